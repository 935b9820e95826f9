//! Twists.

use nalgebra::Vector3;

use crate::Scalar;

/// A velocity [ω; v] of a body: angular velocity, rad/s, and velocity of the frame's origin, m/s, in axes of that frame.
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
}
