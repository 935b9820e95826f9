//! The reason why a command failed, and its exit status.

use articulated_core::diagnostic::{self, Code, Diagnostics};
use articulated_motion::{Fault, MotionErrors};
use serde::ser::SerializeStruct;
use serde::{Serialize, Serializer};

use crate::diagnostic::Diagnostic;

/// Everything went well.
pub const OK: u8 = 0;
/// The input is wrong or unusable.
pub const INPUT: u8 = 1;
/// The command line is wrong.
pub const USAGE: u8 = 2;
/// A tool failed, or was not found.
pub const TOOL: u8 = 3;
/// A comparison exceeded its bound.
pub const BOUND: u8 = 4;
/// A motion ended, but outside its own tolerance: its balance of energy is not kept.
pub const OUT_OF_TOLERANCE: u8 = 5;
/// Ctrl-C: the shells' status for that signal.
pub const INTERRUPTED: u8 = 130;

/// Meaning of each status, for users.
pub const STATUSES: &str = "\
Exit status:
  0  all is well
  1  the input was found wrong or unusable
  2  the command line is wrong
  3  a tool (rustc) failed or was not found
  4  a comparison exceeded its bound
  5  a motion ended, but outside its own tolerance: its balance of energy is not kept
  130  interrupted (Ctrl-C; 129, 131 and 143 by SIGHUP, SIGQUIT and SIGTERM)";

/// The exit status of a command and its errors.
#[derive(Clone, Debug)]
pub(crate) struct Failure {
    pub(crate) status: u8,
    pub(crate) errors: Vec<Diagnostic>,
    /// Whether a report was printed: as JSON it is the whole output.
    pub(crate) reported: bool,
}

impl Serialize for Failure {
    /// `status` is a word here, as in the reports of motions; the number is `exit_status`.
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let mut object = to.serialize_struct("Failure", 3)?;
        object.serialize_field("status", "error")?;
        object.serialize_field("exit_status", &self.status)?;
        object.serialize_field("errors", &self.errors)?;
        object.end()
    }
}

impl Failure {
    /// The input is wrong.
    pub(crate) fn input(errors: impl IntoIterator<Item: Into<Diagnostic>>) -> Self {
        Self { status: INPUT, errors: errors.into_iter().map(Into::into).collect(), reported: false }
    }

    /// The command line is wrong.
    pub(crate) fn usage(line: String) -> Self {
        Self { status: USAGE, errors: vec![line.into()], reported: false }
    }

    /// A tool failed.
    pub(crate) fn tool(error: &impl ToString) -> Self {
        Self { status: TOOL, errors: vec![error.to_string().into()], reported: false }
    }

    /// Whether a tool failed.
    pub(crate) fn is_of_tool(&self) -> bool {
        self.status == TOOL
    }

    /// All failures, with the most severe status: wrong input comes before a wrong command line,
    /// and both before a tool that fails.
    pub(crate) fn of(failures: impl IntoIterator<Item = Self>) -> Self {
        let mut all = Self { status: BOUND, errors: Vec::new(), reported: false };
        for failure in failures {
            all.status = all.status.min(failure.status);
            all.errors.extend(failure.errors);
        }
        all
    }

    /// Both values, or the errors of both.
    pub(crate) fn both<A, B>(a: Result<A, Self>, b: Result<B, Self>) -> Result<(A, B), Self> {
        match (a, b) {
            (Ok(a), Ok(b)) => Ok((a, b)),
            (a, b) => Err(Self::of(a.err().into_iter().chain(b.err()))),
        }
    }

    /// A comparison exceeded its bound.
    pub(crate) fn bound(line: String) -> Self {
        Self { status: BOUND, errors: vec![line.into()], reported: false }
    }

    /// So does one in the report that was just printed.
    pub(crate) fn bound_of_report(line: String) -> Self {
        Self::bound(line).after_report()
    }

    /// The failure after a report was printed.
    pub(crate) fn after_report(self) -> Self {
        Self { reported: true, ..self }
    }
}

impl From<Diagnostics> for Failure {
    fn from(all: Diagnostics) -> Self {
        Self::of(all.errors.iter().map(|finding| Self::from(finding.clone())))
    }
}

impl From<diagnostic::Diagnostic> for Failure {
    /// A function that does not exist is an error of the command line, unless a file names it.
    fn from(finding: diagnostic::Diagnostic) -> Self {
        let is_usage = finding.code == Code::UnknownFunction && finding.line().is_none();
        let status = if is_usage { USAGE } else { INPUT };
        Self { status, errors: vec![Diagnostic::of(&finding)], reported: false }
    }
}

impl From<MotionErrors> for Failure {
    fn from(all: MotionErrors) -> Self {
        Self::input(all.errors.iter().map(|error| match &error.fault {
            Fault::Scene(finding) => Diagnostic::of(finding),
            _ => error.to_string().into(),
        }))
    }
}

impl From<articulated_lab::error::Error> for Failure {
    fn from(error: articulated_lab::error::Error) -> Self {
        use articulated_lab::error::Error;
        match error {
            Error::Findings(findings) => findings.into(),
            Error::Motion(errors) => errors.into(),
            Error::Input(messages) => Self::input(messages),
            Error::Tool(message) => Self::tool(&message),
            Error::Bound(message) => Self::bound(message),
        }
    }
}
