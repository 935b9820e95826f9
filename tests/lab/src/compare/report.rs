//! The results of a measurement, as data.

use std::borrow::Cow;
use std::path::PathBuf;

use articulated_codegen::function_groups::Group;
use articulated_core::algorithm::Dim;
use articulated_core::diagnostic::values;
use articulated_core::lanes::Real;
use articulated_core::model::Model;
use articulated_reference::BITS;
use serde::Serialize;

use super::accuracy::{Against, Errors};
use super::batch::BatchReport;
use super::lanes::LanesReport;
use super::making::Making;
use super::manifest::{Cost, Library};
use super::peer::Peer;
use super::prepare::Prepared;
use crate::compiled::{Rustc, Target};
use crate::json::Units;
use crate::ledger::{Stage, stages};
use crate::robot::Robot;
use crate::timing::{self, Summary};
use crate::tips::Tips;

const CALL: &str = "ns per call";
const STATE: &str = "ns per state";
const RATIO: &str = "ratio";
const MAGNITUDE: &str = "the sum of the magnitudes of the terms";
const ROUNDING: &str = "2⁻⁵³ of the sum of the magnitudes of the terms";

/// Of all numbers that have one.
const UNITS: Units = Units(&[
    ("gravity", "m/s²"),
    ("bound", ROUNDING),
    ("functions[].depth", "operations one after the other"),
    ("functions[].generated", CALL),
    ("functions[].dependent", CALL),
    ("functions[].generic", CALL),
    ("functions[].generic_over_generated", RATIO),
    ("functions[].errors.generated", ROUNDING),
    ("functions[].errors.generic", ROUNDING),
    ("functions[].variants[].time", CALL),
    ("functions[].variants[].over_generated", RATIO),
    ("functions[].variants[].largest_difference", MAGNITUDE),
    ("functions[].batches[].time", STATE),
    ("functions[].batches[].generated_over_batch", RATIO),
    ("functions[].batches[].largest_difference", MAGNITUDE),
    ("functions[].batches[].bound", MAGNITUDE),
    ("functions[].batches[].peers[].peer_over_batch", RATIO),
    ("functions[].peers[].time", CALL),
    ("functions[].peers[].dependent", CALL),
    ("functions[].peers[].generic_over_peer", RATIO),
    ("functions[].peers[].generated_over_peer", RATIO),
    ("functions[].peers[].largest_difference", MAGNITUDE),
    ("functions[].peers[].bound", MAGNITUDE),
    ("functions[].peers_in_lanes[].time", STATE),
    ("functions[].peers_in_lanes[].largest_difference", MAGNITUDE),
    ("functions[].peers_in_lanes[].bound", MAGNITUDE),
    ("making[].peers[].peer_over_ours", RATIO),
]);

/// Settings of the comparison.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The functions; if empty, all that the robot has and that rustc compiles in seconds.
    pub functions: Vec<String>,
    /// The types in which many states at once are compared too.
    pub batch: Vec<Real>,
    /// Whether the same functions in C, by each compiler that is installed, are compared too.
    pub c: bool,
    /// Peer libraries, and a list of them.
    pub peer: Vec<PathBuf>,
    /// The list.
    pub peers_manifest: Option<PathBuf>,
    /// How often each is timed.
    pub repetitions: u32,
    /// How many random states.
    pub states: u32,
    /// Their seed.
    pub seed: u64,
    /// Largest accepted error, in units of 2⁻⁵³ of the sum of the magnitudes of the terms.
    pub bound: f64,
}

/// The results of the measurement.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    pub(super) robot: String,
    /// The scene that it is of.
    pub(super) scene: Option<String>,
    pub(super) base: &'static str,
    pub(super) gravity: [f64; 3],
    pub(super) joints: usize,
    pub(super) degrees_of_freedom: usize,
    /// The frames of functions of frames, and whether the user chose them or they are the robot's
    /// tips.
    pub(super) frames: Vec<String>,
    pub(super) frames_chosen: bool,
    pub(super) states: u32,
    pub(super) seed: u64,
    pub(super) repetitions: u32,
    pub(super) compiler: String,
    pub(super) flags: String,
    /// Reference for errors.
    pub(super) reference: Against,
    /// Bits of its numbers.
    pub(super) reference_bits: usize,
    /// Largest accepted error, in units of 2⁻⁵³ of the magnitude.
    pub(super) bound: f64,
    /// Whether the command itself is optimised; generic code and generation are as fast as it is.
    pub(super) optimised: bool,
    pub(super) units: Units,
    /// Bytes of machine code, operations and seconds of peers are per build; those of generated
    /// code for this robot are listed with the functions.
    pub(super) peers: Vec<PeerLibrary>,
    pub(super) notes: Vec<String>,
    pub(super) functions: Vec<FunctionReport>,
    /// Time to make the functions of the peers' generators, all together.
    pub(super) making: Vec<Making>,
}

