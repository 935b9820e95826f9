//! Instruction sets in generated code: the modules of lanes that it needs, and its detection of the
//! processor.

use std::fmt::Write;

use articulated_core::lanes::{Real, Set, source};
use articulated_core::precision::with_sines;

use crate::Precision;
use crate::language::rust::columns::Layout;
use crate::language::rust::function::precision;
use crate::language::rust::instructions::{
    COMPILED_FOR_AVX512, COMPILED_FOR_AVX512_BESIDE_AVX2, MAY_LACK_AVX2, NOT_COMPILED_FOR_AVX2, OTHERS, has_batch, needs_choice,
};
use crate::language::rust::module::bare;
use crate::language::rust::requirements::Requirements;
use crate::language::rust::several;
use crate::language::rust::tree_shake::tree_shake;
use crate::lir::function::Function;

/// Support that the functions call: multiply-adds, sines, lanes.
pub(crate) fn support(out: &mut String, functions: &[Function], (forbid_unsafe, no_std): (bool, bool), level: Precision) {
    let mut calls = Requirements::default();
    functions.iter().for_each(|f| {
        calls.add_body(&f.body);
        f.few_registers.iter().for_each(|body| calls.add_body(body));
    });
    let before = out.len();
    let plain = || functions.iter().filter(|f| !f.in_lanes());
    if plain().any(|f| needs_choice(f, level)) {
        *out += if level.fused { FUSED } else { NOT_FUSED };
        *out += &FMA.replace("f64", precision::computed(level));
    }
    let any = plain().any(|f| has_batch(&f.body));
    let sines = any && precision::has_vectors(level);
    let portable = forbid_unsafe || !level.fused;
    if any {
        precision::sines(out, if portable { PORTABLE_SINES } else { SINES }, level, no_std);
    }
    precision::module(out, level, no_std);
    let mut when = When { portable: OTHERS, eight: COMPILED_FOR_AVX512_BESIDE_AVX2 };
    let mut widths: Vec<usize> = functions.iter().map(|f| f.body.ty.lanes()).filter(|w| *w > 1).collect();
    // Several vectors at once, in vectors of the widest registers.
    for width in [2, 4] {
        if functions.iter().any(|f| f.body.ty.lanes() == width && several::is_used(&f.body)) {
            several::module(out, width);
            widths.extend([4, 8]);
        }
    }
    if let Some(columns) = functions.iter().find_map(|f| f.columns) {
        Layout::of(columns).module(out);
        when = When { portable: MAY_LACK_AVX2, eight: COMPILED_FOR_AVX512 };
        widths.push(4);
        widths.push(8);
    }
    if sines {
        widths.push(4);
        when.portable = if portable { "" } else { MAY_LACK_AVX2 };
    }
    widths.sort_unstable();
    widths.dedup();
    if !widths.is_empty() {
        // Helpers call others.
        calls.add_helper(&out[before..]);
        lanes(out, &widths, &when, (portable, no_std), level, &calls);
    }
}

/// When modules are compiled: that without instructions of its own, as an attribute, and that of
/// eight lanes, as a condition.
struct When {
    portable: &'static str,
    eight: &'static str,
}

/// The modules of lanes in these widths, with the functions that `out` calls.
fn lanes(out: &mut String, widths: &[usize], when: &When, (forbid_unsafe, no_std): (bool, bool), level: Precision, calls: &Requirements) {
    let sets: &[(Set, &str, &str)] = if forbid_unsafe { &SETS[..1] } else { &SETS };
    let lint = if forbid_unsafe { "" } else { "unsafe_code, " };
    for width in widths {
        for (set, name, cfg) in sets {
            // Eight are for AVX-512 alone, and that for eight.
            let text = source(*set, Real::F64, *width).filter(|_| (*set == Set::Avx512) == (*width == 8));
            let Some(text) = text.map(|text| with_sines(&text, level)) else { continue };
            let text = bare::import(no_std).to_owned() + &tree_shake(&text, calls);
            let _ = writeln!(out, "/// Arithmetic and sines of {width} numbers at once.");
            let cfg = match set {
                Set::Portable => when.portable.to_owned(),
                Set::Avx512 => format!("#[cfg({})]", when.eight),
                _ => (*cfg).to_owned(),
            };
            let line = if cfg.is_empty() { "" } else { "\n" };
            let _ = writeln!(
                out,
                "{cfg}{line}#[allow({lint}dead_code, unused_imports, unused_macros, unreachable_pub, trivial_numeric_casts, unused_results, clippy::all, clippy::pedantic)]"
            );
            let _ = writeln!(out, "mod {name}_f64x{width} {{\n{text}}}\n");
        }
    }
}

