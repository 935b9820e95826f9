//! Pieces: what they name, and what they write.

use std::collections::{HashMap, HashSet};

use super::*;
use crate::emit::statements::order::Angle;
use crate::graph::Node;

/// A graph in which values are needed soon, late and never again.
fn graph() -> Graph {
    let mut g = Graph::default();
    let mut values = vec![g.input(0, 0), g.input(0, 1), g.input(0, 2)];
    for k in 0..200_usize {
        let (a, b) = (values[(k * 7919) % values.len()], values[values.len() - 1 - k % 3]);
        let op = [Op::Mul, Op::Add, Op::Sub][k % 3];
        values.push(g.apply(op, &[a, b]));
    }
    let positive = g.apply(Op::Positive, &[values[20]]);
    let late = g.apply(Op::Select, &[positive, values[5], values[202]]);
    g.outputs = vec![values[202], late, values[30]];
    g
}

#[test]
fn every_place_is_a_field_and_no_struct_is_long() {
    for slots in [1, FIELDS, FIELDS + 1, 3 * FIELDS - 1] {
        let all: Vec<String> = structs(slots).flat_map(|(k, fields)| (0..fields).map(move |m| format!("m.k{k}.m{m}"))).collect();
        assert_eq!(all, (0..slots).map(place).collect::<Vec<_>>());
        assert!(structs(slots).all(|(_, fields)| fields <= FIELDS));
    }
}

#[test]
fn a_place_holds_what_a_later_piece_takes_from_it() {
    let graph = graph();
    let units: Vec<Unit> = units(&graph, 4).into_iter().filter(|u| !is_light(&graph, u)).collect();
    let plan = Plan::of(&graph, units.chunks(10).collect());
    let mut held: Vec<Option<usize>> = vec![None; plan.slots];
    let mut taken = 0;
    for (c, piece) in plan.pieces.iter().enumerate() {
        for unit in *piece {
            for k in heavy_needs(&graph, unit.needs(&graph)).into_iter().filter(|&k| plan.made[k] != c) {
                let slot = plan.slot[k].unwrap_or_else(|| panic!("node {k} has no place"));
                assert_eq!(held[slot], Some(k), "place {slot} in piece {c}");
                taken += 1;
            }
            unit.makes().into_iter().filter_map(|k| Some((k, plan.slot[k]?))).for_each(|(k, slot)| held[slot] = Some(k));
        }
        let mut written: Vec<usize> = piece.iter().flat_map(Unit::makes).filter_map(|k| plan.slot[k]).collect();
        written.sort_unstable();
        assert!(written.windows(2).all(|pair| pair[1] > pair[0] + 1), "piece {c} writes neighbours: {written:?}");
    }
    assert!(taken > 50 && plan.slots < taken, "{taken} taken from {} places", plan.slots);
}

/// Statements that say what they are made of.
struct Text<'a>(&'a Graph);

impl Dialect for Text<'_> {
    fn statement(&self, k: usize, node: &Node) -> Option<String> {
        let name = |id: NodeId| self.0.node(id).constant().map_or_else(|| format!("x{}", id.0), |x| format!("{x:?}"));
        let operands: Vec<String> = node.operands().map(name).collect();
        (node.op != Op::Constant).then(|| format!("    let x{k} = {};\n", operands.join(" ")))
    }

    fn sines(&self, _: &[Angle], _: usize) -> String {
        String::new()
    }

    fn group(&self) -> usize {
        4
    }

    fn number(&self, id: NodeId) -> String {
        let node = self.0.node(id);
        // A lane of a vector is taken where it is a result.
        let from = if node.op == Op::Spread { node.args[0] } else { id.0 };
        node.constant().map_or_else(|| format!("x{from}"), |x| format!("{x:?}"))
    }

    fn value(&self) -> (&'static str, &'static str) {
        ("f64", "0.0")
    }
}

/// The places that pieces write, in order; each name must be known where it is used, and each place of `m` hold it.
fn written(graph: &Graph, zeros: &[String], length: usize) -> Vec<String> {
    let places: Vec<String> = (0..graph.outputs.len()).map(|k| format!("out[{k}]")).collect();
    let (pieces, _) = cut(graph, &Text(graph), &places, zeros, length);
    let (mut kept, mut results) = (HashMap::new(), Vec::new());
    for piece in &pieces {
        let mut named = HashSet::new();
        for line in piece.lines() {
            let (left, right) = line.trim().trim_end_matches(';').split_once(" = ").unwrap();
            assert!(right.split(' ').all(|word| !word.starts_with('x') || named.contains(word)), "{line} in\n{piece}");
            if let Some(name) = left.strip_prefix("let ") {
                assert!(named.insert(name), "{name} twice in\n{piece}");
                assert!(!right.starts_with("m.") || kept.get(right) == Some(&name), "{line} in\n{piece}");
            } else if left.starts_with("m.") {
                let op = graph.nodes()[right[1..].parse::<usize>().unwrap()].op;
                assert!(op != Op::Positive, "a comparison is no number");
                kept.insert(left, right);
            } else {
                results.push(left.to_owned());
            }
        }
    }
    results.sort_unstable();
    results
}

#[test]
fn pieces_name_what_they_use_and_write_each_result_once() {
    let mut graph = graph();
    let positive = graph.nodes().iter().position(|node| node.op == Op::Positive).unwrap() as u32;
    let mut value = graph.outputs[0];
    for _ in 0..30 {
        value = graph.exactly(Op::Mul, &[value, graph.outputs[2]]);
    }
    let (late, number, input) = (graph.exactly(Op::Select, &[NodeId(positive), value, value]), graph.constant(2.5), graph.input(0, 1));
    graph.outputs.extend([late, number, input, late]);
    let zeros: Vec<String> = (0..9).map(|k| format!("    zero[{k}] = 0.0;\n")).collect();
    let expected: Vec<String> = (0..7).map(|k| format!("out[{k}]")).chain((0..9).map(|k| format!("zero[{k}]"))).collect();
    for length in [1, 10, usize::MAX] {
        assert_eq!(written(&graph, &zeros, length), expected, "pieces of {length}");
    }
    let mut constant = Graph::default();
    constant.outputs = vec![constant.constant(1.0); 7];
    assert_eq!(written(&constant, &zeros, 10), expected);
}

#[test]
fn a_lane_that_is_a_result_is_taken_where_its_vector_is_known() {
    let mut graph = Graph::in_lanes(4);
    let x = graph.lane_input(0, &[0, 1, 2, 3]);
    let y = graph.apply(Op::Mul, &[x, x]);
    let [first, third] = [0.0, 2.0].map(|lane| graph.constant(lane));
    let [of_y, of_x, inner] = [(y, first), (x, first), (y, third)].map(|(of, lane)| graph.exactly(Op::Spread, &[of, lane]));
    let sum = graph.apply(Op::Add, &[inner, y]);
    let product = graph.apply(Op::Mul, &[sum, x]);
    let lane = graph.exactly(Op::Spread, &[product, third]);
    graph.outputs = vec![of_y, of_x, inner, product, lane, of_y];
    let expected: Vec<String> = (0..6).map(|k| format!("out[{k}]")).collect();
    for length in [1, 2, usize::MAX] {
        assert_eq!(written(&graph, &[], length), expected, "pieces of {length}");
    }
}
