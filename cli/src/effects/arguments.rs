//! The words of `articulated effects`.

use std::path::PathBuf;

use clap::Args;

use crate::names::{Names, known};

#[derive(Args, Debug)]
pub(crate) struct EffectsArguments {
    /// A bundled scene's name, or the path of a scene
    #[arg(value_name = "SCENE")]
    pub(crate) scene: PathBuf,
    /// The functions whose costs are told, or groups of them [default: inverse_dynamics,forward_dynamics]
    #[arg(long, alias = "function", value_name = "NAMES", value_parser = known)]
    pub(crate) functions: Vec<Names>,
    /// Nanoseconds too: everything is compiled by rustc and timed
    #[arg(long)]
    pub(crate) time: bool,
    /// How often each is timed
    #[arg(long, value_name = "N", default_value_t = 61, value_parser = clap::value_parser!(u32).range(5..=100_000))]
    pub(crate) repetitions: u32,
}
