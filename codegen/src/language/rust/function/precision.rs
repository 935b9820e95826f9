//! Levels of accuracy: the types of a function, and the helpers that it calls.

use std::fmt::Write;

use articulated_core::precision::source;

use crate::language::rust::module::bare;
use crate::{Arithmetic, Precision, TrigAccuracy};

/// The type of arguments and results.
pub(crate) fn real(level: Precision) -> &'static str {
    if level.is_single() { "f32" } else { "f64" }
}

/// The type of the numbers that are computed with.
pub(crate) fn computed(level: Precision) -> &'static str {
    if level.arithmetic == Arithmetic::Single { "f32" } else { "f64" }
}

/// Imports of functions that the statements call by name.
pub(crate) fn imports(out: &mut String, level: Precision) {
    if level.of_two() {
        *out += "    #[allow(unused_imports)]\n    use self::level::*;\n";
    }
}

/// Whether sines are those of lanes, four at a time.
pub(crate) fn has_vectors(level: Precision) -> bool {
    !matches!(level.sines, TrigAccuracy::CorrectlyRounded | TrigAccuracy::DoubleDouble)
}

/// The module that has sines of four angles: `text` of doubles to an ulp.
pub(crate) fn sines(out: &mut String, text: &str, level: Precision, no_std: bool) {
    let import = bare::import(no_std);
    let text = &text.replace("mod trig {\n", &format!("mod trig {{\n{import}"));
    let what = match level.sines {
        TrigAccuracy::Fast7 => "|error| ≤ 1e-7",
        TrigAccuracy::Fast10 => "|error| ≤ 1e-10",
        _ => "Error at most 1 ulp",
    };
    let text = text.replace("Error at most 1 ulp", what);
    match (level.arithmetic, level.sines) {
        (_, TrigAccuracy::DoubleDouble) => {}
        (Arithmetic::Compensated, TrigAccuracy::CorrectlyRounded) => {}
        (Arithmetic::Single, TrigAccuracy::CorrectlyRounded) => {
            *out += &CORRECT.replace("NAME", "sin_cos_correct_f32").replace("f64", "f32");
        }
        (_, TrigAccuracy::CorrectlyRounded) => *out += &CORRECT.replace("NAME", "sin_cos_correct"),
        (Arithmetic::Single, _) => {
            *out += &text.replace("mod trig", "mod trig_of_f64");
            *out += SINGLE;
        }
        _ => *out += &text,
    }
}

/// The module of the arithmetic, if it has one.
pub(crate) fn module(out: &mut String, level: Precision, no_std: bool) {
    let import = bare::import(no_std);
    if let Some(text) = source(level) {
        let _ = writeln!(out, "/// The arithmetic of the level {level}.");
        let _ = writeln!(
            out,
            "#[allow(dead_code, unreachable_pub, unused_results, clippy::all, clippy::pedantic)]\nmod level {{\n{import}{text}}}\n"
        );
    }
}

const CORRECT: &str = "\
#[allow(unused_results, clippy::all, clippy::pedantic)]
mod trig {
    /// [sin x, cos x] of four angles, rad: the nearest there are.
    #[inline(always)]
    pub(super) fn four<F: super::Fma>(a: f64, b: f64, c: f64, d: f64) -> [[f64; 4]; 2] {
        use super::level::NAME as one;
        let [(a, e), (b, f), (c, g), (d, h)] = [a, b, c, d].map(|x| if F::FUSED { one::<true>(x) } else { one::<false>(x) });
        [[a, b, c, d], [e, f, g, h]]
    }
}

";

const SINGLE: &str = "\
#[allow(unused_results, clippy::all, clippy::pedantic)]
mod trig {
    /// [sin x, cos x] of four angles, rad, by those of `f64`.
    #[inline(always)]
    pub(super) fn four<F: super::Fma>(a: f32, b: f32, c: f32, d: f32) -> [[f32; 4]; 2] {
        let [[a, b, c, d], [e, f, g, h]] = super::trig_of_f64::four::<F>(a as f64, b as f64, c as f64, d as f64);
        [[a as f32, b as f32, c as f32, d as f32], [e as f32, f as f32, g as f32, h as f32]]
    }
}

";
