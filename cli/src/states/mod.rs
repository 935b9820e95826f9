//! States of a robot: the arguments of its functions, from a file or at random.

mod csv;
mod json;
mod random;
mod read;

use articulated_core::algorithm::{Argument, Function, functions};
use articulated_core::model::{JointInfo, Model};

pub use random::{SplitMix64, random};
pub use read::{States, read};

/// One state: a vector for each argument that is known of it, laid out as the functions take it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    values: Vec<(Argument, Vec<f64>)>,
}

impl State {
    /// The vector of an argument.
    pub fn get(&self, argument: Argument) -> Option<&[f64]> {
        self.values.iter().find(|(a, _)| *a == argument).map(|(_, x)| x.as_slice())
    }

    /// The arguments of a function in its order; the first that is missing otherwise.
    pub fn arguments<S>(&self, function: &Function<S>) -> Result<Vec<&[f64]>, Argument> {
        function.takes.iter().map(|&a| self.get(a).ok_or(a)).collect()
    }

    /// Gives an argument its vector.
    pub fn set(&mut self, argument: Argument, vector: Vec<f64>) {
        self.values.retain(|(a, _)| *a != argument);
        self.values.push((argument, vector));
    }
}

/// Every argument that any function takes, each once.
pub fn all_arguments() -> Vec<Argument> {
    let mut all: Vec<Argument> = Vec::new();
    for argument in functions::<f64>().iter().flat_map(|f| f.takes) {
        if !all.contains(argument) {
            all.push(*argument);
        }
    }
    all
}

/// Where the numbers of a joint are in an argument: first index and how many. `None` for an argument that is not by joint.
pub(crate) fn slot(argument: Argument, joint: &JointInfo, model: &Model<f64>) -> Option<(usize, usize)> {
    match argument {
        Argument::Q => Some(joint.q),
        other => (other.len(model.shape()) == model.nv).then_some(joint.v),
    }
}

/// First indices in q of the unit quaternions, with the joints that have them.
pub(crate) fn quaternions(model: &Model<f64>) -> impl Iterator<Item = (&JointInfo, usize)> {
    model.joints.iter().filter(|j| j.q.1 == 7).map(|j| (j, j.q.0 + 3))
}
