//! Damping of higher degree, beside `damping`.

use super::Field;
use crate::Scalar;

pub(super) const FIELDS: &[Field] = &[
    Field::number("quadratic", "N·m·s²/rad²|N·s²/m²", "torque per square of the rate").unless("cubic").part(),
    Field::number("cubic", "N·m·s³/rad³|N·s³/m³", "torque per cube of the rate").unless("quadratic").part(),
];

// −(d₂ |v| + d₃ v²) v
#[inline(always)]
pub(super) fn force<S: Scalar>(p: &[S], v: S) -> S {
    -((p[0] * v.abs() + p[1] * (v * v)) * v)
}
