//! Articulated-body algorithm.
//!
//! Featherstone 2008, Table 7.1, in body axes with classical accelerations, as [`super::rnea`] has
//! them: the bias acceleration of a joint and the bias wrench of a body then need no linear
//! velocity. Effects are in [`super::effects`]: forces of those on joints count as torques, a
//! rotor's inertia is part of the pivot. The degrees of freedom of one joint are eliminated one
//! after the other.

use super::effects::{self, LoadCase};
use super::forward_dynamics::by_equation;
use super::workspace::Column;
use super::{Workspace, wrenches};
use crate::Scalar;
use crate::index::BodyId;
use crate::joint::with_pose;
use crate::joint::{JointLaw, Mount};
use crate::model::Model;
use crate::spatial::{ArticulatedInertia, Matrix3, Motion, Twist, Vector3, rate_matrix, rotate};

/// a = M(q)⁻¹·(τ − h(q, v)), in a time that grows with the number of joints.
///
/// q: `[nq]`; v: `[nv]`; tau: `[nv]` N·m|N; out: `[nv]` rad/s²|m/s². For models in which no joint
/// follows another. If M is singular to working precision, a pivot is only rounding error, and the
/// result is infinite, NaN, or finite and meaningless; [`super::checked_forward_dynamics`] reports
/// it. A model with [`Model::massless_joints`] is singular everywhere.
///
/// # Panics
/// If a slice is shorter than stated; [`super::Function::call`] and [`crate::dynamics::Dynamics`]
/// check and return an error.
pub fn articulated_body<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], v: &[S], tau: &[S], out: &mut [S]) {
    articulated_body_with_wrenches(model, ws, q, v, tau, &[], out);
}

/// As [`articulated_body`], with external wrenches on the frames.
///
/// wrenches: `[frames][6]` N·m and N, as [`Model::wrench_reference`] says, or empty.
///
/// # Panics
/// As [`articulated_body`].
pub fn articulated_body_with_wrenches<S: Scalar>(
    model: &Model<S>,
    ws: &mut Workspace<S>,
    q: &[S],
    v: &[S],
    tau: &[S],
    wrenches: &[S],
    out: &mut [S],
) {
    let value = |ws: &mut Workspace<S>, out: &mut [S]| solve(model, ws, q, v, tau, &LoadCase::of(model, wrenches), out);
    by_equation(model, ws, (q, v, tau, wrenches), out, value, |ws, b| {
        let torque = b.to_vec();
        solve_by_articulated_body(model, ws, q, &torque, b);
    });
}

/// M(q)⁻¹·τ: forward dynamics at rest and without gravity.
///
/// # Panics
/// As [`articulated_body`].
pub fn solve_by_articulated_body<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], tau: &[S], out: &mut [S]) {
    let mut rest = core::mem::take(&mut ws.row);
    rest.fill(S::zero());
    solve(model, ws, q, &rest, tau, &LoadCase::empty(), out);
    ws.row = rest;
}

/// Forward dynamics in a world.
fn solve<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], v: &[S], tau: &[S], load: &LoadCase<S>, out: &mut [S]) {
    ws.set_poses(model, q);
    for i in model.outward() {
        velocity(model, ws, i, q, v);
    }
    // p_i −= w
    wrenches::each(model, ws, q, load.wrenches, |ws, i, w| ws.bodies[i].wrench = ws.bodies[i].wrench - *w);
    effects::articulate_body_effects(model, ws, q, v, load);
    let mut tau = effects::input_torque(model, ws, q, v, tau, load);
    for i in model.inward() {
        eliminate_joint(model, ws, i, &tau);
    }
    core::mem::swap(&mut ws.driven, &mut tau);
    ws.common[BodyId::BASE].acceleration = Twist { angular: Vector3::zeros(), linear: -load.gravity };
    for i in model.outward() {
        accelerate(model, ws, i, out);
    }
}

