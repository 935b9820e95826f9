//! The sines and cosines that generated code takes, against 96 digits.

use articulated_core::Scalar;
use articulated_reference::Big;
use articulated_test_support::random::Random;

/// Modules of lanes, as generated code has them.
macro_rules! lanes {
    ($name:ident: $($file:literal)+) => {
        #[allow(dead_code, non_upper_case_globals, unreachable_pub, unsafe_code, unused_imports, unused_macros, clippy::all, clippy::pedantic)]
        mod $name {
            $(include!(concat!("../../src/lanes/text/", $file, ".rs"));)+
        }
    };
}

lanes!(portable: "portable/f64" "portable/4" "portable/common" "common" "sines/f64" "sines/f64_fused" "sines/f64_split");
#[cfg(target_arch = "x86_64")]
lanes!(avx2: "registers/avx2_f64x4" "registers/in_registers" "registers/in_registers_fused" "registers/avx2" "registers/common" "common" "sines/f64" "sines/f64_fused");

/// Sines and cosines by each way that this processor has. Other instruction sets agree with one of
/// these to the bit.
fn ways(x: [f64; 4]) -> Vec<[[f64; 4]; 2]> {
    let (sin, cos) = portable::sin_cos(x);
    #[allow(unused_mut)]
    let mut ways = vec![[sin, cos]];
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
        #[target_feature(enable = "avx2,fma")]
        fn fused(x: [f64; 4]) -> [[f64; 4]; 2] {
            let (sin, cos) = avx2::sin_cos(avx2::lanes(x));
            [avx2::array(sin), avx2::array(cos)]
        }
        // SAFETY: the processor was just asked for both.
        #[allow(unsafe_code)]
        ways.push(unsafe { fused(x) });
    }
    ways
}

/// The spacing of doubles at |x|.
fn ulp(x: f64) -> f64 {
    let x = x.abs().max(f64::MIN_POSITIVE);
    f64::from_bits(x.to_bits() + 1) - x
}

/// The larger error of sin x and cos x, in ulps.
fn error(x: f64, sin: f64, cos: f64) -> f64 {
    Big::scope(|| {
        let (s, c) = Big::from_f64(x).sin_cos();
        s.error_of(sin, ulp(sin)).max(c.error_of(cos, ulp(cos)))
    })
}

fn worst(points: &[f64]) -> (f64, f64) {
    let mut worst = (0.0, 0.0);
    for x in points.chunks(4) {
        let at = |k: usize| x.get(k).copied().unwrap_or(0.0);
        for [sin, cos] in ways([at(0), at(1), at(2), at(3)]) {
            for (k, &x) in x.iter().enumerate() {
                let e = error(x, sin[k], cos[k]);
                if e > worst.0 {
                    worst = (e, x);
                }
            }
        }
    }
    worst
}

#[test]
fn a_sine_is_off_by_at_most_an_ulp_anywhere() {
    let mut random = Random::new(7);
    let mut points = Vec::new();
    for size in [1e-300, 1e-9, 0.1, 0.8, 3.2, 100.0, 1e5, 1e9, 1e22] {
        points.extend((0..1500).map(|_| random.within(-size, size)));
    }
    let (error, x) = worst(&points);
    assert!(error <= 1.0, "{error} ulp at {x:e}");
}

#[test]
fn a_sine_next_to_a_multiple_of_half_pi_is_no_worse() {
    // The doubles below 10⁵ that lie nearest to a multiple of π/2, found by trying every multiple
    // in 200-bit arithmetic.
    let hardest = [45.553093477052, 91.106186954104, 182.212373908208, 364.424747816416, 728.849495632832, 1457.698991265664];
    // And the doubles around every 37th multiple.
    let near = (1..1700).map(|k| f64::from(37 * k) * std::f64::consts::FRAC_PI_2);
    let points: Vec<f64> =
        near.flat_map(|x| [x, x.next_up(), x.next_down()]).chain(hardest).flat_map(|x| [x, -x]).filter(|x| x.abs() < 1e5).collect();
    let (error, x) = worst(&points);
    assert!(error <= 1.0, "{error} ulp at {x:e}");
}
