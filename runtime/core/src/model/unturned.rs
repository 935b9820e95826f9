//! Bodies whose frames do not turn at a configuration: their constants do.

use alloc::boxed::Box;
use alloc::vec;
use alloc::vec::Vec;

use nalgebra::Matrix3;

use crate::Scalar;
use crate::joint::{Angle, JointLaw, Revolute};
use crate::model::{Body, Model};

/// Which revolute bodies have frames that do not turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unturned {
    /// Rows of bodies on parallel joints: each row has the axes in which it begins, and no vector has to be turned from one to the next, there and back.
    Parallel,
    /// These, and bodies that carry no other.
    ParallelAndLast,
}

impl<S: Scalar> Model<S> {
    /// The model as it is at the configuration q, where the frames of these bodies stay, and their constants are turned instead (offsets, moments of mass), by the sum of the angles.
    ///
    /// q: `[nq]` rad|m|quaternion. Joint torques, M(q) and whatever follows from them are those of the model itself, at this q alone; frames are not kept, and effects on bodies must not be there.
    ///
    /// # Panics
    /// If q is shorter than stated.
    pub fn unturned(&self, q: &[S], which: Unturned) -> Self {
        let mut model = self.clone();
        model.frames.clear();
        let stays = self.stays(which);
        let mut turned: Vec<Angle<S>> = vec![Angle::zero(); self.bodies.len()];
        for i in self.outward() {
            let (from, to) = (&self.bodies[i], &mut model.bodies[i]);
            let carried = turned[from.parent];
            let in_row = stays[i] && stays[from.parent] && self.continues(from);
            to.placement.position = carried.rotation() * from.placement.position;
            to.placement.rotation = if in_row { Matrix3::identity() } else { carried.rotation() * from.placement.rotation };
            if stays[i] {
                let own = from.coordinates.turned(q);
                let (sin, cos) = if in_row { carried.plus(own) } else { own };
                turned[i] = Angle { sin, cos };
                to.coordinates.turns = S::zero();
                let turn = Revolute::of(turned[i]);
                to.inertia = turn.inertia_to_joint(&from.inertia);
                to.lent = from.lent.as_ref().map(|lent| Box::new(turn.inertia_to_joint(lent)));
            }
        }
        model
    }

    /// What [`Model::unturned`] has to choose from: nothing where no body is of the kind.
    pub fn unturnable(&self) -> Vec<Unturned> {
        let [none, parallel, all] = [vec![false; self.bodies.len()], self.stays(Unturned::Parallel), self.stays(Unturned::ParallelAndLast)];
        let mut choices = Vec::new();
        choices.extend((parallel != none).then_some(Unturned::Parallel));
        choices.extend((all != parallel).then_some(Unturned::ParallelAndLast));
        choices
    }

    /// Whether the frame of each body stays.
    fn stays(&self, which: Unturned) -> Vec<bool> {
        let last = which == Unturned::ParallelAndLast;
        let mut stays = vec![last; self.bodies.len()];
        stays[0] = false;
        self.outward().for_each(|i| stays[self.bodies[i].parent] = false);
        for i in self.outward() {
            let body = &self.bodies[i];
            stays[i] &= body.joint.is_rotation_about_axis() && !body.coordinates.turns.is_zero();
            if self.continues(body) {
                (stays[i], stays[body.parent]) = (true, true);
            }
        }
        stays
    }

    /// Whether a body's joint is parallel to that of its parent, and its frame not turned against the parent's.
    fn continues(&self, body: &Body<S>) -> bool {
        let turn = &body.placement.rotation;
        let plain = |body: &Body<S>| body.joint.is_rotation_about_axis();
        body.parent != 0 && plain(body) && plain(&self.bodies[body.parent]) && *turn == Matrix3::identity()
    }
}
