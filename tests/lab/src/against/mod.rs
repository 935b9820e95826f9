//! Simulations against peers: wall time of each engine to reach the end at equal error there.

mod ours;
pub(crate) mod peers;
mod report;
mod search;
mod text;

use std::path::Path;
use std::time::Instant;

use articulated::simulate::{IntegratorId, Settings};
use articulated_motion::InitialState;

use crate::compare::manifest::{self, Library};
use crate::compiled::Rustc;
use crate::console::Progress;
use crate::error::Error;
use crate::process::Folder;
use crate::session::Session;
use crate::straight::Straight;
use crate::timing::{self, Run};
use ours::Ours;
use peers::Peer;
pub use report::Report;
use report::{Reached, Target};
use search::{Effort, search};

/// Errors of the last state, rad, m, and the same per second: the largest of all.
const TARGETS: [f64; 3] = [1e-3, 1e-6, 1e-9];
const REPETITIONS: usize = 15;

/// An engine that simulates the motion.
trait Runner {
    fn name(&self) -> String;
    fn order(&self) -> u32;
    /// Whether it is `articulated`.
    fn is_ours(&self) -> bool;
    /// From the least to the largest sensible effort.
    fn effort(&self, level: usize) -> Option<Effort>;
    /// Simulates to the end; returns (q, v) there, or `None` if it diverged.
    fn run(&mut self, effort: Effort) -> Option<Vec<f64>>;
    /// Steps and evaluations of forward dynamics of the last run.
    fn spent(&self) -> (u64, u64);
}

/// Measures a motion from its start. `file`: a peer library, or a list of them (JSON).
pub fn measure(session: &Session, initial: &InitialState, settings: &Settings, file: &Path) -> Result<Report, Error> {
    known_to_peers(session)?;
    let InitialState { q, v, .. } = initial;
    let rustc = Rustc::find().map_err(|e| Error::tool(&e))?;
    let (generated, _) = session.generate(IntegratorId::dop853)?;
    let robot = Straight::build(&rustc, &generated).map_err(|e| Error::tool(&e))?;
    let folder = Folder::new().map_err(|e| Error::tool(&e))?;
    let list = file.extension().is_some_and(|e| e == "json");
    let libraries = if list { manifest::read(file).map_err(|line| Error::input([line]))? } else { vec![Library::at(file)] };
    let (peers, notes) = peers::open(session, &libraries, folder.path(), (q, v), settings.end - settings.start)?;
    let ours = |id| Ours::new(&robot, id, settings, (q, v));
    let mut reference = ours(IntegratorId::dop853);
    let best = reference.run(Effort::Tolerance(1e-14)).ok_or_else(|| astray("the reference"))?;
    let second = reference.run(Effort::Tolerance(4e-14)).ok_or_else(|| astray("the reference"))?;
    let mut runners: Vec<Box<dyn Runner + '_>> = peers.into_iter().map(|p: Peer| Box::new(p) as Box<dyn Runner>).collect();
    runners.extend([IntegratorId::rk4, IntegratorId::dopri5, IntegratorId::dop853].map(|id| Box::new(ours(id)) as Box<dyn Runner>));
    let progress = Progress::new(runners.len() * TARGETS.len() + TARGETS.len());
    let found = found(&mut runners, &best, &progress);
    let targets = (0..TARGETS.len()).map(|k| {
        progress.doing(format!("error {:e}: times", TARGETS[k]));
        let target = timed(&mut runners, k, &found, settings);
        progress.step();
        target
    });
    let report = Report {
        scene: session.name.clone(),
        robot: session.model.name().to_owned(),
        simulated_s: settings.end - settings.start,
        reference: format!("dop853 at a tolerance of 1e-14; at 4e-14 its last state is {:.1e} away", search::distance(&best, &second)),
        compiler: rustc.version.clone(),
        notes,
        targets: targets.collect(),
    };
    drop(progress);
    Ok(report)
}

impl Report {
    /// As tables.
    pub fn text(&self) -> String {
        text::text(self)
    }
}

/// Checks that peers know everything in the scene.
fn known_to_peers(session: &Session) -> Result<(), Error> {
    let file = &session.scene.file;
    let told = |what| format!("{file}: found {what}, expected none for --against: peers know the robot's file and its gravity only");
    let lines: Vec<String> = unknown_to_peers(session).into_iter().map(told).collect();
    if lines.is_empty() { Ok(()) } else { Err(Error::input(lines)) }
}

fn astray(who: &str) -> Error {
    Error::input([format!("{who} does not get to the end of the motion")])
}

/// Content of a scene that peers do not know: they receive the robot's file and gravity only.
pub(crate) fn unknown_to_peers(session: &Session) -> Vec<&'static str> {
    let (o, scene) = (&session.request.options, &session.scene);
    let asked = [
        (!o.robot.effects.is_empty(), "effects"),
        (!o.robot.shafts.is_empty(), "effects.shaft"),
        (!(o.robot.append.is_empty() && o.robot.payloads.is_empty() && o.robot.lock.is_empty()), "append, payload or lock"),
        (scene.control.drive != articulated_scene::Drive::None, "control"),
        (scene.impact.is_some(), "impact"),
    ];
    asked.iter().filter(|(there, _)| *there).map(|(_, what)| *what).collect()
}

/// The least effort of each runner for each target, and the error that is left.
type Found = Vec<Vec<Option<(Effort, f64)>>>;

fn found(runners: &mut [Box<dyn Runner + '_>], best: &[f64], progress: &Progress) -> Found {
    let mut all = Vec::new();
    for runner in runners {
        let (mut own, mut level) = (Vec::new(), 0);
        for target in TARGETS {
            progress.doing(format!("{}: error {target:e}", runner.name()));
            let found = search(runner.as_mut(), best, target, level);
            level = found.map_or(level, |f| f.0);
            own.push(found.map(|(_, effort, error)| (effort, error)));
            progress.step();
        }
        all.push(own);
    }
    all
}

/// All runners that reach the target, timed in turn.
fn timed(runners: &mut [Box<dyn Runner + '_>], target: usize, found: &Found, settings: &Settings) -> Target {
    let mut reached: Vec<Reached> = Vec::new();
    let mut runs: Vec<Run<'_>> = Vec::new();
    for (runner, found) in runners.iter_mut().zip(found) {
        let Some((effort, error)) = found[target] else { continue };
        runner.run(effort);
        let (steps, evaluations) = runner.spent();
        let (name, order, ours) = (runner.name(), runner.order(), runner.is_ours());
        reached.push(Reached { name, order, ours, effort, error, steps, evaluations, ..Reached::default() });
        runs.push(Run::new(1, move |rounds| {
            let clock = Instant::now();
            (0..rounds).for_each(|_| {
                std::hint::black_box(runner.run(effort));
            });
            clock.elapsed()
        }));
    }
    let times = timing::interleaved(&mut runs, REPETITIONS);
    drop(runs);
    for (r, time) in reached.iter_mut().zip(&times) {
        let fastest = time.iter().copied().fold(f64::INFINITY, f64::min);
        r.wall_ms = fastest * 1e-6;
        r.simulated_s_per_wall_s = (settings.end - settings.start) / (fastest * 1e-9);
    }
    Target::new(TARGETS[target], reached)
}
