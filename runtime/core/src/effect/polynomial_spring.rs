//! A spring of higher degree, beside `spring`.

use super::{BallForce, Field, Force};
use crate::Scalar;
use crate::scalar::root;
use crate::spatial::Vector3;
use crate::spatial::screw::Quaternion;

pub(super) const FIELDS: &[Field] = &[
    Field::number("quadratic", "N·m/rad²|N/m²", "torque per square of the distance from rest").unless("cubic").part(),
    Field::number("cubic", "N·m/rad³|N/m³", "torque per cube of the distance from rest").unless("quadratic").part(),
    Field::number("rest", "rad|m", "coordinate at which it is slack").or(&[0.0]),
];

pub(super) const BALL_FIELDS: &[Field] = &[
    Field::number("quadratic", "N·m/rad²", "torque per square of the angle").unless("cubic").part(),
    Field::number("cubic", "N·m/rad³", "torque per cube of the angle").unless("quadratic").part(),
    Field::number("rest", "1", "quaternion (x, y, z, w) at which it is slack, of any length").quaternion::<2>(),
];

pub(super) struct Law;

/// ∫ (k₂ x + k₃ x²) x dx
fn stored<S: Scalar>(p: &[S], x: S) -> S {
    let square = x * x;
    p[0] * S::from_f64(1.0 / 3.0) * (square * x) + p[1] * S::from_f64(0.25) * (square * square)
}

impl Force for Law {
    // x = q − q₀: −(k₂ x + k₃ x²) x
    #[inline(always)]
    fn force<S: Scalar>(p: &[S], q: S, _v: S) -> S {
        let x = q - p[2];
        -((p[0] * x + p[1] * (x * x)) * x)
    }

    fn energy<S: Scalar>(p: &[S], q: S) -> S {
        stored(p, q - p[2])
    }
}

impl BallForce for Law {
    fn rest<S: Scalar>(p: &[S]) -> Quaternion<S> {
        Quaternion::from_array([p[2], p[3], p[4], p[5]])
    }

    // θ = |φ|: −(k₂ θ + k₃ θ²) φ
    #[inline(always)]
    fn torque<S: Scalar>(p: &[S], phi: Vector3<S>, _omega: Vector3<S>) -> Vector3<S> {
        let theta = root(phi.dot(&phi));
        let stiffness = p[0] * theta + p[1] * (theta * theta);
        phi.map(|x| -(stiffness * x))
    }

    fn energy<S: Scalar>(p: &[S], phi: Vector3<S>) -> S {
        stored(p, root(phi.dot(&phi)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_are_the_slopes_of_the_energies() {
        let p = [3.0, -2.0, 0.25];
        let energy = |q: f64| <Law as Force>::energy(&p, q);
        for q in [-1.0, 0.25, 0.9] {
            let slope = (energy(q + 1e-5) - energy(q - 1e-5)) / 2e-5;
            assert!((slope + Law::force(&p, q, 0.0)).abs() < 1e-8, "{q}");
        }
        // (3 · 0.5 − 2 · 0.25) φ with |φ| = 0.5
        let ball = [3.0, -2.0, 0.0, 0.0, 0.0, 1.0];
        let torque = Law::torque(&ball, Vector3::new(0.3_f64, 0.0, -0.4), Vector3::zeros());
        assert!((torque - Vector3::new(-0.3, 0.0, 0.4)).amax() < 1e-15, "{torque}");
        let still = Law::torque(&ball, Vector3::<f64>::zeros(), Vector3::zeros());
        assert_eq!(still, Vector3::zeros());
    }
}
