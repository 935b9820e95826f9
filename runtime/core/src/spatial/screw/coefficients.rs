//! Functions of the angle in exponentials, logarithms and their derivatives.
//!
//! All are analytic in x = θ², and are functions of x here: √x has no derivative at 0. With h = θ/2
//! and the spherical Bessel functions j_n, B_n = j_n(h)/hⁿ, for which dB_n/d(h²) = −½ B_{n+1}, most
//! of them are products without any difference:
//!
//! | | | at 0 |
//! |---|---|--:|
//! | sin θ/θ | B_0 cos h | 1 |
//! | β = (1 − cos θ)/θ² | ½ B_0² | 1/2 |
//! | β' = dβ/dx | −⅛ B_0 B_1 | −1/24 |
//! | γ = (θ − sin θ)/θ³ | | 1/6 |
//! | γ' = dγ/dx | | −1/120 |
//! | ε = 1/θ² − cot(θ/2)/(2θ) | B_1/(4 B_0) | 1/12 |
//! | ε' = dε/dx | by a continued fraction up to θ = π, then (B_1² − B_0 B_2)/(32 B_0²) | 1/720 |
//!
//! ε has a pole at θ = 2π, where the logarithm ends: there its relative error is that of 1/(2π −
//! θ).

use super::series::{Series, beyond};
use crate::Scalar;

/// HalfAngle of an angle θ, from x = θ²: one root, one sine, one cosine for everything below.
#[derive(Clone, Copy, Debug)]
pub struct HalfAngle<S> {
    /// x = θ².
    x: S,
    /// y = h² = x/4.
    y: S,
    /// h, but 1/2 where h is less.
    h: S,
    /// sin h and cos h.
    sin: S,
    cos: S,
}

impl<S: Scalar> HalfAngle<S> {
    /// Of θ = √x, rad; x ≥ 0.
    #[inline(always)]
    pub fn new(x: S) -> Self {
        let y = x * S::from_f64(0.25);
        let h = beyond(y, 0.25).sqrt();
        let (sin, cos) = h.sin_cos();
        Self { x, y, h, sin, cos }
    }

    /// cos h.
    #[inline(always)]
    pub fn cosine(&self) -> S {
        Series::Cosine.or(self.y, self.cos)
    }

    /// B_0 = sin h/h.
    #[inline(always)]
    pub fn sinc(&self) -> S {
        Series::Sinc.or(self.y, self.sin / self.h)
    }

    /// B_1 = (sin h − h cos h)/h³.
    #[inline(always)]
    fn first(&self) -> S {
        let Self { h, sin, cos, .. } = *self;
        Series::First.or(self.y, (sin - h * cos) / (h * h * h))
    }

    /// B_2 = (3 sin h − 3h cos h − h² sin h)/h⁵.
    #[inline(always)]
    fn second(&self) -> S {
        let Self { h, sin, cos, .. } = *self;
        let (square, three) = (h * h, S::from_f64(3.0));
        Series::Second.or(self.y, (three * (sin - h * cos) - square * sin) / (square * square * h))
    }

    /// β = (1 − cos θ)/θ².
    #[inline(always)]
    pub fn versine(&self) -> S {
        let sinc = self.sinc();
        S::from_f64(0.5) * (sinc * sinc)
    }

    /// β'.
    #[inline(always)]
    pub fn versine_rate(&self) -> S {
        -(S::from_f64(0.125) * (self.sinc() * self.first()))
    }

    /// γ = (θ − sin θ)/θ³ = (h − sin h cos h)/(4h³).
    #[inline(always)]
    pub fn excess(&self) -> S {
        let Self { h, sin, cos, .. } = *self;
        Series::Excess.or(self.x, (h - sin * cos) / (S::from_f64(4.0) * (h * h * h)))
    }

    /// γ' = (3 sin θ − 2θ − θ cos θ)/(2θ⁵) = (3 sin h cos h − h − 2h cos² h)/(32h⁵).
    #[inline(always)]
    pub fn excess_rate(&self) -> S {
        let Self { h, sin, cos, .. } = *self;
        let (square, three) = (h * h, S::from_f64(3.0));
        let numerator = cos * (three * sin - (h + h) * cos) - h;
        Series::ExcessRate.or(self.x, numerator / (S::from_f64(32.0) * (square * square * h)))
    }

    /// ε = 1/θ² − cot(θ/2)/(2θ).
    #[inline(always)]
    pub fn inverse(&self) -> S {
        self.first() / (S::from_f64(4.0) * self.sinc())
    }

    /// ε'.
    #[inline(always)]
    pub fn inverse_rate(&self) -> S {
        let (zeroth, first, second) = (self.sinc(), self.first(), self.second());
        let closed = (first * first - zeroth * second) / (S::from_f64(32.0) * (zeroth * zeroth));
        let far = (self.y - S::from_f64(FRACTION)).positive();
        S::select(far, closed, inverse_rate_by_fraction(S::select(far, S::zero(), self.y)))
    }
}

/// Up to which y = h² ε' is taken from its continued fraction: a little beyond (π/2)².
const FRACTION: f64 = 2.5;

/// ε' from y = h²: B_1/B_0 = 1/(3 − y/(5 − y/(7 − …))) (Gauss), and its derivative, a product of
/// sums of positive terms: nothing cancels, where the closed form loses four bits.
#[inline(always)]
fn inverse_rate_by_fraction<S: Scalar>(y: S) -> S {
    let odd = |k: u32| S::from_f64(f64::from(2 * k + 1));
    // t = y/(2k + 1 − t_next), and its derivative.
    let (mut t, mut slope) = (S::zero(), S::zero());
    for k in (2..=const { levels(S::BITS) }).rev() {
        let inverse = S::one() / (odd(k) - t);
        t = y * inverse;
        slope = inverse * (S::one() + t * slope);
    }
    let ratio = S::one() / (S::from_f64(3.0) - t);
    S::from_f64(1.0 / 16.0) * (ratio * ratio * slope)
}

/// Number of levels of the fraction that leave less than 2^(−bits − 4): each contributes y/((2k +
/// 1)(2k + 3)), and a little, of the one before.
const fn levels(bits: u32) -> u32 {
    let (mut k, mut left, mut halvings) = (1, 1.0_f64, 0);
    while halvings < bits + 4 {
        k += 1;
        left *= FRACTION / (((2 * k - 1) * (2 * k + 1)) as f64 - 2.0 * FRACTION);
        while left <= 0.5 {
            left *= 2.0;
            halvings += 1;
        }
    }
    k
}

/// 2·atan(s/w)/s from s² and w ≥ 0, not both zero: the factor from the vector of a quaternion (s
/// times the axis, w) to the rotation vector. s² + w² need not be one.
#[inline(always)]
pub(super) fn rotation_over_vector<S: Scalar>(square: S, w: S) -> S {
    let one = S::one();
    let limit = Series::Arctangent.limit();
    // Where s² is not beyond w²·limit the quotient is small, and w is not zero.
    let far = (square - w * w * S::from_f64(limit)).positive();
    let safe = S::select(far, one, w);
    let tangent = S::select(far, S::zero(), square) / (safe * safe);
    let near = Series::Arctangent.sum(tangent) / safe;
    let sine = S::select(far, square, one).sqrt();
    let ratio = S::select(far, sine.atan2(w) / sine, near);
    ratio + ratio
}
