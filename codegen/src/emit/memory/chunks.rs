//! A long function as several short ones, one after the other: compilers take time that grows faster than a function's length, and spill more.
//!
//! What one piece makes and a later one needs goes through `m`, in which a place is used again once its value is not needed any more. Its places are fields: a compiler checks
//! a field far sooner than an index. Inputs are read where they are needed, results are written where they are made.

use std::fmt::Write;

use crate::emit::function::signature::{Place, Signature};
use crate::emit::memory::apart;
use crate::emit::memory::spill::{Kind, spilled};
use crate::emit::memory::together::two_at_once;
use crate::emit::statements::dialect::{Dialect, Unit, units};
use crate::emit::statements::flat::flat;
use crate::graph::{Graph, NodeId, Op};

/// Statements of a piece.
const LENGTH: usize = 200;

/// From this many nodes on a function is cut: below, one piece is faster to run and as fast to compile.
const CUT_FROM: usize = 4500;

/// The same of plain numbers beside a loop over columns: from here on pieces are as fast as one, and those of a seven-axis arm faster.
const CUT_BESIDE_COLUMNS_FROM: usize = 2000;

/// Whether a function is long.
pub(crate) fn is_long(graph: &Graph, columns: bool) -> bool {
    graph.nodes().len() >= if columns && graph.lanes().width == 1 { CUT_BESIDE_COLUMNS_FROM } else { CUT_FROM }
}

/// The statements of each piece of `length`, each result put where `places` says and `zeros` among them, and how many places of `m` they use.
pub(crate) fn cut(graph: &Graph, dialect: &dyn Dialect, places: &[String], zeros: &[String], length: usize) -> (Vec<String>, usize) {
    let units: Vec<Unit> = units(graph, dialect.group()).into_iter().filter(|u| !is_light(graph, u)).collect();
    let pieces = if units.is_empty() { vec![units.as_slice()] } else { units.chunks(length).collect() };
    let plan = Plan::of(graph, pieces);
    let zeros = Spread { statements: zeros, units: units.len(), passed: 0 };
    let mut piece = Piece { plan: &plan, graph, dialect, zeros, c: 0, named: vec![NOWHERE; graph.nodes().len()] };
    let write = |c: usize| {
        let mut out = String::new();
        piece.c = c;
        piece.write(&mut out, places);
        out
    };
    ((0..plan.pieces.len()).map(write).collect(), plan.slots)
}

/// The pieces as functions `piece_0`, …, each for the features that the macro around it is given, and `whole`, which calls them. Arrays of arrays are one array to them: to check
/// further indices takes a compiler long.
pub(crate) fn pieces(out: &mut String, graph: &Graph, signature: &Signature, dialect: &dyn Dialect) {
    let flattened = signature.flattened();
    let apart = flattened.is_some() && apart::keeps_apart(graph, dialect);
    let result = |k| if apart { apart::place(k) } else { format!("out[{k}]") };
    let places = flattened.as_ref().map_or_else(|| signature.places(), |flat| (0..flat.numbers).map(result).collect());
    let gives = flattened.as_ref().map_or_else(|| signature.gives(), |flat| flat.ty.clone());
    let (pieces, slots) = cut(graph, dialect, &places, &zeros(graph, signature, dialect, &places), LENGTH);
    kept(out, "Kept", dialect, slots);
    for (c, piece) in pieces.iter().enumerate() {
        let _ = writeln!(out, "    $(#[$features])?\n    #[inline(never)]");
        let _ = writeln!(out, "    fn piece_{c}({}) {{", signature.arguments_and(&format!("m: &mut Kept, out: &mut {gives}")));
        for input in &signature.inputs {
            let _ = writeln!(out, "    let _ = {};", input.name);
        }
        let statements = flattened.as_ref().filter(|_| apart).map_or_else(|| piece.clone(), |flat| apart::written(piece, flat.numbers, 0));
        let _ = writeln!(out, "    let _ = (&m, &out);\n{}{statements}    }}", dialect.beginning());
    }
    let _ = writeln!(out, "    $(#[$features])?\n    fn whole({}){} {{", signature.takes(), signature.returns());
    *out += &nothing_kept("Kept", dialect, slots);
    calls(out, signature, pieces.len());
    *out += "    }\n";
}

/// What calls so many pieces, and the result if it is a value.
fn calls(out: &mut String, signature: &Signature, pieces: usize) {
    let filled = signature.place == Place::Filled;
    if !filled {
        let _ = writeln!(out, "    let mut out = {};", signature.nothing());
    }
    let place = if let Some(flat) = signature.flattened() {
        let all = format!("out{}.first_chunk_mut()", ".as_flattened_mut()".repeat(flat.nests));
        let _ = writeln!(out, "    let ::core::option::Option::Some(flat) = {all} else {{ ::core::unreachable!() }};");
        "flat"
    } else if filled {
        "out"
    } else {
        "&mut out"
    };
    for c in 0..pieces {
        let _ = writeln!(out, "    piece_{c}({});", signature.names_and(&format!("&mut m, {place}")));
    }
    *out += if filled { "" } else { "    out\n" };
}

