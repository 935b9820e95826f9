//! Source text for arithmetic and sines of several numbers at once, for generated code, one module
//! per instruction set, element and width.
//!
//! A module needs nothing but `std`. It has, all `pub(super)` and all for the processors of its set
//! (see [`Set::features`]):
//!
//! * `type Real`, `LANES`, `type V` of that many numbers, `type M` of as many truths;
//! * `k(x: f64) -> V`, x in every lane; `lanes([Real; LANES]) -> V` and
//!   `array(V) -> [Real; LANES]`; `load(&[Real; LANES]) -> V` and `store(V, &mut [Real; LANES])`;
//!   `lane::<K>(V) -> Real`;
//! * `add`, `sub`, `mul`, `div`, `neg`, `sqrt`; `fmadd` = ab + c, `fmsub` = ab − c, `fnmadd` = c −
//!   ab, `fnmsub` = −ab − c with one rounding, or two where the set has no such instruction;
//! * `positive(x) -> M`, x > 0; `select(m, a, b)`, a where m; `any(m) -> bool`, whether m holds in
//!   a lane; `reduce_add(x)`, the sum of the lanes in every lane (f64 of 2 and 4);
//! * `sin_cos(x) -> (V, V)`, x in rad, any, and `atan2(y, x)`, lane by lane by the standard
//!   library.
//!
//! Sets of 4 f64 also write results into `to: &mut [MaybeUninit<f64>]`, number by number from `at`
//! on: `put_one`, `put_two`, and `put(x, to, at)`. Of four, `put_fours(a, b, c, d, to, [at; 4])`
//! writes a, b, c, d of each lane at a place of its own, `put_twos` two of them, and
//! `put_in_turn(a, b, c, to, at)` those of all lanes one behind the other, as
//! `every_third(&[f64; 12]) -> [V; 3]` reads them. `reduce_add_of_four(a, b, c, d)` has the sums of the
//! lanes of each in its lanes, `reduce_add_of_two(a, b)` those of two, twice.
//!
//! [`tiles`] adds functions that turn consecutive states, `[[Real; N]; LANES]`, into vectors with
//! one state per lane: `TILE` numbers of each at a time, `columns(&states, at) -> [V; TILE]` and
//! `rows([V; TILE], &mut states, at)`, with `at` + `TILE` ≤ N, or 0 where N is less.
//!
//! These are free functions of raw registers since methods and operators that are inlined into
//! functions of other features take the compiler eight times as long.
//!
//! A lane's sine depends on no other lane. Its error is below 1 ulp up to 10⁵ rad for f64 (0.9
//! seen) and 10⁴ rad for f32 (0.97 over all of them), and the standard library's beyond. All sets
//! that fuse agree to the bit, and so do all that do not. sin(−0) is 0, not −0.
//!
//! [`COLUMNS`] is built on these with four f64.
//!
//! The texts: `registers` and `portable`, the vector types and their arithmetic; `common`,
//! functions built on these; `sines`; `results`, four lanes at places of their own; `tiles`;
//! `loops`, the solution for many right-hand sides.

use alloc::format;
use alloc::string::{String, ToString};

#[cfg(test)]
mod tests;

