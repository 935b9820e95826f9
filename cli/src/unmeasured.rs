//! In place of the commands that measure, in a build without the feature `measure`, as that of the
//! Python package: they are refused.

use std::ffi::OsString;

use clap::{Args, Subcommand};

use crate::arguments::Format;
use crate::failure::Failure;

/// The answer to each of the commands.
const REFUSED: &str = "this build of `articulated` does not measure: `compare`, `accuracy`, `scaling` and `stress` are in the command that `cargo install --path cli` builds";

#[derive(Debug, Subcommand)]
pub(crate) enum Measurement {
    Compare(Words),
    Accuracy(Words),
    Scaling(Words),
    Stress(Words),
}

/// All words are accepted, so that no other error comes before the refusal.
#[derive(Args, Debug)]
#[command(hide = true, override_help = REFUSED)]
pub(crate) struct Words {
    #[arg(allow_hyphen_values = true)]
    _words: Vec<OsString>,
}

/// Refuses.
pub(crate) fn run(_: &Measurement, _: Format) -> Result<u8, Failure> {
    Err(Failure::usage(REFUSED.to_owned()))
}

/// The refusal of an option that compiles code.
pub(crate) fn refused(option: &str) -> Failure {
    Failure::usage(format!(
        "{option}: this build of `articulated` does not compile code: the option is in the command that `cargo install --path cli` builds"
    ))
}
