//! The words of `accuracy`.

use std::path::PathBuf;

use articulated_codegen::Level;
use clap::Args;

use crate::arguments::RobotArguments;
use crate::edits::FrameArguments;
use crate::names::{Names, known};

/// What motions have no use for: how to read and edit a robot, which a scene says, and which functions to measure on which states.
const OF_FUNCTIONS: [&str; 15] = [
    "floating",
    "fixed",
    "gravity",
    "allow_unphysical_inertia",
    "snap_angles",
    "rename",
    "append",
    "payload",
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
    /// The functions to measure, or groups of them [default: placements,inverse_dynamics,mass_matrix,forward_dynamics]
    #[arg(long, alias = "function", value_name = "NAMES", value_parser = known)]
    pub(crate) functions: Vec<Names>,
    /// The levels to measure [default: all that are told apart]
    #[arg(long, alias = "level", value_name = "LEVELS", value_delimiter = ',')]
    pub(crate) levels: Vec<Level>,
    /// How many states at random within the limits of the joints; the hard ones come beside them
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(crate) states: u32,
    /// Seed of the random states
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) seed: u64,
    /// How often each is timed, once at least; of motions the fastest of five at most counts
    #[arg(long, value_name = "N", default_value_t = 31, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub(crate) repetitions: u32,
    /// A peer library to measure beside them; may be given several times. It is run: name only libraries that you trust
    #[arg(long, value_name = "LIBRARY")]
    pub(crate) peer: Vec<PathBuf>,
    /// A list of peer libraries, as the peers' build script writes it
    #[arg(long, value_name = "FILE")]
    pub(crate) peers_manifest: Option<PathBuf>,
    /// The folder to write report.html, accuracy.csv, accuracy.json and diagrams in SVG and PNG to; with --simulate integrators.html, integrators.csv, integrators.json and diagrams
    #[arg(short, long, value_name = "FOLDER")]
    pub(crate) output: Option<PathBuf>,
    /// Measure integrators instead, on the motion of a scene: ROBOT is a scene's file, or the name of a bundled scene
    #[arg(long, conflicts_with_all = OF_FUNCTIONS)]
    pub(crate) simulate: bool,
    /// Only name the cheapest level of each function whose largest error is no larger than --error (exit status 4 if one has none)
    #[arg(long, requires = "error")]
    pub(crate) advise: bool,
    /// The largest error that is right, relative to the sum of the magnitudes of the terms; of a motion rad, m, and those a second
    #[arg(long, value_name = "ERROR", value_parser = wish, requires = "advise", allow_hyphen_values = true)]
    pub(crate) error: Option<f64>,
}

fn wish(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|x: &f64| x.is_finite() && *x > 0.0).ok_or_else(|| "expected a positive number as 1e-9".into())
}
