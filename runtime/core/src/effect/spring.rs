//! A spring in a joint.

use super::{Field, Force};
use crate::Scalar;

pub(super) const FIELDS: &[Field] = &[
    Field::number("stiffness", "N·m/rad|N/m", "torque per unit of the coordinate").at_least_zero().factor(),
    Field::number("rest", "rad|m", "coordinate at which it is slack").or(&[0.0]),
];

pub(super) struct Law;

impl Force for Law {
    // −k (q − q₀)
    #[inline(always)]
    fn force<S: Scalar>(p: &[S], q: S, _v: S) -> S {
        -(p[0] * (q - p[1]))
    }

    // ½ k (q − q₀)²
    fn energy<S: Scalar>(p: &[S], q: S) -> S {
        let x = q - p[1];
        S::from_f64(0.5) * p[0] * x * x
    }
}
