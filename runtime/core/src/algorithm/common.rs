//! The outward sweep in common axes, the source of all functions over pairs of joints.
//!
//! All bodies of a tree are expressed in the same axes, each about its own origin. To carry a
//! wrench from body to body takes a cross product and no rotation, and no moment is taken about a
//! far point, where it would cancel. The axes are those of the world frame, or ([`Axes::Tree`])
//! those of the body in the middle of the tree: the fewer joints lie between, the more zeros there
//! are. Or those of its first body: gravity is constant there if its joint is upright, and so are
//! the axes of joints that are parallel to the next one. Dynamics do not depend on the speed of the
//! base either: if a tree hangs on a floating joint, its inertial frame moves with that joint's
//! body.

use super::Workspace;
use super::workspace::{Column, CommonState};
use crate::Scalar;
use crate::index::BodyId;
use crate::joint::JointLaw;
use crate::joint::with_pose;
use crate::model::{Body, Model};
use crate::spatial::{CoriolisInertia, Matrix3, Placement, Twist, Vector3, Wrench, rotate};

/// Which axes are common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Axes {
    /// Those of the world frame.
    Base,
    /// For each tree, those of the body in its center ([`Workspace::centers`]).
    Tree,
}

/// Rotation and origin of every body, and the columns of S.
pub(super) fn positions<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, axes: Axes, q: &[S]) {
    ws.set_poses(model, q);
    for i in model.outward() {
        ws.common[i].base = Matrix3::identity();
    }
    if axes == Axes::Tree {
        from_the_center(model, ws);
    }
    for i in model.outward() {
        position(model, ws, axes, i, q);
    }
}

/// The same in axes of the base, of the bodies alone that are on the way from a frame to the base.
pub(super) fn positions_of_frames<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S]) {
    let mut is_needed = core::mem::take(&mut ws.is_needed);
    is_needed.fill(false);
    for frame in model.frames.iter() {
        let mut i = frame.body;
        while i != BodyId::BASE && !is_needed[i] {
            is_needed[i] = true;
            i = model.bodies[i].parent;
        }
    }
    for i in model.outward().filter(|i| is_needed[*i]) {
        ws.bodies[i].pose = ws.pose(&model.bodies[i], i, q);
        ws.common[i].base = Matrix3::identity();
        position(model, ws, Axes::Base, i, q);
    }
    ws.is_needed = is_needed;
}

/// Rotation and origin of a body, and its columns of S, from those of its parent.
#[inline(always)]
fn position<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, axes: Axes, i: BodyId, q: &[S]) {
    let body = &model.bodies[i];
    let parent = if body.parent == BodyId::BASE {
        CommonState { rotation: ws.common[i].base, ..ws.common[BodyId::BASE] }
    } else {
        ws.common[body.parent]
    };
    with_pose!(ws.bodies[i].pose, p => {
        let state = &mut ws.common[i];
        if axes == Axes::Base || !ws.centers.inside[i] {
            state.rotation = turned(body, &p, &parent.rotation);
        }
        state.shift = rotate(&parent.rotation, p.origin(&body.placement));
        state.position = parent.position + state.shift;
        for (k, c) in ws.columns_of(i).enumerate() {
            let axis = p.subspace(&ws.common[i].rotation, k);
            let (own, at) = (&mut ws.columns[c], &body.coordinates);
            own.axis = at.rate_of_one(q).map_or(axis, |ratio| axis.times(ratio));
            own.bend = at.bend(q).map(|bend| axis.times(bend));
            own.rate_of_bend = at.rate_of_bend(q).map(|rate| axis.times(rate));
        }
    });
}

/// Rotations of the bodies between the center of each tree and the base, and the base's as its
/// first body has it.
fn from_the_center<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>) {
    for &center in &ws.centers.bodies {
        ws.common[center].rotation = Matrix3::identity();
        let mut i = center;
        while i != BodyId::BASE {
            let body = &model.bodies[i];
            // R_λ = R_i X_iᵀ
            let relative = with_pose!(ws.bodies[i].pose, p => turned(body, &p, &Matrix3::identity()));
            let rotation = ws.common[i].rotation * relative.transpose();
            if body.parent == BodyId::BASE {
                ws.common[i].base = rotation;
            } else {
                ws.common[body.parent].rotation = rotation;
            }
            i = body.parent;
        }
    }
}

/// Axes of the body, from those of its parent.
#[inline(always)]
fn turned<S: Scalar, P: JointLaw<S>>(body: &Body<S>, p: &P, parent: &Matrix3<S>) -> Matrix3<S> {
    p.compose(Placement { rotation: parent * body.placement.rotation, position: Vector3::zeros() }).rotation
}

