//! Why a simulation could not begin or did not go on.

use std::fmt;

use articulated_core::algorithm::FunctionError;

use super::{IntegratorId, SettingError};

/// Why a simulation could not begin or did not go on.
#[derive(Clone, Debug, PartialEq)]
pub enum SimulateError {
    /// Settings that cannot be used; all of them.
    Settings(Vec<SettingError>),
    /// A state to begin with that is none; everything that is wrong with it.
    State(Vec<StateError>),
    /// A function that the robot does not have, or that was given something of the wrong length.
    Function(FunctionError),
    /// A number of the motion, or of what moves it, is not finite.
    NotFinite {
        /// Time, s.
        t: f64,
        /// What is not finite.
        what: &'static str,
        /// Which of them.
        index: usize,
    },
    /// The tolerances ask for a step that is too short to be made.
    StepTooSmall {
        /// Time, s.
        t: f64,
        /// The step that would be needed, s.
        step: f64,
        /// The coordinate whose error is largest: below nv of q, from there of v.
        index: usize,
    },
    /// More steps than allowed.
    TooManySteps {
        /// Time, s.
        t: f64,
        /// Steps made, rejected ones included.
        steps: u64,
    },
    /// The step of an explicit integrator is longer than it is stable at.
    Unstable {
        /// The integrator.
        integrator: IntegratorId,
        /// Time, s.
        t: f64,
        /// The step, s.
        step: f64,
        /// The longest step at which the motion, were it linear, is stable here, s. Where forces bend within a step (stops, dry friction) take three tenths of it.
        admissible: f64,
        /// Size of the fastest eigenvalue, 1/s.
        rate: f64,
    },
    /// An explicit integrator that chooses its steps is held back by stability, not by accuracy.
    Stiff {
        /// The integrator.
        integrator: IntegratorId,
        /// Time, s.
        t: f64,
        /// The step that it is held to, s.
        step: f64,
    },
    /// The equations of an implicit step were not solved.
    NoConvergence {
        /// Time, s.
        t: f64,
        /// The step, s.
        step: f64,
    },
    /// The matrix of an implicit step is singular.
    Singular {
        /// Time, s.
        t: f64,
        /// The step, s.
        step: f64,
    },
    /// An event that maps the state happens again and again at one time.
    Chattering {
        /// Time, s.
        t: f64,
        /// The event's name.
        event: String,
    },
}

/// What is wrong with a state.
#[derive(Clone, Debug, PartialEq)]
pub enum StateError {
    /// A vector of the wrong length.
    Length {
        /// Which one: q, v or another.
        vector: &'static str,
        /// The length found.
        found: usize,
        /// The length expected.
        expected: usize,
    },
    /// A number that is not finite.
    NotFinite {
        /// The vector.
        vector: &'static str,
        /// Which of its numbers.
        index: usize,
        /// The number.
        found: f64,
    },
    /// A quaternion whose norm is not one to 1e-6.
    Quaternion {
        /// Where it begins in q.
        index: usize,
        /// Its norm.
        norm: f64,
    },
    /// An event is about a number of a vector that has not so many.
    Beyond {
        /// The event's name.
        event: String,
        /// The vector.
        vector: &'static str,
        /// Which of its numbers.
        index: usize,
        /// How many it has.
        length: usize,
    },
    /// A number that cannot be used.
    Value {
        /// What it is.
        what: &'static str,
        /// The number.
        found: f64,
    },
}

impl StateError {
    /// What is wrong with a vector that should have so many numbers, all finite.
    pub(crate) fn of(vector: &'static str, x: &[f64], expected: usize) -> impl Iterator<Item = Self> {
        let length = (x.len() != expected).then_some(Self::Length { vector, found: x.len(), expected });
        let bad = x.iter().enumerate().filter(|(_, x)| !x.is_finite());
        length.into_iter().chain(bad.map(move |(index, &found)| Self::NotFinite { vector, index, found }))
    }

    /// Nothing is wrong, or all that is.
    pub(crate) fn none(wrong: impl Iterator<Item = Self>) -> Result<(), SimulateError> {
        let wrong: Vec<Self> = wrong.collect();
        if wrong.is_empty() { Ok(()) } else { Err(SimulateError::State(wrong)) }
    }
}

impl fmt::Display for StateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Length { vector, found, expected } => write!(f, "{vector} has {found} numbers, expected {expected}"),
            Self::NotFinite { vector, index, found } => write!(f, "{vector}[{index}] = {found} is not finite"),
            Self::Quaternion { index, norm } => {
                write!(f, "q[{index}..{}] is a quaternion of norm {norm}; it should be 1", index + 4)
            }
            Self::Beyond { event, vector, index, length } => {
                write!(f, "the event `{event}` is about {vector}[{index}], and {vector} has {length} numbers")
            }
            Self::Value { what, found } => write!(f, "{what} = {found} cannot be used"),
        }
    }
}

impl fmt::Display for SimulateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Settings(all) => lines(f, all),
            Self::State(all) => lines(f, all),
            Self::Function(e) => e.fmt(f),
            Self::NotFinite { t, what, index } => write!(f, "at t = {t} s {what}[{index}] is not finite"),
            Self::StepTooSmall { t, step, index } => write!(
                f,
                "at t = {t} s the tolerances ask for a step of {step:.3e} s (coordinate {index}): is there a jump in what moves the robot, or are rtol and atol below rounding?"
            ),
            Self::TooManySteps { t, steps } => {
                write!(f, "{steps} steps were made by t = {t} s: looser tolerances, rodas4 if the motion is stiff, or a greater max_steps")
            }
            Self::Unstable { integrator, t, step, admissible, rate } => write!(
                f,
                "at t = {t} s {integrator} is not stable with steps of {step:.3e} s: something here moves at a rate of {rate:.3e} 1/s. Steps of at most {admissible:.3e} s, or rodas4"
            ),
            Self::Stiff { integrator, t, step } => write!(
                f,
                "at t = {t} s the motion is stiff: {integrator} is held to steps of {step:.3e} s by stability. Take rodas4, or stiffness = note to go on"
            ),
            Self::NoConvergence { t, step } => {
                write!(f, "at t = {t} s the equations of a step of {step:.3e} s were not solved: a shorter step")
            }
            Self::Singular { t, step } => write!(f, "at t = {t} s the matrix of a step of {step:.3e} s is singular: another step"),
            Self::Chattering { t, event } => {
                write!(f, "at t = {t} s the event `{event}` happens again and again: let it stop, or let the map end what causes it")
            }
        }
    }
}

fn lines<T: fmt::Display>(f: &mut fmt::Formatter<'_>, all: &[T]) -> fmt::Result {
    for (k, one) in all.iter().enumerate() {
        write!(f, "{}{one}", if k > 0 { "\n" } else { "" })?;
    }
    Ok(())
}

impl std::error::Error for StateError {}
impl std::error::Error for SimulateError {}

impl From<FunctionError> for SimulateError {
    fn from(e: FunctionError) -> Self {
        Self::Function(e)
    }
}
