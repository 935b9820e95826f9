//! Zeros of large results: a few side by side by one statement each, between the statements that
//! compute.
//!
//! To fill a whole matrix beforehand takes as long as a third of the humanoid's mass matrix, since
//! a processor does nothing else meanwhile. Single stores have time while sums wait for their
//! terms.

use crate::lir::{Array, Number, Operand, Stmt, Store};

/// Largest number of zeros that are written in place together. More would be a call.
const MOST: usize = 16;

/// The statements that write the zeros of a result, runs of them within a row. `barrier`: one by
/// one, since neighbours are stored through different pointers.
pub(crate) fn zeros(results: &[Array], is_zero: impl Fn(usize) -> bool, barrier: bool) -> Vec<Stmt> {
    let mut runs: Vec<(usize, usize)> = Vec::new();
    for array in results {
        let row = array.lengths.last().copied().unwrap_or(1);
        for at in (array.start..array.start + array.numbers()).filter(|at| is_zero(*at)) {
            let begins_row = (at - array.start).is_multiple_of(row);
            match runs.last_mut() {
                Some((start, count)) if *start + *count == at && *count < MOST && !begins_row && !barrier => *count += 1,
                _ => runs.push((at, 1)),
            }
        }
    }
    let zero = Number { of: Operand::Constant(0.0), lane: 0 };
    let store = |(at, count)| if count == 1 { Store::One(at, zero) } else { Store::Fill(at, count, 0.0) };
    runs.into_iter().map(store).map(Stmt::Store).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn array(start: usize, lengths: &[usize]) -> Array {
        Array { start, lengths: lengths.to_vec() }
    }

    /// The places and numbers of zeros of all statements.
    fn runs(results: &[Array], zeros_at: &[usize], barrier: bool) -> Vec<(usize, usize)> {
        let of = |statement: Stmt| match statement {
            Stmt::Store(Store::One(at, number)) if number.is_zero() => (at, 1),
            Stmt::Store(Store::Fill(at, count, 0.0)) => (at, count),
            other => panic!("{other:?}"),
        };
        zeros(results, |at| zeros_at.contains(&at), barrier).into_iter().map(of).collect()
    }

    #[test]
    fn neighbours_go_together_and_none_is_left_out() {
        // A matrix of two rows, a number, and a vector.
        let results = [array(0, &[2, 6]), array(12, &[]), array(13, &[3])];
        let zeros_at = [1, 2, 4, 5, 6, 12, 13, 15];
        assert_eq!(runs(&results, &zeros_at, false), [(1, 2), (4, 2), (6, 1), (12, 1), (13, 1), (15, 1)]);
        assert_eq!(runs(&results, &zeros_at, true), zeros_at.map(|at| (at, 1)));
    }

    #[test]
    fn no_statement_writes_much() {
        let all: Vec<usize> = (0..40).collect();
        assert_eq!(runs(&[array(0, &[40])], &all, false), [(0, 16), (16, 16), (32, 8)]);
    }
}
