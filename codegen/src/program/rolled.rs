//! What of a function is left a loop: the solution of M X = B column by column, or all of it joint by joint.

use std::ops::RangeInclusive;

use articulated_core::model::Model;

use super::forms::Form;
use crate::Options;
use crate::capabilities::Capabilities;
use crate::graph::{Counts, Op};
use crate::joint_blocks::{self, Groups};
use crate::ledger::{Entry, LOOPS};
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
pub(super) fn columns(wanted: &FunctionSpec, model: &Model<f64>, can: Capabilities) -> Option<MultiRhsSolve> {
    has_columns(wanted, model, can).then(|| MultiRhsSolve { ways: model.paths_to_root() })
}

/// Whether the solution of M X = B is left a loop.
pub(crate) fn has_columns(wanted: &FunctionSpec, model: &Model<f64>, can: Capabilities) -> bool {
    let [part] = wanted.parts.as_slice() else { return false };
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

/// What is fewer instructions than this is never left loops over joints: it is fetched as fast as it is executed, and does nothing that is not asked for.
const WRITTEN_OUT: f64 = 3500.0;

/// An instruction in loops takes this part of the time of one that is written out, or less.
const LOOPED: f64 = 0.95;

/// Where joints stand, if a function that would be so many instructions is fewer as loops over them: these need vectors, and constants that are known.
pub(crate) fn groups(
    wanted: &FunctionSpec,
    written: f64,
    model: &Model<f64>,
    options: &Options,
    can: Capabilities,
) -> Option<(Groups, Counts)> {
    let meant = written > WRITTEN_OUT && wanted.as_function().is_some_and(|f| Form::JointsInLoops.fits(f.id));
    let fits = options.limbs && can.vectors && options.parameters.is_empty();
    let groups = (meant && fits).then(|| Groups::of(model)).flatten()?;
    let counts = groups.counts(model);
    (counts.instructions() as f64 * LOOPED < written).then_some((groups, counts))
}

/// The entry of what is left loops, which cost this.
pub(super) fn count(entry: &mut Entry, counts: &Counts) {
    (entry.ways, entry.lanes) = (vec!["joints in loops".into()], joint_blocks::LANES);
    entry.stages.push((LOOPS, counts.clone()));
}
