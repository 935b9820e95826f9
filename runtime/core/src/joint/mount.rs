//! From a body to its parent and back.

use nalgebra::{Matrix3, Vector3};

use super::JointLaw;
use crate::Scalar;
use crate::spatial::{ArticulatedInertia, Placement, SpatialInertia, Wrench, rotate, rotate_back};

/// How the child of a joint is placed in its parent, at one pose: as one rotation, or as that of
/// the joint's frame and that of the pose in it. One composed rotation is cheaper for numeric
/// scalars, whose zeros are unknown; the second where zeros cost nothing ([`Scalar::FOLDS`]).
#[derive(Clone, Copy)]
pub(crate) struct Mount<'a, S, P> {
    pose: P,
    /// The joint's frame in the parent.
    frame: &'a Placement<S>,
    /// From axes of the child to axes of the parent; not used where zeros cost nothing.
    turn: Matrix3<S>,
    /// The child's origin in the parent, m.
    pub(crate) origin: Vector3<S>,
}

impl<'a, S: Scalar, P: JointLaw<S>> Mount<'a, S, P> {
    /// At this pose, in this frame of the joint.
    #[inline(always)]
    pub(crate) fn new(pose: P, frame: &'a Placement<S>) -> Self {
        let turn = if S::FOLDS {
            frame.rotation
        } else {
            pose.compose(Placement { rotation: frame.rotation, position: Vector3::zeros() }).rotation
        };
        Self { pose, frame, turn, origin: pose.origin(frame) }
    }

    /// A vector in axes of the child, from axes of the parent.
    #[inline(always)]
    pub(crate) fn outward(&self, v: Vector3<S>) -> Vector3<S> {
        let turned = rotate_back(&self.turn, v);
        if S::FOLDS { self.pose.to_child(turned) } else { turned }
    }

    /// A vector in axes of the parent, from axes of the child.
    #[inline(always)]
    pub(crate) fn inward(&self, v: Vector3<S>) -> Vector3<S> {
        rotate(&self.turn, if S::FOLDS { self.pose.to_joint(v) } else { v })
    }

    /// A wrench in the parent's frame, from the child's: [R n + p × R f; R f].
    #[inline(always)]
    pub(crate) fn wrench(&self, wrench: &Wrench<S>) -> Wrench<S> {
        let force = self.inward(wrench.force);
        let moment = self.inward(wrench.moment);
        Wrench { moment: moment + self.origin.cross(&force), force }
    }

    /// The child's mass as the parent has it.
    #[inline(always)]
    pub(crate) fn inertia(&self, inertia: &SpatialInertia<S>) -> SpatialInertia<S> {
        if S::FOLDS { self.pose.inertia_to_joint(inertia).moved(self.frame) } else { inertia.moved(&self.whole()) }
    }

    /// The same of an articulated inertia.
    #[inline(always)]
    pub(crate) fn articulated(&self, inertia: &ArticulatedInertia<S>) -> ArticulatedInertia<S> {
        if S::FOLDS {
            let frame = Placement { rotation: self.frame.rotation, position: self.origin };
            self.pose.articulated_to_joint(inertia).moved(&frame)
        } else {
            inertia.moved(&self.whole())
        }
    }

    /// The child in the parent.
    #[inline(always)]
    fn whole(&self) -> Placement<S> {
        Placement { rotation: self.turn, position: self.origin }
    }
}
