//! Names that are taken.

use std::collections::{BTreeMap, BTreeSet};

/// The names of a kind of thing; each name is unique.
#[derive(Debug, Default)]
pub(crate) struct Taken {
    names: BTreeSet<String>,
    /// For each name that [`Taken::free`] has numbered, the next number to try. No name is ever
    /// removed, so all smaller numbers are taken.
    numbers: BTreeMap<String, usize>,
}

impl Taken {
    /// With one name that is taken.
    pub(crate) fn with(name: &str) -> Self {
        let mut taken = Self::default();
        taken.insert(name.to_owned());
        taken
    }

    /// Takes a name; false if it is taken already.
    pub(crate) fn insert(&mut self, name: String) -> bool {
        self.names.insert(name)
    }

    /// `name`, or `name` with the first free number from 2 on. It is then taken.
    pub(crate) fn free(&mut self, name: String) -> String {
        if self.names.insert(name.clone()) {
            return name;
        }
        let number = self.numbers.entry(name.clone()).or_insert(2);
        loop {
            let free = format!("{name}_{number}");
            *number += 1;
            if self.names.insert(free.clone()) {
                return free;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_free_name_has_the_first_number_that_is_not_taken() {
        let mut taken = Taken::with("tip");
        assert_eq!([0; 2].map(|_| taken.free("tip".to_owned())), ["tip_2", "tip_3"]);
        assert!(taken.insert("tip_5".to_owned()) && !taken.insert("tip_2".to_owned()));
        assert_eq!([0; 2].map(|_| taken.free("tip".to_owned())), ["tip_4", "tip_6"]);
        assert_eq!(taken.free("hand".to_owned()), "hand");
    }
}
