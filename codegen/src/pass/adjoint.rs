//! Reverse mode: from a graph of y = f(x) that of λᵀ ∂y/∂x.
//!
//! For each node n, from the last to the first, the adjoint n̄ = ∂(λᵀy)/∂n is known when all of its
//! uses were visited. A use m = op(…, n, …) adds m̄ ∂m/∂n to it. Griewank & Walther, *Evaluating
//! Derivatives*, 2nd ed., 2008, §3.2. A comparison has no derivative, and a choice has that of its
//! branch: at a kink the derivative is of the side that is computed.
//!
//! Limbs are put into lanes after this, so there are no lanes here.

use std::collections::HashMap;

use super::region_derivatives::Occurrence;
use super::{copy, rebuild};
use crate::graph::{Graph, Node, NodeId, Op};

/// λᵀ ∂y/∂x for the outputs y and the inputs x = `wrt`, each an argument with an index. `weight`
/// makes the node of λ for each output.
pub fn adjoint(graph: &Graph, wrt: &[(usize, usize)], weight: impl FnMut(&mut Graph, usize) -> NodeId) -> Graph {
    let mut new = rebuild(graph, |_| true, copy);
    let outputs = std::mem::take(&mut new.outputs);
    let count = new.nodes().len();
    new.outputs = gradients(&mut new, &outputs, count, wrt, weight);
    new
}

/// Adds the nodes of λᵀ ∂y/∂x to a graph, whose first `count` nodes are those of f.
pub(crate) fn gradients(
    graph: &mut Graph,
    outputs: &[NodeId],
    count: usize,
    wrt: &[(usize, usize)],
    mut weight: impl FnMut(&mut Graph, usize) -> NodeId,
) -> Vec<NodeId> {
    let places: HashMap<(usize, usize), usize> = wrt.iter().copied().zip(0..).collect();
    let place = |node: &Node| {
        let input = (node.args[0] as usize, node.args[1] as usize);
        if node.op == Op::Input { places.get(&input).copied() } else { None }
    };
    let mut active: Vec<bool> = Vec::with_capacity(count);
    for node in &graph.nodes()[..count] {
        active.push(place(node).is_some() || node.op != Op::Positive && node.operands().any(|operand| active[operand.index()]));
    }
    let mut sweep = Sweep { adjoints: vec![None; count], active, of_regions: HashMap::new(), graph };
    for (k, output) in outputs.iter().enumerate() {
        if sweep.active[output.index()] {
            let weight = weight(sweep.graph, k);
            sweep.add(*output, weight, false);
        }
    }
    let mut found = vec![None; wrt.len()];
    for k in (0..count).rev() {
        let (node, Some(adjoint)) = (sweep.graph.nodes()[k], sweep.adjoints[k]) else { continue };
        match place(&node) {
            Some(place) => found[place] = Some(adjoint),
            None => sweep.visit(NodeId(k as u32), node, adjoint),
        }
    }
    found.into_iter().map(|found| found.unwrap_or_else(|| sweep.graph.constant(0.0))).collect()
}

struct Sweep<'a> {
    graph: &'a mut Graph,
    /// Of the nodes of f.
    adjoints: Vec<Option<NodeId>>,
    /// Whether a node of f depends on x.
    active: Vec<bool>,
    /// Of the values that come out of regions.
    of_regions: HashMap<NodeId, Vec<Option<NodeId>>>,
}

