//! References for results: [`Big`], a scalar of 96 digits, and robots in it, [`Exact`];
//! [`Magnitude`], a scalar that has the scale of rounding errors, and these [`scales`].
//!
//! A separate crate, since every algorithm is compiled once more for each of these scalars: users
//! of [`Exact`] and [`scales`] do not compile them again.

mod big;
mod exact;
mod magnitude;
mod random;
#[cfg(test)]
mod samples;

pub use big::{BITS, Big};
pub use exact::Exact;
pub use magnitude::{Magnitude, ROUNDOFF, is_plain, norms, scales, scales_of_generated, where_suspect};
pub use random::SplitMix64;
