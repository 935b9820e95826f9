//! A spring in a joint.

use super::{BallForce, Field, Force};
use crate::Scalar;
use crate::spatial::Vector3;
use crate::spatial::screw::Quaternion;

pub(super) const FIELDS: &[Field] = &[
    Field::number("stiffness", "N·m/rad|N/m", "torque per unit of the coordinate").at_least_zero().factor(),
    Field::number("rest", "rad|m", "coordinate at which it is slack").or(&[0.0]),
];

pub(super) const BALL_FIELDS: &[Field] = &[
    Field::number("stiffness", "N·m/rad", "torque per unit of the angle").at_least_zero().factor(),
    Field::number("rest", "1", "quaternion (x, y, z, w) at which it is slack, of any length").quaternion::<1>(),
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

impl BallForce for Law {
    fn rest<S: Scalar>(p: &[S]) -> Quaternion<S> {
        Quaternion::from_array([p[1], p[2], p[3], p[4]])
    }

    // −k φ: the gradient of ½ k |φ|² along a rate ω is k φᵀ J_r(φ)⁻¹ ω = k φᵀ ω.
    #[inline(always)]
    fn torque<S: Scalar>(p: &[S], phi: Vector3<S>, _omega: Vector3<S>) -> Vector3<S> {
        phi.map(|x| -(p[0] * x))
    }

    // ½ k |φ|²
    fn energy<S: Scalar>(p: &[S], phi: Vector3<S>) -> S {
        S::from_f64(0.5) * p[0] * phi.dot(&phi)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spring_on_a_ball_pulls_along_the_rotation_vector() {
        let phi = Vector3::new(2.0 * 0.1_f64.asin(), 0.0, 0.0);
        let p = [3.0, 0.0, 0.0, 0.0, 1.0];
        let torque = Law::torque(&p, phi, Vector3::zeros());
        assert!((torque.x + 0.601_004_526_9).abs() < 1e-10 && torque.y == 0.0 && torque.z == 0.0, "{torque}");
        let energy = <Law as BallForce>::energy(&p, phi);
        assert!((energy - 0.060_201_073_6).abs() < 1e-10, "{energy}");
    }
}