impl Sweep<'_> {
    /// Adds ± `what` to the adjoint of a node.
    fn add(&mut self, to: NodeId, what: NodeId, minus: bool) {
        let next = match self.adjoints[to.index()] {
            None if minus => self.graph.apply(Op::Neg, &[what]),
            None => what,
            Some(sum) => self.graph.apply(if minus { Op::Sub } else { Op::Add }, &[sum, what]),
        };
        self.adjoints[to.index()] = Some(next);
    }

    /// Hands the adjoint of a node on to its operands.
    fn visit(&mut self, of: NodeId, node: Node, adjoint: NodeId) {
        let [a, b, c] = node.args.map(NodeId);
        let arity = node.op.row().arity;
        let is_active = |k: usize| k < arity && self.active[node.args[k] as usize];
        let [on_a, on_b, on_c] = [0, 1, 2].map(is_active);
        let times = |sweep: &mut Self, x: NodeId| sweep.graph.apply(Op::Mul, &[adjoint, x]);
        match node.op {
            Op::Constant | Op::Input | Op::Positive | Op::List => {}
            Op::RegionValue => {
                let values = self.graph.region_of(&self.graph.node(a)).values();
                self.of_regions.entry(a).or_insert_with(|| vec![None; values])[node.args[1] as usize] = Some(adjoint);
                // Only that it has one counts.
                self.adjoints[a.index()] = Some(adjoint);
            }
            Op::Region => {
                let (region, weights) = (Occurrence::new(self.graph, of), self.of_regions.remove(&of).unwrap_or_default());
                let active: Vec<bool> = region.given.iter().map(|id| self.active[id.index()]).collect();
                for (k, adjoint) in region.adjoint(self.graph, &weights, &active) {
                    if active[k] {
                        self.add(region.given[k], adjoint, false);
                    }
                }
            }
            Op::LaneConstant | Op::LaneInput | Op::Broadcast | Op::ReduceAdd => debug_assert!(false, "no lanes here"),
            Op::Add | Op::Sub => {
                if on_a {
                    self.add(a, adjoint, false);
                }
                if on_b {
                    self.add(b, adjoint, node.op == Op::Sub);
                }
            }
            // d(ab) = b da + a db, with the signs of sums of products
            Op::Mul | Op::MulAdd | Op::MulSub | Op::NegMulAdd | Op::NegMulSub => {
                let minus = matches!(node.op, Op::NegMulAdd | Op::NegMulSub);
                if on_a {
                    let part = times(self, b);
                    self.add(a, part, minus);
                }
                if on_b {
                    let part = times(self, a);
                    self.add(b, part, minus);
                }
                if on_c {
                    self.add(c, adjoint, matches!(node.op, Op::MulSub | Op::NegMulSub));
                }
            }
            // d(a/b) = da/b − (a/b) db/b;  d(1/b) = −(1/b)² db
            Op::Div if !on_a && self.graph.constant_value(a).is_some_and(|x| x.iter().all(|x| *x == 1.0)) => {
                let part = times(self, of);
                let part = self.graph.apply(Op::Mul, &[part, of]);
                self.add(b, part, true);
            }
            Op::Div => {
                let part = self.graph.apply(Op::Div, &[adjoint, b]);
                if on_a {
                    self.add(a, part, false);
                }
                if on_b {
                    let part = self.graph.apply(Op::Mul, &[part, of]);
                    self.add(b, part, true);
                }
            }
            Op::Neg => self.add(a, adjoint, true),
            // d√a = da/(2√a)
            Op::Sqrt => {
                let half = self.graph.constant(0.5);
                let part = times(self, half);
                let part = self.graph.apply(Op::Div, &[part, of]);
                self.add(a, part, false);
            }
            Op::Sin => {
                let cos = self.graph.apply(Op::Cos, &[a]);
                let part = times(self, cos);
                self.add(a, part, false);
            }
            Op::Cos => {
                let sin = self.graph.apply(Op::Sin, &[a]);
                let part = times(self, sin);
                self.add(a, part, true);
            }
            // d atan2(y, x) = (x dy − y dx)/(x² + y²)
            Op::Atan2 => {
                let (y2, x2) = (self.graph.apply(Op::Mul, &[a, a]), self.graph.apply(Op::Mul, &[b, b]));
                let square = self.graph.apply(Op::Add, &[y2, x2]);
                let part = self.graph.apply(Op::Div, &[adjoint, square]);
                if on_a {
                    let part = self.graph.apply(Op::Mul, &[part, b]);
                    self.add(a, part, false);
                }
                if on_b {
                    let part = self.graph.apply(Op::Mul, &[part, a]);
                    self.add(b, part, true);
                }
            }
            Op::Select => {
                let zero = self.graph.constant(0.0);
                if on_b {
                    let part = self.graph.apply(Op::Select, &[a, adjoint, zero]);
                    self.add(b, part, false);
                }
                if on_c {
                    let part = self.graph.apply(Op::Select, &[a, zero, adjoint]);
                    self.add(c, part, false);
                }
            }
        }
    }
}
