//! Which numbers an effect can have.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use core::fmt;

/// The range of a number; whatever the bounds, it must be finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// It may not be less.
    pub at_least: f64,
    /// Nor be equal to that.
    pub strictly: bool,
    /// It may not be more.
    pub at_most: f64,
}

impl Range {
    /// Any finite number.
    pub const ALL: Self = Self::from(f64::NEG_INFINITY);
    /// 0 and more.
    pub const NOT_NEGATIVE: Self = Self::from(0.0);
    /// More than 0.
    pub const POSITIVE: Self = Self { strictly: true, ..Self::from(0.0) };

    /// So much and more.
    pub const fn from(at_least: f64) -> Self {
        Self { at_least, strictly: false, at_most: f64::INFINITY }
    }

    /// Whether `x` is there.
    pub fn has(&self, x: f64) -> bool {
        x.is_finite() && x <= self.at_most && (x > self.at_least || (x == self.at_least && !self.strictly))
    }

    /// `above 0, at most 1`; empty without bounds.
    pub fn bounds(&self) -> String {
        let least = match self.strictly {
            true => format!("above {}", number(self.at_least)),
            false => format!("at least {}", number(self.at_least)),
        };
        let most = format!("at most {}", number(self.at_most));
        let both = [(least, self.at_least.is_finite()), (most, self.at_most.is_finite())];
        both.into_iter().filter(|(_, there)| *there).map(|(bound, _)| bound).collect::<Vec<_>>().join(", ")
    }
}

impl fmt::Display for Range {
    /// `a finite number above 0, at most 1`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let bounds = self.bounds();
        match (bounds.is_empty(), self.strictly) {
            (true, _) => f.write_str("a finite number"),
            (_, true) => write!(f, "a finite number {bounds}"),
            _ => write!(f, "a finite number, {bounds}"),
        }
    }
}

/// The shortest text of a number.
fn number(x: f64) -> String {
    if x != 0.0 && x.abs() < 1e-3 { format!("{x:e}") } else { format!("{x}") }
}

/// A rule on several numbers.
#[derive(Clone, Copy, Debug)]
pub struct Rule {
    /// Of all numbers of the effect.
    pub holds: fn(&[f64]) -> bool,
    /// The rule in words, for the field that has it.
    pub expected: &'static str,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_within_or_not() {
        let part = Range { at_most: 1.0, ..Range::POSITIVE };
        assert_eq!([0.0, 1e-300, 1.0, 1.5, f64::NAN, f64::INFINITY].map(|x| part.has(x)), [false, true, true, false, false, false]);
        assert_eq!([-1.0, 0.0, f64::INFINITY].map(|x| Range::NOT_NEGATIVE.has(x)), [false, true, false]);
        assert!(Range::ALL.has(-f64::MAX) && !Range::ALL.has(f64::NEG_INFINITY));
    }

    #[test]
    fn it_says_what_it_has() {
        assert_eq!(format!("{}", Range { at_most: 1.0, ..Range::POSITIVE }), "a finite number above 0, at most 1");
        assert_eq!(format!("{}", Range::POSITIVE), "a finite number above 0");
        assert_eq!(format!("{}", Range::NOT_NEGATIVE), "a finite number, at least 0");
        assert_eq!(format!("{}", Range::from(1e-15)), "a finite number, at least 1e-15");
        assert_eq!(format!("{}", Range::ALL), "a finite number");
    }
}
