//! Recursive Newton–Euler algorithm.
//!
//! Two sweeps in body axes. Instead of spatial accelerations it carries ω, ω̇ and the classical
//! acceleration of each origin, and applies them through U = [ω̇]× + [ω]×[ω]×, so that no linear
//! velocity is ever formed (Luh, Walker & Paul, *ASME J. Dyn. Syst. Meas. Control* 102, 1980,
//! 69–76; the rate matrix after Balafoutis & Patel, *Dynamic Analysis of Robot Manipulators*, 1991,
//! ch. 4). Bodies may have U by the axis of their joint, which accelerates alike in both of its
//! bodies, in place of ω̇ ([`AngularKinematics`]). The plain matrix form is [`super::textbook`].

use super::effects::{self, LoadCase};
use super::{AngularKinematics, Workspace, wrenches};
use crate::Scalar;
use crate::index::BodyId;
use crate::joint::with_pose;
use crate::joint::{JointLaw, Mount};
use crate::model::{Body, Model};
use crate::spatial::{Motion, Placement, rate_matrix, rates_about, rotate};

/// τ = M(q)·a + h(q, v) − Σ Jᵀw, with external wrenches w on the frames.
///
/// q: `[nq]` rad|m|quaternion; v, a: `[nv]` rad/s|m/s and their derivatives, or empty for zeros;
/// wrenches: `[frames][6]` N·m and N, as [`Model::wrench_reference`] says, or empty; tau: `[nv]`
/// N·m|N. Gravity included. Featherstone 2008, Table 5.1.
///
/// # Panics
/// If a slice is shorter than stated; [`super::Function::call`] and [`crate::dynamics::Dynamics`]
/// check and return an error.
#[inline]
pub fn inverse_dynamics_with_wrenches<S: Scalar>(
    model: &Model<S>,
    ws: &mut Workspace<S>,
    q: &[S],
    v: &[S],
    a: &[S],
    wrenches: &[S],
    tau: &mut [S],
) {
    let zeros = core::mem::take(&mut ws.zeros);
    let [v, a] = [v, a].map(|x| if x.is_empty() { &zeros } else { x });
    recursion(model, ws, q, v, a, &LoadCase::of(model, wrenches), tau);
    ws.zeros = zeros;
}

/// M(q)·v, the generalised momentum: inverse dynamics of the acceleration v at rest and in an empty
/// world.
pub(super) fn momentum<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], v: &[S], load: &LoadCase<S>, out: &mut [S]) {
    let zeros = core::mem::take(&mut ws.zeros);
    recursion(model, ws, q, &zeros, v, load, out);
    ws.zeros = zeros;
}

/// Inverse dynamics in a world.
#[inline(always)]
pub(super) fn recursion<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], v: &[S], a: &[S], load: &LoadCase<S>, tau: &mut [S]) {
    // V̇_0 = [0; −g]
    ws.bodies[BodyId::BASE].motion.acceleration = -load.gravity;
    let features = ModelFeatures::of(model);
    // A sweep for each, as one with both takes a quarter longer on numbers.
    if ws.formulation.kinematics.is_empty() && ws.formulation.torque_inertias.is_empty() {
        outward_sweep::<S, false>(model, ws, q, v, a);
    } else {
        outward_sweep::<S, true>(model, ws, q, v, a);
    }
    // F_i −= w
    wrenches::each(model, ws, q, load.wrenches, |ws, i, w| ws.bodies[i].wrench = ws.bodies[i].wrench - *w);
    if features.on_bodies {
        effects::apply_body_wrenches(model, ws, q, v, load);
    }
    tau.fill(S::zero());
    for i in model.inward() {
        let body = &model.bodies[i];
        with_pose!(ws.bodies[i].pose, p => inward(body, i, &p, ws, q, tau));
    }
    if load.inertia && features.on_joints {
        effects::armature(model, [q, v, a], tau);
    }
    if load.forces && features.on_joints {
        effects::apply_joint_forces(model, q, v, tau);
    }
}

/// Features of a model that a recursion handles, found in one pass over its bodies: with one pass
/// for each, inverse dynamics takes a twentieth longer on numbers.
#[derive(Default)]
struct ModelFeatures {
    on_bodies: bool,
    on_joints: bool,
}

