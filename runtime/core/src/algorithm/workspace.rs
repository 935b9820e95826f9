//! State of an algorithm between its sweeps.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use nalgebra::{Matrix3, Vector3};

use super::checked::Size;
use super::{Formulation, Shape};
use crate::Scalar;
use crate::index::{BodyId, ById};
use crate::joint::Pose;
use crate::model::{Body, Model};
use crate::spatial::{ArticulatedInertia, CoriolisInertia, Motion, Placement, SpatialInertia, Twist, Wrench};

/// Room for one evaluation of any algorithm on one model: made once, used by every call, so that no
/// call allocates.
#[derive(Clone, Debug)]
pub struct Workspace<S> {
    /// The sizes of the model it was made for.
    pub(super) shape: Shape,
    /// The parent of each body, as in that model, and whether it is a link.
    tree: ById<BodyId, (BodyId, bool)>,
    pub(super) bodies: ById<BodyId, BodyState<S>>,
    pub(super) placements: ById<BodyId, Placement<S>>,
    pub(super) zeros: Vec<S>,
    /// Inertia of each body and all that it carries, in its frame.
    pub(super) composite: ById<BodyId, SpatialInertia<S>>,
    /// Articulated inertia of each body, in its frame.
    pub(super) articulated: ById<BodyId, ArticulatedInertia<S>>,
    /// Magnitudes of the terms of each body's articulated inertia, for the checked form.
    pub(super) sizes: ById<BodyId, Size<S>>,
    /// Each body in common axes.
    pub(super) common: ById<BodyId, CommonState<S>>,
    /// The columns of all joint subspaces, followers' too; [`Workspace::columns_of`] says which are
    /// a body's.
    pub(super) columns: Vec<Column<S>>,
    /// First column of each body, and the number of all.
    first: Vec<usize>,
    /// End of the columns of each body and all that it carries.
    end: ById<BodyId, usize>,
    /// Room to mark bodies.
    pub(super) is_needed: ById<BodyId, bool>,
    /// The bodies in the middle of their trees.
    pub(super) centers: Centers,
    /// The first bodies of all trees.
    firsts: Centers,
    /// One row of a matrix, `[nv]`.
    pub(super) row: Vec<S>,
    /// For each degree of freedom the next one on the path to the root, as [`below`] gives them.
    pub(crate) parent_dof: Vec<usize>,
    /// `[nv · nv]`.
    pub(super) matrix: Vec<S>,
    /// `[6 · nv]`.
    pub(super) six_rows: Vec<S>,
    /// Torques that motors give, `[nv]`.
    pub(super) driven: Vec<S>,
    /// Accelerations that were solved for, `[nv]`.
    pub(super) solution: Vec<S>,
    /// How the algorithms compute.
    /// Numbers on the diagonal of M beside those of the robot, for solutions of a step; none
    /// outside of one.
    pub(crate) diagonal: Vec<Option<S>>,
    /// The same below the diagonal, (row, column, number), where M may have entries: for M = Lᵀ D L
    /// alone.
    pub(crate) coupled: Vec<(usize, usize, S)>,
    pub(super) formulation: Formulation<S>,
}

/// One body's quantities of the current evaluation, in its own axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct BodyState<S> {
    /// The pose of its joint.
    pub(super) pose: Pose<S>,
    pub(super) motion: Motion<S>,
    /// U = [ω̇]× + [ω]×[ω]×.
    pub(super) u: Matrix3<S>,
    /// The wrench that its joint passes to it.
    pub(super) wrench: Wrench<S>,
}

