//! Inverse dynamics, and functions that follow from it by linearity.

use alloc::vec;
use alloc::vec::Vec;

use nalgebra::{Vector3, Vector6};

use super::Textbook;
use super::matrix::{adjoint, halves, stack};
use super::rnea::{inward, needed, outward, rnea};
use super::solve::Factor;
use crate::Scalar;
use crate::spatial::{Placement, Reference};

impl<S: Scalar> Textbook<S> {
    /// τ = M(q)·a + h(q, v), `[nv]`.
    pub fn inverse_dynamics(&self, q: &[S], v: &[S], a: &[S]) -> Vec<S> {
        rnea(&self.at(q, v), v, a, &[])
    }

    /// τ = M(q)·a + h(q, v) − Σ Jᵀw, `[nv]`; wrenches `[frames][6]`: a joint need not supply what
    /// the world supplies to its body.
    pub fn inverse_dynamics_with_wrenches(&self, q: &[S], v: &[S], a: &[S], wrenches: &[S]) -> Vec<S> {
        let (poses, mut on_bodies) = (self.poses(q), vec![Vector6::zeros(); self.bodies.len()]);
        for (&body, w) in self.frames.iter().zip(wrenches.chunks_exact(6)) {
            on_bodies[body] += body_wrench(self.wrench_reference, &poses[body], &Vector6::from_column_slice(w));
        }
        rnea(&self.at(q, v), v, a, &on_bodies)
    }

    /// The wrench that each joint passes to its link, `[links][6]`, in the link's frame.
    pub fn joint_wrenches(&self, q: &[S], v: &[S], a: &[S]) -> Vec<S> {
        let tree = self.at(q, v);
        let motion = outward(&tree, v, a);
        let mut wrenches: Vec<Vector6<S>> = tree.bodies.iter().zip(&motion).map(|(b, m)| needed(&b.inertia, m)).collect();
        inward(&tree, &mut wrenches);
        // F_link = Ad(T_i,link)ᵀ F_i
        let seats = self.seats();
        let one = |link: usize| adjoint(&seats[link].1).transpose() * wrenches[seats[link].0];
        self.moving_links().into_iter().flat_map(|link| one(link).iter().copied().collect::<Vec<_>>()).collect()
    }

    /// M(q), column by column: the torques of a unit acceleration of one joint, at rest and without
    /// gravity. `[nv][nv]`.
    pub fn mass_matrix(&self, q: &[S]) -> Vec<S> {
        let n = self.nv;
        let weightless = Self { gravity: Vector3::zeros(), ..self.clone() };
        let mut m = vec![S::zero(); n * n];
        for j in 0..n {
            let column = weightless.inverse_dynamics(q, &self.rest(), &self.unit(j));
            column.into_iter().enumerate().for_each(|(i, x)| m[i * n + j] = x);
        }
        m
    }

    /// M⁻¹, ready to be applied.
    pub(super) fn factored_mass_matrix(&self, q: &[S]) -> Factor<S> {
        Factor::new(&self.mass_matrix(q), self.nv)
    }

    /// a with M a = τ − h + Σ Jᵀw, `[nv]`.
    pub fn forward_dynamics_with_wrenches(&self, q: &[S], v: &[S], tau: &[S], wrenches: &[S]) -> Vec<S> {
        let bias = self.inverse_dynamics_with_wrenches(q, v, &self.rest(), wrenches);
        let given: Vec<S> = tau.iter().zip(&bias).map(|(&t, &h)| t - h).collect();
        self.factored_mass_matrix(q).solve(&given)
    }

    /// M⁻¹, `[nv][nv]`.
    pub fn mass_matrix_inverse(&self, q: &[S]) -> Vec<S> {
        self.factored_mass_matrix(q).inverse()
    }

    /// M⁻¹ τ, `[nv]`.
    pub fn solve_mass_matrix(&self, q: &[S], tau: &[S]) -> Vec<S> {
        self.factored_mass_matrix(q).solve(tau)
    }

    /// J M⁻¹ Jᵀ of each frame, J world aligned: `[frames][6][6]`.
    pub fn operational_space_inertia_inverse(&self, q: &[S]) -> Vec<S> {
        let factor = self.factored_mass_matrix(q);
        let jacobians = self.jacobians(Reference::WorldAligned, q);
        let one = |frame: usize| {
            let row = |i: usize| &jacobians[(6 * frame + i) * self.nv..][..self.nv];
            // Columns M⁻¹ Jᵀ e_j; the product is symmetric.
            let solved: Vec<Vec<S>> = (0..6).map(|j| factor.solve(row(j))).collect();
            let entry = |i: usize, j: usize| row(i).iter().zip(&solved[j]).fold(S::zero(), |sum, (&x, &y)| sum + x * y);
            (0..36).map(|k| entry(k / 6, k % 6)).collect::<Vec<S>>()
        };
        (0..self.frames.len()).flat_map(one).collect()
    }

    /// (J M⁻¹ Jᵀ)⁻¹ of each frame, `[frames][6][6]`.
    pub fn operational_space_inertia(&self, q: &[S]) -> Vec<S> {
        self.operational_space_inertia_inverse(q).chunks_exact(36).flat_map(|m| Factor::new(m, 6).inverse()).collect()
    }
}

/// A wrench in the axes of its frame, about the frame's origin. Power is the same in every
/// reference.
fn body_wrench<S: Scalar>(reference: Reference, x: &Placement<S>, w: &Vector6<S>) -> Vector6<S> {
    let (moment, force) = halves(w);
    let back = x.rotation.transpose();
    match reference {
        Reference::Body => *w,
        Reference::World => stack(back * (moment - x.position.cross(&force)), back * force),
        Reference::WorldAligned => stack(back * moment, back * force),
    }
}
