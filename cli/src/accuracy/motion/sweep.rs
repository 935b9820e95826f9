//! Every integrator over steps or tolerances of many decades, against a reference that two of them agree on.

use std::time::Instant;

use articulated::simulate::{Constant, Integrator, IntegratorId, Output, Settings, Simulation, Stiffness, integrators};
use articulated_core::algorithm::{FunctionId, Workspace};
use articulated_core::dynamics::Dynamics;
use articulated_core::model::Model;
use serde::Serialize;

use crate::console::Progress;
use crate::failure::Failure;

/// What moves.
#[derive(Clone, Debug)]
pub(crate) struct Subject {
    /// The robot with its effects.
    pub model: Model<f64>,
    /// Where it starts.
    pub q: Vec<f64>,
    /// How it moves there.
    pub v: Vec<f64>,
    /// What acts all the time.
    pub torque: Vec<f64>,
    /// How long, s.
    pub seconds: f64,
    /// Whether nothing acts on it from outside, so that its momentum stays.
    pub free: bool,
}

/// All integrators on one motion.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Motion {
    /// The scene.
    pub scene: String,
    /// How long, s.
    pub seconds: f64,
    /// Degrees of freedom.
    pub degrees_of_freedom: usize,
    /// The two that the reference is from.
    pub references: [String; 2],
    /// How far they are from each other: nothing below 100 times this is shown.
    pub agreement: f64,
    /// One an integrator.
    pub curves: Vec<Curve>,
}

/// One integrator.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Curve {
    /// Its name.
    pub integrator: &'static str,
    /// Its nominal order.
    pub order: u32,
    /// How fast the error falls with the evaluations, where it can be told.
    pub slope: Option<f64>,
    /// From the coarsest to the finest.
    pub samples: Vec<Sample>,
}

/// One run.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Sample {
    /// The step, s, where it is fixed.
    pub step: Option<f64>,
    /// The tolerance, where steps are chosen.
    pub tolerance: Option<f64>,
    /// Evaluations of forward dynamics and of its derivatives.
    pub evaluations: u64,
    /// Of the wall's clock, s.
    pub wall: f64,
    /// The largest difference of a number of the last state, rad, m, rad/s, m/s.
    pub error: f64,
    /// What energy is missing or too much at the end, relative to the largest kinetic or potential energy.
    pub energy: Option<f64>,
    /// The change of the momentum, relative to it, where nothing acts from outside.
    pub momentum: Option<f64>,
    /// Whether the reference can tell this error.
    pub told: bool,
}

/// q and v.
type State = (Vec<f64>, Vec<f64>);

/// Who the reference is from, the last state, and how far the two are from each other.
type Reference = ([String; 2], State, f64);

/// How the steps of a run are chosen.
#[derive(Clone, Copy, Debug)]
pub(super) enum How {
    /// All of this length, s.
    Step(f64),
    /// By this tolerance.
    Tolerance(f64),
}

/// Tolerances and numbers of steps: half a decade apart.
const TOLERANCES: usize = 21;
const STEPS: usize = 9;

/// Errors from here on are too coarse for the law of small steps.
const COARSE: f64 = 3e-2;

/// A run that takes more steps is given up.
const MOST: u64 = 1_000_000;

/// Everything: each run as often as told, the fastest counts.
pub(super) fn all(scene: &str, subject: &Subject, repetitions: usize) -> Result<Motion, Failure> {
    let progress = Progress::new(1 + integrators().len());
    progress.doing("reference".to_owned());
    let (references, end, agreement) = reference(subject)?;
    let mut curves = Vec::new();
    for integrator in integrators() {
        progress.step();
        progress.doing(integrator.name.to_owned());
        let how: Vec<How> = if integrator.adaptive {
            (0..TOLERANCES).map(|k| How::Tolerance(10f64.powf(-2.0 - 0.5 * k as f64))).collect()
        } else {
            (0..STEPS).map(|k| How::Step(subject.seconds / (10.0 * 10f64.powf(0.5 * k as f64)).round())).collect()
        };
        curves.push(curve(subject, integrator, &how, &end, agreement, repetitions));
    }
    let (scene, seconds, degrees_of_freedom) = (scene.to_owned(), subject.seconds, subject.model.nv);
    Ok(Motion { scene, seconds, degrees_of_freedom, references, agreement, curves })
}

