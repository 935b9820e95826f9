//! What the command prints: see [`articulated_lab::console`].

pub(crate) use articulated_lab::console::{Progress, error, note, refuse, warn};

use articulated_lab::console::error_of_tool;

use crate::excerpt::Excerpts;
use crate::failure::Failure;

/// Writes to the standard output. A reader that has gone away is not an error.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    articulated_lab::console::print(text).map_err(|error| Failure::input([format!("standard output: {error}")]))
}

/// Each error of a failure.
pub(crate) fn failed(failure: &Failure) {
    let line = if failure.is_of_tool() { error_of_tool } else { error };
    let mut excerpts = Excerpts::default();
    for error in &failure.errors {
        line(&error.message);
        excerpts.of(error).iter().for_each(|excerpt| refuse(excerpt));
    }
}
