//! Functions in four lanes that write their results as they are made, into room that may hold nothing yet: constants first, half of them before the sines and half between and behind
//! them, so that the stores fill the time in which nothing else can be done; then what belongs together as soon as the last of it is known.

pub(crate) mod across;
pub(crate) mod rows;
pub(crate) mod zeros;

use std::collections::{BTreeMap, HashMap};
use std::fmt::Write;

use crate::emit::function::signature::Signature;
use crate::emit::memory::spill::{Kind, spilled};
use crate::emit::statements::dialect::{Dialect, Unit, units};
use crate::emit::statements::flat::flat;
use crate::emit::statements::literal::literal;
use crate::emit::statements::vector::Vector;
use crate::emit::written::across::Across;
use crate::emit::written::rows::{Cell, Column, Group, WIDTH, groups};
use crate::graph::{Graph, NodeId, Op};

/// The statements.
pub(crate) fn body(out: &mut String, graph: &Graph, signature: &Signature) {
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
    let mut statements = Writer::of(&vector, &all).statements();
    if signature.spills {
        statements = spilled(&statements, Kind::of(vector.value().0, WIDTH));
    }
    *out += &flat(&statements, vector.value().0);
}

/// The statements, and what is written between them.
struct Writer<'a> {
    vector: &'a Vector<'a>,
    units: Vec<Unit>,
    across: Across,
    /// The unit in which a node is made.
    made: HashMap<usize, usize>,
    /// What is written after each unit, and before the first.
    after: Vec<String>,
    first: String,
}

impl<'a> Writer<'a> {
    fn of(vector: &'a Vector<'a>, groups: &[(String, Group)]) -> Self {
        let units = units(vector.graph, vector.group());
        let across = Across::of(vector.graph);
        let mut made: HashMap<usize, usize> =
            units.iter().enumerate().flat_map(|(u, unit)| unit.makes().into_iter().map(move |k| (k, u))).collect();
        let alone = made.clone();
        made.iter_mut().for_each(|(k, unit)| *unit = across.set(*k).iter().map(|other| alone[other]).max().unwrap_or(*unit));
        let sines: Vec<usize> = (0..units.len()).filter(|&u| matches!(units[u], Unit::Sines(..))).collect();
        let (constant, others): (Vec<_>, Vec<_>) = groups.iter().partition(|(_, group)| group.nodes().is_empty());
        let mut writer = Self { vector, after: vec![String::new(); units.len()], units, across, made, first: String::new() };
        let before = constant.len() / 2;
        for (n, (name, group)) in constant.iter().enumerate() {
            let behind = n.checked_sub(before).and_then(|n| sines.get(n * sines.len() / (constant.len() - before)));
            writer.write(behind.copied(), name, group);
        }
        for (name, group) in others {
            let ready = group.nodes().iter().filter_map(|k| writer.made.get(k)).max().copied();
            writer.write(ready, name, group);
        }
        writer
    }

    /// Writes a group after a unit, or before all.
    fn write(&mut self, after: Option<usize>, name: &str, group: &Group) {
        let put = self.put(name, group);
        let place = after.map_or(&mut self.first, |unit| &mut self.after[unit]);
        let _ = writeln!(place, "    {put};");
    }

    fn statements(&self) -> String {
        let mut out = self.first.clone();
        let mut thirds = self.vector.thirds();
        for (u, (unit, after)) in self.units.iter().zip(&self.after).enumerate() {
            let three = if let Unit::Node(k) = unit { thirds.iter().position(|three| three.nodes.contains(k)) } else { None };
            match three {
                Some(at) if thirds[at].written => {}
                Some(at) => {
                    thirds[at].written = true;
                    out += &thirds[at].statement;
                }
                None => out += &self.written(u, unit).unwrap_or_default(),
            }
            out += after;
        }
        out
    }

    /// A unit as text; of sums that are made together, where the last of them stands.
    fn written(&self, u: usize, unit: &Unit) -> Option<String> {
        match unit {
            Unit::Node(k) if !self.across.set(*k).is_empty() => (self.made[k] == u).then(|| {
                let nodes = self.vector.graph.nodes();
                self.across.statement(*k, |sum| self.vector.operand(NodeId(nodes[sum].args[0])))
            }),
            _ => unit.written(self.vector.graph, self.vector),
        }
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
            Cell::Lane(node, 0) => {
                let (vector, lane) = self.across.place(node);
                format!("lane::<{lane}>({vector})")
            }
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
}

#[cfg(test)]
mod tests {
    use articulated_core::algorithm::Shape;

    use super::*;
    use crate::wanted::Wanted;

    fn with<T>(graph: &Graph, work: impl FnOnce(&Vector) -> T) -> T {
        let wanted = Wanted::parse("inverse_dynamics").unwrap();
        let signature = Signature::of(&wanted, Shape { nq: 15, nv: 15, frames: 0, links: 0 }, false);
        work(&Vector { graph, signature: &signature })
    }

    /// All lanes of a node, in turn.
    fn lanes_of(graph: &mut Graph, id: NodeId) -> [NodeId; 4] {
        std::array::from_fn(|k| {
            let lane = graph.constant(k as f64);
            graph.exactly(Op::Spread, &[id, lane])
        })
    }

