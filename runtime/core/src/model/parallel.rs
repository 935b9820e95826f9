//! Bodies on parallel joints, in axes that they share.

use alloc::vec;
use alloc::vec::Vec;

use nalgebra::Matrix3;

use crate::Scalar;
use crate::joint::{Angle, Joint, JointLaw, Revolute};
use crate::model::{Body, Model};

impl<S: Scalar> Model<S> {
    /// The model as it is at the configuration q, with the bodies of each row of parallel joints in the axes in which the row begins.
    ///
    /// No vector has to be turned from one such body to the next, there and back; instead their constants are turned (offsets, moments of mass), by the sum of the angles. Joint
    /// torques, M(q) and whatever follows from them are those of the model itself, at this q alone; frames are not kept, and effects on bodies must not be there.
    pub fn unturned(&self, q: &[S]) -> Self {
        let mut model = self.clone();
        model.frames.clear();
        let rows = self.rows();
        let mut turned: Vec<Angle<S>> = vec![Angle::zero(); self.bodies.len()];
        for i in self.outward() {
            let (from, to) = (&self.bodies[i], &mut model.bodies[i]);
            let carried = turned[from.parent];
            to.placement.position = carried.rotation() * from.placement.position;
            if rows[i] == Some(from.parent) {
                to.placement.rotation = Matrix3::identity();
            } else {
                to.placement.rotation = carried.rotation() * from.placement.rotation;
            }
            if rows[i].is_some() {
                let own = from.coordinates.turned(q);
                let (sin, cos) = if rows[i] == Some(from.parent) { carried.plus(own) } else { own };
                turned[i] = Angle { sin, cos };
                to.coordinates.turns = S::zero();
                to.inertia = Revolute::of(turned[i]).inertia_to_joint(&from.inertia);
            }
        }
        model
    }

    /// Whether there are joints that are parallel to the one before.
    pub fn has_parallel_joints(&self) -> bool {
        self.outward().any(|i| self.continues(&self.bodies[i]))
    }

    /// For each body of a row its parent if that is of it, or itself where the row begins.
    fn rows(&self) -> Vec<Option<usize>> {
        let mut rows = vec![None; self.bodies.len()];
        for i in self.outward().filter(|&i| self.continues(&self.bodies[i])) {
            let parent = self.bodies[i].parent;
            rows[i] = Some(parent);
            rows[parent] = rows[parent].or(Some(parent));
        }
        rows
    }

    /// Whether a body's joint is parallel to that of its parent, and its frame not turned against the parent's.
    fn continues(&self, body: &Body<S>) -> bool {
        let turn = &body.placement.rotation;
        let plain = |joint| joint == Joint::Revolute;
        body.parent != 0 && plain(body.joint) && plain(self.bodies[body.parent].joint) && *turn == Matrix3::identity()
    }
}
