//! Reports in JSON: their text, and the units of their numbers.

use serde::{Serialize, Serializer};

use crate::table::is_obeyed;

/// Units by path: `functions[].generated` is `generated` in each of `functions`. Seconds and bytes
/// that are part of the name are not included.
#[derive(Clone, Copy, Debug)]
pub struct Units(pub &'static [(&'static str, &'static str)]);

impl Serialize for Units {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.collect_map(self.0.iter().copied())
    }
}

/// A report as JSON, indented, with a line's end. Characters that a terminal obeys are escaped as
/// JSON has it.
pub fn json(report: &impl Serialize) -> String {
    let text = serde_json::to_string_pretty(report).map_or_else(|e| format!("{{\"error\": {:?}}}\n", e.to_string()), |text| text + "\n");
    // Outside of texts there are no other such characters than ends of lines.
    let obeyed = |c: char| c != '\n' && is_obeyed(c);
    if !text.contains(obeyed) {
        return text;
    }
    text.chars().fold(String::with_capacity(text.len()), |mut out, c| {
        if obeyed(c) {
            out += &format!("\\u{:04x}", u32::from(c));
        } else {
            out.push(c);
        }
        out
    })
}

/// Whether every path leads to something in a report.
pub fn lead(units: Units, report: &serde_json::Value) -> bool {
    units.0.iter().all(|(path, _)| {
        let step = |found: Vec<serde_json::Value>, word: &str| -> Vec<serde_json::Value> {
            let name = word.trim_end_matches("[]");
            let inner = found.iter().filter_map(|v| v.get(name).cloned());
            if word.ends_with("[]") { inner.flat_map(|v| v.as_array().cloned().unwrap_or_default()).collect() } else { inner.collect() }
        };
        !path.split('.').fold(vec![report.clone()], step).is_empty()
    })
}

#[cfg(test)]
mod tests {
    use super::json;

    #[test]
    fn json_has_nothing_that_a_terminal_obeys_and_reads_back() {
        let name = "a\u{202e}b\u{9b}31m\u{7f}\nc\td";
        let text = json(&[name]);
        assert_eq!(text, "[\n  \"a\\u202eb\\u009b31m\\u007f\\nc\\td\"\n]\n");
        assert_eq!(serde_json::from_str::<Vec<String>>(&text).unwrap(), [name]);
    }
}
