//! Points and frames of two bodies that are held together: connect and weld.
//!
//! ```text
//! connect:  φ = p₁ − p₂                             three rows
//! weld:     φ = [p₁ − p₂;  s vec(q₂⁻¹ q₁)]          six rows, s: m for each unit
//! J a + J̇ v = r,   r = −b φ̇ − k d(|φ|) φ            J: the derivative of φ
//! ```
//!
//! With ω = R₂ᵀ (ω₁ − ω₂) and the quaternion e = q₂⁻¹ q₁: ė = ½ [−ω·vec e;  w ω + ω × vec e].
//! Source: MuJoCo documentation, Computation: equality constraints.

use alloc::vec;
use alloc::vec::Vec;

use super::Soft;
use super::joints::{JointRow, Side};
use super::motion::{Column, Twists};
use crate::Scalar;
use crate::algorithm::Placed;
use crate::index::BodyId;
use crate::model::Model;
use crate::scalar::root;
use crate::spatial::screw::Quaternion;
use crate::spatial::{Placement, Twist, Vector3, rotate_back};

/// Two frames that are held together.
#[derive(Clone, Debug, PartialEq)]
pub struct Anchor<S = f64> {
    /// The bodies; the base for frames of the world.
    pub bodies: [BodyId; 2],
    /// The frames in the frames of their bodies.
    pub placements: [Placement<S>; 2],
    /// The length by which turns are scaled, m. `None`: only the origins are held together.
    pub turns: Option<S>,
    /// How it gives way.
    pub soft: Soft<S>,
    /// The inverse inertia of its rows in the reference pose: of translations, 1/kg, and of turns,
    /// 1/(kg·m²).
    pub weights: [S; 2],
}

impl<S: Scalar> Anchor<S> {
    /// The same with `f` of each constant, always in the same order.
    pub(super) fn map<T: Scalar>(&self, f: impl Fn(S) -> T + Copy) -> Anchor<T> {
        Anchor {
            bodies: self.bodies,
            placements: self.placements.map(|placement| placement.map(f)),
            turns: self.turns.map(f),
            soft: self.soft.map(f),
            weights: self.weights.map(f),
        }
    }
}

/// The motion of all bodies about a point, in axes of the world.
pub(super) struct Moving<'a, S: 'static> {
    pub(super) model: &'a Model<S>,
    pub(super) placed: &'a Placed<'a, S>,
    pub(super) columns: &'a [Column<S>],
    /// The point.
    pub(super) origin: Vector3<S>,
    /// The twists at these rates.
    pub(super) twists: &'a Twists<S>,
}

/// The rows of all anchors in a state.
pub(super) fn rows<S: Scalar>(anchors: &[Anchor<S>], moving: &Moving<'_, S>, rows: &mut Vec<JointRow<S>>) {
    if anchors.is_empty() {
        return;
    }
    let accelerations = moving.accelerations();
    anchors.iter().for_each(|anchor| moving.rows(anchor, &accelerations, rows));
}

