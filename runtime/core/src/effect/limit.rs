//! A joint's limits: a stop at each bound.

use super::{Field, Force, ramp};
use crate::Scalar;

pub(super) const FIELDS: &[Field] = &[
    Field::number("lower", "rad|m", "lower bound"),
    Field::number("upper", "rad|m", "upper bound").rule(|p| p[0] < p[1], "a number above the lower bound"),
    Field::number("stiffness", "N·m/rad|N/m", "torque per unit of depth").at_least_zero().factor(),
    Field::number("damping", "s/rad|s/m", "what a unit rate into the stop adds to the torque, in parts of it").at_least_zero().or(&[0.0]),
];

pub(super) struct Law;

impl Force for Law {
    // x = max(0, l − q): k x max(0, 1 − c v);  x = max(0, q − u): −k x max(0, 1 + c v)
    #[inline(always)]
    fn force<S: Scalar>(p: &[S], q: S, v: S) -> S {
        let (k, c) = (p[2], p[3] * v);
        let (below, above) = (ramp(p[0] - q), ramp(q - p[1]));
        k * below * ramp(S::one() - c) - k * above * ramp(S::one() + c)
    }

    // ½ k x²
    fn energy<S: Scalar>(p: &[S], q: S) -> S {
        let (below, above) = (ramp(p[0] - q), ramp(q - p[1]));
        S::from_f64(0.5) * p[2] * (below * below + above * above)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// However fast a body leaves, no stop pulls it.
    #[test]
    fn a_stop_pushes_and_never_pulls() {
        let force = |q: f64, v: f64| Law::force(&[0.0, 1.0, 100.0, 1.0], q, v);
        assert_eq!([0.5, -3.0, 3.0].map(|v| force(-0.25, v)), [12.5, 100.0, 0.0]);
        assert_eq!([-0.5, 3.0, -3.0].map(|v| force(1.25, v)), [-12.5, -100.0, 0.0]);
        assert_eq!([-3.0, 0.0, 3.0].map(|v| force(0.5, v)), [0.0; 3]);
    }
}
