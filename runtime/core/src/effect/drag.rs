//! Quadratic drag at a point.

use super::{Field, FrameForce, Station};
use crate::Scalar;
use crate::spatial::{Vector3, Wrench};

pub(super) const FIELDS: &[Field] =
    &[Field::number("coefficient", "N·s²/m²", "½ ρ C A: density, drag coefficient and area").at_least_zero().factor()];

/// Square of a negligible speed, m²/s²: the root has a slope there.
const STILL: f64 = 1e-24;

pub(super) struct Law;

impl FrameForce for Law {
    // −c |v| v
    #[inline(always)]
    fn wrench<S: Scalar>(p: &[S], at: &Station<S>) -> Wrench<S> {
        let v = at.twist.linear;
        let speed = (v.dot(&v) + S::from_f64(STILL)).sqrt();
        Wrench { moment: Vector3::zeros(), force: -(v * (p[0] * speed)) }
    }
}
