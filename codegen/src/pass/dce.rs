//! Dead code.

use super::{copy, rebuild};
use crate::graph::Graph;

/// Keeps the nodes that an output needs.
pub fn dce(graph: &Graph) -> Graph {
    let mut needed = vec![false; graph.nodes().len()];
    graph.outputs.iter().for_each(|o| needed[o.index()] = true);
    for (k, node) in graph.nodes().iter().enumerate().rev() {
        if needed[k] {
            node.operands().for_each(|a| needed[a.index()] = true);
        }
    }
    if needed.iter().all(|needed| *needed) { graph.clone() } else { rebuild(graph, |k| needed[k], copy) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::Op;

    #[test]
    fn what_no_output_needs_is_gone() {
        let mut g = Graph::default();
        let (x, y) = (g.input(0, 0), g.input(0, 1));
        let sum = g.apply(Op::Add, &[x, y]);
        g.apply(Op::Mul, &[sum, y]);
        g.outputs = vec![sum];
        assert_eq!(dce(&g).nodes().len(), 3);
    }
}
