//! Power series that take over where a closed form cancels.
//!
//! Each is Σ_k c_k (−x)^k with c_k/c_{k−1} a quotient of small integers, summed by Horner's rule
//! from the inside: c_0·(1 − r_1 x (1 − r_2 x (…))). Every coefficient is exact in any scalar, and
//! there are as many as the scalar has bits for.

use crate::Scalar;

/// A series, by the function that it sums.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Series {
    /// cos √x.
    Cosine,
    /// sin θ/θ, x = θ².
    Sinc,
    /// (sin θ − θ cos θ)/θ³.
    First,
    /// (3 sin θ − 3θ cos θ − θ² sin θ)/θ⁵.
    Second,
    /// (θ − sin θ)/θ³.
    Excess,
    /// (3 sin θ − 2θ − θ cos θ)/(2θ⁵), the derivative of [`Series::Excess`] in x.
    ExcessRate,
    /// atan t/t, x = t².
    Arctangent,
}

impl Series {
    /// The x up to which the series is used; beyond it, the closed form.
    ///
    /// A closed form that is the difference of terms a, b, … is off by some (|a| + |b| + …)/|a − b
    /// …| roundings; each limit lies where that has fallen to about 3. The sinc cancels nowhere,
    /// but its derivatives by dual numbers do, as 1/θ².
    pub(super) const fn limit(self) -> f64 {
        match self {
            Self::Cosine => 0.25,
            Self::Sinc => 1.0,
            Self::First => 2.0,
            Self::Second => 6.0,
            Self::Excess => 4.0,
            Self::ExcessRate => 7.0,
            Self::Arctangent => 1.0 / 64.0,
        }
    }

    /// 1/c_0.
    const fn divisor(self) -> f64 {
        match self {
            Self::Cosine | Self::Sinc | Self::Arctangent => 1.0,
            Self::First => 3.0,
            Self::Second => 15.0,
            Self::Excess => 6.0,
            Self::ExcessRate => -120.0,
        }
    }

    /// r_k = c_k/c_{k−1} as numerator and denominator, k = 1, 2, …
    const fn ratio(self, k: f64) -> (f64, f64) {
        match self {
            Self::Cosine => (1.0, (2.0 * k - 1.0) * 2.0 * k),
            Self::Sinc => (1.0, 2.0 * k * (2.0 * k + 1.0)),
            Self::First => (1.0, 2.0 * k * (2.0 * k + 3.0)),
            Self::Second => (1.0, 2.0 * k * (2.0 * k + 5.0)),
            Self::Excess => (1.0, (2.0 * k + 2.0) * (2.0 * k + 3.0)),
            Self::ExcessRate => (k + 1.0, k * (2.0 * k + 4.0) * (2.0 * k + 5.0)),
            Self::Arctangent => (2.0 * k - 1.0, 2.0 * k + 1.0),
        }
    }

    /// How many terms follow the first: at the limit, what is left out is below 2^(−bits − 2) of
    /// the first. All terms alternate and fall, so the rest is less than the first that is left
    /// out.
    const fn terms(self, bits: u32) -> u32 {
        let (mut k, mut left, mut halvings) = (0, 1.0_f64, 0);
        while halvings < bits + 2 {
            k += 1;
            let (a, b) = self.ratio(k as f64);
            left *= a / b * self.limit();
            while left <= 0.5 {
                left *= 2.0;
                halvings += 1;
            }
        }
        k - 1
    }

    /// The same, from a table for the scalars of 53 and 24 bits: to count anew would take longer
    /// than to sum.
    #[inline(always)]
    const fn count(self, bits: u32) -> u32 {
        match bits {
            53 => Self::COUNTS_53[self as usize],
            24 => Self::COUNTS_24[self as usize],
            _ => self.terms(bits),
        }
    }

    const COUNTS_53: [u32; 7] = Self::counts(53);
    const COUNTS_24: [u32; 7] = Self::counts(24);

    /// [`Series::terms`] of each series, in the order of the enumeration.
    const fn counts(bits: u32) -> [u32; 7] {
        [
            Self::Cosine.terms(bits),
            Self::Sinc.terms(bits),
            Self::First.terms(bits),
            Self::Second.terms(bits),
            Self::Excess.terms(bits),
            Self::ExcessRate.terms(bits),
            Self::Arctangent.terms(bits),
        ]
    }

    /// The sum at x. Off by an ulp or so up to the limit, by anything beyond.
    #[inline(always)]
    pub(super) fn sum<S: Scalar>(self, x: S) -> S {
        let mut sum = S::one();
        for k in (1..=self.count(S::BITS)).rev() {
            let (a, b) = self.ratio(f64::from(k));
            // 1 − r_k x (…)
            sum = S::one() - x * (S::from_f64(a) / S::from_f64(b)) * sum;
        }
        sum / S::from_f64(self.divisor())
    }

    /// `closed` where x is beyond the limit, else the series. The closed form is evaluated
    /// everywhere, so it has to be finite everywhere: see [`beyond`].
    #[inline(always)]
    pub(super) fn or<S: Scalar>(self, x: S, closed: S) -> S {
        let far = is_beyond(x, self.limit());
        S::select(far, closed, self.sum(S::select(far, S::zero(), x)))
    }
}

#[inline(always)]
fn is_beyond<S: Scalar>(x: S, limit: f64) -> S::Mask {
    (x - S::from_f64(limit)).positive()
}

/// x, or `limit` below it: a valid divisor for a closed form that is not used, derivatives
/// included.
#[inline(always)]
pub(super) fn beyond<S: Scalar>(x: S, limit: f64) -> S {
    S::select(is_beyond(x, limit), x, S::from_f64(limit))
}
