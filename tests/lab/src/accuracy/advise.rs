//! The cheapest level that is accurate enough.

use std::fmt::Write;

use articulated_codegen::Precision;
use serde::Serialize;

use super::report::{Point, Report};
use crate::json::Units;
use crate::table::counted;

/// Of all numbers that have one.
pub(super) const UNITS: Units = Units(&[
    ("wish", "the sum of the magnitudes of the terms"),
    ("functions[].ns", "ns per call"),
    ("functions[].error", "the sum of the magnitudes of the terms"),
]);

/// The recommended level for each function, as data.
#[derive(Clone, Debug, Serialize)]
pub struct Whole<'a> {
    robot: &'a str,
    scene: Option<&'a str>,
    base: &'static str,
    states: usize,
    seed: u64,
    wish: f64,
    units: Units,
    functions: Vec<Advice>,
}

/// Advice for a whole report.
pub(super) fn whole(report: &Report, wish: f64) -> Whole<'_> {
    let Report { robot, scene, base, states, seed, .. } = report;
    let functions = all(report, wish);
    Whole { robot, scene: scene.as_deref(), base, states: *states, seed: *seed, wish, units: UNITS, functions }
}

/// The recommended level for one function.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Advice {
    function: &'static str,
    /// `None` if no measured level is accurate enough.
    level: Option<String>,
    ns: Option<f64>,
    error: Option<f64>,
    /// The most accurate level, if none is accurate enough.
    best: Option<(String, f64)>,
}

/// For every function.
pub(super) fn all(report: &Report, wish: f64) -> Vec<Advice> {
    report.functions.iter().map(|f| one(f.function, &f.points, wish)).collect()
}

fn one(function: &'static str, points: &[Point], wish: f64) -> Advice {
    let own = || points.iter().filter(|p| !p.peer);
    let fit = own().filter(|p| p.relative.largest <= wish).min_by(|a, b| a.time.median.total_cmp(&b.time.median));
    let best = own().min_by(|a, b| a.relative.largest.total_cmp(&b.relative.largest)).filter(|_| fit.is_none());
    Advice {
        function,
        level: fit.map(|p| p.level.clone()),
        ns: fit.map(|p| p.time.median),
        error: fit.map(|p| p.relative.largest),
        best: best.map(|p| (p.level.clone(), p.relative.largest)),
    }
}

/// The functions without an accurate enough level, in a sentence.
pub(super) fn short(report: &Report, wish: f64) -> Option<String> {
    let names: Vec<&str> = all(report, wish).iter().filter(|a| a.level.is_none()).map(|a| a.function).collect();
    (!names.is_empty()).then(|| format!("nothing measured is accurate to {wish:e}: {}", names.join(", ")))
}

/// In sentences.
pub(super) fn text(report: &Report, wish: f64) -> String {
    let mut out = String::new();
    for a in all(report, wish) {
        let _ = match (&a.level, a.ns, a.error, &a.best) {
            (Some(level), Some(ns), Some(error), _) => {
                writeln!(
                    out,
                    "{}: {level}, {ns:.0} ns per call, off by at most {error:.1e} in {}",
                    a.function,
                    counted(report.states, "state")
                )
            }
            (.., Some((level, error))) => {
                writeln!(out, "{}: nothing measured is accurate to {wish:e}; the most accurate is {level} with {error:.1e}", a.function)
            }
            _ => writeln!(out, "{}: nothing was measured", a.function),
        };
        let level = a.level.as_deref().and_then(|level| level.parse::<Precision>().ok());
        level.iter().flat_map(|l| l.contract()).for_each(|line| {
            let _ = writeln!(out, "    {line}");
        });
    }
    out
}

#[cfg(test)]
mod tests {
    use super::super::report::example;
    use super::*;

    #[test]
    fn the_cheapest_that_is_enough_is_named() {
        let report = example();
        let level = |wish: f64| all(&report, wish).remove(0).level;
        assert_eq!(level(1e-3).as_deref(), Some("f32"));
        assert_eq!(level(1e-9).as_deref(), Some("f64"));
        assert_eq!(level(1e-15).as_deref(), Some("double_double"));
        assert_eq!(level(1e-30), None);
        // As accurate as was wished for is enough.
        let single = &report.functions[0].points.iter().find(|p| p.level == "f32").unwrap().relative;
        assert_eq!(level(single.largest).as_deref(), Some("f32"));
        assert!(text(&report, 1e-30).contains("the most accurate is double_double"));
    }

    #[test]
    fn programs_read_what_it_is_of_and_in_what_units() {
        let report = example();
        let json = serde_json::to_value(whole(&report, 1e-9)).unwrap();
        assert!(crate::json::lead(UNITS, &json));
        assert_eq!((&json["functions"][0]["level"], &json["wish"]), (&"f64".into(), &1e-9.into()));
    }

    #[test]
    fn another_library_is_no_level_however_cheap_and_accurate() {
        let mut report = example();
        for point in &mut report.functions[0].points {
            point.peer = point.level == "double_double";
        }
        let advice = all(&report, 1e-15).remove(0);
        assert_eq!(advice.level, None);
        assert_ne!(advice.best.expect("a level that was measured").0, "double_double");
    }
}
