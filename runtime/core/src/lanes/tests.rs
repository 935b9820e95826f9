//! Every lane of every function of every set that this processor has, against scalars.

mod columns;
mod rows;
mod sines;
mod source;
mod tiles;

use super::Set;

/// A module's functions on whole slices, if this processor has them.
macro_rules! suite {
    ($module:ident, $real:ident, $fused:expr, $set:ident $(, #[$attribute:meta])?) => {
        #[allow(unsafe_code, unused_unsafe)]
        mod $module {
            use super::super::$module as set;

            const L: usize = set::LANES;

            fn available() -> bool {
                let available = super::available(super::Set::$set);
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

            $(#[$attribute])?
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

            /// Sines and cosines of as many angles as there are; `None` where the processor has not
            /// the features.
            pub(super) fn sines(x: &[$real]) -> Option<Vec<[$real; 2]>> {
                // SAFETY: the processor has the features, as is found first.
                available().then(|| unsafe { blocks(x) })
            }

            $(#[$attribute])?
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

/// Whether this processor has the set.
fn available(set: Set) -> bool {
    match set {
        Set::Portable => true,
        #[cfg(target_arch = "x86_64")]
        Set::Sse2 => is_x86_feature_detected!("sse2"),
        #[cfg(target_arch = "x86_64")]
        Set::Avx2 => is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma"),
        #[cfg(target_arch = "x86_64")]
        Set::Avx512 => available(Set::Avx2) && is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512dq"),
        #[cfg(target_arch = "aarch64")]
        Set::Neon => true,
        _ => false,
    }
}

/// The sum over the lanes of a module of 2 or 4 f64.
macro_rules! sum {
    ($module:ident, $set:ident $(, #[$attribute:meta])?) => {
        #[allow(unsafe_code, unused_unsafe)]
        {
            use super::$module as set;
            $(#[$attribute])?
            fn sums() {
                let x: [f64; set::LANES] = core::array::from_fn(|i| 0.1 + 1e15 * i as f64);
                let want = x.chunks(2).map(|x| x[0] + x[1]).sum::<f64>();
                assert_eq!(set::array(set::reduce_add(set::lanes(x))), [want; set::LANES]);
            }
            if available(Set::$set) {
                // SAFETY: the processor has the features, as the line above found.
                unsafe { sums() }
            }
        }
    };
}

mod f64 {
    pub(super) fn values() -> Vec<f64> {
        let mut values = vec![0.0, -0.0, 1.0, -1.0, f64::MIN_POSITIVE, 5e-324, f64::MAX, f64::INFINITY, f64::NEG_INFINITY, f64::NAN];
        values.extend((1..40).flat_map(|i| [0.37 * i as f64, -1.0 / i as f64, (1.7_f64).powi(i)]));
        values
    }
}

mod f32 {
    pub(super) fn values() -> Vec<f32> {
        let mut values = vec![f32::MIN_POSITIVE, 1e-45, f32::MAX];
        values.extend(super::f64::values().into_iter().map(|x| x as f32));
        values
    }
}

/// Whether the portable modules fuse.
const FMA: bool = cfg!(any(target_feature = "fma", target_arch = "aarch64"));

suite!(portable_f64x2, f64, super::FMA, Portable);
suite!(portable_f64x4, f64, super::FMA, Portable);
suite!(portable_f64x8, f64, super::FMA, Portable);
suite!(portable_f32x8, f32, super::FMA, Portable);
suite!(portable_f32x16, f32, super::FMA, Portable);

#[cfg(target_arch = "x86_64")]
suite!(sse2_f64x2, f64, false, Sse2, #[target_feature(enable = "sse2,fxsr")]);
#[cfg(target_arch = "x86_64")]
suite!(sse2_f64x4, f64, false, Sse2, #[target_feature(enable = "sse2,fxsr")]);
#[cfg(target_arch = "x86_64")]
suite!(sse2_f32x4, f32, false, Sse2, #[target_feature(enable = "sse2,fxsr")]);
#[cfg(target_arch = "x86_64")]
suite!(avx2_f64x2, f64, true, Avx2, #[target_feature(enable = "avx2,fma")]);
#[cfg(target_arch = "x86_64")]
suite!(avx2_f64x4, f64, true, Avx2, #[target_feature(enable = "avx2,fma")]);
#[cfg(target_arch = "x86_64")]
suite!(avx2_f32x8, f32, true, Avx2, #[target_feature(enable = "avx2,fma")]);
#[cfg(target_arch = "x86_64")]
suite!(avx512_f64x8, f64, true, Avx512, #[target_feature(enable = "avx512f,avx512dq,avx2,fma")]);
#[cfg(target_arch = "x86_64")]
suite!(avx512_f32x16, f32, true, Avx512, #[target_feature(enable = "avx512f,avx512dq,avx2,fma")]);
#[cfg(target_arch = "aarch64")]
suite!(neon_f64x2, f64, true, Neon, #[target_feature(enable = "neon")]);
#[cfg(target_arch = "aarch64")]
suite!(neon_f64x4, f64, true, Neon, #[target_feature(enable = "neon")]);
#[cfg(target_arch = "aarch64")]
suite!(neon_f32x4, f32, true, Neon, #[target_feature(enable = "neon")]);

#[test]
fn sums_over_the_lanes() {
    sum!(portable_f64x2, Portable);
    sum!(portable_f64x4, Portable);
    #[cfg(target_arch = "x86_64")]
    {
        sum!(sse2_f64x2, Sse2, #[target_feature(enable = "sse2,fxsr")]);
        sum!(sse2_f64x4, Sse2, #[target_feature(enable = "sse2,fxsr")]);
        sum!(avx2_f64x2, Avx2, #[target_feature(enable = "avx2,fma")]);
        sum!(avx2_f64x4, Avx2, #[target_feature(enable = "avx2,fma")]);
    }
    #[cfg(target_arch = "aarch64")]
    {
        sum!(neon_f64x2, Neon, #[target_feature(enable = "neon")]);
        sum!(neon_f64x4, Neon, #[target_feature(enable = "neon")]);
    }
}
