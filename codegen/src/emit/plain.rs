//! A graph of numbers as statements of plain arithmetic.

use std::fmt::Write;

use super::literal::{bare, operand};
use super::order::{Angle, Step, order};
use super::signature::Signature;
use crate::graph::{Graph, Node, NodeId, Op};

/// How many angles `trig::four` takes.
const LANES: usize = 4;

/// From this many angles on a batch is faster than one after the other.
const BATCH_FROM: usize = 3;

/// Whether the statements use `trig::four`.
pub(super) fn has_batch(graph: &Graph) -> bool {
    order(graph).iter().any(|s| matches!(s, Step::Batch(angles) if angles.len() >= BATCH_FROM))
}

/// The statements, the result last.
pub(super) fn body(out: &mut String, graph: &Graph, signature: &Signature) {
    let mut body = Body { out, graph, signature };
    for step in order(graph) {
        match step {
            Step::Node(k) => body.statement(k, &graph.nodes()[k]),
            Step::Batch(angles) if angles.len() < BATCH_FROM => angles.iter().for_each(|a| body.single(a)),
            Step::Batch(angles) => body.batch(&angles),
        }
    }
    let values: Vec<String> = graph.outputs.iter().map(|&o| body.operand(o)).collect();
    signature.result(out, &values);
}

struct Body<'a> {
    out: &'a mut String,
    graph: &'a Graph,
    signature: &'a Signature<'a>,
}

impl Body<'_> {
    fn statement(&mut self, k: usize, node: &Node) {
        let _ = match node.op {
            Op::Constant => Ok(()),
            Op::Input => writeln!(self.out, "    let x{k} = {};", self.signature.inputs[node.args[0] as usize].at(node.args[1] as usize)),
            op => {
                let expression = self.expression(op, node);
                writeln!(self.out, "    let x{k} = {expression};")
            }
        };
    }

    fn single(&mut self, a: &Angle) {
        let _ = writeln!(self.out, "    let ({}, {}) = f64::sin_cos({});", name(a.sin), name(a.cos), self.operand(a.angle));
    }

    /// Four at a time, the last four padded.
    fn batch(&mut self, angles: &[Angle]) {
        let padded = |mut list: Vec<String>, pad: &str| {
            list.resize(LANES, pad.into());
            list.join(", ")
        };
        for four in angles.chunks(LANES) {
            let sines = padded(four.iter().map(|a| name(a.sin)).collect(), "_");
            let cosines = padded(four.iter().map(|a| name(a.cos)).collect(), "_");
            let angles = padded(four.iter().map(|a| self.operand(a.angle)).collect(), "0.0");
            let _ = writeln!(self.out, "    let [[{sines}], [{cosines}]] = trig::four::<FUSED>({angles});");
        }
    }

    fn expression(&self, op: Op, node: &Node) -> String {
        let mut text = op.row().rust.to_owned();
        for (hole, operand) in ["{a}", "{b}", "{c}"].iter().zip(node.operands()) {
            let operand = self.operand(operand);
            text = text.replace(hole, if op == Op::Select { bare(&operand) } else { &operand });
        }
        text
    }

    /// A name, or the literal of a constant.
    fn operand(&self, id: NodeId) -> String {
        self.graph.node(id).constant().map_or_else(|| format!("x{}", id.0), operand)
    }
}

/// The name of a node's value, if it is wanted.
pub(super) fn name(k: Option<usize>) -> String {
    k.map_or_else(|| "_".to_owned(), |k| format!("x{k}"))
}
