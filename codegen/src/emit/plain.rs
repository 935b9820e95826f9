//! A graph of numbers as statements of plain arithmetic.

use std::fmt::Write;

use super::chunks::{gives_much, one_piece};
use super::dialect::{Dialect, statements};
use super::literal::{bare, operand};
use super::order::{Angle, Step, order};
use super::signature::Signature;
use crate::graph::{Graph, Node, NodeId, Op};

/// How many angles `trig::four` takes.
const FOUR: usize = 4;

/// From this many angles on a batch is faster than one after the other.
const BATCH_FROM: usize = 3;

/// Whether the statements use `trig::four`.
pub(super) fn has_batch(graph: &Graph) -> bool {
    order(graph).iter().any(|s| matches!(s, Step::Batch(angles) if angles.len() >= BATCH_FROM))
}

/// The statements, the result last.
pub(super) fn body(out: &mut String, graph: &Graph, signature: &Signature) {
    let plain = Plain { graph, signature };
    if gives_much(graph) {
        return one_piece(out, graph, signature, &plain);
    }
    statements(out, graph, &plain);
    let values: Vec<String> = graph.outputs.iter().map(|&o| plain.operand(o)).collect();
    signature.result(out, &values);
}

/// Operators on numbers.
pub(super) struct Plain<'a> {
    pub(super) graph: &'a Graph,
    pub(super) signature: &'a Signature<'a>,
}

impl Dialect for Plain<'_> {
    fn statement(&self, k: usize, node: &Node) -> Option<String> {
        match node.op {
            Op::Constant => None,
            Op::Input => Some(format!("    let x{k} = {};\n", self.signature.inputs[node.args[0] as usize].at(node.args[1] as usize))),
            op => Some(format!("    let x{k} = {};\n", self.expression(op, node))),
        }
    }

    /// Four at a time, the last four padded; one by one if there are few.
    fn sines(&self, group: &[Angle], of: usize) -> String {
        let mut out = String::new();
        if of < BATCH_FROM {
            for a in group {
                let _ = writeln!(out, "    let ({}, {}) = f64::sin_cos({});", name(a.sin), name(a.cos), self.operand(a.angle));
            }
            return out;
        }
        let padded = |mut list: Vec<String>, pad: &str| {
            list.resize(FOUR, pad.into());
            list.join(", ")
        };
        let sines = padded(group.iter().map(|a| name(a.sin)).collect(), "_");
        let cosines = padded(group.iter().map(|a| name(a.cos)).collect(), "_");
        let angles = padded(group.iter().map(|a| self.operand(a.angle)).collect(), "0.0");
        let _ = writeln!(out, "    let [[{sines}], [{cosines}]] = trig::four::<FUSED>({angles});");
        out
    }

    fn group(&self) -> usize {
        FOUR
    }

    fn number(&self, id: NodeId) -> String {
        self.operand(id)
    }

    fn value(&self) -> (&'static str, &'static str) {
        ("f64", "0.0")
    }
}

impl Plain<'_> {
    fn expression(&self, op: Op, node: &Node) -> String {
        let (mut text, mut rest) = (String::new(), op.row().rust);
        for (hole, operand) in ["{a}", "{b}", "{c}"].iter().zip(node.operands()) {
            // The holes of a row stand in this order.
            let Some((before, behind)) = rest.split_once(hole) else { continue };
            let operand = self.operand(operand);
            text += before;
            text += if op == Op::Select { bare(&operand) } else { &operand };
            rest = behind;
        }
        text + rest
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