impl<S: Scalar> Moving<'_, S> {
    /// The rates of twists at x = 0: of joints whose rates stay, and of floating joints whose
    /// origins move uniformly.
    fn accelerations(&self) -> Twists<S> {
        let mut all: Twists<S> = vec![Twist::zero(); self.model.bodies.len()].into();
        for body in self.model.outward() {
            let parent = self.model.bodies[body].parent;
            let before = self.twists[parent];
            let own = self.twists[body] - before;
            // Ṡ v = V × S v
            let mut rate = all[parent];
            rate.angular += before.angular.cross(&own.angular);
            rate.linear += before.angular.cross(&own.linear) + before.linear.cross(&own.angular);
            if self.model.bodies[body].joint.is_unconstrained() {
                let at = self.placed.frame(body, &Placement::identity()).position - self.origin;
                rate.linear -= own.angular.cross(&(own.linear + own.angular.cross(&at)));
            }
            all[body] = rate;
        }
        all
    }

    fn rows(&self, anchor: &Anchor<S>, accelerations: &Twists<S>, rows: &mut Vec<JointRow<S>>) {
        let half = S::from_f64(0.5);
        let frames = [0, 1].map(|k| {
            let Placement { rotation, position } = match anchor.bodies[k].is_base() {
                true => anchor.placements[k],
                false => self.placed.frame(anchor.bodies[k], &anchor.placements[k]),
            };
            Placement { rotation, position: position - self.origin }
        });
        let points = frames.map(|frame| frame.position);
        let speed = |twist: &Twist<S>, k: usize| twist.linear + twist.angular.cross(&points[k]);
        let twists = anchor.bodies.map(|body| self.twists[body]);
        let rate = |k: usize| {
            let (twist, rate) = (&twists[k], &accelerations[anchor.bodies[k]]);
            speed(rate, k) + twist.angular.cross(&speed(twist, k))
        };
        // e = q₂⁻¹ q₁ and its derivative by ω
        let [first, second] = frames.map(|frame| frame.rotation);
        let error = Quaternion::from_rotation(&(second.transpose() * first)).to_array();
        let (vector, w) = (Vector3::new(error[0], error[1], error[2]), error[3]);
        let turned = |turn: &Vector3<S>| (turn * w + turn.cross(&vector)) * half;
        let spin = rotate_back(&second, twists[0].angular - twists[1].angular);
        let mut violation = (points[0] - points[1]).as_slice().to_vec();
        let mut rates = (speed(&twists[0], 0) - speed(&twists[1], 1)).as_slice().to_vec();
        let mut drift = (rate(0) - rate(1)).as_slice().to_vec();
        if let Some(scale) = anchor.turns {
            let [one, other] = anchor.bodies.map(|body| accelerations[body].angular);
            let spin_rate = rotate_back(&second, one - other) - rotate_back(&second, twists[1].angular).cross(&spin);
            let bent = (spin * (-(half * spin.dot(&vector))) + spin.cross(&turned(&spin))) * half;
            violation.extend((vector * scale).iter());
            rates.extend((turned(&spin) * scale).iter());
            drift.extend(((turned(&spin_rate) + bent) * scale).iter());
        }
        let count = violation.len();
        let mut entries: Vec<Vec<(usize, S)>> = vec![Vec::new(); count];
        for Column { body, at, axis } in self.columns {
            let moves = anchor.bodies.map(|own| !own.is_base() && self.model.is_on_the_way(*body, own));
            let sign = |k: usize| if moves[k] { S::one() } else { S::zero() };
            if moves == [false; 2] {
                continue;
            }
            let linear = speed(axis, 0) * sign(0) - speed(axis, 1) * sign(1);
            let turn = turned(&rotate_back(&second, axis.angular * (sign(0) - sign(1)))) * anchor.turns.unwrap_or(S::zero());
            let all = linear.iter().chain(turn.iter());
            entries.iter_mut().zip(all).for_each(|(row, entry)| row.push((*at, *entry)));
        }
        let size = root(violation.iter().fold(S::zero(), |sum, x| sum + *x * *x));
        for (k, entries) in entries.into_iter().enumerate() {
            let (reference, give) = anchor.soft.row_of(size, violation[k], rates[k], anchor.weights[k / 3]);
            rows.push(JointRow { entries, curvature: S::one() / give, reference: reference - drift[k], side: Side::Both });
        }
    }
}

/// Frames in the world at q `[nq]`, positions in m. `frames`: each with its body, in the frame of
/// the body.
pub fn poses(model: &Model<f64>, q: &[f64], frames: &[(BodyId, Placement<f64>)]) -> Vec<Placement<f64>> {
    let mut ws = crate::algorithm::Workspace::new(model);
    let placed = Placed::at(model, &mut ws, q);
    let of = |(body, placement): &(BodyId, Placement<f64>)| if body.is_base() { *placement } else { placed.frame(*body, placement) };
    frames.iter().map(of).collect()
}
