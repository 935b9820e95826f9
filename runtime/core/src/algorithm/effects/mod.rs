//! Effects in the equations of motion: forces on joints and bodies, inertia besides that of links,
//! motors; and their derivatives.

mod bodies;
mod joints;
mod slopes;

use super::Workspace;
use super::common::{Axes, carry, positions, twists};
use crate::Scalar;
use crate::dual::Dual;
use crate::effect::{BodyEffect, Law, Station};
use crate::index::BodyId;
use crate::model::Model;
use crate::spatial::{Placement, Twist, Vector3, Wrench};

pub(super) use bodies::{add_inertia, apply_body_wrenches, articulate_body_effects};
pub(crate) use bodies::{body_damping, body_turning, has_body_damping};
pub(crate) use joints::damping;
pub(super) use joints::{apply_joint_forces, armature, armature_matrix, driven_slopes, input_torque, motor_torque, rotor};
pub(super) use slopes::{on_bodies as body_slopes, on_joints as joint_slopes};

/// Loads of a recursion.
#[derive(Clone, Copy)]
pub(super) struct LoadCase<'a, S> {
    /// In the world frame, m/s².
    pub(super) gravity: Vector3<S>,
    /// Whether forces of effects count.
    pub(super) forces: bool,
    /// Whether rotors and added mass count.
    pub(super) inertia: bool,
    /// `[frames][6]` on the frames, N·m and N, as [`Model::wrench_reference`] says, or empty.
    pub(super) wrenches: &'a [S],
}

impl<'a, S: Scalar> LoadCase<'a, S> {
    /// The robot's own.
    pub(super) fn of(model: &Model<S>, wrenches: &'a [S]) -> Self {
        Self { gravity: model.gravity, forces: true, inertia: true, wrenches }
    }

    /// Neither gravity nor forces.
    pub(super) fn empty() -> Self {
        Self { gravity: Vector3::zeros(), forces: false, inertia: true, wrenches: &[] }
    }

    /// The links alone.
    pub(super) fn bare() -> Self {
        Self { inertia: false, ..Self::empty() }
    }
}

/// Whether an effect acts on a body.
pub(super) fn any_on_bodies<S: Scalar>(model: &Model<S>) -> bool {
    model.bodies.iter().any(|b| !b.effects.body.is_empty())
}

/// No effect has more parameters.
const MOST: usize = 24;

const _: () = assert!(crate::effect::most_parameters() <= MOST);

/// Parameters as constants with no derivative: the first `p.len()` of them.
fn duals<S: Scalar>(p: &[S]) -> [Dual<S>; MOST] {
    core::array::from_fn(|k| Dual::constant(p.get(k).copied().unwrap_or_else(S::zero)))
}

/// The frame of an effect on a body with pose `x_wb` and velocity `twist`, in the body's axes.
fn station<S: Scalar>(effect: &BodyEffect<S>, x_wb: &Placement<S>, twist: &Twist<S>, gravity: Vector3<S>) -> Station<S> {
    let Placement { rotation, position } = &effect.placement;
    Station { placement: x_wb.compose(&effect.placement), twist: twist.at(*position).turned_back(rotation), gravity }
}

/// A wrench in the frame of an effect, in that of the body.
fn on_body<S: Scalar>(effect: &BodyEffect<S>, w: &Wrench<S>) -> Wrench<S> {
    w.turned(&effect.placement.rotation).shifted(effect.placement.position)
}

/// The station of an effect on body `i`, after sweeps in world axes.
fn station_in_base<S: Scalar>(model: &Model<S>, ws: &Workspace<S>, i: BodyId, effect: &BodyEffect<S>) -> Station<S> {
    let state = &ws.common[i];
    let x_wb = Placement { rotation: state.rotation, position: state.position };
    station(effect, &x_wb, &state.twist.turned_back(&state.rotation), model.gravity)
}

/// Placements and twists of all bodies in world axes.
fn places<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], v: &[S]) {
    positions(model, ws, Axes::Base, q);
    twists(model, ws, Axes::Base, v);
}

/// The generalised forces of all effects but gravity, inertia and motors: M a + (Coriolis,
/// centrifugal and gravity forces) = τ + these.
///
/// q: `[nq]`; v: `[nv]`; out: `[nv]` N·m|N.
///
/// # Panics
/// If a slice is shorter than stated; [`super::Function::call`] and [`crate::dynamics::Dynamics`]
/// check and return an error.
pub fn effect_forces<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], v: &[S], out: &mut [S]) {
    out.fill(S::zero());
    apply_joint_forces(model, q, v, out);
    out.iter_mut().for_each(|x| *x = -*x);
    if !any_on_bodies(model) {
        return;
    }
    places(model, ws, q, v);
    for i in model.outward() {
        let mut total = Wrench::zero();
        for effect in &model.bodies[i].effects.body {
            if let Law::Wrench { wrench, .. } = effect.effect.law::<S>() {
                total += on_body(effect, &wrench(&effect.parameters, &station_in_base(model, ws, i, effect)));
            }
        }
        let w = total.turned(&ws.common[i].rotation);
        if !model.bodies[i].effects.body.is_empty() {
            // τ = Jᵀ w
            carry(model, ws, i, [w], |_, [w], column| out[column.at] += w.power(&column.axis));
        }
    }
}

/// The power of the effects that are not conservative, W: negative where they take energy.
///
/// q: `[nq]`; v: `[nv]`; out: one number. d(T + U)/dt = vᵀτ + this, with τ of the motors and U the
/// [`super::potential_energy`].
///
/// # Panics
/// As [`effect_forces`].
pub fn dissipation<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], v: &[S], out: &mut [S]) {
    out[0] = joints::dissipation(model, q, v);
    if !any_on_bodies(model) {
        return;
    }
    places(model, ws, q, v);
    for i in model.outward() {
        for effect in model.bodies[i].effects.body.iter().filter(|e| !e.effect.row().conservative) {
            let Law::Wrench { wrench, rise, .. } = effect.effect.law::<S>() else { continue };
            let at = station_in_base(model, ws, i, effect);
            // ẇ = wᵀV + dE/dt
            let stored = rise(&duals(&effect.parameters)[..effect.parameters.len()], &at.moved(&at.twist, &Twist::zero()));
            out[0] += wrench(&effect.parameters, &at).power(&at.twist) + stored.slope;
        }
    }
}

/// The energy that effects store, J; after [`positions`] in world axes.
pub(super) fn energy<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S]) -> S {
    let mut sum = joints::energy(model, q);
    for i in model.outward() {
        ws.common[i].twist = Twist::zero();
        for effect in &model.bodies[i].effects.body {
            if let Law::Wrench { energy, .. } = effect.effect.law::<S>() {
                sum += energy(&effect.parameters, &station_in_base(model, ws, i, effect));
            }
        }
    }
    sum
}

impl<S: Scalar> Model<S> {
    /// Whether there are motors between the input torques of forward dynamics and the joints.
    pub fn has_motors(&self) -> bool {
        joints::all(self).any(|one| one.is_motor())
    }
}

/// The torques that motors deliver when commanded.
///
/// v: `[nv]`; tau: `[nv]` N·m|N, at the joints; out: `[nv]`. Joints without a motor get the
/// commanded torque.
///
/// # Panics
/// As [`effect_forces`].
pub fn motor_torques<S: Scalar>(model: &Model<S>, _: &mut Workspace<S>, v: &[S], tau: &[S], out: &mut [S]) {
    motor_torque(model, v, tau, out);
}
