//! Zeros among numbers that were computed.

use crate::Scalar;
use crate::scalar::two_to;

/// `x`, or zero where it is no more than the rounding of terms of this size.
pub(super) fn or_zero<S: Scalar>(x: S, size: S) -> S {
    // A few units of roundoff: 2^(3 − BITS).
    let few = const { two_to(3 - S::BITS as i32) };
    if x == S::zero() || within(x.abs(), size * S::from_f64(few)) { S::zero() } else { x }
}

/// Whether x ≤ limit. Of a symbol nobody knows, and the answer is no.
pub(in crate::model) fn within<S: Scalar>(x: S, limit: S) -> bool {
    S::select((x - limit).positive(), S::zero(), S::one()) == S::one()
}
