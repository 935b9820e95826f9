//! Pieces: the values that they define and keep.

use std::collections::HashMap;

use super::*;
use crate::graph::{Graph, NodeId, Op};
use crate::lir::interpret::interpret;
use crate::lir::lower::{Lowering, SinCosGrouping};
use crate::lir::{Array, Body, Ty, verify};

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

/// The statements of a graph that stores numbers as they are made, in pieces of this length.
fn cut(graph: &Graph, length: usize) -> Body {
    let ty = if graph.lanes().width == 1 { Ty::F64 } else { Ty::Vector(graph.lanes().width) };
    let results = vec![Array { start: 0, lengths: vec![graph.outputs.len()] }];
    let sines = SinCosGrouping { together: 4, are_powers_of_two: false, from: 3 };
    let statements = Lowering { graph, ty, sines, results: &results, first: 0, arguments: &[] }.stores_as_made(|_| true, false);
    let (pieces, kept) = outline(statements, length);
    Body { ty, lanes: graph.lanes().clone(), results, pieces, kept, slots: None, barrier: false, is_partial: false }
}

/// Checks pieces against the rules of bodies and the graph.
fn check(graph: &Graph, length: usize) {
    let body = cut(graph, length);
    assert_eq!(verify(&body), Ok(()), "pieces of {length}");
    let input = |_: usize, k: usize| 0.3 + k as f64 / 3.0;
    assert_eq!(interpret(&body, input), graph.evaluate(input), "pieces of {length}");
}

#[test]
fn slots_hold_what_later_pieces_take_and_are_used_again() {
    let body = cut(&graph(), 10);
    let mut held: HashMap<usize, Temp> = HashMap::new();
    let mut taken = 0;
    for (c, piece) in body.pieces.iter().enumerate() {
        let mut written = Vec::new();
        for statement in piece {
            match statement {
                Stmt::Keep(slot, temp) => {
                    held.insert(*slot, *temp);
                    written.push(*slot);
                }
                Stmt::Recall(temp, slot) => {
                    assert_eq!(held[slot], *temp, "slot {slot} in piece {c}");
                    taken += 1;
                }
                _ => {}
            }
        }
        written.sort_unstable();
        assert!(written.windows(2).all(|pair| pair[1] > pair[0] + 1), "piece {c} writes neighbours: {written:?}");
    }
    assert!(taken > 50 && body.kept < taken, "{taken} taken from {} slots", body.kept);
}

#[test]
fn pieces_compute_what_the_graph_does() {
    let mut graph = graph();
    let positive = graph.nodes().iter().position(|node| node.op == Op::Positive).unwrap() as u32;
    let mut value = graph.outputs[0];
    for _ in 0..30 {
        value = graph.exactly(Op::Mul, &[value, graph.outputs[2]]);
    }
    let (late, number, input) = (graph.exactly(Op::Select, &[NodeId(positive), value, value]), graph.constant(2.5), graph.input(0, 1));
    let zero = graph.constant(0.0);
    graph.outputs.extend([late, number, input, late, zero, zero]);
    for length in [1, 10, usize::MAX] {
        check(&graph, length);
    }
    let mut constant = Graph::default();
    constant.outputs = vec![constant.constant(1.0); 7];
    check(&constant, 10);
}

#[test]
fn a_lane_that_is_a_result_is_taken_where_its_vector_is_known() {
    let mut graph = Graph::in_lanes(4);
    let x = graph.lane_input(0, &[0, 1, 2, 3]);
    let y = graph.apply(Op::Mul, &[x, x]);
    let [first, third] = [0.0, 2.0].map(|lane| graph.constant(lane));
    let [of_y, of_x, inner] = [(y, first), (x, first), (y, third)].map(|(of, lane)| graph.exactly(Op::Broadcast, &[of, lane]));
    let sum = graph.apply(Op::Add, &[inner, y]);
    let product = graph.apply(Op::Mul, &[sum, x]);
    let lane = graph.exactly(Op::Broadcast, &[product, third]);
    graph.outputs = vec![of_y, of_x, inner, product, lane, of_y];
    for length in [1, 2, usize::MAX] {
        check(&graph, length);
    }
}
