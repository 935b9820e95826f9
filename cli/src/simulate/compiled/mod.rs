//! Simulations by generated code, compiled by rustc. Without the feature `measure`, `uncompiled.rs`
//! is in place of this.

mod all;

use std::path::Path;

use articulated::simulate::Settings;
use articulated_lab::compiled::Rustc;
use articulated_lab::session::Session;
use articulated_lab::straight::{Straight, StraightMotion};
use articulated_motion::InitialState;

use crate::arguments::Format;
use crate::console::{self, Progress};
use crate::failure::{Failure, OK};
use crate::simulate::motion::{self, Motion};
pub(super) use all::run as all;

/// The compiler of generated code.
pub(super) struct Compiler(Rustc);

impl Compiler {
    pub(super) fn find() -> Result<Self, Failure> {
        Rustc::find().map(Self).map_err(|e| Failure::tool(&e))
    }

    /// Runs the motion by generated code.
    pub(super) fn run(
        &self,
        session: &Session,
        initial: &InitialState,
        settings: &Settings,
        progress: &Progress,
    ) -> Result<Motion, Failure> {
        progress.doing(format!("{}: rustc", session.name));
        let code = self.code(session, settings)?;
        progress.doing(format!("{}: motion", session.name));
        motion::run(session, initial, &code, settings, progress, &mut || true)
    }

    fn code(&self, session: &Session, settings: &Settings) -> Result<StraightMotion, Failure> {
        let (generated, frames) = session.generate(settings.integrator)?;
        let robot = Straight::build(&self.0, &generated).map_err(|e| Failure::tool(&e))?;
        Ok(StraightMotion { robot, frames })
    }
}

/// Measures generated code against peers, and prints.
pub(super) fn against(session: &Session, initial: &InitialState, settings: &Settings, peers: &Path, format: Format) -> Result<u8, Failure> {
    let report = articulated_lab::against::measure(session, initial, settings, peers)?;
    console::report(format, || report.text(), || crate::json(&report))?;
    Ok(OK)
}
