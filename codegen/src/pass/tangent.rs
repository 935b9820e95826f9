//! Forward mode: from a graph of y = f(x) that of ∂y/∂x·dx.
//!
//! Each node n has a tangent dn, by the chain rule from those of its operands. Griewank & Walther,
//! *Evaluating Derivatives*, 2nd ed., 2008, §3.1. A comparison has no derivative, and a choice has
//! that of its branch: at a kink the derivative is of the side that is computed.
//!
//! Limbs are put into lanes after this, so there are no lanes here.

use super::region_derivatives::Occurrence;
use super::{copy, rebuild};
use crate::graph::{Graph, Node, NodeId, Op, Rule};

/// ∂y/∂x·dx for the outputs y. `direction` makes the node of dx for an input x, an argument with an
/// index; `None`: the input is held.
pub fn tangent(graph: &Graph, direction: impl FnMut(&mut Graph, usize, usize) -> Option<NodeId>) -> Graph {
    let mut new = rebuild(graph, |_| true, copy);
    let outputs = std::mem::take(&mut new.outputs);
    let count = new.nodes().len();
    new.outputs = tangents(&mut new, &outputs, count, direction);
    new
}

/// Adds the nodes of ∂y/∂x·dx to a graph, whose first `count` nodes are those of f.
pub(crate) fn tangents(
    graph: &mut Graph,
    outputs: &[NodeId],
    count: usize,
    mut direction: impl FnMut(&mut Graph, usize, usize) -> Option<NodeId>,
) -> Vec<NodeId> {
    let mut tangents: Vec<Option<NodeId>> = Vec::with_capacity(count);
    for k in 0..count {
        let node = graph.nodes()[k];
        let own = match node.op {
            Op::Input => direction(graph, node.args[0] as usize, node.args[1] as usize),
            _ => of_node(graph, NodeId(k as u32), node, &tangents),
        };
        tangents.push(own);
    }
    outputs.iter().map(|output| tangents[output.index()].unwrap_or_else(|| graph.constant(0.0))).collect()
}

/// The tangent of a node; `None`: zero.
fn of_node(graph: &mut Graph, of: NodeId, node: Node, known: &[Option<NodeId>]) -> Option<NodeId> {
    let [a, b, _] = node.args.map(NodeId);
    let arity = node.op.row().arity;
    let [da, db, dc] = [0, 1, 2].map(|k| if k < arity { known[node.args[k] as usize] } else { None });
    if da.is_none() && db.is_none() && dc.is_none() {
        return None;
    }
    let times = |graph: &mut Graph, x: NodeId, dx: Option<NodeId>| dx.map(|dx| graph.apply(Op::Mul, &[x, dx]));
    match node.op {
        Op::Constant | Op::Input | Op::Positive => None,
        // Only that it has one counts.
        Op::List => Some(of),
        Op::Region => {
            let region = Occurrence::new(graph, of);
            if matches!(region.region.rule, Rule::Held) {
                return None;
            }
            let slopes: Vec<Option<NodeId>> = region.given.iter().map(|id| known[id.index()]).collect();
            Some(region.tangent(graph, &slopes))
        }
        Op::RegionValue => Occurrence::new(graph, a).tangent_value(graph, da?, node.args[1] as usize),
        Op::LaneConstant | Op::LaneInput | Op::Broadcast | Op::ReduceAdd => {
            debug_assert!(false, "no lanes here");
            None
        }
        Op::Add => sum(graph, da, db, false),
        Op::Sub => sum(graph, da, db, true),
        // d(ab) = b da + a db, with the signs of sums of products
        Op::Mul | Op::MulAdd | Op::MulSub | Op::NegMulAdd | Op::NegMulSub => {
            let (left, right) = (times(graph, b, da), times(graph, a, db));
            let product = sum(graph, left, right, false);
            match node.op {
                Op::Mul => product,
                Op::MulAdd => sum(graph, product, dc, false),
                Op::MulSub => sum(graph, product, dc, true),
                Op::NegMulAdd => sum(graph, dc, product, true),
                _ => sum(graph, product, dc, false).map(|x| graph.apply(Op::Neg, &[x])),
            }
        }
        // d(a/b) = (da − (a/b) db)/b;  d(1/b) = −(1/b)² db
        Op::Div if da.is_none() && graph.constant_value(a).is_some_and(|x| x.iter().all(|x| *x == 1.0)) => {
            let part = graph.apply(Op::Mul, &[of, db?]);
            let part = graph.apply(Op::Mul, &[part, of]);
            Some(graph.apply(Op::Neg, &[part]))
        }
        Op::Div => {
            let part = times(graph, of, db);
            let rest = sum(graph, da, part, true)?;
            Some(graph.apply(Op::Div, &[rest, b]))
        }
        Op::Neg => da.map(|da| graph.apply(Op::Neg, &[da])),
        // d√a = da/(2√a)
        Op::Sqrt => {
            let half = graph.constant(0.5);
            let part = graph.apply(Op::Mul, &[half, da?]);
            Some(graph.apply(Op::Div, &[part, of]))
        }
        Op::Sin => {
            let cos = graph.apply(Op::Cos, &[a]);
            Some(graph.apply(Op::Mul, &[cos, da?]))
        }
        Op::Cos => {
            let sin = graph.apply(Op::Sin, &[a]);
            let part = graph.apply(Op::Mul, &[sin, da?]);
            Some(graph.apply(Op::Neg, &[part]))
        }
        // d atan2(y, x) = (x dy − y dx)/(x² + y²)
        Op::Atan2 => {
            let (left, right) = (times(graph, b, da), times(graph, a, db));
            let rest = sum(graph, left, right, true)?;
            let (y2, x2) = (graph.apply(Op::Mul, &[a, a]), graph.apply(Op::Mul, &[b, b]));
            let square = graph.apply(Op::Add, &[y2, x2]);
            Some(graph.apply(Op::Div, &[rest, square]))
        }
        Op::Select => {
            let zero = graph.constant(0.0);
            Some(graph.apply(Op::Select, &[a, db.unwrap_or(zero), dc.unwrap_or(zero)]))
        }
    }
}

/// a ± b, where a missing term is zero.
fn sum(graph: &mut Graph, a: Option<NodeId>, b: Option<NodeId>, minus: bool) -> Option<NodeId> {
    match (a, b) {
        (Some(a), Some(b)) => Some(graph.apply(if minus { Op::Sub } else { Op::Add }, &[a, b])),
        (None, Some(b)) if minus => Some(graph.apply(Op::Neg, &[b])),
        (a, b) => a.or(b),
    }
}
