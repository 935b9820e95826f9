//! The scale against which a rounding error is measured.
//!
//! Operations are calls, not inlined: algorithms would become several times as large, and take as
//! much longer to compile, without benefit.

mod norms;
mod scales;
mod solution;

use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use articulated_core::Scalar;
use articulated_core::region::repeat_known;
use num_traits::{One, Zero};

pub use norms::{is_plain, norms};
pub use scales::{scales, scales_of_generated, where_suspect};

/// A value together with the sum of the magnitudes of its terms.
///
/// |x| where nothing cancels; more where terms cancel, by as much as rounding errors of the terms count more there. An
/// evaluation in floating point is off by about unit roundoff times this, whatever the order of its
/// operations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Magnitude {
    /// The value, in double precision.
    pub value: f64,
    /// The sum of the magnitudes of its terms; never less than |value|, rounding apart.
    pub magnitude: f64,
    /// Whether the value is an input, not computed.
    given: bool,
}

impl Magnitude {
    /// A value from a computation whose terms have these magnitudes.
    pub fn computed(value: f64, magnitude: f64) -> Self {
        Self { value, magnitude, given: false }
    }
}

impl Zero for Magnitude {
    fn zero() -> Self {
        Self::from_f64(0.0)
    }

    fn is_zero(&self) -> bool {
        self.value == 0.0 && self.magnitude == 0.0
    }
}

impl One for Magnitude {
    fn one() -> Self {
        Self::from_f64(1.0)
    }
}

impl Add for Magnitude {
    type Output = Self;

    // ‖a + b‖ = ‖a‖ + ‖b‖
    #[inline(never)]
    fn add(self, other: Self) -> Self {
        Self::computed(self.value + other.value, self.magnitude + other.magnitude)
    }
}

impl Sub for Magnitude {
    type Output = Self;

    #[inline(never)]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Magnitude {
    type Output = Self;

    // ‖a b‖ = ‖a‖ ‖b‖
    #[inline(never)]
    fn mul(self, other: Self) -> Self {
        Self::computed(self.value * other.value, self.magnitude * other.magnitude)
    }
}

impl Div for Magnitude {
    type Output = Self;

    // ‖a / b‖ = ‖a‖ ‖b‖ / b²
    #[inline(never)]
    fn div(self, other: Self) -> Self {
        Self::computed(self.value / other.value, self.magnitude / other.value.abs() * (other.magnitude / other.value.abs()))
    }
}

impl Neg for Magnitude {
    type Output = Self;

    #[inline(never)]
    fn neg(self) -> Self {
        Self { value: -self.value, ..self }
    }
}

impl AddAssign for Magnitude {
    #[inline(never)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Magnitude {
    #[inline(never)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl MulAssign for Magnitude {
    #[inline(never)]
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl Scalar for Magnitude {
    type Mask = bool;

    #[inline(never)]
    fn from_f64(x: f64) -> Self {
        Self { value: x, magnitude: x.abs(), given: true }
    }

    // ‖sin x‖ = |sin x| + |cos x| ‖x‖ for a computed angle x, |sin x| for an input
    #[inline(never)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value.sin_cos();
        let angle = if self.given { 0.0 } else { self.magnitude };
        (Self::computed(sin, sin.abs() + cos.abs() * angle), Self::computed(cos, cos.abs() + sin.abs() * angle))
    }

    // ‖√x‖ = ‖x‖ / √x
    #[inline(never)]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        Self::computed(root, if self.magnitude == 0.0 { 0.0 } else { self.magnitude / root })
    }

    // ‖atan2(y, x)‖ = |atan2(y, x)| + (|x| ‖y‖ + |y| ‖x‖) / (x² + y²)
    #[inline(never)]
    fn atan2(self, x: Self) -> Self {
        let (angle, r) = (self.value.atan2(x.value), self.value.hypot(x.value));
        let share = |along: f64, across: f64| if across == 0.0 { 0.0 } else { along.abs() / r * (across / r) };
        Self::computed(angle, angle.abs() + share(x.value, self.magnitude) + share(self.value, x.magnitude))
    }

    fn positive(self) -> bool {
        self.value > 0.0
    }

    fn select(mask: bool, a: Self, b: Self) -> Self {
        if mask { a } else { b }
    }

    fn repeat(most: usize, state: &mut [Self], body: impl FnMut(&mut [Self]) -> bool) -> bool {
        repeat_known(most, state, body)
    }
}

/// Unit roundoff of double precision, 2⁻⁵³.
pub const ROUNDOFF: f64 = f64::EPSILON / 2.0;

#[cfg(test)]
mod tests {
    use super::*;

    fn of(x: f64) -> Magnitude {
        Magnitude::from_f64(x)
    }

    #[test]
    fn cancellation_lowers_the_value_and_not_the_scale() {
        let x = of(3.0) * of(-2.0) + of(6.0);
        assert_eq!((x.value, x.magnitude), (0.0, 12.0));
        let y = of(1.0) / (of(3.0) - of(2.0));
        assert_eq!((y.value, y.magnitude), (1.0, 5.0));
    }

    #[test]
    fn the_sine_of_a_computed_angle_carries_the_error_of_the_angle() {
        assert_eq!(of(1000.0).sin_cos().1.magnitude, 1000.0_f64.cos().abs());
        assert!((of(500.0) + of(500.0)).sin_cos().1.magnitude > 800.0);
        assert_eq!((of(4.0).sqrt().value, of(4.0).sqrt().magnitude), (2.0, 2.0));
    }

    #[test]
    fn the_angle_of_a_point_carries_the_error_of_the_point() {
        let angle = of(1.0).atan2(of(1.0));
        assert!((angle.magnitude - (angle.value + 1.0)).abs() < 1e-15);
        // (1000 − 999, 0): the zero has no influence, the one has an error of 1999.
        assert!((of(0.0).atan2(of(1000.0) - of(999.0))).magnitude < 1e-15);
        assert!(((of(1000.0) - of(999.0)).atan2(of(1e3))).magnitude > 1.99);
        assert_eq!(of(0.0).atan2(of(0.0)).magnitude, 0.0);
    }
}
