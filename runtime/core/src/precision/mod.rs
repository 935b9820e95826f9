//! Precision of generated code, and the source of the arithmetic that it needs.
//!
//! A precision is an arithmetic, an accuracy of sines and cosines, and whether a multiply-add may
//! be one instruction. The graph of a function is the same for every precision; only the
//! computation of each node changes. Options and scenes call it `level`.

use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt;
use core::str::FromStr;

#[cfg(test)]
mod tests;

/// The number type of a function.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Arithmetic {
    /// `f64`.
    #[default]
    Double,
    /// `f32`, in and out too.
    Single,
    /// `f64`, in and out `f32`.
    SingleByDouble,
    /// `f64` with the rounding error of each operation carried along to first order (Lange & Rump
    /// 2020).
    Compensated,
    /// Sums of two `f64` (Joldes, Muller & Popescu 2017), in and out `f64`.
    DoubleDouble,
}

/// Accuracy of sines and cosines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum TrigAccuracy {
    /// Off by at most 1 ulp of `f64`.
    #[default]
    Ulp1,
    /// The double nearest to the true value.
    CorrectlyRounded,
    /// Off by at most 10⁻⁷.
    Fast7,
    /// Off by at most 10⁻¹⁰.
    Fast10,
    /// Sums of two `f64`, off by at most 2⁻¹⁰⁰ of the value.
    DoubleDouble,
}

/// Precision of a module of generated code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Precision {
    /// The numbers.
    pub arithmetic: Arithmetic,
    /// Sines and cosines.
    pub sines: TrigAccuracy,
    /// Whether a·b + c is one instruction, with one rounding, where the processor has it.
    pub fused: bool,
}

impl Default for Precision {
    fn default() -> Self {
        Self { arithmetic: Arithmetic::Double, sines: TrigAccuracy::Ulp1, fused: true }
    }
}

/// The error for a text that names no precision.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PrecisionError {
    /// The wrong word.
    pub found: String,
    /// The accepted words.
    pub expected: &'static str,
}

impl fmt::Display for PrecisionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "level: found `{}`, expected {}", self.found, self.expected)
    }
}

impl core::error::Error for PrecisionError {}

const ARITHMETICS: [(&str, Arithmetic); 5] = [
    ("f64", Arithmetic::Double),
    ("f32", Arithmetic::Single),
    ("f32_f64", Arithmetic::SingleByDouble),
    ("compensated", Arithmetic::Compensated),
    ("double_double", Arithmetic::DoubleDouble),
];

const TRIG_ACCURACIES: [(&str, TrigAccuracy); 5] = [
    ("ulp", TrigAccuracy::Ulp1),
    ("correct", TrigAccuracy::CorrectlyRounded),
    ("fast_7", TrigAccuracy::Fast7),
    ("fast_10", TrigAccuracy::Fast10),
    ("two", TrigAccuracy::DoubleDouble),
];

const EXPECTED: &str = "f64, f32, f32_f64, compensated or double_double, then what differs from the default of +correct, +fast_7, +fast_10, +two, +no_fma, \
                        as in f64+fast_10+no_fma";

impl Precision {
    /// An arithmetic with its default accuracy of sines and with multiply-adds.
    pub fn of(arithmetic: Arithmetic) -> Self {
        let sines = if arithmetic == Arithmetic::DoubleDouble { TrigAccuracy::DoubleDouble } else { TrigAccuracy::Ulp1 };
        Self { arithmetic, sines, fused: true }
    }

    /// The precisions that `articulated accuracy` measures by default.
    pub fn all() -> Vec<Self> {
        let names = "f32 f32+fast_7 f32_f64 f64 f64+no_fma f64+fast_7 f64+fast_10 f64+correct compensated compensated+correct compensated+two \
                     double_double double_double+no_fma";
        names.split_whitespace().filter_map(|name| name.parse().ok()).collect()
    }

    /// Whether values are sums of two doubles.
    pub fn of_two(self) -> bool {
        matches!(self.arithmetic, Arithmetic::Compensated | Arithmetic::DoubleDouble)
    }

    /// Whether arguments and results are `f32`.
    pub fn is_single(self) -> bool {
        matches!(self.arithmetic, Arithmetic::Single | Arithmetic::SingleByDouble)
    }

