//! Levels of accuracy of generated code, and the source of the arithmetic that they need.
//!
//! A level is an arithmetic, a way to compute sines and cosines, and whether multiplication and addition may be one instruction. The graph of a function is the same
//! at every level; what changes is how a node is computed.

use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt;
use core::str::FromStr;

#[cfg(test)]
mod tests;

/// In what numbers a function computes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Arithmetic {
    /// `f64`.
    #[default]
    Double,
    /// `f32`, in and out too.
    Single,
    /// `f64`, in and out `f32`.
    SingleByDouble,
    /// `f64` with what each operation lost carried along to first order (Lange & Rump 2020).
    Compensated,
    /// Sums of two `f64` (Joldes, Muller & Popescu 2017), in and out `f64`.
    DoubleDouble,
}

/// How sines and cosines of angles are computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Sines {
    /// Off by at most 1 ulp of `f64`.
    #[default]
    Ulp,
    /// The double nearest to the true value.
    Correct,
    /// Off by at most 10⁻⁷.
    Fast7,
    /// Off by at most 10⁻¹⁰.
    Fast10,
    /// Sums of two `f64`, off by at most 2⁻¹⁰⁰ of the value.
    Two,
}

/// How accurate a module of generated code is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Level {
    /// The numbers.
    pub arithmetic: Arithmetic,
    /// Sines and cosines.
    pub sines: Sines,
    /// Whether a·b + c is one instruction, with one rounding, where the processor has it.
    pub fused: bool,
}

impl Default for Level {
    fn default() -> Self {
        Self { arithmetic: Arithmetic::Double, sines: Sines::Ulp, fused: true }
    }
}

/// A text that is no level.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LevelError {
    /// The word that is wrong.
    pub found: String,
    /// What would be right.
    pub expected: &'static str,
}

impl fmt::Display for LevelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "level: found `{}`, expected {}", self.found, self.expected)
    }
}

impl core::error::Error for LevelError {}

const ARITHMETICS: [(&str, Arithmetic); 5] = [
    ("f64", Arithmetic::Double),
    ("f32", Arithmetic::Single),
    ("f32_f64", Arithmetic::SingleByDouble),
    ("compensated", Arithmetic::Compensated),
    ("double_double", Arithmetic::DoubleDouble),
];

const SINES: [(&str, Sines); 5] =
    [("ulp", Sines::Ulp), ("correct", Sines::Correct), ("fast_7", Sines::Fast7), ("fast_10", Sines::Fast10), ("two", Sines::Two)];

const EXPECTED: &str = "f64, f32, f32_f64, compensated or double_double, then what differs from the default of +correct, +fast_7, +fast_10, +two, +no_fma, \
                        as in f64+fast_10+no_fma";

impl Level {
    /// An arithmetic with the sines and the multiply-add that go with it unless one is told.
    pub fn of(arithmetic: Arithmetic) -> Self {
        let sines = if arithmetic == Arithmetic::DoubleDouble { Sines::Two } else { Sines::Ulp };
        Self { arithmetic, sines, fused: true }
    }

    /// Every level that `articulated accuracy` measures unless it is told.
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

    /// Whether limbs that are alike can be computed in lanes.
    pub fn has_lanes(self) -> bool {
        self.arithmetic == Arithmetic::Double && self.fused && matches!(self.sines, Sines::Ulp | Sines::Fast7 | Sines::Fast10)
    }

    fn check(self) -> Result<Self, LevelError> {
        let wrong = |expected| Err(LevelError { found: self.to_string(), expected });
        match (self.arithmetic, self.sines) {
            (Arithmetic::Double | Arithmetic::Single | Arithmetic::SingleByDouble, Sines::Two) => {
                wrong("+two with compensated or double_double, whose numbers are sums of two")
            }
            (Arithmetic::DoubleDouble, Sines::Two) => Ok(self),
            (Arithmetic::DoubleDouble, _) => wrong("double_double with its own sines"),
            _ => Ok(self),
        }
    }

