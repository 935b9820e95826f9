//! A scene's motion as the command runs it: with warnings, progress, and the names that its outputs
//! need.

use std::time::Duration;

use articulated::FunctionId;
use articulated::simulate::{Balance, Counts, Recording as Run, Settings};
use articulated_lab::session::{Code, Session};
use articulated_motion::{Creep, Ending, InitialState, Occurrence, Outcome, Slide};

use super::constrained::Constrained;
use super::method::Method;
use super::monitor::RunMonitor;
use super::recording::{EventRecord, Recording};
use crate::console::{self, Progress};
use crate::failure::Failure;

/// The result.
pub(super) struct Motion {
    pub(super) recording: Recording,
    pub(super) counts: Counts,
    /// Over all steps.
    pub(super) balance: Balance,
    /// Creep where smoothed friction should hold.
    pub(super) creep: Vec<Creep>,
    /// Links that move although friction would hold them.
    pub(super) slides: Vec<Slide>,
    /// The time that was reached, s.
    pub(super) reached: f64,
    pub(super) ending: Ending,
    /// Of the run alone.
    pub(super) wall: Duration,
    /// Kinetic energy that the ball of the scene's impact got, J, if it was hit.
    pub(super) ball: Option<f64>,
    /// The reason why it did not reach its end.
    pub(super) error: Option<String>,
    /// Warnings about its initial state, its events and its steps.
    pub(super) warnings: Vec<String>,
    /// The steps of a robot's file, in place of an integrator.
    pub(super) of_file: Option<Method>,
    /// How limits, dry friction and contacts of the file were kept, if it has them.
    pub(super) constraints: Option<Constrained>,
}

/// Checks that torques determine accelerations: generic code is refused for the same robots as
/// generated code.
pub(super) fn solvable(session: &Session) -> Result<(), Failure> {
    let (file, model) = (&session.request.file, &session.model);
    Ok(articulated_codegen::defined(file, model, &articulated_codegen::massless(model), FunctionId::forward_dynamics.row::<f64>())?)
}

/// Runs it by this code. `go_on` is called after each step, and returns false to stop the run.
pub(super) fn run(
    session: &Session,
    initial: &InitialState,
    code: &dyn Code,
    settings: &Settings,
    progress: &Progress,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Motion, Failure> {
    let mut monitor = RunMonitor::new(session, settings, progress);
    let (outcome, unavailable) = code.run(session, initial, settings, &mut |t, counts| {
        monitor.look(t, counts);
        go_on()
    })?;
    let Outcome { recording, occurrences, creep, penetrations, slides, rolling, ending, reached, ball, error, wall } = outcome;
    let (counts, balance) = (recording.counts, recording.balance.unwrap_or_default());
    let error = error.map(|e| e.to_string());
    let of_slides = slides.iter().map(ToString::to_string);
    let of_rolling = rolling.iter().map(ToString::to_string);
    let of_steps: Vec<String> = session.warning_of_penetrations(&penetrations).into_iter().chain(of_slides).chain(of_rolling).collect();
    of_steps.iter().for_each(|line| console::warn(line));
    let warnings = session.warnings(initial).into_iter().chain(unavailable).chain(of_steps).collect();
    Ok(Motion {
        recording: named_recording(session, recording, occurrences),
        counts,
        balance,
        creep,
        slides,
        reached,
        ending,
        wall,
        ball,
        error,
        warnings,
        of_file: None,
        constraints: None,
    })
}

/// The library's recording with names.
fn named_recording(session: &Session, run: Run, occurrences: Vec<Occurrence>) -> Recording {
    let n = run.len();
    let whole = |x: Vec<f64>| if x.len() == n { x } else { vec![0.0; n] };
    // Without mass there is no centre of mass: rotors have no momentum here.
    let heavy = session.model.moving_mass() > 0.0;
    let momentum = (0..n).map(|k| run.momentum_at(k).filter(|_| heavy).and_then(|p| p.try_into().ok()).unwrap_or_default()).collect();
    Recording {
        events: occurrences.into_iter().map(EventRecord::from).collect(),
        t: run.t,
        q: run.q,
        v: run.v,
        tau: run.tau,
        kinetic: whole(run.kinetic),
        potential: whole(run.potential),
        work: whole(run.work),
        dissipated: whole(run.dissipated),
        from_events: whole(run.from_events),
        momentum,
        ..Recording::of(&session.model)
    }
}
