//! Units next to the numbers of reports in JSON.

use serde_json::Value;

use super::run;

/// The values at a path: `links[].mass` means the mass of each link.
fn found<'a>(report: &'a Value, path: &str) -> Vec<&'a Value> {
    path.split('.').fold(vec![report], |at, word| {
        let inner = at.into_iter().filter_map(|value| value.get(word.trim_end_matches("[]")));
        if word.ends_with("[]") { inner.filter_map(Value::as_array).flatten().collect() } else { inner.collect() }
    })
}

#[test]
fn every_unit_is_that_of_something() {
    for words in [&["check", "panda_like"][..], &["simulate", "quadruped_drop", "--end", "0.2"], &["effects", "pendulum"]] {
        let report = run(&[words, &["--format", "json"]].concat()).json();
        let units = report["units"].as_object().unwrap();
        let vain: Vec<&String> = units.keys().filter(|path| found(&report, path).is_empty()).collect();
        assert!(!units.is_empty() && vain.is_empty(), "{words:?}: {vain:?}");
    }
}
