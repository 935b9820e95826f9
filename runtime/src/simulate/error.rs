//! Errors of simulations.

use std::fmt;

use articulated_core::algorithm::FunctionError;
use articulated_core::algorithm::checked::Singular;
use articulated_core::control::Series;
use articulated_core::dynamics::Dynamics;
use articulated_core::{Plain, listed};

use super::{IntegratorId, SettingError, TableError};

/// Errors at the start of a simulation, or during it.
#[derive(Clone, Debug, PartialEq)]
pub enum SimulateError {
    /// Invalid settings; all of them.
    Settings(Vec<SettingError>),
    /// An invalid initial state; all its errors.
    State(Vec<StateError>),
    /// A missing function, or an argument of the wrong length.
    Function(FunctionError),
    /// Numbers of the motion or of its controller are not finite.
    NotFinite {
        /// Time, s.
        t: f64,
        /// The quantity that is not finite.
        what: &'static str,
        /// Their indices, in order.
        index: Vec<usize>,
        /// Names of the joints that they belong to, each once, as far as the robot knows them; for
        /// an event its own name.
        names: Vec<String>,
    },
    /// There are no accelerations: the mass matrix is singular.
    NoMass {
        /// Time, s.
        t: f64,
        /// The joint where it is.
        cause: Singular,
    },
    /// The tolerances require a step that is too short to be made.
    StepTooSmall {
        /// Time, s.
        t: f64,
        /// The required step, s.
        step: f64,
        /// Where the error is largest: the step of q, or v.
        what: &'static str,
        /// Index of the number there.
        index: usize,
        /// Name of the joint that it belongs to, if the robot knows it.
        joint: Option<String>,
        /// The shortest step that the settings allow, s, if that is the limit, and not the
        /// resolution of time.
        least: Option<f64>,
    },
    /// More steps than allowed.
    TooManySteps {
        /// Time, s.
        t: f64,
        /// Steps made, rejected ones included.
        steps: u64,
    },
    /// The tolerances require steps so short that the end would take far more steps than are
    /// allowed.
    NoProgress {
        /// Time, s.
        t: f64,
        /// The mean step, s.
        step: f64,
        /// Number of such steps to the end, rejected ones included.
        left: f64,
        /// The number whose error limits most steps: its vector (the step of q, or v), its index
        /// there, and the name of its joint, if the robot knows it.
        limiting: Option<(&'static str, usize, Option<String>)>,
    },
    /// The step of an explicit integrator is longer than it is stable at.
    Unstable {
        /// The integrator.
        integrator: IntegratorId,
        /// Time, s.
        t: f64,
        /// The step, s.
        step: f64,
        /// The longest step at which the motion, were it linear, is stable here, s. Where forces
        /// bend within a step (stops, dry friction) take three tenths of it.
        admissible: f64,
        /// Size of the fastest eigenvalue, 1/s.
        rate: f64,
    },
    /// Stability, not accuracy, limits the steps of an explicit adaptive integrator.
    Stiff {
        /// The integrator.
        integrator: IntegratorId,
        /// Time, s.
        t: f64,
        /// The limit of the step, s.
        step: f64,
        /// How many of these there would be to the end, rejected ones among them.
        left: f64,
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
    /// A fixed step turns a joint further than a step can.
    Turn {
        /// Time, s.
        t: f64,
        /// The step, s.
        step: f64,
        /// Its rotation in the step, rad.
        turn: f64,
        /// The limit of the rotation, rad.
        most: f64,
        /// Name of the joint, if the robot knows it.
        joint: Option<String>,
    },
    /// An event that maps the state recurs at one time without end.
    Chattering {
        /// Time, s.
        t: f64,
        /// The event's name.
        event: String,
    },
}

/// An error in a state.
#[derive(Clone, Debug, PartialEq)]
pub enum StateError {
    /// A vector of the wrong length.
    Length {
        /// Its name: q, v or another.
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
        /// Index of the number.
        index: usize,
        /// The number.
        found: f64,
        /// Name of the joint that it belongs to, if the robot knows it.
        joint: Option<String>,
    },
    /// A table over time, as a controller has it.
    Table {
        /// Its name.
        table: &'static str,
        /// Its error.
        wrong: TableError,
    },
    /// A quaternion whose norm is not one within
    /// [`NORM_TOLERANCE`](articulated_core::spatial::NORM_TOLERANCE).
    Quaternion {
        /// The vector.
        vector: &'static str,
        /// Where it begins there.
        index: usize,
        /// Its norm.
        norm: f64,
        /// Name of the joint that it belongs to, if the robot knows it.
        joint: Option<String>,
    },
    /// A frame index out of range.
    Frame {
        /// Its number.
        index: usize,
        /// How many there are.
        frames: usize,
    },
    /// An event refers to an index beyond the length of a vector.
    Beyond {
        /// The event's name.
        event: String,
        /// The vector.
        vector: &'static str,
        /// Index of the number.
        index: usize,
        /// How many it has.
        length: usize,
    },
    /// The bounds of an event exclude every value.
    Bounds {
        /// The event's name.
        event: String,
        /// Its lower bound.
        lower: f64,
        /// Its upper bound.
        upper: f64,
    },
    /// An invalid number.
    Value {
        /// Its name.
        what: &'static str,
        /// The number.
        found: f64,
        /// The accepted values.
        right: String,
    },
}

impl StateError {
    /// Errors in a vector that should have this length and finite numbers; `joint` has the joint
    /// names of its entries.
    pub(crate) fn of(
        vector: &'static str,
        x: &[f64],
        expected: usize,
        joint: impl Fn(usize) -> Option<String>,
    ) -> impl Iterator<Item = Self> {
        let length = (x.len() != expected).then_some(Self::Length { vector, found: x.len(), expected });
        let bad = x.iter().enumerate().filter(|(_, x)| !x.is_finite());
        length.into_iter().chain(bad.map(move |(index, &found)| Self::NotFinite { vector, index, found, joint: joint(index) }))
    }

    /// The same of a vector with a number for each degree of freedom.
    pub(crate) fn of_freedoms<R: Dynamics<f64>>(vector: &'static str, x: &[f64], robot: &R) -> impl Iterator<Item = Self> {
        Self::of(vector, x, robot.shape().nv, |freedom| joint(robot, freedom))
    }

    /// Errors in a table with this number of columns.
    pub(crate) fn of_table(table: &'static str, series: &Series, width: usize) -> impl Iterator<Item = Self> {
        series.problems(width).into_iter().map(move |wrong| Self::Table { table, wrong })
    }

    /// `Ok` if there are no errors, otherwise all of them.
    pub(crate) fn none(wrong: impl Iterator<Item = Self>) -> Result<(), SimulateError> {
        let wrong: Vec<Self> = wrong.collect();
        if wrong.is_empty() { Ok(()) } else { Err(SimulateError::State(wrong)) }
    }
}

impl fmt::Display for StateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Length { vector, found, expected } => write!(f, "{vector} has {found} numbers, expected {expected}"),
            Self::NotFinite { vector, index, found, joint } => write!(f, "{vector}[{index}]{} = {found} is not finite", of_joints(joint)),
            Self::Quaternion { vector, index, norm, joint } => {
                write!(f, "{vector}[{index}..{}]{} is a quaternion of norm {norm}; it should be 1", index + 4, of_joints(joint))
            }
            Self::Table { table, wrong } => write!(f, "{table}: {wrong}"),
            Self::Frame { index, frames } => write!(f, "there is no frame {index}: the robot has {frames}, the first is 0"),
            Self::Beyond { event, vector, index, length } => {
                write!(f, "the event `{event}` is about {vector}[{index}], and {vector} has {length} numbers")
            }
            Self::Bounds { event, lower, upper } => {
                let (lower, upper) = (Plain(*lower), Plain(*upper));
                write!(f, "the event `{event}` has the bounds {lower} and {upper}; the first should be less than the second")
            }
            Self::Value { what, found, right } => write!(f, "{what} = {} cannot be used; it should be {right}", Plain(*found)),
        }
    }
}

