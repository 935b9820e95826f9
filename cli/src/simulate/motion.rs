//! A scene's motion: robot, state, control and events put together, and run.

use std::time::{Duration, Instant};

use articulated::Dynamics;
use articulated::simulate::{Counts, Ended, Hit, IntegratorId, Recording as Run, Settings, SimulateError, Simulation};
use articulated_codegen::Generated;
use articulated_core::description::JointKind;
use articulated_core::model::JointInfo;
use articulated_scene::{Controller, Watched, When};

use super::drive::Drive;
use super::recording::{Happening, Recording};
use super::settings;
use super::stage::Stage;
use super::watched::{self, Watch};
use crate::console::{self, Progress};
use crate::failure::Failure;

/// What came of it.
pub(super) struct Motion {
    pub(super) recording: Recording,
    pub(super) counts: Counts,
    /// The time that was reached, s.
    pub(super) reached: f64,
    /// In a few words.
    pub(super) ended: String,
    /// Of the run alone.
    pub(super) wall: Duration,
    /// Kinetic energy that the ball of the scene's impact got, J, if it was hit.
    pub(super) ball: Option<f64>,
    /// Why it did not go on to its end.
    pub(super) error: Option<String>,
}

/// The state that it starts from, and what drives it.
pub(crate) struct Begin {
    pub(crate) q: Vec<f64>,
    pub(crate) v: Vec<f64>,
    pub(crate) controller: Controller,
}

/// Start and control as the scene has them. Errors: all that do not fit the robot, and tables that cannot be read.
pub(crate) fn begin(stage: &Stage) -> Result<Begin, Failure> {
    let begin = begin_quietly(stage)?;
    beyond_limits(stage, &begin.q).iter().for_each(|line| console::warn(line));
    Ok(begin)
}

fn begin_quietly(stage: &Stage) -> Result<Begin, Failure> {
    let scene = &stage.prepared.scene;
    let start = scene.start(&stage.model).map_err(Failure::from);
    let controller = scene.controller(&stage.model, &mut |file| stage.file(file)).map_err(Failure::from);
    let ((q, v), controller) = Failure::both(start, controller)?;
    Ok(Begin { q, v, controller })
}

/// What is odd about a scene's motion. Errors: all that it would not begin for.
pub(crate) fn look_over(scene: &str) -> Result<Vec<String>, Failure> {
    let (stage, _) = Stage::open(scene)?;
    let settings = stage.prepared.scene.simulation.as_ref().map(settings::from_scene);
    let settings = settings.map_or(Ok(()), |settings| {
        let problems = settings.problems(stage.model.shape());
        let told = Failure::input(problems.iter().map(|problem| format!("{}: {problem}", stage.prepared.scene.file)));
        if problems.is_empty() { in_time(&stage, &settings) } else { Err(told) }
    });
    let (begin, ()) = Failure::both(begin_quietly(&stage), settings)?;
    Ok(beyond_limits(&stage, &begin.q))
}

/// A start beyond a joint's limits is odd, and used.
fn beyond_limits(stage: &Stage, q: &[f64]) -> Vec<String> {
    let told = |joint: &JointInfo| {
        let (limit, x) = (joint.limit?, *q.get(joint.q.0).filter(|_| joint.q.1 == 1)?);
        let (file, name) = (&stage.prepared.scene.file, &joint.name);
        let expected = format!("{} to {}; used as asked for", limit.lower, limit.upper);
        (x < limit.lower || x > limit.upper).then(|| format!("{file}: initial.q.{name}: found {x}, beyond its limits, expected {expected}"))
    };
    stage.model.joints.iter().filter_map(told).collect()
}

