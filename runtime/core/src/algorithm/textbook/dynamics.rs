//! Inverse dynamics in the plain matrix form; what follows from it by linearity.

use alloc::vec;
use alloc::vec::Vec;

use nalgebra::{Matrix6, Vector3, Vector6};

use super::Textbook;
use super::joint::sum;
use super::matrix::{ad, adjoint_of_inverse, halves, stack};
use super::solve::Factor;
use crate::Scalar;
use crate::spatial::{Placement, Reference};

/// What the sweep outward finds, body by body.
pub(super) struct Sweep<S> {
    /// Ad(T_iλ).
    adjoint: Vec<Matrix6<S>>,
    /// Columns of S_i.
    screws: Vec<Vec<Vector6<S>>>,
    /// V_i.
    pub(super) twist: Vec<Vector6<S>>,
    /// V̇_i, less gravity.
    pub(super) acceleration: Vec<Vector6<S>>,
}

impl<S: Scalar> Textbook<S> {
    /// Twists and accelerations; V̇_0 = [0; −g].
    pub(super) fn outward(&self, q: &[S], v: &[S], a: &[S]) -> Sweep<S> {
        let n = self.bodies.len();
        let (mut twist, mut acceleration) = (vec![Vector6::<S>::zeros(); n], vec![Vector6::<S>::zeros(); n]);
        let relative = |b: &super::Link<S>| b.placement.compose(&b.joint.placement(q));
        // Ad(T_iλ) with T_iλ = (T_λi)⁻¹
        let adjoint: Vec<Matrix6<S>> = self.bodies.iter().map(|b| adjoint_of_inverse(&relative(b))).collect();
        let screws: Vec<Vec<Vector6<S>>> = self.bodies.iter().map(|b| b.joint.screws(q)).collect();
        for (i, body) in self.bodies.iter().enumerate() {
            let (v_parent, a_parent) = match body.parent {
                Some(p) => (twist[p], acceleration[p]),
                None => (Vector6::zeros(), stack(Vector3::zeros(), -self.gravity)),
            };
            let rate = sum(&screws[i], &body.joint.rates(v));
            // V_i = Ad(T_iλ) V_λ + S_i q̇_i
            twist[i] = adjoint[i] * v_parent + rate;
            // V̇_i = Ad(T_iλ) V̇_λ + S_i q̈_i + Ṡ_i q̇_i + ad(V_i) S_i q̇_i
            let own = sum(&screws[i], &body.joint.rates(a)) + body.joint.bias(q, v);
            acceleration[i] = adjoint[i] * a_parent + own + ad(&twist[i]) * rate;
        }
        Sweep { adjoint, screws, twist, acceleration }
    }

    /// F_i = G_i V̇_i − ad(V_i)ᵀ G_i V_i, for a G of each body.
    pub(super) fn needed(sweep: &Sweep<S>, i: usize, g: &Matrix6<S>) -> Vector6<S> {
        g * sweep.acceleration[i] - ad(&sweep.twist[i]).transpose() * (g * sweep.twist[i])
    }

    /// τ of the wrenches that the bodies need, which become the wrenches that the joints pass.
    pub(super) fn inward(&self, sweep: &Sweep<S>, wrench: &mut [Vector6<S>]) -> Vec<S> {
        let mut tau = self.rest();
        for (i, body) in self.bodies.iter().enumerate().rev() {
            // τ_i = S_iᵀ F_i
            body.joint.add_torque(&sweep.screws[i], &wrench[i], &mut tau);
            if let Some(p) = body.parent {
                // F_λ += Ad(T_iλ)ᵀ F_i
                let below = sweep.adjoint[i].transpose() * wrench[i];
                wrench[p] += below;
            }
        }
        tau
    }

    /// Wrenches needed by every body.
    fn all_needed(&self, sweep: &Sweep<S>) -> Vec<Vector6<S>> {
        self.bodies.iter().enumerate().map(|(i, body)| Self::needed(sweep, i, &body.inertia)).collect()
    }

    /// τ = M(q)·a + h(q, v), `[nv]`.
    pub fn inverse_dynamics(&self, q: &[S], v: &[S], a: &[S]) -> Vec<S> {
        let sweep = self.outward(q, v, a);
        self.inward(&sweep, &mut self.all_needed(&sweep))
    }

    /// τ = M(q)·a + h(q, v) − Σ Jᵀw, `[nv]`; wrenches `[frames][6]`: what the world gives to a body, its joint need not.
    pub fn inverse_dynamics_with_wrenches(&self, q: &[S], v: &[S], a: &[S], wrenches: &[S]) -> Vec<S> {
        let (sweep, poses) = (self.outward(q, v, a), self.poses(q));
        let mut needed = self.all_needed(&sweep);
        for (&body, w) in self.frames.iter().zip(wrenches.chunks_exact(6)) {
            needed[body] -= body_wrench(self.wrench_reference, &poses[body], &Vector6::from_column_slice(w));
        }
        self.inward(&sweep, &mut needed)
    }

    /// What each joint passes to its child link, `[links][6]`, in the link's frame.
    pub fn joint_wrenches(&self, q: &[S], v: &[S], a: &[S]) -> Vec<S> {
        let sweep = self.outward(q, v, a);
        let mut wrenches = self.all_needed(&sweep);
        self.inward(&sweep, &mut wrenches);
        self.moving_links().flat_map(|i| wrenches[i].iter().copied().collect::<Vec<_>>()).collect()
    }

    /// M(q), column by column: the torques of a unit acceleration of one joint, at rest and without gravity. `[nv][nv]`.
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

/// A wrench in the axes of its frame, about the frame's origin. Power is the same in every reference.
fn body_wrench<S: Scalar>(reference: Reference, x: &Placement<S>, w: &Vector6<S>) -> Vector6<S> {
    let (moment, force) = halves(w);
    let back = x.rotation.transpose();
    match reference {
        Reference::Body => *w,
        Reference::World => stack(back * (moment - x.position.cross(&force)), back * force),
        Reference::WorldAligned => stack(back * moment, back * force),
    }
}
