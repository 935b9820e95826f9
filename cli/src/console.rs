//! Output of the command: see [`articulated_lab::console`].

use std::cell::RefCell;

pub(crate) use articulated_lab::console::{Progress, error, note, refuse, warn};

use articulated_lab::console::error_of_tool;

use crate::arguments::Format;
use crate::excerpt::Excerpts;
use crate::failure::Failure;

/// Writes to the standard output. A closed pipe is not an error.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    articulated_lab::console::print(text).map_err(|error| Failure::input([format!("standard output: {error}")]))
}

thread_local! {
    /// Captures this thread's report instead of the standard output.
    static CAPTURED: RefCell<Option<Reports>> = const { RefCell::new(None) };
}

/// A report in both formats.
#[derive(Clone, Debug, Default)]
pub(crate) struct Reports {
    pub(crate) text: String,
    pub(crate) json: String,
}

/// Prints a report in the requested format, or keeps it in both while [`capture`] runs.
pub(crate) fn report(format: Format, text: impl FnOnce() -> String, json: impl FnOnce() -> String) -> Result<(), Failure> {
    let captures = CAPTURED.with_borrow(Option::is_some);
    if captures {
        let reports = Reports { text: text(), json: json() };
        CAPTURED.set(Some(reports));
        return Ok(());
    }
    print(&match format {
        Format::Text => text(),
        Format::Json => json(),
    })
}

/// Runs, and returns this thread's report in both formats instead of printing it.
pub(crate) fn capture<T>(run: impl FnOnce() -> T) -> (T, Reports) {
    let before = CAPTURED.replace(Some(Reports::default()));
    let out = run();
    (out, CAPTURED.replace(before).unwrap_or_default())
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
