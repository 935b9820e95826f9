//! Every integrator over steps or tolerances of many decades, against a reference on which two of
//! them agree.

use std::path::PathBuf;
use std::time::Instant;

use articulated::simulate::{Integrator, IntegratorId, integrators};
use serde::Serialize;

use super::peers::Peers;
use super::subject::{End, How, State, Subject, difference, drift, extent, run};
use crate::accuracy::report::processor;
use crate::against::peers::Peer;
use crate::console::Progress;
use crate::error::Error;
use crate::json::Units;
use crate::native::Stepping;

/// Settings of the measurement.
#[derive(Clone, Debug)]
pub struct Settings {
    /// How often each is timed, five times at most: the fastest counts.
    pub repetitions: u32,
    /// Peer libraries.
    pub peer: Vec<PathBuf>,
    /// A list of peer libraries.
    pub peers_manifest: Option<PathBuf>,
    /// The commit that the report names.
    pub commit: &'static str,
}

/// Of all numbers that have one.
pub(super) const UNITS: Units = Units(&[
    ("seconds", "s"),
    ("agreement", "rad, m, rad/s, m/s: the largest of all"),
    ("extent", "rad, m, rad/s, m/s: the largest of all"),
    ("curves[].slope", "power of the evaluations"),
    ("curves[].samples[].step", "s"),
    ("curves[].samples[].tolerance", "relative and absolute, of rad, m, rad/s, m/s"),
    ("curves[].samples[].wall", "s"),
    ("curves[].samples[].error", "rad, m, rad/s, m/s: the largest of all"),
    ("curves[].samples[].energy", "the largest kinetic or potential energy"),
    ("curves[].samples[].momentum", "the momentum at the start"),
]);

/// All integrators on one motion.
#[derive(Clone, Debug, Serialize)]
pub struct Motion {
    /// The scene.
    pub(crate) scene: String,
    /// How long, s.
    pub(crate) seconds: f64,
    /// Degrees of freedom.
    pub(crate) degrees_of_freedom: usize,
    /// The two that the reference is from.
    pub(crate) references: [String; 2],
    /// The difference of the two: errors below 100 times this are not shown.
    pub(crate) agreement: f64,
    /// The extent of the motion and its speed at its ends: a run with a larger error is lost.
    pub(crate) extent: f64,
    /// Where it was measured.
    pub(crate) processor: String,
    /// With which version of this command.
    pub(crate) version: &'static str,
    /// Built from which commit.
    pub(crate) commit: &'static str,
    /// Units of the numbers.
    pub(crate) units: Units,
    /// Notes on it.
    pub(crate) notes: Vec<String>,
    /// One for each integrator; those of peers come last.
    pub(crate) curves: Vec<Curve>,
}

/// One integrator.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Curve {
    /// Its name.
    pub integrator: String,
    /// Whether it is a peer's.
    pub peer: bool,
    /// Its nominal order.
    pub order: u32,
    /// Observed order: the power of the evaluations by which the error falls over the finest rows,
    /// if it can be determined.
    pub slope: Option<f64>,
    /// Number of rows from which it is determined.
    pub slope_rows: usize,
    /// From the coarsest to the finest.
    pub samples: Vec<Sample>,
}

/// One run.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub(crate) struct Sample {
    /// The step, s, where it is fixed.
    pub step: Option<f64>,
    /// The tolerance, where steps are chosen.
    pub tolerance: Option<f64>,
    /// Evaluations of forward dynamics and of its derivatives.
    pub evaluations: u64,
    /// Of the wall's clock, s.
    pub wall: f64,
    /// The largest difference in the last state, rad, m, rad/s, m/s.
    pub error: f64,
    /// Error of the balance of energy at the end, relative to the largest kinetic or potential
    /// energy.
    pub energy: Option<f64>,
    /// The relative change of the momentum, if no external force acts.
    pub momentum: Option<f64>,
    /// Whether the reference is accurate enough to determine this error.
    pub resolved: bool,
    /// Whether the error exceeds the motion itself, as for unstable steps.
    pub lost: bool,
}

/// Sources of the reference, its last state, and the difference of the two sources.
type Reference = ([String; 2], State, f64);

/// Tolerances and numbers of steps: half a decade apart.
const TOLERANCES: usize = 21;
const STEPS: usize = 9;

/// Errors from here on are too coarse for the law of small steps.
pub(super) const COARSE: f64 = 3e-2;

/// A power this near to the order is the order.
const SHOWN: f64 = 0.3;

