//! Stages of explicit Runge–Kutta methods, and fast motion between them.

use super::{Start, squared_distance};
use crate::simulate::stability::SUSPICIOUS;
use crate::simulate::system::System;
use crate::simulate::{Control, SimulateError};

/// Numbers that are combined at once.
const BLOCK: usize = 4;

/// Slopes k_1 … k_s of a step, and room for an argument.
#[derive(Clone, Debug)]
pub(super) struct Stages {
    n: usize,
    k: Vec<f64>,
    argument: Vec<f64>,
    before: Vec<f64>,
    fastest: Fastest,
    /// Whether to look for fast motion: steps chosen by tolerance need no such check.
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

    /// The first slope of a step of length h is known.
    pub(super) fn begin(&mut self, start: Start) {
        let h = start.h;
        self.k[..self.n].copy_from_slice(start.f);
        self.argument.copy_from_slice(start.y);
        self.fastest.reset(SUSPICIOUS / h);
    }

    /// The fastest motion that the stages of the step saw.
    pub(super) fn fastest(&self) -> &Fastest {
        &self.fastest
    }

    /// Slope i at t + c·h, y + h·Σ a_j k_j.
    #[inline(always)]
    pub(super) fn stage(
        &mut self,
        system: &mut System<'_>,
        control: &mut dyn Control,
        start: Start,
        i: usize,
        c: f64,
        a: &[f64],
    ) -> Result<(), SimulateError> {
        let h = start.h;
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

    /// out = y + h·Σ a_j k_j. Inlined, so that coefficients known at the call need no checks.
    #[inline(always)]
    pub(super) fn combine(&self, y: &[f64], h: f64, a: &[f64], out: &mut [f64]) {
        let n = self.n;
        let (y, out) = (&y[..n], &mut out[..n]);
        for block in 0..n.div_ceil(BLOCK) {
            // The last block overlaps the one before it if blocks do not divide the length.
            let i = (BLOCK * block).min(n.saturating_sub(BLOCK));
            match (y[i..].first_chunk::<BLOCK>(), out[i..].first_chunk_mut::<BLOCK>()) {
                (Some(y), Some(out)) => {
                    let sum = self.sums(a, i);
                    *out = std::array::from_fn(|l| y[l] + h * sum[l]);
                }
                _ => (0..n).for_each(|i| out[i] = y[i] + h * self.sum(a, i)),
            }
        }
    }

    /// Σ a_j k_j of a block of numbers, from i on.
    #[inline(always)]
    fn sums(&self, a: &[f64], i: usize) -> [f64; BLOCK] {
        let mut sums = [0.0; BLOCK];
        for (j, &a) in a.iter().enumerate().filter(|(_, a)| **a != 0.0) {
            sums.iter_mut().zip(&self.k[j * self.n + i..][..BLOCK]).for_each(|(sum, k)| *sum += a * k);
        }
        sums
    }

    /// Σ a_j k_j of number i.
    pub(super) fn sum(&self, a: &[f64], i: usize) -> f64 {
        a.iter().enumerate().filter(|(_, a)| **a != 0.0).map(|(j, a)| a * self.k[j * self.n + i]).sum()
    }
}

/// No explicit method is stable at this many times the rate that matters: what later stages see is
/// a result of the method.
const WILD: f64 = 10.0;

/// The fastest motion seen between points of a step: the λ with |Δa| = λ²|Δu| + λ|Δv|, which for
/// springs and for damping by itself is at least 0.6 of the true one. Also its place: that of the
/// two points with the larger acceleration, and halfway between, where a force that changes its
/// side is steepest. Motion slower than the rate that matters is not examined closely.
#[derive(Clone, Debug)]
pub(super) struct Fastest {
    rate: f64,
    at: [Vec<f64>; 2],
    /// The rate from which on it matters.
    least: f64,
}

impl Fastest {
    pub(super) fn new(n: usize) -> Self {
        Self { rate: 0.0, at: [vec![0.0; n], vec![0.0; n]], least: 0.0 }
    }

    /// Another step; rates below `least` do not matter in it.
    pub(super) fn reset(&mut self, least: f64) {
        (self.rate, self.least) = (0.0, least);
    }

    /// 1/s, and the places; zero if no motion was as fast as matters.
    pub(super) fn seen(&self) -> (f64, [&[f64]; 2]) {
        (self.rate, self.at.each_ref().map(Vec::as_slice))
    }

    /// Two points of a chart and their slopes.
    pub(super) fn compare(&mut self, y: [&[f64]; 2], f: [&[f64]; 2]) {
        // A point to which the motion was thrown is not examined.
        if self.rate > WILD * self.least {
            return;
        }
        let nv = (self.at[0].len() - 2) / 2;
        let square = |pair: [&[f64]; 2], at: usize| squared_distance(&pair[0][at..at + nv], &pair[1][at..at + nv]);
        let (turn, change) = (square(y, nv), square(f, nv));
        // Then |Δa| ≤ λ²|Δu| + λ|Δv| for certain with this λ: nothing is faster. Mostly so, and
        // without roots.
        let known = self.rate.max(self.least).powi(2);
        if change <= known * turn {
            return;
        }
        let way = square(y, 0);
        if change <= known * (known * way + turn) {
            return;
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
