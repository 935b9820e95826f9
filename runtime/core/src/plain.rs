//! Numbers in messages.

use alloc::format;
use core::fmt;

/// A number as people write it: `1`, not `1.0`; with a power of ten where it is very small or very large.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plain(pub f64);

impl fmt::Display for Plain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let exact = format!("{:?}", self.0);
        f.write_str(exact.strip_suffix(".0").unwrap_or(&exact))
    }
}

#[cfg(test)]
mod tests {
    use alloc::string::ToString;

    use super::Plain;

    #[test]
    fn numbers_are_short_and_exact() {
        let written = |x: f64| Plain(x).to_string();
        assert_eq!([1.0, -9.81, 1e300, -0.0, f64::INFINITY].map(written), ["1", "-9.81", "1e300", "-0", "inf"]);
    }
}
