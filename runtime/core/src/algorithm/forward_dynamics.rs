//! Forward dynamics and other solutions with the mass matrix.

use super::Workspace;
use super::crba::mass_matrix;
use super::effects;
use super::ltdl::{factor, inverse, solve};
use super::rnea::inverse_dynamics_with_wrenches;
use crate::Scalar;
use crate::model::Model;

/// a = M(q)⁻¹·(τ + Σ Jᵀw − h(q, v)), with external wrenches w on the frames.
///
/// q: `[nq]`; v: `[nv]`; tau: `[nv]` N·m|N; wrenches: `[frames][6]` N·m and N, as
/// [`Model::wrench_reference`] says, or empty; out: `[nv]` rad/s²|m/s². By M = Lᵀ D L; Featherstone
/// 2008, §6.5. If M is singular to working precision, a pivot is only rounding error, and the
/// result is infinite, NaN, or finite and meaningless; [`super::checked_forward_dynamics`] reports
/// it. A model with [`Model::massless_joints`] is singular everywhere.
///
/// # Panics
/// If a slice is shorter than stated; [`super::Function::call`] and [`crate::dynamics::Dynamics`]
/// check and return an error.
pub fn forward_dynamics_with_wrenches<S: Scalar>(
    model: &Model<S>,
    ws: &mut Workspace<S>,
    q: &[S],
    v: &[S],
    tau: &[S],
    wrenches: &[S],
    out: &mut [S],
) {
    let value = |ws: &mut Workspace<S>, out: &mut [S]| {
        inverse_dynamics_with_wrenches(model, ws, q, v, &[], wrenches, out);
        // b = τ − h
        let mut driven = core::mem::take(&mut ws.driven);
        effects::motor_torque(model, v, tau, &mut driven);
        out.iter_mut().zip(&driven).for_each(|(b, tau)| *b = *tau - *b);
        ws.driven = driven;
        let matrix = factored(model, ws, q);
        solve(&matrix, &ws.parent_dof, out);
        ws.matrix = matrix;
    };
    by_equation(model, ws, (q, v, tau, wrenches), out, value, |ws, b| {
        let matrix = factored(model, ws, q);
        solve(&matrix, &ws.parent_dof, b);
        ws.matrix = matrix;
    });
}

/// Accelerations computed by `value`, as what solves M(q) a + h(q, v) − τ − Σ Jᵀw = 0; `solve`: M⁻¹
/// b in the place of b.
pub(super) fn by_equation<S: Scalar>(
    model: &Model<S>,
    ws: &mut Workspace<S>,
    (q, v, tau, wrenches): (&[S], &[S], &[S], &[S]),
    out: &mut [S],
    value: impl FnOnce(&mut Workspace<S>, &mut [S]),
    solve: impl FnOnce(&mut Workspace<S>, &mut [S]),
) {
    let residual = |ws: &mut Workspace<S>, a: &[S], r: &mut [S]| {
        inverse_dynamics_with_wrenches(model, ws, q, v, a, wrenches, r);
        let mut driven = core::mem::take(&mut ws.driven);
        effects::motor_torque(model, v, tau, &mut driven);
        r.iter_mut().zip(&driven).for_each(|(r, tau)| *r -= *tau);
        ws.driven = driven;
        for ((r, own), a) in r.iter_mut().zip(&ws.diagonal).zip(a) {
            own.iter().for_each(|own| *r += *own * *a);
        }
        for (i, j, own) in &ws.coupled {
            r[*i] += *own * a[*j];
            r[*j] += *own * a[*i];
        }
    };
    S::implicit(ws, &mut out[..model.nv], value, residual, solve);
}

/// M(q)⁻¹·τ, without M⁻¹.
///
/// q: `[nq]`; tau: `[nv]`; out: `[nv]`.
///
/// # Panics
/// As [`forward_dynamics_with_wrenches`].
pub fn solve_mass_matrix<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], tau: &[S], out: &mut [S]) {
    let matrix = factored(model, ws, q);
    out.copy_from_slice(tau);
    solve(&matrix, &ws.parent_dof, out);
    ws.matrix = matrix;
}

/// M(q)⁻¹, from M = Lᵀ D L.
///
/// q: `[nq]`; out: `[nv · nv]`, symmetric.
///
/// # Panics
/// As [`forward_dynamics_with_wrenches`].
pub fn mass_matrix_inverse<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], out: &mut [S]) {
    let matrix = factored(model, ws, q);
    inverse(&matrix, &ws.parent_dof, out);
    ws.matrix = matrix;
}

/// M(q) factored by `factor`. The matrix belongs to the workspace and must be returned.
pub(super) fn factored<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S]) -> alloc::vec::Vec<S> {
    let mut matrix = core::mem::take(&mut ws.matrix);
    mass_matrix(model, ws, q, &mut matrix);
    for (i, own) in ws.diagonal.iter().enumerate() {
        own.iter().for_each(|own| matrix[i * model.nv + i] += *own);
    }
    ws.coupled.iter().for_each(|(i, j, own)| matrix[i * model.nv + j] += *own);
    factor(&mut matrix, &ws.parent_dof);
    matrix
}
