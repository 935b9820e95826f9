//! Accelerations with constraints: limits, dry friction and contacts.

use alloc::vec;
use alloc::vec::Vec;

use super::{ACT, CTRL, Drive, H, Start, Steps, WARM, free};
use crate::Scalar;
use crate::algorithm::registry::{Group, Inputs, Needs};
use crate::algorithm::{
    Argument, Dim, Function, FunctionId, Variant, Workspace, always, articulated_body_with_wrenches, factorization,
    forward_dynamics_with_wrenches, nothing, untied,
};
use crate::constraint::{Smooth, constrained};
use crate::model::Model;
use core::cell::RefCell;

/// Replaces the accelerations without constraints by those with them, and returns Jᵀ f of their
/// forces. `warm`: where the search begins, and where it ended.
pub(super) fn acceleration<S: Scalar>(
    model: &Model<S>,
    ws: &mut Workspace<S>,
    (q, v): (&[S], &[S]),
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
    let (x, forces) = constrained(model, ws, &Smooth { q, v, a, warm });
    warm.copy_from_slice(&x);
    a.copy_from_slice(&x);
    free::of_bodies(model, v, a);
    forces
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
        ways: &[
            Variant {
                name: "ABA",
                applies: untied,
                least: nothing,
                run: &|model, ws, inputs, out| run(model, ws, inputs, articulated_body_with_wrenches, out),
            },
            Variant {
                name: "LTDL",
                applies: always,
                least: factorization,
                run: &|model, ws, inputs, out| run(model, ws, inputs, forward_dynamics_with_wrenches, out),
            },
        ],
        unsolved: None,
    };
}

/// Activations are those at the state, also of actuators whose force has the next one in a step.
fn run<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, inputs: &Inputs<'_, S>, accelerate: super::Accelerate<S>, out: &mut [S]) {
    let [q, v, act, ctrl, warm] = [Argument::Q, Argument::V, ACT, CTRL, WARM].map(|argument| inputs.get(argument));
    let h = inputs.get(H).first().copied().unwrap_or(S::zero());
    let warm = Some(RefCell::new(warm.to_vec()));
    let start = Start { model, q, v, act, drive: Drive::Controls(ctrl), h, accelerate, warm };
    start.acceleration(ws, (q, v, act), out);
}