/// One body's quantities of the current evaluation, in common axes, about its own origin; see
/// [`super::common`].
#[derive(Clone, Copy, Debug)]
pub(super) struct CommonState<S> {
    /// The body's axes.
    pub(super) rotation: Matrix3<S>,
    /// For a body that hangs on the base, the base's axes.
    pub(super) base: Matrix3<S>,
    /// Its origin from its parent's.
    pub(super) shift: Vector3<S>,
    /// Its origin from that of the common axes.
    pub(super) position: Vector3<S>,
    /// V_λ and V̇_λ, of the parent, at the body's origin.
    pub(super) carried_twist: Twist<S>,
    pub(super) carried_acceleration: Twist<S>,
    pub(super) twist: Twist<S>,
    /// Spatial acceleration, with gravity subtracted if requested.
    pub(super) acceleration: Twist<S>,
    pub(super) inertia: SpatialInertia<S>,
    pub(super) coriolis: CoriolisInertia<S>,
    pub(super) force: Wrench<S>,
}

/// Bodies whose axes are common to their trees, one for each that hangs on the base.
#[derive(Clone, Debug)]
pub(super) struct Centers {
    pub(super) bodies: Vec<BodyId>,
    /// Whether a body is one of them, or between one and the base.
    pub(super) inside: ById<BodyId, bool>,
}

/// One degree of freedom of a body's joint: its motion subspace in common axes, about the body's
/// origin, per unit of the coordinate that moves it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Column<S> {
    /// Index in v.
    pub(super) at: usize,
    /// S.
    pub(super) axis: Twist<S>,
    /// Of a follower that is not linear, S = f′(q) A has derivatives in q besides those of the
    /// axis A, which moves with the bodies: S′ = f″ A, S″ = f‴ A.
    pub(super) bend: Option<Twist<S>>,
    pub(super) rate_of_bend: Option<Twist<S>>,
    /// ψ̇ = V_λ × S + S′ q̇, the derivative of the body's twist in q.
    pub(super) psi_dot: Twist<S>,
    /// Ṡ = V_i × S + S′ q̇.
    pub(super) s_dot: Twist<S>,
    /// ψ̈ = V̇_λ × S + V_λ × (ψ̇ + S′ q̇) + S′ q̈ + S″ q̇².
    pub(super) psi_ddot: Twist<S>,
    /// Of the articulated-body sweep: I^A S, 1 / Sᵀ I^A S, and τ − Sᵀ p^A.
    pub(super) u: Wrench<S>,
    pub(super) inverse: S,
    pub(super) residue: S,
}

impl<S: Scalar> Workspace<S> {
    /// A workspace for `model`.
    pub fn new(model: &Model<S>) -> Self {
        Self::with_formulation(model, Formulation::default())
    }

    /// A workspace in which the algorithms compute as the formulation says.
    pub fn with_formulation(model: &Model<S>, formulation: Formulation<S>) -> Self {
        let (n, nv) = (model.bodies.len(), model.nv);
        let mut first = vec![0];
        let mut columns = Vec::new();
        for body in model.bodies.iter().skip(1) {
            first.push(columns.len());
            columns.extend((0..body.joint.nv()).map(|k| Column::zero(body.coordinates.v + k)));
        }
        first.push(columns.len());
        let mut end: ById<BodyId, usize> = first[1..].to_vec().into();
        for i in model.inward() {
            let parent = model.bodies[i].parent;
            end[parent] = end[parent].max(end[i]);
        }
        Self {
            shape: model.shape(),
            tree: model.bodies.iter().map(|b| (b.parent, b.link.is_some())).collect(),
            is_needed: vec![false; n].into(),
            centers: Centers::of(model, middles(model)),
            firsts: Centers::of(model, firsts(model).collect()),
            bodies: vec![BodyState::zero(); n].into(),
            placements: vec![Placement::identity(); n].into(),
            zeros: vec![S::zero(); nv],
            composite: vec![SpatialInertia::zero(); n].into(),
            articulated: vec![ArticulatedInertia::zero(); n].into(),
            sizes: vec![Size::zero(); n].into(),
            common: vec![CommonState::zero(); n].into(),
            columns,
            first,
            end,
            row: vec![S::zero(); nv],
            parent_dof: parent_dof(model),
            matrix: vec![S::zero(); nv * nv],
            six_rows: vec![S::zero(); 6 * nv],
            driven: vec![S::zero(); nv],
            solution: vec![S::zero(); nv],
            diagonal: Vec::new(),
            coupled: Vec::new(),
            formulation,
        }
    }

