//! Recursive Newton–Euler algorithm.
//!
//! Two sweeps in body axes. Instead of spatial accelerations it carries ω, ω̇ and the classical acceleration of each origin, and
//! applies them through U = [ω̇]× + [ω]×[ω]×, so that no linear velocity is ever formed (Luh, Walker & Paul, *ASME J. Dyn. Syst. Meas.
//! Control* 102, 1980, 69–76; the rate matrix after Balafoutis & Patel, *Dynamic Analysis of Robot Manipulators*, 1991, ch. 4).
//! The plain matrix form is [`super::textbook`].

use super::Workspace;
use crate::joint::{JointLaw, Pose};
use crate::model::{Body, Model};
use crate::spatial::{Motion, Vector3, Wrench, rate_matrix, rotate, rotate_back};
use crate::{Scalar, with_pose};

/// τ = M(q)·a + h(q, v), gravity included.
///
/// q: `[nq]` rad|m|quaternion; v, a: `[nv]` rad/s|m/s and their derivatives; tau: `[nv]` N·m|N. Featherstone 2008, Table 5.1.
///
/// # Panics
/// If a slice is shorter than stated; [`super::Function::call`] and [`crate::dynamics::Dynamics`] check and return an error.
pub fn inverse_dynamics<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], v: &[S], a: &[S], tau: &mut [S]) {
    // V̇_0 = [0; −g]
    ws.bodies[0].motion.acceleration = -model.gravity;
    for i in model.outward() {
        let body = &model.bodies[i];
        let pose = body.joint.pose(&body.coordinates, q);
        with_pose!(pose, p => outward(&model.bodies[i], i, p, pose, ws, v, a));
    }
    tau.fill(S::zero());
    for i in model.inward() {
        let body = &model.bodies[i];
        if let Some(pose) = ws.bodies[i].pose {
            with_pose!(pose, p => inward(body, i, &p, ws, tau));
        }
    }
}

/// h(q, v) = τ at a = 0: Coriolis, centrifugal and gravity forces.
///
/// q: `[nq]`; v: `[nv]`; out: `[nv]` N·m|N.
///
/// # Panics
/// As [`inverse_dynamics`].
pub fn bias_forces<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], v: &[S], out: &mut [S]) {
    let zeros = core::mem::take(&mut ws.zeros);
    inverse_dynamics(model, ws, q, v, &zeros, out);
    ws.zeros = zeros;
}

/// g(q) = τ at v = a = 0: what holds the robot still against gravity.
///
/// q: `[nq]`; out: `[nv]` N·m|N.
///
/// # Panics
/// As [`inverse_dynamics`].
pub fn gravity_torque<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], out: &mut [S]) {
    let zeros = core::mem::take(&mut ws.zeros);
    inverse_dynamics(model, ws, q, &zeros, &zeros, out);
    ws.zeros = zeros;
}

/// Motion and own wrench of body `i` from its parent's motion.
#[inline(always)]
fn outward<S: Scalar, P: JointLaw<S>>(body: &Body<S>, i: usize, p: P, pose: Pose<S>, ws: &mut Workspace<S>, v: &[S], a: &[S]) {
    let parent = &ws.bodies[body.parent];
    let turn = &body.placement.rotation;
    let origin = p.origin(&body.placement);
    // r̈ = r̈_λ + U_λ p
    let carried = Motion {
        omega: rotate_back(turn, parent.motion.omega),
        alpha: rotate_back(turn, parent.motion.alpha),
        acceleration: rotate_back(turn, parent.motion.acceleration + rotate(&parent.u, origin)),
    };
    let motion = p.motion(carried, &body.coordinates, v, a);
    let u = rate_matrix(motion.omega, motion.alpha);
    let state = &mut ws.bodies[i];
    state.pose = Some(pose);
    state.origin = origin;
    state.motion = motion;
    state.u = u;
    // F_i = [h × r̈ + ∫ r × (U r) dm;  m r̈ + U h]
    state.wrench = body.inertia.wrench(motion.acceleration, &u);
}

/// τ of joint `i`, and its wrench on to the parent.
#[inline(always)]
fn inward<S: Scalar, P: JointLaw<S>>(body: &Body<S>, i: usize, p: &P, ws: &mut Workspace<S>, tau: &mut [S]) {
    let state = &ws.bodies[i];
    let (wrench, origin) = (state.wrench, state.origin);
    // τ_i = S_iᵀ F_i
    p.add_torque(&wrench, &body.coordinates, tau);
    if body.parent == 0 {
        return;
    }
    ws.bodies[body.parent].wrench += to_parent(body, p, origin, &wrench);
}

/// A wrench from the body's frame to its parent's: [R n + p × R f; R f].
#[inline(always)]
pub(super) fn to_parent<S: Scalar, P: JointLaw<S>>(body: &Body<S>, p: &P, origin: Vector3<S>, wrench: &Wrench<S>) -> Wrench<S> {
    let turn = &body.placement.rotation;
    let force = rotate(turn, p.to_joint(wrench.force));
    let moment = rotate(turn, p.to_joint(wrench.moment));
    Wrench { moment: moment + origin.cross(&force), force }
}
