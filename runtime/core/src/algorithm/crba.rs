//! Composite rigid body algorithm.

use super::Workspace;
use super::common::{Axes, carry, inertias, positions};
use super::effects;
use crate::Scalar;
use crate::index::BodyId;
use crate::joint::with_pose;
use crate::joint::{JointLaw, Mount};
use crate::model::Model;

/// M(q), the mass matrix.
///
/// q: `[nq]` rad|m|quaternion; out: `[nv · nv]`, row by row, both triangles; kg·m²|kg·m|kg. O(n ·
/// depth). Featherstone 2008, Table 6.2.
///
/// # Panics
/// If a slice is shorter than stated; [`super::Function::call`] and [`crate::dynamics::Dynamics`]
/// check and return an error.
pub fn mass_matrix<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], out: &mut [S]) {
    ws.set_poses(model, q);
    for i in model.outward() {
        ws.composite[i] = model.bodies[i].inertia;
    }
    out.fill(S::zero());
    for i in model.inward() {
        with_pose!(ws.bodies[i].pose, p => joint(model, ws, i, &p, q, out));
    }
    effects::armature_matrix(model, q, out);
    effects::add_inertia(model, ws, q, out);
}

/// Entries of M for joint `i` with itself and with each joint beyond: the components of their
/// columns' wrenches, carried to its body, along the joint. Then passes them, and the inertia of
/// all that it carries, on to the parent.
#[inline(always)]
fn joint<S: Scalar, P: JointLaw<S>>(model: &Model<S>, ws: &mut Workspace<S>, i: BodyId, p: &P, q: &[S], out: &mut [S]) {
    let (n, body) = (model.nv, &model.bodies[i]);
    let mount = Mount::new(*p, &body.placement);
    let (at, dofs) = (&body.coordinates, body.joint.nv());
    for (k, c) in ws.columns_of(i).enumerate() {
        // F = I_i S_i,k
        ws.columns[c].u = p.column(&ws.composite[i], k).scaled(at.rate_of_one(q));
    }
    let all = ws.columns_from(i);
    for (c, column) in ws.columns[all].iter_mut().enumerate() {
        // M_cj = M_jc = S_jᵀ F
        let (k, wrench) = (column.at, &mut column.u);
        for own in 0..dofs {
            let (l, inertia) = (at.v + own, at.to_leader(q, p.torque(wrench, own)));
            out[k * n + l] += inertia;
            if c >= dofs {
                out[l * n + k] += inertia;
            }
        }
        if body.parent != BodyId::BASE {
            *wrench = mount.wrench(wrench);
        }
    }
    if body.parent != BodyId::BASE {
        // I_λ += X_λi I_i
        let inertia = mount.inertia(&ws.composite[i]);
        ws.composite[body.parent] += inertia;
    }
}

/// As [`mass_matrix`], in common axes, to go with other matrices that are: turns each inertia once,
/// and carries wrenches without turning them. A thin body's moment about its axis is then as good
/// as its largest moment, no better.
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
            let (at, wrench) = (ws.columns[k].at, state.inertia.apply(&ws.columns[k].axis));
            carry(model, ws, i, [wrench], |own, [wrench], other| {
                // Of two columns of one joint, once.
                if own && other.at > at {
                    return;
                }
                // M_kl = M_lk = S_lᵀ F
                let inertia = wrench.power(&other.axis);
                out[at * n + other.at] += inertia;
                if !(own && other.at == at) {
                    out[other.at * n + at] += inertia;
                }
            });
        }
        let parent = model.bodies[i].parent;
        if parent != BodyId::BASE {
            ws.common[parent].inertia += state.inertia.shifted(state.shift);
        }
    }
    effects::armature_matrix(model, q, out);
    effects::add_inertia(model, ws, q, out);
}