/// So many places are fields of one struct: a compiler looks at them one by one.
const FIELDS: usize = 1024;

/// A place of `m`.
fn place(slot: usize) -> String {
    format!("m.k{}.m{}", slot / FIELDS, slot % FIELDS)
}

/// The places of each struct in `m`: which one, and how many.
fn structs(slots: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..slots.div_ceil(FIELDS)).map(move |k| (k, FIELDS.min(slots - k * FIELDS)))
}

/// The type of `m`, with so many places.
pub(crate) fn kept(out: &mut String, name: &str, dialect: &dyn Dialect, slots: usize) {
    let ty = dialect.value().0;
    let mut declare = |name: &str, fields: Vec<String>| {
        let _ = writeln!(out, "    #[allow(dead_code, non_camel_case_types)]\n    struct {name} {{ {} }}", fields.join(", "));
    };
    declare(name, structs(slots).map(|(k, _)| format!("k{k}: {name}_{k}")).collect());
    structs(slots).for_each(|(k, fields)| declare(&format!("{name}_{k}"), (0..fields).map(|m| format!("m{m}: {ty}")).collect()));
}

/// The statements that make such an `m`.
pub(crate) fn nothing_kept(name: &str, dialect: &dyn Dialect, slots: usize) -> String {
    let of = |(k, fields)| {
        let zeros: Vec<String> = (0..fields).map(|m| format!("m{m}: zero")).collect();
        format!("k{k}: {name}_{k} {{ {} }}", zeros.join(", "))
    };
    let all: Vec<String> = structs(slots).map(of).collect();
    format!("    let zero = {};\n    let mut m = {name} {{ {} }};\n", dialect.value().1, all.join(", "))
}

/// From this many results and nodes on each result is written as soon as it is made: kept until the end, they would fill the registers. Of a small
/// function the compiler makes more where they come together.
const WRITE_FROM: (usize, usize) = (32, 700);

/// Whether there are so many results that they are written as soon as they are made.
pub(crate) fn gives_much(graph: &Graph) -> bool {
    graph.outputs.len() >= WRITE_FROM.0 && graph.nodes().len() >= WRITE_FROM.1
}

/// The statements of a function in one piece that gives much.
pub(crate) fn one_piece(out: &mut String, graph: &Graph, signature: &Signature, dialect: &dyn Dialect) {
    let apart = signature.flattened().filter(|_| apart::keeps_apart(graph, dialect));
    let places = apart.as_ref().map_or_else(|| signature.places(), |flat| (0..flat.numbers).map(apart::place).collect());
    let (pieces, _) = cut(graph, dialect, &places, &zeros(graph, signature, dialect, &places), usize::MAX);
    let mut statements = pieces.concat();
    if apart.is_none() && dialect.stores_two() {
        statements = two_at_once(&statements);
    }
    if signature.spills {
        statements = spilled(&statements, Kind::of(dialect.value().0, graph.lanes().width));
    }
    if let Some(flat) = &apart {
        statements = apart::written(&statements, flat.numbers, flat.nests);
    }
    *out += &flat(&statements, dialect.value().0);
}

/// The statements that write zeros, where the result may hold anything and they are read.
fn zeros(graph: &Graph, signature: &Signature, dialect: &dyn Dialect, places: &[String]) -> Vec<String> {
    let read = |k| signature.columns.is_none_or(|columns| columns.reads(k));
    match signature.place {
        Place::Filled => crate::emit::written::zeros::statements(graph, dialect, places, read),
        _ => Vec::new(),
    }
}

/// Whether a unit is made again wherever it is needed: inputs, and comparisons, whose values are no numbers.
fn is_light(graph: &Graph, unit: &Unit) -> bool {
    matches!(unit, Unit::Node(k) if light(graph, *k))
}

fn light(graph: &Graph, k: usize) -> bool {
    let op = graph.nodes()[k].op;
    op.row().arity == 0 || op == Op::Positive
}

/// What goes where.
struct Plan<'a> {
    pieces: Vec<&'a [Unit]>,
    /// The piece that makes each node.
    made: Vec<usize>,
    /// The place of each node that a later piece needs.
    slot: Vec<Option<usize>>,
    slots: usize,
    /// The results that each node gives.
    results: Vec<Vec<usize>>,
}

const NOWHERE: usize = usize::MAX;

impl<'a> Plan<'a> {
    fn of(graph: &Graph, pieces: Vec<&'a [Unit]>) -> Self {
        let n = graph.nodes().len();
        let (mut made, mut last) = (vec![NOWHERE; n], vec![0; n]);
        for (c, piece) in pieces.iter().enumerate() {
            for unit in *piece {
                unit.makes().into_iter().for_each(|k| made[k] = c);
                heavy_needs(graph, unit.needs(graph)).into_iter().for_each(|k| last[k] = c);
            }
        }
        let mut plan = Self { pieces, made, slot: vec![None; n], slots: 1, results: vec![Vec::new(); n] };
        for (k, id) in graph.outputs.iter().enumerate() {
            let source = plan.source(graph, *id);
            plan.results[source].push(k);
        }
        plan.place(&last);
        plan
    }

