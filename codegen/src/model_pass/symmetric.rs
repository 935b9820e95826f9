//! Drops the rotation of the frames of axisymmetric bodies.

use articulated_core::Scalar;
use articulated_core::index::{BodyId, ById};
use articulated_core::model::Body;
use articulated_core::spatial::{Matrix3, SpatialInertia, Vector3};

use super::view::View;
use super::zeros::or_zero;

/// Keeps the frame of an axisymmetric revolute body in its joint's frame, without rotation, if the
/// body carries nothing.
///
/// The moments of such a body are constant in a frame that does not rotate with it; only ω changes.
/// Neither sine nor cosine of the angle remains, as for a wheel, a propeller, or the last link of
/// many arms. Bodies that carry a frame, or on which effects act, are left alone. Exact for all
/// joint torques.
pub fn drop_symmetric_rotation<S: Scalar>(view: View<S>) -> View<S> {
    let View { model, mut formulation } = view;
    let mut carries = ById::<BodyId, _>::from(vec![false; model.bodies().len()]);
    model.outward().for_each(|i| carries[model.bodies()[i].parent] = true);
    model.frames().iter().for_each(|frame| carries[frame.body] = true);
    model.actuators().frames().for_each(|frame| carries[frame.body] = true);
    let model = model.changed(|parts| {
        for (i, body) in parts.bodies.with_ids_mut().skip(1).filter(|(i, _)| !carries[*i]) {
            if body.joint.is_rotation_about_axis() && body.effects.body.is_empty() && made_axisymmetric(body) {
                formulation.rotations[i].share = S::zero();
            }
        }
    });
    View { model, formulation }
}

/// Whether a body is axisymmetric about its z-axis within rounding, which is then removed.
fn made_axisymmetric<S: Scalar>(body: &mut Body<S>) -> bool {
    let SpatialInertia { first, second, .. } = body.inertia;
    let size = second.m11.abs() + second.m22.abs();
    let across = [second.m12, second.m13, second.m23, second.m11 - second.m22].map(|x| or_zero(x, size));
    let round = [first.x, first.y].into_iter().chain(across).all(|x| x == S::zero());
    if round {
        let mean = (second.m11 + second.m22) * S::from_f64(0.5);
        body.inertia.second = Matrix3::from_diagonal(&Vector3::new(mean, mean, second.m33));
    }
    round
}
