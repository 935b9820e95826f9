//! A sphere on a compliant plane.

use super::{Field, FrameForce, Station, ramp};
use crate::Scalar;
use crate::spatial::{Vector3, Wrench, rotate, rotate_back};

pub(super) const FIELDS: &[Field] = &[
    Field::number("radius", "m", "of the sphere about the origin of the effect's frame").at_least_zero(),
    Field::number("stiffness", "N/m", "force per unit of depth").at_least_zero().factor(),
    Field::number("damping", "s/m", "what a unit speed into the plane adds to the force, in parts of it")
        .at_least_zero()
        .unless("damping_time"),
    Field::number("friction", "1", "coefficient of friction").at_least_zero(),
    Field::number("speed", "m/s", "sliding speed below which friction is smooth").smooth().or(&[1e-5]),
    Field::number("normal", "1", "outward normal of the plane in the world frame, of any length")
        .or(&[0.0, 0.0, 1.0])
        .of(3)
        .rule(|p| p[5..8] != [0.0; 3], "a direction: three numbers that are not all 0")
        .direction(),
    Field::number("height", "m", "of the plane along its normal, from the world frame's origin").or(&[0.0]),
    Field::number("damping_time", "s", "force of damping per unit speed into the plane, in parts of the stiffness, where the sphere rests")
        .at_least_zero()
        .or(&[0.0]),
];

pub(super) struct Law;

/// How deep the sphere is in the plane, 0 if it is not, m.
fn depth<S: Scalar>(p: &[S], at: &Station<S>) -> S {
    ramp(p[8] + p[0] - normal(p).dot(&at.placement.position))
}

fn normal<S: Scalar>(p: &[S]) -> Vector3<S> {
    Vector3::new(p[5], p[6], p[7])
}

/// T ẋ/√(x² + T²ẋ²): relative increase of the force by the damping of a contact at rest.
///
/// Where |T ẋ| is small beside the depth, k x times this is k T ẋ: the damper of a contact under
/// load. It never exceeds the force of the spring, so that it does not pull, and both vanish at the
/// depth 0, so that the force has no jump there. Times k x it is Lipschitz continuous.
#[inline(always)]
fn settling<S: Scalar>(time: S, depth: S, rate: S) -> S {
    let lag = time * rate;
    let square = depth * depth + lag * lag;
    lag / S::select(square.positive(), square, S::one()).sqrt()
}

impl FrameForce for Law {
    // F = k x max(0, 1 + c ẋ + T ẋ/√(x² + T²ẋ²)) n − μ F_n v_t/√(v_t² + s²), at the lowest point,
    // −r n from the sphere's centre
    #[inline(always)]
    fn wrench<S: Scalar>(p: &[S], at: &Station<S>) -> Wrench<S> {
        let n = normal(p);
        let turn = &at.placement.rotation;
        let (omega, centre) = (rotate(turn, at.twist.angular), rotate(turn, at.twist.linear));
        let arm = -(n * p[0]);
        let velocity = centre + omega.cross(&arm);
        let along = n.dot(&velocity);
        let x = depth(p, at);
        let push = p[1] * x * ramp(S::one() - p[2] * along - settling(p[9], x, along));
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