    /// Whether it was made for a model with as many frames, and with the same tree and the same
    /// coordinates.
    pub(super) fn fits(&self, model: &Model<S>) -> bool {
        let Shape { nq, nv, frames, .. } = self.shape;
        let alike = |i: BodyId| {
            let (body, columns) = (&model.bodies[i], self.columns_of(i));
            let at = self.columns.get(columns.start).map_or(nv, |column| column.at);
            self.tree[i] == (body.parent, body.link.is_some())
                && columns.len() == body.joint.nv()
                && (columns.is_empty() || at == body.coordinates.v)
        };
        let sizes = (model.nq, model.nv, model.frames.len(), model.bodies.len()) == (nq, nv, frames, self.tree.len());
        sizes && model.outward().all(alike)
    }

    /// After inverse dynamics: the wrench that body `i` needs for itself, and the one that its
    /// joint passes to it, in its frame.
    pub(crate) fn wrenches_of(&self, model: &Model<S>, i: BodyId) -> (Wrench<S>, Wrench<S>) {
        let state = &self.bodies[i];
        (model.bodies[i].inertia.wrench(state.motion.acceleration, &state.u), state.wrench)
    }

    /// The poses of all joints, at the coordinates in `q`: before the sweep that needs them, so
    /// that it need not wait for sines.
    #[inline(always)]
    pub(super) fn set_poses(&mut self, model: &Model<S>, q: &[S]) {
        for (i, body) in model.bodies.with_ids().skip(1) {
            self.bodies[i].pose = self.pose(body, i, q);
        }
    }

    /// The pose of the joint of body `i`.
    #[inline(always)]
    pub(super) fn pose(&self, body: &Body<S>, i: BodyId, q: &[S]) -> Pose<S> {
        match self.formulation.rotations.get(i) {
            Some(rotation) if body.joint.is_rotation_about_axis() => Pose::rotation_about_axis(rotation.angle(&body.coordinates, q)),
            _ => body.joint.pose(&body.coordinates, q),
        }
    }

    /// Whether nothing depends on the angle of body `i`: its frame does not rotate, it is
    /// axisymmetric, it carries no other, and its rate does not depend on it.
    pub(super) fn is_independent_of_angle(&self, model: &Model<S>, i: BodyId) -> bool {
        let stays = self.formulation.rotations.get(i).is_some_and(|rotation| rotation.share.is_zero());
        stays
            && !model.bodies[i].coordinates.is_bent()
            && model.bodies[i].inertia.is_axisymmetric()
            && model.outward().all(|k| model.bodies[k].parent != i)
    }

    /// The columns of the joint of body `i`, which is not the base.
    #[inline(always)]
    pub(super) fn columns_of(&self, i: BodyId) -> Range<usize> {
        self.first[i.0]..self.first[i.0 + 1]
    }

    /// The columns of the joint of body `i` and of all beyond it: bodies are in depth-first order.
    #[inline(always)]
    pub(super) fn columns_from(&self, i: BodyId) -> Range<usize> {
        self.first[i.0]..self.end[i]
    }

    /// Runs `work` with the first bodies of trees for centers.
    pub(super) fn axes_of_first_bodies(&mut self, work: impl FnOnce(&mut Self)) {
        core::mem::swap(&mut self.centers, &mut self.firsts);
        work(self);
        core::mem::swap(&mut self.centers, &mut self.firsts);
    }
}

impl<S: Scalar> BodyState<S> {
    fn zero() -> Self {
        let zero = Vector3::zeros();
        let motion = Motion { omega: zero, alpha: zero, acceleration: zero };
        Self { pose: Pose::identity(), motion, u: Matrix3::zeros(), wrench: Wrench::zero() }
    }
}

