//! Dormand's, Prince's and Hairer's method of order 8 with errors of orders 5 and 3: twelve stages,
//! a thirteenth that is the first of the next step, three more for a curve of order 7.
//!
//! Hairer, Nørsett & Wanner, *Solving Ordinary Differential Equations I*, 1993, §II.5 (method),
//! (II.10.17) (error), §II.6 (curve); test of stiffness as in dopri5.

use super::dop853_coefficients::{A, C, D, E3, E5};
use super::stages::Stages;
use super::{Method, Start, distance, largest_of_polynomial};
use crate::simulate::step_control::{Controller, Error, Norm};
use crate::simulate::system::System;
use crate::simulate::{Control, SimulateError};

/// Index of the stage at the end of the step, and of its row.
const LAST: usize = 12;

pub(crate) struct Dop853 {
    stages: Stages,
    /// Argument of stage 12, which is at the end of the step too.
    twelfth: Vec<f64>,
    stability: [f64; LAST + 1],
    curve: [Vec<f64>; 4],
    ready: bool,
}

impl Dop853 {
    pub(super) fn new(n: usize, fixed: bool) -> Self {
        let curve = std::array::from_fn(|_| vec![0.0; n]);
        Self { stages: Stages::new(n, 16, fixed), twelfth: vec![0.0; n], stability: stability(), curve, ready: false }
    }
}

/// The step multiplies e^{λt} by Σ c_j (hλ)ʲ, c_j = bᵀ Aʲ⁻¹ 1.
fn stability() -> [f64; LAST + 1] {
    let mut c = [1.0; LAST + 1];
    let mut powers = [1.0; LAST];
    for c in &mut c[1..] {
        *c = A[LAST - 1].iter().zip(powers).map(|(b, p)| b * p).sum();
        powers = std::array::from_fn(|i| if i == 0 { 0.0 } else { A[i - 1].iter().zip(powers).map(|(a, p)| a * p).sum() });
    }
    c
}

/// Weights minus those of order 3.
fn of_order_three(j: usize) -> f64 {
    A[LAST - 1][j] - E3.iter().find(|(i, _)| *i == j).map_or(0.0, |(_, x)| *x)
}

impl Method for Dop853 {
    fn step(
        &mut self,
        system: &mut System<'_>,
        control: &mut dyn Control,
        start: Start,
        end: &mut [f64],
        norm: &Norm,
    ) -> Result<Error, SimulateError> {
        let h = start.h;
        self.ready = false;
        let k = &mut self.stages;
        k.begin(start);
        for i in 1..=LAST {
            k.stage(system, control, start, i, C[i - 1], A[i - 1])?;
            if i == LAST - 1 {
                self.twelfth.copy_from_slice(k.argument());
            }
        }
        end.copy_from_slice(k.argument());
        let third: [f64; LAST] = std::array::from_fn(of_order_three);
        let (fifth, third) = (norm.of(|i| h * k.sum(&E5, i), end), norm.of(|i| h * k.sum(&third, i), end));
        let both = (fifth.size * fifth.size + 0.01 * third.size * third.size).sqrt();
        let size = if both == 0.0 { 0.0 } else { fifth.size * fifth.size / both };
        Ok(Error { size, ..fifth })
    }

    fn last_rate(&self) -> Option<&[f64]> {
        Some(self.stages.k(LAST))
    }

    fn prepare(&mut self, system: &mut System<'_>, control: &mut dyn Control, start: Start, _: &[f64]) -> Result<(), SimulateError> {
        let h = start.h;
        if self.ready {
            return Ok(());
        }
        let k = &mut self.stages;
        for i in LAST + 1..16 {
            k.stage(system, control, start, i, C[i - 1], A[i - 1])?;
        }
        for (row, d) in self.curve.iter_mut().zip(&D) {
            row.iter_mut().enumerate().for_each(|(i, out)| *out = h * k.sum(d, i));
        }
        self.ready = true;
        Ok(())
    }

    fn between(&self, s: f64, start: Start, end: &[f64], out: &mut [f64]) {
        let h = start.h;
        let (k, [c3, c4, c5, c6], r) = (&self.stages, &self.curve, 1.0 - s);
        let (first, last) = (k.k(0), k.k(LAST));
        for (i, out) in out.iter_mut().enumerate() {
            let way = end[i] - start.y[i];
            let bend = h * first[i] - way;
            let turn = 2.0 * way - h * (first[i] + last[i]);
            *out = start.y[i] + s * (way + r * (bend + s * (turn + r * (c3[i] + s * (c4[i] + r * (c5[i] + s * c6[i]))))));
        }
    }

    fn controller(&self) -> Option<Controller> {
        Some(Controller::new(8.0, 0.0, 1.0 / 3.0, 6.0))
    }

    fn amplification(&self, a: f64, b: f64, h: f64) -> Option<f64> {
        Some(largest_of_polynomial(&self.stability, a, b, h))
    }

    fn stiffness(&self, h: f64, end: &[f64]) -> Option<(f64, f64)> {
        let points = distance(end, &self.twelfth);
        (points > 0.0).then(|| (h * distance(self.stages.k(LAST), self.stages.k(LAST - 1)) / points, 6.1))
    }

    fn fastest(&self) -> Option<(f64, [&[f64]; 2])> {
        Some(self.stages.fastest().seen())
    }
}

#[cfg(test)]
mod tests {
    use super::{A, C, D, E5, LAST, of_order_three, stability};

    fn moment(weights: impl Iterator<Item = f64>, power: i32) -> f64 {
        let nodes = std::iter::once(0.0).chain(C);
        weights.zip(nodes).map(|(b, c)| b * c.powi(power)).sum()
    }

    #[test]
    fn coefficients_meet_the_conditions_of_order() {
        for (i, (a, c)) in A.iter().zip(C).enumerate() {
            assert!((a.iter().sum::<f64>() - c).abs() < 3e-14, "row {i}");
        }
        for power in 0..8 {
            let sum = moment(A[LAST - 1].iter().copied(), power);
            assert!((sum - 1.0 / f64::from(power + 1)).abs() < 1e-14, "{power}: {sum}");
        }
        for power in 0..5 {
            assert!(moment(E5.into_iter(), power).abs() < 1e-14);
        }
        for power in 0..3 {
            assert!(moment((0..LAST).map(of_order_three), power).abs() < 1e-14);
        }
        for d in D {
            assert!(d.iter().sum::<f64>().abs() < 1e-11);
        }
        let mut factorial = 1.0;
        for (j, c) in stability().iter().enumerate().take(9) {
            factorial *= (j.max(1)) as f64;
            assert!((c * factorial - 1.0).abs() < 1e-11, "{j}: {c}");
        }
    }
}
