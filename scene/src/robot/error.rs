//! Why a robot cannot be had.

use std::fmt;

use articulated_core::description::EditError;
use articulated_core::effect::EffectError;
use articulated_core::model::ModelError;
use articulated_urdf::Problems;

use crate::error::SceneErrors;

/// One edit of a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edit {
    /// An index into [`append`](super::RobotOptions::append).
    Append(usize),
    /// An index into [`payloads`](super::RobotOptions::payloads).
    Payload(usize),
    /// An index into [`shafts`](super::RobotOptions::shafts).
    Shaft(usize),
    /// An index into [`lock`](super::RobotOptions::lock).
    Lock(usize),
    /// An index into [`frames`](super::RobotOptions::frames).
    Frame(usize),
}

/// Why an edit cannot be made.
#[derive(Clone, Debug)]
pub enum Reason {
    /// The document of the robot to be appended is not a usable URDF.
    Urdf(Problems),
    /// What it names or asks for is not there, or not possible.
    Edit(EditError),
    /// A frame listed twice.
    FrameTwice(String),
}

/// An edit that cannot be made.
#[derive(Clone, Debug)]
pub struct Refusal {
    /// The file of the robot that was to be edited.
    pub file: String,
    /// Which edit.
    pub edit: Edit,
    /// Why not.
    pub reason: Reason,
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = match self.edit {
            Edit::Append(_) => "append",
            Edit::Payload(_) => "payload",
            Edit::Shaft(_) => "shaft",
            Edit::Lock(_) => "lock",
            Edit::Frame(_) => "frames",
        };
        match &self.reason {
            Reason::Urdf(problems) => problems.fmt(f),
            Reason::Edit(error) => write!(f, "{}: {what}: {error}", self.file),
            Reason::FrameTwice(name) => write!(f, "{}: {what}: {name:?} is listed twice", self.file),
        }
    }
}

/// Everything that can be wrong with a robot as it is asked for, as data first and a sentence second.
#[derive(Clone, Debug)]
pub enum RobotError {
    /// The document is not a usable URDF.
    Urdf(Problems),
    /// The robot is not one that the algorithms know.
    Model {
        /// The file.
        file: String,
        /// What is wrong.
        error: ModelError,
    },
    /// Effects that cannot be had; all of them.
    Effects {
        /// The file of the robot.
        file: String,
        /// One for each effect.
        errors: Vec<EffectError>,
    },
    /// A scene that is wrong, or does not fit its robot; everything that is.
    Scene(SceneErrors),
    /// Edits of the robot that cannot be made; all of them.
    Edits {
        /// One for each edit.
        refusals: Vec<Refusal>,
    },
    /// A choice whose number cannot be.
    Number {
        /// The choice, as a scene calls it.
        key: &'static str,
        /// The number.
        found: String,
        /// What is wanted.
        expected: &'static str,
    },
    /// A file that could not be read or written.
    File {
        /// The file.
        file: String,
        /// What the system said.
        reason: String,
    },
    /// Several of these.
    Several {
        /// Two at least, none of them several again.
        errors: Vec<RobotError>,
    },
}

impl RobotError {
    /// All of them as one; `None` of none.
    pub fn of(errors: Vec<Self>) -> Option<Self> {
        let mut errors: Vec<Self> = errors.into_iter().flat_map(Self::into_each).collect();
        if errors.len() > 1 { Some(Self::Several { errors }) } else { errors.pop() }
    }

    /// Each of several errors; one that is by itself.
    pub fn into_each(self) -> Vec<Self> {
        match self {
            Self::Several { errors } => errors,
            one => vec![one],
        }
    }
}

impl fmt::Display for RobotError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Urdf(problems) => problems.fmt(f),
            Self::Model { file, error } => write!(f, "{file}: {error}"),
            Self::Effects { file, errors } => lines(f, errors.iter().map(|error| format!("{file}: {error}"))),
            Self::Scene(errors) => errors.fmt(f),
            Self::Edits { refusals } => lines(f, refusals),
            Self::Number { key, found, expected } => write!(f, "{key}: found {found}, expected {expected}"),
            Self::File { file, reason } => write!(f, "{file}: {reason}"),
            Self::Several { errors } => lines(f, errors),
        }
    }
}

impl std::error::Error for RobotError {}

impl From<Problems> for RobotError {
    fn from(problems: Problems) -> Self {
        Self::Urdf(problems)
    }
}

impl From<SceneErrors> for RobotError {
    fn from(errors: SceneErrors) -> Self {
        Self::Scene(errors)
    }
}

fn lines(f: &mut fmt::Formatter<'_>, all: impl IntoIterator<Item = impl fmt::Display>) -> fmt::Result {
    for (i, one) in all.into_iter().enumerate() {
        write!(f, "{}{one}", if i == 0 { "" } else { "\n" })?;
    }
    Ok(())
}
