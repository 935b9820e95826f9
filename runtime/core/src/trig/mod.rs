//! Sines and cosines of four angles at once, and the source of the same for generated code.
//!
//! On x86-64 with AVX2 and FMA the vector instructions are written out (`vector.rs`), which takes two lines of `unsafe`; the same polynomials
//! without them are in `portable.rs`, for generated code that must do without.

#[allow(dead_code, unreachable_pub, unsafe_code, clippy::all, clippy::pedantic)]
mod vector {
    include!("lanes.rs");
    include!("vector.rs");
}

#[cfg(test)]
#[allow(dead_code, unreachable_pub, clippy::all, clippy::pedantic)]
mod portable {
    include!("lanes.rs");
    include!("portable.rs");
}

pub use vector::four;

/// The source of [`four`]: the contents of a module that needs nothing but `std`. sin(−0) is 0, not −0.
pub const SOURCE: &str = concat!(include_str!("lanes.rs"), include_str!("vector.rs"));

/// The same without `unsafe`.
pub const PORTABLE_SOURCE: &str = concat!(include_str!("lanes.rs"), include_str!("portable.rs"));

#[cfg(test)]
mod tests {
    use super::{four, portable};

    fn both(x: f64) -> (f64, f64) {
        let by = [four(x, 0.0, 1.0, 2.0), portable::four(x, 0.0, 1.0, 2.0)];
        for [s, c] in by {
            assert_eq!((s[1], c[1]), (0.0, 1.0));
            assert_eq!((s[0].to_bits(), c[0].to_bits()), (by[0][0][0].to_bits(), by[0][1][0].to_bits()), "{x:e}");
        }
        (by[0][0][0], by[0][1][0])
    }

    fn ulps(a: f64, b: f64) -> u64 {
        a.to_bits().abs_diff(b.to_bits())
    }

    /// The doubles below 10⁵ that lie nearest to a multiple of π/2, found by trying every multiple in 200-bit arithmetic.
    const NEAREST: [f64; 6] = [45.553093477052, 91.106186954104, 182.212373908208, 364.424747816416, 728.849495632832, 1457.698991265664];

    #[test]
    fn agrees_with_the_standard_library_to_an_ulp() {
        let mut x = 1e-300;
        let mut points: Vec<f64> = NEAREST.to_vec();
        while x < 1e300 {
            points.push(x);
            x *= 1.0 + 0.37 * ((points.len() % 7) as f64 / 7.0 + 0.01);
        }
        points.extend((1..100_000).map(|k| k as f64 * 0.999_983));
        for x in points.into_iter().flat_map(|x| [x, -x]) {
            let ((s, c), (s0, c0)) = (both(x), x.sin_cos());
            assert!(ulps(s, s0) <= 1 && ulps(c, c0) <= 1, "{x:e}: {s:e} {s0:e} {c:e} {c0:e}");
        }
    }

    #[test]
    fn what_has_no_sine_gives_nan() {
        for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let [s, c] = four(x, 0.5, 1.0, 2.0);
            assert!(s[0].is_nan() && c[0].is_nan());
            assert_eq!(s[1], 0.5_f64.sin());
        }
    }
}
