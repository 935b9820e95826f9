//! Decimal numbers only.
//!
//! `[+-] digits [. digits] [e [+-] digits]`, with digits before or after the point. No `nan`,
//! `inf`, hexadecimal digits, decimal commas or letters behind; the value is the double nearest to
//! the spelling.

use super::element::Tag;
use articulated_core::diagnostic::{At, Code, Diagnostics, Place, quote};

/// Whether a value holds an expression of xacro.
pub(crate) fn is_expression(value: &str) -> bool {
    value.contains("${") || value.contains("$(")
}

/// Reason why a word is not a usable number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fault {
    NotANumber,
    NotFinite,
    Vanishes,
}

/// The number that a word without blanks spells.
pub(crate) fn parse(word: &str) -> Result<f64, Fault> {
    // With these characters only, Rust's grammar is the one above.
    let plain = word.bytes().all(|b| matches!(b, b'0'..=b'9' | b'+' | b'-' | b'.' | b'e' | b'E'));
    if !plain {
        return Err(if names_infinity(word) { Fault::NotFinite } else { Fault::NotANumber });
    }
    match word.parse().map_err(|_| Fault::NotANumber)? {
        v if !f64::is_finite(v) => Err(Fault::NotFinite),
        v if v == 0.0 && !spells_zero(word) => Err(Fault::Vanishes),
        v => Ok(v),
    }
}

fn names_infinity(word: &str) -> bool {
    let word = word.strip_prefix(['+', '-']).unwrap_or(word);
    ["nan", "inf", "infinity"].iter().any(|name| word.eq_ignore_ascii_case(name))
}

fn spells_zero(word: &str) -> bool {
    let mantissa = word.split(['e', 'E']).next().unwrap_or_default();
    !mantissa.bytes().any(|b| (b'1'..=b'9').contains(&b))
}

/// The number in an attribute, if it is there and valid.
pub(crate) fn attribute(tag: &Tag<'_>, name: &str, log: &mut Diagnostics) -> Option<f64> {
    attribute_list::<1>(tag, name, log).map(|[number]| number)
}

/// The `N` numbers in an attribute, if it is there and valid.
pub(crate) fn attribute_list<const N: usize>(tag: &Tag<'_>, name: &str, log: &mut Diagnostics) -> Option<[f64; N]> {
    let (value, at) = tag.attribute(name)?;
    checked(value, at, tag, name, log)
}

/// The number in a required attribute.
pub(crate) fn required(tag: &Tag<'_>, name: &str, log: &mut Diagnostics) -> Option<f64> {
    let (value, at) = tag.required_attribute(name, log)?;
    checked(value, at, tag, name, log).map(|[number]| number)
}

fn checked<const N: usize>(value: &str, at: At, tag: &Tag<'_>, name: &str, log: &mut Diagnostics) -> Option<[f64; N]> {
    let wrong = match list(value) {
        Ok(numbers) => return Some(numbers),
        Err(wrong) => wrong,
    };
    // It has its own error.
    if tag.reports_expressions() && is_expression(value) {
        return None;
    }
    let field = format!("{} {name}", tag.name());
    let place = Place { at, ..tag.place(&field) };
    match wrong {
        Wrong::Word(word, fault) => complain(fault, word, value, &place, log),
        Wrong::Count(count) => {
            log.error(place, Code::WrongCount, format!("{count} numbers in {}", quote(value)), expected_count(N));
        }
    }
    None
}

/// The error of a list of numbers: its first invalid word, or else its length.
enum Wrong<'a> {
    Word(&'a str, Fault),
    Count(usize),
}

/// The `N` numbers in an attribute, if it is there and valid; no error is reported.
pub(crate) fn silently<const N: usize>(tag: &Tag<'_>, name: &str) -> Option<[f64; N]> {
    list(tag.attribute(name)?.0).ok()
}

fn list<const N: usize>(value: &str) -> Result<[f64; N], Wrong<'_>> {
    let mut numbers = [0.0; N];
    let mut count = 0;
    for word in value.split_ascii_whitespace() {
        let number = parse(word).map_err(|fault| Wrong::Word(word, fault))?;
        numbers.get_mut(count).into_iter().for_each(|n| *n = number);
        count += 1;
    }
    if count == N { Ok(numbers) } else { Err(Wrong::Count(count)) }
}

fn expected_count(n: usize) -> String {
    match n {
        1 => "one number".to_owned(),
        3 => "three numbers".to_owned(),
        n => format!("{n} numbers"),
    }
}

fn complain(fault: Fault, word: &str, value: &str, place: &Place<'_>, log: &mut Diagnostics) {
    let found = match word == value {
        true => quote(word),
        false => format!("{} in {}", quote(word), quote(value)),
    };
    let (kind, expected) = match fault {
        Fault::NotANumber => (Code::NotANumber, "a decimal number"),
        Fault::NotFinite => (Code::NotFinite, "a finite number"),
        Fault::Vanishes => (Code::NotFinite, "a number that is not too small for double precision"),
    };
    log.error(place, kind, found, expected);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn legal_spellings_are_read_exactly() {
        let spellings = [
            ("0", 0.0),
            ("-0", -0.0),
            ("+.5", 0.5),
            ("2.", 2.0),
            ("1E-2", 0.01),
            ("1e+02", 100.0),
            ("-.002", -0.002),
            ("0e-999", 0.0),
            ("4.9e-324", 4.9e-324),
            ("0.1000000000000000055511151231257827", 0.1),
        ];
        for (word, value) in spellings {
            assert_eq!(parse(word).map(f64::to_bits), Ok(f64::to_bits(value)), "{word}");
        }
    }

    #[test]
    fn nothing_else_is_a_number() {
        for word in ["", "+", ".", "e5", "1e", "1e+", "0x10", "0x1p3", "1,5", "1.2.3", "--1", "+-1", "1f", "１", "1_0", "1d3"] {
            assert_eq!(parse(word), Err(Fault::NotANumber), "{word}");
        }
        for word in ["nan", "-NaN", "inf", "+Infinity", "1e999", "-1e400"] {
            assert_eq!(parse(word), Err(Fault::NotFinite), "{word}");
        }
        assert_eq!(parse("1e-400"), Err(Fault::Vanishes));
    }
}
