//! The number that an algorithm runs on.

use nalgebra::{ClosedAddAssign, ClosedMulAssign, ClosedSubAssign};
use num_traits::{One, Zero};

#[cfg(feature = "alloc")]
use crate::region;

/// A real number, or a representation of one: `f32`, `f64`, a symbol, a big float, a dual number.
///
/// There is no ordering on purpose: a program that is traced cannot branch on a value, so a choice
/// between two values is written `S::select(x.positive(), a, b)`, which every scalar can do.
pub trait Scalar:
    nalgebra::Scalar
    + Copy
    + Zero
    + One
    + ClosedAddAssign
    + ClosedSubAssign
    + ClosedMulAssign
    + core::ops::Div<Output = Self>
    + core::ops::Neg<Output = Self>
{
    /// The outcome of a comparison: `bool`, or its representation.
    type Mask: Copy;

    /// Bits of its significand: they decide the length of power series.
    const BITS: u32 = f64::MANTISSA_DIGITS;

    /// Whether computing with zeros and ones costs nothing, as they are known before: then sparse
    /// factors one after the other cost less than their product.
    const FOLDS: bool = false;

    /// The scalar nearest to `x`.
    fn from_f64(x: f64) -> Self;

    /// (sin self, cos self); self in rad.
    fn sin_cos(self) -> (Self, Self);

    /// self·b + c; with one rounding where that is one instruction of the processor compiled for.
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        self * b + c
    }

    /// √self.
    fn sqrt(self) -> Self;

    /// The angle of the point (x, self), rad, in (−π, π]; 0 at the origin. The sign of a zero
    /// counts where the scalar has one.
    fn atan2(self, x: Self) -> Self;

    /// self > 0.
    fn positive(self) -> Self::Mask;

    /// `a` where the mask holds, else `b`. Both are evaluated.
    fn select(mask: Self::Mask, a: Self, b: Self) -> Self;

    /// |self|.
    fn abs(self) -> Self {
        Self::select(self.positive(), self, -self)
    }

    /// Repeats `body` on `state` until the mask that it returns holds, at most `most` times.
    /// Returns whether it held; at the bound `state` has the last values.
    ///
    /// Its derivative is that of the fixed point at which it ends: there one more turn must not
    /// change the state. For a given number of turns use [`Scalar::for_each`].
    ///
    /// ```
    /// use articulated_core::Scalar;
    ///
    /// /// √a by Newton's iteration, x ← (x + a/x)/2.
    /// fn root<S: Scalar>(a: S) -> S {
    ///     let mut x = [a];
    ///     let _converged = S::repeat(50, &mut x, |x| {
    ///         let before = x[0];
    ///         x[0] = S::from_f64(0.5) * (before + a / before);
    ///         (S::from_f64(1e-12) * x[0] - (x[0] - before).abs()).positive()
    ///     });
    ///     x[0]
    /// }
    /// assert!((root(2.0_f64) - 2_f64.sqrt()).abs() < 1e-15);
    /// ```
    #[cfg(feature = "alloc")]
    fn repeat(most: usize, state: &mut [Self], body: impl FnMut(&mut [Self]) -> Self::Mask) -> Self::Mask {
        region::repeat_all(most, state, body)
    }

    /// Runs `body` on `state` only where the mask holds.
    #[cfg(feature = "alloc")]
    fn when(mask: Self::Mask, state: &mut [Self], body: impl FnOnce(&mut [Self])) {
        region::when_all(mask, state, body);
    }

    /// Runs `body` on `state` for each of the `turns` rows of a table, which have the same length:
    /// `body(row, state, results of this turn)`.
    ///
    /// # Panics
    /// If the length of `table` or of `results` is not a multiple of `turns`.
    #[cfg(feature = "alloc")]
    fn for_each(
        turns: usize,
        table: &[Self],
        state: &mut [Self],
        results: &mut [Self],
        body: impl FnMut(&[Self], &mut [Self], &mut [Self]),
    ) {
        region::for_each_turn(turns, table, state, results, body);
    }

    /// How many times in a row what is computed is differentiated at most.
    fn orders() -> usize {
        0
    }

    /// Computes x by `value`, and declares that it is a constant: its derivatives are zero.
    fn held(x: &mut [Self], value: impl FnOnce(&mut [Self])) {
        value(x);
    }

    /// Computes x by `value`, and declares that it solves r(x, p) = 0 with a symmetric ∂r/∂x.
    ///
    /// `residual(x, r)` has r at x, `solve(b)` replaces b by (∂r/∂x)⁻¹ b. Only symbols and dual
    /// numbers call these two: derivatives of generated code are then those of the equation,
    /// dx = −(∂r/∂x)⁻¹ ∂r/∂p dp, and not those of the way on which x was found. They are first
    /// derivatives: for n of them, this is done n times, the next time of x + δ with the solution
    /// δ = 0 (see [`Scalar::orders`]).
    fn implicit<C>(
        context: &mut C,
        x: &mut [Self],
        value: impl FnOnce(&mut C, &mut [Self]),
        residual: impl FnOnce(&mut C, &[Self], &mut [Self]),
        solve: impl FnOnce(&mut C, &mut [Self]),
    ) {
        let _ = (residual, solve);
        value(context, x);
    }
}

