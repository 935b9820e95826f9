//! Arithmetic and sines of several numbers at once: the source of it, for generated code, one module an instruction set, element and width.
//!
//! A module needs nothing but `std`. It has, all `pub(super)` and all for the processors of its set (see [`Set::features`]):
//!
//! * `type Real`, `LANES`, `type V` of that many numbers, `type M` of as many truths;
//! * `k(x: f64) -> V`, x in every lane; `lanes([Real; LANES]) -> V` and `array(V) -> [Real; LANES]`; `load(&[Real; LANES]) -> V` and
//!   `store(V, &mut [Real; LANES])`; `lane::<K>(V) -> Real`;
//! * `add`, `sub`, `mul`, `div`, `neg`, `sqrt`; `fmadd` = ab + c, `fmsub` = ab − c, `fnmadd` = c − ab, `fnmsub` = −ab − c with one rounding, or
//!   two where the set has no such instruction;
//! * `positive(x) -> M`, x > 0; `select(m, a, b)`, a where m; `across(x)`, the sum of the lanes in every lane (f64 of 2 and 4);
//! * `sin_cos(x) -> (V, V)`, x in rad, any, and `atan2(y, x)`, lane by lane by the standard library.
//!
//! These are free functions of raw registers since methods and operators that are inlined into functions of other features take the compiler
//! eight times as long.
//!
//! A lane's sine depends on no other lane. Its error is at most 1 ulp.

use alloc::string::{String, ToString};

#[cfg(test)]
mod tests;

/// An instruction set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Set {
    /// Arrays, and no `unsafe`. Fused multiply-add if that is compiled for.
    Portable,
    /// What every x86-64 has; no fused multiply-add.
    Sse2,
    /// AVX2 and FMA.
    Avx2,
    /// AVX-512F and DQ, AVX2 and FMA.
    Avx512,
    /// What every 64-bit Arm has.
    Neon,
}

/// The type of a lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Real {
    /// `f32`.
    F32,
    /// `f64`.
    F64,
}

impl Set {
    /// What stands in `#[target_feature(enable = "…")]` of the functions; empty for [`Set::Portable`], whose functions do without.
    pub fn features(self) -> &'static str {
        match self {
            Self::Portable => "",
            Self::Sse2 => "sse2",
            Self::Avx2 => "avx2,fma",
            Self::Avx512 => "avx512f,avx512dq,avx2,fma",
            Self::Neon => "neon",
        }
    }

    /// `target_arch` of the set; empty for [`Set::Portable`].
    pub fn arch(self) -> &'static str {
        match self {
            Self::Portable => "",
            Self::Sse2 | Self::Avx2 | Self::Avx512 => "x86_64",
            Self::Neon => "aarch64",
        }
    }
}

/// Contents of a module; `None` if the set has no such width.
pub fn source(set: Set, real: Real, lanes: usize) -> Option<String> {
    let text = match (set, real, lanes) {
        (Set::Portable, Real::F64, 2) => portable_f64x2::TEXT,
        (Set::Portable, Real::F64, 4) => portable_f64x4::TEXT,
        (Set::Portable, Real::F64, 8) => portable_f64x8::TEXT,
        (Set::Avx2, Real::F64, 2) => avx2_f64x2::TEXT,
        (Set::Avx2, Real::F64, 4) => avx2_f64x4::TEXT,
        (Set::Avx512, Real::F64, 8) => avx512_f64x8::TEXT,
        _ => return None,
    };
    Some(text.to_string())
}

/// A module's text, which tests compile.
macro_rules! module {
    ($name:ident, $arch:meta, $($file:literal)+) => {
        #[allow(dead_code, unreachable_pub, unsafe_code, unused_imports, clippy::all, clippy::pedantic)]
        mod $name {
            pub(super) const TEXT: &str = concat!($(include_str!($file)),+);
            $(#[cfg(all(test, $arch))] include!($file);)+
        }
    };
}

module!(portable_f64x2, all(), "portable_f64.rs" "portable_2.rs" "portable.rs" "common.rs" "sin_cos_f64.rs");
module!(portable_f64x4, all(), "portable_f64.rs" "portable_4.rs" "portable.rs" "common.rs" "sin_cos_f64.rs");
module!(portable_f64x8, all(), "portable_f64.rs" "portable_8.rs" "portable.rs" "common.rs" "sin_cos_f64.rs");
module!(avx2_f64x2, target_arch = "x86_64", "avx2_f64x2.rs" "register.rs" "common.rs" "sin_cos_f64.rs");
module!(avx2_f64x4, target_arch = "x86_64", "avx2_f64x4.rs" "register.rs" "common.rs" "sin_cos_f64.rs");
module!(avx512_f64x8, target_arch = "x86_64", "avx512_f64x8.rs" "register.rs" "common.rs" "sin_cos_f64.rs");
