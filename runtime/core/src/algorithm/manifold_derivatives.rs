//! Derivatives of steps and differences on the manifold of configurations.
//!
//! A change of a configuration is a small step behind it, as in all derivatives here. With Ad, J_l
//! and J_r of SE(3) for a floating joint, of SO(3) for a spherical one, and ones for all others,
//!
//! ```text
//! (q ⊕ δ) ⊕ s     ≈ (q ⊕ s) ⊕ Ad(exp −s) δ
//! q ⊕ (s + δ)     ≈ (q ⊕ s) ⊕ J_r(s) δ
//! t ⊖ (q ⊕ δ)     ≈ d − J_l(d)⁻¹ δ           with d = t ⊖ q
//! (t ⊕ δ) ⊖ q     ≈ d + J_r(d)⁻¹ δ
//! ```
//!
//! Barfoot 2017, §7.1.5; Solà, Deray & Atchuthan 2018, *A micro Lie theory for state estimation in
//! robotics*, §III–IV.

use super::Workspace;
use super::manifold::{Space, range, six, three, turn_between, way_between};
use crate::Scalar;
use crate::model::{JointInfo, Model};
use crate::spatial::screw::{Quaternion, left_jacobian_inverse, right_jacobian, right_jacobian_inverse};

/// ∂(q ⊕ step)/∂q and ∂(q ⊕ step)/∂step, which q has no part in; rows and columns in the tangent
/// spaces of where it ends and begins.
///
/// step: `[nv]` rad|m|twist times time; out: `[2][nv][nv]`, 1, of a floating joint's lower left
/// blocks m. Absolute error of an entry some 2u times 1 + the largest number of the step. The
/// second is singular at |ω| = 2π.
///
/// # Panics
/// If a slice is shorter than stated; [`super::Function::call`] and [`crate::dynamics::Dynamics`]
/// check and return an error.
pub fn integrate_derivatives<S: Scalar>(model: &Model<S>, _: &mut Workspace<S>, step: &[S], out: &mut [S]) {
    let [by_q, by_step] = halves(out, model.nv);
    for joint in &model.joints {
        let s = &step[range(joint.v)];
        match Space::of(joint.kind) {
            Space::Placements => {
                let twist = six(s);
                put(by_q, model.nv, joint, twist.times(-S::one()).exp().adjoint().as_slice());
                put(by_step, model.nv, joint, twist.right_jacobian().as_slice());
            }
            Space::Rotations => {
                let omega = three(s);
                put(by_q, model.nv, joint, Quaternion::exp(-omega).to_rotation().as_slice());
                put(by_step, model.nv, joint, right_jacobian(omega).as_slice());
            }
            Space::Numbers => [&mut *by_q, &mut *by_step].into_iter().for_each(|block| diagonal(block, model.nv, joint, S::one())),
        }
    }
}

/// ∂(target ⊖ q)/∂q and ∂(target ⊖ q)/∂target; rows as the difference, columns in the tangent
/// spaces of q and of the target.
///
/// q, target: `[nq]` rad|m|quaternion; out: `[2][nv][nv]`, 1, of a floating joint's lower left
/// blocks m. Absolute error of an entry some 4u times 1 + the distance. At half a turn the
/// difference jumps; these are the derivatives of the step that [`super::difference`] gives.
///
/// # Panics
/// As [`integrate_derivatives`].
pub fn difference_derivatives<S: Scalar>(model: &Model<S>, _: &mut Workspace<S>, q: &[S], target: &[S], out: &mut [S]) {
    let [by_q, by_target] = halves(out, model.nv);
    for joint in &model.joints {
        let (q, target) = (&q[range(joint.q)], &target[range(joint.q)]);
        match Space::of(joint.kind) {
            Space::Placements => {
                let twist = way_between(q, target);
                put(by_q, model.nv, joint, (-twist.left_jacobian_inverse()).as_slice());
                put(by_target, model.nv, joint, twist.right_jacobian_inverse().as_slice());
            }
            Space::Rotations => {
                let omega = turn_between(q, target);
                put(by_q, model.nv, joint, (-left_jacobian_inverse(omega)).as_slice());
                put(by_target, model.nv, joint, right_jacobian_inverse(omega).as_slice());
            }
            Space::Numbers => {
                diagonal(by_q, model.nv, joint, -S::one());
                diagonal(by_target, model.nv, joint, S::one());
            }
        }
    }
}

/// Two matrices of zeros.
fn halves<S: Scalar>(out: &mut [S], nv: usize) -> [&mut [S]; 2] {
    let out = &mut out[..2 * nv * nv];
    out.fill(S::zero());
    let (first, second) = out.split_at_mut(nv * nv);
    [first, second]
}

/// A joint's block, given column by column, into `[nv][nv]`.
fn put<S: Scalar>(matrix: &mut [S], nv: usize, joint: &JointInfo, block: &[S]) {
    let (first, n) = joint.v;
    for (at, x) in block.iter().enumerate() {
        matrix[(first + at % n) * nv + first + at / n] = *x;
    }
}

/// A number times the identity as a joint's block.
fn diagonal<S: Scalar>(matrix: &mut [S], nv: usize, joint: &JointInfo, x: S) {
    range(joint.v).for_each(|k| matrix[k * nv + k] = x);
}
