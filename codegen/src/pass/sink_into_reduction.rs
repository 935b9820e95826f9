//! Terms beside a sum over lanes, taken into it.

use super::sums::{Rebuild, Term, flatten, inner, is_sum, open};
use super::{cost, dce};
use crate::graph::{Graph, NodeId, Op};

/// A program that costs more than this is left unchanged: it has other work while it waits for a
/// sum over lanes, and computing the rest early takes instructions.
const LONG: u32 = 1500;

/// Adds terms beside a sum over lanes within the lanes: `reduce_add(x) + c·y` becomes `reduce_add(x
/// + c/w·y)` in w lanes.
///
/// A sum over lanes takes a dozen cycles, and later operations wait for it; within the lanes, such
/// terms are added before. A term is moved if it is equal in all lanes, takes no further
/// instruction (a constant times a value, or a value alone) and has no other use. Shares are powers
/// of two, and so exact.
pub fn sink_into_reduction(graph: &Graph) -> Graph {
    if graph.lanes().width == 1 || cost(graph) > LONG {
        return graph.clone();
    }
    let inner = inner(graph);
    let (uses, same) = (graph.uses(), same_in_all(graph));
    let mut gone = vec![false; graph.nodes().len()];
    let sums: Vec<Option<Sum>> = (0..graph.nodes().len())
        .map(|k| {
            let terms = (is_sum(&graph.nodes()[k]) && !inner[k]).then(|| flatten(graph, &inner, k))?;
            let sum = Sum::of(graph, terms, &uses, &same)?;
            gone[sum.reduction.node] = true;
            open(graph, &inner, k, &mut gone);
            Some(sum)
        })
        .collect();
    let new = dce(&Rebuild::graph(graph, &gone, |rebuild, k| sums[k].as_ref().map(|sum| sum.built(rebuild))));
    // A negated value with other uses can need a negation more.
    if cost(&new) > cost(graph) { graph.clone() } else { new }
}

/// Whether each node has the same value in all lanes.
fn same_in_all(graph: &Graph) -> Vec<bool> {
    let mut same: Vec<bool> = Vec::with_capacity(graph.nodes().len());
    for node in graph.nodes() {
        same.push(match node.op {
            Op::LaneConstant | Op::LaneInput => false,
            Op::ReduceAdd | Op::Broadcast => true,
            _ => node.operands().all(|o| same[o.index()]),
        });
    }
    same
}

/// The terms of a sum with a sum over lanes among them.
struct Sum {
    reduction: Term,
    inside: Vec<Term>,
    outside: Vec<Term>,
}

impl Sum {
    /// `None` if nothing can be taken in.
    fn of(graph: &Graph, mut terms: Vec<Term>, uses: &[u32], same: &[bool]) -> Option<Self> {
        let node = |term: &Term| graph.nodes()[term.node];
        let place = terms.iter().position(|term| node(term).op == Op::ReduceAdd && uses[term.node] == 1)?;
        let reduction = terms.swap_remove(place);
        let shared = |term: &Term| match node(term).op {
            Op::Constant => true,
            Op::Mul => uses[term.node] == 1 && same[term.node] && node(term).operands().any(|o| graph.node(o).op == Op::Constant),
            _ => false,
        };
        let (inside, outside): (Vec<Term>, Vec<Term>) = terms.into_iter().partition(shared);
        (!inside.is_empty()).then_some(Self { reduction, inside, outside })
    }

