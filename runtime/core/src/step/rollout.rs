//! Many steps, one after the other.

use alloc::vec;

use super::H;
use crate::Scalar;
use crate::algorithm::{Argument, Function, FunctionError, Workspace};
use crate::model::Model;

/// Steps a state in place. `torque(k)` has the torques of step k, `[nv]`; `see(k, q, v)` is called
/// after it.
///
/// q: `[nq]`, v: `[nv]`, h in s; `method` is a row of [`super::steps`].
///
/// # Errors
/// Vectors of another length than the model says, another robot's workspace, and another function.
pub fn rollout<'a, S: Scalar>(
    method: &Function<S>,
    (model, ws): (&Model<S>, &mut Workspace<S>),
    (q, v): (&mut [S], &mut [S]),
    h: S,
    torques: impl IntoIterator<Item = &'a [S]>,
    mut see: impl FnMut(usize, &[S], &[S]),
) -> Result<(), FunctionError> {
    if !method.takes.contains(&H) {
        return Err(FunctionError::Arguments { function: method.name, found: 4, expected: method.takes.len() });
    }
    crate::algorithm::check_length(Argument::Q.name(), q.len(), model.nq)?;
    crate::algorithm::check_length(Argument::V.name(), v.len(), model.nv)?;
    let mut next = vec![S::zero(); model.nq + model.nv];
    for (k, tau) in torques.into_iter().enumerate() {
        method.call(model, ws, &[q, v, tau, &[h]], &mut next)?;
        let (q_next, v_next) = next.split_at(model.nq);
        q.copy_from_slice(q_next);
        v.copy_from_slice(v_next);
        see(k, q, v);
    }
    Ok(())
}
