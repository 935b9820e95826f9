//! Operational-space inertia. Khatib, *IEEE J. Robot. Autom.* 3, 1987, 43–53.

use super::Workspace;
use super::common::{Axes, positions};
use super::forward_dynamics::factored;
use super::frames::jacobian;
use super::ltdl::solve;
use crate::Scalar;
use crate::index::BodyId;
use crate::model::{Frame, Model};
use crate::spatial::Reference;

/// Λ⁻¹ = J M⁻¹ Jᵀ of each frame by itself, J being the frame's Jacobian in world axes about its
/// origin.
///
/// q: `[nq]`; out: `[frames][6][6]`, symmetric.
///
/// # Panics
/// If a slice is shorter than stated; [`super::Function::call`] and [`crate::dynamics::Dynamics`]
/// check and return an error.
pub fn operational_space_inertia_inverse<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], out: &mut [S]) {
    let matrix = factored(model, ws, q);
    positions(model, ws, Axes::Base, q);
    for (frame, out) in model.frames.iter().zip(out.chunks_exact_mut(36)) {
        inverse_of(model, ws, &matrix, frame, out);
    }
    ws.matrix = matrix;
}

/// Λ = (J M⁻¹ Jᵀ)⁻¹ of each frame by itself.
///
/// q: `[nq]`; out: `[frames][6][6]`, symmetric. NaN for a frame with less than six degrees of
/// freedom on its path to the root. In a configuration in which they do not move it in all six
/// directions, Λ⁻¹ is singular and its inverse is rounding error: large meaningless numbers.
///
/// # Panics
/// As [`operational_space_inertia_inverse`].
pub fn operational_space_inertia<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], out: &mut [S]) {
    operational_space_inertia_inverse(model, ws, q, out);
    for (frame, out) in model.frames.iter().zip(out.chunks_exact_mut(36)) {
        if freedoms_before(model, frame.body) < 6 { out.fill(S::from_f64(f64::NAN)) } else { invert(out) }
    }
}

/// How many degrees of freedom move body `i`, up to six: joints that follow others have none of
/// their own.
fn freedoms_before<S: Scalar>(model: &Model<S>, mut i: BodyId) -> usize {
    let (mut found, mut count) = ([0; 6], 0);
    while i != BodyId::BASE {
        let body = &model.bodies[i];
        for freedom in body.coordinates.v..body.coordinates.v + body.joint.nv() {
            if count < 6 && !found[..count].contains(&freedom) {
                found[count] = freedom;
                count += 1;
            }
        }
        i = body.parent;
    }
    count
}

fn inverse_of<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, matrix: &[S], frame: &Frame<S>, out: &mut [S]) {
    let n = model.nv;
    let (mut rows, mut x) = (core::mem::take(&mut ws.six_rows), core::mem::take(&mut ws.row));
    jacobian(model, ws, frame, Reference::WorldAligned, &mut rows);
    for a in 0..6 {
        // x = M⁻¹ J_aᵀ
        x.copy_from_slice(&rows[a * n..][..n]);
        solve(matrix, &ws.parent_dof, &mut x);
        for b in a..6 {
            let sum = x.iter().zip(&rows[b * n..]).fold(S::zero(), |sum, (x, j)| sum + *x * *j);
            (out[6 * a + b], out[6 * b + a]) = (sum, sum);
        }
    }
    (ws.six_rows, ws.row) = (rows, x);
}

/// The inverse of a symmetric positive definite 6×6 matrix in place, by A = Lᵀ D L.
fn invert<S: Scalar>(a: &mut [S]) {
    const CHAIN: [usize; 6] = [0, 1, 2, 3, 4, 5];
    super::ltdl::factor(a, &CHAIN);
    let mut inverse = [S::zero(); 36];
    for j in 0..6 {
        let mut x = [S::zero(); 6];
        x[j] = S::one();
        solve(a, &CHAIN, &mut x);
        (0..=j).for_each(|i| (inverse[6 * i + j], inverse[6 * j + i]) = (x[i], x[i]));
    }
    a.copy_from_slice(&inverse);
}
