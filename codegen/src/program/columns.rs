//! Parts of a function emitted as loops: the solution of M X = B column by column.

use std::ops::RangeInclusive;
use std::sync::Arc;

use articulated_core::model::Model;

use crate::capabilities::Capabilities;
use crate::function_spec::FunctionSpec;
use crate::graph::{CAPTURED, Graph, Kind, NodeId, Op, ROW, Region, Rule};
use crate::ledger::Entry;
use crate::pass;
use crate::trace::applies;

/// The solution of M X = B column by column, which is the same for each.
pub(crate) struct MultiRhsSolve {
    /// For each row of L, the columns of its non-zero entries before the diagonal.
    pub(crate) ways: Vec<Vec<usize>>,
}

/// Range of degrees of freedom in which the solution column by column is a loop. With six, the
/// whole function takes a quarter longer than unrolled; with seven 5 % to 20 % less, with eight and
/// nine 14 % to 20 % less; with 18 and 36 it has a third of the code and of the compile time.
const COLUMNS: RangeInclusive<usize> = 7..=60;

/// The part of a function to emit as a loop, if that is faster; it needs vectors.
pub(super) fn columns(spec: &FunctionSpec, model: &Model<f64>, can: Capabilities) -> Option<MultiRhsSolve> {
    has_columns(spec, model, can).then(|| MultiRhsSolve { ways: model.paths_to_root() })
}

/// Whether the solution of M X = B is emitted as a loop.
pub(crate) fn has_columns(spec: &FunctionSpec, model: &Model<f64>, can: Capabilities) -> bool {
    let ([part], None) = (spec.parts.as_slice(), &spec.transform) else { return false };
    let fits = COLUMNS.contains(&model.nv()) && can.loops;
    fits && part.function.unsolved.as_ref().is_some_and(|unsolved| applies(unsolved, model))
}

impl MultiRhsSolve {
    /// Whether the loop reads entry `k` of the three matrices: all entries of both B; of the
    /// factors, the diagonal and the entries on a path to the root.
    pub(crate) fn reads(&self, k: usize) -> bool {
        let n = self.ways.len();
        let (matrix, row, column) = (k / n / n, k / n % n, k % n);
        matrix < 2 || row == column || self.ways[row].contains(&column)
    }

    /// The graph of the whole function, from that of the part before the loop: the loop is a region
    /// over the columns, with the factors as captured values.
    ///
    /// ```text
    /// x ← L⁻ᵀ x from the last row up, then x ← L⁻¹ D⁻¹ x from the first row down
    /// ```
    pub(super) fn whole(&self, before: &Graph) -> Graph {
        let n = self.ways.len();
        let mut graph = before.clone();
        let outputs = std::mem::take(&mut graph.outputs);
        let (right, factors) = outputs.split_at(2 * n * n);
        // The places of the factors among the captured values.
        let entries: Vec<(usize, usize)> =
            (0..n).flat_map(|k| std::iter::once(k).chain(self.ways[k].iter().copied()).map(move |i| (k, i))).collect();
        let place = |k: usize, i: usize| entries.iter().position(|entry| *entry == (k, i)).unwrap_or_default();
        let mut body = Graph::default();
        let mut x: Vec<NodeId> = (0..n).map(|k| body.input(ROW, k)).collect();
        let subtract = |body: &mut Graph, from: NodeId, entry: usize, of: NodeId| {
            let factor = body.input(CAPTURED, entry);
            let product = body.apply(Op::Mul, &[factor, of]);
            body.apply(Op::Sub, &[from, product])
        };
        for k in (0..n).rev() {
            for i in &self.ways[k] {
                x[*i] = subtract(&mut body, x[*i], place(k, *i), x[k]);
            }
        }
        for k in 0..n {
            let inverse = body.input(CAPTURED, place(k, k));
            x[k] = body.apply(Op::Mul, &[inverse, x[k]]);
            for i in &self.ways[k] {
                x[k] = subtract(&mut body, x[k], place(k, *i), x[*i]);
            }
        }
        body.outputs = x;
        let mut given: Vec<NodeId> = entries.iter().map(|(k, i)| factors[k * n + i]).collect();
        let [zero, one] = [0.0, 1.0].map(|x| graph.constant(x));
        for column in 0..3 * n {
            let (matrix, j) = (column / n, column % n);
            given.extend((0..n).map(|i| match matrix {
                2 if i == j => one,
                2 => zero,
                _ => graph.apply(Op::Neg, &[right[(matrix * n + i) * n + j]]),
            }));
        }
        let kind = Kind::ForEach { turns: 3 * n, row: n, results: n };
        let region = Region { kind, carried: 0, captured: entries.len(), body: pass::run_all_unchecked(body), rule: Rule::OfItsKind };
        let solved = graph.region(Arc::new(region), &given);
        let value = |at: usize| (at / n / n * n + at % n) * n + at / n % n;
        graph.outputs = (0..3 * n * n).map(|at| graph.region_value(solved, value(at))).collect();
        graph
    }

    /// Adds the operations of the loop, in vectors of four columns, to every stage.
    pub(super) fn count(&self, entry: &mut Entry) {
        let (n, entries) = (self.ways.len() as u64, self.ways.iter().map(|way| way.len() as u64).sum::<u64>());
        let vectors = 3 * n.div_ceil(4);
        for (_, counts) in &mut entry.stages {
            counts.add(Op::NegMulAdd, 2 * entries * vectors);
            counts.add(Op::Mul, n * vectors);
        }
        entry.ways = vec!["columns in a loop".into()];
    }
}
