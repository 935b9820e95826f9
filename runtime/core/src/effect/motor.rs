//! A motor: the torque at the joint for a commanded torque.

use super::{Field, smooth_sign};
use crate::Scalar;

pub(super) const FIELDS: &[Field] = &[
    Field::number("torque", "N·m|N", "largest torque of the motor, at a standstill").positive(),
    Field::number("speed", "rad/s|m/s", "speed of the motor at which it has no torque left").positive(),
    Field::number("gear", "1", "revolutions of the motor per revolution of the joint").positive().or(&[1.0]),
    Field::number("efficiency", "1", "of the gear").positive().at_most(1.0).or(&[1.0]),
    Field::number("smooth", "rad/s|m/s", "rate of the joint below which the loss is smooth").smooth().or(&[1e-3]),
];

/// The torque at the joint for the requested `tau` at the rate `v`: within ±T(1 ∓ v/v₀) and ±T,
/// with T = torque·gear and v₀ = speed/gear, less the loss (1 − η) |τ| v/√(v² + s²).
#[inline(always)]
pub(super) fn torque<S: Scalar>(p: &[S], tau: S, v: S) -> S {
    let (most, part) = (p[0] * p[2], v * p[2] / p[1]);
    let one = S::one();
    // The braking torque does not exceed the torque at standstill.
    let upper = most * clamp(one - part, S::zero(), one);
    let lower = -(most * clamp(one + part, S::zero(), one));
    let given = clamp(tau, lower, upper);
    given - (one - p[3]) * given.abs() * smooth_sign(v, p[4])
}

#[inline(always)]
fn clamp<S: Scalar>(x: S, lower: S, upper: S) -> S {
    let x = S::select((x - upper).positive(), upper, x);
    S::select((lower - x).positive(), lower, x)
}
