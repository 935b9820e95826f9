//! Another order of the same nodes.

use super::copy;
use crate::graph::{Graph, NodeId};

/// Puts each node where the results first need it, from the last result on. A mass matrix is then
/// computed column by column from the tips, each carried to the base at once. In traced order,
/// joint by joint, there are as many live wrenches as columns.
pub fn from_the_last(graph: &Graph) -> Graph {
    let mut new = graph.emptied();
    let mut ids: Vec<Option<NodeId>> = vec![None; graph.nodes().len()];
    for &result in graph.outputs.iter().rev() {
        let mut open = vec![result];
        while let Some(&id) = open.last() {
            let node = graph.node(id);
            let missing = node.operands().find(|a| ids[a.index()].is_none());
            if let (Some(missing), None) = (missing, ids[id.index()]) {
                open.push(missing);
                continue;
            }
            open.pop();
            let operands: Vec<NodeId> = node.operands().filter_map(|a| ids[a.index()]).collect();
            let place = &mut ids[id.index()];
            *place = place.or_else(|| Some(if operands.is_empty() { new.leaf(node) } else { copy(&mut new, node, &operands) }));
        }
    }
    new.outputs = graph.outputs.iter().filter_map(|o| ids[o.index()]).collect();
    new
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::Op;

    #[test]
    fn the_last_result_is_computed_first_and_all_are_the_same() {
        let mut g = Graph::default();
        let (x, y) = (g.input(0, 0), g.input(0, 1));
        let (sum, product) = (g.apply(Op::Add, &[x, y]), g.apply(Op::Mul, &[x, y]));
        let (first, last) = (g.apply(Op::Add, &[sum, x]), g.apply(Op::Mul, &[product, y]));
        g.outputs = vec![first, last, sum, last];
        let turned = from_the_last(&g);
        let operations: Vec<Op> = turned.nodes().iter().map(|n| n.op).collect();
        assert_eq!(operations, [Op::Input, Op::Input, Op::Mul, Op::Mul, Op::Add, Op::Add]);
        turned.verify().unwrap();
        let values = |g: &Graph| g.evaluate(|_, k| [3.0, 5.0][k]);
        assert_eq!(values(&turned), values(&g));
    }
}