/// The last state by the two integrators that agree best, and how far they are from each other.
pub(super) fn reference(subject: &Subject) -> Result<Reference, Failure> {
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
        best.ok_or_else(|| Failure::input(["no two integrators come to the end of this motion: there is no reference".to_owned()]))?;
    Ok((names, found[at].2.state.clone(), apart.max(1e-16)))
}

/// One integrator over its settings.
pub(super) fn curve(
    subject: &Subject,
    integrator: &'static Integrator,
    how: &[How],
    end: &State,
    agreement: f64,
    repetitions: usize,
) -> Curve {
    let mut samples: Vec<Sample> = Vec::new();
    for how in how {
        // Twice beyond what the reference can tell is enough.
        if samples.iter().filter(|s| !s.told).count() >= 2 {
            break;
        }
        let Some(mut best) = run(subject, integrator.id, *how) else { continue };
        for _ in 1..repetitions {
            best.wall = best.wall.min(run(subject, integrator.id, *how).map_or(f64::INFINITY, |r| r.wall));
        }
        let error = difference(subject, &best.state, end);
        let (step, tolerance) = match how {
            How::Step(h) => (Some(*h), None),
            How::Tolerance(t) => (None, Some(*t)),
        };
        let End { evaluations, wall, energy, momentum, .. } = best;
        samples.push(Sample { step, tolerance, evaluations, wall, error, energy, momentum, told: error >= 100.0 * agreement });
    }
    let slope = slope(&samples);
    Curve { integrator: integrator.name, order: integrator.order, slope, samples }
}

/// By which power of the evaluations the error falls: a line through the logarithms, over the samples that the reference can tell and that are past the first coarse ones.
pub(super) fn slope(samples: &[Sample]) -> Option<f64> {
    let points: Vec<(f64, f64)> =
        samples.iter().filter(|s| s.told && s.error < COARSE).map(|s| ((s.evaluations as f64).log10(), s.error.log10())).collect();
    let wide = points.iter().map(|p| p.0).fold(f64::NEG_INFINITY, f64::max) - points.iter().map(|p| p.0).fold(f64::INFINITY, f64::min);
    if points.len() < 3 || wide < 0.5 {
        return None;
    }
    let n = points.len() as f64;
    let (x, y) = (points.iter().map(|p| p.0).sum::<f64>() / n, points.iter().map(|p| p.1).sum::<f64>() / n);
    let (xy, xx) = points.iter().fold((0.0, 0.0), |(xy, xx), p| (xy + (p.0 - x) * (p.1 - y), xx + (p.0 - x) * (p.0 - x)));
    Some(-xy / xx)
}

/// Where a run ended.
struct End {
    state: State,
    evaluations: u64,
    wall: f64,
    energy: Option<f64>,
    momentum: Option<f64>,
}

/// To the end; `None` if it does not get there.
fn run(subject: &Subject, id: IntegratorId, how: How) -> Option<End> {
    let mut settings = Settings {
        integrator: id,
        end: subject.seconds,
        output: Output::Ends,
        stiffness: Stiffness::Note,
        max_steps: MOST,
        ..Settings::default()
    };
    match how {
        How::Step(h) => settings.step = Some(h),
        How::Tolerance(t) => (settings.rtol, settings.atol) = (t, t),
    }
    let mut simulation = Simulation::new(&subject.model, settings).ok()?;
    let mut control = Constant::new(subject.torque.clone());
    let clock = Instant::now();
    let r = simulation.run(&subject.q, &subject.v, &mut control, &mut []).ok()?;
    let wall = clock.elapsed().as_secs_f64();
    let last = r.len().checked_sub(1)?;
    let state = (r.q_at(last).to_vec(), r.v_at(last).to_vec());
    if state.0.iter().chain(&state.1).any(|x| !x.is_finite()) {
        return None;
    }
    let size = [0, last].iter().filter_map(|k| Some(r.kinetic.get(*k)?.abs().max(r.potential.get(*k)?.abs()))).fold(0.0, f64::max);
    let energy = r.imbalance(last).map(|e| e.abs() / size.max(1e-12));
    let momentum = subject.free.then(|| Some((r.momentum_at(0)?, r.momentum_at(last)?))).flatten().map(|(a, b)| {
        let norm = a.iter().map(|x| x * x).sum::<f64>().sqrt();
        a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / norm.max(1e-12)
    });
    Some(End { state, evaluations: r.counts.evaluations + r.counts.derivatives, wall, energy, momentum })
}

