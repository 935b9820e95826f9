//! Twists.

use nalgebra::{Matrix3, Vector3};

use super::{Wrench, rotate, rotate_back};
use crate::Scalar;

/// A velocity [ω; v] of a body: angular velocity, rad/s, and velocity of the frame's origin, m/s,
/// in axes of that frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twist<S> {
    /// ω, rad/s.
    pub angular: Vector3<S>,
    /// v, m/s.
    pub linear: Vector3<S>,
}

impl<S: Scalar> Twist<S> {
    /// [0; 0].
    pub fn zero() -> Self {
        Self { angular: Vector3::zeros(), linear: Vector3::zeros() }
    }

    /// The same motion, with the velocity of the point at `d` from the origin: [ω; v + ω × d].
    #[inline(always)]
    #[must_use]
    pub fn at(&self, d: Vector3<S>) -> Self {
        Self { angular: self.angular, linear: self.linear + self.angular.cross(&d) }
    }

    /// V × W = ad(V) W = [ω×w; ω×u + v×w].
    #[inline(always)]
    #[must_use]
    pub fn cross(&self, other: &Self) -> Self {
        Self { angular: self.angular.cross(&other.angular), linear: self.angular.cross(&other.linear) + self.linear.cross(&other.angular) }
    }

    /// V ×* F = −ad(V)ᵀ F = [ω×m + v×f; ω×f].
    #[inline(always)]
    pub fn cross_wrench(&self, f: &Wrench<S>) -> Wrench<S> {
        Wrench { moment: self.angular.cross(&f.moment) + self.linear.cross(&f.force), force: self.angular.cross(&f.force) }
    }

    /// The same in other axes, to which `turn` takes vectors: R times each of both.
    #[inline(always)]
    #[must_use]
    pub fn turned(&self, turn: &Matrix3<S>) -> Self {
        Self { angular: rotate(turn, self.angular), linear: rotate(turn, self.linear) }
    }

    /// The same in axes from which `turn` takes vectors to those it is in: Rᵀ times each of both.
    #[inline(always)]
    #[must_use]
    pub fn turned_back(&self, turn: &Matrix3<S>) -> Self {
        Self { angular: rotate_back(turn, self.angular), linear: rotate_back(turn, self.linear) }
    }

    /// The twist times a number.
    #[inline(always)]
    #[must_use]
    pub fn times(&self, x: S) -> Self {
        Self { angular: self.angular * x, linear: self.linear * x }
    }

    /// The inverse of [`Self::to_array`].
    pub fn from_array([a, b, c, d, e, f]: [S; 6]) -> Self {
        Self { angular: Vector3::new(a, b, c), linear: Vector3::new(d, e, f) }
    }

    /// The six numbers.
    pub fn to_array(&self) -> [S; 6] {
        let (w, v) = (&self.angular, &self.linear);
        [w.x, w.y, w.z, v.x, v.y, v.z]
    }
}

impl<S: Scalar> core::ops::Add for Twist<S> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { angular: self.angular + other.angular, linear: self.linear + other.linear }
    }
}

impl<S: Scalar> core::ops::Sub for Twist<S> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { angular: self.angular - other.angular, linear: self.linear - other.linear }
    }
}
