//! `articulated stress`.

use std::path::{Path, PathBuf};

use articulated_codegen::Precision;
use articulated_core::algorithm::Argument;
use articulated_core::model::Model;
use articulated_lab::states;
use articulated_lab::stress::judge::State;
use articulated_lab::stress::{Settings, of_corpus, of_robot};
use clap::Args;

use crate::arguments::{Format, Gravity, RobotArguments, gravity};
use crate::console;
use crate::failure::{Failure, OK};
use crate::robot::{Robot, read_bytes};

#[derive(Args, Debug)]
pub(crate) struct StressArguments {
    /// A bundled robot's or scene's name (a robot's first), the path of a robot file (URDF, xacro,
    /// MJCF or SDF) or of a scene (.toml), or - for a robot file on the standard input
    /// [default: the corpus and all bundled robots]
    #[arg(value_name = "ROBOT")]
    pub(crate) robot: Option<PathBuf>,
    /// The root link moves freely (bundled robots know their own base)
    #[arg(long, conflicts_with = "fixed", requires = "robot")]
    pub(crate) floating: bool,
    /// The root link is fixed
    #[arg(long, requires = "robot")]
    pub(crate) fixed: bool,
    /// Gravity in the world frame, m/s² [default: 0,0,-9.81]
    #[arg(long, value_name = "X,Y,Z", value_parser = gravity, allow_hyphen_values = true, requires = "robot")]
    pub(crate) gravity: Option<Gravity>,
    /// Accept negative principal moments
    #[arg(long, requires = "robot")]
    pub(crate) allow_unphysical_inertia: bool,
    /// A JSON or CSV file of states of the robot, beside the random and hard ones
    #[arg(long, value_name = "FILE", requires = "robot")]
    pub(crate) states: Option<PathBuf>,
    /// Also test generated code, compiled by rustc
    #[arg(long)]
    pub(crate) generated: bool,
    /// Levels of accuracy of generated code [default: all of the corpus, f64 of robots]
    #[arg(long, alias = "level", value_name = "LEVELS", value_delimiter = ',', requires = "generated")]
    pub(crate) levels: Vec<Precision>,
    /// Only these chapters of the corpus
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = chapters(), conflicts_with = "robot")]
    pub(crate) chapters: Vec<String>,
    /// Run everything: longer chains, ten million steps, every level on every robot; takes minutes
    #[arg(long, conflicts_with = "robot")]
    pub(crate) full: bool,
    /// Print every row, not only the row of each case that is nearest to its limit
    #[arg(long)]
    pub(crate) rows: bool,
}

fn chapters() -> clap::builder::PossibleValuesParser {
    clap::builder::PossibleValuesParser::new(articulated_lab::stress::chapters())
}

/// Measures and prints; a row that is wrong is an exceeded bound.
pub(crate) fn run(arguments: &StressArguments, format: Format) -> Result<u8, Failure> {
    let StressArguments { chapters, full, generated, levels, .. } = arguments;
    let settings = Settings { chapters: chapters.clone(), full: *full, generated: *generated, levels: levels.clone() };
    let report = match &arguments.robot {
        Some(name) => {
            let robot = robot(arguments, name)?;
            let model = robot.whole_model(&robot.read()?)?;
            let given = arguments.states.as_deref().map_or_else(|| Ok(Vec::new()), |file| read_states(&model, file))?;
            of_robot(&robot.loaded(), &model, &given, &settings)?
        }
        None => of_corpus(&settings)?,
    };
    console::report(format, || report.text(arguments.rows), || crate::json(&report))?;
    report.exceeded().map_or(Ok(OK), |line| Err(Failure::bound_of_report(line)))
}

fn robot(arguments: &StressArguments, name: &Path) -> Result<Robot, Failure> {
    let mut robot = RobotArguments::plain(name, arguments.floating);
    robot.fixed = arguments.fixed;
    robot.gravity = arguments.gravity;
    robot.allow_unphysical_inertia = arguments.allow_unphysical_inertia;
    Robot::find(&robot)
}

/// The states of a file; missing values are zero.
fn read_states(model: &Model<f64>, path: &Path) -> Result<Vec<State>, Failure> {
    let file = path.display();
    let bytes = read_bytes(path).map_err(|e| Failure::input([format!("{file}: {e}")]))?;
    let read = states::read(&bytes, model).map_err(|lines| Failure::input(lines.into_iter().map(|l| format!("{file}: {l}"))))?;
    read.warnings.iter().for_each(|w| console::warn(w));
    let one = |s: &states::State| {
        let of = |a: Argument| s.get(a).map_or_else(|| vec![0.0; a.len(model.shape())], <[f64]>::to_vec);
        State { q: of(Argument::Q), v: of(Argument::V), a: of(Argument::A), tau: of(Argument::Tau) }
    };
    Ok(read.states.iter().map(one).collect())
}
