//! Nested sums as lists of terms, and graphs with other sums in their place.

use crate::graph::{Graph, Node, NodeId, Op};

/// A term of a sum.
#[derive(Clone, Copy, Debug)]
pub(super) struct Term {
    pub(super) negative: bool,
    pub(super) node: usize,
}

/// Whether a node is a sum.
pub(super) fn is_sum(node: &Node) -> bool {
    matches!(node.op, Op::Add | Op::Sub | Op::Neg)
}

/// Number of uses of each node as a term of additions, subtractions and negations.
pub(super) fn uses_in_sums(graph: &Graph) -> Vec<u32> {
    let mut uses = vec![0; graph.nodes().len()];
    graph.nodes().iter().filter(|n| is_sum(n)).flat_map(Node::operands).for_each(|a| uses[a.index()] += 1);
    uses
}

/// The sums that are a term of one other sum and nothing else.
pub(super) fn inner(graph: &Graph) -> Vec<bool> {
    let (uses, in_sums) = (graph.uses(), uses_in_sums(graph));
    graph.nodes().iter().enumerate().map(|(k, n)| is_sum(n) && uses[k] == 1 && in_sums[k] == 1).collect()
}

/// The terms of the sum at `root`, inner sums opened.
pub(super) fn flatten(graph: &Graph, inner: &[bool], root: usize) -> Vec<Term> {
    let mut terms = Vec::new();
    let mut stack = vec![Term { negative: false, node: root }];
    while let Some(Term { negative, node }) = stack.pop() {
        if node != root && !inner[node] {
            terms.push(Term { negative, node });
            continue;
        }
        let Node { op, args } = graph.nodes()[node];
        let at = |k: usize, flip: bool| Term { negative: negative != flip, node: args[k] as usize };
        match op {
            Op::Add => stack.extend([at(1, false), at(0, false)]),
            Op::Sub => stack.extend([at(1, true), at(0, false)]),
            _ => stack.push(at(0, true)),
        }
    }
    terms
}

/// Marks the sums within the sum at `root`.
pub(super) fn open(graph: &Graph, inner: &[bool], root: usize, marked: &mut [bool]) {
    let mut stack = vec![root];
    while let Some(k) = stack.pop() {
        for a in graph.nodes()[k].operands().map(NodeId::index).filter(|&a| inner[a]) {
            marked[a] = true;
            stack.push(a);
        }
    }
}

/// A graph whose sums are built anew.
pub(super) struct Rebuild<'a> {
    pub(super) graph: &'a Graph,
    pub(super) new: Graph,
    /// The new node of each old one that has one.
    pub(super) ids: Vec<NodeId>,
}

impl<'a> Rebuild<'a> {
    /// The graph without nodes that are `gone`, where the result of `sum` for a node, if any,
    /// replaces it.
    pub(super) fn graph(graph: &'a Graph, gone: &[bool], mut sum: impl FnMut(&mut Self, usize) -> Option<NodeId>) -> Graph {
        let mut rebuild = Self { graph, new: graph.emptied(), ids: vec![NodeId(u32::MAX); graph.nodes().len()] };
        for (k, node) in graph.nodes().iter().enumerate().filter(|(k, _)| !gone[*k]) {
            rebuild.ids[k] = sum(&mut rebuild, k).unwrap_or_else(|| rebuild.copy(*node));
        }
        rebuild.new.outputs = graph.outputs.iter().map(|o| rebuild.ids[o.index()]).collect();
        rebuild.new
    }

    fn copy(&mut self, node: Node) -> NodeId {
        if node.op.row().arity == 0 {
            return self.new.leaf(node);
        }
        let operands: Vec<NodeId> = node.operands().map(|a| self.ids[a.index()]).collect();
        self.new.on_operands(node, &operands)
    }

    /// The sum of terms, each with whether it is negative.
    pub(super) fn add(&mut self, terms: &[(bool, NodeId)]) -> NodeId {
        let nothing = self.new.constant(0.0);
        terms.iter().fold(nothing, |sum, (negative, node)| self.new.apply(if *negative { Op::Sub } else { Op::Add }, &[sum, *node]))
    }
}
