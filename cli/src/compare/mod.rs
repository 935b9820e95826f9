//! `articulated compare`.

mod accuracy;
pub(crate) mod contender;
mod peer;
mod prepare;
mod report;
mod text;
pub(crate) mod timing;

use std::path::{Path, PathBuf};

use articulated_core::algorithm::{Function, function};
use articulated_core::model::Model;

use crate::arguments::{CompareArguments, Format};
use crate::compiled::Rustc;
use crate::console::{self, Progress};
use crate::failure::{Failure, OK};
use crate::robot::Robot;
use crate::tips::Tips;
use crate::{groups, names, parallel};
use accuracy::Reference;
use contender::Contender;
use peer::Peer;
use prepare::{Plan, Prepared, Unready};
use report::{FunctionReport, PeerReport, Report};

/// A peer's result may differ from ours by this much of the sum of the magnitudes of the terms.
const PEER_BOUND: f64 = 1e-9;

/// Measures and prints.
pub(crate) fn run(arguments: &CompareArguments, format: Format) -> Result<u8, Failure> {
    let mut robot = Robot::find(&arguments.robot)?.with(&arguments.frames);
    robot.options.forbid_unsafe = arguments.forbid_unsafe;
    let reading = robot.read()?;
    reading.warnings.iter().chain(&reading.snapped).for_each(|w| console::warn(&w.to_string()));
    if cfg!(debug_assertions) {
        console::warn("this command was built without optimisation: times of generic code, and of the generation, mean little");
    }
    let whole = robot.whole_model(&reading)?;
    let tips = robot.options.frames.is_none().then(|| Tips::of(&reading.description, &whole));
    let rustc = Rustc::find().map_err(|e| Failure::tool(&e))?;
    let mut report = Report::new(&robot, &whole, tips.as_ref(), arguments, &rustc);
    let folder = tempfile::tempdir().map_err(|e| Failure::tool(&e))?;
    let peers = open_peers(arguments, &robot, &whole, folder.path(), &mut report)?;
    let plan = Plan {
        reference: Reference::new(&reading.description, &robot.options),
        robot,
        tips,
        rustc,
        states: arguments.states as usize,
        seed: arguments.seed,
        named: !arguments.functions.is_empty(),
    };
    let prepared = prepare_all(&plan, arguments, &mut report)?;
    measure_all(&prepared, &peers, arguments.repetitions as usize, &mut report);
    console::print(&match format {
        Format::Text => text::text(&report),
        Format::Json => crate::json(&report),
    })?;
    match report.exceeded(arguments.bound, PEER_BOUND) {
        None => Ok(OK),
        Some(line) => Err(Failure::bound(line)),
    }
}

/// The peers that read this robot; a note for each that does not.
fn open_peers(
    arguments: &CompareArguments,
    robot: &Robot,
    model: &Model<f64>,
    folder: &Path,
    report: &mut Report,
) -> Result<Vec<Peer>, Failure> {
    let mut libraries: Vec<(Option<String>, PathBuf)> = arguments.peer.iter().map(|p| (None, p.clone())).collect();
    if let Some(manifest) = &arguments.peers_manifest {
        libraries.extend(peer::manifest(manifest).map_err(|line| Failure::input([line]))?);
    }
    let mut peers: Vec<Peer> = Vec::new();
    if libraries.is_empty() {
        return Ok(peers);
    }
    let urdf = robot.file_in(folder).map_err(|e| Failure::input([format!("{}: {e}", robot.file)]))?;
    for (name, library) in libraries {
        let label = name.clone().unwrap_or_else(|| library.display().to_string());
        match Peer::open(name, &library, &urdf, robot, model) {
            Ok(peer) => peers.push(peer),
            Err(reason) => report.notes.push(format!("peer {label} is left out: {reason}")),
        }
    }
    Ok(peers)
}

/// All functions that were asked for, or all that the robot has.
fn prepare_all(plan: &Plan, arguments: &CompareArguments, report: &mut Report) -> Result<Vec<Prepared>, Failure> {
    let chosen = names::flat(&arguments.functions);
    let mut names = if chosen.is_empty() { groups::all() } else { chosen.clone() };
    let mut seen: Vec<String> = Vec::new();
    names.retain(|name| {
        !seen.contains(name) && {
            seen.push(name.clone());
            true
        }
    });
    let rows: Vec<&'static Function<f64>> = names.iter().filter_map(|name| function::<f64>(name)).collect();
    let progress = Progress::new(rows.len());
    let mut prepared = Vec::new();
    for (result, f) in parallel::map(&rows, |f| plan.prepare(f, &progress)).into_iter().zip(rows) {
        match result {
            Ok(ready) => prepared.push(ready),
            Err(Unready::Undefined(why)) if chosen.is_empty() => report.notes.push(format!("{} is left out: {why}", f.name)),
            Err(Unready::Undefined(why)) => return Err(Failure::input([format!("{}: {why}", f.name)])),
            Err(Unready::Failed(failure)) => return Err(failure),
        }
    }
    Ok(prepared)
}

fn measure_all(prepared: &[Prepared], peers: &[Peer], repetitions: usize, report: &mut Report) {
    let progress = Progress::new(prepared.len());
    for ready in prepared {
        progress.doing(format!("{}: times", ready.function.name));
        report.functions.push(measure(ready, peers, repetitions));
        progress.step();
    }
}

/// Times of one function: of generated code, generic code and each peer.
fn measure(ready: &Prepared, peers: &[Peer], repetitions: usize) -> FunctionReport {
    let (f, model) = (ready.function, &ready.model);
    let arguments = prepare::arguments(&ready.states, f);
    let (generated, generic) = (Contender::generated(&ready.compiled, f), Contender::generic(model, f));
    let known: Vec<(&Peer, Contender)> = peers.iter().filter_map(|p| Some((p, p.contender(f, model)?))).collect();
    let theirs: Vec<Vec<Vec<Vec<f64>>>> = known.iter().map(|(p, _)| arguments.iter().map(|x| p.arguments(f, model, x)).collect()).collect();
    let theirs: Vec<Vec<Vec<&[f64]>>> =
        theirs.iter().map(|states| states.iter().map(|x| x.iter().map(Vec::as_slice).collect()).collect()).collect();
    let mut runs: Vec<timing::Run<'_>> = vec![generated.run(&arguments), generic.run(&arguments)];
    runs.extend(known.iter().zip(&theirs).map(|((_, c), x)| c.run(x)));
    let times = timing::interleaved(&mut runs, repetitions, arguments.len());
    // Where the robot is singular nobody's result is right.
    let regular = ready.errors.is_none_or(|e| e.states > 0);
    let peers = known.iter().zip(&theirs).enumerate().map(|(k, ((peer, contender), x))| PeerReport {
        peer: peer.name.clone(),
        time: timing::summary(&times[2 + k]),
        generic_over_peer: timing::ratio(&times[1], &times[2 + k]),
        generated_over_peer: timing::ratio(&times[0], &times[2 + k]),
        largest_difference: regular.then(|| peer.difference(f, model, &arguments, x, contender, &generic)).flatten(),
    });
    FunctionReport::new(ready, &times, peers.collect())
}
