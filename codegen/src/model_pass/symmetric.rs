//! Frames of axisymmetric bodies that stay while their bodies rotate.

use articulated_core::Scalar;
use articulated_core::model::Body;
use articulated_core::spatial::{Matrix3, SpatialInertia, Vector3};

use super::view::View;
use super::zeros::or_zero;

/// Lets the frame of a revolute body stay as its joint's frame stands, if the body is the same from all sides about that axis and carries nothing.
///
/// In a frame that does not turn with it such a body has constant moments as well, and what turns is ω alone: neither sine nor cosine of the angle is left, as
/// of a wheel, of a propeller, or of the last link of many arms. For a model whose frames nobody asks for: a body that carries a frame is left alone, and so is one on which effects
/// act. Exact for all joint torques.
pub fn drop_symmetric_rotation<S: Scalar>(view: View<S>) -> View<S> {
    let View { model, mut formulation } = view;
    let mut carries = vec![false; model.bodies().len()];
    model.outward().for_each(|i| carries[model.bodies()[i].parent] = true);
    model.frames().iter().for_each(|frame| carries[frame.body] = true);
    let model = model.changed(|parts| {
        for (i, body) in parts.bodies.iter_mut().enumerate().skip(1).filter(|(i, _)| !carries[*i]) {
            if body.joint.is_rotation_about_axis() && body.effects.body.is_empty() && made_axisymmetric(body) {
                formulation.rotations[i].share = S::zero();
            }
        }
    });
    View { model, formulation }
}

/// Whether a body is the same from all sides about its z-axis, but for rounding; that is then taken away.
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
