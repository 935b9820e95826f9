//! Accelerations with constraints: limits, dry friction and contacts; how exact they are, and the
//! forces of contacts.

use alloc::vec;
use alloc::vec::Vec;

use super::{ACT, CONTACTS, CTRL, Drive, FOUND, H, Start, Steps, WARM, free};
use crate::Scalar;
use crate::algorithm::registry::{Group, Inputs, Needs};
use crate::algorithm::{
    Argument, Dim, Function, FunctionId, Port, Variant, Workspace, always, articulated_body_with_wrenches, factorization,
    forward_dynamics_with_wrenches, nothing, untied,
};
use crate::constraint::{CONTACT, Certificate, Smooth, certified, constrained, contact_forces, searched};
use crate::model::Model;
use core::cell::RefCell;

/// Replaces the accelerations without constraints by those with them, and returns Jᵀ f of their
/// forces. `warm`: where the search begins, and where it ended.
pub(super) fn acceleration<S: Scalar>(
    model: &Model<S>,
    ws: &mut Workspace<S>,
    (q, v, given): (&[S], &[S], &[S]),
    warm: &mut Vec<S>,
    a: &mut [S],
) -> Vec<S> {
    if model.constraints.is_empty() {
        free::of_origins(model, v, a);
        warm.copy_from_slice(a);
        free::of_bodies(model, v, a);
        return vec![S::zero(); model.nv];
    }
    free::of_origins(model, v, a);
    let (x, forces) = constrained(model, ws, &Smooth { q, v, a, warm, given });
    warm.copy_from_slice(&x);
    a.copy_from_slice(&x);
    free::of_bodies(model, v, a);
    forces
}

/// The ways of a function by those of forward dynamics: `$run` takes one of them.
macro_rules! ways {
    ($run:ident) => {
        &[
            Variant {
                name: "ABA",
                applies: untied,
                least: nothing,
                run: &|model, ws, inputs, out| $run(model, ws, inputs, articulated_body_with_wrenches, out),
            },
            Variant {
                name: "LTDL",
                applies: always,
                least: factorization,
                run: &|model, ws, inputs, out| $run(model, ws, inputs, forward_dynamics_with_wrenches, out),
            },
        ]
    };
}

#[allow(non_upper_case_globals)]
impl<S: Scalar> Steps<S> {
    pub(super) const constrained_acceleration: Function<S> = Function {
        id: FunctionId::user,
        general: FunctionId::user,
        name: "constrained_acceleration",
        summary: "a with the forces of actuators, limits, dry friction and contacts",
        source: "MuJoCo documentation, Computation: constraint model; Todorov, ICRA 2014",
        takes: &[Argument::Q, Argument::V, ACT, CTRL, WARM],
        gives: &[Dim::Nv],
        outputs: &[],
        unit: "rad/s²|m/s²",
        group: Group::Constraints,
        needs: Needs::MassMatrix,
        regrouped: false,
        contains: &[FunctionId::forward_dynamics_with_wrenches],
        ways: ways!(run),
        unsolved: None,
    };

    pub(super) const constrained_acceleration_with_contacts: Function<S> = Function {
        name: "constrained_acceleration_with_contacts",
        summary: "constrained_acceleration with contacts that a caller finds",
        takes: &[Argument::Q, Argument::V, ACT, CTRL, CONTACTS, WARM],
        group: Group::GivenContacts,
        ..Self::constrained_acceleration
    };

    pub(super) const constrained_search: Function<S> = Function {
        name: "constrained_search",
        summary: "the search of constrained_acceleration: what it finds, no less than ‖a − optimum‖_M, ‖a₀‖_M, and its steps",
        source: "Boyd & Vandenberghe, Convex Optimization, 2004, §9.1.2",
        gives: &[],
        outputs: &[
            Port::new("found", &[Dim::Nv], "rad/s²|m/s², `warm_next` of a step"),
            ERROR,
            SIZE,
            Port::new("steps", &[], "1, steps of Newton's method"),
        ],
        unit: "",
        ways: ways!(search),
        ..Self::constrained_acceleration
    };

    pub(super) const constrained_error: Function<S> = Function {
        name: "constrained_error",
        summary: "how far any acceleration is from constrained_acceleration: no less than ‖a − optimum‖_M, and ‖a₀‖_M",
        source: "Boyd & Vandenberghe, Convex Optimization, 2004, §9.1.2",
        takes: &[Argument::Q, Argument::V, ACT, CTRL, FOUND],
        gives: &[],
        outputs: &[ERROR, SIZE],
        unit: "",
        ways: ways!(certify),
        ..Self::constrained_acceleration
    };

