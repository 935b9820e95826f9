//! Errors that keep a scene from moving, as data and text.

use std::fmt;

use articulated::FunctionError;
use articulated::simulate::{SettingError, SimulateError, StateError};
use articulated_core::diagnostic::{Diagnostic, Diagnostics};
use articulated_core::listed;

/// All errors that keep a scene from moving.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionErrors {
    /// In the order of detection, without duplicates; never empty.
    pub errors: Vec<MotionError>,
}

/// An error that keeps a scene from moving.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionError {
    /// The scene's file, by the name under which it was read.
    pub file: String,
    /// The fault.
    pub fault: Fault,
}

/// A fault that keeps a scene from moving.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Fault {
    /// The start or the control does not fit the robot, a table cannot be read, or the ball is hit
    /// at a time outside the motion.
    Scene(Diagnostic),
    /// The scene has no `[simulation]`, and so no end time.
    NoSimulation,
    /// The scene has a law of constraints, whose steps are whole: no integrator takes them.
    Law,
    /// A setting that cannot be used.
    Setting(SettingError),
    /// A smoothing speed of friction or contact that the tolerance of velocities does not resolve.
    Speed {
        /// Its key in the scene.
        key: String,
        /// The speed, rad/s or m/s.
        found: f64,
        /// The least that the tolerance resolves, rad/s or m/s.
        expected: f64,
        /// The absolute tolerance, rad/s or m/s.
        atol: f64,
    },
    /// The numbers of coordinates or degrees of freedom of the robot and of the scene's robot
    /// differ.
    Shape {
        /// `coordinates` or `degrees of freedom`.
        what: &'static str,
        /// Number of the robot.
        found: usize,
        /// Number of the scene's robot.
        expected: usize,
    },
    /// The number of frame names differs from the number of frames.
    Frames {
        /// Number of names.
        found: usize,
        /// Number of frames.
        expected: usize,
    },
    /// The robot has another name for a frame.
    FrameName {
        /// Number of the frame, from 0.
        index: usize,
        /// The given name.
        found: String,
        /// The robot's name.
        expected: String,
    },
    /// The robot lacks a frame that an event needs.
    NoFrame {
        /// The key that needs it: `effects.contact` or `impact.link`.
        key: &'static str,
        /// The link that the frame is of.
        link: String,
        /// The frames of the robot.
        frames: Vec<String>,
    },
    /// The robot's accelerations differ from those of the scene's robot.
    Dynamics {
        /// Largest difference of the required torques, N·m or N.
        apart: f64,
        /// The largest of these torques, N·m or N.
        largest: f64,
    },
    /// The robot lacks a function that the motion needs.
    Function(FunctionError),
    /// Errors of the initial state, of the control or of an event.
    State(StateError),
    /// Another error that kept the simulation from starting.
    Simulation(SimulateError),
}

impl MotionErrors {
    /// These, each once.
    fn of(all: impl IntoIterator<Item = MotionError>) -> Self {
        let mut errors: Vec<MotionError> = Vec::new();
        for error in all {
            if !errors.contains(&error) {
                errors.push(error);
            }
        }
        Self { errors }
    }

    /// `Ok` without faults, else all faults.
    pub(crate) fn none(file: &str, faults: impl IntoIterator<Item = Fault>) -> Result<(), Self> {
        let all = Self::of(faults.into_iter().map(|fault| MotionError::new(file, fault)));
        if all.errors.is_empty() { Ok(()) } else { Err(all) }
    }

    /// This alone.
    pub(crate) fn one(file: &str, fault: Fault) -> Self {
        Self { errors: vec![MotionError::new(file, fault)] }
    }

    /// Errors that made a simulation refuse.
    pub(crate) fn refused(file: &str, error: SimulateError) -> Self {
        Self::of(Fault::of(error).into_iter().map(|fault| MotionError::new(file, fault)))
    }

    /// Both values, or the errors of both.
    pub(crate) fn both<A, B>(a: Result<A, Self>, b: Result<B, Self>) -> Result<(A, B), Self> {
        match (a, b) {
            (Ok(a), Ok(b)) => Ok((a, b)),
            (a, b) => Err(Self::of(a.err().into_iter().chain(b.err()).flat_map(|all| all.errors))),
        }
    }
}

impl MotionError {
    /// An error of a scene may be in a file that it names.
    fn new(file: &str, fault: Fault) -> Self {
        let file = if let Fault::Scene(error) = &fault { error.file() } else { file };
        Self { file: file.to_owned(), fault }
    }
}

impl Fault {
    /// The faults of a simulation error, one by one; never empty.
    pub(crate) fn of(error: SimulateError) -> Vec<Self> {
        match error {
            SimulateError::Settings(all) if !all.is_empty() => all.into_iter().map(Self::Setting).collect(),
            SimulateError::State(all) if !all.is_empty() => all.into_iter().map(Self::State).collect(),
            SimulateError::Function(error) => vec![Self::Function(error)],
            other => vec![Self::Simulation(other)],
        }
    }
}

impl From<Diagnostics> for MotionErrors {
    fn from(all: Diagnostics) -> Self {
        let placed = |error: Diagnostic| MotionError { file: error.file().to_owned(), fault: Fault::Scene(error) };
        Self { errors: all.errors.into_iter().map(placed).collect() }
    }
}

impl fmt::Display for MotionErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, error) in self.errors.iter().enumerate() {
            write!(f, "{}{error}", if i == 0 { "" } else { "\n" })?;
        }
        Ok(())
    }
}

impl std::error::Error for MotionErrors {}

impl fmt::Display for MotionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.fault {
            // With its file, and the line there.
            Fault::Scene(error) => error.fmt(f),
            fault => write!(f, "{}: {fault}", self.file),
        }
    }
}

impl std::error::Error for MotionError {}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scene(error) => f.write_str(&error.message()),
            Self::NoSimulation => f.write_str("simulation: found nothing, expected [simulation] with `end`, s"),
            Self::Law => f.write_str(
                "simulation.law: found \"mujoco\", expected no law: `articulated simulate`, Python's `simulate` and functions of the group `constraints` step by it",
            ),
            Self::Setting(error) => error.fmt(f),
            Self::Speed { key, found, expected, atol } => write!(
                f,
                "{key}: found {found:e}, expected at least {expected:e}, ten times simulation.atol = {atol:e}: a larger `speed`, or a smaller `atol`"
            ),
            Self::Shape { what, found, expected } => {
                write!(f, "robot: found {found} {what}, expected {expected}: it is another robot than the scene's")
            }
            Self::Frames { found, expected } => {
                write!(f, "frames: found {found} names, expected {expected}: one for each frame of the robot, in its order")
            }
            Self::FrameName { index, found, expected } => {
                write!(f, "frames[{index}]: found {found:?}, expected {expected:?}, as the robot calls it")
            }
            Self::NoFrame { key, link, frames } => {
                let frames = if frames.is_empty() { "it has none".to_owned() } else { listed(frames) };
                write!(f, "{key}: found a robot that gives no frame of {link:?}, expected that among its frames ({frames})")
            }
            Self::Dynamics { apart, largest } => write!(
                f,
                "robot: found accelerations that take torques {apart:.3e} N·m or N from those of the scene's robot, of {largest:.3e}, expected a robot with the scene's \
                 gravity, effects and edits (made from the scene, not from its robot's file); `Session::motion` moves another all the same"
            ),
            Self::Function(error) => error.fmt(f),
            Self::State(error) => error.fmt(f),
            Self::Simulation(error) => error.fmt(f),
        }
    }
}
