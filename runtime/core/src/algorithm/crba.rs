//! Composite rigid body algorithm.

use super::Workspace;
use super::common::{Axes, inertias, positions};
use super::effects;
use super::rnea::to_parent;
use crate::joint::JointLaw;
use crate::model::Model;
use crate::{Scalar, with_pose};

/// M(q), the mass matrix.
///
/// q: `[nq]` rad|m|quaternion; out: `[nv · nv]`, row by row, both triangles; kg·m²|kg·m|kg. O(n · depth). Featherstone 2008, Table 6.2.
///
/// # Panics
/// If a slice is shorter than stated; [`super::Function::call`] and [`crate::dynamics::Dynamics`] check and return an error.
pub fn mass_matrix<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], out: &mut [S]) {
    for i in model.outward() {
        let body = &model.bodies[i];
        let pose = body.joint.pose(&body.coordinates, q);
        ws.bodies[i].origin = with_pose!(pose, p => p.origin(&body.placement));
        ws.bodies[i].pose = Some(pose);
        ws.composite[i] = body.inertia;
    }
    out.fill(S::zero());
    for i in model.inward() {
        let body = &model.bodies[i];
        let Some(pose) = ws.bodies[i].pose else { continue };
        for k in 0..body.joint.nv() {
            column(model, ws, i, k, out);
        }
        if body.parent != 0 {
            // I_λ += X_λi I_i
            let joint = with_pose!(pose, p => p.inertia_to_joint(&ws.composite[i]));
            ws.composite[body.parent] += joint.moved(&body.placement);
        }
    }
    effects::armature_matrix(model, out);
    effects::add_inertia(model, ws, q, out);
}

/// The wrench that accelerates everything from body `i` on in its degree of freedom `k`, and what it asks of the joints on the way to the base.
fn column<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, i: usize, k: usize, out: &mut [S]) {
    let (n, at) = (model.nv, &model.bodies[i].coordinates);
    let Some(pose) = &ws.bodies[i].pose else { return };
    // F = I_i S_i,k;  M_ik,i = S_iᵀ F
    let mut wrench = with_pose!(pose, p => p.column(&ws.composite[i], k)).scaled(at.rate_of_one());
    let row = at.v + k;
    with_pose!(pose, p => p.add_torque(&wrench, at, &mut out[row * n..][..n]));
    let mut j = i;
    while model.bodies[j].parent != 0 {
        let (body, state) = (&model.bodies[j], &ws.bodies[j]);
        let Some(pose) = &state.pose else { return };
        // F in the parent's frame;  M_ik,j = M_j,ik = S_jᵀ F
        wrench = with_pose!(pose, p => to_parent(body, p, state.origin, &wrench));
        j = body.parent;
        let (body, Some(pose)) = (&model.bodies[j], &ws.bodies[j].pose) else { return };
        let (first, end) = (body.coordinates.v, body.coordinates.v + body.joint.nv());
        ws.row[first..end].fill(S::zero());
        with_pose!(pose, p => p.add_torque(&wrench, &body.coordinates, &mut ws.row));
        for l in first..end {
            out[row * n + l] += ws.row[l];
            out[l * n + row] += ws.row[l];
        }
    }
}

/// As [`mass_matrix`], in common axes, to go with other matrices that are: turns each inertia once, and carries wrenches without turning them. A thin body's
/// moment about its axis is then as good as its largest moment, no better.
///
/// # Panics
/// As [`mass_matrix`].
pub(super) fn mass_matrix_in_common_axes<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], out: &mut [S]) {
    let n = model.nv;
    positions(model, ws, Axes::Tree, q);
    inertias(model, ws);
    out.fill(S::zero());
    for i in model.inward() {
        let state = ws.common[i];
        for k in ws.columns_of(i) {
            // F = I_i S_k
            let (at, mut wrench, mut j) = (ws.columns[k].at, state.inertia.apply(&ws.columns[k].axis), i);
            while j != 0 {
                // Of two columns of one joint, once.
                for l in ws.columns_of(j).filter(|&l| l <= k) {
                    // M_kl = M_lk = S_lᵀ F
                    let (other, inertia) = (ws.columns[l].at, wrench.power(&ws.columns[l].axis));
                    out[at * n + other] += inertia;
                    if l != k {
                        out[other * n + at] += inertia;
                    }
                }
                wrench = ws.common[j].hand_on(&wrench);
                j = model.bodies[j].parent;
            }
        }
        let parent = model.bodies[i].parent;
        if parent != 0 {
            ws.common[parent].inertia += state.inertia.shifted(state.shift);
        }
    }
    effects::armature_matrix(model, out);
    effects::add_inertia(model, ws, q, out);
}
