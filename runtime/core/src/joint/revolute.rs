//! A turn about z.

use nalgebra::{Matrix3, Vector3};

use super::{Coordinates, Freedom, JointLaw};
use crate::Scalar;
use crate::spatial::{ArticulatedInertia, Motion, Placement, SpatialInertia, Twist, Wrench, turned_about_z};

/// R = Rz(q), S = [e_z; 0].
#[derive(Clone, Copy, Debug)]
pub struct Revolute<S> {
    sin: S,
    cos: S,
}

impl<S> Revolute<S> {
    /// At this angle.
    #[inline(always)]
    pub fn of(angle: super::Angle<S>) -> Self {
        Self { sin: angle.sin, cos: angle.cos }
    }
}

impl<S: Scalar> JointLaw<S> for Revolute<S> {
    const NQ: usize = 1;
    const NV: usize = 1;
    const QUATERNION: Option<usize> = None;
    const ROTATION: Freedom = Freedom::Axis;
    const TRANSLATION: Freedom = Freedom::None;

    #[inline(always)]
    fn at(at: &Coordinates<S>, q: &[S]) -> Self {
        let (sin, cos) = at.coordinate(q).sin_cos();
        Self { sin, cos }
    }

    #[inline(always)]
    fn to_child(&self, v: Vector3<S>) -> Vector3<S> {
        let (s, c) = (self.sin, self.cos);
        Vector3::new(c * v.x + s * v.y, c * v.y - s * v.x, v.z)
    }

    #[inline(always)]
    fn to_joint(&self, v: Vector3<S>) -> Vector3<S> {
        let (s, c) = (self.sin, self.cos);
        Vector3::new(c * v.x - s * v.y, s * v.x + c * v.y, v.z)
    }

    #[inline(always)]
    fn origin(&self, x_pj: &Placement<S>) -> Vector3<S> {
        x_pj.position
    }

    #[inline(always)]
    fn compose(&self, x_wj: Placement<S>) -> Placement<S> {
        let (s, c) = (self.sin, self.cos);
        let (x, y, z) = (x_wj.rotation.column(0), x_wj.rotation.column(1), x_wj.rotation.column(2));
        let rotation = Matrix3::from_columns(&[x * c + y * s, y * c - x * s, z.into_owned()]);
        Placement { rotation, position: x_wj.position }
    }

    #[inline(always)]
    fn subspace(&self, turn: &Matrix3<S>, _: usize) -> Twist<S> {
        Twist { angular: turn.column(2).into_owned(), linear: Vector3::zeros() }
    }

    #[inline(always)]
    fn motion(&self, carried: Motion<S>, turn: impl Fn(Vector3<S>) -> Vector3<S>, at: &Coordinates<S>, state: [&[S]; 3]) -> Motion<S> {
        let [rate, acceleration] = at.rates(state);
        let (mut omega, mut alpha) = (turn(carried.omega), turn(carried.alpha));
        // ω̇ = Rᵀ ω̇_λ + Rᵀ ω_λ × e_z q̇ + e_z q̈;  ω = Rᵀ ω_λ + e_z q̇
        alpha.x += omega.y * rate;
        alpha.y -= omega.x * rate;
        alpha.z += acceleration;
        omega.z += rate;
        Motion { omega, alpha, acceleration: turn(carried.acceleration) }
    }

    #[inline(always)]
    fn inertia_to_joint(&self, i: &SpatialInertia<S>) -> SpatialInertia<S> {
        // Σ' = Rz Σ Rzᵀ
        SpatialInertia { mass: i.mass, first: self.to_joint(i.first), second: turned_about_z(&i.second, self.sin, self.cos) }
    }

    #[inline(always)]
    fn articulated_to_joint(&self, i: &ArticulatedInertia<S>) -> ArticulatedInertia<S> {
        i.turned_about_z(self.sin, self.cos)
    }

    #[inline(always)]
    fn freedom(_: usize) -> Option<usize> {
        Some(2)
    }

    #[inline(always)]
    fn column(&self, i: &SpatialInertia<S>, _: usize) -> Wrench<S> {
        // n = (tr(Σ)·1 − Σ) e_z, f = e_z × h
        let (h, m) = (i.first, &i.second);
        Wrench { moment: Vector3::new(-m.m13, -m.m23, m.m11 + m.m22), force: Vector3::new(-h.y, h.x, S::zero()) }
    }

    #[inline(always)]
    fn torque(&self, wrench: &Wrench<S>, _: usize) -> S {
        wrench.moment.z
    }

    fn regroupable(own: &SpatialInertia<S>) -> Option<SpatialInertia<S>> {
        let o = S::zero();
        let second = Matrix3::from_diagonal(&Vector3::new(o, o, own.second.m33));
        Some(SpatialInertia { mass: own.mass, first: Vector3::new(o, o, own.first.z), second })
    }

    fn has_inertia(own: &SpatialInertia<S>) -> bool {
        // I_zz = Σ_xx + Σ_yy
        !(own.second.m11 + own.second.m22).is_zero()
    }
}
