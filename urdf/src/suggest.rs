//! "Did you mean …?"

/// Longer names are not compared.
const LONGEST: usize = 64;
/// Pairs of letters compared per file; beyond, no suggestions are made, so that a file full of unknown names is still
/// read quickly.
const MOST_PAIRS: usize = 3_000_000;

/// Finds the nearest of some names, with a bound on the work.
pub(crate) struct Suggester {
    left: usize,
}

impl Suggester {
    pub(crate) fn new() -> Self {
        Self { left: MOST_PAIRS }
    }

    /// ` (did you mean "upper"?)`, or nothing.
    pub(crate) fn hint<'a>(&mut self, wrong: &str, names: impl Iterator<Item = &'a str>) -> String {
        match nearest_within(wrong, names, &mut self.left) {
            Some(name) => format!(" (did you mean {}?)", crate::problem::quote(name)),
            None => String::new(),
        }
    }
}

/// The name that differs least from `wrong`, if it differs by little: by a third of its letters at most.
pub(crate) fn nearest<'a>(wrong: &str, names: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    nearest_within(wrong, names, &mut MOST_PAIRS.clone())
}

fn nearest_within<'a>(wrong: &str, names: impl Iterator<Item = &'a str>, left: &mut usize) -> Option<&'a str> {
    if wrong.len() > LONGEST || *left == 0 {
        return None;
    }
    let most = (wrong.chars().count() / 3).max(1);
    let lower = wrong.to_lowercase();
    names
        .filter(|name| name.len().abs_diff(wrong.len()) <= 4 * most && name.len() <= LONGEST)
        .take_while(|name| {
            *left = left.saturating_sub(name.len() * wrong.len());
            *left > 0
        })
        .map(|name| (strsim::osa_distance(&lower, &name.to_lowercase()), name))
        .filter(|(distance, _)| *distance <= most)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_names_are_found_and_far_ones_are_not() {
        let names = ["base", "upper", "fore_arm", "hand"];
        assert_eq!(nearest("uper", names.into_iter()), Some("upper"));
        assert_eq!(nearest("Forearm", names.into_iter()), Some("fore_arm"));
        assert_eq!(nearest("wheel", names.into_iter()), None);
        for names in [["left_hand", "left_hands"], ["left_hands", "left_hand"]] {
            assert_eq!(nearest("lft_hands", names.into_iter()), Some("left_hands"));
            assert_eq!(nearest("lft_hand", names.into_iter()), Some("left_hand"));
        }
    }
}
