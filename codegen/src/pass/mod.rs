//! Graph passes: `Graph → Graph`, keeping the algebra. One file each, in the order of
//! [`GRAPH_PASSES`].

mod adjoint;
mod chains;
mod cse_partial_sums;
mod dce;
mod factor;
mod fma_contract;
mod from_the_last;
mod hoist;
mod inline;
mod region_derivatives;
mod sink_into_reduction;
mod sums;
mod tangent;

pub use adjoint::adjoint;
pub(crate) use adjoint::gradients;
pub use cse_partial_sums::cse_partial_sums;
pub use dce::dce;
pub use factor::factor;
pub use fma_contract::fma_contract;
pub use from_the_last::from_the_last;
pub use hoist::hoist;
pub use inline::inline;
pub use sink_into_reduction::sink_into_reduction;
pub use tangent::tangent;
pub(crate) use tangent::tangents;

use articulated_core::running::Running;

use crate::graph::{Graph, Node, NodeId, Op, Region};

/// A pass over graphs.
pub type GraphPass = fn(&Graph) -> Graph;

/// One row: a pass with its name.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// Its name in the ledger.
    pub name: &'static str,
    /// The pass.
    pub pass: GraphPass,
    /// Its description, for the ledger.
    pub does: &'static str,
    /// Its postcondition.
    pub holds: &'static str,
}

/// The passes in order.
pub const GRAPH_PASSES: &[Row] = &[
    Row { name: "dce", pass: dce, does: "dead code removed", holds: "every node is needed by an output" },
    Row {
        name: "factor",
        pass: factor,
        does: "common factors multiplied once",
        holds: "no two products that only one sum uses have a factor in common there",
    },
    Row {
        name: "cse_partial_sums",
        pass: cse_partial_sums,
        does: "partial sums of several sums computed once",
        holds: "no two sums have two terms in common, where that saves an instruction",
    },
    Row {
        name: "sink_into_reduction",
        pass: sink_into_reduction,
        does: "terms beside a sum over lanes added within the lanes",
        holds: "each term beside a sum over lanes is in that sum, where that takes no further instruction",
    },
    Row {
        name: "fma_contract",
        pass: fma_contract,
        does: "sums as chains of multiply-adds",
        holds: "no sum is a term of one other sum; a product that only one or two sums use is part of multiply-adds, but for one a sum at most",
    },
    Row { name: "final_dce", pass: dce, does: "dead code removed again", holds: "every node is needed by an output again" },
];

