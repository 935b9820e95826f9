//! Sines of several vectors of lanes at once: in wider registers, if that does not slow down later
//! code.

use std::fmt::Write;

use crate::language::rust::instructions::{COMPILED_FOR_AVX512_BESIDE_AVX2, NOT_COMPILED_FOR_AVX2, OTHERS};
use crate::lir::{Body, Stmt};

/// Whether a body of vectors computes sines of more than one at once.
pub(crate) fn is_used(body: &Body) -> bool {
    body.statements().into_iter().any(|s| matches!(s, Stmt::SinCos { angles, .. } if angles.len() > 1))
}

/// The name of the function for this many vectors.
pub(crate) fn name(vectors: usize) -> &'static str {
    match vectors {
        1 => "sin_cos",
        2 => "sin_cos_of_two",
        _ => "sin_cos_of_four",
    }
}

/// The module for vectors of this many lanes.
pub(crate) fn module(out: &mut String, width: usize) {
    let _ = writeln!(out, "/// Sines and cosines of several vectors of {width}: in wider ones where there are such.");
    *out += "#[allow(unsafe_code, dead_code, unused_imports, unreachable_pub, unused_results, clippy::all, clippy::pedantic)]\n";
    let _ = writeln!(out, "mod several_f64x{width} {{");
    block(out, "#[cfg(target_arch = \"x86_64\")]", "avx2", width, &avx2(width));
    for (cfg, set, features) in [
        (NOT_COMPILED_FOR_AVX2, "sse2", "#[inline]\n#[target_feature(enable = \"sse2,fxsr\")]"),
        ("#[cfg(target_arch = \"aarch64\")]", "neon", "#[inline]\n#[target_feature(enable = \"neon\")]"),
        (OTHERS, "portable", "#[inline(always)]"),
    ] {
        block(out, cfg, set, width, &one_by_one(width, features));
    }
    *out += "}\n\n";
}

fn block(out: &mut String, cfg: &str, set: &str, width: usize, functions: &str) {
    let _ = writeln!(out, "{cfg}\npub(super) mod {set} {{\nuse super::super::{set}_f64x{width}::{{V, sin_cos}};\n{functions}}}\n");
}

/// Each by itself.
fn one_by_one(width: usize, features: &str) -> String {
    let mut text = function(2, features, APART);
    if width == 2 {
        text += &function(4, features, TWICE);
    }
    text
}

/// Two of four lanes, or four of two, in a register of AVX-512 where this is compiled for AMD's
/// processors with that; two of two lanes in one of AVX2.
fn avx2(width: usize) -> String {
    let features = "#[inline]\n#[target_feature(enable = \"avx2,fma\")]";
    let not_avx512 = format!("#[cfg(not({COMPILED_FOR_AVX512_BESIDE_AVX2}))]\n{features}");
    let avx512 = format!("#[cfg({COMPILED_FOR_AVX512_BESIDE_AVX2})]\n{features}");
    let mut text = String::from("use ::core::arch::x86_64::*;\n");
    if width == 2 {
        text += &function(2, features, TWO_OF_TWO);
        text += &function(4, &not_avx512, TWICE);
        text += &function(4, &avx512, FOUR_OF_TWO);
    } else {
        text += &function(2, &not_avx512, APART);
        text += &function(2, &avx512, TWO_OF_FOUR);
    }
    text
}

/// The function for this many vectors.
fn function(vectors: usize, attributes: &str, body: &str) -> String {
    let takes: Vec<String> = ["a", "b", "c", "d"][..vectors].iter().map(|x| format!("{x}: V")).collect();
    let (name, takes) = (name(vectors), takes.join(", "));
    let body: String = body.lines().map(|line| format!("    {line}\n")).collect();
    format!("\n{attributes}\npub(in super::super) fn {name}({takes}) -> [[V; {vectors}]; 2] {{\n{body}}}\n")
}

const APART: &str = "\
let ((s, c), (t, d)) = (sin_cos(a), sin_cos(b));
[[s, t], [c, d]]";

const TWICE: &str = "\
let ([[s, t], [x, y]], [[u, v], [z, w]]) = (sin_cos_of_two(a, b), sin_cos_of_two(c, d));
[[s, t, u, v], [x, y, z, w]]";

const TWO_OF_TWO: &str = "\
let (sin, cos) = super::super::avx2_f64x4::sin_cos(_mm256_set_m128d(b, a));
[
    [_mm256_castpd256_pd128(sin), _mm256_extractf128_pd::<1>(sin)],
    [_mm256_castpd256_pd128(cos), _mm256_extractf128_pd::<1>(cos)],
]";

const FOUR_OF_TWO: &str = "\
#[inline]
#[target_feature(enable = \"avx512f,avx512dq,avx2,fma\")]
fn parts(x: __m512d) -> [V; 4] {
    [_mm512_castpd512_pd128(x), _mm512_extractf64x2_pd::<1>(x), _mm512_extractf64x2_pd::<2>(x), _mm512_extractf64x2_pd::<3>(x)]
}
#[inline]
#[target_feature(enable = \"avx512f,avx512dq,avx2,fma\")]
fn wide(a: V, b: V, c: V, d: V) -> [[V; 4]; 2] {
    let (low, high) = (_mm256_set_m128d(b, a), _mm256_set_m128d(d, c));
    let (sin, cos) = super::super::avx512_f64x8::sin_cos(_mm512_insertf64x4::<1>(_mm512_castpd256_pd512(low), high));
    [parts(sin), parts(cos)]
}
// SAFETY: this is compiled for processors with AVX-512.
unsafe { wide(a, b, c, d) }";

const TWO_OF_FOUR: &str = "\
#[inline]
#[target_feature(enable = \"avx512f,avx512dq,avx2,fma\")]
fn parts(x: __m512d) -> [V; 2] {
    [_mm512_castpd512_pd256(x), _mm512_extractf64x4_pd::<1>(x)]
}
#[inline]
#[target_feature(enable = \"avx512f,avx512dq,avx2,fma\")]
fn wide(a: V, b: V) -> [[V; 2]; 2] {
    let (sin, cos) = super::super::avx512_f64x8::sin_cos(_mm512_insertf64x4::<1>(_mm512_castpd256_pd512(a), b));
    [parts(sin), parts(cos)]
}
// SAFETY: this is compiled for processors with AVX-512.
unsafe { wide(a, b) }";