/// The largest difference of two states: of configurations along the manifold.
fn difference(subject: &Subject, a: &State, b: &State) -> f64 {
    let mut apart = vec![0.0; subject.model.nv];
    let told = subject.model.call(FunctionId::difference, &mut Workspace::new(&subject.model), &[&a.0, &b.0], &mut apart);
    let rates = a.1.iter().zip(&b.1).map(|(a, b)| (a - b).abs());
    let all = apart.iter().map(|x| x.abs()).chain(rates).fold(0.0, |a: f64, b| if b.is_nan() { b } else { a.max(b) });
    if told.is_ok() { all } else { f64::NAN }
}

#[cfg(test)]
mod tests {
    use super::super::scene::find;
    use super::*;

    /// From the coarsest to the finest, each twice as many steps as the last.
    fn sweep(subject: &Subject, from: u32, times: u32) -> Vec<How> {
        (0..times).map(|k| How::Step(subject.seconds / f64::from(from << k))).collect()
    }

    /// Higher orders reach rounding before their law of small steps is all there is: their errors fall faster until then. Implicit steps take fewer rounds
    /// the shorter they are.
    #[test]
    fn errors_fall_with_evaluations_as_the_order_says() {
        let (_, mut subject) = find("pendulum").unwrap();
        (subject.q, subject.v, subject.seconds) = (vec![1.5], vec![1.0], 3.0);
        let (names, end, agreement) = reference(&subject).unwrap();
        assert!(names[0] != names[1] && agreement < 1e-12, "{names:?} {agreement:e}");
        for integrator in integrators() {
            let (from, times, decades, over) = match integrator.id {
                IntegratorId::semi_implicit_euler => (400, 6, 1.5, 0.2),
                IntegratorId::rk4 => (96, 6, 1.2, 0.2),
                IntegratorId::dopri5 => (24, 5, 0.85, 0.6),
                IntegratorId::dop853 => (9, 4, 0.5, 0.6),
                IntegratorId::rodas4 => (48, 6, 0.85, 0.4),
                IntegratorId::lie_midpoint => (400, 6, 1.3, 0.35),
            };
            let curve = curve(&subject, integrator, &sweep(&subject, from, times), &end, agreement, 1);
            let seen: Vec<(u64, f64)> = curve.samples.iter().filter(|s| s.told).map(|s| (s.evaluations, s.error)).collect();
            let (slope, order) = (curve.slope.unwrap_or_default(), f64::from(integrator.order));
            assert!((order - 0.2..=order + over).contains(&slope), "{}: {slope} {seen:?}", integrator.name);
            assert!((seen[seen.len() - 1].0 as f64 / seen[0].0 as f64).log10() >= decades, "{}: {seen:?}", integrator.name);
        }
    }

    #[test]
    fn a_power_law_has_its_power_as_slope() {
        let sample = |n: u64| {
            let error = 3.0 * (n as f64).powi(-4);
            Sample { step: None, tolerance: None, evaluations: n, wall: 0.0, error, energy: None, momentum: None, told: true }
        };
        let samples: Vec<Sample> = [10, 30, 100, 300, 1000].into_iter().map(sample).collect();
        assert!((slope(&samples).unwrap() - 4.0).abs() < 1e-12);
        assert!(slope(&samples[..1]).is_none());
    }
}
