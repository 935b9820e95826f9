//! Free motion.

use nalgebra::{Matrix3, Vector3};

use super::{Coordinates, Freedom, JointLaw};
use crate::Scalar;
use crate::spatial::{ArticulatedInertia, Motion, Placement, SpatialInertia, Twist, Wrench, from_quaternion, rotate, rotate_back};

/// q = (position; unit quaternion x, y, z, w) of the child in the joint frame; v = body twist
/// [ω; v] in the child's frame; a = the time derivative of the six numbers in v; S = 1.
///
/// The quaternion's norm is taken to be one ([`from_quaternion`]).
#[derive(Clone, Copy, Debug)]
pub struct Floating<S> {
    rotation: Matrix3<S>,
    position: Vector3<S>,
}

#[inline(always)]
fn six<S: Scalar>(x: &[S], at: usize) -> Twist<S> {
    Twist { angular: Vector3::new(x[at], x[at + 1], x[at + 2]), linear: Vector3::new(x[at + 3], x[at + 4], x[at + 5]) }
}

impl<S: Scalar> JointLaw<S> for Floating<S> {
    const NQ: usize = 7;
    const NV: usize = 6;
    const QUATERNION: Option<usize> = Some(3);
    const ROTATION: Freedom = Freedom::Free;
    const TRANSLATION: Freedom = Freedom::Free;

    #[inline(always)]
    fn at(at: &Coordinates<S>, q: &[S]) -> Self {
        let q = &q[at.q..at.q + 7];
        Self { position: Vector3::new(q[0], q[1], q[2]), rotation: from_quaternion([q[3], q[4], q[5], q[6]]) }
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
        x_pj.transform(self.position)
    }

    #[inline(always)]
    fn compose(&self, x_wj: Placement<S>) -> Placement<S> {
        x_wj.compose(&Placement { rotation: self.rotation, position: self.position })
    }

    #[inline(always)]
    fn subspace(&self, turn: &Matrix3<S>, k: usize) -> Twist<S> {
        let (e, zero) = (turn.column(k % 3).into_owned(), Vector3::zeros());
        if k < 3 { Twist { angular: e, linear: zero } } else { Twist { angular: zero, linear: e } }
    }

    #[inline(always)]
    fn motion(&self, carried: Motion<S>, turn: impl Fn(Vector3<S>) -> Vector3<S>, at: &Coordinates<S>, [_, v, a]: [&[S]; 3]) -> Motion<S> {
        let (rate, derivative) = (six(v, at.v), six(a, at.v));
        let omega = turn(carried.omega);
        let total = omega + rate.angular;
        // ω̇ = Rᵀ ω̇_λ + Rᵀ ω_λ × ω_J + ω̇_J
        let alpha = turn(carried.alpha) + omega.cross(&rate.angular) + derivative.angular;
        // r̈ = Rᵀ r̈_carried + 2 Rᵀ ω_λ × v_J + ω_J × v_J + v̇_J
        let coriolis = (omega + total).cross(&rate.linear);
        let acceleration = turn(carried.acceleration) + coriolis + derivative.linear;
        Motion { omega: total, alpha, acceleration }
    }

    #[inline(always)]
    fn inertia_to_joint(&self, inertia: &SpatialInertia<S>) -> SpatialInertia<S> {
        inertia.moved(&Placement { rotation: self.rotation, position: self.position })
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
        let mut e = Vector3::zeros();
        e[k % 3] = S::one();
        match k {
            // n = (tr(Σ)·1 − Σ) e, f = e × h
            0..3 => Wrench { moment: i.rotational().column(k).into_owned(), force: e.cross(&i.first) },
            // n = h × e, f = m e
            _ => Wrench { moment: i.first.cross(&e), force: e * i.mass },
        }
    }

    #[inline(always)]
    fn torque(&self, wrench: &Wrench<S>, k: usize) -> S {
        if k < 3 { wrench.moment[k] } else { wrench.force[k - 3] }
    }

    fn regroupable(_: &SpatialInertia<S>) -> Option<SpatialInertia<S>> {
        None
    }

    fn has_inertia(own: &SpatialInertia<S>) -> bool {
        *own != SpatialInertia::zero()
    }
}
