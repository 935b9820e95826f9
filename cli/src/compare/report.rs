//! What was measured, as data.

use articulated_core::algorithm::Dim;
use articulated_core::model::Model;
use serde::Serialize;

use super::accuracy::Errors;
use super::prepare::Prepared;
use super::timing::{self, Summary};
use crate::arguments::CompareArguments;
use crate::compiled::Rustc;
use crate::groups::Group;
use crate::ledger::{Stage, stages};
use crate::precise::BITS;
use crate::robot::Robot;
use crate::tips::Tips;

#[derive(Clone, Debug, Serialize)]
pub(super) struct Report {
    pub(super) robot: String,
    pub(super) base: &'static str,
    pub(super) gravity: [f64; 3],
    pub(super) joints: usize,
    pub(super) degrees_of_freedom: usize,
    /// The frames of functions of frames, and whether the user chose them or they are the robot's tips.
    pub(super) frames: Vec<String>,
    pub(super) frames_chosen: bool,
    pub(super) states: u32,
    pub(super) seed: u64,
    pub(super) repetitions: u32,
    pub(super) compiler: String,
    pub(super) flags: String,
    /// Bits of the numbers of the reference.
    pub(super) reference_bits: usize,
    /// The largest error that is right, in units of 2⁻⁵³ of the magnitude.
    pub(super) bound: f64,
    /// Whether the command itself is optimised; generic code and generation are as fast as it is.
    pub(super) optimised: bool,
    pub(super) notes: Vec<String>,
    pub(super) functions: Vec<FunctionReport>,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct FunctionReport {
    pub(super) function: &'static str,
    pub(super) group: &'static str,
    /// The ways that the generator chose by count, where it had a choice.
    pub(super) ways: Vec<&'static str>,
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
    /// ns per call.
    pub(super) generic: Summary,
    pub(super) generic_over_generated: Summary,
    pub(super) peers: Vec<PeerReport>,
    /// In units of 2⁻⁵³ of the magnitude; `None` where there is no reference for the function.
    pub(super) errors: Option<Errors>,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct PeerReport {
    pub(super) peer: String,
    /// ns per call.
    pub(super) time: Summary,
    pub(super) generic_over_peer: Summary,
    pub(super) generated_over_peer: Summary,
    /// Relative to the magnitude; `None` where the peer keeps its results to itself.
    pub(super) largest_difference: Option<f64>,
}

impl FunctionReport {
    /// `times`: ns a call of generated code, generic code and each peer.
    pub(super) fn new(ready: &Prepared, times: &[Vec<f64>], peers: Vec<PeerReport>) -> Self {
        let (f, entry) = (ready.function, &ready.entry);
        let dims = f.takes.iter().flat_map(|a| a.dims()).chain(f.gives);
        let framed = dims.into_iter().any(|d| *d == Dim::Frames);
        Self {
            function: f.name,
            group: Group::of(f.id).name(),
            ways: entry.ways.clone(),
            frames: framed.then(|| ready.model.frames.iter().map(|f| f.name.clone()).collect()),
            stages: stages(entry),
            depth: entry.depth,
            code_bytes: ready.compiled.code_bytes(f.name),
            source_bytes: ready.source_bytes,
            generation_seconds: ready.generation.as_secs_f64(),
            compilation_seconds: ready.compiled.time.as_secs_f64(),
            generated: timing::summary(&times[0]),
            generic: timing::summary(&times[1]),
            generic_over_generated: timing::ratio(&times[1], &times[0]),
            peers,
            errors: ready.errors,
        }
    }

    /// The peer that was fastest.
    pub(super) fn fastest(&self) -> Option<&PeerReport> {
        self.peers.iter().min_by(|a, b| a.time.median.total_cmp(&b.time.median))
    }
}

impl Report {
    pub(super) fn new(robot: &Robot, model: &Model<f64>, tips: Option<&Tips>, arguments: &CompareArguments, rustc: &Rustc) -> Self {
        let chosen = robot.options.frames.clone();
        Self {
            frames_chosen: chosen.is_some(),
            frames: chosen.unwrap_or_else(|| tips.map_or_else(Vec::new, |t| t.all().to_vec())),
            robot: robot.file.clone(),
            base: robot.base(),
            gravity: robot.options.gravity,
            joints: model.joints.len(),
            degrees_of_freedom: model.nv,
            states: arguments.states,
            seed: arguments.seed,
            repetitions: arguments.repetitions,
            compiler: rustc.version.clone(),
            flags: Rustc::flags().join(" "),
            reference_bits: BITS,
            bound: arguments.bound,
            optimised: !cfg!(debug_assertions),
            notes: Vec::new(),
            functions: Vec::new(),
        }
    }

    /// The first error or difference beyond its bound, as a sentence.
    pub(super) fn exceeded(&self, bound: f64, peer_bound: f64) -> Option<String> {
        let beyond = |x: f64, bound: f64| x.is_nan() || x > bound;
        self.functions.iter().find_map(|f| {
            let sides = f.errors.map(|e| [("generated", e.generated), ("generic", e.generic)]).into_iter().flatten();
            let wrong = sides.into_iter().find(|(_, e)| beyond(*e, bound));
            let ours = wrong.map(|(side, e)| format!("{}: the error of {side} code is {e:.1} units, more than {bound}", f.function));
            let far = f.peers.iter().find(|p| p.largest_difference.is_some_and(|d| beyond(d, peer_bound)));
            let theirs = far.map(|p| {
                let d = p.largest_difference.unwrap_or(f64::NAN);
                format!("{}: peer {} differs by {d:.1e} of the magnitude, more than {peer_bound:e}", f.function, p.peer)
            });
            ours.or(theirs)
        })
    }
}
