//! Sums as chains of multiply-adds.

use super::chains::{Known, plan};
use super::sums::{Term, flatten, inner, is_sum, uses_in_sums};
use crate::graph::{Graph, Node, NodeId, Op};

/// Multiplications or multiply-adds that a processor begins in a cycle.
const A_CYCLE: u32 = 2;

/// Fraction of the total latency by which the last result may be late for the sake of fewer
/// instructions; a processor looks only so far ahead.
const GRACE: u32 = 16;

/// Number of instructions from which on a program nearly fills the instruction cache: then no gain
/// is worth more of them.
const LONG: u32 = 1800;

/// From this many sums on, a product that they use is computed once: one instruction more for two
/// multiplications fewer, and processors that add beside multiplying have additions to spare.
const SHARED: u32 = 3;

/// Flattens nested sums and rebuilds each as a chain, in which every product that only sums use,
/// and at most two, is part of a multiply-add.
///
/// A chain takes its terms in the order in which they become known, so that the last one waits for
/// nothing but itself. Each sum is due when the last result still is in time; where one chain would
/// be late, it is cut into two or three, which takes more instructions. A sum of products alone
/// needs one that is computed on its own to start from; those are chosen so that as few as possible
/// are. Re-association changes results by roundings only.
pub fn fma_contract(graph: &Graph) -> Graph {
    let sums = Sums::of(graph);
    let due = build(graph, &sums, &vec![0; graph.nodes().len()]).due();
    build(graph, &sums, &due).new
}

/// Rebuilds the graph with each sum by the time that `due` gives for its node.
fn build<'a>(graph: &'a Graph, sums: &Sums, due: &[u32]) -> Builder<'a> {
    let mut builder = Builder { graph, new: graph.emptied(), ids: vec![NodeId(u32::MAX); graph.nodes().len()], arrival: Vec::new() };
    for (k, node) in graph.nodes().iter().enumerate() {
        if !sums.inner[k] && !sums.fused(k) {
            builder.ids[k] = match &sums.terms[k] {
                Some(terms) => builder.sum(terms, sums, due[k]),
                None => builder.copy(node),
            };
        }
    }
    builder.new.outputs = graph.outputs.iter().map(|o| builder.ids[o.index()]).collect();
    builder
}

/// The sums of a graph.
struct Sums {
    /// Nodes that are part of a larger sum and nothing else.
    inner: Vec<bool>,
    /// The terms of each sum that is not inner.
    terms: Vec<Option<Vec<Term>>>,
    /// Products that only sums use.
    fusible: Vec<bool>,
    /// Those of them that are computed on their own nevertheless, because a sum starts from them or
    /// many sums use them.
    seed: Vec<bool>,
}

impl Sums {
    fn of(graph: &Graph) -> Self {
        let nodes = graph.nodes();
        let (uses, in_sums) = (graph.uses(), uses_in_sums(graph));
        let inner = inner(graph);
        let fusible: Vec<bool> = (0..nodes.len()).map(|k| nodes[k].op == Op::Mul && uses[k] > 0 && uses[k] == in_sums[k]).collect();
        let seed = (0..nodes.len()).map(|k| fusible[k] && uses[k] >= SHARED).collect();
        let terms = (0..nodes.len()).map(|k| (is_sum(&nodes[k]) && !inner[k]).then(|| flatten(graph, &inner, k))).collect();
        let mut sums = Self { inner, terms, fusible, seed };
        sums.choose_seeds(&uses);
        sums
    }

    /// Whether a node is a product that is part of multiply-adds only.
    fn fused(&self, k: usize) -> bool {
        self.fusible[k] && !self.seed[k]
    }

    /// A sum all of whose terms would be fused starts from one of them: the one that most sums use,
    /// as it may serve them all.
    fn choose_seeds(&mut self, uses: &[u32]) {
        for terms in self.terms.iter().flatten() {
            if terms.iter().all(|t| self.fusible[t.node] && !self.seed[t.node])
                && let Some(seed) = terms.iter().max_by_key(|t| (uses[t.node], usize::MAX - t.node))
            {
                self.seed[seed.node] = true;
            }
        }
    }
}

/// A node with a sign in front.
#[derive(Clone, Copy, Debug)]
struct Signed {
    negative: bool,
    node: NodeId,
}

struct Builder<'a> {
    graph: &'a Graph,
    new: Graph,
    /// The new node of each old one that has one.
    ids: Vec<NodeId>,
    /// When each new node's value is known, in cycles.
    arrival: Vec<u32>,
}

