//! Rotations of frames at a configuration, folded into the constants of their bodies.

use articulated_core::Scalar;
use articulated_core::index::{BodyId, ById};
use articulated_core::joint::{Angle, JointLaw, Revolute};
use articulated_core::model::{Body, Model};
use articulated_core::spatial::Matrix3;

use super::view::View;

/// Which revolute bodies have frames that do not rotate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FoldedRotations {
    /// Rows of bodies on parallel joints: each row has the axes of its first body, and no vector is
    /// rotated from one to the next and back.
    Parallel,
    /// These, and bodies without children.
    ParallelAndLast,
}

impl<S: Scalar> View<S> {
    /// The view at the configuration q with frames of these bodies that do not rotate: their
    /// constants (offsets, moments of mass) are rotated instead, by the sum of the angles.
    ///
    /// q: `[nq]` rad|m|quaternion. Joint torques, M(q) and quantities that follow from them are
    /// those of the robot itself, at this q only. Frames are not kept, and the model must have no
    /// effects on bodies.
    ///
    /// # Panics
    /// If q is shorter than stated.
    #[must_use]
    pub fn fold_rotations_into_constants(&self, q: &[S], which: FoldedRotations) -> Self {
        let View { model, mut formulation } = self.clone();
        let stays = self.stays(which);
        let mut folded: ById<BodyId, Angle<S>> = vec![Angle::zero(); self.model.bodies().len()].into();
        let model = model.without_frames().changed(|parts| {
            for (i, to) in parts.bodies.with_ids_mut().skip(1) {
                let from = &self.model.bodies()[i];
                let carried = folded[from.parent];
                let in_row = stays[i] && stays[from.parent] && continues(&self.model, from);
                to.placement.position = carried.rotation() * from.placement.position;
                to.placement.rotation = if in_row { Matrix3::identity() } else { carried.rotation() * from.placement.rotation };
                if stays[i] {
                    let own = self.formulation.rotations[i].angle(&from.coordinates, q);
                    let (sin, cos) = if in_row { carried.plus((own.sin, own.cos)) } else { (own.sin, own.cos) };
                    folded[i] = Angle { sin, cos };
                    formulation.rotations[i].share = S::zero();
                    let rotation = Revolute::of(folded[i]);
                    to.inertia = rotation.inertia_to_joint(&from.inertia);
                    if let Some(inertia) = formulation.torque_inertias.get_mut(i) {
                        *inertia = rotation.inertia_to_joint(inertia);
                    }
                }
            }
        });
        View { model, formulation }
    }

    /// Choices for [`View::fold_rotations_into_constants`]: each that folds further bodies.
    pub fn foldable_rotations(&self) -> Vec<FoldedRotations> {
        let none = ById::<BodyId, _>::from(vec![false; self.model.bodies().len()]);
        let [parallel, all] = [FoldedRotations::Parallel, FoldedRotations::ParallelAndLast].map(|which| self.stays(which));
        let mut choices = Vec::new();
        choices.extend((parallel != none).then_some(FoldedRotations::Parallel));
        choices.extend((all != parallel).then_some(FoldedRotations::ParallelAndLast));
        choices
    }

    /// Whether the frame of each body does not rotate.
    fn stays(&self, which: FoldedRotations) -> ById<BodyId, bool> {
        let (model, last) = (&self.model, which == FoldedRotations::ParallelAndLast);
        let mut stays = ById::<BodyId, _>::from(vec![last; model.bodies().len()]);
        stays[BodyId::BASE] = false;
        model.outward().for_each(|i| stays[model.bodies()[i].parent] = false);
        for i in model.outward() {
            let body = &model.bodies()[i];
            stays[i] &= body.joint.is_rotation_about_axis() && self.rotates(i);
            if continues(model, body) {
                (stays[i], stays[body.parent]) = (true, true);
            }
        }
        stays
    }
}

/// Whether a body's joint is parallel to that of its parent, and its frame not turned against the
/// parent's.
fn continues<S: Scalar>(model: &Model<S>, body: &Body<S>) -> bool {
    let rotates = |body: &Body<S>| body.joint.is_rotation_about_axis();
    body.parent != BodyId::BASE && rotates(body) && rotates(&model.bodies()[body.parent]) && body.placement.rotation == Matrix3::identity()
}
