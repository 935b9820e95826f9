//! A joint's limits: a stop at each bound.

use super::{BallForce, Field, Force, ramp};
use crate::Scalar;
use crate::spatial::Vector3;

pub(super) const FIELDS: &[Field] = &[
    Field::number("lower", "rad|m", "lower bound"),
    Field::number("upper", "rad|m", "upper bound").rule(|p| p[0] < p[1], "a number above the lower bound"),
    Field::number("stiffness", "N·m/rad|N/m", "torque per unit of depth").at_least_zero().factor(),
    Field::number("damping", "s/rad|s/m", "what a unit rate into the stop adds to the torque, in parts of it").at_least_zero().or(&[0.0]),
];

pub(super) const BALL_FIELDS: &[Field] = &[
    Field::number("upper", "rad", "largest angle of the rotation from the identity, about any axis; no bound from π on").positive(),
    Field::number("stiffness", "N·m/rad", "torque per unit of depth").at_least_zero().factor(),
    Field::number("damping", "s/rad", "what a unit rate into the stop adds to the torque, in parts of it").at_least_zero().or(&[0.0]),
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

/// |φ|, but `upper` where it is less: there it has a derivative at φ = 0 too.
#[inline(always)]
fn angle_beyond<S: Scalar>(upper: S, phi: Vector3<S>) -> S {
    let (square, least) = (phi.dot(&phi), upper * upper);
    S::select((square - least).positive(), square, least).sqrt()
}

impl BallForce for Law {
    // θ = |φ|, θ̇ = φᵀω/θ, x = max(0, θ − u): −k x max(0, 1 + c θ̇) φ/θ
    #[inline(always)]
    fn torque<S: Scalar>(p: &[S], phi: Vector3<S>, omega: Vector3<S>) -> Vector3<S> {
        let theta = angle_beyond(p[0], phi);
        let axis = phi.map(|x| x / theta);
        let push = p[1] * ramp(theta - p[0]) * ramp(S::one() + p[2] * axis.dot(&omega));
        axis.map(|x| -(push * x))
    }

    // ½ k x²
    fn energy<S: Scalar>(p: &[S], phi: Vector3<S>) -> S {
        let x = ramp(angle_beyond(p[0], phi) - p[0]);
        S::from_f64(0.5) * p[1] * (x * x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cone_pushes_back_along_the_rotation_vector_and_never_pulls() {
        let torque = |phi: [f64; 3], omega: [f64; 3]| {
            let torque = Law::torque(&[0.5, 100.0, 1.0], Vector3::from(phi), Vector3::from(omega));
            [torque.x, torque.y, torque.z]
        };
        assert_eq!(torque([0.0; 3], [1.0, 2.0, 3.0]), [0.0; 3]);
        assert_eq!(torque([0.3, 0.4, 0.0], [9.0, 9.0, 9.0]), [0.0; 3]);
        // A rate across the axis has no effect.
        assert_eq!(torque([0.0, 0.75, 0.0], [5.0, 0.0, 7.0]), [0.0, -25.0, 0.0]);
        assert_eq!(torque([0.0, 0.75, 0.0], [0.0, 3.0, 0.0]), [0.0, -100.0, 0.0]);
        assert_eq!(torque([0.0, 0.75, 0.0], [0.0, -3.0, 0.0]), [0.0; 3]);
        assert_eq!(<Law as BallForce>::energy(&[0.5, 100.0, 1.0], Vector3::new(0.0, 0.0, -0.75)), 3.125);
    }

    /// However fast a body leaves, no stop pulls it.
    #[test]
    fn a_stop_pushes_and_never_pulls() {
        let force = |q: f64, v: f64| Law::force(&[0.0, 1.0, 100.0, 1.0], q, v);
        assert_eq!([0.5, -3.0, 3.0].map(|v| force(-0.25, v)), [12.5, 100.0, 0.0]);
        assert_eq!([-0.5, 3.0, -3.0].map(|v| force(1.25, v)), [-12.5, -100.0, 0.0]);
        assert_eq!([-3.0, 0.0, 3.0].map(|v| force(0.5, v)), [0.0; 3]);
    }
}
