//! "Did you mean …?"

/// Longer names are not compared.
const LONGEST: usize = 64;
/// Pairs of letters compared for one scene; beyond, no suggestions are made, so that a file full of unknown names is still read quickly.
const MOST_PAIRS: usize = 3_000_000;

/// Finds the nearest of some names, with a bound on the work.
#[derive(Clone, Debug)]
pub(crate) struct Suggester {
    left: usize,
}

impl Default for Suggester {
    fn default() -> Self {
        Self { left: MOST_PAIRS }
    }
}

impl Suggester {
    /// The name that differs least from `wrong`: by half of its letters at most, whatever their case.
    pub(crate) fn nearest<'a>(&mut self, wrong: &str, names: impl IntoIterator<Item = &'a str>) -> Option<String> {
        if wrong.len() > LONGEST {
            return None;
        }
        let most = (wrong.chars().count() / 2).max(1);
        let lower = wrong.to_lowercase();
        let mut best: Option<(usize, &str)> = None;
        for name in names.into_iter().filter(|name| name.len() <= LONGEST) {
            self.left = self.left.checked_sub(name.len() * wrong.len() + 1)?;
            let distance = strsim::osa_distance(&lower, &name.to_lowercase());
            if distance <= most && best.is_none_or(|(least, _)| distance < least) {
                best = Some((distance, name));
            }
        }
        best.map(|(_, name)| name.to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_names_are_found_and_far_ones_are_not() {
        let names = ["damping", "friction", "spring"];
        let near = |wrong: &str| Suggester::default().nearest(wrong, names);
        assert_eq!(near("Dampign").as_deref(), Some("damping"));
        assert_eq!(near("frction").as_deref(), Some("friction"));
        assert_eq!(near("buoyancy"), None);
    }

    #[test]
    fn work_is_bounded() {
        let mut suggester = Suggester { left: 100 };
        assert!(suggester.nearest("dampin", ["damping"]).is_some());
        assert!(suggester.nearest("dampin", ["damping"]).is_some());
        assert!(suggester.nearest("dampin", ["damping"]).is_none());
    }
}
