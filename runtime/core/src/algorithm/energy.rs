//! Energies of the moving links.

use super::Workspace;
use super::common::{Axes, positions};
use super::effects;
use super::rnea::momentum;
use crate::Scalar;
use crate::model::Model;
use crate::spatial::rotate;

/// T = ½ Σ Vᵀ G V = ½ vᵀ M v, rotors and added mass included.
///
/// q: `[nq]`; v: `[nv]`; out: one number, J. Featherstone 2008, §2.12.
///
/// # Panics
/// If a slice is shorter than stated; [`super::Function::call`] and [`crate::dynamics::Dynamics`]
/// check and return an error.
pub fn kinetic_energy<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], v: &[S], out: &mut [S]) {
    let mut row = core::mem::take(&mut ws.row);
    momentum(model, ws, q, v, &effects::LoadCase::empty(), &mut row);
    out[0] = row.iter().zip(v).fold(S::zero(), |sum, (p, v)| sum + *p * *v) * S::from_f64(0.5);
    ws.row = row;
}

/// U = −Σ m gᵀc = −gᵀ Σ (m p + R h), zero at the world frame's origin, and the energy of springs,
/// stops, buoyancy and contacts.
///
/// q: `[nq]`; out: one number, J. Links fixed to the base do not count.
///
/// # Panics
/// As [`kinetic_energy`].
pub fn potential_energy<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], out: &mut [S]) {
    positions(model, ws, Axes::Base, q);
    let mut energy = S::zero();
    for i in model.outward() {
        let (state, inertia) = (&ws.common[i], &model.bodies[i].inertia);
        energy -= model.gravity.dot(&(state.position * inertia.mass + rotate(&state.rotation, inertia.first)));
    }
    out[0] = energy + effects::energy(model, ws, q);
}
