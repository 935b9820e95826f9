//! A graph of numbers as statements of plain arithmetic.

use std::fmt::Write;

use crate::emit::function::signature::{Place, Signature};
use crate::emit::memory::chunks::one_piece;
use crate::emit::memory::spill::{self, Kind, spilled_before};
use crate::emit::statements::dialect::{Dialect, statements};
use crate::emit::statements::literal::{bare, operand, single};
use crate::emit::statements::order::{Angle, Step, order};
use crate::graph::{Graph, Node, NodeId, Op};
use crate::{Arithmetic, Level, Sines};

/// How many angles `trig::four` takes.
const FOUR: usize = 4;

/// From this many angles on a batch is faster than one after the other.
const BATCH_FROM: usize = 3;

/// Whether the statements use `trig::four`.
pub(crate) fn has_batch(graph: &Graph, level: Level) -> bool {
    order(graph).iter().any(|s| matches!(s, Step::Batch(angles) if !few(angles.len(), level)))
}

/// Whether the standard library does so few angles.
fn few(angles: usize, level: Level) -> bool {
    angles < BATCH_FROM
        && level.fused
        && level.sines == Sines::Ulp
        && matches!(level.arithmetic, Arithmetic::Double | Arithmetic::SingleByDouble)
}

/// The statements, the result last.
pub(crate) fn body(out: &mut String, graph: &Graph, signature: &Signature, dialect: &dyn Dialect) {
    if signature.place == Place::Filled {
        return one_piece(out, graph, signature, dialect);
    }
    let mut values: Vec<String> = graph.outputs.iter().map(|&o| dialect.number(o)).collect();
    let kind = Kind::of(dialect.value().0, graph.lanes().width);
    statements(out, graph, dialect, |lines| if signature.spills { spilled_before(&lines, &mut values, kind) } else { lines });
    signature.result(out, &values);
    *out += if signature.spills { spill::END } else { "" };
}

/// Operators on numbers.
pub(crate) struct Plain<'a> {
    pub(crate) graph: &'a Graph,
    pub(crate) signature: &'a Signature<'a>,
    pub(crate) level: Level,
}

impl Dialect for Plain<'_> {
    fn statement(&self, k: usize, node: &Node) -> Option<String> {
        match node.op {
            Op::Constant => None,
            Op::Input => Some(format!("    let x{k} = {};\n", self.input(node))),
            op => Some(format!("    let x{k} = {};\n", self.expression(op, node))),
        }
    }

    /// Four at a time, the last four padded; one by one if there are few.
    fn sines(&self, group: &[Angle], of: usize) -> String {
        let mut out = String::new();
        if few(of, self.level) {
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
        let _ = writeln!(out, "    let [[{sines}], [{cosines}]] = trig::four::<F>({angles});");
        out
    }

    fn group(&self) -> usize {
        FOUR
    }

    fn number(&self, id: NodeId) -> String {
        match (self.level.arithmetic, self.graph.node(id).constant()) {
            (Arithmetic::SingleByDouble, Some(x)) => single(x),
            (Arithmetic::SingleByDouble, None) => format!("x{} as f32", id.0),
            _ => self.operand(id),
        }
    }

    fn value(&self) -> (&'static str, &'static str) {
        (if self.is_single() { "f32" } else { "f64" }, "0.0")
    }
}

impl Plain<'_> {
    fn is_single(&self) -> bool {
        self.level.arithmetic == Arithmetic::Single
    }

    /// An element of an argument as one of the numbers that are computed with.
    fn input(&self, node: &Node) -> String {
        let input = &self.signature.inputs[node.args[0] as usize];
        let number = input.at(node.args[1] as usize);
        match (self.level.arithmetic, input.is_parameters()) {
            (Arithmetic::SingleByDouble, false) => format!("{number} as f64"),
            (Arithmetic::Single, true) => format!("{number} as f32"),
            _ => number,
        }
    }

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
        if self.is_single() { (text + rest).replace("f64::", "f32::") } else { text + rest }
    }

    /// A name, or the literal of a constant.
    fn operand(&self, id: NodeId) -> String {
        let literal = if self.is_single() { single } else { operand };
        self.graph.node(id).constant().map_or_else(|| format!("x{}", id.0), literal)
    }
}

/// The name of a node's value, if it is wanted.
pub(crate) fn name(k: Option<usize>) -> String {
    k.map_or_else(|| "_".to_owned(), |k| format!("x{k}"))
}
