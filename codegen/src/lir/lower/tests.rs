//! Statements compute what their graph does.

use articulated_core::Scalar;

use super::*;
use crate::Sym;
use crate::lir::interpret::interpret;
use crate::lir::{Body, verify};

fn lowering<'a>(graph: &'a Graph, results: &'a [Array]) -> Lowering<'a> {
    let width = graph.lanes().width;
    let ty = if width == 1 { Ty::F64 } else { Ty::Vector(width) };
    Lowering {
        graph,
        ty,
        sines: SinCosGrouping { together: 8 / width, are_powers_of_two: width > 1, from: 0 },
        results,
        first: 0,
        arguments: &[],
    }
}

/// One array for all numbers.
fn results(graph: &Graph) -> Vec<Array> {
    vec![Array { start: 0, lengths: vec![graph.outputs.len()] }]
}

/// The statements, checked against the rules and the graph.
fn rows(graph: &Graph) -> Vec<Stmt> {
    let results = results(graph);
    let lowering = lowering(graph, &results);
    let (statements, lanes) = lowering.stores_in_rows();
    let pieces = vec![statements.clone()];
    let body = Body { ty: lowering.ty, lanes, results: results.clone(), pieces, kept: 0, slots: None, barrier: false, is_partial: false };
    assert_eq!(verify(&body), Ok(()));
    let input = |argument: usize, k: usize| 0.2 + argument as f64 + k as f64 / 9.0;
    let [found, expected] = [interpret(&body, input), graph.evaluate(input)];
    assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-14), "{found:?} {expected:?}");
    statements
}

/// All lanes of a node, in turn.
fn lanes_of(graph: &mut Graph, id: NodeId) -> [NodeId; 4] {
    std::array::from_fn(|k| {
        let lane = graph.constant(k as f64);
        graph.exactly(Op::Broadcast, &[id, lane])
    })
}

#[test]
fn three_vectors_are_read_together_where_their_lanes_lie_one_after_the_other() {
    let all = |starts: [usize; 4]| {
        let mut graph = Graph::in_lanes(4);
        let x: Vec<NodeId> = (0..3).map(|n| graph.lane_input(0, &starts.map(|k| k + n))).collect();
        let sum = graph.apply(Op::Add, &[x[0], x[1]]);
        let sum = graph.apply(Op::Mul, &[sum, x[2]]);
        graph.outputs = lanes_of(&mut graph, sum).to_vec();
        let dst = [x[0], x[1], x[2]].map(|id| Temp::of(id.index()));
        (rows(&graph).into_iter().filter(|s| matches!(s, Stmt::Thirds { .. })).collect::<Vec<_>>(), dst)
    };
    let (thirds, dst) = all([2, 5, 8, 11]);
    assert_eq!(thirds, [Stmt::Thirds { dst, argument: 0, first: 2 }]);
    for starts in [[2, 6, 9, 12], [2, 5, 9, 12], [2, 5, 8, 12], [11, 8, 5, 2]] {
        assert_eq!(all(starts).0, [], "{starts:?}");
    }
}

#[test]
fn sums_over_lanes_are_made_four_at_a_time_where_they_are_results_alone() {
    for (count, sets, without_one) in [(1, vec![], vec![]), (2, vec![2], vec![]), (3, vec![3], vec![2]), (6, vec![4, 2], vec![4])] {
        let mut graph = Graph::in_lanes(4);
        let sums: Vec<NodeId> = (0..count)
            .map(|k| {
                let x = graph.lane_input(0, &[k, k + 2, k + 4, k + 6]);
                graph.exactly(Op::ReduceAdd, &[x])
            })
            .collect();
        graph.outputs = sums.clone();
        let made = |graph: &Graph| -> Vec<usize> {
            rows(graph).iter().filter_map(|s| if let Stmt::SumLanes(_, operands) = s { Some(operands.len()) } else { None }).collect()
        };
        assert_eq!(made(&graph), sets);
        // A sum that another node uses is made by itself, and so is one that is left over.
        let twice = graph.exactly(Op::Add, &[sums[0], sums[0]]);
        graph.outputs.push(twice);
        assert_eq!(made(&graph), without_one);
    }
}

#[test]
fn rows_are_stored_as_soon_as_they_are_known_and_constants_between() {
    let mut graph = Graph::in_lanes(4);
    let x = graph.lane_input(0, &[0, 3, 6, 9]);
    let y = graph.lane_input(0, &[1, 4, 7, 10]);
    let sine = graph.apply(Op::Sin, &[x]);
    let sum = graph.apply(Op::Add, &[sine, y]);
    let product = graph.apply(Op::Mul, &[sum, y]);
    let numbers = graph.lane_constant([2.0, 2.0, 2.0, -3.0]);
    // Pairs of each lane, one of them made late; constants beside; one alone.
    let (early, late, given) = (lanes_of(&mut graph, sine), lanes_of(&mut graph, product), lanes_of(&mut graph, numbers));
    let mut outputs: Vec<NodeId> = (0..4).flat_map(|k| [early[k], late[k], given[k]]).collect();
    outputs.extend([graph.constant(0.5), late[2], graph.constant(0.0), graph.constant(0.0), late[3]]);
    graph.outputs = outputs;
    let statements = rows(&graph);
    let number = |x| Number { of: Operand::Constant(x), lane: 0 };
    for store in [Store::One(12, number(0.5)), Store::Fill(14, 2, 0.0)] {
        assert!(statements.contains(&Stmt::Store(store.clone())), "{store:?} in {statements:?}");
    }
    assert!(statements.iter().any(|s| matches!(s, Stmt::Store(Store::Rows(Rows::InTurn(0), columns)) if columns.len() == 3)));
}

