//! One graph as one straight-line function.

use std::fmt::Write;

use articulated_core::algorithm::{Function, Shape as Sizes};

use super::literal::literal;
use super::order::{Angle, Step, order};
use super::shape::{Shape, length, shape};
use crate::Sym;
use crate::graph::{Graph, Node, NodeId, Op};
use crate::ledger::Entry;

/// The function's source, with its documentation.
pub(super) fn function(out: &mut String, function: &Function<Sym>, graph: &Graph, entry: &Entry, sizes: Sizes) {
    document(out, function, entry);
    let arguments: Vec<String> = function.takes.iter().map(|a| format!("{}: &[f64; {}]", a.name(), length(*a))).collect();
    let Shape { array, row, .. } = shape(function.gives, sizes);
    let _ = writeln!(out, "#[allow(clippy::all, clippy::pedantic)]");
    let _ = writeln!(out, "pub fn {}({}) -> {array} {{", function.name, arguments.join(", "));
    for argument in function.takes {
        let _ = writeln!(out, "    let _ = {};", argument.name());
    }
    Body { out, graph, function, row }.write();
    let _ = writeln!(out, "}}\n");
}

fn document(out: &mut String, function: &Function<Sym>, entry: &Entry) {
    let c = entry.emitted();
    let _ = writeln!(out, "/// {}.\n///", function.summary);
    for argument in function.takes {
        let _ = writeln!(out, "/// {}: {}.", argument.name(), argument.doc());
    }
    let _ = writeln!(out, "/// Returns {}.\n///", function.gives.doc());
    let _ = writeln!(out, "/// {}.", function.source);
    let arctangents = if c.arctangents() == 0 { String::new() } else { format!(", {} arctangents", c.arctangents()) };
    let _ = writeln!(
        out,
        "/// {} multiplications + {} additions in {} instructions (multiply-adds counted once), {} sines and cosines{arctangents}, depth {}.",
        c.multiplications(),
        c.additions(),
        c.instructions(),
        c.trigonometric(),
        entry.depth
    );
}

/// How many angles `trig::four` takes.
const LANES: usize = 4;

/// From this many angles on a batch is faster than one after the other.
pub(super) const BATCH_FROM: usize = 3;

struct Body<'a> {
    out: &'a mut String,
    graph: &'a Graph,
    function: &'a Function<Sym>,
    row: Option<usize>,
}

impl Body<'_> {
    fn write(&mut self) {
        for step in order(self.graph) {
            match step {
                Step::Node(k) => self.statement(k, &self.graph.nodes()[k]),
                Step::Batch(angles) if angles.len() < BATCH_FROM => angles.iter().for_each(|a| self.single(a)),
                Step::Batch(angles) => self.batch(&angles),
            }
        }
        self.result();
    }

    fn statement(&mut self, k: usize, node: &Node) {
        let _ = match node.op {
            Op::Constant => Ok(()),
            Op::Input => writeln!(self.out, "    let x{k} = {}[{}];", self.function.takes[node.args[0] as usize].name(), node.args[1]),
            op => {
                let expression = self.expression(op, node);
                writeln!(self.out, "    let x{k} = {expression};")
            }
        };
    }

    fn single(&mut self, a: &Angle) {
        let name = |k: Option<usize>| k.map_or_else(|| "_".to_owned(), |k| format!("x{k}"));
        let _ = writeln!(self.out, "    let ({}, {}) = f64::sin_cos({});", name(a.sin), name(a.cos), self.operand(a.angle));
    }

    /// Four at a time, the last four padded.
    fn batch(&mut self, angles: &[Angle]) {
        let name = |k: Option<usize>| k.map_or_else(|| "_".to_owned(), |k| format!("x{k}"));
        let padded = |mut list: Vec<String>, pad: &str| {
            list.resize(LANES, pad.into());
            list.join(", ")
        };
        for four in angles.chunks(LANES) {
            let sines = padded(four.iter().map(|a| name(a.sin)).collect(), "_");
            let cosines = padded(four.iter().map(|a| name(a.cos)).collect(), "_");
            let angles = padded(four.iter().map(|a| self.operand(a.angle)).collect(), "0.0");
            let _ = writeln!(self.out, "    let [[{sines}], [{cosines}]] = trig::four({angles});");
        }
    }

    fn expression(&self, op: Op, node: &Node) -> String {
        let mut text = op.row().rust.to_owned();
        for (hole, operand) in ["{a}", "{b}", "{c}"].iter().zip(node.operands()) {
            text = text.replace(hole, &self.operand(operand));
        }
        text
    }

    /// A name, or the literal of a constant.
    fn operand(&self, id: NodeId) -> String {
        match self.graph.node(id).constant() {
            Some(c) if c < 0.0 => format!("({})", literal(c)),
            Some(c) => literal(c),
            None => format!("x{}", id.0),
        }
    }

    fn result(&mut self) {
        let values: Vec<String> = self.graph.outputs.iter().map(|&o| self.operand(o)).collect();
        let rows: Vec<String> = match self.row {
            None => vec![values.join(", ")],
            Some(width) => values.chunks(width.max(1)).map(|row| format!("[{}]", row.join(", "))).collect(),
        };
        let _ = writeln!(self.out, "    [{}]", rows.join(",\n     "));
    }
}
