//! `articulated accuracy`.

use std::path::PathBuf;

use articulated_codegen::Precision;
use articulated_lab::{accuracy, tips::Tips};
use clap::Args;

use crate::arguments::{Format, RobotArguments};
use crate::edits::FrameArguments;
use crate::failure::Failure;
use crate::names::{self, Names, known};
use crate::robot::Robot;
use crate::{console, named_scene, output};

/// The commit that this command was built from; see `build.rs`.
const COMMIT: &str = match option_env!("ARTICULATED_COMMIT") {
    Some(commit) => commit,
    None => "commit not told when this was built",
};

/// Options that do not apply to motions: reading and editing of a robot, which a scene determines,
/// and functions and states to measure.
const OF_FUNCTIONS: [&str; 21] = [
    "floating",
    "fixed",
    "gravity",
    "allow_unphysical_inertia",
    "first_of_duplicates",
    "leave_out",
    "allow_unknown_version",
    "snap_angles",
    "arg",
    "package",
    "rename",
    "append",
    "payload",
    "coupling",
    "lock",
    "frames",
    "wrenches_in",
    "functions",
    "levels",
    "states",
    "seed",
];

#[derive(Args, Debug)]
pub(crate) struct AccuracyArguments {
    #[command(flatten)]
    pub(crate) robot: RobotArguments,
    #[command(flatten)]
    pub(crate) frames: FrameArguments,
    /// The functions to measure, or groups of them
    /// [default: placements,inverse_dynamics,mass_matrix,forward_dynamics]
    #[arg(long, alias = "function", value_name = "NAMES", value_parser = known)]
    pub(crate) functions: Vec<Names>,
    /// Levels of accuracy to measure [default: all distinct ones]
    #[arg(long, alias = "level", value_name = "LEVELS", value_delimiter = ',')]
    pub(crate) levels: Vec<Precision>,
    /// Number of random states within the joint limits; hard states are added
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(crate) states: u32,
    /// Seed of the random states
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) seed: u64,
    /// Repetitions of each timing, at least 1; for motions the fastest of at most five counts
    #[arg(long, value_name = "N", default_value_t = 31, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub(crate) repetitions: u32,
    /// A peer library to measure beside them; may be given several times. It is run: name only
    /// libraries that you trust
    #[arg(long, value_name = "LIBRARY")]
    pub(crate) peer: Vec<PathBuf>,
    /// A list of peer libraries, as the peers' build script writes it
    #[arg(long, value_name = "FILE")]
    pub(crate) peers_manifest: Option<PathBuf>,
    /// The folder to write report.html, accuracy.csv, accuracy.json and diagrams in SVG to; with
    /// --simulate integrators.html, integrators.csv, integrators.json and diagrams
    #[arg(short, long, value_name = "FOLDER")]
    pub(crate) output: Option<PathBuf>,
    /// Measure integrators instead, on the motion of a scene: ROBOT is a scene's file, or the name
    /// of a bundled scene
    #[arg(long, conflicts_with_all = OF_FUNCTIONS)]
    pub(crate) simulate: bool,
    /// Only name the cheapest level of each function whose largest error is no larger than --error
    /// (exit status 4 if one has none)
    #[arg(long, requires = "error")]
    pub(crate) advise: bool,
    /// Largest accepted error, relative to the sum of the magnitudes of the terms; for a motion in
    /// rad, m, rad/s, m/s
    #[arg(long, value_name = "ERROR", value_parser = wish, requires = "advise", allow_hyphen_values = true)]
    pub(crate) error: Option<f64>,
}

/// Measures and prints.
pub(crate) fn run(arguments: &AccuracyArguments, format: Format) -> Result<(), Failure> {
    if arguments.simulate { motions(arguments, format) } else { functions(arguments, format) }
}

/// Functions at levels.
fn functions(arguments: &AccuracyArguments, format: Format) -> Result<(), Failure> {
    let mut robot = Robot::find(&arguments.robot)?.with(&arguments.frames);
    let built = robot.read()?;
    let reading = &built.reading;
    robot.warn_of(reading.warnings.iter().chain(&reading.snapped));
    if robot.options.robot.frames.is_none() {
        let tips = Tips::of(&reading.description, &robot.whole_model(&built)?);
        robot = robot.on(tips.all());
    }
    arguments.output.as_deref().map_or(Ok(()), |folder| output::folder("--output", folder))?;
    let settings = accuracy::Settings {
        functions: names::flat(&arguments.functions),
        levels: arguments.levels.clone(),
        states: arguments.states,
        seed: arguments.seed,
        repetitions: arguments.repetitions,
        peer: arguments.peer.clone(),
        peers_manifest: arguments.peers_manifest.clone(),
        commit: COMMIT,
    };
    let report = accuracy::measure(&robot.loaded(), &reading.description, &settings)?;
    let wish = arguments.error.filter(|_| arguments.advise);
    let text = match (wish, format) {
        (Some(wish), Format::Text) => report.advice_in_text(wish),
        (Some(wish), Format::Json) => crate::json(&report.advice(wish)),
        (None, Format::Text) => report.text(),
        (None, Format::Json) => crate::json(&report),
    };
    concluded(arguments, &text, || report.files(), wish.and_then(|wish| report.short_of(wish)))
}

/// Integrators on the motion of a scene.
fn motions(arguments: &AccuracyArguments, format: Format) -> Result<(), Failure> {
    let session = named_scene::session(&arguments.robot.robot)?;
    arguments.output.as_deref().map_or(Ok(()), |folder| output::folder("--output", folder))?;
    let settings = accuracy::motion::Settings {
        repetitions: arguments.repetitions,
        peer: arguments.peer.clone(),
        peers_manifest: arguments.peers_manifest.clone(),
        commit: COMMIT,
    };
    let motion = accuracy::motion::measure(&session, &settings)?;
    let wish = arguments.error.filter(|_| arguments.advise);
    let text = match (wish, format) {
        (Some(wish), Format::Text) => motion.advice_in_text(wish),
        (Some(wish), Format::Json) => crate::json(&motion.advice(wish)),
        (None, Format::Text) => motion.text(),
        (None, Format::Json) => crate::json(&motion),
    };
    concluded(arguments, &text, || motion.files(), wish.and_then(|wish| motion.short_of(wish)))
}

/// Prints a report, writes its files, and fails if `short` names a missed goal.
fn concluded(
    arguments: &AccuracyArguments,
    text: &str,
    files: impl FnOnce() -> Vec<(String, String)>,
    short: Option<String>,
) -> Result<(), Failure> {
    console::print(text)?;
    // Results of long measurements are printed even if the files cannot be written.
    if let Some(folder) = &arguments.output {
        for (name, content) in files() {
            output::write(&folder.join(name), content).map_err(Failure::after_report)?;
        }
    }
    short.map_or(Ok(()), |line| Err(Failure::bound_of_report(line)))
}

fn wish(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|x: &f64| x.is_finite() && *x > 0.0).ok_or_else(|| "expected a positive number as 1e-9".into())
}
