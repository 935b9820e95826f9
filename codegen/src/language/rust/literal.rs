//! Numbers in source.

/// The shortest literal that is read back as exactly `x`; infinities and NaN by their names.
pub(crate) fn literal(x: f64) -> String {
    match x {
        x if x.is_nan() => "f64::NAN".into(),
        f64::INFINITY => "f64::INFINITY".into(),
        f64::NEG_INFINITY => "f64::NEG_INFINITY".into(),
        x => format!("{x:?}"),
    }
}

/// The literal as an operand.
pub(crate) fn operand(x: f64) -> String {
    if x < 0.0 { format!("({})", literal(x)) } else { literal(x) }
}

/// The nearest `f32` as an operand.
pub(crate) fn single(x: f64) -> String {
    match x as f32 {
        x if x.is_nan() => "f32::NAN".into(),
        f32::INFINITY => "f32::INFINITY".into(),
        f32::NEG_INFINITY => "f32::NEG_INFINITY".into(),
        x if x < 0.0 => format!("({x:?})"),
        x => format!("{x:?}"),
    }
}

/// An operand on its own: a negative number without its brackets.
pub(crate) fn bare(operand: &str) -> &str {
    match operand.strip_prefix('(') {
        Some(rest) => rest.strip_suffix(')').unwrap_or(operand),
        None => operand,
    }
}

#[cfg(test)]
mod tests {
    use super::{bare, literal, operand, single};

    #[test]
    fn literals_are_read_back_to_the_bit() {
        for x in [0.1, 1.0, -2.5e-300, f64::MIN_POSITIVE / 4.0, f64::MAX, 1.0 / 3.0, 1e22, 123_456_789.123_456_78] {
            assert_eq!(literal(x).parse::<f64>().map(f64::to_bits), Ok(x.to_bits()));
            assert!(literal(x).contains(['.', 'e']), "{} would be an integer", literal(x));
        }
        // Code that overflows is code.
        assert_eq!([f64::INFINITY, f64::NEG_INFINITY].map(literal), ["f64::INFINITY", "f64::NEG_INFINITY"]);
        assert_eq!([literal(f64::NAN), single(f64::NAN), single(-1e40)], ["f64::NAN", "f32::NAN", "f32::NEG_INFINITY"]);
    }

    #[test]
    fn a_sign_belongs_to_its_number() {
        // `-2.0.sqrt()` is −√2.
        assert_eq!([operand(-2.0), single(-2.0), operand(2.0), single(0.1)], ["(-2.0)", "(-2.0)", "2.0", "0.1"]);
        assert_eq!([bare("(-2.0)"), bare("2.0"), bare("(a) + b")], ["-2.0", "2.0", "(a) + b"]);
    }
}
