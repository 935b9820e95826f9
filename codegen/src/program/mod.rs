//! One function, from its algorithms to the graph that is emitted.

mod candidate;
mod columns;
mod forms;
pub(crate) mod strategy;

use articulated_core::model::Model;

use crate::Options;
use crate::capabilities::Capabilities;
use crate::function_spec::FunctionSpec;
use crate::graph::{Graph, Op};
use crate::ledger::Entry;
use crate::limbs::{self, IsomorphicLimbs};
use crate::parameters::Parameter;
use crate::pass;
use candidate::Candidate;

pub(crate) use columns::{MultiRhsSolve, has_columns};
pub(crate) use strategy::Strategy;

/// A function with its graph.
pub(crate) struct Program {
    pub(crate) spec: FunctionSpec,
    pub(crate) graph: Graph,
    /// The graph without vectorized limbs, for batches with one state per lane.
    pub(crate) plain: Graph,
    /// The graph without vectorized limbs, for compilers without vectors: the part before the loop
    /// where there is one.
    pub(crate) scalar: Graph,
    pub(crate) entry: Entry,
    /// The part emitted as a loop; `graph` is the part before it.
    pub(crate) columns: Option<MultiRhsSolve>,
    /// The graph of the whole function where there is such a loop: the loop is a region.
    pub(crate) with_loop: Option<Graph>,
}

/// The program of a function by its cheapest strategy, with isomorphic limbs in lanes if that is
/// cheaper.
pub(crate) fn program(spec: FunctionSpec, model: &Model<f64>, parameters: &[Parameter], options: &Options, can: Capabilities) -> Program {
    let candidate = Candidate { model, parameters, stages: options.stages, alike: None };
    let reduced = spec.reduced();
    let columns = columns::columns(&reduced, model, can);
    let whole = (columns.is_none() || can.states).then(|| candidate.build(&reduced, None));
    let unsolved = columns.as_ref().and(reduced.parts[0].function.unsolved.as_ref());
    let mut best = match &whole {
        Some(whole) if unsolved.is_none() => whole.clone(),
        _ => candidate.build(&reduced, unsolved),
    };
    let plain = whole.map_or_else(Graph::default, |(graph, _)| graph);
    let with_loop = columns.as_ref().map(|columns| columns.whole(&best.0));
    let scalar = if can.scalar_too { best.0.clone() } else { Graph::default() };
    // Limbs need the vector instructions; constants that stay inputs differ from limb to limb, and
    // masks of regions are those of a whole state.
    if options.limbs && can.vectors && parameters.is_empty() && !best.0.has_regions() {
        for width in [4, 2] {
            let completed = limbs::completed(model, width);
            let model = completed.as_ref().unwrap_or(model);
            let Some(alike) = IsomorphicLimbs::of(model, width) else { continue };
            let other = Candidate { model, alike: Some(alike), ..candidate }.build(&reduced, unsolved);
            if price(&other.0) * MIN_GAIN < price(&best.0) {
                best = other;
            }
        }
    }
    let (graph, mut entry) = best;
    if let Some(columns) = &columns {
        columns.count(&mut entry);
    }
    Program { spec, graph, plain, scalar, entry, columns, with_loop }
}

/// Minimal gain of lanes, which have costs that no count shows (values inserted and extracted one
/// by one).
const MIN_GAIN: f64 = 1.15;

/// Instructions of the sines and cosines of one vector of angles.
const SINES: f64 = 28.0;

/// The cost of a program in instructions, plain or in lanes. Sines take four angles at a time, or
/// those of all lanes; inputs of lanes are loaded one by one.
fn price(graph: &Graph) -> f64 {
    let counts = graph.counts();
    let rows = f64::from(pass::cost(graph)) - 10.0 * counts.trigonometric() as f64;
    let mut angles: Vec<u32> = graph.nodes().iter().filter(|n| matches!(n.op, Op::Sin | Op::Cos)).map(|n| n.args[0]).collect();
    angles.sort_unstable();
    angles.dedup();
    let width = graph.lanes().width;
    let calls = (angles.len() * width).div_ceil(4);
    rows + SINES * calls as f64 + (counts.of(Op::LaneInput) as usize * width) as f64
}
