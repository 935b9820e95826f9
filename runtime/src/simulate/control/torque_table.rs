//! Torques from a table.

use std::fmt;

use super::{Control, Dependence};

/// Torques given at times, on straight lines between, held before the first and after the last.
#[derive(Clone, Debug, PartialEq)]
pub struct TorqueTable {
    times: Vec<f64>,
    rows: Vec<f64>,
    nv: usize,
}

/// What is wrong with a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TableError {
    /// It has no row.
    Empty,
    /// Its numbers are not `[times][nv]`.
    Length {
        /// How many numbers there are.
        found: usize,
        /// How many there should be.
        expected: usize,
    },
    /// A number is not finite.
    NotFinite {
        /// In which row.
        row: usize,
    },
    /// A time is not later than the one before.
    Order {
        /// In which row.
        row: usize,
        /// The time, s.
        found: f64,
        /// The time before, s.
        before: f64,
    },
}

impl fmt::Display for TableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => f.write_str("the table has no row"),
            Self::Length { found, expected } => write!(f, "the table has {found} torques, expected {expected}"),
            Self::NotFinite { row } => write!(f, "row {row} of the table has a number that is not finite"),
            Self::Order { row, found, before } => write!(f, "row {row} of the table: t = {found} s is not after {before} s"),
        }
    }
}

impl std::error::Error for TableError {}

/// All that is wrong with a table, a line each.
#[derive(Clone, Debug, PartialEq)]
pub struct TableErrors(pub Vec<TableError>);

impl std::ops::Deref for TableErrors {
    type Target = [TableError];

    fn deref(&self) -> &[TableError] {
        &self.0
    }
}

impl fmt::Display for TableErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().enumerate().try_for_each(|(k, one)| write!(f, "{}{one}", if k > 0 { "\n" } else { "" }))
    }
}

impl std::error::Error for TableErrors {}

impl TorqueTable {
    /// times: `[n]`, s, each later than the one before; rows: `[n][nv]`, N·m|N. Everything that is wrong.
    pub fn new(times: Vec<f64>, rows: Vec<f64>, nv: usize) -> Result<Self, TableErrors> {
        let (n, mut wrong) = (times.len(), Vec::new());
        if n == 0 {
            wrong.push(TableError::Empty);
        }
        if rows.len() != n * nv {
            wrong.push(TableError::Length { found: rows.len(), expected: n * nv });
        }
        let row = |k: usize| rows.get(k * nv..(k + 1) * nv).unwrap_or(&[]);
        let bad = (0..n).filter(|&k| !times[k].is_finite() || row(k).iter().any(|x| !x.is_finite()));
        wrong.extend(bad.map(|row| TableError::NotFinite { row }));
        let order = times.windows(2).enumerate().filter(|(_, w)| w[1] <= w[0]);
        wrong.extend(order.map(|(k, w)| TableError::Order { row: k + 1, found: w[1], before: w[0] }));
        if wrong.is_empty() { Ok(Self { times, rows, nv }) } else { Err(TableErrors(wrong)) }
    }

    fn row(&self, k: usize) -> &[f64] {
        &self.rows[k * self.nv..(k + 1) * self.nv]
    }
}

impl Control for TorqueTable {
    fn torques(&mut self, t: f64, _: &[f64], _: &[f64], tau: &mut [f64]) {
        let after = self.times.partition_point(|x| *x <= t);
        let last = self.times.len() - 1;
        if after == 0 || after > last {
            tau.iter_mut().zip(self.row(after.min(last))).for_each(|(tau, x)| *tau = *x);
            return;
        }
        let (from, to) = (self.times[after - 1], self.times[after]);
        let s = (t - from) / (to - from);
        let between = self.row(after - 1).iter().zip(self.row(after));
        tau.iter_mut().zip(between).for_each(|(tau, (a, b))| *tau = a + s * (b - a));
    }

    fn next_kink(&self, t: f64) -> f64 {
        self.times.get(self.times.partition_point(|x| *x <= t)).copied().unwrap_or(f64::INFINITY)
    }

    fn count(&self) -> Option<usize> {
        Some(self.nv)
    }

    fn depends_on(&self) -> Dependence {
        Dependence { time: true, state: false }
    }
}

#[cfg(test)]
mod tests {
    use super::{Control, TableError, TableErrors, TorqueTable};

    #[test]
    fn a_table_is_straight_between_its_rows_and_held_outside() {
        let mut table = TorqueTable::new(vec![1.0, 2.0, 4.0], vec![0.0, 1.0, 10.0, 3.0, -10.0, 3.0], 2).unwrap();
        for (t, expected) in [(0.0, [0.0, 1.0]), (1.5, [5.0, 2.0]), (2.0, [10.0, 3.0]), (3.0, [0.0, 3.0]), (9.0, [-10.0, 3.0])] {
            let mut tau = [0.0; 2];
            table.torques(t, &[], &[], &mut tau);
            assert_eq!(tau, expected, "{t}");
        }
        assert_eq!([0.0, 1.0, 2.5, 4.0].map(|t| table.next_kink(t)), [1.0, 2.0, 4.0, f64::INFINITY]);
    }

    #[test]
    fn everything_wrong_with_a_table_is_named() {
        assert_eq!(TorqueTable::new(vec![], vec![], 1), Err(TableErrors(vec![TableError::Empty])));
        let wrong = TorqueTable::new(vec![0.0, 0.0, f64::NAN], vec![1.0], 1).unwrap_err();
        assert!(wrong.contains(&TableError::Length { found: 1, expected: 3 }));
        assert!(wrong.contains(&TableError::Order { row: 1, found: 0.0, before: 0.0 }));
        assert!(wrong.contains(&TableError::NotFinite { row: 2 }));
    }
}
