//! Numbers and lists in messages.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt;

/// A number as people write it: `1`, not `1.0`; with a power of ten where it is very small or very
/// large.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plain(pub f64);

impl fmt::Display for Plain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let exact = format!("{:?}", self.0);
        f.write_str(exact.strip_suffix(".0").unwrap_or(&exact))
    }
}

/// Of more than these a message names the first, and counts the others.
pub const MOST_LISTED: usize = 12;

/// The first of many, and how many more there are: `a, b and 3 more`.
pub fn listed<T: fmt::Display>(all: impl IntoIterator<Item = T>) -> String {
    let mut all = all.into_iter();
    let shown: Vec<String> = all.by_ref().take(MOST_LISTED).map(|one| one.to_string()).collect();
    let (shown, more) = (shown.join(", "), all.count());
    if more > 0 { format!("{shown} and {more} more") } else { shown }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lists_are_cut_and_counted() {
        let all = listed(0..MOST_LISTED);
        assert_eq!([0, 1, 2].map(|n| listed(0..n)), ["", "0", "0, 1"]);
        assert_eq!([1, 3].map(|n| listed(0..MOST_LISTED + n)), [1, 3].map(|n| format!("{all} and {n} more")));
    }

    #[test]
    fn numbers_are_short_and_exact() {
        let written = |x: f64| Plain(x).to_string();
        assert_eq!([1.0, -9.81, 1e300, -0.0, f64::INFINITY].map(written), ["1", "-9.81", "1e300", "-0", "inf"]);
    }
}
