//! Articulated-body algorithm.
//!
//! Featherstone 2008, Table 7.1, in body axes with classical accelerations, as [`super::rnea`] has them: the bias acceleration of a joint and the bias wrench of
//! a body then need no linear velocity. A joint with several degrees of freedom gives way in one after the other.

use super::workspace::Column;
use super::{Workspace, wrenches};
use crate::joint::JointLaw;
use crate::model::Model;
use crate::spatial::{ArticulatedInertia, Matrix3, Motion, Twist, Vector3, rate_matrix, rotate, rotate_back};
use crate::{Scalar, with_pose};

/// a = M(q)⁻¹·(τ − h(q, v)), in a time that grows with the number of joints.
///
/// q: `[nq]`; v: `[nv]`; tau: `[nv]` N·m|N; out: `[nv]` rad/s²|m/s². For models in which no joint follows another. Where M is singular the result is not
/// finite; a model with [`Model::massless_joints`] is singular everywhere.
///
/// # Panics
/// If a slice is shorter than stated; [`super::Function::call`] and [`crate::dynamics::Dynamics`] check and return an error.
pub fn articulated_body<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], v: &[S], tau: &[S], out: &mut [S]) {
    solve(model, ws, q, v, tau, &[], model.gravity, out);
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
    solve(model, ws, q, v, tau, wrenches, model.gravity, out);
}

/// M(q)⁻¹·τ: forward dynamics at rest and without gravity.
///
/// # Panics
/// As [`articulated_body`].
pub fn solve_by_articulated_body<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], tau: &[S], out: &mut [S]) {
    let mut rest = core::mem::take(&mut ws.row);
    rest.fill(S::zero());
    solve(model, ws, q, &rest, tau, &[], Vector3::zeros(), out);
    ws.row = rest;
}

#[allow(clippy::too_many_arguments)]
// Why: all that forward dynamics depends on.
fn solve<S: Scalar>(
    model: &Model<S>,
    ws: &mut Workspace<S>,
    q: &[S],
    v: &[S],
    tau: &[S],
    wrenches: &[S],
    gravity: Vector3<S>,
    out: &mut [S],
) {
    for i in model.outward() {
        velocity(model, ws, i, q, v);
    }
    // p_i −= w
    wrenches::each(model, ws, q, wrenches, |ws, i, w| ws.bodies[i].wrench = ws.bodies[i].wrench - *w);
    for i in model.inward() {
        give_way(model, ws, i, tau);
    }
    ws.common[0].acceleration = Twist { angular: Vector3::zeros(), linear: -gravity };
    for i in model.outward() {
        accelerate(model, ws, i, out);
    }
}

/// ω, the bias acceleration c, the bias wrench p and the placement in the parent of body `i`, and S of its joint.
fn velocity<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, i: usize, q: &[S], v: &[S]) {
    let body = &model.bodies[i];
    let pose = body.joint.pose(&body.coordinates, q);
    let omega = ws.bodies[body.parent].motion.omega;
    let (zeros, zero) = (core::mem::take(&mut ws.zeros), Vector3::zeros());
    let turn = &body.placement.rotation;
    with_pose!(pose, p => {
        let x_pi = p.compose(body.placement);
        // The point of the parent accelerates by ω × (ω × p) more than the parent's origin does.
        let centripetal = rotate_back(turn, omega.cross(&omega.cross(&x_pi.position)));
        let carried = Motion { omega: rotate_back(turn, omega), alpha: zero, acceleration: centripetal };
        ws.bodies[i].motion = p.motion(carried, &body.coordinates, v, &zeros);
        ws.relative[i] = x_pi;
        for (k, c) in ws.columns_of(i).enumerate() {
            ws.columns[c].axis = p.subspace(&Matrix3::identity(), k);
        }
    });
    ws.zeros = zeros;
    ws.bodies[i].wrench = body.inertia.wrench(zero, &rate_matrix(ws.bodies[i].motion.omega, zero));
    ws.articulated[i] = ArticulatedInertia::rigid(&body.inertia);
}

/// Lets the joint of body `i` give way, and hands what is left to the parent.
fn give_way<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, i: usize, tau: &[S]) {
    let (mut inertia, mut bias) = (ws.articulated[i], ws.bodies[i].wrench);
    for c in ws.columns_of(i) {
        let column = &mut ws.columns[c];
        // U = I S;  D = SᵀU;  u = τ − Sᵀp
        column.held = inertia.apply(&column.axis);
        column.inverse = S::one() / column.held.power(&column.axis);
        column.residue = tau[column.at] - bias.power(&column.axis);
        // I −= U Uᵀ / D;  p += U u / D
        inertia = inertia.giving_way(&column.held, column.inverse);
        bias += column.held.times(column.residue * column.inverse);
    }
    let parent = model.bodies[i].parent;
    if parent == 0 {
        return;
    }
    // p += I c
    let motion = &ws.bodies[i].motion;
    bias += inertia.apply(&Twist { angular: motion.alpha, linear: motion.acceleration });
    let x_pi = ws.relative[i];
    ws.articulated[parent] += inertia.moved(&x_pi);
    let (moment, force) = (rotate(&x_pi.rotation, bias.moment), rotate(&x_pi.rotation, bias.force));
    ws.bodies[parent].wrench += crate::spatial::Wrench { moment, force }.shifted(x_pi.position);
}

/// a of the joint of body `i`, and the acceleration of the body.
fn accelerate<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, i: usize, out: &mut [S]) {
    let x_pi = ws.relative[i];
    let motion = &ws.bodies[i].motion;
    let carried = ws.common[model.bodies[i].parent].acceleration.at(x_pi.position);
    // a' = X a_λ + c
    let mut acceleration = Twist {
        angular: rotate_back(&x_pi.rotation, carried.angular) + motion.alpha,
        linear: rotate_back(&x_pi.rotation, carried.linear) + motion.acceleration,
    };
    for c in ws.columns_of(i).rev() {
        let Column { at, axis, held, inverse, residue, .. } = ws.columns[c];
        // q̈ = (u − Uᵀ a') / D;  a = a' + S q̈
        out[at] = (residue - held.power(&acceleration)) * inverse;
        acceleration = acceleration + axis.times(out[at]);
    }
    ws.common[i].acceleration = acceleration;
}