    /// The node whose value a result is, or has a lane of.
    fn source(&self, graph: &Graph, id: NodeId) -> usize {
        let node = graph.node(id);
        if node.op == Op::Spread && self.made[id.index()] == NOWHERE { node.args[0] as usize } else { id.index() }
    }

    /// A place for each value that outlives its piece; places become free when the last piece that needs them is done.
    fn place(&mut self, last: &[usize]) {
        let mut places = Places::default();
        let mut ends: Vec<Vec<usize>> = vec![Vec::new(); self.pieces.len()];
        for c in 0..self.pieces.len() {
            for k in self.pieces[c].iter().flat_map(Unit::makes).filter(|&k| last[k] > c) {
                let slot = places.take(c);
                self.slot[k] = Some(slot);
                ends[last[k]].push(slot);
            }
            places.free.append(&mut ends[c]);
        }
        self.slots = places.written.len().max(1);
    }
}

/// Places of `m`, as they are given away.
#[derive(Default)]
struct Places {
    free: Vec<usize>,
    /// The piece that wrote each last.
    written: Vec<usize>,
}

impl Places {
    /// A place for piece `c` to write to, and not beside another: of neighbours a compiler would look for vectors to make them from.
    fn take(&mut self, c: usize) -> usize {
        let beside = |slot: usize| [slot.wrapping_sub(1), slot + 1].into_iter().any(|k| self.written.get(k) == Some(&c));
        let found = self.free.iter().rposition(|&slot| !beside(slot));
        let slot = match found {
            Some(at) => self.free.remove(at),
            None => self.new_place(c),
        };
        self.written[slot] = c;
        slot
    }

    fn new_place(&mut self, c: usize) -> usize {
        if self.written.last() == Some(&c) {
            self.free.push(self.written.len());
            self.written.push(NOWHERE);
        }
        self.written.push(NOWHERE);
        self.written.len() - 1
    }
}

/// What must be kept for these nodes: for light ones, what they are made of.
fn heavy_needs(graph: &Graph, nodes: Vec<usize>) -> Vec<usize> {
    let mut needs = Vec::new();
    let mut open = nodes;
    while let Some(k) = open.pop() {
        if light(graph, k) { open.extend(graph.nodes()[k].operands().map(NodeId::index)) } else { needs.push(k) }
    }
    needs
}

/// Statements between units, as far apart as there are units for.
struct Spread<'a> {
    statements: &'a [String],
    units: usize,
    /// Units that are written.
    passed: usize,
}

impl Spread<'_> {
    /// What stands behind the next unit.
    fn next(&mut self) -> &[String] {
        let until = |passed: usize| passed * self.statements.len() / self.units.max(1);
        let behind = &self.statements[until(self.passed)..until(self.passed + 1)];
        self.passed += 1;
        behind
    }
}

/// The writer of one piece.
struct Piece<'a> {
    plan: &'a Plan<'a>,
    graph: &'a Graph,
    dialect: &'a dyn Dialect,
    zeros: Spread<'a>,
    c: usize,
    /// The piece in which each node was given a name last.
    named: Vec<usize>,
}

impl Piece<'_> {
    fn write(&mut self, out: &mut String, places: &[String]) {
        // What is made nowhere, inputs and constants, is given by the first piece.
        if self.c == 0 {
            if self.zeros.units == 0 {
                *out += &self.zeros.statements.concat();
            }
            (0..self.plan.made.len()).filter(|&k| self.plan.made[k] == NOWHERE).for_each(|k| self.give(out, k, places));
        }
        for unit in self.plan.pieces[self.c] {
            unit.needs(self.graph).into_iter().for_each(|k| self.name(out, k));
            *out += &unit.written(self.graph, self.dialect).unwrap_or_default();
            for k in unit.makes() {
                self.named[k] = self.c;
                if let Some(slot) = self.plan.slot[k] {
                    let _ = writeln!(out, "    {} = x{k};", place(slot));
                }
                self.give(out, k, places);
            }
            *out += &self.zeros.next().concat();
        }
    }

    /// Writes the results that a node gives.
    fn give(&mut self, out: &mut String, node: usize, places: &[String]) {
        for &k in &self.plan.results[node] {
            if let Some(statement) = self.dialect.give(&places[k], self.graph.outputs[k]) {
                self.name(out, node);
                *out += &statement;
            }
        }
    }

    /// Gives a name to a value that was made before, or can be made again.
    fn name(&mut self, out: &mut String, k: usize) {
        if self.named[k] == self.c {
            return;
        }
        self.named[k] = self.c;
        if light(self.graph, k) {
            self.graph.nodes()[k].operands().for_each(|o| self.name(out, o.index()));
            *out += &Unit::Node(k).written(self.graph, self.dialect).unwrap_or_default();
        } else if let Some(slot) = self.plan.slot[k] {
            let _ = writeln!(out, "    let x{k} = {};", place(slot));
        }
    }
}

#[cfg(test)]
mod tests;
