//! The outward sweep in common axes, from which everything that pairs joints with joints is read.
//!
//! All bodies of a tree are expressed in the same axes, each about its own origin: to carry a wrench from body to body takes a cross product and no
//! rotation, and no moment is ever taken about a far point, where it would cancel. The axes are those of the base frame, or ([`Axes::Tree`]), where a tree
//! hangs on a floating joint, those of the floating body, in an inertial frame that moves with it: dynamics do not depend on how the base is turned or
//! how fast it moves, and the floating joint's subspace becomes the unit matrix.

use super::Workspace;
use super::workspace::CommonState;
use crate::joint::{Joint, JointLaw};
use crate::model::{Body, Model};
use crate::spatial::{CoriolisInertia, Matrix3, Placement, Twist, Vector3, Wrench, rotate, rotate_back};
use crate::{Scalar, with_pose};

/// Which axes are common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Axes {
    /// Those of the base frame.
    Base,
    /// For each tree, those of its floating body; of the base frame where there is none.
    Tree,
}

/// Rotation and origin of every body, and the columns of S.
pub(super) fn positions<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, axes: Axes, q: &[S]) {
    for i in model.outward() {
        let body = &model.bodies[i];
        let pose = body.joint.pose(&body.coordinates, q);
        let parent = ws.common[body.parent];
        let own = is_own(body, axes);
        with_pose!(pose, p => {
            if own { ws.common[i].place_own() } else { ws.common[i].place(body, &p, &parent) }
            for (k, c) in ws.columns_of(i).enumerate() {
                let axis = p.subspace(&ws.common[i].rotation, k);
                ws.columns[c].axis = body.coordinates.rate_of_one().map_or(axis, |m| axis.times(m));
            }
        });
        ws.bodies[i].pose = Some(pose);
    }
}

/// Twist of every body, and ψ̇ = V_λ × S and Ṡ = V_i × S of every column; after [`positions`].
pub(super) fn twists<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, axes: Axes, v: &[S]) {
    for i in model.outward() {
        let body = &model.bodies[i];
        let carried = if is_own(body, axes) {
            // The inertial frame moves with the body's origin: in it, the base moves backward.
            let at = body.coordinates.v;
            Twist { angular: Vector3::zeros(), linear: -Vector3::new(v[at + 3], v[at + 4], v[at + 5]) }
        } else {
            ws.common[body.parent].twist.at(ws.common[i].shift)
        };
        // V_i = V_λ + Σ S q̇
        let columns = ws.columns_of(i);
        let joint = columns.clone().fold(Twist::zero(), |sum, c| sum + ws.columns[c].axis.times(v[ws.columns[c].at]));
        let twist = if is_own(body, axes) { Twist { angular: joint.angular, linear: Vector3::zeros() } } else { carried + joint };
        for c in columns {
            let column = &mut ws.columns[c];
            column.drift = carried.cross(&column.axis);
            column.rate = twist.cross(&column.axis);
        }
        ws.common[i].carried_twist = carried;
        ws.common[i].twist = twist;
    }
}

/// Spatial acceleration of every body, on top of that of the base (−g, or nothing); after [`twists`].
pub(super) fn accelerations<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, axes: Axes, v: &[S], a: &[S], base: Vector3<S>) {
    for i in model.outward() {
        let body = &model.bodies[i];
        let carried = match (body.parent, ws.bodies[i].pose) {
            (0, Some(pose)) if is_own(body, axes) => {
                let turned = rotate_back(&body.placement.rotation, base);
                Twist { angular: Vector3::zeros(), linear: with_pose!(pose, p => p.to_child(turned)) }
            }
            (0, _) => Twist { angular: Vector3::zeros(), linear: base },
            (parent, _) => ws.common[parent].acceleration.at(ws.common[i].shift),
        };
        // V̇_i = V̇_λ + Σ S q̈ + Ṡ q̇
        let term = |c: usize| ws.columns[c].axis.times(a[ws.columns[c].at]) + ws.columns[c].rate.times(v[ws.columns[c].at]);
        let acceleration = ws.columns_of(i).fold(carried, |sum, c| sum + term(c));
        ws.common[i].carried_acceleration = carried;
        ws.common[i].acceleration = acceleration;
    }
}

/// Inertia of every body; after [`positions`].
pub(super) fn inertias<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>) {
    for i in model.outward() {
        let state = &mut ws.common[i];
        state.inertia = model.bodies[i].inertia.turned(&state.rotation);
    }
}

/// B(V) of every body; after [`twists`] and [`inertias`].
pub(super) fn coriolis<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>) {
    for i in model.outward() {
        let state = &mut ws.common[i];
        state.coriolis = CoriolisInertia::new(&state.inertia, &state.twist);
    }
}

/// The wrench that moves every body by itself, F = G V̇ + B(V) ω; after [`accelerations`] and [`coriolis`].
pub(super) fn forces<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>) {
    for i in model.outward() {
        let state = &mut ws.common[i];
        state.force = state.inertia.apply(&state.acceleration) + state.coriolis.wrench(state.twist.angular);
    }
}

fn is_own<S: Scalar>(body: &Body<S>, axes: Axes) -> bool {
    axes == Axes::Tree && body.parent == 0 && body.joint == Joint::Floating
}

impl<S: Scalar> CommonState<S> {
    #[inline(always)]
    fn place<P: JointLaw<S>>(&mut self, body: &Body<S>, p: &P, parent: &Self) {
        let turn = parent.rotation * body.placement.rotation;
        let x = p.compose(Placement { rotation: turn, position: rotate(&parent.rotation, body.placement.position) });
        (self.rotation, self.shift, self.position) = (x.rotation, x.position, parent.position + x.position);
    }

    /// In its own axes.
    #[inline(always)]
    fn place_own(&mut self) {
        (self.rotation, self.shift, self.position) = (Matrix3::identity(), Vector3::zeros(), Vector3::zeros());
    }

    /// A wrench on this body, as one on its parent.
    #[inline(always)]
    pub(super) fn to_parent(&self, wrench: &Wrench<S>) -> Wrench<S> {
        wrench.shifted(self.shift)
    }
}
