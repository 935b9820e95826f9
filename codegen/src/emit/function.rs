//! One graph as one straight-line function.

use std::fmt::Write;

use articulated_core::algorithm::{Dim, Shape as Sizes};

use super::literal::literal;
use super::order::{Angle, Step, order};
use crate::graph::{Graph, Node, NodeId, Op};
use crate::ledger::Entry;
use crate::wanted::{Wanted, array};

/// The function's source, with its documentation and, where it gives several results, the type that holds them.
pub(super) fn function(out: &mut String, wanted: &Wanted, graph: &Graph, entry: &Entry, sizes: Sizes, parameters: bool) {
    let group = wanted.group();
    if let Some(name) = &group {
        results(out, wanted, name);
    }
    document(out, wanted, entry, parameters);
    let mut inputs: Vec<Input> = wanted.arguments().iter().map(|a| Input { name: a.name(), dims: a.dims().to_vec() }).collect();
    if parameters {
        inputs.push(Input { name: "parameters", dims: Vec::new() });
    }
    let arguments: Vec<String> = inputs.iter().map(Input::declared).collect();
    let gives = group.clone().unwrap_or_else(|| array(wanted.parts[0].function.gives));
    let _ = writeln!(out, "#[allow(clippy::all, clippy::pedantic)]");
    let _ = writeln!(out, "pub fn {}({}) -> {gives} {{", wanted.name, arguments.join(", "));
    for input in &inputs {
        let _ = writeln!(out, "    let _ = {};", input.name);
    }
    Body { out, graph, inputs, wanted, sizes, group }.write();
    let _ = writeln!(out, "}}\n");
}

/// What is handed in.
struct Input {
    name: &'static str,
    /// None for the parameters.
    dims: Vec<Dim>,
}

impl Input {
    fn declared(&self) -> String {
        let ty = if self.dims.is_empty() { "[f64; PARAMETERS.len()]".into() } else { array(&self.dims) };
        format!("{}: &{ty}", self.name)
    }

    /// Number `k` of it.
    fn at(&self, k: usize) -> String {
        match self.dims.as_slice() {
            [_, Dim::Of(width)] => format!("{}[{}][{}]", self.name, k / width, k % width),
            _ => format!("{}[{k}]", self.name),
        }
    }
}

fn results(out: &mut String, wanted: &Wanted, name: &str) {
    let _ = writeln!(out, "/// What [`{}`] gives.", wanted.name);
    let _ = writeln!(out, "#[derive(::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::cmp::PartialEq)]");
    let _ = writeln!(out, "pub struct {name} {{");
    for part in &wanted.parts {
        let f = part.function;
        let _ = writeln!(out, "    /// {}: `{}`, {}.\n    pub {}: {},", f.summary, array(f.gives), f.unit, f.name, array(f.gives));
    }
    let _ = writeln!(out, "}}\n");
}

fn document(out: &mut String, wanted: &Wanted, entry: &Entry, parameters: bool) {
    for part in &wanted.parts {
        let constants: Vec<String> = part.constants.iter().map(|(a, c)| format!("{} = {}", a.name(), shown(c))).collect();
        let at = if constants.is_empty() { String::new() } else { format!(", at {}", constants.join(", ")) };
        let _ = writeln!(out, "/// {}{at}.\n///", part.function.summary);
    }
    for argument in wanted.arguments() {
        let _ = writeln!(out, "/// {}: `{}` {}.", argument.name(), array(argument.dims()), argument.unit());
    }
    if parameters {
        let _ = writeln!(out, "/// parameters: as [`PARAMETERS`].");
    }
    if let [part] = wanted.parts.as_slice() {
        let _ = writeln!(out, "/// Returns `{}` {}.\n///", array(part.function.gives), part.function.unit);
        let _ = writeln!(out, "/// {}.", part.function.source);
    }
    let by = if entry.ways.is_empty() { String::new() } else { format!("By {}, the cheapest for this robot; ", entry.ways.join(", ")) };
    let c = entry.emitted();
    let _ = writeln!(
        out,
        "/// {by}{} multiplications + {} additions in {} instructions (multiply-adds counted once), {} sines and cosines, depth {}.",
        c.multiplications(),
        c.additions(),
        c.instructions(),
        c.trigonometric(),
        entry.depth
    );
}