/// Runs it on a robot whose functions give these frames.
pub(super) fn run<R: Dynamics<f64>>(
    stage: &Stage,
    begin: &Begin,
    (robot, frames): (&R, &[String]),
    settings: &Settings,
    progress: &Progress,
) -> Result<Motion, Failure> {
    let refused = |e: SimulateError| Failure::input(e.to_string().lines().map(|l| format!("{}: {l}", stage.prepared.scene.file)));
    let mut drive = Drive::new(robot, begin.controller.clone(), stage.prepared.scene.control.period);
    in_time(stage, settings)?;
    let mut watch = Watch::of(stage, robot, frames, settings.start).map_err(refused)?;
    watch.without.iter().for_each(|what| console::warn(&nothing_of(stage, *what)));
    let mut simulation = Simulation::new(robot, settings.clone()).map_err(refused)?;
    let mut run = simulation.recording();
    let (length, mut looked, mut reached) = (settings.end - settings.start, 0_u64, settings.start);
    let mut follow = |over: bool, t: f64, counts: &Counts| {
        reached = t;
        // The bar is for people: often enough, and no burden.
        if counts.steps >= looked + 256 {
            looked = counts.steps;
            progress.at((t - settings.start) / length);
        }
        !over
    };
    let over = watch.over.clone();
    let clock = Instant::now();
    let result =
        simulation.run_into(&begin.q, &begin.v, &mut drive, &mut watch.events, &mut run, &mut |t, counts| follow(over.get(), t, counts));
    let wall = clock.elapsed();
    let error = match result {
        Ok(()) => None,
        // Nothing was done yet: it is the scene that is wrong.
        Err(e @ (SimulateError::Settings(_) | SimulateError::State(_) | SimulateError::Function(_))) => return Err(refused(e)),
        Err(e) => Some(e.to_string()),
    };
    let ended = match run.ended {
        Ended::Not => "by an error".to_owned(),
        Ended::AtEnd => "at its end".to_owned(),
        Ended::ByEvent(_) | Ended::ByWatcher => "by an event".to_owned(),
    };
    let reached = if run.ended == Ended::AtEnd { settings.end } else { run.t.last().map_or(reached, |t| t.max(reached)) };
    let counts = run.counts;
    Ok(Motion { reached, recording: told(stage, run, &|hit| watch.words(hit)), counts, ended, wall, ball: watch.ball.get(), error })
}

/// An event that can't happen is odd, and no mistake: effects come and go.
fn nothing_of(stage: &Stage, what: Watched) -> String {
    let (file, name) = (&stage.prepared.scene.file, what.name());
    let expected = match what {
        Watched::Limits => "a joint with bounds",
        Watched::Contacts => "an effect contact of the scene",
        Watched::StickSlip => "an effect friction of the scene",
    };
    format!("{file}: simulation.events: found {name:?}, expected {expected}; nothing to look for")
}

/// Whether the ball is hit while the robot moves.
fn in_time(stage: &Stage, settings: &Settings) -> Result<(), Failure> {
    let Settings { start, end, .. } = settings;
    match stage.prepared.scene.impact.as_ref().map(|impact| impact.when) {
        Some(When::Time(t)) if t < *start || t >= *end => {
            let file = &stage.prepared.scene.file;
            Err(Failure::input([format!("{file}: impact.time: found {t:?}, expected a time from {start:?} s on and before {end:?} s")]))
        }
        _ => Ok(()),
    }
}

/// The library's recording with names.
fn told(stage: &Stage, run: Run, words: &dyn Fn(&Hit) -> String) -> Recording {
    let n = run.len();
    let whole = |x: Vec<f64>| if x.len() == n { x } else { vec![0.0; n] };
    // Without mass there is no centre of it: rotors have no momentum here.
    let heavy = stage.model.moving_mass() > 0.0;
    let momentum = (0..n).map(|k| run.momentum_at(k).filter(|_| heavy).and_then(|p| p.try_into().ok()).unwrap_or_default()).collect();
    Recording {
        events: run.events.iter().map(|hit| Happening { time: hit.t, what: words(hit), ball_speed_m_per_s: hit.value }).collect(),
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
    let frames = watched::frames(stage);
    let mut functions: Vec<&str> = integrator.row().needs.iter().map(|f| f.name()).collect();
    functions.extend(["kinetic_energy", "potential_energy"]);
    if stage.model.moving_mass() > 0.0 {
        functions.push("centroidal_momentum");
    }
    if !stage.effects().is_empty() {
        functions.extend(["dissipation", "motor_torques"]);
    }
    let turns = |kind: JointKind| matches!(kind, JointKind::Floating | JointKind::Spherical);
    if stage.model.joints.iter().any(|j| turns(j.kind)) {
        functions.push("integrate");
    }
    functions.push("difference");
    if !frames.is_empty() {
        functions.push("placements");
    }
    if stage.prepared.scene.impact.is_some() {
        functions.extend(["jacobians_world_aligned", "solve_mass_matrix"]);
    }
    let mut request = stage.prepared.request.clone();
    request.options.functions = functions.into_iter().map(str::to_owned).collect();
    request.set_frames(&frames);
    (request.options.runtime, request.options.stages) = (None, false);
    (request.options.parameters, request.options.batch) = (Vec::new(), Vec::new());
    Ok((articulated_codegen::generate(&request)?, frames))
}
