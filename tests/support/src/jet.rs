//! A number that moves: its value and its first two derivatives with respect to time.

use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use articulated_core::Scalar;
use num_traits::{One, Zero};

/// x, ẋ, ẍ. Results computed with it have their exact derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet<S>(pub S, pub S, pub S);

impl<S: Scalar> Jet<S> {
    /// A number that does not move.
    pub fn still(x: S) -> Self {
        Self(x, S::zero(), S::zero())
    }
}

impl<S: Scalar> Zero for Jet<S> {
    fn zero() -> Self {
        Self::still(S::zero())
    }

    fn is_zero(&self) -> bool {
        self.0.is_zero() && self.1.is_zero() && self.2.is_zero()
    }
}

impl<S: Scalar> One for Jet<S> {
    fn one() -> Self {
        Self::still(S::one())
    }
}

impl<S: Scalar> Add for Jet<S> {
    type Output = Self;

    fn add(self, b: Self) -> Self {
        Self(self.0 + b.0, self.1 + b.1, self.2 + b.2)
    }
}

impl<S: Scalar> Neg for Jet<S> {
    type Output = Self;

    fn neg(self) -> Self {
        Self(-self.0, -self.1, -self.2)
    }
}

impl<S: Scalar> Sub for Jet<S> {
    type Output = Self;

    fn sub(self, b: Self) -> Self {
        self + -b
    }
}

impl<S: Scalar> Mul for Jet<S> {
    type Output = Self;

    // (ab)˙ = ȧb + aḃ;  (ab)¨ = äb + 2ȧḃ + ab̈
    fn mul(self, b: Self) -> Self {
        let cross = self.1 * b.1;
        Self(self.0 * b.0, self.1 * b.0 + self.0 * b.1, self.2 * b.0 + (cross + cross) + self.0 * b.2)
    }
}

impl<S: Scalar> Div for Jet<S> {
    type Output = Self;

    // From a = c·b, differentiated.
    fn div(self, b: Self) -> Self {
        let value = self.0 / b.0;
        let first = (self.1 - value * b.1) / b.0;
        let cross = first * b.1;
        Self(value, first, (self.2 - (cross + cross) - value * b.2) / b.0)
    }
}

impl<S: Scalar> AddAssign for Jet<S> {
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}

impl<S: Scalar> SubAssign for Jet<S> {
    fn sub_assign(&mut self, b: Self) {
        *self = *self - b;
    }
}

impl<S: Scalar> MulAssign for Jet<S> {
    fn mul_assign(&mut self, b: Self) {
        *self = *self * b;
    }
}

impl<S: Scalar> Scalar for Jet<S> {
    type Mask = S::Mask;

    const BITS: u32 = S::BITS;

    fn from_f64(x: f64) -> Self {
        Self::still(S::from_f64(x))
    }

    // s˙ = c ẋ, s¨ = c ẍ − s ẋ²;  c˙ = −s ẋ, c¨ = −s ẍ − c ẋ²
    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = self.0.sin_cos();
        let square = self.1 * self.1;
        (Self(s, c * self.1, c * self.2 - s * square), Self(c, -(s * self.1), -(s * self.2) - c * square))
    }

    // From r² = x, differentiated.
    fn sqrt(self) -> Self {
        let value = self.0.sqrt();
        let twice = value + value;
        let first = self.1 / twice;
        let square = first * first;
        Self(value, first, (self.2 - (square + square)) / twice)
    }

    // r² θ˙ = x ẏ − y ẋ, differentiated once more.
    fn atan2(self, x: Self) -> Self {
        let square = x.0 * x.0 + self.0 * self.0;
        let half_rate = x.0 * x.1 + self.0 * self.1;
        let first = (x.0 * self.1 - self.0 * x.1) / square;
        let second = (x.0 * self.2 - self.0 * x.2 - (half_rate + half_rate) * first) / square;
        Self(self.0.atan2(x.0), first, second)
    }

    fn positive(self) -> S::Mask {
        self.0.positive()
    }

    fn select(mask: S::Mask, a: Self, b: Self) -> Self {
        Self(S::select(mask, a.0, b.0), S::select(mask, a.1, b.1), S::select(mask, a.2, b.2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// f(t) with its derivatives by differences of fourth order.
    fn near(f: impl Fn(Jet<f64>) -> Jet<f64>) {
        let (t, h) = (0.7, 1e-3);
        let at = |k: f64| f(Jet(t + k * h, 1.0, 0.0)).0;
        let first = (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * h);
        let second = (16.0 * (at(1.0) + at(-1.0)) - (at(2.0) + at(-2.0)) - 30.0 * at(0.0)) / (12.0 * h * h);
        let exact = f(Jet(t, 1.0, 0.0));
        assert!((exact.1 - first).abs() < 1e-10 && (exact.2 - second).abs() < 1e-8, "{exact:?} {first} {second}");
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        near(|t| t * t * t - t);
        near(|t| t.sin_cos().0 / (t + Jet::one()));
        near(|t| (t * t).sin_cos().1 * t.sqrt());
        near(|t| Scalar::abs(-t));
        near(|t| (t * t).atan2(-t.sin_cos().1));
    }
}