fn shown(constant: &crate::Constant) -> String {
    match constant {
        crate::Constant::All(x) => format!("{x}"),
        crate::Constant::Each(numbers) => format!("{numbers:?}"),
    }
}

/// How many angles `trig::four` takes.
const LANES: usize = 4;

/// From this many angles on a batch is faster than one after the other.
pub(super) const BATCH_FROM: usize = 3;

struct Body<'a> {
    out: &'a mut String,
    graph: &'a Graph,
    inputs: Vec<Input>,
    wanted: &'a Wanted,
    sizes: Sizes,
    /// The type of the result, if there are several.
    group: Option<String>,
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
            Op::Input => writeln!(self.out, "    let x{k} = {};", self.inputs[node.args[0] as usize].at(node.args[1] as usize)),
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
            let operand = self.operand(operand);
            text = text.replace(hole, if op == Op::Select { bare(&operand) } else { &operand });
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
        let mut rest = values.as_slice();
        let mut results = Vec::new();
        for part in &self.wanted.parts {
            let (own, others) = rest.split_at(part.function.len(self.sizes));
            let lengths: Vec<usize> = part.function.gives.iter().map(|d| d.len(self.sizes)).collect();
            let value = if is_sparse(own) { self.sparse(part.function.name, own, &lengths) } else { nested(own, &lengths) };
            results.push((part.function.name, value));
            rest = others;
        }
        let _ = match &self.group {
            None => results.iter().try_for_each(|(_, value)| writeln!(self.out, "    {value}")),
            Some(name) => {
                let fields: Vec<String> = results.iter().map(|(field, value)| format!("        {field}: {value},\n")).collect();
                writeln!(self.out, "    {name} {{\n{}    }}", fields.concat())
            }
        };
    }

    /// An array of zeros, and what is not zero put in one by one: for the compiler far less than to write every zero out. Returns its name.
    fn sparse(&mut self, name: &str, values: &[String], lengths: &[usize]) -> String {
        let zeros = lengths.iter().rev().fold(ZERO.to_owned(), |inner, n| format!("[{inner}; {n}]"));
        let mutable = if values.iter().any(|value| value != ZERO) { "mut " } else { "" };
        let _ = writeln!(self.out, "    let {mutable}{name} = {zeros};");
        for (k, value) in values.iter().enumerate().filter(|(_, value)| *value != ZERO) {
            let _ = writeln!(self.out, "    {name}{} = {};", index(k, lengths), bare(value));
        }
        name.to_owned()
    }
}

const ZERO: &str = "0.0";

/// An operand that stands by itself: a negative number without its brackets.
fn bare(operand: &str) -> &str {
    operand.trim_matches(['(', ')'])
}

/// Whether most of many values are nothing.
fn is_sparse(values: &[String]) -> bool {
    values.len() >= 64 && values.iter().filter(|value| *value == ZERO).count() * 2 > values.len()
}

/// The indices of value `k` in an array of these lengths.
fn index(mut k: usize, lengths: &[usize]) -> String {
    lengths.iter().rev().fold(String::new(), |inner, n| {
        let own = format!("[{}]{inner}", k % n);
        k /= n;
        own
    })
}

/// Values as an array of these lengths.
fn nested(values: &[String], lengths: &[usize]) -> String {
    match lengths {
        [] => values.first().cloned().unwrap_or_default(),
        [_] => format!("[{}]", values.join(", ")),
        [n, inner @ ..] => {
            let width: usize = inner.iter().product();
            let rows: Vec<String> = (0..*n).map(|k| nested(&values[k * width..][..width], inner)).collect();
            format!("[{}]", rows.join(",\n     "))
        }
    }
}
