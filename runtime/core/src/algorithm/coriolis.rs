//! The Coriolis matrix.

use super::Workspace;
use super::common::{Axes, carry, coriolis, inertias, positions, twists};
use crate::Scalar;
use crate::index::BodyId;
use crate::model::Model;

/// C(q, v), with C v + g = h and Ṁ − 2C skew-symmetric.
///
/// q: `[nq]`; v: `[nv]`; out: `[nv · nv]`, row by row, N·m·s|N·s|N·s/m. Of all matrices with these
/// properties it is C = Σ Jᵀ (B J + G J̇), which is that of the Christoffel symbols where rates are
/// derivatives of coordinates. Echeandia & Wensing, *J. Comput. Nonlinear Dyn.* 16, 2021.
///
/// # Panics
/// If a slice is shorter than stated; [`super::Function::call`] and [`crate::dynamics::Dynamics`]
/// check and return an error.
pub fn coriolis_matrix<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], v: &[S], out: &mut [S]) {
    positions(model, ws, Axes::Tree, q);
    twists(model, ws, Axes::Tree, v);
    inertias(model, ws);
    coriolis(model, ws);
    out.fill(S::zero());
    for i in model.inward() {
        for k in ws.columns_of(i) {
            row_and_column(model, ws, i, k, out);
        }
        let (parent, state) = (model.bodies[i].parent, ws.common[i]);
        if parent != BodyId::BASE {
            ws.common[parent].inertia += state.inertia.shifted(state.shift);
            ws.common[parent].coriolis += state.coriolis.shifted(state.shift);
        }
    }
}

/// Entries of column `k` of body `i` with itself and with the columns on the path to the root.
fn row_and_column<S: Scalar>(model: &Model<S>, ws: &Workspace<S>, i: BodyId, k: usize, out: &mut [S]) {
    let (n, state, column) = (model.nv, &ws.common[i], &ws.columns[k]);
    // C_kl = S_kᵀ (B s_l + I Ṡ_l) = (Bᵀ S_k)·s_l + (I S_k)·Ṡ_l
    let held = state.inertia.apply(&column.axis);
    let turning = state.coriolis.transposed(&column.axis);
    // C_lk = S_lᵀ (B s_k + I Ṡ_k)
    let drive = state.coriolis.wrench(column.axis.angular) + state.inertia.apply(&column.s_dot);
    carry(model, ws, i, [held, drive], |own, [held, drive], other| {
        out[column.at * n + other.at] += turning.dot(&other.axis.angular) + held.power(&other.s_dot);
        if !own {
            out[other.at * n + column.at] += drive.power(&other.axis);
        }
    });
}
