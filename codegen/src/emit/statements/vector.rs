//! A graph as statements of the functions of [`articulated_core::lanes`], for whichever instruction set they stand in.

use crate::emit::function::signature::{Place, Signature};
use crate::emit::statements::dialect::Dialect;
use crate::emit::statements::literal::{literal, operand};
use crate::emit::statements::order::Angle;
use crate::emit::statements::plain::{self, name};
use crate::emit::statements::several;
use crate::emit::written;
use crate::emit::written::rows::WIDTH;
use crate::graph::{Graph, Node, NodeId, Op};

/// The statements, the result last.
pub(crate) fn body(out: &mut String, graph: &Graph, signature: &Signature) {
    if signature.place == Place::Written && graph.lanes().width == WIDTH {
        return written::body(out, graph, signature);
    }
    let vector = Vector { graph, signature };
    *out += vector.beginning();
    plain::body(out, graph, signature, &vector);
}

/// Functions on vectors.
pub(crate) struct Vector<'a> {
    pub(crate) graph: &'a Graph,
    pub(crate) signature: &'a Signature<'a>,
}

/// Has the compiler lay the function's frame at the start of a cache line. Vectors that it keeps there lie across two lines otherwise, wherever the stack happens to begin so:
/// a function takes up to a seventh longer.
const ALIGNED: &str = "    {
        // Vectors in this frame lie in one cache line each.
        #[repr(align(64))]
        #[allow(dead_code)]
        struct Line(u8);
        let _ = ::core::hint::black_box(&::core::mem::MaybeUninit::<Line>::uninit());
    }
";

impl Dialect for Vector<'_> {
    fn statement(&self, k: usize, node: &Node) -> Option<String> {
        let value = match node.op {
            Op::Constant | Op::LaneConstant => return None,
            Op::Input => format!("k({})", self.signature.inputs[node.args[0] as usize].at(node.args[1] as usize)),
            Op::LaneInput => {
                let input = &self.signature.inputs[node.args[0] as usize];
                let numbers = self.graph.lanes().input(node.args[1]).iter().map(|&i| input.at(i as usize));
                format!("lanes([{}])", numbers.collect::<Vec<_>>().join(", "))
            }
            Op::Spread => format!("k({})", self.lane(node)),
            op => {
                let operands: Vec<String> = node.operands().map(|o| self.operand(o)).collect();
                format!("{}({})", op.row().lanes, operands.join(", "))
            }
        };
        Some(format!("    let x{k} = {value};\n"))
    }

    fn sines(&self, group: &[Angle], _: usize) -> String {
        if let [one] = group {
            return format!("    let ({}, {}) = sin_cos({});\n", name(one.sin), name(one.cos), self.operand(one.angle));
        }
        // There are functions of two and of four.
        let (now, rest) = group.split_at(if group.len() < 4 { 2 } else { 4 });
        let list = |of: &dyn Fn(&Angle) -> String| now.iter().map(of).collect::<Vec<_>>().join(", ");
        let (sines, cosines) = (list(&|a| name(a.sin)), list(&|a| name(a.cos)));
        let function = several::name(now.len());
        let out = format!("    let [[{sines}], [{cosines}]] = {function}({});\n", list(&|a| self.operand(a.angle)));
        if rest.is_empty() { out } else { out + &self.sines(rest, rest.len()) }
    }

    fn group(&self) -> usize {
        several::together(self.graph.lanes().width)
    }

    fn number(&self, id: NodeId) -> String {
        let node = self.graph.node(id);
        match (node.op, node.constant()) {
            (_, Some(x)) => operand(x),
            (Op::Spread, _) => self.lane(&node),
            _ => format!("lane::<0>({})", self.operand(id)),
        }
    }

    fn stores_two(&self) -> bool {
        self.graph.lanes().width == 2
    }

    fn beginning(&self) -> &'static str {
        ALIGNED
    }

    fn value(&self) -> (&'static str, &'static str) {
        ("V", "k(0.0)")
    }
}

impl Vector<'_> {
    /// A lane of a node.
    fn lane(&self, spread: &Node) -> String {
        let lane = self.graph.node(NodeId(spread.args[1])).constant().unwrap_or_default();
        format!("lane::<{lane}>({})", self.operand(NodeId(spread.args[0])))
    }

    /// A name, or a constant.
    pub(crate) fn operand(&self, id: NodeId) -> String {
        let node = self.graph.node(id);
        match (node.op, node.constant()) {
            (_, Some(x)) => format!("k({})", literal(x)),
            (Op::LaneConstant, _) => {
                let numbers = &self.graph.lanes().constant(node.args[0])[..self.graph.lanes().width];
                format!("lanes([{}])", numbers.iter().map(|x| literal(*x)).collect::<Vec<_>>().join(", "))
            }
            _ => format!("x{}", id.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use articulated_core::algorithm::Shape;

    use super::*;
    use crate::wanted::Wanted;

    #[test]
    fn each_lane_has_its_number() {
        let wanted = Wanted::parse("fast = inverse_dynamics(q = sin_cos)").unwrap();
        let signature = Signature::of(&wanted, Shape { nq: 9, nv: 9, frames: 0, links: 0 }, false);
        for (width, indices, numbers, of_two) in [
            (2, &[7, 4][..], "v[7], v[4]", "sines[3][1], sines[2][0]"),
            (4, &[7, 4, 0, 8], "v[7], v[4], v[0], v[8]", "sines[3][1], sines[2][0], sines[0][0], sines[4][0]"),
        ] {
            let mut graph = Graph::in_lanes(width);
            let [v, sines] = [1, 3].map(|argument| graph.lane_input(argument, indices));
            let constant = graph.lane_constant(std::array::from_fn(|k| k as f64 - 0.5));
            let lane = graph.constant(1.0);
            let [of_v, of_constant] = [v, constant].map(|id| graph.exactly(Op::Spread, &[id, lane]));
            let product = graph.exactly(Op::MulSub, &[of_v, v, constant]);
            let vector = Vector { graph: &graph, signature: &signature };
            let statement = |id: NodeId| vector.statement(id.index(), &graph.node(id));
            assert_eq!(statement(v), Some(format!("    let x{} = lanes([{numbers}]);\n", v.0)));
            assert_eq!(statement(sines), Some(format!("    let x{} = lanes([{of_two}]);\n", sines.0)));
            assert_eq!((statement(constant), statement(lane)), (None, None));
            let constants = ["-0.5", "0.5", "1.5", "2.5"][..width].join(", ");
            assert_eq!(statement(of_v), Some(format!("    let x{} = k(lane::<1>(x{}));\n", of_v.0, v.0)));
            assert_eq!(vector.number(of_constant), format!("lane::<1>(lanes([{constants}]))"));
            let operands: Vec<String> = graph.node(product).operands().map(|id| vector.operand(id)).collect();
            assert_eq!(statement(product), Some(format!("    let x{} = fmsub({});\n", product.0, operands.join(", "))));
            assert_eq!(operands[2], format!("lanes([{constants}])"));
            assert_eq!([v, lane].map(|id| vector.number(id)), [format!("lane::<0>(x{})", v.0), "1.0".into()]);
        }
    }
}
