//! A scene's motion as the command runs it: with warnings, progress, and the names that its outputs need.

use std::path::Path;
use std::time::Duration;

use articulated::simulate::{Balance, Counts, IntegratorId, Recording as Run, Settings};
use articulated::{Dynamics, FunctionId};
use articulated_codegen::Generated;
use articulated_motion::{Begin, Creep, Ending, Happening as Happened, Outcome, Sunk};
use articulated_scene::beyond_sense;

use super::recording::{Happening, Recording};
use super::stage::Stage;
use super::watch::Watch;
use crate::console::{self, Progress};
use crate::failure::Failure;
use crate::robot::has_room;

/// What came of it.
pub(super) struct Motion {
    pub(super) recording: Recording,
    pub(super) counts: Counts,
    /// Over all steps.
    pub(super) balance: Balance,
    /// What smoothed friction did not hold.
    pub(super) creep: Vec<Creep>,
    /// The time that was reached, s.
    pub(super) reached: f64,
    pub(super) ending: Ending,
    /// Of the run alone.
    pub(super) wall: Duration,
    /// Kinetic energy that the ball of the scene's impact got, J, if it was hit.
    pub(super) ball: Option<f64>,
    /// Why it did not go on to its end.
    pub(super) error: Option<String>,
    /// What is odd about its start and what it looks out for.
    pub(super) warnings: Vec<String>,
}

/// What is odd about the state at the start.
fn odd(stage: &Stage, begin: &Begin) -> Vec<String> {
    let beyond = stage.beyond(&begin.q).iter().map(ToString::to_string).collect::<Vec<_>>();
    let file = &stage.scene.file;
    let senseless = beyond_sense(&stage.model, &begin.q).into_iter().map(|line| format!("{file}: initial: {line}"));
    let sunk = summary_of_sunk(&stage.sunk(&begin.q));
    beyond.into_iter().chain(senseless).chain(sunk).chain(stage.warning_of_penetrations_at_start(&begin.q)).collect()
}

/// The deepest contact that starts under its plane, and how many more there are.
fn summary_of_sunk(sunk: &[Sunk]) -> Option<String> {
    let deepest = sunk.iter().max_by(|a, b| a.depth.total_cmp(&b.depth))?;
    let more = if sunk.len() == 1 { String::new() } else { format!(" (and {} more, less deep)", sunk.len() - 1) };
    Some(format!("{deepest}{more}"))
}

/// Start and control as the scene has them, with a warning of what is odd. Errors: all that do not fit the robot, and tables that cannot be read.
pub(crate) fn begin(stage: &Stage) -> Result<Begin, Failure> {
    let begin = stage.begin()?;
    odd(stage, &begin).iter().for_each(|line| console::warn(line));
    Ok(begin)
}

/// The warnings about a scene's motion. Errors: everything that keeps the motion from starting, or
/// else the error of its first step.
pub(crate) fn look_over(scene: &Path) -> Result<Vec<String>, Failure> {
    let stage = Stage::open(scene)?;
    let (begin, without) = Failure::both(stage.begin().map_err(Failure::from), looked_for(&stage))?;
    if stage.scene.simulation.is_some() {
        let mut motion = stage.motion(&stage.model, &stage.frame_names(), stage.settings()?)?;
        if let Some(error) = motion.first_step(&begin)? {
            return Err(Failure::input([format!("{}: the motion ends with its first step: {error}", stage.scene.file)]));
        }
    }
    Ok(odd(&stage, &begin).into_iter().chain(without).collect())
}

/// What the scene looks for and has not. Errors: all that its motion would not begin for but its start; who simulates a scene without settings gives its end.
fn looked_for(stage: &Stage) -> Result<Vec<String>, Failure> {
    if stage.scene.simulation.is_none() {
        return Ok(Vec::new());
    }
    has_room(&stage.scene.file, stage.model.nv)?;
    let motion = stage.settings().and_then(|settings| stage.motion(&stage.model, &stage.frame_names(), settings));
    let (motion, ()) = Failure::both(motion.map_err(Failure::from), solvable(stage))?;
    Ok(motion.without().iter().map(ToString::to_string).collect())
}

/// Whether torques determine accelerations at all. What generated code would be refused for, generic code is.
pub(super) fn solvable(stage: &Stage) -> Result<(), Failure> {
    let (file, model) = (&stage.request.file, &stage.model);
    Ok(articulated_codegen::defined(file, model, &articulated_codegen::massless(model), FunctionId::forward_dynamics.row::<f64>())?)
}

/// Runs it on a robot whose functions give these frames.
pub(super) fn run<R: Dynamics<f64>, S: AsRef<str>>(
    stage: &Stage,
    begin: &Begin,
    (robot, frames): (&R, &[S]),
    settings: &Settings,
    progress: &Progress,
) -> Result<Motion, Failure> {
    let mut motion = stage.motion(robot, frames, settings.clone())?;
    let without: Vec<String> = motion.without().iter().map(ToString::to_string).collect();
    without.iter().for_each(|line| console::warn(line));
    let mut watch = Watch::new(stage, settings, progress);
    let outcome = motion.run(begin, &mut |t, counts| {
        watch.look(t, counts);
        true
    })?;
    let Outcome { recording, happenings, creep, ending, reached, ball, error, wall } = outcome;
    let (counts, balance) = (recording.counts, recording.balance.unwrap_or_default());
    let error = error.map(|e| e.to_string());
    let penetrations = stage.warning_of_penetrations(&recording.t, &recording.q);
    penetrations.iter().for_each(|line| console::warn(line));
    let warnings = odd(stage, begin).into_iter().chain(without).chain(penetrations).collect();
    Ok(Motion { recording: told(stage, recording, happenings), counts, balance, creep, reached, ending, wall, ball, error, warnings })
}

/// The library's recording with names.
fn told(stage: &Stage, run: Run, happenings: Vec<Happened>) -> Recording {
    let n = run.len();
    let whole = |x: Vec<f64>| if x.len() == n { x } else { vec![0.0; n] };
    // Without mass there is no centre of it: rotors have no momentum here.
    let heavy = stage.model.moving_mass() > 0.0;
    let momentum = (0..n).map(|k| run.momentum_at(k).filter(|_| heavy).and_then(|p| p.try_into().ok()).unwrap_or_default()).collect();
    Recording {
        events: happenings.into_iter().map(Happening::from).collect(),
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
        ..Recording::of(&stage.model)
    }
}

/// The code that a simulation of the scene needs, and the frames that it gives.
pub(super) fn generate(stage: &Stage, integrator: IntegratorId) -> Result<(Generated, Vec<String>), Failure> {
    stage.is_of_doubles()?;
    let frames = stage.frames();
    let mut request = stage.request.clone();
    request.options.functions = stage.functions(integrator).into_iter().map(Into::into).collect();
    request.set_frames(&frames);
    (request.options.rust_mut().runtime, request.options.stages) = (None, false);
    (request.options.parameters, request.options.rust_mut().batch) = (Vec::new(), Vec::new());
    Ok((articulated_codegen::generate(&request)?, frames))
}
