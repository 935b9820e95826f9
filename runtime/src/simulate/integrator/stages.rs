//! Stages of explicit Runge–Kutta methods, and what is fast between them.

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
    before: Vec<f64>,
    fastest: Fastest,
    /// Whether to look for fast motion: who chooses steps by tolerance has no need.
    looks: bool,
}

impl Stages {
    /// `count` slopes of `n` numbers; whether steps are fixed.
    pub(super) fn new(n: usize, count: usize, looks: bool) -> Self {
        Self { n, k: vec![0.0; n * count], argument: vec![0.0; n], before: vec![0.0; n], fastest: Fastest::new(n), looks }
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
    pub(super) fn begin(&mut self, start: Start) {
        self.k[..self.n].copy_from_slice(start.f);
        self.argument.copy_from_slice(start.y);
        self.fastest.reset();
    }

    /// The fastest motion that the stages of the step saw.
    pub(super) fn fastest(&self) -> &Fastest {
        &self.fastest
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
        std::mem::swap(&mut self.argument, &mut self.before);
        let mut argument = std::mem::take(&mut self.argument);
        self.combine(start.y, h, a, &mut argument);
        self.argument = argument;
        let (n, k) = (self.n, &mut self.k);
        system.rate(control, start.t + c * h, &self.argument, &mut k[i * n..(i + 1) * n])?;
        if self.looks {
            self.fastest.compare([&self.before, &self.argument], [&self.k[(i - 1) * n..i * n], &self.k[i * n..(i + 1) * n]]);
        }
        Ok(())
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

/// The fastest motion seen between points of a step: the λ with |Δa| = λ²|Δu| + λ|Δv|, which for springs and for damping by itself is at least 0.6 of the true one, and
/// where it was seen: at that of the two points with the larger acceleration, and halfway between, where a force that changes its side is steepest.
#[derive(Clone, Debug)]
pub(super) struct Fastest {
    rate: f64,
    at: [Vec<f64>; 2],
}

impl Fastest {
    pub(super) fn new(n: usize) -> Self {
        Self { rate: 0.0, at: [vec![0.0; n], vec![0.0; n]] }
    }

    pub(super) fn reset(&mut self) {
        self.rate = 0.0;
    }

    /// 1/s, and where.
    pub(super) fn seen(&self) -> (f64, [&[f64]; 2]) {
        (self.rate, self.at.each_ref().map(Vec::as_slice))
    }

    /// Two points of a chart and their slopes.
    pub(super) fn compare(&mut self, y: [&[f64]; 2], f: [&[f64]; 2]) {
        let nv = (self.at[0].len() - 2) / 2;
        let (mut way, mut turn, mut change) = (0.0, 0.0, 0.0);
        for i in 0..nv {
            let square = |pair: [&[f64]; 2], i: usize| (pair[0][i] - pair[1][i]).powi(2);
            (way, turn, change) = (way + square(y, i), turn + square(y, nv + i), change + square(f, nv + i));
        }
        let (way, turn, change) = (way.sqrt(), turn.sqrt(), change.sqrt());
        // The positive root of way·λ² + turn·λ = change, without cancellation.
        let rate = 2.0 * change / (turn + (turn * turn + 4.0 * way * change).sqrt());
        if rate > self.rate && rate.is_finite() {
            self.rate = rate;
            let size = f.map(|f| f[nv..2 * nv].iter().map(|a| a * a).sum::<f64>());
            let [end, middle] = &mut self.at;
            end.copy_from_slice(y[usize::from(size[1] > size[0])]);
            middle.iter_mut().zip(y[0]).zip(y[1]).for_each(|((m, a), b)| *m = 0.5 * (a + b));
        }
    }
}