/// The graph after all passes in order; `see` is called after each of them. In debug builds each
/// pass is checked, as in [`run`].
pub(crate) fn run_all(graph: Graph, mut see: impl FnMut(&'static str, &Graph)) -> Graph {
    fn checked(body: Graph) -> Graph {
        run_all(body, |_, _| {})
    }
    let graph = if graph.has_regions() { bodies(&run("hoist", hoist, &dce(&graph)), checked) } else { graph };
    GRAPH_PASSES.iter().fold(graph, |graph, row| {
        let new = run(row.name, row.pass, &graph);
        see(row.name, &new);
        new
    })
}

/// The same without checks, for graphs that are only counted.
pub(crate) fn run_all_unchecked(graph: Graph) -> Graph {
    let graph = if graph.has_regions() { bodies(&hoist(&dce(&graph)), run_all_unchecked) } else { graph };
    GRAPH_PASSES.iter().fold(graph, |graph, row| (row.pass)(&graph))
}

/// The graph with the passes run on the bodies of its regions.
fn bodies(graph: &Graph, passes: fn(Graph) -> Graph) -> Graph {
    graph.clone().with_regions(|region| Region { body: passes(region.body.clone()), ..region.clone() })
}

/// Rebuilds a graph node by node: `rewrite(new, node, operands)` gives the new node for each old
/// one that `keep` lets through.
pub(crate) fn rebuild(old: &Graph, keep: impl Fn(usize) -> bool, mut rewrite: impl FnMut(&mut Graph, Node, &[NodeId]) -> NodeId) -> Graph {
    let mut new = old.emptied();
    let mut ids = vec![NodeId(u32::MAX); old.nodes().len()];
    for (k, node) in old.nodes().iter().enumerate().filter(|(k, _)| keep(*k)) {
        ids[k] = if node.op.row().arity == 0 {
            new.leaf(*node)
        } else {
            let mut operands = [NodeId(0); 3];
            operands.iter_mut().zip(node.operands()).for_each(|(slot, id)| *slot = ids[id.index()]);
            rewrite(&mut new, *node, &operands[..node.op.row().arity])
        };
    }
    new.outputs = old.outputs.iter().map(|o| ids[o.index()]).collect();
    new
}

/// Adds the nodes of `graph` to another, with some of its inputs replaced. Returns its outputs.
pub(crate) fn splice(new: &mut Graph, graph: &Graph, mut input: impl FnMut(&mut Graph, usize, usize) -> Option<NodeId>) -> Vec<NodeId> {
    let mut ids: Vec<NodeId> = Vec::with_capacity(graph.nodes().len());
    for node in graph.nodes() {
        let operands: Vec<NodeId> = node.operands().map(|operand| ids[operand.index()]).collect();
        ids.push(match node.op {
            Op::Input => input(new, node.args[0] as usize, node.args[1] as usize).unwrap_or_else(|| new.leaf(*node)),
            _ if operands.is_empty() => new.leaf(*node),
            Op::List | Op::Region | Op::RegionValue => new.adopted(graph, *node, &operands),
            op => new.apply(op, &operands),
        });
    }
    graph.outputs.iter().map(|output| ids[output.index()]).collect()
}

/// Copies a node as it is.
pub(crate) fn copy(new: &mut Graph, node: Node, operands: &[NodeId]) -> NodeId {
    new.on_operands(node, operands)
}

/// Runs a pass; in debug builds checks the result's form, its value on pseudo-random input, and
/// that the cost has not risen.
pub fn run(name: &str, pass: GraphPass, graph: &Graph) -> Graph {
    let new = pass(graph);
    if cfg!(debug_assertions) {
        new.verify().unwrap_or_else(|e| panic!("pass {name}: {e}"));
        assert!(cost(&new) <= cost(graph), "pass {name} raised the cost");
        let values = |g: &Graph| g.evaluate(probe);
        for (k, (a, b)) in values(graph).into_iter().zip(values(&new)).enumerate() {
            let close = a == b || (a - b).abs() <= 1e-9 * (1.0 + a.abs()) || (a.is_nan() && b.is_nan());
            assert!(close || rounding(graph, &new, k), "pass {name} changed output {k}: {a} became {b}");
        }
    }
    new
}

/// Whether output `k` of two graphs differs by rounding at most: where numbers of very different
/// sizes cancel, rounding is all that remains.
fn rounding(one: &Graph, other: &Graph, k: usize) -> bool {
    let known = |g: &Graph| g.evaluate_as(|argument, index| Running::<53, 0>::within(probe(argument, index), 0.0))[k];
    let (a, b) = (known(one), known(other));
    let (off, most) = ((a.value - b.value).abs(), a.radius + b.radius);
    off <= most || off.is_nan() || most.is_nan()
}

/// Total cost of a graph; that of regions at their bounds.
pub(crate) fn cost(graph: &Graph) -> u32 {
    let own: u32 = graph.nodes().iter().map(|n| n.op.row().cost).sum();
    let regions = graph.nodes().iter().filter(|node| node.op == Op::Region).map(|node| graph.region_of(node));
    regions.fold(own, |sum, region| sum.saturating_add(cost(&region.body).saturating_mul(region.most() as u32)))
}

/// A fixed irregular number in (−1, 1) for each input.
fn probe(argument: usize, index: usize) -> f64 {
    let x = ((argument * 7919 + index * 104_729 + 13) as f64 * 0.754_877_666_246_692_7).fract();
    2.0 * x - 1.0
}
