//! Generated code against generic code and peers: operations, bytes, times and errors.

pub(crate) mod accuracy;
mod batch;
mod chart;
pub mod contender;
mod lanes;
mod making;
pub(crate) mod manifest;
pub(crate) mod peer;
mod prepare;
mod report;
mod text;

use std::path::Path;

use articulated_codegen::function_groups;
use articulated_core::algorithm::{Function, function};
use articulated_core::description::Description;
use articulated_core::model::Model;

use crate::compiled::{Cc, Rustc};
use crate::console::Progress;
use crate::error::Error;
use crate::parallel;
use crate::process::Folder;
use crate::robot::Robot;
use crate::timing;
use crate::tips::Tips;
use accuracy::Reference;
use batch::{Beside, Many};
use contender::Contender;
use lanes::Lanes;
use making::Making;
use manifest::Library;
use peer::Peer;
use prepare::{Plan, PrepareError, Prepared};
use report::{FunctionReport, PeerLibrary, PeerReport, VariantReport};
pub use report::{Report, Settings};

/// Other code of ours may differ from generic code by this much of the sum of the magnitudes of the
/// terms.
const VARIANT_BOUND: f64 = 1e-9;

/// Measures a robot. `whole`: its model with a frame for each link.
pub fn measure(robot: Robot, description: &Description, whole: &Model<f64>, settings: &Settings) -> Result<Report, Error> {
    let tips = robot.options.robot.frames.is_none().then(|| Tips::of(description, whole));
    let rustc = Rustc::find().map_err(|e| Error::tool(&e))?;
    let mut report = Report::new(&robot, whole, tips.as_ref(), settings, &rustc);
    let folder = Folder::new().map_err(|e| Error::tool(&e))?;
    let peers = open_peers(settings, &robot, whole, folder.path(), &mut report)?;
    let plan = Plan {
        reference: Reference::new(description, &robot),
        robot,
        tips,
        rustc,
        states: settings.states as usize,
        seed: settings.seed,
        batch: settings.batch.clone(),
        compilers: if settings.c { Cc::all() } else { Vec::new() },
        named: !settings.functions.is_empty(),
    };
    report.notes.extend(plan.reference.note());
    report.notes.extend(plan.note_of_c(settings.c));
    let prepared = prepare_all(&plan, settings, &mut report)?;
    measure_all(&prepared, &peers, settings.repetitions as usize, &mut report);
    report.making = Making::all(&plan, &prepared, &peers)?;
    Ok(report)
}

impl Report {
    /// As tables.
    pub fn text(&self) -> String {
        text::text(self)
    }

    /// The medians as dots on a logarithmic axis, in SVG.
    pub fn chart(&self) -> String {
        chart::svg(self)
    }

    /// The first error or difference beyond its bound, as a sentence.
    pub fn exceeded(&self) -> Option<String> {
        self.beyond(self.bound, VARIANT_BOUND)
    }
}

/// The peers that read this robot; a note for each that does not.
fn open_peers(settings: &Settings, robot: &Robot, model: &Model<f64>, folder: &Path, report: &mut Report) -> Result<Vec<Peer>, Error> {
    let libraries = manifest::named(&settings.peer, settings.peers_manifest.as_deref())?;
    let peers = peer::open_all(libraries, robot, model, folder, &mut report.notes)?;
    let told = |p: &Peer| PeerLibrary { peer: p.name.clone(), library: Library { robots: Vec::new(), ..p.library.clone() } };
    report.peers = peers.iter().map(told).collect();
    Ok(peers)
}

/// The requested functions, or all that the robot has.
fn prepare_all(plan: &Plan, settings: &Settings, report: &mut Report) -> Result<Vec<Prepared>, Error> {
    let chosen = &settings.functions;
    let mut names = if chosen.is_empty() { function_groups::all() } else { chosen.clone() };
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
            Err(PrepareError::Undefined(why)) if chosen.is_empty() => report.notes.push(format!("{} is left out: {why}", f.name)),
            Err(PrepareError::Undefined(why)) => return Err(Error::input([format!("{}: {why}", f.name)])),
            Err(PrepareError::Failed(failure)) => return Err(failure),
        }
    }
    Ok(prepared)
}

fn measure_all(prepared: &[Prepared], peers: &[Peer], repetitions: usize, report: &mut Report) {
    let progress = Progress::new(prepared.len());
    for ready in prepared {
        progress.doing(format!("{}: times", ready.function.name));
        report.functions.push(function_report(ready, peers, repetitions));
        progress.step();
    }
}

