//! Placements, and their derivatives along a motion: twists, Jacobians, accelerations.

use alloc::vec;
use alloc::vec::Vec;

use nalgebra::Vector6;

use super::matrix::{stack, vee};
use super::{Textbook, varied};
use crate::Scalar;
use crate::dual::Dual;
use crate::spatial::{Placement, Reference};

/// Six numbers for each degree of freedom: a Jacobian by its columns.
pub(super) type Columns<S> = Vec<Vector6<S>>;

impl<S: Scalar> Textbook<S> {
    /// T of every body in the world frame.
    pub(super) fn poses(&self, q: &[S]) -> Vec<Placement<S>> {
        let mut poses: Vec<Placement<S>> = Vec::with_capacity(self.bodies.len());
        for body in &self.bodies {
            let x = body.placement.compose(&body.joint.placement(q));
            poses.push(body.parent.map_or(x, |p| poses[p].compose(&x)));
        }
        poses
    }

    /// q ⊕ ε v, to first order: q + ε q̇ with the q̇ of the rates v.
    pub(super) fn along(&self, q: &[S], v: &[S]) -> Vec<Dual<S>> {
        let mut rates = vec![S::zero(); self.nq];
        self.bodies.iter().for_each(|body| body.joint.write_coordinate_rates(q, v, &mut rates));
        varied(q, &rates)
    }

    /// T of every body, moving along v.
    pub(super) fn moving_poses(&self, q: &[S], v: &[S]) -> Vec<Placement<Dual<S>>> {
        self.lift().poses(&self.along(q, v))
    }

    /// Twist of every body.
    pub(super) fn body_twists(&self, reference: Reference, q: &[S], v: &[S]) -> Vec<Vector6<S>> {
        self.moving_poses(q, v).iter().map(|x| twist(reference, x)).collect()
    }

    /// J of every body: its twist for every unit of rate.
    pub(super) fn body_jacobians(&self, reference: Reference, q: &[S]) -> Vec<Columns<S>> {
        let mut jacobians = vec![Vec::with_capacity(self.nv); self.bodies.len()];
        let lifted = self.lift();
        for k in 0..self.nv {
            let poses = lifted.poses(&self.along(q, &self.unit(k)));
            jacobians.iter_mut().zip(&poses).for_each(|(j, x)| j.push(twist(reference, x)));
        }
        jacobians
    }

    /// dJ/dt of every body.
    pub(super) fn body_jacobian_rates(&self, reference: Reference, q: &[S], v: &[S]) -> Vec<Columns<S>> {
        let jacobians = self.lift().body_jacobians(reference, &self.along(q, v));
        jacobians.into_iter().map(|columns| columns.into_iter().map(|c| c.map(|x| x.slope)).collect()).collect()
    }

    /// The values of the frames, from those of all bodies.
    fn of_frames<'a, T>(&'a self, all: &'a [T]) -> impl Iterator<Item = &'a T> {
        self.frames.iter().map(|&body| &all[body])
    }

    /// `[frames][12]`.
    pub fn placements(&self, q: &[S]) -> Vec<S> {
        self.of_frames(&self.poses(q)).flat_map(Placement::to_array).collect()
    }

    /// ∂(placements)/∂q in the tangent space, `[frames][12][nv]`.
    pub fn placement_derivatives(&self, q: &[S]) -> Vec<S> {
        let along = |k: usize| self.lift().placements(&self.along(q, &self.unit(k)));
        let columns: Vec<Vec<Dual<S>>> = (0..self.nv).map(along).collect();
        (0..12 * self.frames.len()).flat_map(|i| columns.iter().map(move |c| c[i].slope)).collect()
    }

    /// `[frames][6]`.
    pub fn twists(&self, reference: Reference, q: &[S], v: &[S]) -> Vec<S> {
        let twists = self.body_twists(reference, q, v);
        self.of_frames(&twists).flat_map(|t| t.iter().copied()).collect()
    }

    /// d(twists)/dt along the motion q(t), v(t): `[frames][6]`.
    pub fn accelerations(&self, reference: Reference, q: &[S], v: &[S], a: &[S]) -> Vec<S> {
        super::slopes(&self.lift().twists(reference, &self.along(q, v), &varied(v, a)))
    }

    /// `[frames][6][nv]`.
    pub fn jacobians(&self, reference: Reference, q: &[S]) -> Vec<S> {
        let jacobians = self.body_jacobians(reference, q);
        self.of_frames(&jacobians).flat_map(|j| rows(j)).collect()
    }

    /// d(jacobians)/dt, `[frames][6][nv]`.
    pub fn jacobian_rates(&self, reference: Reference, q: &[S], v: &[S]) -> Vec<S> {
        let rates = self.body_jacobian_rates(reference, q, v);
        self.of_frames(&rates).flat_map(|j| rows(j)).collect()
    }
}

/// A Jacobian row by row.
fn rows<S: Scalar>(columns: &[Vector6<S>]) -> Vec<S> {
    (0..6).flat_map(|i| columns.iter().map(move |c| c[i])).collect()
}

/// The twist of a frame that moves as T + ε Ṫ, Lynch & Park 2017, §3.3.2:
///
/// body [vee(RᵀṘ); Rᵀṗ], world [ω; ṗ − ω × p] with ω = vee(ṘRᵀ), world aligned [ω; ṗ].
pub(super) fn twist<S: Scalar>(reference: Reference, x: &Placement<Dual<S>>) -> Vector6<S> {
    let (r, rate) = (x.rotation.map(|c| c.value), x.rotation.map(|c| c.slope));
    let (p, velocity) = (x.position.map(|c| c.value), x.position.map(|c| c.slope));
    let omega = vee(&(rate * r.transpose()));
    match reference {
        Reference::Body => stack(vee(&(r.transpose() * rate)), r.transpose() * velocity),
        Reference::World => stack(omega, velocity - omega.cross(&p)),
        Reference::WorldAligned => stack(omega, velocity),
    }
}
