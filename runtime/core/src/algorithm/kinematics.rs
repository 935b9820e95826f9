//! Forward kinematics.

use super::Workspace;
use super::wrenches::place_bodies;
use crate::Scalar;
use crate::model::Model;

/// Placements of all frames (links of the file) in the world frame.
///
/// q: `[nq]` rad|m|quaternion; out: `[12 · frames]`, for each frame the rotation row by row, then
/// the position in m. One outward sweep. Lynch & Park 2017, §4.1; Featherstone 2008, §4.4.
///
/// # Panics
/// If a slice is shorter than stated; [`super::Function::call`] and [`crate::dynamics::Dynamics`]
/// check and return an error.
pub fn placements<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S], out: &mut [S]) {
    place_bodies(model, ws, q);
    for (frame, out) in model.frames.iter().zip(out.chunks_exact_mut(12)) {
        out.copy_from_slice(&ws.placements[frame.body].compose(&frame.placement).to_array());
    }
}