/// The instruction sets of limbs and sines, with the attribute of each module; [`When`] has it for
/// those without one here.
const SETS: [(Set, &str, &str); 5] = [
    (Set::Portable, "portable", ""),
    (Set::Sse2, "sse2", NOT_COMPILED_FOR_AVX2),
    (Set::Avx2, "avx2", "#[cfg(target_arch = \"x86_64\")]"),
    (Set::Avx512, "avx512", ""),
    (Set::Neon, "neon", "#[cfg(target_arch = \"aarch64\")]"),
];

const FUSED: &str = "\
/// Whether this is compiled for a processor on which a·b + c is one instruction.
const FUSED: bool = ::core::cfg!(any(all(target_arch = \"x86_64\", target_feature = \"avx2\", target_feature = \"fma\"), target_arch = \"aarch64\"));

";

const NOT_FUSED: &str = "\
/// At this level a·b + c is never one instruction.
const FUSED: bool = false;

";

/// A trait, so that compilers resolve `F::fma` late: if they resolve it early, they inline each
/// call before they optimise, and take longer.
const FMA: &str = "\
/// How a·b + c is computed.
#[allow(dead_code)]
trait Fma {
    const FUSED: bool;

    fn fma(a: f64, b: f64, c: f64) -> f64;
}

/// In one instruction, and with one rounding, or in two.
struct MultiplyAdd<const FUSED: bool>;

#[allow(unused_results, clippy::all, clippy::pedantic)]
impl<const FUSED: bool> Fma for MultiplyAdd<FUSED> {
    const FUSED: bool = FUSED;

    #[inline(always)]
    fn fma(a: f64, b: f64, c: f64) -> f64 {
        if FUSED { a.mul_add(b, c) } else { a * b + c }
    }
}

/// The default.
#[allow(dead_code)]
type F = MultiplyAdd<FUSED>;

";

const SINES: &str = "\
#[allow(unsafe_code, unused_results, clippy::all, clippy::pedantic)]
mod trig {
    /// [sin x, cos x] of four angles, rad. Error at most 1 ulp.
    #[cfg(target_arch = \"x86_64\")]
    #[inline(always)]
    pub(super) fn four<F: super::Fma>(a: f64, b: f64, c: f64, d: f64) -> [[f64; 4]; 2] {
        #[cfg(not(all(target_feature = \"avx2\", target_feature = \"fma\")))]
        if !F::FUSED {
            let (sin, cos) = super::portable_f64x4::sin_cos([a, b, c, d]);
            return [sin, cos];
        }
        use super::avx2_f64x4::{array, lanes, sin_cos};
        #[inline]
        #[target_feature(enable = \"avx2,fma\")]
        fn four(angles: [f64; 4]) -> [[f64; 4]; 2] {
            let (sin, cos) = sin_cos(lanes(angles));
            [array(sin), array(cos)]
        }
        // SAFETY: what is fused runs on processors with AVX2 and FMA alone.
        unsafe { four([a, b, c, d]) }
    }

    /// [sin x, cos x] of four angles, rad. Error at most 1 ulp.
    #[cfg(not(target_arch = \"x86_64\"))]
    #[inline(always)]
    pub(super) fn four<F: super::Fma>(a: f64, b: f64, c: f64, d: f64) -> [[f64; 4]; 2] {
        let (sin, cos) = super::portable_f64x4::sin_cos([a, b, c, d]);
        [sin, cos]
    }
}

";

const PORTABLE_SINES: &str = "\
#[allow(unused_results, clippy::all, clippy::pedantic)]
mod trig {
    /// [sin x, cos x] of four angles, rad. Error at most 1 ulp.
    #[inline(always)]
    pub(super) fn four<F: super::Fma>(a: f64, b: f64, c: f64, d: f64) -> [[f64; 4]; 2] {
        let (sin, cos) = super::portable_f64x4::sin_cos([a, b, c, d]);
        [sin, cos]
    }
}

";
