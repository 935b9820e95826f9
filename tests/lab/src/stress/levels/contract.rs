//! The contract of a level of accuracy for a number.

use articulated_codegen::{Arithmetic, Precision, TrigAccuracy};

use crate::stress::judge::BACKWARD;

const DOUBLE: f64 = f64::EPSILON / 2.0;
const SINGLE: f64 = f32::EPSILON as f64 / 2.0;

/// Maximum error of a result:
///
/// ```text
/// r |x| + 64 u Σ|terms| + 3 N σ Σ‖terms‖
/// ```
///
/// u is the unit roundoff of the arithmetic, r that of the final rounding of the result. σ is the
/// absolute error of a sine: a rotation by sines with errors σ changes a vector by √2 σ of its
/// length, and a torque's terms pass N joints on their way out and N on their way back, 2√2 N < 3
/// N; lengths count, since a sine of zero has an error of σ too.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contract {
    roundoff: f64,
    result: f64,
    sines: f64,
    joints: f64,
}

impl Contract {
    /// For a robot of this number of joints.
    pub(super) fn of(level: Precision, joints: usize) -> Self {
        let (roundoff, result) = match level.arithmetic {
            Arithmetic::Single => (SINGLE, 0.0),
            Arithmetic::SingleByDouble => (DOUBLE, SINGLE),
            // Constants are those of the model in f64, for all computations.
            Arithmetic::Double | Arithmetic::Compensated | Arithmetic::DoubleDouble => (DOUBLE, 0.0),
        };
        let sines = match level.sines {
            TrigAccuracy::Fast7 => 1e-7,
            TrigAccuracy::Fast10 => 1e-10,
            TrigAccuracy::Ulp1 | TrigAccuracy::CorrectlyRounded | TrigAccuracy::DoubleDouble => 0.0,
        };
        Self { roundoff, result, sines, joints: joints as f64 }
    }

    /// The ratio of an error to the allowed one, for a number with these terms.
    pub(super) fn part(&self, error: f64, value: f64, terms: f64, norms: f64) -> f64 {
        if error == 0.0 { 0.0 } else { error / self.allowed(value, terms, norms) }
    }

    fn allowed(&self, value: f64, terms: f64, norms: f64) -> f64 {
        self.result * value.abs() + BACKWARD * self.roundoff * terms + 3.0 * self.joints * self.sines * norms
    }

    /// The unit of shown errors, and the allowed number of units.
    pub(super) fn unit(&self) -> (f64, &'static str) {
        match (self.result == 0.0, self.sines == 0.0) {
            (true, true) => (BACKWARD, "u"),
            (false, true) => (1.0, "of u₃₂|x| + 64u"),
            (true, false) => (1.0, "of 64u + 3Nσ"),
            (false, false) => (1.0, "of u₃₂|x| + 64u + 3Nσ"),
        }
    }
}
