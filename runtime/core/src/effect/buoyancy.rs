//! Buoyancy.

use super::{Field, FrameForce, Station};
use crate::Scalar;
use crate::spatial::{Vector3, Wrench, rotate_back};

pub(super) const FIELDS: &[Field] = &[
    Field::number("volume", "m³", "displaced volume; its centre is the origin of the effect's frame").at_least_zero().factor(),
    Field::number("density", "kg/m³", "of the fluid").positive().or(&[1000.0]),
];

pub(super) struct Law;

impl FrameForce for Law {
    // −ρ V g
    #[inline(always)]
    fn wrench<S: Scalar>(p: &[S], at: &Station<S>) -> Wrench<S> {
        let force = rotate_back(&at.placement.rotation, at.gravity) * (p[0] * p[1]);
        Wrench { moment: Vector3::zeros(), force: -force }
    }

    // ρ V gᵀp
    fn energy<S: Scalar>(p: &[S], at: &Station<S>) -> S {
        p[0] * p[1] * at.gravity.dot(&at.placement.position)
    }
}