#[test]
fn sines_go_together_as_a_target_has_functions_for() {
    let sizes = |angles: usize, sines: SinCosGrouping| -> Vec<usize> {
        let mut graph = Graph::default();
        graph.outputs = (0..angles)
            .map(|k| {
                let angle = graph.input(0, k);
                graph.apply(Op::Sin, &[angle])
            })
            .collect();
        let results = results(&graph);
        let statements = Lowering { graph: &graph, ty: Ty::F64, sines, results: &results, first: 0, arguments: &[] }.results_at_end();
        statements.iter().filter_map(|s| if let Stmt::SinCos { angles, .. } = s { Some(angles.len()) } else { None }).collect()
    };
    let four = SinCosGrouping { together: 4, are_powers_of_two: false, from: 3 };
    assert_eq!([1, 2, 3, 4, 7].map(|n| sizes(n, four)), [vec![1], vec![1, 1], vec![3], vec![4], vec![4, 3]]);
    let powers = SinCosGrouping { together: 4, are_powers_of_two: true, from: 0 };
    assert_eq!([1, 2, 3, 7].map(|n| sizes(n, powers)), [vec![1], vec![2], vec![2, 1], vec![4, 2, 1]]);
}

/// A loop over rows [a, x] in an iteration that changes x alone: the column of a is built once.
#[test]
fn columns_that_do_not_change_are_built_before_the_iteration() {
    let graph = crate::sym::trace(|| {
        let [a, b, x] = [0, 1, 2].map(|k| Sym::input(0, k));
        let mut state = [x];
        let _ = Sym::repeat(3, &mut state, |state| {
            let rows = [a, state[0], b, state[0] * a];
            Sym::for_each(2, &rows, state, &mut [], |row, state, _| state[0] += row[0] * row[1]);
            (state[0] - Sym::from_f64(50.0)).positive()
        });
        state.to_vec()
    });
    let results = results(&graph);
    let statements = lowering(&graph, &results).results_at_end();
    let regions = statements.iter().filter_map(|s| if let Stmt::Region(region) = s { Some(region) } else { None });
    let columns: Vec<usize> = regions.map(|region| region.columns.len()).collect();
    assert_eq!(columns, [1]);
    let pieces = vec![statements];
    let body = Body { ty: Ty::F64, lanes: graph.lanes().clone(), results, pieces, kept: 0, slots: None, barrier: false, is_partial: false };
    assert_eq!(verify(&body), Ok(()));
    let input = |_: usize, k: usize| [0.7, -0.4, 1.3][k];
    assert_eq!(interpret(&body, input), graph.evaluate(input));
}

/// A motion x ← x + u · y, with the state of each turn, and its gradient: the way back reads the
/// states where they are, and the text of both does not grow with the number of turns.
#[test]
fn the_way_back_of_a_gradient_reads_the_states_in_place() {
    let length = |turns: usize| {
        let mut graph = crate::sym::trace(|| {
            let controls: Vec<Sym> = (0..turns).map(|k| Sym::input(1, k)).collect();
            let mut state = [Sym::input(0, 0), Sym::input(0, 1)];
            Sym::for_each(turns, &controls, &mut state, &mut [], |u, state, _| {
                let [x, y] = [state[0], state[1]];
                (state[0], state[1]) = (x + u[0] * y, y - u[0] * x * x);
            });
            state.to_vec()
        });
        let (count, output) = (graph.nodes().len(), graph.outputs[0]);
        let wrt: Vec<(usize, usize)> = (0..turns).map(|k| (1, k)).chain([(0, 0), (0, 1)]).collect();
        graph.outputs = crate::pass::gradients(&mut graph, &[output], count, &wrt, |graph, _| graph.constant(1.0));
        let graph = crate::pass::dce(&graph);
        let (mut results, arguments) = (vec![Array { start: 0, lengths: vec![turns] }], [2, turns]);
        results.push(Array { start: turns, lengths: vec![2] });
        let lowering = Lowering { arguments: &arguments, ..lowering(&graph, &results) };
        let (mut pieces, kept) = crate::lir::pass::outline::outline(lowering.stores_as_made(|_| true, false), usize::MAX);
        pieces.iter_mut().for_each(|piece| read_in_place(piece, &[]));
        let statements = pieces[0].clone();
        let body = Body {
            ty: Ty::F64,
            lanes: graph.lanes().clone(),
            results: results.clone(),
            pieces,
            kept,
            slots: None,
            barrier: false,
            is_partial: false,
        };
        assert_eq!(verify(&body), Ok(()));
        let input = |argument: usize, k: usize| if argument == 0 { [0.7, -0.4][k] } else { 0.01 + 1e-4 * k as f64 };
        assert_eq!(interpret(&body, input), graph.evaluate(input));
        format!("{statements:?}").len()
    };
    // Names have more digits.
    assert!(length(90).abs_diff(length(10)) < 60, "{} {}", length(10), length(90));
}
