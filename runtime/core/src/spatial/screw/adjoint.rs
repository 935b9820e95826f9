//! Twists and wrenches under a change of frame.
//!
//! Ad(T) takes twists in b to twists in a, and Ad(T⁻¹)ᵀ wrenches, so that power is invariant. Their
//! derivatives are ad(V) W = [V, W], the Lie bracket ([`Twist::cross`]), and coad(V) = −ad(V)ᵀ
//! ([`Twist::cross_wrench`]). Lynch & Park 2017, §3.3.2, §8.2.

use nalgebra::Matrix6;

use super::motion::lower;
use super::rotation::cross_matrix;
use crate::Scalar;
use crate::spatial::{Placement, Twist, Wrench, rotate, rotate_back};

impl<S: Scalar> Placement<S> {
    /// `Ad(T) = [R 0; [p]×R R]`, on twists (angular; linear).
    pub fn adjoint(&self) -> Matrix6<S> {
        lower(&self.rotation, &(cross_matrix(self.position) * self.rotation))
    }

    /// `Ad(T⁻¹)ᵀ = [R [p]×R; 0 R]`, on wrenches (moment; force).
    pub fn coadjoint(&self) -> Matrix6<S> {
        swapped(&self.adjoint())
    }

    /// Ad(T) V: a twist in the frame b about its origin, as one in a.
    #[inline(always)]
    pub fn transform_twist(&self, v: &Twist<S>) -> Twist<S> {
        let angular = rotate(&self.rotation, v.angular);
        Twist { angular, linear: rotate(&self.rotation, v.linear) + self.position.cross(&angular) }
    }

    /// Ad(T⁻¹) V: a twist in the frame a, as one in b.
    #[inline(always)]
    pub fn transform_twist_back(&self, v: &Twist<S>) -> Twist<S> {
        let linear = v.linear - self.position.cross(&v.angular);
        Twist { angular: rotate_back(&self.rotation, v.angular), linear: rotate_back(&self.rotation, linear) }
    }

    /// Ad(T⁻¹)ᵀ F: a wrench in the frame b about its origin, as one in a.
    #[inline(always)]
    pub fn transform_wrench(&self, f: &Wrench<S>) -> Wrench<S> {
        let force = rotate(&self.rotation, f.force);
        Wrench { moment: rotate(&self.rotation, f.moment) + self.position.cross(&force), force }
    }

    /// Ad(T)ᵀ F: a wrench in the frame a, as one in b.
    #[inline(always)]
    pub fn transform_wrench_back(&self, f: &Wrench<S>) -> Wrench<S> {
        let moment = f.moment - self.position.cross(&f.force);
        Wrench { moment: rotate_back(&self.rotation, moment), force: rotate_back(&self.rotation, f.force) }
    }
}

impl<S: Scalar> Twist<S> {
    /// `ad(V) = [[ω]× 0; [v]× [ω]×]`, on twists (angular; linear).
    pub fn ad(&self) -> Matrix6<S> {
        lower(&cross_matrix(self.angular), &cross_matrix(self.linear))
    }

    /// `coad(V) = −ad(V)ᵀ = [[ω]× [v]×; 0 [ω]×]`, on wrenches (moment; force).
    pub fn coad(&self) -> Matrix6<S> {
        swapped(&self.ad())
    }
}

/// [D C; 0 D] of [D 0; C D].
fn swapped<S: Scalar>(m: &Matrix6<S>) -> Matrix6<S> {
    let mut all = *m;
    let coupling = m.fixed_view::<3, 3>(3, 0).into_owned();
    all.fixed_view_mut::<3, 3>(0, 3).copy_from(&coupling);
    all.fixed_view_mut::<3, 3>(3, 0).fill(S::zero());
    all
}
