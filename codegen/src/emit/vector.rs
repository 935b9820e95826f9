//! A graph as statements of the functions of [`articulated_core::lanes`], for whichever instruction set they stand in.

use std::fmt::Write;

use super::literal::{literal, operand};
use super::order::{Angle, Step, order};
use super::plain::name;
use super::signature::Signature;
use crate::graph::{Graph, Node, NodeId, Op};

/// The statements, the result last.
pub(super) fn body(out: &mut String, graph: &Graph, signature: &Signature) {
    let mut body = Body { out, graph, signature, block: false };
    body.statements(&inner(graph));
    let values: Vec<String> = graph.outputs.iter().map(|&o| body.number(o)).collect();
    signature.result(out, &values);
}

/// The statements for a part of a block of states, each result put where `places` says.
pub(super) fn block(out: &mut String, graph: &Graph, signature: &Signature, places: &[String]) {
    let mut body = Body { out, graph, signature, block: true };
    body.statements(&inner(graph));
    for (output, place) in graph.outputs.iter().zip(places) {
        let value = body.operand(*output);
        let _ = writeln!(body.out, "    put(&mut {place}, part, {value});");
    }
}

/// What other nodes use, and so needs a name.
fn inner(graph: &Graph) -> Vec<bool> {
    let mut inner = vec![false; graph.nodes().len()];
    graph.nodes().iter().flat_map(Node::operands).for_each(|o| inner[o.index()] = true);
    for o in &graph.outputs {
        inner[o.index()] |= graph.node(*o).op != Op::Spread;
    }
    inner
}

struct Body<'a> {
    out: &'a mut String,
    graph: &'a Graph,
    signature: &'a Signature<'a>,
    /// Whether each number of the inputs is a block of states.
    block: bool,
}

impl Body<'_> {
    fn statements(&mut self, inner: &[bool]) {
        for step in order(self.graph) {
            match step {
                Step::Node(k) if inner[k] => self.statement(k, &self.graph.nodes()[k]),
                Step::Node(_) => {}
                Step::Batch(angles) if self.graph.lanes().width == 2 => angles.chunks(2).for_each(|two| self.sines_of_two(two)),
                Step::Batch(angles) => angles.iter().for_each(|a| self.sines(a)),
            }
        }
    }

    fn statement(&mut self, k: usize, node: &Node) {
        let value = match node.op {
            Op::Constant | Op::LaneConstant => return,
            Op::Input if self.block && !self.signature.inputs[node.args[0] as usize].is_parameters() => {
                format!("at(&{}, part)", self.signature.inputs[node.args[0] as usize].flat(node.args[1] as usize))
            }
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
        let _ = writeln!(self.out, "    let x{k} = {value};");
    }

    fn sines(&mut self, a: &Angle) {
        let _ = writeln!(self.out, "    let ({}, {}) = sin_cos({});", name(a.sin), name(a.cos), self.operand(a.angle));
    }

    /// Two vectors of two fill one of four.
    fn sines_of_two(&mut self, two: &[Angle]) {
        let [a, b] = two else { return two.iter().for_each(|a| self.sines(a)) };
        let (x, y) = (self.operand(a.angle), self.operand(b.angle));
        let (sines, cosines) = ([name(a.sin), name(b.sin)].join(", "), [name(a.cos), name(b.cos)].join(", "));
        let _ = writeln!(self.out, "    let [[{sines}], [{cosines}]] = sin_cos_of_two({x}, {y});");
    }

    /// A lane of a node.
    fn lane(&self, spread: &Node) -> String {
        let lane = self.graph.node(NodeId(spread.args[1])).constant().unwrap_or_default();
        format!("lane::<{lane}>({})", self.operand(NodeId(spread.args[0])))
    }

    /// A result.
    fn number(&self, id: NodeId) -> String {
        let node = self.graph.node(id);
        match (node.op, node.constant()) {
            (_, Some(x)) => operand(x),
            (Op::Spread, _) => self.lane(&node),
            _ => format!("lane::<0>({})", self.operand(id)),
        }
    }

    /// A name, or a constant.
    fn operand(&self, id: NodeId) -> String {
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
