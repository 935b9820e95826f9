//! In place of simulations by generated code, in a build that compiles none.

use std::path::Path;

use articulated::simulate::Settings;
use articulated_lab::session::Session;
use articulated_motion::InitialState;

use super::arguments::SimulateArguments;
use super::motion::Motion;
use crate::arguments::Format;
use crate::console::Progress;
use crate::failure::Failure;
use crate::measure::refused;

/// This build has no compiler, so no value of this type exists.
pub(super) enum Compiler {}

impl Compiler {
    pub(super) fn find() -> Result<Self, Failure> {
        Err(refused("--generated"))
    }

    pub(super) fn run(&self, _: &Session, _: &InitialState, _: &Settings, _: &Progress) -> Result<Motion, Failure> {
        match *self {}
    }
}

pub(super) fn all(_: &SimulateArguments, _: Format) -> Result<u8, Failure> {
    Err(refused("--all"))
}

pub(super) fn against(_: &Session, _: &InitialState, _: &Settings, _: &Path, _: Format) -> Result<u8, Failure> {
    Err(refused("--against"))
}
