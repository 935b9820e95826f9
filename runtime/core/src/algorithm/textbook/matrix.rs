//! Matrices of spatial algebra, written out; Lynch & Park 2017, ch. 3 and 8.
//!
//! Vectors of six are (angular; linear).

use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

use crate::Scalar;
use crate::spatial::Placement;

/// `R = 1 + sin θ [ω]× + (1 − cos θ) [ω]×²`, of a unit axis ω and θ in rad.
pub fn rodrigues<S: Scalar>(axis: Vector3<S>, angle: S) -> Matrix3<S> {
    let (sin, cos) = angle.sin_cos();
    let w = cross_matrix(axis);
    Matrix3::identity() + w * sin + w * w * (S::one() - cos)
}

/// `[v]×`, with `[v]× r = v × r`.
pub fn cross_matrix<S: Scalar>(v: Vector3<S>) -> Matrix3<S> {
    let o = S::zero();
    Matrix3::new(o, -v.z, v.y, v.z, o, -v.x, -v.y, v.x, o)
}

/// v with [v]× = m, of the skew part of m.
pub(super) fn vee<S: Scalar>(m: &Matrix3<S>) -> Vector3<S> {
    Vector3::new(m.m32 - m.m23, m.m13 - m.m31, m.m21 - m.m12) * S::from_f64(0.5)
}

/// The vector (angular; linear).
pub fn stack<S: Scalar>(angular: Vector3<S>, linear: Vector3<S>) -> Vector6<S> {
    Vector6::new(angular.x, angular.y, angular.z, linear.x, linear.y, linear.z)
}

/// The angular and the linear part.
pub fn halves<S: Scalar>(x: &Vector6<S>) -> (Vector3<S>, Vector3<S>) {
    (Vector3::new(x[0], x[1], x[2]), Vector3::new(x[3], x[4], x[5]))
}

/// A 6×6 matrix from its four 3×3 blocks.
pub(super) fn blocks<S: Scalar>(a: &Matrix3<S>, b: &Matrix3<S>, c: &Matrix3<S>, d: &Matrix3<S>) -> Matrix6<S> {
    Matrix6::from_fn(|i, j| match (i < 3, j < 3) {
        (true, true) => a[(i, j)],
        (true, false) => b[(i, j - 3)],
        (false, true) => c[(i - 3, j)],
        (false, false) => d[(i - 3, j - 3)],
    })
}

/// `Ad(T) = [R 0; [p]×R R]`: takes a twist from the axes of the frame to the axes in which T is
/// given.
pub fn adjoint<S: Scalar>(x: &Placement<S>) -> Matrix6<S> {
    blocks(&x.rotation, &Matrix3::zeros(), &(cross_matrix(x.position) * x.rotation), &x.rotation)
}

/// `Ad(T⁻¹) = [Rᵀ 0; −Rᵀ[p]× Rᵀ]`.
pub fn inverse_adjoint<S: Scalar>(x: &Placement<S>) -> Matrix6<S> {
    let rt = x.rotation.transpose();
    blocks(&rt, &Matrix3::zeros(), &-(rt * cross_matrix(x.position)), &rt)
}

/// `ad(V) = [[ω]× 0; [v]× [ω]×]`: ad(V) A is the rate of a screw A that moves with the twist V.
pub fn ad<S: Scalar>(v: &Vector6<S>) -> Matrix6<S> {
    let (angular, linear) = halves(v);
    let w = cross_matrix(angular);
    blocks(&w, &Matrix3::zeros(), &cross_matrix(linear), &w)
}

/// m (mass) and h = m c of G = [I, [h]×; [h]×ᵀ, m 1].
pub(super) fn mass_and_moment<S: Scalar>(g: &Matrix6<S>) -> (S, Vector3<S>) {
    (g[(5, 5)], Vector3::new(g[(2, 4)], g[(0, 5)], g[(1, 3)]))
}
