//! The words of `stress`.

use std::path::PathBuf;

use articulated_codegen::Level;
use clap::Args;

use crate::arguments::{Gravity, gravity};

#[derive(Args, Debug)]
pub(crate) struct StressArguments {
    /// A bundled robot's or scene's name (a robot's first), the path of a URDF or of a scene (.toml), or - for a URDF on the standard input [default: the corpus and all bundled robots]
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
    /// A file of states of the robot in JSON or CSV, besides those at random and the hard ones
    #[arg(long, value_name = "FILE", requires = "robot")]
    pub(crate) states: Option<PathBuf>,
    /// Generated code too, compiled by rustc
    #[arg(long)]
    pub(crate) generated: bool,
    /// Levels of accuracy of generated code [default: all of the corpus, f64 of robots]
    #[arg(long, alias = "level", value_name = "LEVELS", value_delimiter = ',', requires = "generated")]
    pub(crate) levels: Vec<Level>,
    /// Only these chapters of the corpus
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = chapters(), conflicts_with = "robot")]
    pub(crate) chapters: Vec<String>,
    /// All of it: longer chains, ten million steps, every level on every robot; takes minutes
    #[arg(long, conflicts_with = "robot")]
    pub(crate) full: bool,
    /// Every row, and not only the one of each case that comes nearest to its limit
    #[arg(long)]
    pub(crate) rows: bool,
}

fn chapters() -> clap::builder::PossibleValuesParser {
    let names =
        crate::stress::corpus::CHAPTERS.iter().map(|(name, _)| *name).chain([crate::stress::levels::NAME, crate::stress::own::NAME]);
    clap::builder::PossibleValuesParser::new(names)
}
