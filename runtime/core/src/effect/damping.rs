//! Viscous damping.

use super::{Field, Force};
use crate::Scalar;

pub(super) const FIELDS: &[Field] = &[Field::number("damping", "N·m·s/rad|N·s/m", "torque at the unit rate").at_least_zero().factor()];

pub(super) struct Law;

impl Force for Law {
    // −d v
    #[inline(always)]
    fn force<S: Scalar>(p: &[S], _q: S, v: S) -> S {
        -(p[0] * v)
    }
}
