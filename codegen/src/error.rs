//! Why nothing was generated.

use articulated_scene::{RobotError, SceneErrors};
use thiserror::Error;

/// Everything that can be wrong with a request, as data first and a sentence second.
#[derive(Clone, Debug, Error)]
pub enum Error {
    /// The robot cannot be had as it is asked for.
    #[error("{0}")]
    Robot(#[from] RobotError),
    /// A type of numbers that is asked for twice.
    #[error("batch: found a type that is there twice, {found}, expected each once")]
    BatchTwice {
        /// The type.
        found: &'static str,
    },
    /// A level that a target does not have.
    #[error("level: found {found}, expected for target {target:?}: {expected}")]
    LevelOfTarget {
        /// The target.
        target: &'static str,
        /// The level.
        found: String,
        /// The levels that it has.
        expected: &'static str,
    },
    /// A prefix that is no name.
    #[error("prefix: found {found:?}, expected a letter of ASCII, then letters, digits and _")]
    Prefix {
        /// The prefix.
        found: String,
    },
    /// A type of numbers that does not exist.
    #[error("batch: found {found:?}, expected \"f64\" or \"f32\"")]
    BatchUnknown {
        /// The word found.
        found: String,
    },
    /// A function that does not exist.
    #[error("unknown function `{found}`, {}", nearest.as_ref().map_or_else(|| format!("there are: {}", known.join(", ")), |n| format!("did you mean `{n}`?")))]
    UnknownFunction {
        /// The name found.
        found: String,
        /// The known name most like it.
        nearest: Option<String>,
        /// All names, and those of groups.
        known: Vec<String>,
    },
    /// A function that is not defined for this robot.
    #[error("{file}: {function} is not defined: no inertia of its own for joint {}: nothing behind it resists its motion, or another joint moves the same mass in the same way, so the mass matrix is singular in every configuration; give a link behind it an inertia, or the joint an armature, or take one joint fewer, or leave {function} out", joints.join(", joint "))]
    Singular {
        /// The file.
        file: String,
        /// The function.
        function: String,
        /// The joints without an inertia of their own.
        joints: Vec<String>,
    },
    /// A robot so large that its code would be of no use.
    #[error("{file}: found {found} degrees of freedom, expected at most {most} to write code for")]
    TooLarge {
        /// The file.
        file: String,
        /// Its degrees of freedom.
        found: usize,
        /// How many it may have.
        most: usize,
    },
    /// A function whose code would be larger than the request allows.
    #[error("{file}: {function}: found about {found} MB of code for {freedoms} degrees of freedom, expected at most {most} MB for all functions together; call the library's {}, a loop over the joints, or set `max_code_size` (`--max-code-size`) to more MB", library.join(", "))]
    TooMuchCode {
        /// The file.
        file: String,
        /// The function.
        function: String,
        /// What it consists of, as the generic library calls it.
        library: Vec<&'static str>,
        /// The robot's degrees of freedom.
        freedoms: usize,
        /// Predicted size of the function's source, MB.
        found: u64,
        /// The request's limit, MB.
        most: u64,
    },
    /// Two names of the URDF that are the same in Rust.
    #[error(
        "{file}: {kind}s {first:?} and {second:?} are both `{ident}` in Rust; `--rename` (key `rename`, method `Build::rename`) gives one another name"
    )]
    NameClash {
        /// The file.
        file: String,
        /// `joint` or `link`.
        kind: &'static str,
        /// The first name.
        first: String,
        /// The second name.
        second: String,
        /// The name that both become.
        ident: String,
    },
    /// A name in `rename` that the robot does not have, or a Rust name that is none.
    #[error("{file}: rename {from:?} to `{to}`: {reason}")]
    Rename {
        /// The file.
        file: String,
        /// The name in the URDF.
        from: String,
        /// The name asked for.
        to: String,
        /// What is wrong.
        reason: &'static str,
    },
    /// An entry of the list of functions that cannot be read, or does not fit the robot.
    #[error("functions: `{found}`: {reason}")]
    FunctionSpec {
        /// The entry.
        found: String,
        /// What is wrong.
        reason: String,
    },
    /// An entry of the list of parameters that cannot be read, or does not fit the robot.
    #[error("parameters: `{found}`: {reason}")]
    Parameter {
        /// The entry.
        found: String,
        /// What is wrong.
        reason: String,
    },
    /// Two functions of the same name.
    #[error("functions: two are called `{name}`; give one another name, as in other = {name}")]
    SameName {
        /// The name.
        name: String,
    },
    /// A function of the centre of mass, on a robot of which nothing that moves has mass.
    #[error("{file}: {function} is not defined: nothing that moves has mass")]
    NoMass {
        /// The file.
        file: String,
        /// The function.
        function: String,
    },
    /// A function that needs frames which can move in all directions, on a robot where some cannot.
    #[error("{file}: {function} is not defined: fewer than six degrees of freedom carry {}; {}", frames.join(", "), if *has_others { "choose others with `--frames` (key `frames`, method `Build::frames`)" } else { "no link of this robot has six: take operational_space_inertia_inverse" })]
    BoundFrames {
        /// The file.
        file: String,
        /// The function.
        function: String,
        /// The frames, each with how many carry it.
        frames: Vec<String>,
        /// Whether any link of the robot has as many.
        has_others: bool,
    },
    /// Several of these.
    #[error("{}", errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
    Several {
        /// Two at least, none of them several again.
        errors: Vec<Error>,
    },
}

impl Error {
    /// All of them as one; `None` of none.
    pub(crate) fn of(errors: Vec<Error>) -> Option<Self> {
        let mut errors: Vec<Error> = errors.into_iter().flat_map(Error::into_each).collect();
        if errors.len() > 1 { Some(Self::Several { errors }) } else { errors.pop() }
    }

    /// Each of several errors; one that is by itself.
    pub fn into_each(self) -> Vec<Error> {
        match self {
            Self::Several { errors } => errors,
            Self::Robot(RobotError::Several { errors }) => errors.into_iter().map(Self::Robot).collect(),
            one => vec![one],
        }
    }
}

impl From<SceneErrors> for Error {
    fn from(errors: SceneErrors) -> Self {
        Self::Robot(errors.into())
    }
}
