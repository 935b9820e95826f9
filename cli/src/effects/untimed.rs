//! In place of times, in a build that compiles no code.

use articulated_codegen::Generated;
use articulated_lab::session::Session;

use super::report::Cost;
use crate::console::Progress;
use crate::failure::Failure;
use crate::measure::refused;

/// This build has no compiler, so no value of this type exists.
pub(super) enum Compiler {}

impl Compiler {
    pub(super) fn find() -> Result<Self, Failure> {
        Err(refused("--time"))
    }

    pub(super) fn version(&self) -> String {
        match *self {}
    }

    pub(super) fn time(&self, _: &Session, _: &[Generated], _: usize, _: &mut [Cost], _: &Progress) -> Result<(), Failure> {
        match *self {}
    }
}
