//! The words of `articulated simulate`.

use std::path::PathBuf;

use articulated_formats::LeaveOut;
use clap::{ArgGroup, Args};

use crate::arguments::Package;

#[derive(Args, Debug, Default)]
#[command(group = ArgGroup::new("written").args(["output", "mcap"]).multiple(true))]
#[command(group = ArgGroup::new("of_file").args(["smooth", "constraints"]))]
pub(crate) struct SimulateArguments {
    /// A bundled scene's name, the path of a scene, or the path of a robot's file (URDF, xacro,
    /// MJCF or SDF). An MJCF with limits, dry friction, equations or contacts moves as with
    /// `--constraints`; of other files, and with an integrator, the smooth motion is simulated
    #[arg(value_name = "SCENE", required_unless_present = "all")]
    pub(crate) scene: Option<PathBuf>,
    /// The smooth motion that a robot's file describes, without contacts, limits and dry friction:
    /// its method, step and actuators, from its keyframe `home` or its initial state. As MuJoCo's
    /// with constraints off
    #[arg(long, conflicts_with_all = ["all", "generated", "against", "integrator", "rtol", "atol"])]
    pub(crate) smooth: bool,
    /// The same with limits, dry friction, equations and contacts of the file, by MuJoCo's law: the
    /// default of an MJCF that has some
    #[arg(long, conflicts_with_all = ["print_scene", "all", "generated", "against", "integrator", "rtol", "atol"])]
    pub(crate) constraints: bool,
    /// Leave out kinds of constraints that are not computed, with a warning: contact, constraint,
    /// solver
    #[arg(long, value_name = "KINDS", value_delimiter = ',', conflicts_with = "smooth")]
    pub(crate) leave_out: Vec<LeaveOut>,
    /// Start with this keyframe of the file, and its controls, instead of `home`
    #[arg(long, value_name = "NAME")]
    pub(crate) keyframe: Option<String>,
    /// Print the scene that a robot's file is simulated as, to begin a scene of your own; with
    /// `--smooth` that of an integrator, with effects in place of a law
    #[arg(long, conflicts_with_all = ["all", "output", "mcap", "generated", "against", "end", "integrator", "step", "rtol", "atol", "every"])]
    pub(crate) print_scene: bool,
    /// Instead of one scene, how fast each bundled scene is, by generated and by generic code
    #[arg(long, conflicts_with_all = ["scene", "output", "generated", "against", "mcap"])]
    pub(crate) all: bool,
    /// The folder to write to, made if it is not there; or FILE.html, the page alone that plays the
    /// motion
    #[arg(short, long, value_name = "FOLDER")]
    pub(crate) output: Option<PathBuf>,
    /// The folder of a ROS package, for meshes named package://NAME/…; of a FOLDER alone the last
    /// component is the name. May be repeated
    #[arg(long, value_name = "NAME=FOLDER", requires = "output", value_parser = Package::parse)]
    pub(crate) package: Vec<Package>,
    /// Also write joint states and transforms of all links to this MCAP file, for Foxglove and
    /// others
    #[arg(long, value_name = "FILE")]
    pub(crate) mcap: Option<PathBuf>,
    /// How many MB recording.csv, or the MCAP file, may become; more is refused before the motion
    /// begins [default: 1000]
    #[arg(long, value_name = "MB", requires = "written", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    pub(crate) max_output_size: Option<u64>,
    /// By generated code, compiled by rustc, instead of generic code
    #[arg(long)]
    pub(crate) generated: bool,
    /// The last time, s, instead of the scene's
    #[arg(long, value_name = "SECONDS", value_parser = time, allow_negative_numbers = true)]
    pub(crate) end: Option<f64>,
    /// The integrator, instead of the scene's; one that chooses its steps takes none of the scene's
    #[arg(long, value_name = "NAME", value_parser = integrator)]
    pub(crate) integrator: Option<String>,
    /// Fixed steps of this length, s
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) step: Option<f64>,
    /// Relative tolerance of a step, instead of the scene's
    #[arg(long, value_name = "TOL", conflicts_with = "step", allow_negative_numbers = true)]
    pub(crate) rtol: Option<f64>,
    /// Absolute tolerance of a step, rad, m, and those a second, instead of the scene's
    #[arg(long, value_name = "TOL", conflicts_with = "step", allow_negative_numbers = true)]
    pub(crate) atol: Option<f64>,
    /// Instead of writing a motion, measure how fast generated code gets to the scene's end at
    /// final errors of 1e-3, 1e-6 and 1e-9, beside peer libraries that take steps: one library, or
    /// a list of them. They are run: name only what you trust
    #[arg(long, value_name = "FILE", conflicts_with_all = ["output", "mcap", "generated", "integrator", "step", "rtol", "atol", "every"])]
    pub(crate) against: Option<PathBuf>,
    /// Record every so many seconds, instead of what the scene says (of a scene that records its
    /// ends only, nothing is drawn)
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) every: Option<f64>,
    /// Whether a program has filled these in, whose messages name fields and not options.
    #[arg(skip)]
    pub(crate) is_program: bool,
}

impl SimulateArguments {
    /// An option as messages name it.
    pub(super) fn option(&self, name: &str) -> String {
        if self.is_program { name.to_owned() } else { format!("--{name}") }
    }
}

fn time(text: &str) -> Result<f64, String> {
    text.trim().parse().ok().filter(|x: &f64| x.is_finite()).ok_or_else(|| "expected a number of seconds".into())
}

fn seconds(text: &str) -> Result<f64, String> {
    text.trim().parse().ok().filter(|x: &f64| *x > 0.0 && x.is_finite()).ok_or_else(|| "expected a number of seconds greater than 0".into())
}

/// The name of an integrator.
pub(super) fn integrator(text: &str) -> Result<String, String> {
    let names = || articulated::simulate::integrators().iter().map(|i| i.name);
    if names().any(|name| name == text) {
        return Ok(text.to_owned());
    }
    let elsewhere = articulated::simulate::resolve_synonym(text).map(|row| row.name.to_owned());
    let near = elsewhere.or_else(|| articulated_codegen::nearest(text, names())).map(|n| format!("did you mean {n}? ")).unwrap_or_default();
    Err(format!("{near}there are {}", names().collect::<Vec<_>>().join(", ")))
}
