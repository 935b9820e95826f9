//! The composite rigid body algorithm on one page (Featherstone, *Rigid Body Dynamics Algorithms*,
//! 2008, Table 6.2).
//!
//! I_i is the inertia of body i and of all that it carries. Inward:
//!
//! ```text
//! I_i = G_i + Σ Ad(T_ki)ᵀ I_k Ad(T_ki)                          over the children k of i
//! M_ji = S_jᵀ Ad(T_ij)ᵀ I_i S_i,   M_ij = M_jiᵀ                  for j = i and the bodies that carry i
//! ```

use alloc::vec::Vec;

use nalgebra::{DMatrix, Matrix6};

use super::tree::Tree;
use crate::Scalar;

/// M(q), `[nv × nv]`, symmetric.
pub fn crba<S: Scalar>(tree: &Tree<S>) -> DMatrix<S> {
    let mut composite: Vec<Matrix6<S>> = tree.bodies.iter().map(|body| body.inertia).collect();
    let mut m = DMatrix::zeros(tree.nv, tree.nv);
    let mut add = |row: usize, column: usize, block: &DMatrix<S>| {
        let mut entries = m.view_mut((row, column), block.shape());
        entries += block;
    };
    for (i, body) in tree.bodies.iter().enumerate().rev() {
        // F = I_i S_i, one wrench for each rate of joint i; M_ii = S_iᵀ F
        let mut f = composite[i] * &body.screws;
        add(body.at, body.at, &(body.screws.transpose() * &f));
        // To each body j that carries i: F ← Ad(T_iλ)ᵀ F, M_ji = S_jᵀ F, M_ij = M_jiᵀ
        let mut below = body;
        while let Some(p) = below.parent {
            f = below.adjoint.transpose() * f;
            below = &tree.bodies[p];
            let block = below.screws.transpose() * &f;
            add(below.at, body.at, &block);
            add(body.at, below.at, &block.transpose());
        }
        // I_λ += Ad(T_iλ)ᵀ I_i Ad(T_iλ)
        if let Some(p) = body.parent {
            let carried = body.adjoint.transpose() * composite[i] * body.adjoint;
            composite[p] += carried;
        }
    }
    m
}