impl Builder<'_> {
    fn push(&mut self, op: Op, operands: &[NodeId]) -> NodeId {
        let id = self.new.exactly(op, operands);
        self.note(id)
    }

    fn copy(&mut self, node: &Node) -> NodeId {
        if node.op.row().arity == 0 {
            let id = self.new.leaf(*node);
            return self.note(id);
        }
        let operands: Vec<NodeId> = node.operands().map(|a| self.ids[a.index()]).collect();
        let id = self.new.on_operands(*node, &operands);
        self.note(id)
    }

    fn note(&mut self, id: NodeId) -> NodeId {
        if id.index() == self.arrival.len() {
            let node = self.new.node(id);
            let start = node.operands().map(|a| self.arrival[a.index()]).max().unwrap_or(0);
            self.arrival.push(start + node.op.row().latency);
        }
        id
    }

    /// When the value of each old node is due, in cycles, for the last result to be known in time:
    /// a little later than it is here, if the instructions take longer anyway, and of a long
    /// program when these are done.
    fn due(&self) -> Vec<u32> {
        let nodes = self.new.nodes();
        let earliest = self.new.outputs.iter().map(|o| self.arrival[o.index()]).max().unwrap_or(0);
        let instructions = self.new.counts().instructions() as u32;
        let busy = instructions / A_CYCLE;
        let last = match busy > earliest {
            true if instructions > LONG => busy,
            true => earliest + earliest / GRACE,
            false => earliest,
        };
        let mut due = vec![last; nodes.len()];
        for (k, node) in nodes.iter().enumerate().rev() {
            let start = due[k].saturating_sub(node.op.row().latency);
            node.operands().for_each(|a| due[a.index()] = due[a.index()].min(start));
        }
        self.ids.iter().map(|id| due.get(id.index()).copied().unwrap_or(last)).collect()
    }

    /// When a term could be added: for a fused product, when its factors are known.
    fn known(&self, term: Term, sums: &Sums) -> u32 {
        let at = |id: NodeId| self.arrival[id.index()];
        if sums.fused(term.node) { self.factors(term.node).into_iter().map(at).max().unwrap_or(0) } else { at(self.ids[term.node]) }
    }

    fn factors(&self, product: usize) -> [NodeId; 2] {
        let [a, b, _] = self.graph.nodes()[product].args;
        [self.ids[a as usize], self.ids[b as usize]]
    }

    /// Builds a sum by the plan that takes fewest instructions of those that are done when it is
    /// due.
    fn sum(&mut self, terms: &[Term], sums: &Sums, due: u32) -> NodeId {
        let mut terms: Vec<(Term, Known)> =
            terms.iter().map(|t| (*t, Known { at: self.known(*t, sums), fused: sums.fused(t.node) })).collect();
        terms.sort_by_key(|(_, known)| known.at);
        let known: Vec<Known> = terms.iter().map(|(_, known)| *known).collect();
        let mut total: Option<Signed> = None;
        for chain in plan(&known, due) {
            let part = chain.into_iter().fold(None, |sum, k| Some(self.add(sum, terms[k].0, sums)));
            total = match (total, part) {
                (Some(total), Some(part)) => Some(self.add_nodes(total, part)),
                (total, part) => total.or(part),
            };
        }
        match total {
            Some(Signed { negative: false, node }) => node,
            Some(Signed { negative: true, node }) => self.negate(node),
            None => self.new.constant(0.0),
        }
    }

    /// sum + term; a first term that is a product is computed on its own.
    fn add(&mut self, sum: Option<Signed>, term: Term, sums: &Sums) -> Signed {
        let fused = sums.fused(term.node);
        let Some(sum) = sum else {
            let node = if fused { self.push(Op::Mul, &self.factors(term.node)) } else { self.ids[term.node] };
            return Signed { negative: term.negative, node };
        };
        if !fused {
            return self.add_nodes(sum, Signed { negative: term.negative, node: self.ids[term.node] });
        }
        let [a, b] = self.factors(term.node);
        // ±sum ± a·b; two minuses stay outside, in the hope of a plus to come.
        let (op, negative) = match (term.negative, sum.negative) {
            (false, false) => (Op::MulAdd, false),
            (true, false) => (Op::NegMulAdd, false),
            (false, true) => (Op::MulSub, false),
            (true, true) => (Op::MulAdd, true),
        };
        Signed { negative, node: self.push(op, &[a, b, sum.node]) }
    }

    fn add_nodes(&mut self, a: Signed, b: Signed) -> Signed {
        let (op, x, y, negative) = match (a.negative, b.negative) {
            (false, false) => (Op::Add, a, b, false),
            (false, true) => (Op::Sub, a, b, false),
            (true, false) => (Op::Sub, b, a, false),
            (true, true) => (Op::Add, a, b, true),
        };
        Signed { negative, node: self.push(op, &[x.node, y.node]) }
    }

    /// −x; of a multiply-add that was just made, with its signs turned.
    fn negate(&mut self, x: NodeId) -> NodeId {
        let node = self.new.node(x);
        match node.op {
            Op::MulAdd => self.push(Op::NegMulSub, &node.args.map(NodeId)),
            _ => self.push(Op::Neg, &[x]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pass::dce;

    fn at(_: usize, k: usize) -> f64 {
        [0.3, -0.8, 1.7, 2.9, -0.45, 0.62][k]
    }

    fn check(g: &Graph, instructions: u64) {
        let new = dce(&fma_contract(g));
        new.verify().unwrap();
        assert_eq!(new.counts().instructions(), instructions);
        for (a, b) in new.evaluate(at).into_iter().zip(g.evaluate(at)) {
            assert!((a - b).abs() < 1e-15, "{a} {b}");
        }
    }

    #[test]
    fn a_rotation_is_one_product_and_one_multiply_add_a_component() {
        let mut g = Graph::default();
        let [c, s, x, y] = [0, 1, 2, 3].map(|k| g.input(0, k));
        let [cx, sy, sx, cy] = [[c, x], [s, y], [s, x], [c, y]].map(|f| g.apply(Op::Mul, &f));
        let sum = g.apply(Op::Add, &[cx, sy]);
        let difference = g.apply(Op::Sub, &[sx, cy]);
        let negative = g.apply(Op::Neg, &[difference]);
        g.outputs = vec![sum, negative];
        check(&g, 4);
    }

    #[test]
    fn nested_sums_are_one_chain() {
        let mut g = Graph::default();
        let [a, b, c, d, e, f] = [0, 1, 2, 3, 4, 5].map(|k| g.input(0, k));
        let [ab, cd, ef] = [[a, b], [c, d], [e, f]].map(|f| g.apply(Op::Mul, &f));
        let left = g.apply(Op::Sub, &[ab, cd]);
        let right = g.apply(Op::Sub, &[ef, a]);
        g.outputs = vec![g.clone().apply(Op::Sub, &[left, right])];
        let all = g.apply(Op::Sub, &[left, right]);
        g.outputs = vec![all];
        check(&g, 3);
    }

    #[test]
    fn a_product_that_three_sums_use_is_computed_once() {
        let mut g = Graph::default();
        let [a, b, c, d, e] = [0, 1, 2, 3, 4].map(|k| g.input(0, k));
        let ab = g.apply(Op::Mul, &[a, b]);
        g.outputs = [c, d, e].map(|x| g.apply(Op::Add, &[ab, x])).to_vec();
        check(&g, 4);
        assert_eq!(dce(&fma_contract(&g)).nodes().iter().filter(|n| n.op == Op::Add).count(), 3);
    }

    #[test]
    fn a_product_that_two_sums_use_vanishes_into_both() {
        let mut g = Graph::default();
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| g.input(0, k));
        let ab = g.apply(Op::Mul, &[a, b]);
        g.outputs = vec![];
        let (x, y) = (g.apply(Op::Add, &[ab, c]), g.apply(Op::Sub, &[ab, d]));
        g.outputs = vec![x, y];
        check(&g, 2);
    }

    #[test]
    fn minus_everything_needs_no_sign_of_its_own() {
        let mut g = Graph::default();
        let [a, b, c] = [0, 1, 2].map(|k| g.input(0, k));
        let ab = g.apply(Op::Mul, &[a, b]);
        let sum = g.apply(Op::Add, &[ab, c]);
        let minus = g.apply(Op::Neg, &[sum]);
        g.outputs = vec![minus];
        check(&g, 1);
    }

    #[test]
    fn a_sum_that_has_another_use_keeps_its_sign_when_it_is_turned() {
        for [first, second] in [[Op::Add, Op::Add], [Op::Add, Op::Sub], [Op::Sub, Op::Add], [Op::Sub, Op::Sub]] {
            let mut g = Graph::default();
            let [a, b, c, d] = [0, 1, 2, 3].map(|k| g.input(0, k));
            let ab = g.exactly(Op::Mul, &[a, b]);
            for sum in [g.exactly(first, &[ab, c]), g.exactly(second, &[d, ab])] {
                let (minus, root) = (g.exactly(Op::Neg, &[sum]), g.exactly(Op::Sqrt, &[sum]));
                g.outputs.extend([minus, root, sum]);
            }
            let new = dce(&fma_contract(&g));
            let positive = |argument: usize, k: usize| at(argument, k).abs();
            for (a, b) in new.evaluate(positive).into_iter().zip(g.evaluate(positive)) {
                assert!((a - b).abs() < 1e-15 || a.is_nan() && b.is_nan(), "{a} {b}");
            }
        }
    }
}
