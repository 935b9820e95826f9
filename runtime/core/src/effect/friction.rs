//! Coulomb friction.

use super::{Field, smooth_sign};
use crate::Scalar;

/// The rate s below which the law is smooth, if a scene does not have it.
pub(super) const SPEED: f64 = 1e-5;

pub(super) const FIELDS: &[Field] = &[
    Field::number("friction", "N·m|N", "torque of sliding").at_least_zero().factor(),
    Field::number("speed", "rad/s|m/s", "rate below which the law is smooth").smooth().or(&[SPEED]),
];

// −μ v/√(v² + s²)
#[inline(always)]
pub(super) fn force<S: Scalar>(p: &[S], v: S) -> S {
    -(p[0] * smooth_sign(v, p[1]))
}
