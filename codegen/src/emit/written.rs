//! Functions in four lanes that write their results as they are made, into room that may hold nothing yet: constants first, half of them before the sines and half between and behind
//! them, so that the stores fill the time in which nothing else can be done; then what belongs together as soon as the last of it is known.

use std::collections::{BTreeMap, HashMap};
use std::fmt::Write;

use super::dialect::{Dialect, Unit, units};
use super::flat::flat;
use super::literal::literal;
use super::rows::{Cell, Column, Group, groups};
use super::signature::Signature;
use super::vector::Vector;
use crate::graph::{Graph, Op};

/// The statements.
pub(super) fn body(out: &mut String, graph: &Graph, signature: &Signature) {
    let vector = Vector { graph, signature };
    let cells: Vec<Cell> = graph.outputs.iter().map(|&o| Cell::of(graph, o)).collect();
    let mut all = Vec::new();
    let mut from = 0;
    for (name, place, length) in signature.rooms() {
        let _ = writeln!(out, "    // SAFETY: room for as many numbers, which need not be there yet.");
        let _ = writeln!(out, "    let {name} = unsafe {{ &mut *{place}.cast::<[::core::mem::MaybeUninit<f64>; {length}]>() }};");
        all.extend(groups(&cells[from..from + length]).into_iter().map(|group| (name.clone(), group)));
        from += length;
    }
    *out += vector.beginning();
    *out += &flat(&Writer::of(&vector, &all).statements(), vector.value().0);
}

/// The statements, and what is written between them.
struct Writer<'a> {
    vector: &'a Vector<'a>,
    units: Vec<Unit>,
    /// What is written after each unit, and before the first.
    after: Vec<String>,
    first: String,
}

impl<'a> Writer<'a> {
    fn of(vector: &'a Vector<'a>, groups: &[(String, Group)]) -> Self {
        let units = units(vector.graph, vector.group());
        let made: HashMap<usize, usize> =
            units.iter().enumerate().flat_map(|(u, unit)| unit.makes().into_iter().map(move |k| (k, u))).collect();
        let sines: Vec<usize> = (0..units.len()).filter(|&u| matches!(units[u], Unit::Sines(..))).collect();
        let (constant, others): (Vec<_>, Vec<_>) = groups.iter().partition(|(_, group)| group.nodes().is_empty());
        let mut writer = Self { vector, after: vec![String::new(); units.len()], units, first: String::new() };
        let before = constant.len() / 2;
        for (n, (name, group)) in constant.iter().enumerate() {
            let behind = n.checked_sub(before).and_then(|n| sines.get(n * sines.len() / (constant.len() - before)));
            writer.write(behind.copied(), name, group);
        }
        for (name, group) in others {
            writer.write(group.nodes().iter().filter_map(|k| made.get(k)).max().copied(), name, group);
        }
        writer
    }

    /// Writes a group after a unit, or before all.
    fn write(&mut self, after: Option<usize>, name: &str, group: &Group) {
        let place = after.map_or(&mut self.first, |unit| &mut self.after[unit]);
        let _ = writeln!(place, "    {};", self.vector.put(name, group));
    }

    fn statements(&self) -> String {
        let (graph, mut out) = (self.vector.graph, self.first.clone());
        let mut thirds = self.vector.thirds();
        for (unit, after) in self.units.iter().zip(&self.after) {
            let three = if let Unit::Node(k) = unit { thirds.iter().position(|three| three.nodes.contains(k)) } else { None };
            match three {
                Some(at) if thirds[at].written => {}
                Some(at) => {
                    thirds[at].written = true;
                    out += &thirds[at].statement;
                }
                None => out += &unit.written(graph, self.vector).unwrap_or_default(),
            }
            out += after;
        }
        out
    }
}

/// Three vectors that are read together: the first, second and third numbers of each lane, where the lanes lie one behind the other.
struct Three {
    nodes: [usize; 3],
    statement: String,
    written: bool,
}

impl Vector<'_> {
    fn thirds(&self) -> Vec<Three> {
        let lanes = self.graph.lanes();
        let mut inputs: BTreeMap<(u32, &[u32]), usize> = BTreeMap::new();
        for (k, node) in self.graph.nodes().iter().enumerate().filter(|(_, node)| node.op == Op::LaneInput) {
            inputs.insert((node.args[0], lanes.input(node.args[1])), k);
        }
        let three = |(&(argument, numbers), &first): (&(u32, &[u32]), &usize)| {
            let [a, b, c, d] = *numbers else { return None };
            let next = |n: u32| inputs.get(&(argument, &[a + n, b + n, c + n, d + n][..])).copied();
            let nodes = (b == a + 3 && c == b + 3 && d == c + 3).then_some([first, next(1)?, next(2)?])?;
            let input = &self.signature.inputs[argument as usize];
            let numbers: Vec<String> = (a..a + 12).map(|k| input.at(k as usize)).collect();
            let statement = format!("    let [x{}, x{}, x{}] = every_third(&[{}]);\n", nodes[0], nodes[1], nodes[2], numbers.join(", "));
            Some(Three { nodes, statement, written: false })
        };
        inputs.iter().filter_map(three).collect()
    }

    /// What writes a group.
    fn put(&self, out: &str, group: &Group) -> String {
        let columns = |columns: &[Column]| columns.iter().map(|c| self.column(c)).collect::<Vec<_>>().join(", ");
        match group {
            Group::Whole(node, at) => format!("put(x{node}, {out}, {at})"),
            Group::InTurn(of, at) => format!("put_in_turn({}, {out}, {at})", columns(of)),
            Group::Fours(of, at) => format!("put_fours({}, {out}, {at:?})", columns(of)),
            Group::Twos(of, at) => format!("put_twos({}, {out}, {at:?})", columns(of)),
            Group::Pair([a, b], at) => format!("put_two([{}, {}], {out}, {at})", self.cell(*a), self.cell(*b)),
            Group::One(cell, at) => format!("put_one({}, {out}, {at})", self.cell(*cell)),
            Group::Constant(x, at, 1) => format!("put_one({}, {out}, {at})", literal(*x)),
            Group::Constant(x, at, n) => format!("{out}[{at}..{}].fill(::core::mem::MaybeUninit::new({}))", at + n, literal(*x)),
        }
    }

    fn cell(&self, cell: Cell) -> String {
        match cell {
            Cell::Constant(x) => literal(x),
            Cell::Lane(node, lane) => format!("lane::<{lane}>(x{node})"),
        }
    }

    fn column(&self, column: &Column) -> String {
        match column {
            Column::Node(node) => format!("x{node}"),
            Column::Constants(x) if x.iter().all(|y| y == &x[0]) => format!("k({})", literal(x[0])),
            Column::Constants(x) => format!("lanes([{}])", x.iter().map(|x| literal(*x)).collect::<Vec<_>>().join(", ")),
        }
    }
}
