//! Any turn about a point.

use nalgebra::{Matrix3, Vector3};

use super::{Coordinates, Freedom, JointLaw};
use crate::Scalar;
use crate::spatial::{ArticulatedInertia, Motion, Placement, SpatialInertia, Twist, Wrench, from_quaternion, rotate, rotate_back};

/// q = unit quaternion (x, y, z, w) of the child in the joint frame; v = ω in axes of the child; S
/// = [1; 0].
///
/// The quaternion's norm is taken to be one ([`from_quaternion`]).
#[derive(Clone, Copy, Debug)]
pub struct Spherical<S> {
    rotation: Matrix3<S>,
}

#[inline(always)]
fn three<S: Scalar>(x: &[S], at: usize) -> Vector3<S> {
    Vector3::new(x[at], x[at + 1], x[at + 2])
}

impl<S: Scalar> JointLaw<S> for Spherical<S> {
    const NQ: usize = 4;
    const NV: usize = 3;
    const QUATERNION: Option<usize> = Some(0);
    const ROTATION: Freedom = Freedom::Free;
    const TRANSLATION: Freedom = Freedom::None;

    #[inline(always)]
    fn at(at: &Coordinates<S>, q: &[S]) -> Self {
        let q = &q[at.q..at.q + 4];
        Self { rotation: from_quaternion([q[0], q[1], q[2], q[3]]) }
    }

    #[inline(always)]
    fn to_child(&self, v: Vector3<S>) -> Vector3<S> {
        rotate_back(&self.rotation, v)
    }

    #[inline(always)]
    fn to_joint(&self, v: Vector3<S>) -> Vector3<S> {
        rotate(&self.rotation, v)
    }

    #[inline(always)]
    fn origin(&self, x_pj: &Placement<S>) -> Vector3<S> {
        x_pj.position
    }

    #[inline(always)]
    fn compose(&self, x_wj: Placement<S>) -> Placement<S> {
        x_wj.compose(&Placement { rotation: self.rotation, position: Vector3::zeros() })
    }

    #[inline(always)]
    fn subspace(&self, turn: &Matrix3<S>, k: usize) -> Twist<S> {
        Twist { angular: turn.column(k).into_owned(), linear: Vector3::zeros() }
    }

    #[inline(always)]
    fn motion(&self, carried: Motion<S>, turn: impl Fn(Vector3<S>) -> Vector3<S>, at: &Coordinates<S>, [_, v, a]: [&[S]; 3]) -> Motion<S> {
        let (rate, derivative) = (three(v, at.v), three(a, at.v));
        let omega = turn(carried.omega);
        // ω̇ = Rᵀ ω̇_λ + Rᵀ ω_λ × ω_J + ω̇_J;  ω = Rᵀ ω_λ + ω_J
        let alpha = turn(carried.alpha) + omega.cross(&rate) + derivative;
        Motion { omega: omega + rate, alpha, acceleration: turn(carried.acceleration) }
    }

    #[inline(always)]
    fn inertia_to_joint(&self, inertia: &SpatialInertia<S>) -> SpatialInertia<S> {
        inertia.moved(&Placement { rotation: self.rotation, position: Vector3::zeros() })
    }

    #[inline(always)]
    fn articulated_to_joint(&self, inertia: &ArticulatedInertia<S>) -> ArticulatedInertia<S> {
        inertia.turned(&self.rotation)
    }

    #[inline(always)]
    fn freedom(k: usize) -> Option<usize> {
        Some(k)
    }

    #[inline(always)]
    fn column(&self, i: &SpatialInertia<S>, k: usize) -> Wrench<S> {
        // n = (tr(Σ)·1 − Σ) e, f = e × h
        let mut e = Vector3::zeros();
        e[k] = S::one();
        Wrench { moment: i.rotational().column(k).into_owned(), force: e.cross(&i.first) }
    }

    #[inline(always)]
    fn torque(&self, wrench: &Wrench<S>, k: usize) -> S {
        wrench.moment[k]
    }

    fn regroupable(own: &SpatialInertia<S>) -> Option<SpatialInertia<S>> {
        Some(SpatialInertia { mass: own.mass, ..SpatialInertia::zero() })
    }

    fn has_inertia(own: &SpatialInertia<S>) -> bool {
        (0..3).all(|k| !own.rotational()[(k, k)].is_zero())
    }
}