    fn built(&self, rebuild: &mut Rebuild) -> NodeId {
        let lanes = NodeId(rebuild.graph.nodes()[self.reduction.node].args[0]);
        let part = rebuild.new.constant(1.0 / rebuild.graph.lanes().width as f64);
        let mut terms = vec![(self.reduction.negative, rebuild.ids[lanes.index()])];
        for term in &self.inside {
            let share = rebuild.new.apply(Op::Mul, &[part, rebuild.ids[term.node]]);
            terms.push((term.negative, share));
        }
        let sum = rebuild.add(&terms);
        let mut terms = vec![(false, rebuild.new.apply(Op::ReduceAdd, &[sum]))];
        terms.extend(self.outside.iter().map(|term| (term.negative, rebuild.ids[term.node])));
        rebuild.add(&terms)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(argument: usize, k: usize) -> f64 {
        [[0.3, -0.8, 1.7, 2.9], [-0.45, 0.62, 3.1, -1.2]][argument][k]
    }

    /// x in lanes, y in all of them, and 2.5 y.
    fn leaves(g: &mut Graph) -> [NodeId; 3] {
        let (x, y, c) = (g.lane_input(0, &[0, 1, 2, 3]), g.input(1, 0), g.constant(2.5));
        [x, y, g.apply(Op::Mul, &[c, y])]
    }

    /// The graph with these outputs after the pass, whose values must be the same.
    fn passed(mut g: Graph, outputs: &[NodeId]) -> Graph {
        g.outputs = outputs.to_vec();
        let new = sink_into_reduction(&g);
        new.verify().unwrap();
        for (a, b) in new.evaluate(at).into_iter().zip(g.evaluate(at)) {
            assert!((a - b).abs() < 1e-14, "{a} {b}");
        }
        assert!(cost(&new) <= cost(&g));
        new
    }

    fn ends_in_a_sum_over_lanes(g: &Graph) -> bool {
        g.node(g.outputs[0]).op == Op::ReduceAdd
    }

    #[test]
    fn what_is_added_to_a_sum_over_lanes_goes_into_it_with_its_sign() {
        for [first, second] in [[Op::Add, Op::Add], [Op::Add, Op::Sub], [Op::Sub, Op::Add]] {
            let mut g = Graph::in_lanes(4);
            let [x, _, product] = leaves(&mut g);
            let (reduction, c) = (g.apply(Op::ReduceAdd, &[x]), g.constant(-7.0));
            let sum = g.apply(first, &[reduction, product]);
            let sum = g.apply(second, &[sum, c]);
            assert!(ends_in_a_sum_over_lanes(&passed(g, &[sum])), "{first:?} {second:?}");
        }
        let mut g = Graph::in_lanes(4);
        let [x, _, product] = leaves(&mut g);
        let reduction = g.apply(Op::ReduceAdd, &[x]);
        let difference = g.apply(Op::Sub, &[product, reduction]);
        assert!(ends_in_a_sum_over_lanes(&passed(g, &[difference])));
    }

    #[test]
    fn a_negated_value_with_other_uses_stays_where_it_would_be_negated_twice() {
        let mut g = Graph::in_lanes(4);
        let [x, _, product] = leaves(&mut g);
        let z = g.lane_input(0, &[1, 0, 3, 2]);
        let sum = g.apply(Op::Add, &[x, z]);
        let negative = g.apply(Op::Neg, &[sum]);
        let reduction = g.apply(Op::ReduceAdd, &[negative]);
        let difference = g.apply(Op::Sub, &[reduction, product]);
        let lane = g.constant(1.0);
        let other = g.apply(Op::Broadcast, &[negative, lane]);
        assert!(!ends_in_a_sum_over_lanes(&passed(g, &[difference, other])));
    }

    #[test]
    fn what_would_take_more_or_is_not_the_same_in_all_lanes_stays() {
        let mut g = Graph::in_lanes(4);
        let [x, y, product] = leaves(&mut g);
        let reduction = g.apply(Op::ReduceAdd, &[x]);
        let square = g.apply(Op::Mul, &[y, y]);
        let (half, lanes) = (g.constant(0.5), g.lane_constant([1.0, 2.0, 3.0, 4.0]));
        let in_lanes = g.apply(Op::Mul, &[half, x]);
        for other in [y, square, lanes, in_lanes] {
            let mut g = g.clone();
            let sum = g.apply(Op::Add, &[reduction, other]);
            assert!(!ends_in_a_sum_over_lanes(&passed(g, &[sum])), "node {}", other.0);
        }
        // Used elsewhere: the product, or the sum over lanes.
        for other in [product, reduction] {
            let mut g = g.clone();
            let sum = g.apply(Op::Add, &[reduction, product]);
            assert!(!ends_in_a_sum_over_lanes(&passed(g, &[sum, other])), "node {}", other.0);
        }
    }
}