    /// Whether isomorphic limbs can be computed in lanes.
    pub fn has_lanes(self) -> bool {
        self.arithmetic == Arithmetic::Double
            && self.fused
            && matches!(self.sines, TrigAccuracy::Ulp1 | TrigAccuracy::Fast7 | TrigAccuracy::Fast10)
    }

    fn check(self) -> Result<Self, PrecisionError> {
        let wrong = |expected| Err(PrecisionError { found: self.to_string(), expected });
        match (self.arithmetic, self.sines) {
            (Arithmetic::Double | Arithmetic::Single | Arithmetic::SingleByDouble, TrigAccuracy::DoubleDouble) => {
                wrong("+two with compensated or double_double, whose numbers are sums of two")
            }
            (Arithmetic::DoubleDouble, TrigAccuracy::DoubleDouble) => Ok(self),
            (Arithmetic::DoubleDouble, _) => wrong("double_double with its own sines"),
            _ => Ok(self),
        }
    }

    /// The contract of this precision, in lines: error bound, domain, and results of non-finite
    /// arguments.
    pub fn contract(self) -> Vec<String> {
        let arithmetic = match self.arithmetic {
            Arithmetic::Double => "Numbers: f64; each operation is off by at most 2⁻⁵³ of its result.",
            Arithmetic::Single => {
                "Numbers: f32, in and out too; each operation is off by at most 2⁻²⁴ of its result. What exceeds 3.4e38 is infinite."
            }
            Arithmetic::SingleByDouble => "Numbers: f64, arguments and results f32: results are those of f64 rounded to f32 once.",
            Arithmetic::Compensated => {
                "Numbers: f64 and what each operation lost, to first order: with sines of two doubles results are as of some 2⁻¹⁰⁰, rounded once, for values of 1e-140 to 1e140."
            }
            Arithmetic::DoubleDouble => {
                "Numbers: sums of two f64; each operation is off by at most 2⁻¹⁰² of its result, and results are rounded once, for values of 1e-140 to 1e140."
            }
        };
        let sines = match self.sines {
            TrigAccuracy::Ulp1 => {
                "Sines and cosines: off by at most 1 ulp up to 1e5 rad; beyond, and so at 1e6, 1e15 and 1e22, as the standard library has them."
            }
            TrigAccuracy::CorrectlyRounded => "Sines and cosines: the nearest doubles, of any finite angle, 1e6, 1e15 and 1e22 among them.",
            TrigAccuracy::Fast7 => {
                "Sines and cosines: |error| ≤ 1e-7 up to 1e5 rad; beyond, and so at 1e6, 1e15 and 1e22, as the standard library has them."
            }
            TrigAccuracy::Fast10 => {
                "Sines and cosines: |error| ≤ 1e-10 up to 1e5 rad; beyond, and so at 1e6, 1e15 and 1e22, as the standard library has them."
            }
            TrigAccuracy::DoubleDouble => {
                "Sines and cosines: off by at most 2⁻¹⁰⁰ of the value, of any finite angle, 1e6, 1e15 and 1e22 among them."
            }
        };
        let mut lines = Vec::from([arithmetic.to_string(), sines.to_string()]);
        if self.arithmetic == Arithmetic::Single && self.sines != TrigAccuracy::CorrectlyRounded {
            lines.push("They are computed in f64 and rounded.".into());
        }
        if !self.fused {
            lines.push(
                "No fused multiply-add: the same bits on every processor where angles stay within 1e5 rad and nothing is an arctangent."
                    .into(),
            );
        }
        lines.push("NaN and ∞ in an argument that a result depends on give NaN or ∞ there, and never a panic.".into());
        lines.push(
            "The constants are those of the model in f64: each is off by some 2⁻⁵³ of what the decimals of the robot's file say, at every level.".into(),
        );
        lines
    }
}

impl fmt::Display for Precision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = ARITHMETICS.iter().find(|(_, a)| *a == self.arithmetic).map_or("", |(name, _)| name);
        f.write_str(name)?;
        if self.sines != Self::of(self.arithmetic).sines {
            write!(f, "+{}", TRIG_ACCURACIES.iter().find(|(_, s)| *s == self.sines).map_or("", |(name, _)| name))?;
        }
        if self.fused { Ok(()) } else { f.write_str("+no_fma") }
    }
}

