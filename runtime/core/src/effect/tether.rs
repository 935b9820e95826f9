//! A spring between a frame and a pose in the world.

use super::{Field, FrameForce, Station};
use crate::Scalar;
use crate::scalar::root;
use crate::spatial::screw::{Quaternion, log_rotation};
use crate::spatial::{Vector3, Wrench, rotate_back};

pub(super) const FIELDS: &[Field] = &[
    Field::number("linear", "N/m", "force per distance").part().or(&[0.0]),
    Field::number("linear_quadratic", "N/m²", "force per square of the distance").part().or(&[0.0]),
    Field::number("linear_cubic", "N/m³", "force per cube of the distance").part().or(&[0.0]),
    Field::number("angular", "N·m/rad", "torque per angle of the rotation").part().or(&[0.0]),
    Field::number("angular_quadratic", "N·m/rad²", "torque per square of the angle").part().or(&[0.0]),
    Field::number("angular_cubic", "N·m/rad³", "torque per cube of the angle").part().or(&[0.0]),
    Field::number("position", "m", "where the frame is slack, in the world frame").or(&[0.0; 3]).of(3),
    Field::number("orientation", "1", "quaternion (x, y, z, w) at which the frame is slack, of any length").quaternion::<9>(),
];

pub(super) struct Law;

/// −(k₁ + k₂ |x| + k₃ |x|²) x
#[inline(always)]
fn pull<S: Scalar>(k: &[S], x: &Vector3<S>) -> Vector3<S> {
    let r = root(x.dot(x));
    let stiffness = k[0] + k[1] * r + k[2] * (r * r);
    x.map(|x| -(stiffness * x))
}

/// ∫ (k₁ + k₂ r + k₃ r²) r dr
fn stored<S: Scalar>(k: &[S], x: &Vector3<S>) -> S {
    let square = x.dot(x);
    let r = root(square);
    let [half, third, quarter] = [0.5, 1.0 / 3.0, 0.25].map(S::from_f64);
    half * k[0] * square + third * k[1] * (square * r) + quarter * k[2] * (square * square)
}

/// p − p₀ in the world frame, and log(q₀⁻¹ q) in axes of the frame.
#[inline(always)]
fn away<S: Scalar>(p: &[S], at: &Station<S>) -> (Vector3<S>, Vector3<S>) {
    let rest = Quaternion::from_array([p[9], p[10], p[11], p[12]]).to_rotation();
    (at.placement.position - Vector3::new(p[6], p[7], p[8]), log_rotation(&(rest.transpose() * at.placement.rotation)))
}

impl FrameForce for Law {
    #[inline(always)]
    fn wrench<S: Scalar>(p: &[S], at: &Station<S>) -> Wrench<S> {
        let (x, phi) = away(p, at);
        Wrench { moment: pull(&p[3..6], &phi), force: rotate_back(&at.placement.rotation, pull(&p[..3], &x)) }
    }

    fn energy<S: Scalar>(p: &[S], at: &Station<S>) -> S {
        let (x, phi) = away(p, at);
        stored(&p[..3], &x) + stored(&p[3..6], &phi)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spatial::screw::exp_rotation;
    use crate::spatial::{Placement, Twist};

    fn at(rotation: Vector3<f64>, position: Vector3<f64>) -> Station<f64> {
        let placement = Placement { rotation: exp_rotation(rotation), position };
        Station { placement, twist: Twist::zero(), gravity: Vector3::zeros() }
    }

    #[test]
    fn forces_are_the_slopes_of_the_energy() {
        let p = [3.0, -1.0, 0.5, 2.0, 0.7, -0.2, 0.1, -0.2, 0.3, 0.1, -0.7, 0.1, 0.7];
        let (turn, place) = (Vector3::new(0.4, -1.1, 0.7), Vector3::new(0.9, 0.3, -0.5));
        let own = at(turn, place);
        let w = Law::wrench(&p, &own);
        let h = 1e-5;
        for k in 0..3 {
            let step = Vector3::from_fn(|i, _| if i == k { h } else { 0.0 });
            // Along and about the axes of the frame
            let energy = |sign: f64| {
                let mut turned = own;
                turned.placement.rotation = own.placement.rotation * exp_rotation(step * sign);
                let mut shifted = own;
                shifted.placement.position += own.placement.rotation * step * sign;
                [Law::energy(&p, &turned), Law::energy(&p, &shifted)]
            };
            let (after, before) = (energy(1.0), energy(-1.0));
            for (i, found) in [w.moment[k], w.force[k]].into_iter().enumerate() {
                assert!((found + (after[i] - before[i]) / (2.0 * h)).abs() < 1e-8, "{k} {i}");
            }
        }
    }

    #[test]
    fn a_turn_about_an_axis_is_pulled_back_by_its_angle() {
        let p = [4.0, 0.0, 0.0, 2.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        let w = Law::wrench(&p, &at(Vector3::new(0.0, 0.0, 0.5), Vector3::zeros()));
        assert!((w.moment - Vector3::new(0.0, 0.0, -1.25)).amax() < 1e-15 && w.force == Vector3::zeros(), "{w:?}");
        let w = Law::wrench(&p, &at(Vector3::new(0.0, 0.0, 0.5), Vector3::new(0.0, 0.0, 0.1)));
        assert!((w.force - Vector3::new(0.0, 0.0, -0.4)).amax() < 1e-15, "{w:?}");
    }
}
