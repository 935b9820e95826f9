//! Every lane of every function of every set that this processor has, against scalars.

use super::{Real, Set, source};

/// A module's functions on whole slices, if this processor has them.
macro_rules! suite {
    ($module:ident, $real:ident, $fused:expr, $available:expr, $(#[$attribute:meta])*) => {
        #[allow(unsafe_code, unused_unsafe)]
        mod $module {
            use super::super::$module as set;

            const L: usize = set::LANES;

            fn available() -> bool {
                let available = $available;
                if !available {
                    println!("{} is not tried: this processor does not have it", stringify!($module));
                }
                available
            }

            #[test]
            fn lanes_are_scalars() {
                if available() {
                    // SAFETY: the processor has the features, as the line above found.
                    unsafe { arithmetic() }
                }
            }

            #[track_caller]
            fn same(got: set::V, want: [$real; L], of: &str) {
                // SAFETY: called where the features are.
                let got = unsafe { set::array(got) };
                for (got, want) in got.iter().zip(want) {
                    assert!(got.to_bits() == want.to_bits() || (got.is_nan() && want.is_nan()), "{of}: {got:e} is not {want:e}");
                }
            }

            fn fused(a: $real, b: $real, c: $real) -> $real {
                if $fused { a.mul_add(b, c) } else { a * b + c }
            }

            $(#[$attribute])*
            fn arithmetic() {
                use core::array::from_fn;
                let values = super::$real::values();
                let n = values.len();
                for i in 0..n {
                    let [x, y, z]: [[$real; L]; 3] = [from_fn(|j| values[(i + j) % n]), from_fn(|j| values[(i * 7 + 3 * j) % n]), from_fn(|j| values[(i * 5 + j * j) % n])];
                    let (a, b, c) = (set::lanes(x), set::load(&y), set::lanes(z));
                    let mut stored = [0.0; L];
                    set::store(a, &mut stored);
                    same(a, stored, "store");
                    same(a, x, "lanes");
                    same(b, y, "load");
                    same(set::k(f64::from(x[0])), [x[0]; L], "k");
                    same(set::add(a, b), from_fn(|i| x[i] + y[i]), "add");
                    same(set::sub(a, b), from_fn(|i| x[i] - y[i]), "sub");
                    same(set::mul(a, b), from_fn(|i| x[i] * y[i]), "mul");
                    same(set::div(a, b), from_fn(|i| x[i] / y[i]), "div");
                    same(set::neg(a), x.map(|x| -x), "neg");
                    same(set::fmadd(a, b, c), from_fn(|i| fused(x[i], y[i], z[i])), "fmadd");
                    same(set::fmsub(a, b, c), from_fn(|i| fused(x[i], y[i], -z[i])), "fmsub");
                    same(set::fnmadd(a, b, c), from_fn(|i| fused(-x[i], y[i], z[i])), "fnmadd");
                    same(set::fnmsub(a, b, c), from_fn(|i| fused(-x[i], y[i], -z[i])), "fnmsub");
                    same(set::sqrt(a), x.map($real::sqrt), "sqrt");
                    same(set::atan2(a, b), from_fn(|i| x[i].atan2(y[i])), "atan2");
                    same(set::select(set::positive(a), b, c), from_fn(|i| if x[i] > 0.0 { y[i] } else { z[i] }), "select");
                    assert_eq!(set::lane::<0>(a).to_bits(), x[0].to_bits());
                    assert_eq!(set::lane::<{ L - 1 }>(a).to_bits(), x[L - 1].to_bits());
                }
            }

            /// Sines and cosines of as many angles as there are; `None` where the processor has not the features.
            pub(super) fn sines(x: &[$real]) -> Option<Vec<[$real; 2]>> {
                // SAFETY: the processor has the features, as is found first.
                available().then(|| unsafe { blocks(x) })
            }

            $(#[$attribute])*
            fn blocks(x: &[$real]) -> Vec<[$real; 2]> {
                let mut out = Vec::with_capacity(x.len() + L);
                for block in x.chunks(L) {
                    let mut full = [0.0; L];
                    full[..block.len()].copy_from_slice(block);
                    let (sin, cos) = set::sin_cos(set::load(&full));
                    out.extend(set::array(sin).into_iter().zip(set::array(cos)).map(|(s, c)| [s, c]));
                }
                out.truncate(x.len());
                out
            }
        }
    };
}

/// The sum over the lanes.
macro_rules! sum {
    ($module:ident, $available:expr, $(#[$attribute:meta])*) => {{
        #[allow(unsafe_code, unused_unsafe)]
        fn test() {
            use super::$module as set;
            $(#[$attribute])*
            fn sums() {
                let x: [f64; set::LANES] = core::array::from_fn(|i| 0.1 + 1e15 * i as f64);
                let want = x.chunks(2).map(|x| x[0] + x[1]).sum::<f64>();
                assert_eq!(set::array(set::across(set::lanes(x))), [want; set::LANES]);
            }
            if $available {
                // SAFETY: the processor has the features, as the line above found.
                unsafe { sums() }
            }
        }
        test();
    }};
}

mod f64 {
    pub(super) fn values() -> Vec<f64> {
        let mut values = vec![0.0, -0.0, 1.0, -1.0, f64::MIN_POSITIVE, 5e-324, f64::MAX, f64::INFINITY, f64::NEG_INFINITY, f64::NAN];
        values.extend((1..40).flat_map(|i| [0.37 * i as f64, -1.0 / i as f64, (1.7_f64).powi(i)]));
        values
    }
}

/// Whether the portable modules fuse.
const FMA: bool = cfg!(any(target_feature = "fma", target_arch = "aarch64"));

suite!(portable_f64x2, f64, super::FMA, true,);
suite!(portable_f64x4, f64, super::FMA, true,);
suite!(portable_f64x8, f64, super::FMA, true,);
#[cfg(target_arch = "x86_64")]
mod x86 {
    pub(super) fn avx2() -> bool {
        is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma")
    }
    pub(super) fn avx512() -> bool {
        avx2() && is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512dq")
    }
}
#[cfg(target_arch = "x86_64")]
suite!(avx2_f64x2, f64, true, super::x86::avx2(), #[target_feature(enable = "avx2,fma")]);
#[cfg(target_arch = "x86_64")]
suite!(avx2_f64x4, f64, true, super::x86::avx2(), #[target_feature(enable = "avx2,fma")]);
#[cfg(target_arch = "x86_64")]
suite!(avx512_f64x8, f64, true, super::x86::avx512(), #[target_feature(enable = "avx512f,avx512dq,avx2,fma")]);

#[test]
fn sums_over_the_lanes() {
    sum!(portable_f64x2, true,);
    sum!(portable_f64x4, true,);
    #[cfg(target_arch = "x86_64")]
    {
        sum!(avx2_f64x2, x86::avx2(), #[target_feature(enable = "avx2,fma")]);
        sum!(avx2_f64x4, x86::avx2(), #[target_feature(enable = "avx2,fma")]);
    }
}

#[test]
fn portable_sources_have_no_unsafe() {
    for lanes in [2, 4, 8] {
        assert!(!source(Set::Portable, Real::F64, lanes).unwrap().contains("unsafe"));
    }
}

/// The doubles below 10⁵ that lie nearest to a multiple of π/2, found by trying every multiple in 200-bit arithmetic.
const NEAREST: [f64; 6] = [45.553093477052, 91.106186954104, 182.212373908208, 364.424747816416, 728.849495632832, 1457.698991265664];

fn angles() -> Vec<f64> {
    let mut x = 1e-300;
    let mut points: Vec<f64> = NEAREST.to_vec();
    points.extend([0.0, f64::NAN, f64::INFINITY, 1e5, 1e5_f64.next_up()]);
    while x < 1e300 {
        points.push(x);
        x *= 1.0 + 0.37 * ((points.len() % 7) as f64 / 7.0 + 0.01);
    }
    points.extend((1..100_000).map(|k| k as f64 * 0.999_983));
    points.into_iter().flat_map(|x| [x, -x]).collect()
}

fn ulps(a: f64, b: f64) -> u64 {
    if a == b || (a.is_nan() && b.is_nan()) { 0 } else { a.to_bits().abs_diff(b.to_bits()) }
}

#[test]
fn sines_agree_with_the_standard_library_to_an_ulp() {
    let x = angles();
    let mut sets = vec![portable_f64x2::sines(&x), portable_f64x4::sines(&x), portable_f64x8::sines(&x)];
    #[cfg(target_arch = "x86_64")]
    sets.extend([avx2_f64x2::sines(&x), avx2_f64x4::sines(&x), avx512_f64x8::sines(&x)]);
    for (set, sines) in sets.iter().flatten().enumerate() {
        for (x, [s, c]) in x.iter().zip(sines) {
            let (s0, c0) = x.sin_cos();
            assert!(ulps(*s, s0) <= 1 && ulps(*c, c0) <= 1, "{set}, {x:e}: {s:e} {s0:e} {c:e} {c0:e}");
        }
    }
}