    /// What holds at this level, in lines: bound, domain, and what comes of odd arguments.
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
            Sines::Ulp => {
                "Sines and cosines: off by at most 1 ulp up to 1e5 rad; beyond, and so at 1e6, 1e15 and 1e22, as the standard library has them."
            }
            Sines::Correct => "Sines and cosines: the nearest doubles, of any finite angle, 1e6, 1e15 and 1e22 among them.",
            Sines::Fast7 => {
                "Sines and cosines: |error| ≤ 1e-7 up to 1e5 rad; beyond, and so at 1e6, 1e15 and 1e22, as the standard library has them."
            }
            Sines::Fast10 => {
                "Sines and cosines: |error| ≤ 1e-10 up to 1e5 rad; beyond, and so at 1e6, 1e15 and 1e22, as the standard library has them."
            }
            Sines::Two => "Sines and cosines: off by at most 2⁻¹⁰⁰ of the value, of any finite angle, 1e6, 1e15 and 1e22 among them.",
        };
        let mut lines = Vec::from([arithmetic.to_string(), sines.to_string()]);
        if self.arithmetic == Arithmetic::Single && self.sines != Sines::Correct {
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
            "The constants are those of the model in f64: each is off by some 2⁻⁵³ of what the URDF's decimals say, at every level.".into(),
        );
        lines
    }
}

impl fmt::Display for Level {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = ARITHMETICS.iter().find(|(_, a)| *a == self.arithmetic).map_or("", |(name, _)| name);
        f.write_str(name)?;
        if self.sines != Self::of(self.arithmetic).sines {
            write!(f, "+{}", SINES.iter().find(|(_, s)| *s == self.sines).map_or("", |(name, _)| name))?;
        }
        if self.fused { Ok(()) } else { f.write_str("+no_fma") }
    }
}

impl FromStr for Level {
    type Err = LevelError;

    fn from_str(text: &str) -> Result<Self, LevelError> {
        let wrong = |found: &str| LevelError { found: found.trim().to_string(), expected: EXPECTED };
        let mut words = text.split('+').map(str::trim);
        let first = words.next().unwrap_or_default();
        let (_, arithmetic) = ARITHMETICS.iter().find(|(name, _)| *name == first).ok_or_else(|| wrong(first))?;
        let (mut level, mut sines_said) = (Self::of(*arithmetic), false);
        for word in words {
            // Each kind of word once: of two the last would win in silence.
            match SINES.iter().find(|(name, _)| *name == word) {
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

/// Contents of the module that code of a level calls, for which `std` is enough; nothing where the level needs none. All is generic over `FUSED: bool`,
/// whether a·b + c is one instruction. With numbers of two: `type V`, `k`, `add`, `sub`, `mul`, `div`, `neg`, `sqrt`, `fmadd` = ab + c, `fmsub`, `fnmadd`, `fnmsub`, `positive`, `select`,
/// `atan2`, `number`, and `sin_cos` or `turned`, which makes them of those of the double. With sines to the nearest double: `sin_cos_correct`, `sin_cos_correct_f32`.
pub fn source(level: Level) -> Option<&'static str> {
    match (level.arithmetic, level.sines) {
        (Arithmetic::DoubleDouble, _) => Some(DOUBLE_DOUBLE),
        (Arithmetic::Compensated, Sines::Two) => Some(PAIR_OF_TWO),
        (Arithmetic::Compensated, Sines::Correct) => Some(PAIR_CORRECT),
        (Arithmetic::Compensated, _) => Some(PAIR),
        (_, Sines::Correct) => Some(CORRECT),
        _ => None,
    }
}

/// The text of a module of [`lanes`](crate::lanes) with the sines of a level.
pub fn with_sines(lanes: &str, level: Level) -> String {
    let fast = match level.sines {
        Sines::Fast7 => include_str!("../lanes/text/sines/f64_fast_7.rs"),
        Sines::Fast10 => include_str!("../lanes/text/sines/f64_fast_10.rs"),
        _ => "",
    };
    let text = if level.fused { lanes.to_string() } else { lanes.replace(FUSED, "const FMA: bool = false;") };
    if fast.is_empty() {
        return text;
    }
    let (fused, split) = (include_str!("../lanes/text/sines/f64_fused.rs"), include_str!("../lanes/text/sines/f64_split.rs"));
    // One of them is replaced, the other goes.
    let one = text.contains(fused) && text.contains(split);
    text.replace(fused, fast).replace(split, if one { "" } else { fast })
}

const FUSED: &str = "const FMA: bool = ::core::cfg!(any(target_feature = \"fma\", target_arch = \"aarch64\"));";