/// ω, the bias acceleration c, the bias wrench p and the placement in the parent of body `i`, and S
/// of its joint.
fn velocity<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, i: BodyId, q: &[S], v: &[S]) {
    let body = &model.bodies[i];
    let pose = ws.bodies[i].pose;
    let omega = ws.bodies[body.parent].motion.omega;
    let (zeros, zero) = (core::mem::take(&mut ws.zeros), Vector3::zeros());
    with_pose!(pose, p => {
        let mount = Mount::new(p, &body.placement);
        // The point of the parent accelerates by U_λ p = ω × (ω × p) more than the parent's origin
        // does.
        let carried = Motion { omega, alpha: zero, acceleration: rotate(&ws.bodies[body.parent].u, mount.origin) };
        ws.bodies[i].motion = p.motion(carried, |vector| mount.outward(vector), &body.coordinates, [q, v, &zeros]);
        for (k, c) in ws.columns_of(i).enumerate() {
            ws.columns[c].axis = p.subspace(&Matrix3::identity(), k);
        }
    });
    ws.zeros = zeros;
    ws.bodies[i].u = rate_matrix(ws.bodies[i].motion.omega, zero);
    ws.bodies[i].wrench = body.inertia.wrench(zero, &ws.bodies[i].u);
    ws.articulated[i] = ArticulatedInertia::rigid(&body.inertia);
}

/// Eliminates the joint of body `i`, and shifts the articulated inertia and the bias wrench that
/// remain to the parent.
fn eliminate_joint<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, i: BodyId, tau: &[S]) {
    let pose = ws.bodies[i].pose;
    let (mut inertia, mut bias) = (ws.articulated[i], ws.bodies[i].wrench);
    for (k, c) in ws.columns_of(i).enumerate() {
        let column = &mut ws.columns[c];
        // U = I S;  D = SᵀU;  u = τ − Sᵀp
        column.u = inertia.apply(&column.axis);
        let own = ws.diagonal.get(column.at).copied().flatten();
        let rotor = [effects::rotor(model, i, k), own].into_iter().flatten().reduce(|rotor, own| rotor + own);
        let pivot = column.u.power(&column.axis);
        column.inverse = S::one() / rotor.map_or(pivot, |rotor| pivot + rotor);
        column.residue = tau[column.at] - bias.power(&column.axis);
        // I −= U Uᵀ / D;  p += U u / D
        inertia = inertia.eliminating(&column.u, column.inverse);
        bias += column.u.times(column.residue * column.inverse);
        if let (Some(k), None) = (pose.freedom(k), rotor) {
            // I S = 0;  Sᵀp = τ
            inertia = inertia.without(k);
            *bias.number(k) = tau[column.at];
        }
    }
    let parent = model.bodies[i].parent;
    if parent == BodyId::BASE {
        return;
    }
    // p += I c
    let motion = &ws.bodies[i].motion;
    bias += inertia.apply(&Twist { angular: motion.alpha, linear: motion.acceleration });
    with_pose!(pose, p => {
        let mount = Mount::new(p, &model.bodies[i].placement);
        ws.articulated[parent] += mount.articulated(&inertia);
        ws.bodies[parent].wrench += mount.wrench(&bias);
    });
}

/// a of the joint of body `i`, and the acceleration of the body.
fn accelerate<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, i: BodyId, out: &mut [S]) {
    let pose = ws.bodies[i].pose;
    let (body, motion) = (&model.bodies[i], &ws.bodies[i].motion);
    // a' = X a_λ + c
    let mut acceleration = with_pose!(pose, p => {
        let mount = Mount::new(p, &body.placement);
        let carried = ws.common[body.parent].acceleration.at(mount.origin);
        Twist { angular: mount.outward(carried.angular) + motion.alpha, linear: mount.outward(carried.linear) + motion.acceleration }
    });
    for c in ws.columns_of(i).rev() {
        let Column { at, axis, u, inverse, residue, .. } = ws.columns[c];
        // q̈ = (u − Uᵀ a') / D;  a = a' + S q̈
        out[at] = (residue - u.power(&acceleration)) * inverse;
        acceleration = acceleration + axis.times(out[at]);
    }
    ws.common[i].acceleration = acceleration;
}
