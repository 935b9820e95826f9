//! A sphere on a plane that gives way.

use super::{Field, FrameForce, Station, ramp};
use crate::Scalar;
use crate::spatial::{Vector3, Wrench, rotate, rotate_back};

pub(super) const FIELDS: &[Field] = &[
    Field::number("radius", "m", "of the sphere about the origin of the effect's frame").at_least_zero(),
    Field::number("stiffness", "N/m", "force per unit of depth").at_least_zero().factor(),
    Field::number("damping", "s/m", "what a unit speed into the plane adds to the force, in parts of it").at_least_zero(),
    Field::number("friction", "1", "coefficient of friction").at_least_zero(),
    Field::number("speed", "m/s", "sliding speed below which friction is smooth").smooth().or(&[1e-5]),
    Field::number("normal", "1", "outward normal of the plane in the world frame, of any length")
        .or(&[0.0, 0.0, 1.0])
        .of(3)
        .rule(|p| p[5..8] != [0.0; 3], "a direction: three numbers that are not all 0")
        .direction(),
    Field::number("height", "m", "of the plane along its normal, from the world frame's origin").or(&[0.0]),
];

pub(super) struct Law;

/// How deep the sphere is in the plane, 0 if it is not, m.
fn depth<S: Scalar>(p: &[S], at: &Station<S>) -> S {
    ramp(p[8] + p[0] - normal(p).dot(&at.placement.position))
}

fn normal<S: Scalar>(p: &[S]) -> Vector3<S> {
    Vector3::new(p[5], p[6], p[7])
}

impl FrameForce for Law {
    // F = k x max(0, 1 + c ẋ) n − μ F_n v_t/√(v_t² + s²), at the lowest point, −r n from the
    // sphere's centre
    #[inline(always)]
    fn wrench<S: Scalar>(p: &[S], at: &Station<S>) -> Wrench<S> {
        let n = normal(p);
        let turn = &at.placement.rotation;
        let (omega, centre) = (rotate(turn, at.twist.angular), rotate(turn, at.twist.linear));
        let arm = -(n * p[0]);
        let velocity = centre + omega.cross(&arm);
        let along = n.dot(&velocity);
        let push = p[1] * depth(p, at) * ramp(S::one() - p[2] * along);
        let sliding = velocity - n * along;
        let drag = p[3] * push / (sliding.dot(&sliding) + p[4] * p[4]).sqrt();
        let force = n * push - sliding * drag;
        Wrench { moment: rotate_back(turn, arm.cross(&force)), force: rotate_back(turn, force) }
    }

    // ½ k x²
    fn energy<S: Scalar>(p: &[S], at: &Station<S>) -> S {
        let x = depth(p, at);
        S::from_f64(0.5) * p[1] * x * x
    }
}
