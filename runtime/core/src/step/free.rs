//! Motion of a configuration during a step, joint by joint.

use alloc::vec::Vec;

use crate::Scalar;
use crate::algorithm::Workspace;
use crate::algorithm::manifold::{Space, placement, put, put_quaternion, quaternion, range, six, three};
use crate::model::Model;
use crate::spatial::screw::{Quaternion, right_jacobian_inverse};
use crate::spatial::{rotate, rotate_back};

/// q moved for h by the rates: angular velocities in axes of the child, the velocity of the origin
/// of a floating joint in axes that do not turn, those of its parent.
pub(super) fn moved<S: Scalar>(model: &Model<S>, q: &[S], rates: &[S], h: S, out: &mut [S]) {
    for joint in &model.joints {
        let (q, rates, out) = (&q[range(joint.q)], &rates[range(joint.v)], &mut out[range(joint.q)]);
        match Space::of(joint.kind) {
            Space::Placements => {
                let (position, rotation) = placement(q);
                put(out, &(position + three(&rates[3..]) * h));
                put_quaternion(&mut out[3..], &rotation.product(&Quaternion::exp(three(rates) * h)));
            }
            Space::Rotations => put_quaternion(out, &quaternion(q).product(&Quaternion::exp(three(rates) * h))),
            Space::Numbers => out.iter_mut().zip(q).zip(rates).for_each(|((out, q), rate)| *out = *q + h * *rate),
        }
    }
}

/// Rates whose velocities of origins are in axes of the parent, from those of body twists.
pub(super) fn to_parent<S: Scalar>(model: &Model<S>, q: &[S], v: &[S]) -> Vec<S> {
    turned(model, q, v, |rotation, v| rotate(&rotation.to_rotation(), v))
}

/// Body twists from rates whose velocities of origins are in axes of the parent.
pub(super) fn to_body<S: Scalar>(model: &Model<S>, q: &[S], rates: &[S]) -> Vec<S> {
    turned(model, q, rates, |rotation, v| rotate_back(&rotation.to_rotation(), v))
}

fn turned<S: Scalar>(
    model: &Model<S>,
    q: &[S],
    v: &[S],
    turn: impl Fn(&Quaternion<S>, crate::spatial::Vector3<S>) -> crate::spatial::Vector3<S>,
) -> Vec<S> {
    let mut out = v.to_vec();
    for joint in model.joints.iter().filter(|joint| matches!(Space::of(joint.kind), Space::Placements)) {
        let (_, rotation) = placement(&q[range(joint.q)]);
        put(&mut out[joint.v.0 + 3..], &turn(&rotation, six(&v[range(joint.v)]).linear));
    }
    out
}

/// Accelerations of origins, v̇ + ω × v, in the place of the rates v̇ of body twists.
pub(super) fn of_origins<S: Scalar>(model: &Model<S>, v: &[S], a: &mut [S]) {
    for joint in model.joints.iter().filter(|joint| matches!(Space::of(joint.kind), Space::Placements)) {
        let (twist, at) = (six(&v[range(joint.v)]), joint.v.0 + 3);
        let classical = three(&a[at..]) + twist.angular.cross(&twist.linear);
        put(&mut a[at..], &classical);
    }
}

/// The rates v̇ of body twists, in the place of accelerations of origins v̇ + ω × v.
pub(super) fn of_bodies<S: Scalar>(model: &Model<S>, v: &[S], a: &mut [S]) {
    for joint in model.joints.iter().filter(|joint| matches!(Space::of(joint.kind), Space::Placements)) {
        let (twist, at) = (six(&v[range(joint.v)]), joint.v.0 + 3);
        let rate = three(&a[at..]) - twist.angular.cross(&twist.linear);
        put(&mut a[at..], &rate);
    }
}

/// τ −= h D (ω × v): h D acts on accelerations of origins of floating joints, not on rates v̇ of
/// their body twists.
pub(super) fn act_on_origins<S: Scalar>(model: &Model<S>, ws: &Workspace<S>, v: &[S], tau: &mut [S]) {
    for joint in model.joints.iter().filter(|joint| matches!(Space::of(joint.kind), Space::Placements)) {
        let (twist, first) = (six(&v[range(joint.v)]), joint.v.0 + 3);
        let turning = twist.angular.cross(&twist.linear);
        let is_own = |i: usize| (first..first + 3).contains(&i);
        for i in (first..first + 3).filter(|i| ws.diagonal.get(*i).is_some_and(Option::is_some)) {
            tau[i] -= ws.diagonal[i].unwrap_or(S::zero()) * turning[i - first];
        }
        for &(i, j, own) in &ws.coupled {
            if is_own(j) {
                tau[i] -= own * turning[j - first];
            }
            if is_own(i) {
                tau[j] -= own * turning[i - first];
            }
        }
    }
}

/// u̇ of turns by u at the rates v, whose velocities of origins are in axes of the parent:
/// J_r(u)⁻¹ ω of joints that turn freely, v of everything else.
pub(super) fn turn_rates<S: Scalar>(model: &Model<S>, u: &[S], v: &[S], out: &mut [S]) {
    out.copy_from_slice(v);
    for joint in model.joints.iter().filter(|joint| !matches!(Space::of(joint.kind), Space::Numbers)) {
        let at = joint.v.0;
        put(&mut out[at..], &(right_jacobian_inverse(three(&u[at..])) * three(&v[at..])));
    }
}

/// u̇ of q ⊕ u at the rates v: J_r(u)⁻¹ v of joints that turn freely, v of others. Munthe-Kaas, BIT
/// 38, 1998.
pub(super) fn chart_rates<S: Scalar>(model: &Model<S>, u: &[S], v: &[S], out: &mut [S]) {
    out.copy_from_slice(v);
    for joint in &model.joints {
        let (u, v, out) = (&u[range(joint.v)], &v[range(joint.v)], &mut out[range(joint.v)]);
        match Space::of(joint.kind) {
            Space::Placements => {
                let jacobian = six(u).right_jacobian_inverse();
                for (i, out) in out.iter_mut().enumerate() {
                    *out = (0..6).fold(S::zero(), |sum, k| sum + jacobian[(i, k)] * v[k]);
                }
            }
            Space::Rotations => put(out, &(right_jacobian_inverse(three(u)) * three(v))),
            Space::Numbers => {}
        }
    }
}