    pub(super) const contact_forces: Function<S> = Function {
        name: "contact_forces",
        summary: "for each place of contact 1, its point, normal, force and moment in axes of the world; 0 where nothing touches",
        source: "MuJoCo documentation, Computation: constraint model",
        takes: &[Argument::Q, Argument::V, FOUND],
        gives: &[Dim::Contacts, Dim::Of(CONTACT)],
        unit: "1, m, 1, N, N·m",
        needs: Needs::Nothing,
        contains: &[],
        ways: &[Variant {
            name: "direct",
            applies: always,
            least: nothing,
            run: &|model, ws, inputs, out| {
                let [q, v, contacts, found] = [Argument::Q, Argument::V, CONTACTS, FOUND].map(|argument| inputs.get(argument));
                contact_forces(model, ws, (q, v, contacts), found, out);
            },
        }],
        ..Self::constrained_acceleration
    };

    pub(super) const contact_forces_with_contacts: Function<S> = Function {
        name: "contact_forces_with_contacts",
        summary: "contact_forces, and the same of contacts that a caller finds",
        takes: &[Argument::Q, Argument::V, CONTACTS, FOUND],
        gives: &[],
        outputs: &[
            Port::new("forces", &[Dim::Contacts, Dim::Of(CONTACT)], "1, m, 1, N, N·m, of each place of contact"),
            Port::new("given_forces", &[Dim::Given, Dim::Of(CONTACT)], "1, m, 1, N, N·m, of each given contact"),
        ],
        unit: "",
        group: Group::GivenContacts,
        ..Self::contact_forces
    };
}

const ERROR: Port = Port::new("error", &[], "√kg·m/s², no less than ‖found − optimum‖_M");
const SIZE: Port = Port::new("size", &[], "√kg·m/s², ‖a₀‖_M of the acceleration without constraints");

/// Calls `solve` with the smooth motion, whose acceleration is that of origins.
fn with_smooth<S: Scalar, T>(
    model: &Model<S>,
    ws: &mut Workspace<S>,
    inputs: &Inputs<'_, S>,
    (accelerate, warm): (super::Accelerate<S>, &[S]),
    solve: impl FnOnce(&Model<S>, &mut Workspace<S>, &Smooth<'_, S>) -> T,
) -> T {
    let [q, v, act, ctrl] = [Argument::Q, Argument::V, ACT, CTRL].map(|argument| inputs.get(argument));
    let start = Start { model, q, v, act, drive: Drive::Controls(ctrl), h: S::zero(), accelerate, warm: None, given: &[] };
    let mut a = vec![S::zero(); model.nv];
    start.acceleration(ws, (q, v, act), &mut a);
    free::of_origins(model, v, &mut a);
    solve(model, ws, &Smooth { q, v, a: &a, warm, given: &[] })
}

fn search<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, inputs: &Inputs<'_, S>, accelerate: super::Accelerate<S>, out: &mut [S]) {
    let (found, Certificate { error, size }, steps) = with_smooth(model, ws, inputs, (accelerate, inputs.get(WARM)), searched);
    out[..model.nv].copy_from_slice(&found);
    out[model.nv..].copy_from_slice(&[error, size, steps]);
}

fn certify<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, inputs: &Inputs<'_, S>, accelerate: super::Accelerate<S>, out: &mut [S]) {
    let Certificate { error, size } = with_smooth(model, ws, inputs, (accelerate, inputs.get(FOUND)), certified);
    out.copy_from_slice(&[error, size]);
}

/// Activations are those at the state, also of actuators whose force has the next one in a step.
fn run<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, inputs: &Inputs<'_, S>, accelerate: super::Accelerate<S>, out: &mut [S]) {
    let [q, v, act, ctrl, warm] = [Argument::Q, Argument::V, ACT, CTRL, WARM].map(|argument| inputs.get(argument));
    let h = inputs.get(H).first().copied().unwrap_or(S::zero());
    let warm = Some(RefCell::new(warm.to_vec()));
    let start = Start { model, q, v, act, drive: Drive::Controls(ctrl), h, accelerate, warm, given: inputs.get(CONTACTS) };
    start.acceleration(ws, (q, v, act), out);
}
