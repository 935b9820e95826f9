//! Armature: the inertia of a rotor behind a gear.

use super::Field;
use crate::Scalar;

pub(super) const FIELDS: &[Field] = &[
    Field::number("inertia", "kg·m²|kg", "inertia of the rotor about its own axis").at_least_zero().factor(),
    Field::number("gear", "1", "revolutions of the rotor per revolution of the joint").or(&[1.0]).factor(),
];

/// I n².
pub(super) fn inertia<S: Scalar>(p: &[S]) -> S {
    p[0] * p[1] * p[1]
}
