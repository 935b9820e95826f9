//! States of a robot: the arguments of its functions, from a file or at random.

mod csv;
pub mod exact;
mod json;
mod random;
mod read;
mod unique;

use articulated_core::algorithm::{Argument, Dim, Function};
use articulated_core::model::{JointInfo, Model};
use articulated_core::step::{ACT, CTRL};

pub use articulated_reference::SplitMix64;
pub use random::random;
use read::Found;
pub use read::{States, listed};

/// One state: a vector for each known argument, in the layout of the functions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    values: Vec<(Argument, Vec<f64>)>,
}

impl State {
    /// The vector of an argument.
    pub fn get(&self, argument: Argument) -> Option<&[f64]> {
        self.values.iter().find(|(a, _)| *a == argument).map(|(_, x)| x.as_slice())
    }

    /// The arguments of a function in its order; otherwise the first missing one.
    pub fn arguments<S>(&self, function: &Function<S>) -> Result<Vec<&[f64]>, Argument> {
        function.takes.iter().map(|&a| self.get(a).ok_or(a)).collect()
    }

    /// Sets the vector of an argument.
    pub fn set(&mut self, argument: Argument, vector: Vec<f64>) {
        self.values.retain(|(a, _)| *a != argument);
        self.values.push((argument, vector));
    }
}

/// Reads states in JSON or CSV. Errors: all of the file's, a line each, with the state and the
/// joint.
pub fn read(bytes: &[u8], model: &Model<f64>) -> Result<States, Vec<String>> {
    let text = std::str::from_utf8(bytes).map_err(|e| vec![format!("byte {}: found no UTF-8, expected JSON or CSV", e.valid_up_to())])?;
    let text = text.trim_start_matches('\u{feff}');
    let mut found = Found::new(model);
    if text.trim_start().starts_with(['{', '[']) {
        json::read(text, &mut found);
    } else {
        csv::read(text, &mut found);
    }
    found.finish()
}

/// Numbers of an argument that have a name: a joint's, or a frame's.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Slot<'a> {
    /// Of the joint or frame.
    pub name: &'a str,
    /// First index.
    pub at: usize,
    /// How many numbers.
    pub count: usize,
}

/// The arguments that a file of states may have: those of the table, and of functions of actuators.
pub fn known_arguments() -> impl Iterator<Item = Argument> {
    Argument::ALL.into_iter().chain([ACT, CTRL])
}

/// The named parts of an argument, in its order.
pub fn slots(argument: Argument, model: &Model<f64>) -> Vec<Slot<'_>> {
    let by_joint = |part: fn(&JointInfo) -> (usize, usize)| {
        model.joints().iter().map(|j| Slot { name: &j.name, at: part(j).0, count: part(j).1 }).collect()
    };
    match argument.dims() {
        [Dim::Frames, rest @ ..] => {
            let count = rest.iter().map(|d| d.len(model.shape())).product();
            model.frames().iter().enumerate().map(|(k, f)| Slot { name: &f.name, at: k * count, count }).collect()
        }
        [Dim::Nq] => by_joint(|j| j.q),
        [dim @ (Dim::Controls | Dim::Activations)] => {
            let own = model.actuators().laws.iter().filter(|law| *dim == Dim::Controls || law.activation.is_some());
            own.enumerate().map(|(k, law)| Slot { name: &law.name, at: k, count: 1 }).collect()
        }
        _ => by_joint(|j| j.v),
    }
}

/// The owners of an argument's parts.
pub fn owner(argument: Argument) -> &'static str {
    match argument {
        Argument::Wrenches => "link",
        ACT | CTRL => "actuator",
        _ => "joint",
    }
}

/// First indices in q of the unit quaternions, with the joints that have them.
pub fn quaternions(model: &Model<f64>) -> impl Iterator<Item = (&JointInfo, usize)> {
    model.joints().iter().filter_map(|j| Some((j, j.quaternion()?.start)))
}
