//! A turn about z that slides along z.

use nalgebra::Vector3;

use super::{Coordinates, Freedom, JointLaw, Prismatic, Revolute};
use crate::Scalar;
use crate::spatial::{ArticulatedInertia, Matrix3, Motion, Placement, SpatialInertia, Twist, Wrench};

/// R = Rz(q), p = e_z h q, S = [e_z; h e_z], with h in m/rad.
#[derive(Clone, Copy, Debug)]
pub struct Helical<S> {
    turn: Revolute<S>,
    slide: Prismatic<S>,
    pitch: S,
}

impl<S: Scalar> JointLaw<S> for Helical<S> {
    const NQ: usize = 1;
    const NV: usize = 1;
    const QUATERNION: Option<usize> = None;
    const ROTATION: Freedom = Freedom::Axis;
    const TRANSLATION: Freedom = Freedom::Axis;

    #[inline(always)]
    fn at(at: &Coordinates<S>, q: &[S]) -> Self {
        Self { turn: Revolute::at(at, q), slide: Prismatic::by(at.coordinate(q) * at.pitch), pitch: at.pitch }
    }

    #[inline(always)]
    fn to_child(&self, v: Vector3<S>) -> Vector3<S> {
        self.turn.to_child(v)
    }

    #[inline(always)]
    fn to_joint(&self, v: Vector3<S>) -> Vector3<S> {
        self.turn.to_joint(v)
    }

    #[inline(always)]
    fn origin(&self, x_pj: &Placement<S>) -> Vector3<S> {
        self.slide.origin(x_pj)
    }

    #[inline(always)]
    fn compose(&self, x_wj: Placement<S>) -> Placement<S> {
        self.turn.compose(self.slide.compose(x_wj))
    }

    #[inline(always)]
    fn subspace(&self, turn: &Matrix3<S>, _: usize) -> Twist<S> {
        let z = turn.column(2).into_owned();
        Twist { angular: z, linear: z * self.pitch }
    }

    #[inline(always)]
    fn motion(&self, carried: Motion<S>, turn: impl Fn(Vector3<S>) -> Vector3<S>, at: &Coordinates<S>, state: [&[S]; 3]) -> Motion<S> {
        let [rate, acceleration] = at.rates(state);
        let slid = Prismatic::slide(carried.turned(turn), rate * self.pitch, acceleration * self.pitch);
        self.turn.motion(slid, |vector| vector, at, state)
    }

    #[inline(always)]
    fn inertia_to_joint(&self, inertia: &SpatialInertia<S>) -> SpatialInertia<S> {
        self.slide.inertia_to_joint(&self.turn.inertia_to_joint(inertia))
    }

    #[inline(always)]
    fn articulated_to_joint(&self, inertia: &ArticulatedInertia<S>) -> ArticulatedInertia<S> {
        self.turn.articulated_to_joint(inertia)
    }

    #[inline(always)]
    fn freedom(_: usize) -> Option<usize> {
        None
    }

    #[inline(always)]
    fn column(&self, inertia: &SpatialInertia<S>, k: usize) -> Wrench<S> {
        // I [e_z; h e_z]
        let mut wrench = self.slide.column(inertia, k).times(self.pitch);
        wrench += self.turn.column(inertia, k);
        wrench
    }

    #[inline(always)]
    fn torque(&self, wrench: &Wrench<S>, _: usize) -> S {
        wrench.moment.z + self.pitch * wrench.force.z
    }

    fn regroupable(_: &SpatialInertia<S>) -> Option<SpatialInertia<S>> {
        None
    }

    fn has_inertia(own: &SpatialInertia<S>) -> bool {
        Prismatic::has_inertia(own) || Revolute::has_inertia(own)
    }
}
