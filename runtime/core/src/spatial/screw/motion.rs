//! SE(3): twists taken for a unit of time, and placements.
//!
//! Every formula is that of SO(3) with ω + ε v for ω, ε² = 0 (the principle of transference): the
//! factor of ε is the coupling block. So with δ = ω·v and primes for derivatives in θ²
//!
//! ```text
//! p of exp ξ   = J_l(ω) v
//! J_l(ξ)       = [J_l 0; Q J_l],   Q  = β [v]× + γ ([ω]×[v]× + [v]×[ω]×) + 2δ (β' [ω]× + γ' [ω]×²)
//! J_l(ξ)⁻¹     = [J_l⁻¹ 0; Q⁻ J_l⁻¹],   Q⁻ = −½ [v]× + ε ([ω]×[v]× + [v]×[ω]×) + 2δ ε' [ω]×²
//! J_r(ξ)       = J_l(−ξ)
//! ```
//!
//! which is the Q of Barfoot 2017, (7.86), with half the coefficients. Lynch & Park 2017, §3.3.3.

use nalgebra::{Matrix3, Matrix6, Vector3};

use super::Quaternion;
use super::coefficients::HalfAngle;
use super::rotation::{cross_matrix, polynomial};
use crate::Scalar;
use crate::spatial::{Placement, Twist, rotate_back};

impl<S: Scalar> Twist<S> {
    /// exp ξ: where a body that moves with this twist for a unit of time gets to, from the
    /// identity.
    ///
    /// Absolute error of the rotation at most (4 + 1.5|ω|)·u, of the position (3 + |ω|)·u·|v|.
    pub fn exp(&self) -> Placement<S> {
        let (rotation, position) = self.exp_parts();
        Placement { rotation: rotation.to_rotation(), position }
    }

    /// exp ξ as quaternion and position.
    #[inline(always)]
    pub fn exp_parts(&self) -> (Quaternion<S>, Vector3<S>) {
        let (w, v) = (self.angular, self.linear);
        let half = HalfAngle::new(w.dot(&w));
        let rotation = Quaternion { vector: w * (S::from_f64(0.5) * half.sinc()), scalar: half.cosine() };
        // J_l v = v + ω × (β v + γ ω × v)
        let position = v + w.cross(&(v * half.versine() + w.cross(&v) * half.excess()));
        (rotation, position)
    }

    /// log of a placement given as quaternion and position: ω = log q, v = J_l(ω)⁻¹ p. See
    /// [`Placement::log`].
    #[inline(always)]
    pub fn log_of_parts(rotation: &Quaternion<S>, position: Vector3<S>) -> Self {
        let (w, p) = (rotation.log(), position);
        let half = HalfAngle::new(w.dot(&w));
        // J_l⁻¹ p = p + ω × (−½ p + ε ω × p)
        let linear = p + w.cross(&(w.cross(&p) * half.inverse() - p * S::from_f64(0.5)));
        Self { angular: w, linear }
    }

    /// J_l(ξ), on (angular; linear): the twist in fixed axes about the fixed origin is J_l(ξ)·ξ̇.
    /// Singular at |ω| = 2π.
    pub fn left_jacobian(&self) -> Matrix6<S> {
        self.jacobian(S::one())
    }

    /// J_r(ξ), on (angular; linear): the body twist is J_r(ξ)·ξ̇. Singular at |ω| = 2π.
    pub fn right_jacobian(&self) -> Matrix6<S> {
        self.jacobian(-S::one())
    }

    /// J_l(ξ)⁻¹; its entries grow as 1/(2π − |ω|)².
    pub fn left_jacobian_inverse(&self) -> Matrix6<S> {
        self.jacobian_inverse(-S::from_f64(0.5))
    }

    /// J_r(ξ)⁻¹; its entries grow as 1/(2π − |ω|)².
    pub fn right_jacobian_inverse(&self) -> Matrix6<S> {
        self.jacobian_inverse(S::from_f64(0.5))
    }

    fn jacobian(&self, sign: S) -> Matrix6<S> {
        let half = HalfAngle::new(self.angular.dot(&self.angular));
        self.blocks([sign * half.versine(), half.excess()], [sign * half.versine_rate(), half.excess_rate()])
    }

    fn jacobian_inverse(&self, first: S) -> Matrix6<S> {
        let half = HalfAngle::new(self.angular.dot(&self.angular));
        self.blocks([first, half.inverse()], [S::zero(), half.inverse_rate()])
    }

    /// `[P 0; P' P]` with `P = 1 + a [ω]× + b [ω]×²` and P' its derivative in the direction v.
    fn blocks(&self, [a, b]: [S; 2], [a_rate, b_rate]: [S; 2]) -> Matrix6<S> {
        let (w, v) = (self.angular, self.linear);
        let (wx, vx) = (cross_matrix(w), cross_matrix(v));
        let along = w.dot(&v);
        let twice = along + along;
        let coupling = vx * a + (wx * vx + vx * wx) * b + polynomial(w, twice * a_rate, twice * b_rate);
        lower(&(Matrix3::identity() + polynomial(w, a, b)), &coupling)
    }
}

/// [D 0; C D].
pub(super) fn lower<S: Scalar>(diagonal: &Matrix3<S>, coupling: &Matrix3<S>) -> Matrix6<S> {
    let mut all = Matrix6::zeros();
    all.fixed_view_mut::<3, 3>(0, 0).copy_from(diagonal);
    all.fixed_view_mut::<3, 3>(3, 3).copy_from(diagonal);
    all.fixed_view_mut::<3, 3>(3, 0).copy_from(coupling);
    all
}

impl<S: Scalar> Placement<S> {
    /// T⁻¹ = [Rᵀ | −Rᵀ p]: the frame a in the frame b.
    #[must_use]
    pub fn inverse(&self) -> Self {
        Self { rotation: self.rotation.transpose(), position: -rotate_back(&self.rotation, self.position) }
    }

    /// The twist ξ with |ω| ≤ π whose exponential is this placement: absolute error some u in ω and
    /// some u·|p| in v, up to |ω| = π. For its choice of the two axes at π see
    /// [`super::log_rotation`].
    pub fn log(&self) -> Twist<S> {
        Twist::log_of_parts(&Quaternion::from_rotation(&self.rotation), self.position)
    }
}
