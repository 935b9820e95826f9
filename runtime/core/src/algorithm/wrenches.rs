//! External wrenches on frames.

use super::Workspace;
use crate::Scalar;
use crate::index::BodyId;
use crate::joint::JointLaw;
use crate::joint::with_pose;
use crate::model::Model;
use crate::spatial::{Reference, Vector3, Wrench};

/// The wrenches of `[frames][6]` one by one, as (body, wrench on it in its axes about its origin),
/// added up by `add`; none for an empty slice. Wrenches on the base are left out: they have no
/// effect.
pub(super) fn each<S: Scalar>(
    model: &Model<S>,
    ws: &mut Workspace<S>,
    q: &[S],
    wrenches: &[S],
    mut add: impl FnMut(&mut Workspace<S>, BodyId, &Wrench<S>),
) {
    if wrenches.is_empty() {
        return;
    }
    if model.wrench_reference != Reference::Body {
        place_bodies(model, ws, q);
    }
    for (frame, w) in model.frames.iter().zip(wrenches.chunks_exact(6)).filter(|(f, _)| f.body != BodyId::BASE) {
        let given = Wrench { moment: Vector3::new(w[0], w[1], w[2]), force: Vector3::new(w[3], w[4], w[5]) };
        let x_wb = ws.placements[frame.body];
        let on_body = match model.wrench_reference {
            Reference::Body => given.turned(&frame.placement.rotation).shifted(frame.placement.position),
            Reference::WorldAligned => given.turned_back(&x_wb.rotation).shifted(frame.placement.position),
            // The moment about the body's origin p is that about the world frame's, less p × f.
            Reference::World => given.shifted(-x_wb.position).turned_back(&x_wb.rotation),
        };
        add(ws, frame.body, &on_body);
    }
}

/// Placements of all bodies in the world frame.
pub(super) fn place_bodies<S: Scalar>(model: &Model<S>, ws: &mut Workspace<S>, q: &[S]) {
    for i in model.outward() {
        let body = &model.bodies[i];
        // T_i = T_λ · T_λj · T_j(q)
        let x_wj = ws.placements[body.parent].compose(&body.placement);
        ws.placements[i] = with_pose!(ws.pose(body, i, q), p => p.compose(x_wj));
    }
}