impl FromStr for Precision {
    type Err = PrecisionError;

    fn from_str(text: &str) -> Result<Self, PrecisionError> {
        let wrong = |found: &str| PrecisionError { found: found.trim().to_string(), expected: EXPECTED };
        let mut words = text.split('+').map(str::trim);
        let first = words.next().unwrap_or_default();
        let (_, arithmetic) = ARITHMETICS.iter().find(|(name, _)| *name == first).ok_or_else(|| wrong(first))?;
        let (mut level, mut sines_said) = (Self::of(*arithmetic), false);
        for word in words {
            // Each kind of word once: of two the last would win in silence.
            match TRIG_ACCURACIES.iter().find(|(name, _)| *name == word) {
                Some((_, sines)) if !sines_said => (level.sines, sines_said) = (*sines, true),
                None if word == "no_fma" && level.fused => level.fused = false,
                _ => return Err(wrong(word)),
            }
        }
        level.check()
    }
}

macro_rules! texts {
    ($($name:ident [$($file:literal)+];)+) => {
        $(
            const $name: &str = concat!($(include_str!(concat!("text/", $file, ".rs"))),+);
        )+
    };
}

texts! {
    DOUBLE_DOUBLE ["exact" "both" "double_double" "sines" "whole"];
    PAIR ["exact" "both" "pair" "pair_of_double"];
    PAIR_CORRECT ["exact" "both" "pair" "pair_of_double" "sines" "whole" "correct"];
    PAIR_OF_TWO ["exact" "both" "pair" "pair_of_two" "sines" "whole"];
    CORRECT ["exact" "sines" "whole" "correct"];
}

/// Contents of the module that generated code of a precision calls; `None` where it needs none. It
/// depends on `std` only.
///
/// Everything is generic over `FUSED: bool`, whether a·b + c is one instruction. For sums of two
/// doubles: `type V`, `k`, `add`, `sub`, `mul`, `div`, `neg`, `sqrt`, `fmadd` = ab + c, `fmsub`,
/// `fnmadd`, `fnmsub`, `positive`, `select`, `atan2`, `number`, and `sin_cos` or `turned`, which
/// refines the sine and cosine of the leading double. For correctly rounded sines:
/// `sin_cos_correct`, `sin_cos_correct_f32`.
pub fn source(level: Precision) -> Option<&'static str> {
    match (level.arithmetic, level.sines) {
        (Arithmetic::DoubleDouble, _) => Some(DOUBLE_DOUBLE),
        (Arithmetic::Compensated, TrigAccuracy::DoubleDouble) => Some(PAIR_OF_TWO),
        (Arithmetic::Compensated, TrigAccuracy::CorrectlyRounded) => Some(PAIR_CORRECT),
        (Arithmetic::Compensated, _) => Some(PAIR),
        (_, TrigAccuracy::CorrectlyRounded) => Some(CORRECT),
        _ => None,
    }
}

/// The text of a module of [`lanes`](crate::lanes) with the sines of a precision.
pub fn with_sines(lanes: &str, level: Precision) -> String {
    let fast = match level.sines {
        TrigAccuracy::Fast7 => include_str!("../lanes/text/sines/f64_fast_7.rs"),
        TrigAccuracy::Fast10 => include_str!("../lanes/text/sines/f64_fast_10.rs"),
        _ => "",
    };
    let text = if level.fused { lanes.to_string() } else { lanes.replace(FUSED, "const FMA: bool = false;") };
    if fast.is_empty() {
        return text;
    }
    let (fused, split) = (include_str!("../lanes/text/sines/f64_fused.rs"), include_str!("../lanes/text/sines/f64_split.rs"));
    // One of them is replaced, the other is removed.
    let one = text.contains(fused) && text.contains(split);
    text.replace(fused, fast).replace(split, if one { "" } else { fast })
}

const FUSED: &str = "const FMA: bool = ::core::cfg!(any(target_feature = \"fma\", target_arch = \"aarch64\"));";
