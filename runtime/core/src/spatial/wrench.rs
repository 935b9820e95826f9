//! Wrenches.

use nalgebra::{Matrix3, Vector3};

use super::{Twist, rotate, rotate_back};
use crate::Scalar;

/// A force [m; f] on a body: moment about the frame's origin, N·m, and force, N, in axes of that
/// frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrench<S> {
    /// m, N·m.
    pub moment: Vector3<S>,
    /// f, N.
    pub force: Vector3<S>,
}

impl<S: Scalar> Wrench<S> {
    /// [0; 0].
    #[inline(always)]
    pub fn zero() -> Self {
        Self { moment: Vector3::zeros(), force: Vector3::zeros() }
    }

    /// The wrench times a number, if there is one.
    #[cfg(feature = "alloc")]
    pub(crate) fn scaled(mut self, factor: Option<S>) -> Self {
        if let Some(factor) = factor {
            self.moment *= factor;
            self.force *= factor;
        }
        self
    }

    /// The same force, with the moment about the point at −`d` from the origin: [m + d × f; f].
    #[inline(always)]
    #[must_use]
    pub fn shifted(&self, d: Vector3<S>) -> Self {
        Self { moment: self.moment + d.cross(&self.force), force: self.force }
    }

    /// The same in other axes, to which `turn` takes vectors: R times each of both.
    #[inline(always)]
    #[must_use]
    pub fn turned(&self, turn: &Matrix3<S>) -> Self {
        Self { moment: rotate(turn, self.moment), force: rotate(turn, self.force) }
    }

    /// The same in axes from which `turn` takes vectors to those it is in: Rᵀ times each of both.
    #[inline(always)]
    #[must_use]
    pub fn turned_back(&self, turn: &Matrix3<S>) -> Self {
        Self { moment: rotate_back(turn, self.moment), force: rotate_back(turn, self.force) }
    }

    /// The wrench times a number.
    #[inline(always)]
    #[must_use]
    pub fn times(&self, x: S) -> Self {
        Self { moment: self.moment * x, force: self.force * x }
    }

    /// Number k of the six.
    #[inline(always)]
    pub fn number(&mut self, k: usize) -> &mut S {
        if k < 3 { &mut self.moment[k] } else { &mut self.force[k - 3] }
    }

    /// The inverse of [`Self::to_array`].
    pub fn from_array([a, b, c, d, e, f]: [S; 6]) -> Self {
        Self { moment: Vector3::new(a, b, c), force: Vector3::new(d, e, f) }
    }

    /// The six numbers.
    pub fn to_array(&self) -> [S; 6] {
        let (m, f) = (&self.moment, &self.force);
        [m.x, m.y, m.z, f.x, f.y, f.z]
    }

    /// The power ω·m + v·f that the wrench gives to a body moving with `twist`, W. Both in the same
    /// frame.
    pub fn power(&self, twist: &Twist<S>) -> S {
        twist.angular.dot(&self.moment) + twist.linear.dot(&self.force)
    }
}

impl<S: Scalar> core::ops::AddAssign for Wrench<S> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        self.moment += other.moment;
        self.force += other.force;
    }
}

impl<S: Scalar> core::ops::Add for Wrench<S> {
    type Output = Self;

    #[inline(always)]
    fn add(mut self, other: Self) -> Self {
        self += other;
        self
    }
}

impl<S: Scalar> core::ops::Sub for Wrench<S> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { moment: self.moment - other.moment, force: self.force - other.force }
    }
}
