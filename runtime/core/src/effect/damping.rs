//! Viscous damping.

use super::Field;
use crate::Scalar;

pub(super) const FIELDS: &[Field] = &[Field::number("damping", "N·m·s/rad|N·s/m", "torque at the unit rate").at_least_zero().factor()];

// −d v
#[inline(always)]
pub(super) fn force<S: Scalar>(p: &[S], v: S) -> S {
    -(p[0] * v)
}