impl ModelFeatures {
    #[inline(always)]
    fn of<S>(model: &Model<S>) -> Self {
        let mut features = Self::default();
        for body in &model.bodies {
            features.on_bodies |= !body.effects.body.is_empty();
            features.on_joints |= !body.effects.joint.is_empty();
        }
        features
    }
}

/// The wrench that each joint passes to its child link, gravity included: the torque is its
/// component along the joint.
///
/// q: `[nq]`; v, a: `[nv]`; out: `[links][6]`, N·m and N, in axes of the link about its origin. The
/// model must be as it was read: a pass that moves mass between bodies changes these wrenches.
///
/// # Panics
/// As [`inverse_dynamics_with_wrenches`].
pub fn joint_wrenches<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], v: &[S], a: &[S], out: &mut [S]) {
    let mut tau = core::mem::take(&mut ws.row);
    inverse_dynamics_with_wrenches(model, ws, q, v, a, &[], &mut tau);
    ws.row = tau;
    for (i, out) in model.links().zip(out.chunks_exact_mut(6)) {
        if let Some(link) = &model.bodies[i].link {
            let Placement { rotation, position } = &link.placement;
            out.copy_from_slice(&ws.bodies[i].wrench.shifted(-position).turned_back(rotation).to_array());
        }
    }
}

/// Motion and own wrench of each body, with the formulation's kinematics and inertias or with the
/// default.
fn outward_sweep<S: Scalar, const FORMULATED: bool>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], v: &[S], a: &[S]) {
    ws.set_poses(model, q);
    for i in model.outward() {
        let body = &model.bodies[i];
        with_pose!(ws.bodies[i].pose, p => outward::<S, _, FORMULATED>(body, i, p, ws, [q, v, a]));
    }
}

/// Motion and own wrench of body `i` from its parent's motion.
#[inline(always)]
fn outward<S: Scalar, P: JointLaw<S>, const FORMULATED: bool>(body: &Body<S>, i: BodyId, p: P, ws: &mut Workspace<S>, state: [&[S]; 3]) {
    let parent = &ws.bodies[body.parent];
    let mount = Mount::new(p, &body.placement);
    // r̈ = r̈_λ + U_λ p
    let carried = Motion { acceleration: parent.motion.acceleration + rotate(&parent.u, mount.origin), ..parent.motion };
    let mut motion = p.motion(carried, |vector| mount.outward(vector), &body.coordinates, state);
    let formulation = FORMULATED.then_some(&ws.formulation);
    let kinematics = formulation.and_then(|f| f.kinematics.get(i).copied()).unwrap_or_default();
    let u = if FORMULATED && kinematics != AngularKinematics::AngularAcceleration {
        // ë = U_λ e
        let axis = mount.outward(rotate(&parent.u, body.placement.rotation.column(2).into_owned()));
        let (alpha, u) = rates_about(motion.omega, motion.alpha.z, axis, kinematics == AngularKinematics::AxisAccelerationAndDiagonal);
        motion.alpha = alpha;
        u
    } else {
        rate_matrix(motion.omega, motion.alpha)
    };
    let inertia = formulation.and_then(|f| f.torque_inertias.get(i)).unwrap_or(&body.inertia);
    let state = &mut ws.bodies[i];
    state.motion = motion;
    state.u = u;
    // F_i = [h × r̈ + ∫ r × (U r) dm;  m r̈ + U h]
    state.wrench = inertia.wrench(motion.acceleration, &u);
}

/// τ of joint `i`, and its wrench on to the parent.
#[inline(always)]
fn inward<S: Scalar, P: JointLaw<S>>(body: &Body<S>, i: BodyId, p: &P, ws: &mut Workspace<S>, q: &[S], tau: &mut [S]) {
    let wrench = ws.bodies[i].wrench;
    // τ_i = S_iᵀ F_i
    for k in 0..body.joint.nv() {
        tau[body.coordinates.v + k] += body.coordinates.to_leader(q, p.torque(&wrench, k));
    }
    if body.parent == BodyId::BASE {
        return;
    }
    ws.bodies[body.parent].wrench += Mount::new(*p, &body.placement).wrench(&wrench);
}
