//! Multiply-adds.

use super::{is_product, live, rebuild};
use crate::graph::{Graph, Node, NodeId, Op};

/// Puts each product that one addition or subtraction alone uses into it.
pub fn fuse(graph: &Graph) -> Graph {
    let uses = graph.uses();
    // The factors of an operand that is a product of one use.
    let factors = |id: u32| {
        let node = graph.node(NodeId(id));
        (is_product(node) && uses[id as usize] == 1).then_some(node.args)
    };
    let plan = |node: &Node| -> Option<(Op, [u32; 3])> {
        let [a, b, _] = node.args;
        match node.op {
            Op::Add => factors(a).map(|f| (Op::MulAdd, [f[0], f[1], b])).or_else(|| factors(b).map(|f| (Op::MulAdd, [f[0], f[1], a]))),
            Op::Sub => factors(a).map(|f| (Op::MulSub, [f[0], f[1], b])).or_else(|| factors(b).map(|f| (Op::NegMulAdd, [f[0], f[1], a]))),
            _ => None,
        }
    };
    let mut fused = Graph::default();
    let mut ids: Vec<NodeId> = Vec::with_capacity(graph.nodes().len());
    for node in graph.nodes() {
        let id = match (plan(node), node.op.row().arity) {
            (Some((op, args)), _) => fused.exactly(op, &args.map(|a| ids[a as usize])),
            (None, 0) => fused.leaf(*node),
            (None, _) => {
                let operands: Vec<NodeId> = node.operands().map(|a| ids[a.index()]).collect();
                fused.exactly(node.op, &operands)
            }
        };
        ids.push(id);
    }
    fused.outputs = graph.outputs.iter().map(|o| ids[o.index()]).collect();
    negate(&live(&fused))
}

/// −(a b + c) of one use = −(a b) − c, and so on: the sign costs nothing inside a multiply-add.
fn negate(graph: &Graph) -> Graph {
    let uses = graph.uses();
    let flipped = |op: Op| match op {
        Op::MulAdd => Some(Op::NegMulSub),
        Op::MulSub => Some(Op::NegMulAdd),
        Op::NegMulAdd => Some(Op::MulSub),
        Op::NegMulSub => Some(Op::MulAdd),
        _ => None,
    };
    let rewrite = |new: &mut Graph, node: Node, operands: &[NodeId]| {
        if node.op == Op::Neg && uses[node.args[0] as usize] == 1 {
            let inner = new.node(operands[0]);
            if let Some(op) = flipped(inner.op) {
                return new.exactly(op, &inner.args.map(NodeId));
            }
        }
        new.exactly(node.op, operands)
    };
    live(&rebuild(graph, |_| true, rewrite))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rotation_is_one_product_and_one_multiply_add_a_component() {
        let mut g = Graph::default();
        let [c, s, x, y] = [0, 1, 2, 3].map(|k| g.input(0, k));
        let (cx, sy, sx, cy) = (g.apply(Op::Mul, &[c, x]), g.apply(Op::Mul, &[s, y]), g.apply(Op::Mul, &[s, x]), g.apply(Op::Mul, &[c, y]));
        g.outputs = vec![g.clone().apply(Op::Add, &[cx, sy])];
        let sum = g.apply(Op::Add, &[cx, sy]);
        let difference = g.apply(Op::Sub, &[cy, sx]);
        let negative = g.apply(Op::Neg, &[difference]);
        g.outputs = vec![sum, negative];
        let fused = fuse(&g);
        assert_eq!((fused.counts().instructions(), fused.counts().fused()), (4, 2));
        let at = |_: usize, k: usize| [0.3, -0.8, 1.7, 2.9][k];
        assert_eq!(fused.evaluate(at), g.evaluate(at));
    }
}
