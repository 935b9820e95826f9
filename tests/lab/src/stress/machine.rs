//! The floats that programs run on.

use articulated_core::Scalar;
use articulated_core::model::Model;
use articulated_reference::Exact;

/// `f64` or `f32`.
pub trait Machine: Scalar<Mask = bool> {
    /// Its name.
    const NAME: &'static str;
    /// u, half the spacing of numbers at 1.
    const ROUNDOFF: f64;

    /// Exactly.
    fn to_f64(self) -> f64;
}

impl Machine for f64 {
    const NAME: &'static str = "f64";
    const ROUNDOFF: f64 = f64::EPSILON / 2.0;

    fn to_f64(self) -> f64 {
        self
    }
}

impl Machine for f32 {
    const NAME: &'static str = "f32";
    const ROUNDOFF: f64 = f32::EPSILON as f64 / 2.0;

    fn to_f64(self) -> f64 {
        f64::from(self)
    }
}

/// Nearest numbers.
pub fn cast<F: Scalar>(x: &[f64]) -> Vec<F> {
    x.iter().map(|x| F::from_f64(*x)).collect()
}

/// The same numbers.
pub fn widened<F: Machine>(x: &[F]) -> Vec<f64> {
    x.iter().map(|x| x.to_f64()).collect()
}

/// As it is, in many digits.
pub fn exact<F: Machine>(model: &Model<F>) -> Exact {
    Exact::library(&wide(model))
}

/// As it is, in double precision.
pub fn wide<F: Machine>(model: &Model<F>) -> Model<f64> {
    model.map(Machine::to_f64)
}