impl<S: Scalar> CommonState<S> {
    fn zero() -> Self {
        Self {
            rotation: Matrix3::identity(),
            base: Matrix3::identity(),
            shift: Vector3::zeros(),
            position: Vector3::zeros(),
            carried_twist: Twist::zero(),
            carried_acceleration: Twist::zero(),
            twist: Twist::zero(),
            acceleration: Twist::zero(),
            inertia: SpatialInertia::zero(),
            coriolis: CoriolisInertia::zero(),
            force: Wrench::zero(),
        }
    }
}

impl<S: Scalar> Column<S> {
    fn zero(at: usize) -> Self {
        let o = Twist::zero();
        Self {
            at,
            axis: o,
            bend: None,
            rate_of_bend: None,
            psi_dot: o,
            s_dot: o,
            psi_ddot: o,
            u: Wrench::zero(),
            inverse: S::zero(),
            residue: S::zero(),
        }
    }
}

/// For each body that hangs on the base, the body beyond and before which no branch has more than
/// half of the degrees of freedom of its tree.
fn middles<S: Scalar>(model: &Model<S>) -> Vec<BodyId> {
    let mut weight: ById<BodyId, usize> = model.bodies.iter().map(|b| b.joint.nv()).collect();
    for i in model.inward() {
        let parent = model.bodies[i].parent;
        weight[parent] += if parent == BodyId::BASE { 0 } else { weight[i] };
    }
    let middle = |root: BodyId| {
        let heavy = |i: &BodyId| weight[*i] * 2 > weight[root];
        // Children come after their parents.
        let next = |i: &BodyId| (i.0 + 1..model.bodies.len()).map(BodyId).find(|k| model.bodies[*k].parent == *i && heavy(k));
        core::iter::successors(Some(root), next).last().unwrap_or(root)
    };
    firsts(model).map(middle).collect()
}

/// The bodies that hang on the base.
fn firsts<S: Scalar>(model: &Model<S>) -> impl Iterator<Item = BodyId> + '_ {
    model.outward().filter(|&i| model.bodies[i].parent == BodyId::BASE)
}

/// How far from its first body the middle of a tree may be for [`near_the_middle`].
const NEAR: usize = 4;

/// Whether the first bodies of trees differ from those in the middle, but are near them with only
/// rotations between. Then their axes may be cheaper, since they have zeros of parallel joints that
/// the middle lacks.
pub(super) fn near_the_middle<S: Scalar>(model: &Model<S>) -> bool {
    let way = |i: BodyId| core::iter::successors(Some(i), |&i| Some(model.bodies[i].parent).filter(|p| !p.is_base()));
    let ways = || middles(model).into_iter().map(way);
    let turns = |i: BodyId| model.bodies[i].joint.is_rotation_about_axis();
    ways().any(|way| way.count() > 1) && ways().all(|way| way.clone().count() <= NEAR && way.into_iter().all(turns))
}

impl Centers {
    fn of<S: Scalar>(model: &Model<S>, bodies: Vec<BodyId>) -> Self {
        let mut inside: ById<BodyId, bool> = vec![false; model.bodies.len()].into();
        for &center in &bodies {
            let mut i = center;
            while !i.is_base() {
                inside[i] = true;
                i = model.bodies[i].parent;
            }
        }
        Self { bodies, inside }
    }
}

/// For each degree of freedom the number of the next one on the way to the base plus one; 0 where
/// the base is next. The mass matrix is zero between degrees of freedom neither of which is on the
/// other's way (Featherstone 2008, §6.5). Joints that follow others tie branches together: then all
/// are one chain.
pub(super) fn parent_dof<S: Scalar>(model: &Model<S>) -> Vec<usize> {
    let tied = model.has_followers();
    let mut parent_dof: Vec<usize> = (0..model.nv).collect();
    for i in model.outward().filter(|_| !tied) {
        let (body, parent) = (&model.bodies[i], &model.bodies[model.bodies[i].parent]);
        parent_dof[body.coordinates.v] = if body.parent == BodyId::BASE { 0 } else { parent.coordinates.v + parent.joint.nv() };
    }
    parent_dof
}
