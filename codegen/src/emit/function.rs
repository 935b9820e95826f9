//! One graph as one straight-line function.

use std::fmt::Write;

use articulated_core::algorithm::{Function, ResultKind};

use super::literal::literal;
use crate::Sym;
use crate::graph::{Graph, Node, NodeId, Op};
use crate::ledger::Entry;

/// The function's source, with its documentation.
pub(super) fn function(out: &mut String, function: &Function<Sym>, graph: &Graph, entry: &Entry) {
    document(out, function, entry);
    let arguments: Vec<String> = function.takes.iter().map(|a| format!("{}: &[f64; {}]", a.name(), size(*a))).collect();
    let result = result_type(function.gives);
    let _ = writeln!(out, "#[allow(clippy::all, clippy::pedantic)]");
    let _ = writeln!(out, "pub fn {}({}) -> {result} {{", function.name, arguments.join(", "));
    for argument in function.takes {
        let _ = writeln!(out, "    let _ = {};", argument.name());
    }
    Body { out, graph, function }.write();
    let _ = writeln!(out, "}}\n");
}

fn size(argument: articulated_core::algorithm::Argument) -> &'static str {
    if argument.name() == "q" { "NQ" } else { "NV" }
}

fn result_type(gives: ResultKind) -> &'static str {
    match gives {
        ResultKind::Torque => "[f64; NV]",
        ResultKind::Placements => "[[f64; 12]; FRAMES]",
    }
}

fn document(out: &mut String, function: &Function<Sym>, entry: &Entry) {
    let c = entry.emitted();
    let _ = writeln!(out, "/// {}.\n///", function.summary);
    for argument in function.takes {
        let _ = writeln!(out, "/// {}: {}.", argument.name(), argument.doc());
    }
    let _ = writeln!(out, "/// Returns {}.\n///", function.gives.doc());
    let _ = writeln!(out, "/// {}.", function.source);
    let _ = writeln!(
        out,
        "/// {} multiplications + {} additions in {} instructions (multiply-adds counted once), {} sines and cosines, depth {}.",
        c.multiplications(),
        c.additions(),
        c.instructions(),
        c.trigonometric(),
        entry.depth
    );
}

struct Body<'a> {
    out: &'a mut String,
    graph: &'a Graph,
    function: &'a Function<Sym>,
}

impl Body<'_> {
    fn write(&mut self) {
        for (k, node) in self.graph.nodes().iter().enumerate() {
            self.statement(k, node);
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
        let rows: Vec<String> = match self.function.gives {
            ResultKind::Torque => vec![values.join(", ")],
            ResultKind::Placements => values.chunks(12).map(|row| format!("[{}]", row.join(", "))).collect(),
        };
        let _ = writeln!(self.out, "    [{}]", rows.join(",\n     "));
    }
}
