//! Many steps, one after the other.

use alloc::vec;
use alloc::vec::Vec;

use super::{ACT, CONTACTS, CTRL, H, WARM};
use crate::Scalar;
use crate::algorithm::{Argument, Function, FunctionError, Workspace, check_length};
use crate::model::Model;

/// A state that is stepped.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State<S = f64> {
    /// Coordinates, `[nq]`.
    pub q: Vec<S>,
    /// Rates, `[nv]`.
    pub v: Vec<S>,
    /// Activations of actuators, `[na]`: for steps with actuators.
    pub act: Vec<S>,
    /// The last acceleration, `[nv]`: for steps with constraints, as [`super::WARM`]. Empty: zeros.
    pub warm: Vec<S>,
}

impl<S: Scalar> State<S> {
    /// The neutral configuration at rest, with activations of zero.
    pub fn neutral(model: &Model<S>) -> Self {
        let act = vec![S::zero(); model.actuators().activations()];
        Self { q: model.neutral(), v: vec![S::zero(); model.nv()], act, warm: Vec::new() }
    }
}

/// Steps a state in place. `inputs` has what is held during each step: the torques `[nv]`, or the
/// controls `[nu]` of a step with actuators. `see(k, state)` is called after step k.
///
/// `method` is a row of [`super::steps`], or a step of [`super::of_actuators`] or
/// [`super::of_constraints`]; h in s.
///
/// # Errors
/// Vectors of another length than the model says, another robot's workspace, and another function.
pub fn rollout<'a, S: Scalar>(
    method: &Function<S>,
    (model, ws): (&Model<S>, &mut Workspace<S>),
    state: &mut State<S>,
    h: S,
    inputs: impl IntoIterator<Item = &'a [S]>,
    mut see: impl FnMut(usize, &State<S>),
) -> Result<(), FunctionError> {
    if !method.takes.contains(&H) || method.takes.contains(&CONTACTS) {
        return Err(FunctionError::Arguments { function: method.name, found: 4, expected: method.takes.len() });
    }
    let has_actuators = method.takes.contains(&CTRL);
    check_length(Argument::Q.name(), state.q.len(), model.nq)?;
    check_length(Argument::V.name(), state.v.len(), model.nv)?;
    let activations = if has_actuators { model.actuators.activations() } else { 0 };
    if has_actuators {
        check_length(ACT.name(), state.act.len(), activations)?;
    }
    let has_constraints = method.takes.contains(&WARM);
    if has_constraints {
        if state.warm.is_empty() {
            state.warm = vec![S::zero(); model.nv];
        }
        check_length(WARM.name(), state.warm.len(), model.nv)?;
    }
    let ends = if has_constraints { model.nv } else { 0 };
    let mut next = vec![S::zero(); model.nq + model.nv + activations + ends];
    for (k, input) in inputs.into_iter().enumerate() {
        let State { q, v, act, warm } = state;
        if has_constraints {
            method.call(model, ws, &[q, v, act, input, warm, &[h]], &mut next)?;
        } else if has_actuators {
            method.call(model, ws, &[q, v, act, input, &[h]], &mut next)?;
        } else {
            method.call(model, ws, &[q, v, input, &[h]], &mut next)?;
        }
        let (q_next, rest) = next.split_at(model.nq);
        let (v_next, rest) = rest.split_at(model.nv);
        let (act_next, warm_next) = rest.split_at(activations);
        q.copy_from_slice(q_next);
        v.copy_from_slice(v_next);
        if has_actuators {
            act.copy_from_slice(act_next);
        }
        if has_constraints {
            warm.copy_from_slice(warm_next);
        }
        see(k, state);
    }
    Ok(())
}