/// A library that was opened, under its name.
#[derive(Clone, Debug, Serialize)]
pub(super) struct PeerLibrary {
    pub(super) peer: String,
    #[serde(flatten)]
    pub(super) library: Library,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct FunctionReport {
    pub(super) function: &'static str,
    pub(super) group: &'static str,
    /// The forms that the generator chose by count, if it had a choice.
    pub(super) ways: Vec<Cow<'static, str>>,
    /// The frames that it was evaluated on, if it is a function of frames.
    pub(super) frames: Option<Vec<String>>,
    pub(super) stages: Vec<Stage>,
    pub(super) depth: u32,
    /// Machine code, without sines and cosines.
    pub(super) code_bytes: Option<u64>,
    pub(super) source_bytes: usize,
    pub(super) generation_seconds: f64,
    /// `rustc`, start and linking included.
    pub(super) compilation_seconds: f64,
    /// ns per call.
    pub(super) generated: Summary,
    /// ns per call that waits for the result of the previous call; `None` without a result.
    pub(super) dependent: Option<Summary>,
    /// ns per call.
    pub(super) generic: Summary,
    pub(super) generic_over_generated: Summary,
    /// Other code of ours.
    pub(super) variants: Vec<VariantReport>,
    /// Results of batches, if requested.
    pub(super) batches: Vec<BatchReport>,
    pub(super) peers: Vec<PeerReport>,
    /// Times of peers that compute several states a call; empty unless batches are requested.
    pub(super) peers_in_lanes: Vec<LanesReport>,
    /// In units of 2⁻⁵³ of the magnitude; `None` without a reference for the function.
    pub(super) errors: Option<Errors>,
}

/// The generated function in another form.
#[derive(Clone, Debug, Serialize)]
pub(super) struct VariantReport {
    pub(super) variant: String,
    /// ns per state.
    pub(super) time: Summary,
    pub(super) over_generated: Summary,
    pub(super) code_bytes: Option<u64>,
    pub(super) compilation_seconds: f64,
    /// From generic code, relative to the magnitude.
    pub(super) largest_difference: Option<f64>,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct PeerReport {
    pub(super) peer: String,
    /// Builds of one engine have this in common.
    pub(super) engine: String,
    /// ns per call.
    pub(super) time: Summary,
    /// ns per call that waits for the result of the previous call; `None` if the peer does not
    /// return its result.
    pub(super) dependent: Option<Summary>,
    pub(super) generic_over_peer: Summary,
    pub(super) generated_over_peer: Summary,
    /// Relative to the magnitude; `None` if the peer does not return its results.
    pub(super) largest_difference: Option<f64>,
    /// The largest that is right.
    pub(super) bound: f64,
    /// Of generated code.
    pub(super) cost: Option<Cost>,
}

impl PeerReport {
    /// `times`: ns per call of the peer, of generated code and of generic code; `dependent`: ns per
    /// call of the peer that waits.
    pub(super) fn new(
        peer: &Peer,
        function: &str,
        [own, generated, generic]: [&[f64]; 3],
        dependent: Option<&[f64]>,
        largest_difference: Option<f64>,
    ) -> Self {
        Self {
            peer: peer.name.clone(),
            engine: peer.engine().to_owned(),
            time: timing::summary(own),
            dependent: dependent.map(timing::summary),
            generic_over_peer: timing::ratio(generic, own),
            generated_over_peer: timing::ratio(generated, own),
            largest_difference,
            bound: peer.library.bound(),
            cost: peer.cost(function).cloned(),
        }
    }
}

impl FunctionReport {
    /// `times`: ns per call of generated code and of generic code; `dependent`: of generated code
    /// that waits.
    pub(super) fn new(
        ready: &Prepared,
        times: [&[f64]; 2],
        dependent: Option<&[f64]>,
        variants: Vec<VariantReport>,
        batches: Vec<BatchReport>,
        peers: Vec<PeerReport>,
        peers_in_lanes: Vec<LanesReport>,
    ) -> Self {
        let (f, entry) = (ready.function, &ready.entry);
        let dims = f.takes.iter().flat_map(|a| a.dims()).chain(f.gives);
        let framed = dims.into_iter().any(|d| *d == Dim::Frames);
        Self {
            function: f.name,
            group: Group::of(f.id).name(),
            ways: entry.ways.clone(),
            frames: framed.then(|| ready.model.frames().iter().map(|f| f.name.clone()).collect()),
            stages: stages(entry),
            depth: entry.depth,
            code_bytes: ready.compiled.code_bytes(f.name),
            source_bytes: ready.source_bytes,
            generation_seconds: ready.generation.as_secs_f64(),
            compilation_seconds: ready.compiled.time.as_secs_f64(),
            generated: timing::summary(times[0]),
            dependent: dependent.map(timing::summary),
            generic: timing::summary(times[1]),
            generic_over_generated: timing::ratio(times[1], times[0]),
            variants,
            batches,
            peers,
            peers_in_lanes,
            errors: ready.errors,
        }
    }

