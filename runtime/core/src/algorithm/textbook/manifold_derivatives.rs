//! Derivatives of steps and differences, by power series of ad.
//!
//! With s the step as a twist, E = exp(−ad s) and J = ∫₀¹ exp(−t ad s) dt: (q ⊕ δ) ⊕ s = (q ⊕ s) ⊕
//! E δ and, to first order, q ⊕ (s + δ) = (q ⊕ s) ⊕ J δ.

use alloc::vec;
use alloc::vec::Vec;

use nalgebra::{Matrix3, Matrix6, Vector3};

use super::Textbook;
use super::manifold::{HALVINGS, TERMS, inverse, part, three};
use super::matrix::{ad, blocks, stack};
use crate::Scalar;
use crate::description::JointKind;
use crate::model::JointInfo;

impl<S: Scalar> Textbook<S> {
    /// ∂(q ⊕ step)/∂q and ∂(q ⊕ step)/∂step, `[2][nv][nv]`: E and J.
    pub fn integrate_derivatives(&self, step: &[S]) -> Vec<S> {
        self.both(step, |twist| exponential(&-ad(&twist)), Matrix6::identity())
    }

    /// ∂(target ⊖ q)/∂q and ∂(target ⊖ q)/∂target, `[2][nv][nv]`: −J(−d)⁻¹ and J(d)⁻¹ at the
    /// difference d.
    pub fn difference_derivatives(&self, q: &[S], target: &[S]) -> Vec<S> {
        let back = |twist| inverse_of_lower(&exponential(&twist)[1]);
        let ways = |twist| [-back(ad(&twist)), back(-ad(&twist))];
        self.both(&self.difference(q, target), ways, -Matrix6::identity())
    }

    /// Two matrices of a block for each joint; `first`: of the first, for joints of plain
    /// coordinates, of the second the identity.
    fn both(&self, step: &[S], of: impl Fn(nalgebra::Vector6<S>) -> [Matrix6<S>; 2], first: Matrix6<S>) -> Vec<S> {
        let n = self.nv;
        let mut out = vec![S::zero(); 2 * n * n];
        for JointInfo { kind, v, .. } in &self.joints {
            let d = part(step, *v);
            let pair = match kind {
                JointKind::Spherical => of(stack(three(d), Vector3::zeros())),
                JointKind::Floating => of(stack(three(d), three(&d[3..]))),
                _ => [first, Matrix6::identity()],
            };
            for (k, (i, j)) in (0..2).flat_map(|k| (0..v.1 * v.1).map(move |at| (k, (at / v.1, at % v.1)))) {
                out[(k * n + v.0 + i) * n + v.0 + j] = pair[k][(i, j)];
            }
        }
        out
    }
}

/// exp A and ∫₀¹ exp(t A) dt: series of a small part of A, doubled up.
fn exponential<S: Scalar>(a: &Matrix6<S>) -> [Matrix6<S>; 2] {
    let a = a * S::from_f64(1.0 / f64::from(1_u32 << HALVINGS));
    let (mut power, mut sums) = (Matrix6::identity(), [Matrix6::identity(); 2]);
    for k in 1..TERMS {
        power = power * a * (S::one() / S::from_f64(f64::from(k)));
        sums[0] += power;
        sums[1] += power * (S::one() / S::from_f64(f64::from(k + 1)));
    }
    // ∫₀² exp(t A) dt/2 = (1 + exp A) ∫₀¹ exp(t A) dt/2
    (0..HALVINGS).fold(sums, |[e, j], _| [e * e, (j + e * j) * S::from_f64(0.5)])
}

/// Of [D 0; C D].
fn inverse_of_lower<S: Scalar>(m: &Matrix6<S>) -> Matrix6<S> {
    let block = |i: usize| -> Matrix3<S> { m.fixed_view::<3, 3>(i, 0).into_owned() };
    let d = inverse(&block(0));
    blocks(&d, &Matrix3::zeros(), &-(d * block(3) * d), &d)
}
