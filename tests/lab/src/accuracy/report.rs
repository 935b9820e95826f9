//! The results of a measurement.

use std::path::PathBuf;

use articulated_codegen::Precision;
use serde::Serialize;

use crate::compare::accuracy::Against;
use crate::json::Units;
use crate::timing::Summary;

/// Settings of the measurement.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The functions; if empty, four of kinematics and dynamics.
    pub functions: Vec<String>,
    /// The levels; if empty, all.
    pub levels: Vec<Precision>,
    /// How many random states.
    pub states: u32,
    /// Their seed.
    pub seed: u64,
    /// How often each is timed.
    pub repetitions: u32,
    /// Peer libraries.
    pub peer: Vec<PathBuf>,
    /// A list of peer libraries.
    pub peers_manifest: Option<PathBuf>,
    /// The commit that the report names.
    pub commit: &'static str,
}

const MAGNITUDE: &str = "the sum of the magnitudes of the terms";

/// Of all numbers that have one.
pub(super) const UNITS: Units = Units(&[
    ("functions[].points[].time", "ns per call"),
    ("functions[].points[].relative", MAGNITUDE),
    ("functions[].points[].ulps", "the last place of the result as a double"),
    ("functions[].points[].rounding", MAGNITUDE),
    ("functions[].points[].backward", "the sum of the magnitudes of the terms of the torques"),
    ("functions[].points[].hard", "the sum of the magnitudes of the terms, or \"overflow\"; and the name of the state"),
    ("functions[].points[].bound", MAGNITUDE),
    ("functions[].points[].reached", "the bound"),
]);

/// All that was measured.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    pub(super) robot: String,
    /// The scene that it is of.
    pub(super) scene: Option<String>,
    pub(super) base: &'static str,
    pub(super) joints: usize,
    pub(super) degrees_of_freedom: usize,
    pub(super) frames: Vec<String>,
    pub(super) states: usize,
    pub(super) hard_states: usize,
    pub(super) seed: u64,
    pub(super) repetitions: u32,
    pub(super) reference: Against,
    pub(super) reference_bits: usize,
    pub(super) processor: String,
    pub(super) compiler: String,
    pub(super) flags: String,
    pub(super) version: &'static str,
    pub(super) commit: &'static str,
    pub(super) units: Units,
    pub(super) notes: Vec<String>,
    pub(super) functions: Vec<FunctionReport>,
}

/// One function at every level.
#[derive(Clone, Debug, Serialize)]
pub(super) struct FunctionReport {
    pub(super) function: &'static str,
    /// Description of the result.
    pub(super) summary: &'static str,
    pub(super) points: Vec<Point>,
    /// Notable results.
    pub(super) surprises: Vec<String>,
}

/// The middle, nearly the largest and the largest of some errors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub(super) struct Spread {
    pub(super) median: f64,
    pub(super) most: f64,
    pub(super) largest: f64,
}

/// A function at a level, or another library's.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Point {
    pub(super) level: String,
    /// Whether it is a library of others.
    pub(super) peer: bool,
    /// ns per call.
    pub(super) time: Summary,
    /// For each state, the largest error of a result, relative to the sum of the magnitudes of its
    /// terms; against [`Report::reference`].
    pub(super) relative: Spread,
    /// The same in units in the last place of a double.
    pub(super) ulps: Spread,
    /// As `relative`, against the graph that is emitted, in the reference's digits: rounding alone.
    pub(super) rounding: Option<Spread>,
    /// Difference between the torques that a solution needs and the given ones, relative to the
    /// magnitudes of their terms.
    pub(super) backward: Option<Spread>,
    /// The largest relative error on the hard states, NaN if the result is not a number, and the
    /// name of the hard state.
    #[serde(serialize_with = "hard")]
    pub(super) hard: Option<(f64, &'static str)>,
    /// The largest guaranteed bound on `rounding`, over the random states.
    pub(super) bound: Option<f64>,
    /// The largest ratio of an error to its bound.
    pub(super) reached: Option<f64>,
    pub(super) instructions: Option<u64>,
    pub(super) operations: Option<u64>,
    pub(super) code_bytes: Option<u64>,
    /// rustc's time for all functions of the level.
    pub(super) compilation_seconds: Option<f64>,
    /// Whether no other point is both faster and more accurate.
    pub(super) front: bool,
}

