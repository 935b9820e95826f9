//! Neighbouring results that are computed soon after one another, by one store.
//!
//! A processor stores once a cycle, and large matrices are mostly stores: the mass matrix of a
//! humanoid takes a tenth less time.

use std::collections::BTreeMap;

use crate::lir::{Array, Number, Stmt, Store};

/// Largest number of statements between two results of a pair: kept longer, they would fill the
/// registers.
const APART: usize = 100;

/// The statements with stores of columns 2j and 2j + 1 of a row of a matrix as one, where the
/// second was.
pub(crate) fn pair_stores(statements: Vec<Stmt>, results: &[Array]) -> Vec<Stmt> {
    let mut made: BTreeMap<usize, (usize, Number)> = BTreeMap::new();
    for (n, statement) in statements.iter().enumerate() {
        if let Stmt::Store(Store::One(at, number)) = statement {
            made.insert(*at, (n, *number));
        }
    }
    let mut new: Vec<Option<Stmt>> = statements.into_iter().map(Some).collect();
    for (&at, &(m, a)) in made.iter().filter(|(at, _)| is_even_column(results, **at)) {
        let second = made.get(&(at + 1)).filter(|(n, _)| m.abs_diff(*n) <= APART);
        if let Some(&(n, b)) = second {
            new[m.min(n)] = None;
            new[m.max(n)] = Some(Stmt::Store(Store::Two(at, [a, b])));
        }
    }
    new.into_iter().flatten().collect()
}

/// Whether a place is an even column of a row of a matrix, and not the last one.
fn is_even_column(results: &[Array], at: usize) -> bool {
    let of = |array: &&Array| (array.start..array.start + array.numbers()).contains(&at);
    let Some(Array { start, lengths }) = results.iter().find(of) else { return false };
    let column = lengths.last().map_or(0, |row| (at - start) % row);
    lengths.len() > 1 && column.is_multiple_of(2) && column + 1 < lengths[lengths.len() - 1]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lir::{Expr, Operand, Temp};

    fn store(at: usize, id: usize) -> Stmt {
        Stmt::Store(Store::One(at, number(id)))
    }

    fn number(id: usize) -> Number {
        Number { of: Operand::Temp(Temp::of(id)), lane: 0 }
    }

    fn input(id: usize) -> Stmt {
        Stmt::Let(Temp::of(id), Expr::Input { argument: 0, index: id as u32 })
    }

    /// A matrix of two rows of three columns, then a vector.
    fn results() -> Vec<Array> {
        vec![Array { start: 0, lengths: vec![2, 3] }, Array { start: 6, lengths: vec![4] }]
    }

    #[test]
    fn neighbours_are_stored_together_and_others_alone() {
        // Columns 2 and 3 of different rows, and those of a vector, stay alone.
        let alone = [store(2, 1), store(6, 1), store(7, 1)];
        let statements = [vec![input(1), store(4, 1), input(2), store(3, 2)], alone.to_vec()].concat();
        let pair = Stmt::Store(Store::Two(3, [number(2), number(1)]));
        let expected = [vec![input(1), input(2), pair], alone.to_vec()].concat();
        assert_eq!(pair_stores(statements, &results()), expected);
    }

    #[test]
    fn what_is_made_long_after_is_stored_alone() {
        let mut statements = vec![store(0, 0)];
        statements.extend((1..=APART).map(input));
        statements.push(store(1, 1));
        assert_eq!(pair_stores(statements.clone(), &results()), statements);
    }
}