    /// The peer that was fastest.
    pub(super) fn fastest(&self) -> Option<&PeerReport> {
        fastest(self.peers.iter())
    }

    /// The fastest build of an engine.
    pub(super) fn fastest_of(&self, engine: &str) -> Option<&PeerReport> {
        fastest(self.peers.iter().filter(|p| p.engine == engine))
    }
}

fn fastest<'a>(peers: impl Iterator<Item = &'a PeerReport>) -> Option<&'a PeerReport> {
    peers.min_by(|a, b| a.time.median.total_cmp(&b.time.median))
}

impl Report {
    pub(super) fn new(robot: &Robot, model: &Model<f64>, tips: Option<&Tips>, settings: &Settings, rustc: &Rustc) -> Self {
        let chosen = robot.options.robot.frames.as_deref().map(values);
        Self {
            frames_chosen: chosen.is_some(),
            frames: chosen.unwrap_or_else(|| tips.map_or_else(Vec::new, |t| t.all().to_vec())),
            robot: robot.file.clone(),
            scene: robot.scene.clone(),
            base: robot.base(),
            gravity: model.gravity().into(),
            joints: model.joints().len(),
            degrees_of_freedom: model.nv(),
            states: settings.states,
            seed: settings.seed,
            repetitions: settings.repetitions,
            compiler: rustc.version.clone(),
            flags: Rustc::flags(Target::Own).join(" "),
            reference: Against::of(robot),
            reference_bits: BITS,
            bound: settings.bound,
            optimised: !cfg!(debug_assertions),
            units: UNITS,
            peers: Vec::new(),
            notes: Vec::new(),
            functions: Vec::new(),
            making: Vec::new(),
        }
    }

    /// Engines of the peers, in the order in which they are met.
    pub(super) fn engines(&self) -> Vec<&str> {
        let mut engines: Vec<&str> = Vec::new();
        for peer in self.functions.iter().flat_map(|f| &f.peers) {
            if !engines.contains(&peer.engine.as_str()) {
                engines.push(&peer.engine);
            }
        }
        engines
    }

    /// The first error or difference that is too large, as a sentence. `bound`: of errors,
    /// `other_bound`: of the differences of other code of ours.
    pub(super) fn beyond(&self, bound: f64, other_bound: f64) -> Option<String> {
        let beyond = |x: f64, bound: f64| x.is_nan() || x > bound;
        self.functions.iter().find_map(|f| {
            let sides = f.errors.map(|e| [("generated", e.generated), ("generic", e.generic)]).into_iter().flatten();
            let wrong = sides.into_iter().find(|(_, e)| beyond(*e, bound));
            let ours = wrong.map(|(side, e)| format!("{}: the error of {side} code is {e:.1} units, more than {bound}", f.function));
            let variants = f.variants.iter().map(|v| (format!("the code of \"{}\"", v.variant), v.largest_difference, other_bound));
            let peers = f.peers.iter().map(|p| (format!("peer {}", p.peer), p.largest_difference, p.bound));
            let lanes = f.peers_in_lanes.iter().map(|p| (format!("peer {}", p.peer), p.largest_difference, p.bound));
            let batches = f.batches.iter().map(|b| (format!("batch of {} in {}", b.numbers, b.layout), b.largest_difference, b.bound));
            let far = variants
                .chain(batches)
                .chain(peers)
                .chain(lanes)
                .filter_map(|(who, d, bound)| Some((who, d?, bound)))
                .find(|(_, d, bound)| beyond(*d, *bound));
            ours.or(far.map(|(who, d, bound)| format!("{}: {who} differs by {d:.1e} of the magnitude, more than {bound:e}", f.function)))
        })
    }
}
