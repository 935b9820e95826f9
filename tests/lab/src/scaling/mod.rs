//! How costs grow with the robot: chains of different lengths.

pub mod chain;
mod document;
mod measure;
mod plot;
mod report;
mod text;

use std::path::Path;

use articulated_core::algorithm::{Function, Shape, function};

use crate::compiled::{FILLER_INSTRUCTIONS, Rustc, Target};
use crate::console::Progress;
use crate::error::Error;
use crate::table::counted;
use measure::Cold;
pub use report::Report;

/// Lengths of chains, and the maximum length of a result: a matrix and its costs grow with the
/// square of the chain.
struct Extent {
    joints: &'static [usize],
    numbers: usize,
}

/// A minute or two.
const SHORT: Extent = Extent { joints: &[7, 14, 30, 60, 125], numbers: 1_000 };
/// All of it.
const WHOLE: Extent = Extent { joints: &[7, 14, 30, 60, 125, 250, 500, 1000], numbers: 16_000 };

const FUNCTIONS: [&str; 3] = ["inverse_dynamics", "mass_matrix", "forward_dynamics"];

/// Settings of the measurement.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Numbers of joints; if empty, a short list.
    pub joints: Vec<usize>,
    /// The functions; if empty, three of dynamics.
    pub functions: Vec<String>,
    /// A long list of lengths instead of the short one.
    pub all: bool,
    /// How often each is timed.
    pub repetitions: u32,
}

/// Measures chains.
pub fn measure(settings: &Settings) -> Result<Report, Error> {
    let rustc = Rustc::find().map_err(|e| Error::tool(&e))?;
    let mut report = Report {
        compiler: rustc.version.clone(),
        flags: Rustc::flags(Target::Own).join(" "),
        optimised: !cfg!(debug_assertions),
        states: measure::STATES,
        repetitions: settings.repetitions,
        buffer_bytes: measure::BUFFER,
        filler_instructions: FILLER_INSTRUCTIONS,
        units: report::UNITS,
        points: Vec::new(),
        crossovers: Vec::new(),
        growth: Vec::new(),
        notes: Vec::new(),
    };
    let plan = plan(settings, &mut report.notes);
    let mut cold = Cold::new(&rustc).map_err(|e| Error::tool(&e))?;
    let progress = Progress::new(plan.len());
    let mut points = Vec::new();
    for (function, joints) in plan {
        progress.doing(format!("{}, {}", function.name, counted(joints, "joint")));
        points.push(measure::point(function, joints, settings.repetitions as usize, &rustc, &mut cold)?);
        progress.step();
    }
    drop(progress);
    report.conclude(points);
    Ok(report)
}

impl Report {
    /// As tables.
    pub fn text(&self) -> String {
        text::text(self)
    }

    /// As a document in Markdown that refers to the file of its chart.
    pub fn markdown(&self, chart: Option<&Path>) -> String {
        document::markdown(self, chart)
    }

    /// The times against the number of joints, in SVG.
    pub fn chart(&self) -> String {
        plot::svg(self)
    }
}

/// Every function on every length that its result allows.
fn plan(settings: &Settings, notes: &mut Vec<String>) -> Vec<(&'static Function<f64>, usize)> {
    let extent = if settings.all { WHOLE } else { SHORT };
    let mut joints = if settings.joints.is_empty() { extent.joints.to_vec() } else { settings.joints.clone() };
    joints.sort_unstable();
    joints.dedup();
    let numbers = if settings.joints.is_empty() { extent.numbers } else { WHOLE.numbers };
    let mut names = settings.functions.clone();
    if names.is_empty() {
        names = FUNCTIONS.map(str::to_owned).to_vec();
    }
    let mut seen: Vec<String> = Vec::new();
    let mut plan = Vec::new();
    for name in names {
        if seen.contains(&name) {
            continue;
        }
        if let Some(f) = function::<f64>(&name) {
            let fits = |n: &usize| f.len(shape(*n)) <= numbers;
            plan.extend(joints.iter().copied().filter(fits).map(|n| (f, n)));
            let left: Vec<String> = joints.iter().filter(|n| !fits(n)).map(usize::to_string).collect();
            if !left.is_empty() {
                notes.push(format!("{name} is left out at {} joints: its result has more than {numbers} numbers", left.join(", ")));
            }
        }
        seen.push(name);
    }
    plan
}

/// The shape of a chain with the frame of its tip.
fn shape(joints: usize) -> Shape {
    Shape { nq: joints, nv: joints, frames: 1, links: joints, ..Shape::default() }
}