/// Measures everything; the fastest repetition of a run counts.
pub(super) fn all(scene: &str, subject: &Subject, peers: &Peers, settings: &Settings) -> Result<Motion, Error> {
    let repetitions = settings.repetitions.min(5) as usize;
    let progress = Progress::new(1 + integrators().len() + peers.count());
    progress.doing("reference".to_owned());
    let (references, end, agreement) = reference(subject)?;
    let mut motion = Motion {
        scene: scene.to_owned(),
        seconds: subject.seconds,
        degrees_of_freedom: subject.model.nv(),
        references,
        agreement,
        extent: extent(subject, &end),
        processor: processor(),
        version: env!("CARGO_PKG_VERSION"),
        commit: settings.commit,
        units: UNITS,
        notes: subject.notes(),
        curves: Vec::new(),
    };
    for integrator in integrators() {
        progress.step();
        progress.doing(integrator.name.to_owned());
        let how: Vec<How> = if integrator.adaptive {
            (0..TOLERANCES).map(|k| How::Tolerance(10f64.powf(-2.0 - 0.5 * k as f64))).collect()
        } else {
            steps().map(|n| How::Step(subject.seconds / n as f64)).collect()
        };
        motion.curves.push(curve(subject, integrator, &how, (&end, agreement), repetitions));
    }
    motion.notes.extend(peers.notes.iter().cloned());
    for peer in &peers.peers {
        for method in peer.methods() {
            progress.step();
            progress.doing(format!("{} {}", peer.engine(), method.name));
            motion.curves.push(curve_of_peer(subject, peer, &method, (&end, agreement), repetitions));
        }
    }
    Ok(motion)
}

/// Numbers of equal steps.
pub(super) fn steps() -> impl Iterator<Item = usize> {
    (0..STEPS).map(|k| (10.0 * 10f64.powf(0.5 * k as f64)).round() as usize)
}

/// The last state by the two integrators that agree best, and how far they are from each other.
pub(super) fn reference(subject: &Subject) -> Result<Reference, Error> {
    let candidates = [
        (IntegratorId::dop853, 1e-13),
        (IntegratorId::dop853, 1e-12),
        (IntegratorId::dopri5, 1e-13),
        (IntegratorId::dopri5, 1e-12),
        (IntegratorId::rodas4, 1e-11),
    ];
    let found: Vec<(IntegratorId, f64, End)> =
        candidates.into_iter().filter_map(|(id, tolerance)| Some((id, tolerance, run(subject, id, How::Tolerance(tolerance))?))).collect();
    let mut best: Option<([String; 2], usize, f64)> = None;
    for (i, a) in found.iter().enumerate() {
        for b in found[i + 1..].iter().filter(|b| b.0 != a.0) {
            let apart = difference(subject, &a.2.state, &b.2.state);
            if best.as_ref().is_none_or(|(.., least)| apart < *least) {
                best = Some(([(a.0, a.1), (b.0, b.1)].map(|(id, t)| format!("{id} at {t:e}")), i, apart));
            }
        }
    }
    let (names, at, apart) =
        best.ok_or_else(|| Error::input(["no two integrators come to the end of this motion: there is no reference".to_owned()]))?;
    Ok((names, found[at].2.state.clone(), apart.max(1e-16)))
}

/// One integrator over its settings, against the last state of the reference and its accuracy.
pub(super) fn curve(
    subject: &Subject,
    integrator: &'static Integrator,
    how: &[How],
    reference: (&State, f64),
    repetitions: usize,
) -> Curve {
    let samples = samples(how, repetitions, &mut |how| Some(sample(subject, reference, *how, &run(subject, integrator.id, *how)?)));
    Curve::new(integrator.name.to_owned(), false, integrator.order, samples)
}

impl Curve {
    /// With the order that its samples show.
    pub(super) fn new(integrator: String, peer: bool, order: u32, samples: Vec<Sample>) -> Self {
        let finest = finest(&samples);
        let slope = slope(&samples).and_then(|_| power(&finest));
        let slope_rows = if slope.is_some() { finest.len() } else { 0 };
        Self { integrator, peer, order, slope, slope_rows, samples }
    }

    /// Whether the power that was measured is the order.
    pub(super) fn shows_order(&self) -> bool {
        self.slope.is_some_and(|s| (s - f64::from(self.order)).abs() <= SHOWN)
    }
}

/// A sample for each setting, the fastest of several, until two errors are below the accuracy of
/// the reference.
pub(super) fn samples<T>(settings: &[T], repetitions: usize, take: &mut dyn FnMut(&T) -> Option<Sample>) -> Vec<Sample> {
    let mut samples: Vec<Sample> = Vec::new();
    for setting in settings {
        if samples.iter().filter(|s| !s.resolved).count() >= 2 {
            break;
        }
        let Some(mut best) = take(setting) else { continue };
        for _ in 1..repetitions {
            best.wall = best.wall.min(take(setting).map_or(f64::INFINITY, |again| again.wall));
        }
        samples.push(best);
    }
    samples
}

/// The result of a run.
pub(super) fn sample(subject: &Subject, (end, agreement): (&State, f64), how: How, run: &End) -> Sample {
    let error = difference(subject, &run.state, end);
    let (step, tolerance) = match how {
        How::Step(h) => (Some(h), None),
        How::Tolerance(t) => (None, Some(t)),
    };
    let End { evaluations, wall, energy, momentum, .. } = *run;
    let (resolved, lost) = (error >= 100.0 * agreement, error > extent(subject, end));
    Sample { step, tolerance, evaluations, wall, error, energy, momentum, resolved, lost }
}