/// Twist of every body, and ψ̇ = V_λ × S and Ṡ = V_i × S of every column, both with S′ q̇ more of a
/// follower that is not linear; after [`positions`].
pub(super) fn twists<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, axes: Axes, v: &[S]) {
    for i in model.outward() {
        let body = &model.bodies[i];
        let carried = match body.parent {
            // The inertial frame moves with the body's origin: in it, the base moves backward.
            BodyId::BASE if moves_along(body, axes) => {
                let at = body.coordinates.v;
                let velocity = Vector3::new(v[at + 3], v[at + 4], v[at + 5]);
                Twist { angular: Vector3::zeros(), linear: -rotate(&ws.common[i].rotation, velocity) }
            }
            BodyId::BASE => Twist::zero(),
            parent => ws.common[parent].twist.at(ws.common[i].shift),
        };
        // V_i = V_λ + Σ S q̇
        let columns = ws.columns_of(i);
        let joint = columns.clone().fold(Twist::zero(), |sum, c| sum + ws.columns[c].axis.times(v[ws.columns[c].at]));
        let twist = if moves_along(body, axes) { Twist { angular: joint.angular, linear: Vector3::zeros() } } else { carried + joint };
        // For a joint of one degree of freedom Ṡ = ψ̇, since S × S q̇ = 0.
        let alone = columns.len() == 1;
        for c in columns {
            let column = &mut ws.columns[c];
            column.psi_dot = carried.cross(&column.axis);
            column.bend.iter().for_each(|bend| column.psi_dot = column.psi_dot + bend.times(v[column.at]));
            column.s_dot = if alone { column.psi_dot } else { twist.cross(&column.axis) };
        }
        ws.common[i].carried_twist = carried;
        ws.common[i].twist = twist;
    }
}

/// Spatial acceleration of every body, on top of that of the base (−g or zero); after [`twists`].
pub(super) fn accelerations<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, v: &[S], a: &[S], base: Vector3<S>) {
    for i in model.outward() {
        let body = &model.bodies[i];
        let carried = match body.parent {
            BodyId::BASE => Twist { angular: Vector3::zeros(), linear: rotate(&ws.common[i].base, base) },
            parent => ws.common[parent].acceleration.at(ws.common[i].shift),
        };
        // V̇_i = V̇_λ + Σ S q̈ + Ṡ q̇
        let term = |c: usize| ws.columns[c].axis.times(a[ws.columns[c].at]) + ws.columns[c].s_dot.times(v[ws.columns[c].at]);
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

/// The wrench that moves every body by itself, F = G V̇ + B(V) ω; after [`accelerations`] and
/// [`coriolis`].
pub(super) fn forces<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>) {
    for i in model.outward() {
        let state = &mut ws.common[i];
        state.force = state.inertia.apply(&state.acceleration) + state.coriolis.wrench(state.twist.angular);
    }
}

/// Visits the columns on the path from body `i` to the root, each with how far a point is from the
/// origin that the column is about: the point is `from` away from that of body `i`.
#[inline(always)]
pub(super) fn on_the_way<S: Scalar>(
    model: &Model<S>,
    ws: &Workspace<S>,
    i: BodyId,
    from: Vector3<S>,
    mut visit: impl FnMut(&Column<S>, Vector3<S>),
) {
    let (mut j, mut d) = (i, from);
    while !j.is_base() {
        ws.columns_of(j).for_each(|c| visit(&ws.columns[c], d));
        d += ws.common[j].shift;
        j = model.bodies[j].parent;
    }
}

/// Visits the columns of body `i` and of those on the path to the root, with wrenches on `i`
/// carried along: (whether it is of body `i`, wrenches, column).
#[inline(always)]
pub(super) fn carry<S: Scalar, const N: usize>(
    model: &Model<S>,
    ws: &Workspace<S>,
    i: BodyId,
    mut wrenches: [Wrench<S>; N],
    mut visit: impl FnMut(bool, &[Wrench<S>; N], &Column<S>),
) {
    let mut j = i;
    while !j.is_base() {
        for l in ws.columns_of(j) {
            visit(j == i, &wrenches, &ws.columns[l]);
        }
        for w in &mut wrenches {
            *w = ws.common[j].shift_to_parent(w);
        }
        j = model.bodies[j].parent;
    }
}

/// Whether the inertial frame moves with the body.
fn moves_along<S: Scalar>(body: &Body<S>, axes: Axes) -> bool {
    axes == Axes::Tree && body.parent == BodyId::BASE && body.joint.is_unconstrained()
}

impl<S: Scalar> CommonState<S> {
    /// A wrench on this body, as one on its parent.
    #[inline(always)]
    pub(super) fn shift_to_parent(&self, wrench: &Wrench<S>) -> Wrench<S> {
        wrench.shifted(self.shift)
    }
}
