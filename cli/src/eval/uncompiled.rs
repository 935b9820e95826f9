//! In place of compiled code, in a build that compiles none.

use articulated_core::algorithm::FunctionError;

use super::report::Report;
use crate::console;
use crate::failure::Failure;
use crate::measure::refused;
use crate::robot::Robot;

/// This build has no compiler, so no value of this type exists.
pub(super) enum Compiled {}

impl Compiled {
    pub(super) fn call(&self, _: &str, _: &[&[f64]], _: &mut [f64]) -> Result<(), FunctionError> {
        match *self {}
    }
}

/// `None`, with a note of the reason, if generic results suffice.
pub(super) fn compile(_: &Robot, _: &[String], needed: bool, report: &mut Report) -> Result<Option<Compiled>, Failure> {
    if needed {
        return Err(refused("--generated"));
    }
    let note = "this build of `articulated` does not compile code; generic results only".to_owned();
    console::warn(&note);
    report.warnings.push(note);
    Ok(None)
}
