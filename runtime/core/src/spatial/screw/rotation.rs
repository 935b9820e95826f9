//! SO(3): rotation vectors and the effect of their exponential on small changes.
//!
//! With θ = |ω| and β, γ, ε of the module's table:
//!
//! ```text
//! exp ω   = 1 + sin θ/θ [ω]× + β [ω]×²
//! J_l(ω)  = 1 + β [ω]× + γ [ω]×²          exp(ω + δ) ≈ exp(J_l δ)·exp(ω)
//! J_r(ω)  = J_l(−ω) = J_lᵀ                 exp(ω + δ) ≈ exp(ω)·exp(J_r δ)
//! J_l⁻¹   = 1 − ½ [ω]× + ε [ω]×²           log(exp(δ)·exp(ω)) ≈ ω + J_l⁻¹ δ
//! ```
//!
//! Lynch & Park 2017, §3.2.3; Park 1994; Barfoot 2017, §7.1.5.

use nalgebra::{Matrix3, Vector3};

use super::Quaternion;
use super::coefficients::HalfAngle;
use crate::Scalar;
use crate::spatial::rate_matrix;

/// The rotation about ω by |ω| rad. Absolute error of an entry at most (4 + 1.5|ω|)·u: ω counts as
/// exact only to a relative u.
pub fn exp_rotation<S: Scalar>(omega: Vector3<S>) -> Matrix3<S> {
    Quaternion::exp(omega).to_rotation()
}

/// The rotation vector, rad, |ω| ≤ π, through the quaternion, so that it is as good at π as
/// anywhere: off by a few u absolutely. At exactly π the first component of the axis that is not
/// zero is positive; next to it a perturbation of R by u may turn the axis round, which is the same
/// rotation.
pub fn log_rotation<S: Scalar>(r: &Matrix3<S>) -> Vector3<S> {
    Quaternion::from_rotation(r).log()
}

/// J_l(ω): the angular velocity in fixed axes is J_l(ω)·ω̇. Singular at |ω| = 2π.
pub fn left_jacobian<S: Scalar>(omega: Vector3<S>) -> Matrix3<S> {
    let half = HalfAngle::new(omega.dot(&omega));
    one_and(omega, half.versine(), half.excess())
}

/// J_r(ω): the angular velocity in turned axes is J_r(ω)·ω̇. Singular at |ω| = 2π.
pub fn right_jacobian<S: Scalar>(omega: Vector3<S>) -> Matrix3<S> {
    left_jacobian(-omega)
}

/// J_l(ω)⁻¹. Its entries grow as 1/(2π − |ω|); their relative error there is u·2π/(2π − |ω|) times
/// a few.
pub fn left_jacobian_inverse<S: Scalar>(omega: Vector3<S>) -> Matrix3<S> {
    let half = HalfAngle::new(omega.dot(&omega));
    one_and(omega, -S::from_f64(0.5), half.inverse())
}

/// J_r(ω)⁻¹. See [`left_jacobian_inverse`].
pub fn right_jacobian_inverse<S: Scalar>(omega: Vector3<S>) -> Matrix3<S> {
    left_jacobian_inverse(-omega)
}

/// `1 + a [ω]× + b [ω]×²`.
fn one_and<S: Scalar>(omega: Vector3<S>, a: S, b: S) -> Matrix3<S> {
    Matrix3::identity() + polynomial(omega, a, b)
}

/// `a [ω]× + b [ω]×²`.
pub(super) fn polynomial<S: Scalar>(omega: Vector3<S>, a: S, b: S) -> Matrix3<S> {
    cross_matrix(omega) * a + rate_matrix(omega, Vector3::zeros()) * b
}

/// `[v]×`: its product with r is v × r.
pub fn cross_matrix<S: Scalar>(v: Vector3<S>) -> Matrix3<S> {
    let zero = S::zero();
    Matrix3::new(zero, -v.z, v.y, v.z, zero, -v.x, -v.y, v.x, zero)
}
