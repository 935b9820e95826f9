//! Coulomb friction.

use super::{Field, smooth_sign};
use crate::Scalar;

pub(super) const FIELDS: &[Field] = &[
    Field::number("friction", "N·m|N", "torque of sliding").at_least_zero().factor(),
    Field::number("speed", "rad/s|m/s", "rate below which the law is smooth").smooth().or(&[1e-5]),
];

// −μ v/√(v² + s²)
#[inline(always)]
pub(super) fn force<S: Scalar>(p: &[S], v: S) -> S {
    -(p[0] * smooth_sign(v, p[1]))
}
