//! A slide along z.

use nalgebra::Vector3;

use super::{Coordinates, Freedom, JointLaw};
use crate::Scalar;
use crate::spatial::{ArticulatedInertia, Matrix3, Motion, Placement, SpatialInertia, Twist, Wrench};

/// R = 1, p = e_z q, S = [0; e_z].
#[derive(Clone, Copy, Debug)]
pub struct Prismatic<S> {
    shift: S,
}

impl<S: Scalar> Prismatic<S> {
    /// A slide by `shift` metres.
    pub(super) fn by(shift: S) -> Self {
        Self { shift }
    }

    /// The motion of the carrying point, with a slide at `rate` and its derivative added.
    #[inline(always)]
    pub(super) fn slide(carried: Motion<S>, rate: S, derivative: S) -> Motion<S> {
        let (mut acceleration, twice) = (carried.acceleration, rate + rate);
        // r̈ = r̈_carried + 2 ω × e_z q̇ + e_z q̈
        acceleration.x += carried.omega.y * twice;
        acceleration.y -= carried.omega.x * twice;
        acceleration.z += derivative;
        Motion { acceleration, ..carried }
    }
}

impl<S: Scalar> JointLaw<S> for Prismatic<S> {
    const NQ: usize = 1;
    const NV: usize = 1;
    const QUATERNION: Option<usize> = None;
    const ROTATION: Freedom = Freedom::None;
    const TRANSLATION: Freedom = Freedom::Axis;

    #[inline(always)]
    fn at(at: &Coordinates<S>, q: &[S]) -> Self {
        Self { shift: at.coordinate(q) }
    }

    #[inline(always)]
    fn to_child(&self, v: Vector3<S>) -> Vector3<S> {
        v
    }

    #[inline(always)]
    fn to_joint(&self, v: Vector3<S>) -> Vector3<S> {
        v
    }

    #[inline(always)]
    fn origin(&self, x_pj: &Placement<S>) -> Vector3<S> {
        x_pj.position + x_pj.rotation.column(2) * self.shift
    }

    #[inline(always)]
    fn compose(&self, x_wj: Placement<S>) -> Placement<S> {
        Placement { rotation: x_wj.rotation, position: self.origin(&x_wj) }
    }

    #[inline(always)]
    fn subspace(&self, turn: &Matrix3<S>, _: usize) -> Twist<S> {
        Twist { angular: Vector3::zeros(), linear: turn.column(2).into_owned() }
    }

    #[inline(always)]
    fn motion(&self, carried: Motion<S>, turn: impl Fn(Vector3<S>) -> Vector3<S>, at: &Coordinates<S>, state: [&[S]; 3]) -> Motion<S> {
        let [rate, acceleration] = at.rates(state);
        Self::slide(carried.turned(turn), rate, acceleration)
    }

    #[inline(always)]
    fn inertia_to_joint(&self, i: &SpatialInertia<S>) -> SpatialInertia<S> {
        // A shift by d = q along z: h' = h + m d, Σ' = Σ + (h e_zᵀ + e_z hᵀ) d + m d² e_z e_zᵀ
        let (d, h, mut second) = (self.shift, i.first, i.second);
        let md = i.mass * d;
        for (k, hk) in [(0, h.x), (1, h.y)] {
            second[(k, 2)] += hk * d;
            second[(2, k)] = second[(k, 2)];
        }
        second.m33 += (h.z + h.z + md) * d;
        SpatialInertia { mass: i.mass, first: Vector3::new(h.x, h.y, h.z + md), second }
    }

    #[inline(always)]
    fn articulated_to_joint(&self, inertia: &ArticulatedInertia<S>) -> ArticulatedInertia<S> {
        *inertia
    }

    #[inline(always)]
    fn freedom(_: usize) -> Option<usize> {
        Some(5)
    }

    #[inline(always)]
    fn column(&self, i: &SpatialInertia<S>, _: usize) -> Wrench<S> {
        // f = m e_z, n = h × e_z
        let o = S::zero();
        Wrench { moment: Vector3::new(i.first.y, -i.first.x, o), force: Vector3::new(o, o, i.mass) }
    }

    #[inline(always)]
    fn torque(&self, wrench: &Wrench<S>, _: usize) -> S {
        wrench.force.z
    }

    fn regroupable(own: &SpatialInertia<S>) -> Option<SpatialInertia<S>> {
        Some(SpatialInertia { second: own.second, ..SpatialInertia::zero() })
    }

    fn has_inertia(own: &SpatialInertia<S>) -> bool {
        !own.mass.is_zero()
    }
}
