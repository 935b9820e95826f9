//! `articulated scaling`.

pub mod chain;
mod cold;
mod document;
mod measure;
mod plot;
mod report;
mod text;

use articulated_core::algorithm::{Function, Shape, function};

use crate::arguments::{Format, ScalingArguments};
use crate::compiled::{FILLER_INSTRUCTIONS, Rustc, Target};
use crate::console::{self, Progress};
use crate::failure::Failure;
use crate::names;
use crate::output;
use crate::table::counted;
use cold::Cold;
use report::Report;

/// Lengths of chains, and the most numbers that a result may have: a matrix grows with the square of the chain, and so does all that it costs.
struct Extent {
    joints: &'static [usize],
    numbers: usize,
}

/// A minute or two.
const SHORT: Extent = Extent { joints: &[7, 14, 30, 60, 125], numbers: 1_000 };
/// All of it.
const WHOLE: Extent = Extent { joints: &[7, 14, 30, 60, 125, 250, 500, 1000], numbers: 16_000 };

const FUNCTIONS: [&str; 3] = ["inverse_dynamics", "mass_matrix", "forward_dynamics"];

/// Measures and prints.
pub(crate) fn run(arguments: &ScalingArguments, format: Format) -> Result<(), Failure> {
    if cfg!(debug_assertions) {
        console::warn("this command was built without optimisation: times of generic code, and of the generation, mean little");
    }
    arguments.chart.as_deref().map_or(Ok(()), |path| output::file("--chart", path))?;
    let rustc = Rustc::find().map_err(|e| Failure::tool(&e))?;
    let mut report = Report {
        compiler: rustc.version.clone(),
        flags: Rustc::flags(Target::Own).join(" "),
        optimised: !cfg!(debug_assertions),
        states: measure::STATES,
        repetitions: arguments.repetitions,
        buffer_bytes: cold::BUFFER,
        filler_instructions: FILLER_INSTRUCTIONS,
        units: report::UNITS,
        points: Vec::new(),
        crossovers: Vec::new(),
        growth: Vec::new(),
        notes: Vec::new(),
    };
    let plan = plan(arguments, &mut report.notes);
    let mut cold = Cold::new(&rustc).map_err(|e| Failure::tool(&e))?;
    let progress = Progress::new(plan.len());
    let mut points = Vec::new();
    for (function, joints) in plan {
        progress.doing(format!("{}, {}", function.name, counted(joints, "joint")));
        points.push(measure::measure(function, joints, arguments.repetitions as usize, &rustc, &mut cold)?);
        progress.step();
    }
    drop(progress);
    report.conclude(points);
    console::print(&match format {
        Format::Json => crate::json(&report),
        Format::Text if arguments.markdown => document::markdown(&report, arguments.chart.as_deref()),
        Format::Text => text::text(&report),
    })?;
    // What took minutes to measure is told even if the drawing cannot be written.
    arguments.chart.as_ref().map_or(Ok(()), |path| output::write(path, plot::svg(&report))).map_err(Failure::after_report)
}

/// Every function on every length that its result allows.
fn plan(arguments: &ScalingArguments, notes: &mut Vec<String>) -> Vec<(&'static Function<f64>, usize)> {
    let extent = if arguments.all { WHOLE } else { SHORT };
    let mut joints = if arguments.joints.is_empty() { extent.joints.to_vec() } else { arguments.joints.clone() };
    joints.sort_unstable();
    joints.dedup();
    let numbers = if arguments.joints.is_empty() { extent.numbers } else { WHOLE.numbers };
    let mut names = names::flat(&arguments.functions);
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

/// Of a chain with the frame of its tip.
fn shape(joints: usize) -> Shape {
    Shape { nq: joints, nv: joints, frames: 1, links: joints }
}
