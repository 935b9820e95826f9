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
    /// For each degree of freedom the next one on the way to the base, as [`below`] gives them.
    pub(super) below: Vec<usize>,
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
            below: below(model),
            matrix: vec![S::zero(); nv * nv],
        }
    }
}

/// For each degree of freedom the number of the next one on the way to the base plus one; 0 where the base is next. The mass matrix is zero
/// between degrees of freedom neither of which is on the other's way (Featherstone 2008, §6.5). Joints that follow others tie branches together: then all are one chain.
fn below<S: Scalar>(model: &Model<S>) -> Vec<usize> {
    let tied = model.bodies.iter().any(|b| b.coordinates.mimic.is_some());
    let mut below: Vec<usize> = (0..model.nv).collect();
    for i in model.outward().filter(|_| !tied) {
        let (body, parent) = (&model.bodies[i], &model.bodies[model.bodies[i].parent]);
        below[body.coordinates.v] = if body.parent == 0 { 0 } else { parent.coordinates.v + parent.joint.nv() };
    }
    below
}
