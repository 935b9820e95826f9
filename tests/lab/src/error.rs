//! Why a measurement ended without a result.

use std::fmt;

use articulated_codegen::Error as GeneratorError;
use articulated_motion::MotionErrors;

/// What is wrong. The command makes an exit status and diagnostics of it.
#[derive(Debug)]
pub enum Error {
    /// The robot or its code.
    Generator(GeneratorError),
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
            Self::Generator(error) => error.fmt(f),
            Self::Motion(errors) => errors.fmt(f),
            Self::Input(messages) => f.write_str(&messages.join("\n")),
            Self::Tool(message) | Self::Bound(message) => f.write_str(message),
        }
    }
}

impl std::error::Error for Error {}

impl From<GeneratorError> for Error {
    fn from(error: GeneratorError) -> Self {
        Self::Generator(error)
    }
}

impl From<MotionErrors> for Error {
    fn from(errors: MotionErrors) -> Self {
        Self::Motion(errors)
    }
}

/// Why a robot does not have a function, in a few words; the error itself if it is another.
pub fn undefined(error: GeneratorError) -> Result<String, GeneratorError> {
    use GeneratorError::{BoundFrames, NoMass, Singular, TooMuchCode};
    match error {
        Singular { joints, .. } => Ok(format!("no inertia of its own for joint {}", joints.join(", joint "))),
        NoMass { .. } => Ok("nothing that moves has mass".into()),
        BoundFrames { frames, .. } => Ok(format!("fewer than six degrees of freedom carry {}", frames.join(", "))),
        TooMuchCode { found, most, .. } => Ok(format!("about {found} MB of code, more than {most} (--max-code-size)")),
        other => Err(other),
    }
}
