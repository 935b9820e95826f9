//! "Did you mean …?"

use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;

/// Longer names are not compared.
const LONGEST: usize = 64;
/// Pairs of letters that are compared at most, so that a file full of unknown names is still read
/// quickly.
const MOST_PAIRS: usize = 3_000_000;
/// Fewer letters are not taken for the beginning or the end of a name.
const LEAST: usize = 3;

/// Finds the intended name with bounded work: one for a file, which makes no suggestions beyond the
/// bound.
#[derive(Clone, Debug)]
pub struct Suggester {
    left: usize,
}

impl Default for Suggester {
    fn default() -> Self {
        Self { left: MOST_PAIRS }
    }
}

impl Suggester {
    /// The name that differs least from `wrong`, if by a third of its letters at most; or else the
    /// shortest that begins with it; or else the shortest that ends with it.
    pub fn nearest<'a>(&mut self, wrong: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
        self.found(wrong, names).and_then(|(misspelt, begins)| misspelt.or(begins))
    }

    /// The name that differs least from `wrong`, if by a third of its letters at most.
    pub fn misspelt<'a>(&mut self, wrong: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
        self.found(wrong, names).and_then(|(misspelt, _)| misspelt)
    }

    /// The name that differs least, and the shortest that begins with `wrong`; `None` if that is
    /// too much work.
    fn found<'a>(&mut self, wrong: &str, names: impl IntoIterator<Item = &'a str>) -> Option<(Option<&'a str>, Option<&'a str>)> {
        let letters: Vec<char> = small(wrong).take(LONGEST + 1).collect();
        if letters.len() > LONGEST {
            return None;
        }
        let most = (letters.len() / 3).max(1);
        let (mut near, mut longer, mut ending): (Option<(usize, &str)>, Option<&str>, Option<&str>) = (None, None, None);
        for name in names.into_iter().filter(|name| name.len() <= 4 * LONGEST) {
            let other: Vec<char> = small(name).collect();
            self.left = self.left.checked_sub(letters.len() * other.len() + 1)?;
            let differs = distance(&letters, &other);
            if differs <= most && near.is_none_or(|(least, _)| differs < least) {
                near = Some((differs, name));
            }
            if letters.len() >= LEAST {
                let shorter = |so_far: Option<&str>| so_far.is_none_or(|so_far| name.len() < so_far.len());
                if other.starts_with(&letters) && shorter(longer) {
                    longer = Some(name);
                } else if other.ends_with(&letters) && shorter(ending) {
                    ending = Some(name);
                }
            }
        }
        Some((near.map(|(_, name)| name), longer.or(ending)))
    }
}

/// As [`Suggester::nearest`], for one name.
pub fn nearest<'a>(wrong: &str, names: impl IntoIterator<Item = &'a str>) -> Option<String> {
    Suggester::default().nearest(wrong, names).map(String::from)
}

/// Its letters, in lower case.
fn small(name: &str) -> impl Iterator<Item = char> {
    name.chars().flat_map(char::to_lowercase)
}

/// How many letters to insert, take out, change, or swap with the next (optimal string alignment).
fn distance(a: &[char], b: &[char]) -> usize {
    let (mut before, mut row): (Vec<usize>, Vec<usize>) = (Vec::new(), (0..=a.len()).collect());
    for i in 0..b.len() {
        let mut next = vec![i + 1];
        for j in 0..a.len() {
            let changed = row[j] + usize::from(a[j] != b[i]);
            let swapped = if i > 0 && j > 0 && a[j] == b[i - 1] && a[j - 1] == b[i] { before[j - 1] + 1 } else { changed };
            next.push(changed.min(swapped).min(row[j + 1] + 1).min(next[j] + 1));
        }
        (before, row) = (row, next);
    }
    row[a.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_names_are_found_and_far_ones_are_not() {
        let near = |wrong| nearest(wrong, ["shoulder", "elbow", "wrist_1", "palm", "arm"]);
        assert_eq!(near("elbo").as_deref(), Some("elbow"));
        assert_eq!(near("Wrist1").as_deref(), Some("wrist_1"));
        assert_eq!(near("plam").as_deref(), Some("palm"));
        assert_eq!(near("hip"), None);
        assert_eq!(nearest("x", []), None);
        for names in [["left_hand", "left_hands"], ["left_hands", "left_hand"]] {
            assert_eq!(nearest("lft_hands", names).as_deref(), Some("left_hands"));
            assert_eq!(nearest("lft_hand", names).as_deref(), Some("left_hand"));
        }
    }

    #[test]
    fn beginnings_are_found() {
        let near = |wrong| nearest(wrong, ["jacobians_world", "jacobians_body", "inverse_dynamics_derivatives", "inverse_dynamics"]);
        assert_eq!(near("inverse_dyn").as_deref(), Some("inverse_dynamics"));
        assert_eq!(near("Jacobian").as_deref(), Some("jacobians_body"));
        assert_eq!(near("ja"), None);
    }

    #[test]
    fn endings_are_found_where_no_beginning_is() {
        let near = |wrong| nearest(wrong, ["left_panda_hand_tcp", "panda_hand_tcp", "panda_hand"]);
        assert_eq!(near("hand_tcp").as_deref(), Some("panda_hand_tcp"));
        assert_eq!(near("panda").as_deref(), Some("panda_hand"));
        assert_eq!(near("cp"), None);
    }

    #[test]
    fn work_is_bounded() {
        let mut suggester = Suggester { left: 100 };
        assert!(suggester.nearest("dampin", ["damping"]).is_some());
        assert!(suggester.nearest("dampin", ["damping"]).is_some());
        assert!(suggester.nearest("dampin", ["damping"]).is_none());
        assert_eq!(nearest(&"x".repeat(LONGEST + 1), ["x"]), None);
    }
}
