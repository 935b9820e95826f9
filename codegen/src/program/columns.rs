//! Parts of a function emitted as loops: the solution of M X = B column by column.

use std::ops::RangeInclusive;

use articulated_core::model::Model;

use crate::capabilities::Capabilities;
use crate::function_spec::FunctionSpec;
use crate::graph::Op;
use crate::ledger::Entry;
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