impl Spread {
    /// Of the largest errors of states.
    pub(super) fn of(mut errors: Vec<f64>) -> Self {
        // A NaN may have a sign, and a negative one would be sorted first.
        errors.iter_mut().filter(|e| e.is_nan()).for_each(|e| *e = f64::NAN);
        errors.sort_by(f64::total_cmp);
        let at = |part: f64| errors.get(((errors.len().max(1) - 1) as f64 * part).ceil() as usize).copied().unwrap_or(f64::NAN);
        Self { median: at(0.5), most: at(0.99), largest: at(1.0) }
    }
}

/// JSON has no NaN.
fn hard<S: serde::Serializer>(hard: &Option<(f64, &'static str)>, to: S) -> Result<S::Ok, S::Error> {
    match hard {
        Some((error, name)) if !error.is_finite() => ("overflow", name).serialize(to),
        other => other.serialize(to),
    }
}

/// Marks the points that no other beats in both time and error.
pub(super) fn mark_front(points: &mut [Point]) {
    let all: Vec<(f64, f64)> = points.iter().map(|p| (p.time.median, p.relative.largest)).collect();
    for (k, point) in points.iter_mut().enumerate() {
        let (time, error) = all[k];
        let beats = |(t, e): &(f64, f64)| *t <= time && *e <= error && (*t < time || *e < error);
        point.front = error.is_finite() && !all.iter().any(beats);
    }
}

/// The processor's name for itself.
pub(crate) fn processor() -> String {
    let told = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = told.lines().find_map(|l| l.strip_prefix("model name")?.split_once(": ").map(|(_, name)| name.to_owned()));
    name.unwrap_or_else(|| std::env::consts::ARCH.to_owned())
}

#[cfg(test)]
pub(super) fn point(level: &str, ns: f64, error: f64) -> Point {
    let time = Summary { median: ns, lower_quartile: ns, upper_quartile: ns };
    let of = |x: f64| Spread { median: x / 4.0, most: x / 2.0, largest: x };
    Point {
        level: level.into(),
        peer: false,
        time,
        relative: of(error),
        ulps: of(error * 9e15),
        rounding: Some(of(error / 2.0)),
        backward: None,
        hard: Some((error * 2.0, "angles of 1e22")),
        bound: Some(error * 30.0),
        reached: Some(0.1),
        instructions: Some(100),
        operations: Some(150),
        code_bytes: None,
        compilation_seconds: Some(1.0),
        front: false,
    }
}

#[cfg(test)]
pub(super) fn example() -> Report {
    let mut points =
        vec![point("f32", 50.0, 1e-6), point("f64", 60.0, 2e-15), point("f64+no_fma", 90.0, 3e-15), point("double_double", 2000.0, 4e-16)];
    mark_front(&mut points);
    Report {
        robot: "an <arm> & more".into(),
        scene: None,
        base: "fixed",
        joints: 7,
        degrees_of_freedom: 7,
        frames: vec!["tool".into()],
        states: 64,
        hard_states: 13,
        seed: 1,
        repetitions: 31,
        reference: Against::Textbook,
        reference_bits: 320,
        processor: "a processor".into(),
        compiler: "rustc".into(),
        flags: String::new(),
        version: "0",
        commit: "none",
        units: UNITS,
        notes: vec![],
        functions: vec![FunctionReport { function: "inverse_dynamics", summary: "torques", points, surprises: vec!["a surprise".into()] }],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_has_what_nothing_beats() {
        let report = example();
        let front: Vec<&str> = report.functions[0].points.iter().filter(|p| p.front).map(|p| p.level.as_str()).collect();
        assert_eq!(front, ["f32", "f64", "double_double"]);
    }

    #[test]
    fn units_are_those_of_numbers_that_are_there() {
        assert!(crate::json::lead(UNITS, &serde_json::to_value(example()).unwrap()));
    }

    #[test]
    fn what_has_overflowed_is_told_as_data_too() {
        let told = |hard| serde_json::to_value(Point { hard, ..point("f32", 1.0, 1e-7) }).unwrap()["hard"].clone();
        assert_eq!(told(Some((f64::NAN, "angles of 1e22"))), serde_json::json!(["overflow", "angles of 1e22"]));
        assert_eq!(told(Some((0.5, "at rest"))), serde_json::json!([0.5, "at rest"]));
        assert!(told(None).is_null());
    }

    #[test]
    fn a_spread_is_of_sorted_numbers() {
        let s = Spread::of((1..=100).rev().map(f64::from).collect());
        assert_eq!((s.median, s.most, s.largest), (51.0, 100.0, 100.0));
        assert!(
            Spread::of(vec![1.0, f64::NAN]).largest.is_nan()
                && Spread::of(vec![1.0, -f64::NAN]).largest.is_nan()
                && Spread::of(vec![]).median.is_nan()
        );
    }
}
