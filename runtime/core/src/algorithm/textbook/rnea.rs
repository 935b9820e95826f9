//! The recursive Newton–Euler algorithm on one page (Lynch & Park 2017, §8.3.2).
//!
//! Outward, with V_0 = 0 and V̇_0 = [0; −g]:
//!
//! ```text
//! V_i = Ad(T_iλ) V_λ + S_i q̇_i
//! V̇_i = Ad(T_iλ) V̇_λ + S_i q̈_i + Ṡ_i q̇_i + ad(V_i) S_i q̇_i
//! ```
//!
//! Inward, with the wrench w_i that the world applies to body i:
//!
//! ```text
//! F_i = G_i V̇_i − ad(V_i)ᵀ G_i V_i − w_i + Σ Ad(T_ki)ᵀ F_k   over the children k of i
//! τ_i = S_iᵀ F_i
//! ```

use alloc::vec;
use alloc::vec::Vec;

use nalgebra::{Matrix6, Vector3, Vector6};

use super::matrix::{ad, stack};
use super::tree::Tree;
use crate::Scalar;

/// Twist and acceleration of a body, in its own axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyMotion<S> {
    /// V_i.
    pub twist: Vector6<S>,
    /// V̇_i − [0; g]: the acceleration that an accelerometer measures.
    pub acceleration: Vector6<S>,
}

/// τ = M(q) q̈ + h(q, q̇) − Σ Jᵀw.
///
/// v, a: `[nv]`, q̇ and q̈; wrenches: one for each body in its own axes, or empty; result: `[nv]`.
///
/// # Panics
/// If a slice is shorter than stated.
pub fn rnea<S: Scalar>(tree: &Tree<S>, v: &[S], a: &[S], wrenches: &[Vector6<S>]) -> Vec<S> {
    let motion = outward(tree, v, a);
    let mut f: Vec<Vector6<S>> = tree.bodies.iter().zip(&motion).map(|(body, m)| needed(&body.inertia, m)).collect();
    f.iter_mut().zip(wrenches).for_each(|(f, w)| *f -= w);
    inward(tree, &mut f)
}

/// V_i and V̇_i of every body.
pub fn outward<S: Scalar>(tree: &Tree<S>, v: &[S], a: &[S]) -> Vec<BodyMotion<S>> {
    // V_0 = 0, V̇_0 = [0; −g]
    let world = BodyMotion { twist: Vector6::zeros(), acceleration: stack(Vector3::zeros(), -tree.gravity) };
    let mut motion: Vec<BodyMotion<S>> = Vec::with_capacity(tree.bodies.len());
    for body in &tree.bodies {
        let parent = body.parent.map_or(world, |p| motion[p]);
        let rate = &body.screws * body.part(v);
        // V_i = Ad(T_iλ) V_λ + S_i q̇_i
        let twist = body.adjoint * parent.twist + rate;
        // V̇_i = Ad(T_iλ) V̇_λ + S_i q̈_i + Ṡ_i q̇_i + ad(V_i) S_i q̇_i
        let acceleration = body.adjoint * parent.acceleration + &body.screws * body.part(a) + body.screw_rate + ad(&twist) * rate;
        motion.push(BodyMotion { twist, acceleration });
    }
    motion
}

/// G V̇ − ad(V)ᵀ G V: the wrench that a body of the inertia G needs to move so.
pub fn needed<S: Scalar>(g: &Matrix6<S>, motion: &BodyMotion<S>) -> Vector6<S> {
    g * motion.acceleration - ad(&motion.twist).transpose() * (g * motion.twist)
}

/// τ of the wrenches that the bodies need. Each `f[i]` becomes F_i, the wrench that joint i passes.
pub fn inward<S: Scalar>(tree: &Tree<S>, f: &mut [Vector6<S>]) -> Vec<S> {
    let mut tau = vec![S::zero(); tree.nv];
    for (i, body) in tree.bodies.iter().enumerate().rev() {
        // τ_i = S_iᵀ F_i
        for (k, screw) in body.screws.column_iter().enumerate() {
            tau[body.at + k] += screw.dot(&f[i]);
        }
        // F_λ += Ad(T_iλ)ᵀ F_i
        if let Some(p) = body.parent {
            let passed = body.adjoint.transpose() * f[i];
            f[p] += passed;
        }
    }
    tau
}
