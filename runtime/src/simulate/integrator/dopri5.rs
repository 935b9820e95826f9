//! Dormand's and Prince's pair of orders 5(4): seven stages, of which the last is the first of the
//! next step.
//!
//! Coefficients: Dormand & Prince, *A family of embedded Runge–Kutta formulae*, J. Comput. Appl.
//! Math. 6, 1980; curve of order 4 and test of stiffness: Hairer, Nørsett & Wanner 1993, (II.6.12),
//! and Hairer & Wanner 1996, §IV.2.

use super::stages::Stages;
use super::{Method, Start, distance, largest_of_polynomial};
use crate::simulate::step_control::{Controller, Error, Norm};
use crate::simulate::system::System;
use crate::simulate::{Control, SimulateError};

const C: [f64; 6] = [1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0, 1.0];

const A: [&[f64]; 6] = [
    &[1.0 / 5.0],
    &[3.0 / 40.0, 9.0 / 40.0],
    &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
    &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
    &[9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
    &[35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];

/// Weights of order 5 less those of order 4.
const E: [f64; 7] = [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339_200.0, 22.0 / 525.0, -1.0 / 40.0];

/// The curve's own combination of slopes.
const D: [f64; 7] = [
    -12_715_105_075.0 / 11_282_082_432.0,
    0.0,
    87_487_479_700.0 / 32_700_410_799.0,
    -10_690_763_975.0 / 1_880_347_072.0,
    701_980_252_875.0 / 199_316_789_632.0,
    -1_453_857_185.0 / 822_651_844.0,
    69_997_945.0 / 29_380_423.0,
];

/// 1 + z + … + z⁵/120 + z⁶/600.
const STABILITY: [f64; 7] = [1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 120.0, 1.0 / 600.0];

pub(crate) struct Dopri5 {
    stages: Stages,
    /// Argument of stage 6, which is at the end of the step as that of stage 7 is.
    sixth: Vec<f64>,
}

impl Dopri5 {
    pub(super) fn new(n: usize, fixed: bool) -> Self {
        Self { stages: Stages::new(n, 7, fixed), sixth: vec![0.0; n] }
    }
}

impl Method for Dopri5 {
    fn step(
        &mut self,
        system: &mut System<'_>,
        control: &mut dyn Control,
        start: Start,
        end: &mut [f64],
        norm: &Norm,
    ) -> Result<Error, SimulateError> {
        let h = start.h;
        let k = &mut self.stages;
        k.begin(start);
        for i in 0..6 {
            k.stage(system, control, start, i + 1, C[i], A[i])?;
            if i == 4 {
                self.sixth.copy_from_slice(k.argument());
            }
        }
        end.copy_from_slice(k.argument());
        Ok(norm.of(|i| h * k.sum(&E, i), end))
    }

    fn last_rate(&self) -> Option<&[f64]> {
        Some(self.stages.k(6))
    }

    fn prepare(&mut self, _: &mut System<'_>, _: &mut dyn Control, _: Start, _: &[f64]) -> Result<(), SimulateError> {
        Ok(())
    }

    fn between(&self, s: f64, start: Start, end: &[f64], out: &mut [f64]) {
        let h = start.h;
        let k = &self.stages;
        for (i, out) in out.iter_mut().enumerate() {
            let way = end[i] - start.y[i];
            let bend = h * k.k(0)[i] - way;
            let last = way - h * k.k(6)[i] - bend;
            let own = h * k.sum(&D, i);
            *out = start.y[i] + s * (way + (1.0 - s) * (bend + s * (last + (1.0 - s) * own)));
        }
    }

    fn controller(&self) -> Option<Controller> {
        Some(Controller::new(5.0, 0.04, 0.2, 10.0))
    }

    fn amplification(&self, a: f64, b: f64, h: f64) -> Option<f64> {
        Some(largest_of_polynomial(&STABILITY, a, b, h))
    }

    fn stiffness(&self, h: f64, end: &[f64]) -> Option<(f64, f64)> {
        let points = distance(end, &self.sixth);
        (points > 0.0).then(|| (h * distance(self.stages.k(6), self.stages.k(5)) / points, 3.25))
    }

    fn fastest(&self) -> Option<(f64, [&[f64]; 2])> {
        Some(self.stages.fastest().seen())
    }
}

#[cfg(test)]
mod tests {
    use super::{A, C, D, E};

    #[test]
    fn coefficients_meet_the_conditions_of_order() {
        for (a, c) in A.iter().zip(C) {
            assert!((a.iter().sum::<f64>() - c).abs() < 1e-14);
        }
        let nodes = [0.0, C[0], C[1], C[2], C[3], C[4], C[5]];
        for power in 0..5 {
            let sum: f64 = A[5].iter().zip(nodes).map(|(b, c)| b * c.powi(power)).sum();
            assert!((sum - 1.0 / f64::from(power + 1)).abs() < 1e-14, "{power}: {sum}");
        }
        for power in 0..4 {
            let sum: f64 = E.iter().zip(nodes).map(|(e, c)| e * c.powi(power)).sum();
            assert!(sum.abs() < 1e-14, "{power}: {sum}");
        }
        assert!(D.iter().sum::<f64>().abs() < 1e-14);
    }
}
