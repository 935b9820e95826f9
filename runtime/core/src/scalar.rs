//! The number that an algorithm runs on.

use nalgebra::{ClosedAddAssign, ClosedMulAssign, ClosedSubAssign};
use num_traits::{One, Zero};

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
