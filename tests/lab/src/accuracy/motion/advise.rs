//! The cheapest runs that are accurate enough.

use serde::Serialize;

use super::{Motion, Sample};
use crate::json::Units;

/// Of all numbers that have one.
pub(super) const UNITS: Units = Units(&[
    ("wish", "rad, m, rad/s, m/s: the largest of all"),
    ("runs[].step", "s"),
    ("runs[].tolerance", "relative and absolute, of rad, m, rad/s, m/s"),
    ("runs[].wall", "s"),
    ("runs[].error", "rad, m, rad/s, m/s: the largest of all"),
    ("runs[].energy", "the largest kinetic or potential energy"),
    ("runs[].momentum", "the momentum at the start"),
]);

/// The recommended integrator for one motion.
#[derive(Clone, Debug, Serialize)]
pub struct Advice<'a> {
    scene: &'a str,
    wish: f64,
    units: Units,
    /// The runs with the fewest evaluations and with the least time, which may be the same; empty
    /// if no measured run is accurate enough.
    pub(super) runs: Vec<Run<'a>>,
}

/// An integrator with its setting and its results.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct Run<'a> {
    /// The minimal quantity: `evaluations` or `wall`.
    least: &'static str,
    pub(super) integrator: &'a str,
    #[serde(flatten)]
    pub(super) sample: &'a Sample,
}

/// By evaluations and by the clock; only runs that are not lucky hits count.
pub(super) fn all(m: &Motion, wish: f64) -> Advice<'_> {
    let own = m.curves.iter().filter(|c| !c.peer);
    let fit: Vec<(&str, &Sample)> = own.flat_map(|c| lasting(&c.samples, wish).iter().map(|s| (c.integrator.as_str(), s))).collect();
    let by_evaluations = fit.iter().copied().min_by_key(|(_, s)| s.evaluations);
    let by_time = fit.iter().copied().min_by(|a, b| a.1.wall.total_cmp(&b.1.wall));
    let found = [by_evaluations.map(|r| ("evaluations", r)), by_time.map(|r| ("wall", r))];
    let runs = found.into_iter().flatten().map(|(least, (integrator, sample))| Run { least, integrator, sample }).collect();
    Advice { scene: &m.scene, wish, units: UNITS, runs }
}

/// The finest runs that all reach the error; at least two. A run is a lucky hit if a finer one does
/// not reach it.
fn lasting(samples: &[Sample], wish: f64) -> &[Sample] {
    let from = samples.iter().rposition(|s| s.error.is_nan() || s.error > wish).map_or(0, |k| k + 1);
    if samples.len() - from >= 2 { &samples[from..] } else { &[] }
}
