//! Units of what a report in JSON has.

use serde::{Serialize, Serializer};

/// Units by path: `functions[].generated` is what `generated` is in each of `functions`. Seconds and bytes that say so in their names are not among them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Units(pub(crate) &'static [(&'static str, &'static str)]);

impl Serialize for Units {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.collect_map(self.0.iter().copied())
    }
}

/// Whether every path leads to something in a report.
#[cfg(test)]
pub(crate) fn lead(units: Units, report: &serde_json::Value) -> bool {
    units.0.iter().all(|(path, _)| {
        let step = |found: Vec<serde_json::Value>, word: &str| -> Vec<serde_json::Value> {
            let name = word.trim_end_matches("[]");
            let inner = found.iter().filter_map(|v| v.get(name).cloned());
            if word.ends_with("[]") { inner.flat_map(|v| v.as_array().cloned().unwrap_or_default()).collect() } else { inner.collect() }
        };
        !path.split('.').fold(vec![report.clone()], step).is_empty()
    })
}
