//! One function, from its algorithms to the graph that is emitted.

mod candidate;
mod columns;
mod forms;
pub(crate) mod strategy;

use articulated_core::model::Model;

use crate::Options;
use crate::capabilities::Capabilities;
use crate::graph::{Graph, Op};
use crate::ledger::Entry;
use crate::limbs::IsomorphicLimbs;
use crate::parameters::Parameter;
use crate::pass;
use crate::spec::FunctionSpec;
use candidate::Candidate;

pub(crate) use columns::{MultiRhsSolve, has_columns};
pub(crate) use strategy::Strategy;

/// A function and what it became.
pub(crate) struct Program {
    pub(crate) spec: FunctionSpec,
    pub(crate) graph: Graph,
    /// The graph with each limb for itself: what a batch runs, a state a lane.
    pub(crate) plain: Graph,
    pub(crate) entry: Entry,
    /// What is left a loop. Then `graph` is what comes before.
    pub(crate) columns: Option<MultiRhsSolve>,
}

/// A function by the cheapest of its ways, limbs that are alike in lanes if that is cheaper.
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
    // Limbs need the vector instructions; constants that stay inputs differ from limb to limb.
    if options.limbs && can.vectors && parameters.is_empty() {
        for width in [4, 2] {
            let Some(alike) = IsomorphicLimbs::of(model, width) else { continue };
            let other = Candidate { alike: Some(alike), ..candidate }.build(&reduced, unsolved);
            if price(&other.0) * WORTH < price(&best.0) {
                best = other;
            }
        }
    }
    let (graph, mut entry) = best;
    if let Some(columns) = &columns {
        columns.count(&mut entry);
    }
    Program { spec, graph, plain, entry, columns }
}

/// Lanes cost what no count shows (values that come and go one by one): they must be cheaper by this.
const WORTH: f64 = 1.15;

/// Instructions of sines and cosines of as many angles as there are lanes.
const SINES: f64 = 28.0;

/// What a program costs, in instructions, plain or in lanes: sines go four angles at a time, or the angles of all lanes; inputs of lanes come one by one.
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
