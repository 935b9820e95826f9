//! Contribution of a moving body to the Coriolis matrix.

use nalgebra::{Matrix3, Vector3};

use super::inertia::complement;
use super::{SpatialInertia, Twist, Wrench, rotate, rotate_back};
use crate::Scalar;

/// B(V) of a body with twist V: the wrench ∫ [r; 1] × (ω × u_r) dm for an angular velocity ω, with
/// u_r the velocity of the point at r.
///
/// It is ½[(V×*)G − G(V×) + (G V)×̄*] of Echeandia & Wensing (*J. Comput. Nonlinear Dyn.* 16,
/// 2021), which maps a 6-vector (ω; v) but depends on ω alone: it consists of K = ∫ u_r rᵀ dm and p
/// = ∫ u_r dm. These add up over bodies like moments of mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoriolisInertia<S> {
    /// p, the linear momentum, kg·m/s.
    pub momentum: Vector3<S>,
    /// K, kg·m²/s.
    pub second: Matrix3<S>,
}

impl<S: Scalar> CoriolisInertia<S> {
    /// Zero.
    pub fn zero() -> Self {
        Self { momentum: Vector3::zeros(), second: Matrix3::zeros() }
    }

    /// Of a body of this inertia that moves with this twist, both in the same frame:
    /// `p = m v + ω × h, K = v hᵀ + [ω]× Σ`.
    #[inline(always)]
    pub fn new(inertia: &SpatialInertia<S>, twist: &Twist<S>) -> Self {
        let (w, v, h) = (twist.angular, twist.linear, inertia.first);
        let column = |k: usize| v * h[k] + w.cross(&inertia.second.column(k).into_owned());
        Self { momentum: v * inertia.mass + w.cross(&h), second: Matrix3::from_columns(&[column(0), column(1), column(2)]) }
    }

    /// The same about the origin that lies at −`shift`: K' = K + p shiftᵀ.
    #[inline(always)]
    #[must_use]
    pub fn shifted(&self, shift: Vector3<S>) -> Self {
        Self { momentum: self.momentum, second: self.second + self.momentum * shift.transpose() }
    }

    /// B ω = [(tr(K)·1 − K) ω; ω × p].
    #[inline(always)]
    pub fn wrench(&self, omega: Vector3<S>) -> Wrench<S> {
        Wrench { moment: rotate(&complement(&self.second), omega), force: omega.cross(&self.momentum) }
    }

    /// Bᵀ V: the power of the wrench B ω on the twist V is ω·(Bᵀ V).
    #[inline(always)]
    pub fn transposed(&self, twist: &Twist<S>) -> Vector3<S> {
        rotate_back(&complement(&self.second), twist.angular) + self.momentum.cross(&twist.linear)
    }
}

impl<S: Scalar> core::ops::AddAssign for CoriolisInertia<S> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        self.momentum += other.momentum;
        self.second += other.second;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spatial::{Placement, from_rpy};

    #[test]
    fn times_its_own_velocity_is_the_velocity_dependent_wrench() {
        let i = Matrix3::new(0.03, 0.001, -0.002, 0.001, 0.05, 0.0005, -0.002, 0.0005, 0.055);
        let x = Placement { rotation: from_rpy([0.4, -1.1, 2.0]), position: Vector3::new(0.15, 0.02, -0.01) };
        let g = SpatialInertia::from_central(2.0, i, &x);
        let twist = Twist { angular: Vector3::new(0.3, -1.2, 0.7), linear: Vector3::new(2.0, 0.5, -0.9) };
        let b = CoriolisInertia::new(&g, &twist);
        let expected = twist.cross_wrench(&g.apply(&twist));
        let got = b.wrench(twist.angular);
        assert!((got.moment - expected.moment).amax() < 1e-14 && (got.force - expected.force).amax() < 1e-14);
        let other = Twist { angular: Vector3::new(-0.2, 0.4, 1.1), linear: Vector3::new(0.1, -0.8, 0.3) };
        assert!((got.power(&other) - twist.angular.dot(&b.transposed(&other))).abs() < 1e-14);
    }
}
