//! Nested sums as lists of terms.

use crate::graph::{Graph, Node, Op};

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

/// How often each node is a term of what adds two nodes or turns one's sign.
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
