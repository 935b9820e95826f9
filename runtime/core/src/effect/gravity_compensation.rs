//! Gravity compensation.

use super::{Field, FrameForce, Station};
use crate::Scalar;
use crate::spatial::{Vector3, Wrench, rotate_back};

pub(super) const FIELDS: &[Field] =
    &[Field::number("mass", "kg", "the mass whose weight is carried; its centre is the origin of the effect's frame").factor()];

pub(super) struct Law;

impl FrameForce for Law {
    // −m g
    #[inline(always)]
    fn wrench<S: Scalar>(p: &[S], at: &Station<S>) -> Wrench<S> {
        Wrench { moment: Vector3::zeros(), force: -(rotate_back(&at.placement.rotation, at.gravity) * p[0]) }
    }

    // m gᵀp
    fn energy<S: Scalar>(p: &[S], at: &Station<S>) -> S {
        p[0] * at.gravity.dot(&at.placement.position)
    }
}
