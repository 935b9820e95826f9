//! Of the mass matrix: the two measures that flag a configuration.

use crate::Scalar;
use crate::algorithm::checked::{Factor, articulated_body_pivots};
use crate::algorithm::{Workspace, articulated_body, mass_matrix};
use crate::model::Model;

/// Remaining part of each joint's inertia after elimination, D/(Σ|terms|) in (0, 1], with the other
/// joints free; a few units of roundoff where M is singular.
///
/// q: `[nq]`; out: `[nv]`. By ABA at rest, or LᵀDL of M where joints follow others. Allocates.
///
/// # Panics
/// If a slice is shorter than stated.
pub fn pivot_cancellation<S: Scalar<Mask = bool>>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], out: &mut [S]) {
    if model.has_followers() {
        out.copy_from_slice(factored(model, ws, q).0.pivots());
        return;
    }
    let rest = alloc::vec![S::zero(); model.nv];
    articulated_body(model, ws, q, &rest, &rest, out);
    articulated_body_pivots(model, ws, |freedom, left| out[freedom] = left);
}

/// An estimate of the condition number of M(q), scaled to a diagonal of ones
/// ([`Factor::condition`]); infinite where M is singular to working precision.
///
/// q: `[nq]`. Accelerations move relatively by about this times a relative change of M or τ; a
/// result may be exact for a robot a few roundings away and yet have a forward error of this many
/// roundings. Allocates.
///
/// # Panics
/// If q is shorter.
pub fn scaled_condition<S: Scalar<Mask = bool>>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S]) -> S {
    let (mut factor, regular) = factored(model, ws, q);
    if regular { factor.condition() } else { S::one() / S::zero() }
}

/// M factored, and whether it is regular.
fn factored<S: Scalar<Mask = bool>>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S]) -> (Factor<S>, bool) {
    let mut matrix = alloc::vec![S::zero(); model.nv * model.nv];
    mass_matrix(model, ws, q, &mut matrix);
    let mut factor = Factor::new(model.nv);
    let regular = factor.factor(&matrix).is_ok();
    (factor, regular)
}