    #[test]
    fn three_vectors_are_read_together_where_their_lanes_lie_one_behind_the_other() {
        let all = |starts: [usize; 4]| {
            let mut graph = Graph::in_lanes(4);
            let x: Vec<NodeId> = (0..3).map(|n| graph.lane_input(0, &starts.map(|k| k + n))).collect();
            (with(&graph, |v| v.thirds().into_iter().map(|three| (three.nodes, three.statement)).collect::<Vec<_>>()), x)
        };
        let (thirds, x) = all([2, 5, 8, 11]);
        let numbers: Vec<String> = (2..14).map(|k| format!("q[{k}]")).collect();
        let names = x.iter().map(|id| format!("x{}", id.0)).collect::<Vec<_>>().join(", ");
        assert_eq!(thirds.len(), 1);
        assert_eq!(thirds[0].0.to_vec(), x.iter().map(|id| id.index()).collect::<Vec<_>>());
        assert_eq!(thirds[0].1, format!("    let [{names}] = every_third(&[{}]);\n", numbers.join(", ")));
        for starts in [[2, 6, 9, 12], [2, 5, 9, 12], [2, 5, 8, 12], [11, 8, 5, 2]] {
            assert_eq!(all(starts).0, [], "{starts:?}");
        }
    }

    #[test]
    fn sums_over_lanes_are_made_four_at_a_time_where_they_are_results_alone() {
        for (count, statements) in [
            (1, vec!["let x1 = across(x0);"]),
            (2, vec!["let sums_0 = across_of_two(x0, x2);"]),
            (3, vec!["let sums_0 = across_of_four(x0, x2, x4, x4);"]),
            (6, vec!["let sums_0 = across_of_four(x0, x2, x4, x6);", "let sums_1 = across_of_two(x8, x10);"]),
        ] {
            let mut graph = Graph::in_lanes(4);
            let sums: Vec<NodeId> = (0..count)
                .map(|k| {
                    let x = graph.lane_input(0, &[k, k + 2, k + 4, k + 6]);
                    graph.exactly(Op::Across, &[x])
                })
                .collect();
            graph.outputs = sums.clone();
            let written = |graph: &Graph| {
                let cells: Vec<Cell> = graph.outputs.iter().map(|&o| Cell::of(graph, o)).collect();
                let all: Vec<(String, Group)> = groups(&cells).into_iter().map(|group| ("out".into(), group)).collect();
                with(graph, |v| Writer::of(v, &all).statements())
            };
            let text = written(&graph);
            let found: Vec<&str> = text.lines().map(str::trim).filter(|line| line.contains("across")).collect();
            assert_eq!(found, statements);
            let last =
                if count == 1 { "put_one(lane::<0>(x1), out, 0)" } else { "put_two([lane::<0>(sums_0), lane::<1>(sums_0)], out, 0)" };
            assert!(text.contains(last), "{text}");
            // One that something else needs too is made by itself.
            let twice = graph.exactly(Op::Add, &[sums[0], sums[0]]);
            graph.outputs.push(twice);
            assert!(written(&graph).contains("let x1 = across(x0);"));
        }
    }

    #[test]
    fn what_is_written_is_made_before_and_every_number_is_its_own() {
        let mut graph = Graph::in_lanes(4);
        let x = graph.lane_input(0, &[0, 3, 6, 9]);
        let y = graph.lane_input(0, &[1, 4, 7, 10]);
        let sine = graph.apply(Op::Sin, &[x]);
        let sum = graph.apply(Op::Add, &[sine, y]);
        let product = graph.apply(Op::Mul, &[sum, y]);
        let numbers = graph.lane_constant([2.0, 2.0, 2.0, -3.0]);
        // Pairs of each lane, one of them made late; constants beside; one alone.
        let (early, late, given) = (lanes_of(&mut graph, sine), lanes_of(&mut graph, product), lanes_of(&mut graph, numbers));
        // What all lanes are.
        let same = graph.constant(0.25);
        let same = lanes_of(&mut graph, same);
        let mut outputs: Vec<NodeId> = (0..4).flat_map(|k| [early[k], late[k], given[k]]).collect();
        outputs.extend([graph.constant(0.5), late[2], graph.constant(0.0), graph.constant(0.0), late[3], same[2]]);
        graph.outputs = outputs;
        let cells: Vec<Cell> = graph.outputs.iter().map(|&o| Cell::of(&graph, o)).collect();
        let all: Vec<(String, Group)> = groups(&cells).into_iter().map(|group| ("out".into(), group)).collect();
        let text = with(&graph, |v| Writer::of(v, &all).statements());
        let mut named: Vec<&str> = Vec::new();
        for line in text.lines() {
            let (left, right) = line.split_once(" = ").unwrap_or(("", line));
            let words = right.split(|c: char| !c.is_ascii_alphanumeric()).filter(|w| w.starts_with('x') && w.len() > 1);
            words.for_each(|word| assert!(named.contains(&word), "{line} in\n{text}"));
            named.extend(left.split(|c: char| !c.is_ascii_alphanumeric()).filter(|w| w.starts_with('x')));
        }
        for group in [
            "lanes([2.0, 2.0, 2.0, -3.0])",
            "put_one(0.5, out, 12);",
            "put_one(0.25, out, 17);",
            "out[14..16].fill(::core::mem::MaybeUninit::new(0.0));",
        ] {
            assert!(text.contains(group), "{group} in\n{text}");
        }
        assert_eq!(text.matches("put").count() + text.matches("fill").count(), all.len(), "{text}");
    }
}
