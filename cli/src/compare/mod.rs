//! `articulated compare`.

mod accuracy;
mod contender;
mod peer;
mod report;
mod text;
mod timing;

use std::path::PathBuf;
use std::time::Instant;

use articulated_core::algorithm::{Function, function};
use articulated_core::model::Model;

use crate::arguments::{CompareArguments, Format, names};
use crate::compiled::{Compiled, Rustc};
use crate::console::{self, Progress};
use crate::failure::{Failure, OK};
use crate::ledger::stages;
use crate::robot::Robot;
use crate::states::{self, State};
use accuracy::Reference;
use contender::Contender;
use peer::Peer;
use report::{FunctionReport, PeerReport, Report};

/// A peer's result may differ from ours by this much of the sum of the magnitudes of the terms.
const PEER_BOUND: f64 = 1e-9;

/// What all functions are measured on.
struct Bench<'a> {
    robot: &'a Robot,
    model: Model<f64>,
    reference: Reference,
    states: Vec<State>,
    peers: Vec<Peer>,
    rustc: Rustc,
    repetitions: usize,
}

/// Measures and prints.
pub(crate) fn run(arguments: &CompareArguments, format: Format) -> Result<u8, Failure> {
    let mut robot = Robot::find(&arguments.robot)?;
    robot.options.forbid_unsafe = arguments.forbid_unsafe;
    let reading = robot.read()?;
    reading.warnings.iter().chain(&reading.snapped).for_each(|w| console::warn(&w.to_string()));
    if cfg!(debug_assertions) {
        console::warn("this command was built without optimisation: times of generic code, and of the generation, mean little");
    }
    let model = robot.model(&reading)?;
    let rustc = Rustc::find().map_err(|e| Failure::tool(&e))?;
    let mut report = Report::new(&robot, &model, arguments, &rustc);
    let folder = tempfile::tempdir().map_err(|e| Failure::tool(&e))?;
    let peers = open_peers(arguments, &robot, &model, folder.path(), &mut report)?;
    let bench = Bench {
        reference: Reference::new(&reading.description, &robot.options),
        states: states::random(&model, arguments.states as usize, arguments.seed),
        robot: &robot,
        model,
        peers,
        rustc,
        repetitions: arguments.repetitions as usize,
    };
    bench.measure_all(arguments, &mut report)?;
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
    folder: &std::path::Path,
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

impl Bench<'_> {
    fn measure_all(&self, arguments: &CompareArguments, report: &mut Report) -> Result<(), Failure> {
        let chosen = !arguments.functions.is_empty();
        let all: Vec<&str> = if chosen { arguments.functions.iter().map(String::as_str).collect() } else { names() };
        let progress = Progress::new(all.len());
        for f in all.into_iter().filter_map(function::<f64>) {
            if report.functions.iter().any(|r| r.function == f.name) {
                continue;
            }
            match self.measure(f, &progress) {
                Ok(measured) => report.functions.push(measured),
                Err(Measure::Undefined(why)) if !chosen => report.notes.push(format!("{} is left out: {why}", f.name)),
                Err(Measure::Undefined(why)) => return Err(Failure::input([why])),
                Err(Measure::Failed(failure)) => return Err(failure),
            }
            progress.step();
        }
        Ok(())
    }

    /// Everything about one function.
    fn measure(&self, f: &'static Function<f64>, progress: &Progress) -> Result<FunctionReport, Measure> {
        progress.doing(format!("{}: generation", f.name));
        let start = Instant::now();
        let generated = self.robot.generate(&[f.name.to_owned()])?;
        let generation = start.elapsed();
        progress.doing(format!("{}: rustc", f.name));
        let compiled = Compiled::build(&self.rustc, &generated).map_err(|e| Failure::tool(&e))?;
        let arguments: Vec<Vec<&[f64]>> = self.states.iter().map(|s| s.arguments(f).unwrap_or_default()).collect();
        progress.doing(format!("{}: errors", f.name));
        let ours = Contender::generated(&compiled, f);
        let errors = accuracy::errors(&self.reference, &self.model, f, &arguments, &ours);
        progress.doing(format!("{}: times", f.name));
        let (times, peers) = self.times(f, &arguments, &ours);
        let entry = &generated.ledger.functions[0];
        Ok(FunctionReport {
            function: f.name.to_owned(),
            stages: stages(entry),
            depth: entry.depth,
            code_bytes: compiled.code_bytes(f.name),
            source_bytes: generated.source.len(),
            generation_seconds: generation.as_secs_f64(),
            compilation_seconds: compiled.time.as_secs_f64(),
            generated: timing::summary(&times[0]),
            generic: timing::summary(&times[1]),
            generic_over_generated: timing::ratio(&times[1], &times[0]),
            peers,
            errors,
        })
    }

    /// Times of generated code, generic code and each peer, in this order; and what is to be said of the peers.
    fn times(&self, f: &'static Function<f64>, arguments: &[Vec<&[f64]>], generated: &Contender) -> (Vec<Vec<f64>>, Vec<PeerReport>) {
        let known: Vec<(&Peer, Contender)> = self.peers.iter().filter_map(|p| Some((p, p.contender(f, &self.model)?))).collect();
        let theirs: Vec<Vec<Vec<Vec<f64>>>> =
            known.iter().map(|(p, _)| arguments.iter().map(|x| p.arguments(f, &self.model, x)).collect()).collect();
        let theirs: Vec<Vec<Vec<&[f64]>>> =
            theirs.iter().map(|states| states.iter().map(|x| x.iter().map(Vec::as_slice).collect()).collect()).collect();
        let generic = Contender::generic(&self.model, f);
        let mut runs: Vec<timing::Run<'_>> = vec![generated.run(arguments), generic.run(arguments)];
        runs.extend(known.iter().zip(&theirs).map(|((_, c), x)| c.run(x)));
        let times = timing::interleaved(&mut runs, self.repetitions, arguments.len());
        let reports = known.iter().zip(&theirs).enumerate().map(|(k, ((peer, contender), x))| PeerReport {
            peer: peer.name.clone(),
            time: timing::summary(&times[2 + k]),
            generic_over_peer: timing::ratio(&times[1], &times[2 + k]),
            generated_over_peer: timing::ratio(&times[0], &times[2 + k]),
            largest_difference: peer.difference(f, &self.model, arguments, x, contender, &generic),
        });
        let reports = reports.collect();
        (times, reports)
    }
}

/// Why a function was not measured.
enum Measure {
    /// It does not exist for this robot.
    Undefined(String),
    Failed(Failure),
}

impl From<articulated_codegen::Error> for Measure {
    fn from(error: articulated_codegen::Error) -> Self {
        match error {
            articulated_codegen::Error::Singular { .. } => Self::Undefined(error.to_string()),
            other => Self::Failed(other.into()),
        }
    }
}

impl From<Failure> for Measure {
    fn from(failure: Failure) -> Self {
        Self::Failed(failure)
    }
}
