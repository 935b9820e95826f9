//! The moving robot, and its run to the end.

use std::time::Instant;

use articulated::simulate::{IntegratorId, Output, Settings, Simulation, Stiffness};
use articulated_core::algorithm::{FunctionId, Workspace};
use articulated_core::dynamics::Dynamics;
use articulated_core::model::Model;
use articulated_motion::Drive;
use articulated_scene::Controller;

/// Maximum number of steps of a run.
const MOST: u64 = 1_000_000;

/// The moving robot.
#[derive(Clone, Debug)]
pub(crate) struct Subject {
    /// The robot with its effects.
    pub model: Model<f64>,
    /// Where it starts.
    pub q: Vec<f64>,
    /// How it moves there.
    pub v: Vec<f64>,
    /// Its control, and the time between samples, s, if it is sampled.
    pub control: (Controller, Option<f64>),
    /// From when, s.
    pub start: f64,
    /// How long, s.
    pub seconds: f64,
    /// Whether no external force acts on it, so that its momentum is constant.
    pub free: bool,
}

/// q and v.
pub(super) type State = (Vec<f64>, Vec<f64>);

/// The choice of the steps of a run.
#[derive(Clone, Copy, Debug)]
pub(super) enum How {
    /// All of this length, s.
    Step(f64),
    /// By this tolerance.
    Tolerance(f64),
}

/// Where a run ended.
pub(super) struct End {
    pub(super) state: State,
    pub(super) evaluations: u64,
    pub(super) wall: f64,
    /// Missing or too much, relative to the largest kinetic or potential energy at the ends.
    pub(super) energy: Option<f64>,
    /// The relative change of momentum, if no external force acts.
    pub(super) momentum: Option<f64>,
}

/// Runs to the end; `None` if it does not reach it.
pub(super) fn run(subject: &Subject, id: IntegratorId, how: How) -> Option<End> {
    let mut settings = Settings {
        integrator: id,
        start: subject.start,
        end: subject.start + subject.seconds,
        output: Output::Ends,
        stiffness: Stiffness::Note,
        max_steps: MOST,
        ..Settings::default()
    };
    match how {
        How::Step(h) => settings.step = Some(h),
        How::Tolerance(t) => (settings.rtol, settings.atol) = (t, t),
    }
    let mut simulation = Simulation::new(&subject.model, settings).ok()?.with_energy_balance();
    let (controller, period) = &subject.control;
    let mut control = Drive::new(&subject.model, controller, *period).ok()?;
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
    let momentum = subject.free.then(|| Some(change(r.momentum_at(0)?, r.momentum_at(last)?))).flatten();
    Some(End { state, evaluations: r.counts.evaluations + r.counts.derivatives, wall, energy, momentum })
}

/// How much a vector changes, relative to its norm.
fn change(a: &[f64], b: &[f64]) -> f64 {
    let norm = a.iter().map(|x| x * x).sum::<f64>().sqrt();
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / norm.max(1e-12)
}

/// Energy and momentum of a motion under gravity alone, from its last state: as in [`End`].
pub(super) fn drift(subject: &Subject, end: &State) -> Option<(f64, Option<f64>)> {
    let (model, mut ws) = (&subject.model, Workspace::new(&subject.model));
    let mut at = |q: &[f64], v: &[f64]| {
        let (mut kinetic, mut potential, mut momentum) = ([0.0], [0.0], vec![0.0; 6]);
        model.call(FunctionId::kinetic_energy, &mut ws, &[q, v], &mut kinetic).ok()?;
        model.call(FunctionId::potential_energy, &mut ws, &[q], &mut potential).ok()?;
        let told = subject.free && model.call(FunctionId::centroidal_momentum, &mut ws, &[q, v], &mut momentum).is_ok();
        Some((kinetic[0], potential[0], told.then_some(momentum)))
    };
    let (a, b) = (at(&subject.q, &subject.v)?, at(&end.0, &end.1)?);
    let size = [a.0, a.1, b.0, b.1].into_iter().map(f64::abs).fold(1e-12, f64::max);
    Some(((b.0 + b.1 - a.0 - a.1).abs() / size, a.2.zip(b.2).map(|(a, b)| change(&a, &b))))
}

/// The extent of the motion and its speed at its ends: the largest number of all, at least 1 rad,
/// m, and the same per second.
pub(super) fn extent(subject: &Subject, end: &State) -> f64 {
    let way = difference(subject, &(subject.q.clone(), end.1.clone()), end);
    subject.v.iter().chain(&end.1).map(|v| v.abs()).fold(way.max(1.0), f64::max)
}

/// The largest difference of two states: of configurations along the manifold.
pub(super) fn difference(subject: &Subject, a: &State, b: &State) -> f64 {
    let mut apart = vec![0.0; subject.model.nv()];
    let told = subject.model.call(FunctionId::difference, &mut Workspace::new(&subject.model), &[&a.0, &b.0], &mut apart);
    let rates = a.1.iter().zip(&b.1).map(|(a, b)| (a - b).abs());
    let all = apart.iter().map(|x| x.abs()).chain(rates).fold(0.0, |a: f64, b| if b.is_nan() { b } else { a.max(b) });
    if told.is_ok() { all } else { f64::NAN }
}