/// The logarithms of evaluations and errors of the samples above the accuracy of the reference,
/// without the first coarse ones.
fn points(samples: &[Sample]) -> Vec<(f64, f64)> {
    let within = |s: &&Sample| s.resolved && s.error > 0.0 && s.error < COARSE;
    samples.iter().filter(within).map(|s| ((s.evaluations as f64).log10(), s.error.log10())).collect()
}

/// The finer half of the points, three at least: long steps hide the order.
fn finest(samples: &[Sample]) -> Vec<(f64, f64)> {
    let points = points(samples);
    let count = points.len().div_ceil(2).max(3).min(points.len());
    points[points.len() - count..].to_vec()
}

/// Observed order over all samples whose error can be determined.
pub(super) fn slope(samples: &[Sample]) -> Option<f64> {
    let points = points(samples);
    let wide = points.iter().map(|p| p.0).fold(f64::NEG_INFINITY, f64::max) - points.iter().map(|p| p.0).fold(f64::INFINITY, f64::min);
    if wide < 0.5 { None } else { power(&points) }
}

/// The negative slope of a straight line through the points, which must be at least three with
/// different abscissas.
fn power(points: &[(f64, f64)]) -> Option<f64> {
    let n = points.len() as f64;
    let (x, y) = (points.iter().map(|p| p.0).sum::<f64>() / n, points.iter().map(|p| p.1).sum::<f64>() / n);
    let (xy, xx) = points.iter().fold((0.0, 0.0), |(xy, xx), p| (xy + (p.0 - x) * (p.1 - y), xx + (p.0 - x) * (p.0 - x)));
    (points.len() >= 3 && xx > 0.0).then(|| -xy / xx)
}

/// A peer's method over numbers of steps.
fn curve_of_peer(subject: &Subject, peer: &Peer, method: &Stepping, reference: (&State, f64), repetitions: usize) -> Curve {
    let how: Vec<usize> = steps().collect();
    let samples = samples(&how, repetitions, &mut |n| {
        let clock = Instant::now();
        let state = peer.go(method, *n)?;
        let wall = clock.elapsed().as_secs_f64();
        let drift = drift(subject, &state);
        let evaluations = u64::from(method.evaluations) * *n as u64;
        let end = End { state, evaluations, wall, energy: drift.map(|d| d.0), momentum: drift.and_then(|d| d.1) };
        Some(sample(subject, reference, How::Step(subject.seconds / *n as f64), &end))
    });
    let integrator = format!("{} {}", peer.engine(), method.name);
    Curve::new(integrator, true, method.order, samples)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples(error: impl Fn(f64) -> f64, counts: &[u64]) -> Vec<Sample> {
        let sample = |n: &u64| Sample { evaluations: *n, error: error(*n as f64), resolved: true, ..Sample::default() };
        counts.iter().map(sample).collect()
    }

    #[test]
    fn a_power_law_has_its_power_as_slope() {
        let samples = samples(|n| 3.0 * n.powi(-4), &[10, 30, 100, 300, 1000]);
        assert!((slope(&samples).unwrap() - 4.0).abs() < 1e-12);
        assert!(slope(&samples[..1]).is_none());
        let curve = Curve::new("rk4".into(), false, 4, samples[..2].to_vec());
        assert!(curve.slope.is_none() && curve.slope_rows == 0 && !curve.shows_order());
    }

    #[test]
    fn long_steps_do_not_count_for_the_order() {
        // A term of order 7 hides the order until steps are short.
        let error = |n: f64| 3.0 * n.powi(-4) + 3e5 * n.powi(-7);
        let curve = Curve::new("rk4".into(), false, 4, samples(error, &[10, 20, 40, 80, 160, 320, 640]));
        assert_eq!(curve.slope_rows, 3);
        assert!((curve.slope.unwrap() - 4.0).abs() < 0.1 && curve.shows_order(), "{curve:?}");
        assert!(slope(&curve.samples).unwrap() > 4.5);
        let coarse = Curve::new("rk4".into(), false, 4, samples(error, &[10, 20, 30, 40, 50, 60]));
        assert!(!coarse.shows_order(), "{coarse:?}");
    }

    #[test]
    fn what_the_reference_cannot_tell_does_not_count_for_the_order() {
        let mut samples = samples(|n| n.powi(-2), &[10, 30, 100, 300, 1000]);
        samples.extend([3000, 10_000].map(|evaluations| Sample { evaluations, error: 1e-6, resolved: false, ..Sample::default() }));
        let curve = Curve::new("midpoint".into(), false, 2, samples);
        assert!((curve.slope.unwrap() - 2.0).abs() < 1e-12 && curve.slope_rows == 3, "{curve:?}");
    }
}
