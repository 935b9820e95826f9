//! The articulated-body algorithm on one page (Featherstone, *Rigid Body Dynamics Algorithms*,
//! 2008, Table 7.1).
//!
//! Outward: V_i as in [`rnea`], and
//!
//! ```text
//! c_i = Ṡ_i q̇_i + ad(V_i) S_i q̇_i        I_i = G_i        p_i = −ad(V_i)ᵀ G_i V_i − w_i
//! ```
//!
//! Inward, eliminating one joint after the other:
//!
//! ```text
//! U_i = I_i S_i        D_i = S_iᵀ U_i        u_i = τ_i − S_iᵀ p_i
//! I_λ += Ad(T_iλ)ᵀ (I_i − U_i D_i⁻¹ U_iᵀ) Ad(T_iλ)
//! p_λ += Ad(T_iλ)ᵀ (p_i + (I_i − U_i D_i⁻¹ U_iᵀ) c_i + U_i D_i⁻¹ u_i)
//! ```
//!
//! Outward, with V̇_0 = [0; −g]:
//!
//! ```text
//! A_i = Ad(T_iλ) V̇_λ + c_i        q̈_i = D_i⁻¹ (u_i − U_iᵀ A_i)        V̇_i = A_i + S_i q̈_i
//! ```

use alloc::vec;
use alloc::vec::Vec;

use nalgebra::{DMatrix, DVector, Matrix6, Matrix6xX, Vector3, Vector6};

use super::matrix::{ad, stack};
use super::rnea;
use super::solve::Factor;
use super::tree::Tree;
use crate::Scalar;

/// Results of the inward sweep for a joint.
struct Eliminated<S> {
    u: Matrix6xX<S>,
    d_inverse: DMatrix<S>,
    torque: DVector<S>,
}

/// q̈ with M(q) q̈ = τ − h(q, q̇) + Σ Jᵀw, in a time that grows with the number of joints.
///
/// v, tau: `[nv]`; wrenches: one for each body in its own axes, or empty; result: `[nv]`. `None`
/// for a robot in which one joint follows another: its joints cannot be eliminated one by one.
///
/// # Panics
/// If a slice is shorter than stated.
pub fn aba<S: Scalar>(tree: &Tree<S>, v: &[S], tau: &[S], wrenches: &[Vector6<S>]) -> Option<Vec<S>> {
    if has_followers(tree) {
        return None;
    }
    // V_i, and c_i: V̇_i at q̈ = 0 without the parent's contribution
    let motion = rnea::outward(tree, v, &vec![S::zero(); tree.nv]);
    let c: Vec<Vector6<S>> = tree.bodies.iter().zip(&motion).map(|(b, m)| b.screw_rate + ad(&m.twist) * (&b.screws * b.part(v))).collect();
    // I_i = G_i, p_i = −ad(V_i)ᵀ G_i V_i − w_i
    let mut inertia: Vec<Matrix6<S>> = tree.bodies.iter().map(|body| body.inertia).collect();
    let mut p: Vec<Vector6<S>> = motion.iter().zip(&inertia).map(|(m, g)| -(ad(&m.twist).transpose() * (g * m.twist))).collect();
    p.iter_mut().zip(wrenches).for_each(|(p, w)| *p -= w);

    let mut eliminated = Vec::with_capacity(tree.bodies.len());
    for (i, body) in tree.bodies.iter().enumerate().rev() {
        // U_i = I_i S_i, D_i = S_iᵀ U_i, u_i = τ_i − S_iᵀ p_i
        let u = inertia[i] * &body.screws;
        let d_inverse = inverse(&(body.screws.transpose() * &u));
        let torque = body.part(tau) - body.screws.transpose() * p[i];
        if let Some(parent) = body.parent {
            // The part that the joint passes on: I_i − U_i D_i⁻¹ U_iᵀ
            let apparent = inertia[i] - &u * &d_inverse * u.transpose();
            let bias = p[i] + apparent * c[i] + &u * &d_inverse * &torque;
            inertia[parent] += body.adjoint.transpose() * apparent * body.adjoint;
            p[parent] += body.adjoint.transpose() * bias;
        }
        eliminated.push(Eliminated { u, d_inverse, torque });
    }
    eliminated.reverse();

    let mut result = vec![S::zero(); tree.nv];
    let mut acceleration: Vec<Vector6<S>> = Vec::with_capacity(tree.bodies.len());
    for (i, (body, Eliminated { u, d_inverse, torque })) in tree.bodies.iter().zip(&eliminated).enumerate() {
        let parent = body.parent.map_or(stack(Vector3::zeros(), -tree.gravity), |p| acceleration[p]);
        // A_i = Ad(T_iλ) V̇_λ + c_i, q̈_i = D_i⁻¹ (u_i − U_iᵀ A_i), V̇_i = A_i + S_i q̈_i
        let carried = body.adjoint * parent + c[i];
        let own = d_inverse * (torque - u.transpose() * carried);
        acceleration.push(carried + &body.screws * &own);
        result[body.at..][..own.len()].copy_from_slice(own.as_slice());
    }
    Some(result)
}

/// Whether two joints share a rate.
fn has_followers<S: Scalar>(tree: &Tree<S>) -> bool {
    let rates: usize = tree.bodies.iter().map(|body| body.screws.ncols()).sum();
    rates != tree.nv
}

/// D⁻¹ of a symmetric positive definite D.
fn inverse<S: Scalar>(d: &DMatrix<S>) -> DMatrix<S> {
    DMatrix::from_row_slice(d.nrows(), d.ncols(), &Factor::new(d.as_slice(), d.nrows()).inverse())
}
