//! What of a function is left a loop: the solution of M X = B column by column.

use std::ops::RangeInclusive;

use articulated_core::model::Model;

use crate::capabilities::Capabilities;
use crate::graph::Op;
use crate::ledger::Entry;
use crate::spec::FunctionSpec;
use crate::trace::applies;

/// The solution of M X = B column by column, which is the same for each.
pub(crate) struct MultiRhsSolve {
    /// For each row of L, where it has numbers before the diagonal.
    pub(crate) ways: Vec<Vec<usize>>,
}

/// From so many degrees of freedom on, and up to so many, the solution column by column is a loop: with six the whole function takes a quarter longer than written out, with seven
/// a twentieth to a fifth less, with eight and nine a seventh to a fifth less; with 18 and 36 it has a third of the code and of the time to compile it.
const COLUMNS: RangeInclusive<usize> = 7..=60;

/// What of a function is left a loop, if that is faster: it needs vectors.
pub(super) fn columns(spec: &FunctionSpec, model: &Model<f64>, can: Capabilities) -> Option<MultiRhsSolve> {
    has_columns(spec, model, can).then(|| MultiRhsSolve { ways: model.paths_to_root() })
}

/// Whether the solution of M X = B is left a loop.
pub(crate) fn has_columns(spec: &FunctionSpec, model: &Model<f64>, can: Capabilities) -> bool {
    let [part] = spec.parts.as_slice() else { return false };
    let fits = COLUMNS.contains(&model.nv) && can.vectors;
    fits && part.function.unsolved.as_ref().is_some_and(|unsolved| applies(unsolved, model))
}

impl MultiRhsSolve {
    /// Whether the loop reads number `k` of the three matrices: both B, and of the factors what is on the diagonal or on a way.
    pub(crate) fn reads(&self, k: usize) -> bool {
        let n = self.ways.len();
        let (matrix, row, column) = (k / n / n, k / n % n, k % n);
        matrix < 2 || row == column || self.ways[row].contains(&column)
    }

    /// Adds what the loop computes, in vectors of four columns, to every stage.
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