/// Times of one function: of generated code, generic code, other code of ours, and each peer.
fn function_report(ready: &Prepared, peers: &[Peer], repetitions: usize) -> FunctionReport {
    let (f, model) = (ready.function, &ready.model);
    let arguments = prepare::arguments(&ready.states, f);
    let (generated, generic) = (Contender::generated(&ready.compiled, f), Contender::generic(model, f));
    let variants: Vec<Contender> = ready.variants.iter().map(|(_, compiled)| Contender::generated(compiled, f)).collect();
    let out = f.len(model.shape());
    let batches: Vec<Many> = ready.batches.as_ref().map_or_else(Vec::new, |compiled| Many::all(compiled, &arguments, out));
    let known: Vec<(&Peer, Contender)> = peers.iter().filter_map(|p| Some((p, p.contender(f, model)?))).collect();
    let theirs: Vec<Vec<Vec<Vec<f64>>>> = known.iter().map(|(p, _)| arguments.iter().map(|x| p.arguments(f, model, x)).collect()).collect();
    let theirs: Vec<Vec<Vec<&[f64]>>> =
        theirs.iter().map(|states| states.iter().map(|x| x.iter().map(Vec::as_slice).collect()).collect()).collect();
    let in_lanes: Vec<Lanes> =
        if batches.is_empty() { Vec::new() } else { peers.iter().filter_map(|p| Lanes::of(p, f, model, &arguments)).collect() };
    let ours = [&generated, &generic].into_iter().chain(&variants);
    let mut runs: Vec<timing::Run<'_>> = ours.map(|c| c.run(&arguments)).collect();
    runs.extend(batches.iter().map(Many::run));
    runs.extend(known.iter().zip(&theirs).map(|((_, c), x)| c.run(x)));
    runs.extend(in_lanes.iter().map(Lanes::run));
    // Calls that wait for each other: of generated code first, then of each peer that writes its
    // result.
    let independent = runs.len();
    runs.extend(generated.can_wait().then(|| generated.run_dependent(&arguments)));
    runs.extend(known.iter().zip(&theirs).filter(|((_, c), _)| c.can_wait()).map(|((_, c), x)| c.run_dependent(x)));
    let times = timing::interleaved(&mut runs, repetitions);
    drop(runs);
    let (times, waiting) = times.split_at(independent);
    let mut waiting = waiting.iter().map(Vec::as_slice);
    let mut waits = |contender: &Contender<'_>| contender.can_wait().then(|| waiting.next()).flatten();
    let own_waiting = waits(&generated);
    let peers_waiting: Vec<Option<&[f64]>> = known.iter().map(|(_, c)| waits(c)).collect();
    // No result is valid if the robot is singular.
    let regular = ready.errors.is_none_or(|e| e.states > 0);
    let (own, rest) = times.split_at(2);
    let (other, rest) = rest.split_at(variants.len());
    let (of_many, rest) = rest.split_at(batches.len());
    let (peer_times, lanes_times) = rest.split_at(known.len());
    let beside = Beside {
        function: f,
        model,
        states: &arguments,
        generic: &generic,
        generated: &own[0],
        peers: known.iter().map(|(p, _)| *p).zip(peer_times.iter().map(Vec::as_slice)).collect(),
        regular,
    };
    let batches = batches.iter().zip(of_many).map(|(many, time)| beside.report(many, time)).collect();
    let variants = ready.variants.iter().zip(&variants).zip(other).map(|(((variant, compiled), contender), time)| {
        let difference = || peer::difference(f, model, &arguments, &generic, |k, _| Some(contender.call(&arguments[k])));
        VariantReport {
            variant: variant.clone(),
            time: timing::summary(time),
            over_generated: timing::ratio(time, &own[0]),
            code_bytes: compiled.code_bytes(f.name),
            compilation_seconds: compiled.time.as_secs_f64(),
            largest_difference: regular.then(difference).flatten(),
        }
    });
    let peers = known.iter().zip(&theirs).zip(peer_times.iter().zip(peers_waiting)).map(|(((peer, contender), x), (time, waiting))| {
        let difference = || peer.difference(f, model, &arguments, x, contender, &generic);
        PeerReport::new(peer, f.name, [time, &own[0], &own[1]], waiting, regular.then(difference).flatten())
    });
    let in_lanes = in_lanes.iter().zip(lanes_times).map(|(lanes, time)| {
        let difference = || lanes.difference(f, model, &arguments, &generic);
        lanes.report(time, regular.then(difference).flatten())
    });
    FunctionReport::new(ready, [&own[0], &own[1]], own_waiting, variants.collect(), batches, peers.collect(), in_lanes.collect())
}