/// An instruction set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Set {
    /// Arrays, and no `unsafe`. Fused multiply-add if that is compiled for.
    Portable,
    /// The set of every x86-64; no fused multiply-add.
    Sse2,
    /// AVX2 and FMA.
    Avx2,
    /// AVX-512F and DQ, AVX2 and FMA.
    Avx512,
    /// The set of every 64-bit Arm.
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
    /// The value of `#[target_feature(enable = "…")]` of the functions; empty for
    /// [`Set::Portable`], whose functions have none.
    pub fn features(self) -> &'static str {
        match self {
            Self::Portable => "",
            // The second is in every x86-64, and only distinguishes these functions from arithmetic
            // in registers.
            Self::Sse2 => "sse2,fxsr",
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

impl Real {
    /// The type's name in Rust.
    pub fn name(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::F64 => "f64",
        }
    }

    /// How many bytes one takes.
    pub fn bytes(self) -> usize {
        match self {
            Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

/// Contents of a module; `None` if the set has no such width.
pub fn source(set: Set, real: Real, lanes: usize) -> Option<String> {
    let module = MODULES.iter().find(|module| (module.0, module.1, module.2) == (set, real, lanes))?;
    Some(format!("{TRAITS}{}", module.3).replace(HALF, &format!("{HALF}{TRAITS}")))
}

/// Parts of the prelude that the texts need, for crates without it.
const TRAITS: &str = "#[allow(unused_imports)]\nuse ::core::{convert::From, iter::Iterator};\n\n";

/// Where a module in a module begins.
const HALF: &str = "\nmod half {\n";

/// The addition to such a module for consecutive states; `None` if the set has no such width, or
/// batches do not use it.
pub fn tiles(set: Set, real: Real, lanes: usize) -> Option<String> {
    let module = MODULES.iter().find(|module| (module.0, module.1, module.2) == (set, real, lanes))?;
    (!module.4.is_empty()).then(|| module.4.to_string())
}

/// M X = B for all columns of three `[NV][NV]` matrices B, the third the unit matrix, by M = Lᵀ D
/// L: Featherstone 2008, §6.5.
///
/// The text of a module beside `portable_f64x4`, `avx2_f64x4`, `avx512_f64x8` and `neon_f64x4`.
/// Before it must come
/// * `NV`, and `TOGETHER`, how many matrices are solved for at once (3 or 1) in vectors of four
///   columns and in vectors of eight;
/// * `BEFORE` and `BEYOND`: `[&[(u16, u16)]; NV]`, for each row of L (each column) the column (the
///   row) of each number and its place in `l`.
pub const COLUMNS: &str = include_str!("text/loops/columns.rs");

/// Modules' texts, which tests compile: common files in the order in which macros are needed.
macro_rules! modules {
    (@texts $($file:literal)+ $(, half $($half:literal)+)?) => {
        concat!($(include_str!(concat!("text/", $file, ".rs"))),+ $(, "\nmod half {\n", $(include_str!(concat!("text/", $half, ".rs"))),+, "}\n")?)
    };
    ($($name:ident, $set:ident, $real:ident, $lanes:literal, $arch:meta:
        [$($file:literal)+] $(half [$($half:literal)+])? $(tiles [$($tiles:literal)+])?;)+) => {
        const MODULES: &[(Set, Real, usize, &str, &str)] = &[$((
            Set::$set, Real::$real, $lanes, modules!(@texts $($file)+ $(, half $($half)+)?), concat!($($(include_str!(concat!("text/", $tiles, ".rs"))),+)?),
        )),+];
        $(
            #[cfg(all(test, $arch))]
            #[allow(dead_code, non_upper_case_globals, unreachable_pub, unsafe_code, unused_imports, clippy::all, clippy::pedantic)]
            mod $name {
                $(include!(concat!("text/", $file, ".rs"));)+
                $($(include!(concat!("text/", $tiles, ".rs"));)+)?
                $(mod half {
                    $(include!(concat!("text/", $half, ".rs"));)+
                })?
            }
        )+
    };
}

modules! {
    portable_f64x2, Portable, F64, 2, all():
        ["portable/f64" "portable/2" "portable/common" "common" "sines/f64" "sines/f64_fused" "sines/f64_split"];
    portable_f64x4, Portable, F64, 4, all():
        ["portable/f64" "portable/4" "portable/common" "common" "results/put" "results/rows" "sines/f64" "sines/f64_fused" "sines/f64_split"];
    portable_f64x8, Portable, F64, 8, all():
        ["portable/f64" "portable/8" "portable/common" "common" "sines/f64" "sines/f64_fused" "sines/f64_split"]
        tiles ["tiles/portable"];
    portable_f32x8, Portable, F32, 8, all():
        ["portable/f32" "portable/8" "portable/common" "portable/f32_reduce" "common" "sines/f32" "sines/f32_fused" "sines/f32_split"];
    portable_f32x16, Portable, F32, 16, all():
        ["portable/f32" "portable/16" "portable/common" "portable/f32_reduce" "common" "sines/f32" "sines/f32_fused" "sines/f32_split"]
        tiles ["tiles/portable"];
    sse2_f64x2, Sse2, F64, 2, target_arch = "x86_64":
        ["registers/sse2_f64x2" "registers/in_registers" "registers/sse2" "registers/common" "common" "sines/f64" "sines/f64_split"]
        tiles ["tiles/common" "tiles/16_bytes" "tiles/register" "tiles/f64" "tiles/sse2_f64"];
    sse2_f64x4, Sse2, F64, 4, target_arch = "x86_64":
        ["registers/pair_sse2" "registers/pair" "results/put" "results/rows"]
        half ["registers/sse2_f64x2" "registers/in_registers" "registers/sse2" "registers/common" "common" "sines/f64" "sines/f64_split"];
    sse2_f32x4, Sse2, F32, 4, target_arch = "x86_64":
        ["registers/sse2_f32x4" "registers/in_registers" "registers/sse2" "registers/common" "common" "sines/f32" "sines/f32_split"]
        tiles ["tiles/common" "tiles/16_bytes" "tiles/register" "tiles/f32" "tiles/sse2_f32"];
    avx2_f64x2, Avx2, F64, 2, target_arch = "x86_64":
        ["registers/avx2_f64x2" "registers/in_registers" "registers/in_registers_fused" "registers/avx2" "registers/common" "common" "sines/f64" "sines/f64_fused"];
    avx2_f64x4, Avx2, F64, 4, target_arch = "x86_64":
        ["registers/avx2_f64x4" "registers/in_registers" "registers/in_registers_fused" "registers/avx2" "registers/common" "common" "results/put" "results/rows_avx2" "sines/f64" "sines/f64_fused"]
        tiles ["tiles/common" "tiles/32_bytes" "tiles/register" "tiles/f64" "tiles/avx2_f64"];
    avx2_f32x8, Avx2, F32, 8, target_arch = "x86_64":
        ["registers/avx2_f32x8" "registers/in_registers" "registers/in_registers_fused" "registers/avx2" "registers/common" "common" "sines/f32" "sines/f32_fused"]
        tiles ["tiles/common" "tiles/32_bytes" "tiles/register" "tiles/f32" "tiles/avx2_f32"];
    avx512_f64x8, Avx512, F64, 8, target_arch = "x86_64":
        ["registers/avx512_f64x8" "registers/in_registers" "registers/in_registers_fused" "registers/avx512" "registers/common" "common" "sines/f64" "sines/f64_fused"]
        tiles ["tiles/common" "tiles/32_bytes" "tiles/register" "tiles/f64" "tiles/avx2_f64"];
    avx512_f32x16, Avx512, F32, 16, target_arch = "x86_64":
        ["registers/avx512_f32x16" "registers/in_registers" "registers/in_registers_fused" "registers/avx512" "registers/common" "common" "sines/f32" "sines/f32_fused"]
        tiles ["tiles/common" "tiles/32_bytes" "tiles/register" "tiles/f32" "tiles/avx2_f32"];
    neon_f64x2, Neon, F64, 2, target_arch = "aarch64":
        ["registers/neon_f64x2" "registers/neon" "registers/common" "common" "sines/f64" "sines/f64_fused"]
        tiles ["tiles/common" "tiles/16_bytes" "tiles/register" "tiles/f64" "tiles/neon_f64"];
    neon_f64x4, Neon, F64, 4, target_arch = "aarch64":
        ["registers/pair_neon" "registers/pair" "results/put" "results/rows"]
        half ["registers/neon_f64x2" "registers/neon" "registers/common" "common" "sines/f64" "sines/f64_fused"];
    neon_f32x4, Neon, F32, 4, target_arch = "aarch64":
        ["registers/neon_f32x4" "registers/neon" "registers/common" "common" "sines/f32" "sines/f32_fused"]
        tiles ["tiles/common" "tiles/16_bytes" "tiles/register" "tiles/f32" "tiles/neon_f32"];
}
