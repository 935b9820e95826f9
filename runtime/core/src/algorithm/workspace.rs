//! What an algorithm keeps between its sweeps.

use alloc::vec;
use alloc::vec::Vec;

use nalgebra::{Matrix3, Vector3};

use crate::Scalar;
use crate::joint::Pose;
use crate::model::Model;
use crate::spatial::{Motion, Placement, SpatialInertia, Wrench};

/// Room for one evaluation of any algorithm on one model: made once, used by every call, so that no call allocates.
#[derive(Clone, Debug)]
pub struct Workspace<S> {
    pub(super) bodies: Vec<BodyState<S>>,
    pub(super) placements: Vec<Placement<S>>,
    pub(super) zeros: Vec<S>,
    /// Inertia of each body and all that it carries, in its frame.
    pub(super) composite: Vec<SpatialInertia<S>>,
    /// One row of a matrix, `[nv]`.
    pub(super) row: Vec<S>,
    /// `[nv · nv]`.
    pub(super) matrix: Vec<S>,
}

/// One body's quantities of the current evaluation, in its own axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct BodyState<S> {
    /// The pose of its joint.
    pub(super) pose: Option<Pose<S>>,
    /// Its origin in its parent's frame.
    pub(super) origin: Vector3<S>,
    pub(super) motion: Motion<S>,
    /// U = [ω̇]× + [ω]×[ω]×.
    pub(super) u: Matrix3<S>,
    /// The wrench that its joint passes to it.
    pub(super) wrench: Wrench<S>,
}

impl<S: Scalar> Workspace<S> {
    /// A workspace for `model`.
    pub fn new(model: &Model<S>) -> Self {
        let zero = Vector3::zeros();
        let state = BodyState {
            pose: None,
            origin: zero,
            motion: Motion { omega: zero, alpha: zero, acceleration: zero },
            u: Matrix3::zeros(),
            wrench: Wrench::zero(),
        };
        let (n, nv) = (model.bodies.len(), model.nv);
        Self {
            bodies: vec![state; n],
            placements: vec![Placement::identity(); n],
            zeros: vec![S::zero(); nv],
            composite: vec![SpatialInertia::zero(); n],
            row: vec![S::zero(); nv],
            matrix: vec![S::zero(); nv * nv],
        }
    }
}
