//! Cost of each generated function, stage by stage.

use std::borrow::Cow;

use articulated_core::algorithm::Argument;

use crate::graph::{Counts, Graph};
use crate::model_pass::model_passes;
use crate::pass::GRAPH_PASSES;
use crate::program::strategy::Transform;

/// The costs of all functions of one robot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ledger {
    /// One entry per function, in the requested order.
    pub functions: Vec<Entry>,
}

/// The costs of one function.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Name of the function.
    pub function: String,
    /// The ways chosen by count, where the function can be computed in several.
    pub ways: Vec<Cow<'static, str>>,
    /// Counts after each stage: `requested` (operations of the algorithm as written), `trace`
    /// (folded and shared), the same after each model pass and each transform of the strategy
    /// (`shift_masses`, `axis_rates`, `fold_rotations`, `unit`), then after each graph pass.
    /// Without [`stages`](crate::Options::stages) only the last of the model passes.
    pub stages: Vec<(&'static str, Counts)>,
    /// Longest chain of operations from an input to an output.
    pub depth: u32,
    /// Number of isomorphic limbs that are computed together; 1 if each is computed separately.
    pub lanes: usize,
    /// Its arguments, in order; constants of the model that stayed inputs come after them.
    pub arguments: Vec<Argument>,
}

impl Entry {
    /// The counts of the emitted code.
    pub fn emitted(&self) -> &Counts {
        &self.stages[self.stages.len() - 1].1
    }
}

/// Every stage that an entry may have, in order, with its description.
pub fn stages() -> impl Iterator<Item = (&'static str, &'static str)> {
    let first = [("requested", "operations of the algorithm as written"), ("trace", "zeros, ones and equal expressions folded")];
    let model = model_passes::<f64>().iter().map(|(name, _, _)| (*name, "frames and masses moved so that numbers vanish"));
    let graph = GRAPH_PASSES.iter().map(|row| (row.name, row.does));
    let added = Transform::ALL.map(|(_, name, does)| (name, does));
    first.into_iter().chain(model).chain(added).chain(graph)
}

/// Longest chain of operations.
pub fn depth(graph: &Graph) -> u32 {
    let mut depths: Vec<u32> = Vec::with_capacity(graph.nodes().len());
    for node in graph.nodes() {
        let below = node.operands().map(|a| depths[a.index()]).max();
        depths.push(below.map_or(0, |d| d + 1));
    }
    graph.outputs.iter().map(|o| depths[o.index()]).max().unwrap_or(0)
}
