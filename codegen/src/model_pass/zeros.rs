//! Zeros among numbers that were computed.

use articulated_core::Scalar;

/// `x`, or zero where it is within the rounding error of terms of this size.
pub(super) fn or_zero<S: Scalar>(x: S, size: S) -> S {
    // A few units of roundoff: 2^(3 − BITS).
    let few = 2.0_f64.powi(3 - S::BITS as i32);
    if x == S::zero() || within(x.abs(), size * S::from_f64(few)) { S::zero() } else { x }
}

/// Whether x ≤ limit. Of a symbol this is unknown, and the answer is no.
pub(super) fn within<S: Scalar>(x: S, limit: S) -> bool {
    S::select((x - limit).positive(), S::zero(), S::one()) == S::one()
}

/// Numbers that are not zero.
pub(super) fn count<S: Scalar>(x: &[S]) -> u32 {
    x.iter().filter(|x| **x != S::zero()).count() as u32
}
