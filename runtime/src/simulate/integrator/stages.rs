//! Stages of explicit Runge–Kutta methods.

use articulated_core::dynamics::Dynamics;

use super::Start;
use crate::simulate::system::System;
use crate::simulate::{Control, SimulateError};

/// Slopes k_1 … k_s of a step, and room for an argument.
#[derive(Clone, Debug)]
pub(super) struct Stages {
    n: usize,
    k: Vec<f64>,
    argument: Vec<f64>,
}

impl Stages {
    /// `count` slopes of `n` numbers.
    pub(super) fn new(n: usize, count: usize) -> Self {
        Self { n, k: vec![0.0; n * count], argument: vec![0.0; n] }
    }

    /// Slope i, from 0.
    pub(super) fn k(&self, i: usize) -> &[f64] {
        &self.k[i * self.n..(i + 1) * self.n]
    }

    /// The argument of the last slope.
    pub(super) fn argument(&self) -> &[f64] {
        &self.argument
    }

    /// The first slope is known.
    pub(super) fn begin(&mut self, f: &[f64]) {
        self.k[..self.n].copy_from_slice(f);
    }

    /// Slope i at t + c·h, y + h·Σ a_j k_j.
    pub(super) fn stage<R: Dynamics<f64>>(
        &mut self,
        system: &mut System<R>,
        control: &mut dyn Control,
        (start, h): (Start, f64),
        i: usize,
        c: f64,
        a: &[f64],
    ) -> Result<(), SimulateError> {
        let mut argument = std::mem::take(&mut self.argument);
        self.combine(start.y, h, a, &mut argument);
        self.argument = argument;
        let (n, k) = (self.n, &mut self.k);
        system.rate(control, start.t + c * h, &self.argument, &mut k[i * n..(i + 1) * n])
    }

    /// out = y + h·Σ a_j k_j.
    pub(super) fn combine(&self, y: &[f64], h: f64, a: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        for (k, &a) in self.k.chunks_exact(self.n).zip(a).filter(|(_, a)| **a != 0.0) {
            out.iter_mut().zip(k).for_each(|(out, k)| *out += a * k);
        }
        out.iter_mut().zip(y).for_each(|(out, y)| *out = y + h * *out);
    }

    /// Σ a_j k_j of number i.
    pub(super) fn sum(&self, a: &[f64], i: usize) -> f64 {
        a.iter().enumerate().filter(|(_, a)| **a != 0.0).map(|(j, a)| a * self.k[j * self.n + i]).sum()
    }
}
