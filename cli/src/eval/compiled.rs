//! Generated code, compiled by rustc. Without the feature `measure`, `uncompiled.rs` is in place of
//! this.

use articulated_codegen::generate;
pub(super) use articulated_lab::compiled::Compiled;
use articulated_lab::compiled::{CompileError, Rustc, Target};

use super::report::Report;
use crate::console;
use crate::failure::Failure;
use crate::robot::Robot;

/// Compiled code, or `None`, with a note of the reason, if generic results suffice.
pub(super) fn compile(robot: &Robot, names: &[String], needed: bool, report: &mut Report) -> Result<Option<Compiled>, Failure> {
    let generated = generate(&robot.request(names))?;
    let progress = console::Progress::new(1);
    progress.doing("rustc".into());
    let built = Rustc::find().and_then(|rustc| Ok((Compiled::build(&rustc, &generated)?, rustc)));
    match built {
        Ok((compiled, rustc)) => {
            report.compiler = Some(format!("{} {}", rustc.version, Rustc::flags(Target::Own).join(" ")));
            Ok(Some(compiled))
        }
        Err(error @ (CompileError::NotFound { .. } | CompileError::Folder(_))) if !needed => {
            let note = format!("{error}; generic results only");
            drop(progress);
            console::warn(&note);
            report.warnings.push(note);
            Ok(None)
        }
        Err(error) => Err(Failure::tool(&error)),
    }
}
