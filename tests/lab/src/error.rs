//! Why a measurement ended without a result.

use std::fmt;

use articulated_core::diagnostic::{Diagnostic, Diagnostics};
use articulated_motion::MotionErrors;

/// An error. The command turns it into an exit status and diagnostics.
#[derive(Debug)]
pub enum Error {
    /// The robot or its code.
    Findings(Diagnostics),
    /// The motion of a scene.
    Motion(MotionErrors),
    /// Other input: a message for each error.
    Input(Vec<String>),
    /// A tool, such as rustc, failed or was not found.
    Tool(String),
    /// A result exceeds its bound.
    Bound(String),
}

impl Error {
    /// The input is wrong.
    pub fn input(messages: impl IntoIterator<Item = String>) -> Self {
        Self::Input(messages.into_iter().collect())
    }

    /// A tool failed.
    pub fn tool(error: &impl ToString) -> Self {
        Self::Tool(error.to_string())
    }

    /// A result exceeds its bound.
    pub fn bound(message: String) -> Self {
        Self::Bound(message)
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Findings(findings) => findings.fmt(f),
            Self::Motion(errors) => errors.fmt(f),
            Self::Input(messages) => f.write_str(&messages.join("\n")),
            Self::Tool(message) | Self::Bound(message) => f.write_str(message),
        }
    }
}

impl std::error::Error for Error {}

impl From<Diagnostics> for Error {
    fn from(findings: Diagnostics) -> Self {
        Self::Findings(findings)
    }
}

impl From<Diagnostic> for Error {
    fn from(finding: Diagnostic) -> Self {
        Self::Findings(finding.into())
    }
}

impl From<MotionErrors> for Error {
    fn from(errors: MotionErrors) -> Self {
        Self::Motion(errors)
    }
}

/// The missing property of a robot for a function, in a few words; the findings for another error.
pub fn undefined(findings: Diagnostics) -> Result<String, Diagnostics> {
    match articulated_codegen::undefined(&findings) {
        Some(why) => Ok(why.to_owned()),
        None => Err(findings),
    }
}