/// 1 where the mask holds, else 0.
#[cfg(feature = "alloc")]
pub(crate) fn flag<S: Scalar>(mask: S::Mask) -> S {
    S::select(mask, S::one(), S::zero())
}

/// A power of two of each precision, `f64` and `f32`, of which one counts: generated code is the
/// same for both. The square of 2^−100 is zero in `f32` alone. x, 0 or more, is a number that no
/// pass knows.
#[cfg(feature = "alloc")]
pub(crate) fn of_precision<S: Scalar>(x: S, [wide, narrow]: [i32; 2]) -> S {
    let small = S::select(x.positive(), S::one(), S::from_f64(0.5)) * S::from_f64(two_to(-100));
    S::select((small * small).positive(), S::from_f64(two_to(wide)), S::from_f64(two_to(narrow)))
}

/// x within −most and most.
#[cfg(feature = "alloc")]
pub(crate) fn within<S: Scalar>(x: S, most: S) -> S {
    let x = S::select((x - most).positive(), most, x);
    S::select((-(x + most)).positive(), -most, x)
}

/// √x of x ≥ 0, with a derivative of 0 at 0.
#[cfg(feature = "alloc")]
#[inline(always)]
pub(crate) fn root<S: Scalar>(x: S) -> S {
    let is_positive = x.positive();
    S::select(is_positive, S::select(is_positive, x, S::one()).sqrt(), S::zero())
}

/// The greater of two numbers.
#[cfg(feature = "alloc")]
pub(crate) fn greater<S: Scalar>(a: S, b: S) -> S {
    S::select((a - b).positive(), a, b)
}

/// 2^n, of −1022 or more and 1023 or less; of a lesser n that of −1022.
pub(crate) const fn two_to(n: i32) -> f64 {
    let n = if n < -1022 { -1022 } else { n };
    f64::from_bits(((1023 + n) as u64) << 52)
}

macro_rules! impl_float {
    ($t:ty, $sincos:path, $sqrt:path, $atan2:path) => {
        impl Scalar for $t {
            type Mask = bool;

            const BITS: u32 = <$t>::MANTISSA_DIGITS;

            #[inline(always)]
            fn from_f64(x: f64) -> Self {
                x as $t
            }

            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) {
                #[cfg(feature = "std")]
                return <$t>::sin_cos(self);
                #[cfg(not(feature = "std"))]
                $sincos(self)
            }

            #[cfg(all(feature = "std", any(all(target_arch = "x86_64", target_feature = "fma"), target_arch = "aarch64")))]
            #[inline(always)]
            fn mul_add(self, b: Self, c: Self) -> Self {
                <$t>::mul_add(self, b, c)
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                #[cfg(feature = "std")]
                return <$t>::sqrt(self);
                #[cfg(not(feature = "std"))]
                $sqrt(self)
            }

            #[inline(always)]
            fn atan2(self, x: Self) -> Self {
                #[cfg(feature = "std")]
                return <$t>::atan2(self, x);
                #[cfg(not(feature = "std"))]
                $atan2(self, x)
            }

            #[inline(always)]
            fn positive(self) -> bool {
                self > 0.0
            }

            #[inline(always)]
            fn select(mask: bool, a: Self, b: Self) -> Self {
                if mask { a } else { b }
            }

            #[cfg(feature = "alloc")]
            #[inline(always)]
            fn repeat(most: usize, state: &mut [Self], body: impl FnMut(&mut [Self]) -> bool) -> bool {
                region::repeat_known(most, state, body)
            }

            #[cfg(feature = "alloc")]
            #[inline(always)]
            fn when(mask: bool, state: &mut [Self], body: impl FnOnce(&mut [Self])) {
                if mask {
                    body(state);
                }
            }
        }
    };
}

impl_float!(f32, libm::sincosf, libm::sqrtf, libm::atan2f);
impl_float!(f64, libm::sincos, libm::sqrt, libm::atan2);

#[cfg(test)]
mod tests {
    use super::Scalar;

    #[test]
    fn select_takes_the_side_the_mask_says() {
        assert_eq!(f64::select(2.0.positive(), 1.0, -1.0), 1.0);
        assert_eq!(f64::select(0.0.positive(), 1.0, -1.0), -1.0);
        assert_eq!(Scalar::abs(-3.5_f32), 3.5);
    }
}
