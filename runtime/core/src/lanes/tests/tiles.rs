//! Conversion of consecutive states to vectors with one state per lane, and back.

use super::{Set, available};

/// Tiles of states of `N` numbers, at every place.
macro_rules! tiles {
    ($module:ident, $real:ident, $set:ident $(, #[$attribute:meta])?) => {
        #[allow(unsafe_code, unused_unsafe)]
        mod $module {
            use super::super::super::$module as set;
            use core::array::from_fn;

            $(#[$attribute])?
            fn of<const N: usize>() {
                // Number k of state s.
                let number = |s: usize, k: usize| (1 + s * N + k) as $real;
                let states: [[$real; N]; set::STATES] = from_fn(|s| from_fn(|k| number(s, k)));
                for at in 0..=N.saturating_sub(set::TILE) {
                    let columns = set::columns(&states, at);
                    for (k, column) in columns.iter().enumerate().take(N) {
                        assert_eq!(*column, from_fn(|s| number(s, at + k)), "numbers {at} and on of {N}");
                    }
                    let mut back = [[0.0; N]; set::STATES];
                    set::rows(&columns, &mut back, at);
                    assert_eq!(back, from_fn(|s| from_fn(|k| if (at..at + set::TILE).contains(&k) { number(s, k) } else { 0.0 })));
                }
                if set::WIDE == set::TILE || N < set::WIDE {
                    return;
                }
                for at in 0..=N - set::WIDE {
                    let columns = set::wide_columns(&states, at);
                    for (k, column) in columns.iter().enumerate() {
                        assert_eq!(*column, from_fn(|s| number(s, at + k)), "wide, numbers {at} and on of {N}");
                    }
                    let mut back = [[0.0; N]; set::STATES];
                    set::wide_rows(&columns, &mut back, at);
                    assert_eq!(back, from_fn(|s| from_fn(|k| if (at..at + set::WIDE).contains(&k) { number(s, k) } else { 0.0 })));
                }
            }

            $(#[$attribute])?
            fn all() {
                of::<1>();
                of::<2>();
                of::<3>();
                of::<4>();
                of::<5>();
                of::<7>();
                of::<8>();
                of::<9>();
                of::<15>();
                of::<16>();
                of::<36>();
            }

            #[test]
            fn a_state_is_a_lane_and_comes_back() {
                if super::available(super::Set::$set) {
                    // SAFETY: the processor has the features, as the line above found.
                    unsafe { all() }
                }
            }
        }
    };
}

tiles!(portable_f64x8, f64, Portable);
tiles!(portable_f32x16, f32, Portable);

#[cfg(target_arch = "x86_64")]
tiles!(sse2_f64x2, f64, Sse2, #[target_feature(enable = "sse2,fxsr")]);
#[cfg(target_arch = "x86_64")]
tiles!(sse2_f32x4, f32, Sse2, #[target_feature(enable = "sse2,fxsr")]);
#[cfg(target_arch = "x86_64")]
tiles!(avx2_f64x4, f64, Avx2, #[target_feature(enable = "avx2,fma")]);
#[cfg(target_arch = "x86_64")]
tiles!(avx2_f32x8, f32, Avx2, #[target_feature(enable = "avx2,fma")]);
#[cfg(target_arch = "x86_64")]
tiles!(avx512_f64x8, f64, Avx512, #[target_feature(enable = "avx512f,avx512dq,avx2,fma")]);
#[cfg(target_arch = "x86_64")]
tiles!(avx512_f32x16, f32, Avx512, #[target_feature(enable = "avx512f,avx512dq,avx2,fma")]);
#[cfg(target_arch = "aarch64")]
tiles!(neon_f64x2, f64, Neon, #[target_feature(enable = "neon")]);
#[cfg(target_arch = "aarch64")]
tiles!(neon_f32x4, f32, Neon, #[target_feature(enable = "neon")]);