impl fmt::Display for SimulateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Settings(all) => lines(f, all),
            Self::State(all) => lines(f, all),
            Self::Function(e) => e.fmt(f),
            Self::TooManySteps { t, steps } => {
                let t = Plain(*t);
                write!(
                    f,
                    "{steps} steps were made by t = {t} s: a longer step or looser tolerances, rodas4 if the motion is stiff, or a greater max_steps"
                )
            }
            Self::NotFinite { t, .. }
            | Self::NoMass { t, .. }
            | Self::StepTooSmall { t, .. }
            | Self::Unstable { t, .. }
            | Self::Stiff { t, .. }
            | Self::NoProgress { t, .. }
            | Self::NoConvergence { t, .. }
            | Self::Singular { t, .. }
            | Self::Turn { t, .. }
            | Self::Chattering { t, .. } => {
                write!(f, "at t = {} s ", Plain(*t))?;
                self.of_a_step(f).and_then(|()| self.of_a_state(f))
            }
        }
    }
}

impl SimulateError {
    /// Description, for errors about a step.
    fn of_a_step(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::StepTooSmall { step, what, index, joint, least: Some(least), .. } => write!(
                f,
                "the tolerances ask for a step of {step:.3e} s, {what}[{index}]{} most of all, shorter than min_step = {least:.3e} s: a shorter min_step, or looser tolerances",
                of_joints(joint)
            ),
            Self::StepTooSmall { step, what, index, joint, .. } => write!(
                f,
                "the tolerances ask for a step of {step:.3e} s, {what}[{index}]{} most of all: is there a jump in what moves the robot, or are rtol and atol below rounding?",
                of_joints(joint)
            ),
            Self::Unstable { integrator, step, admissible, rate, .. } => write!(
                f,
                "{integrator} is not stable with steps of {step:.3e} s: something here moves at a rate of {rate:.3e} 1/s. Steps of at most {admissible:.3e} s, or rodas4"
            ),
            Self::Stiff { integrator, step, left, .. } => write!(
                f,
                "the motion is stiff: {integrator} is held to steps of {step:.3e} s by stability, {left:.1e} of them to the end. Take rodas4, or go on with stiffness = \"note\" (Stiffness::Note in Rust)"
            ),
            Self::NoProgress { step, left, limiting, .. } => {
                write!(f, "the motion makes no progress: steps of {step:.1e} s, {left:.1e} of them to the end")?;
                if let Some((what, index, joint)) = limiting {
                    write!(f, ", limited by {what}[{index}]{}", of_joints(joint))?;
                }
                f.write_str(". Is a `speed` of friction or contact, or a tolerance, too small, or does a sampled control make a light joint oscillate?")
            }
            Self::NoConvergence { step, .. } => write!(f, "the equations of a step of {step:.3e} s were not solved: a shorter step"),
            Self::Singular { step, .. } => write!(f, "the matrix of a step of {step:.3e} s is singular: another step"),
            Self::Turn { step, turn, most, joint, .. } => {
                let (joint, least) = (of_joints(joint), step * most / turn);
                write!(
                    f,
                    "a step of {step:.3e} s turns by {turn:.3} rad{joint}: a step can turn by {most:.3} rad at most, here one of {least:.3e} s"
                )
            }
            _ => Ok(()),
        }
    }

    /// Description, for errors about the state that was reached.
    fn of_a_state(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { what, index, names, .. } => {
                let numbers = listed(index.iter().map(|i| format!("[{i}]")));
                let names = if *what == "event" { of_names("event", names) } else { of_joints(names) };
                write!(f, "{what}{numbers}{names} {} not finite", if index.len() > 1 { "are" } else { "is" })
            }
            Self::NoMass { cause, .. } => {
                let joint = Some(&cause.joint).filter(|name| !name.is_empty());
                let freedom = format!("v[{}]{}", cause.freedom, of_joints(joint));
                write!(f, "the mass matrix is singular at {freedom}: does it move a mass, and otherwise than the joints behind it?")
            }
            Self::Chattering { event, .. } => {
                write!(f, "the event `{event}` happens again and again: let it stop, or let the map end what causes it")
            }
            _ => Ok(()),
        }
    }
}

/// Name of the joint that a degree of freedom belongs to, if the robot knows it.
pub(crate) fn joint<R: Dynamics<f64>>(robot: &R, freedom: usize) -> Option<String> {
    robot.joint_of(freedom).filter(|name| !name.is_empty()).map(str::to_owned)
}

/// In brackets, if there are some.
fn of_joints<'a>(names: impl IntoIterator<Item = &'a String>) -> String {
    of_names("joint", names)
}

fn of_names<'a>(kind: &str, names: impl IntoIterator<Item = &'a String>) -> String {
    let names: Vec<String> = names.into_iter().map(|name| format!("`{name}`")).collect();
    match names.len() {
        0 => String::new(),
        1 => format!(" ({kind} {})", names[0]),
        _ => format!(" ({kind}s {})", listed(names)),
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
