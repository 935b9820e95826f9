//! What drives the joints, as data in the order of a robot: as scenes have it, and as simulations
//! follow it.

use alloc::vec::Vec;
use core::fmt;

/// What drives the joints.
#[derive(Clone, Debug, PartialEq)]
pub enum Controller {
    /// No torque.
    None,
    /// The same torques all the time, `[nv]`.
    Torque(Vec<f64>),
    /// Torques over time, `[nv]` a row.
    Table(Series),
    /// τ = kp (target ⊖ q) + kd (target' − v) + torque.
    Pd {
        /// Where to.
        target: Aim,
        /// `[nv]`, N·m/rad or N/m.
        kp: Vec<f64>,
        /// `[nv]`, N·m·s/rad or N·s/m.
        kd: Vec<f64>,
        /// `[nv]`, N·m or N.
        torque: Vec<f64>,
    },
}

/// What a controller aims at.
#[derive(Clone, Debug, PartialEq)]
pub enum Aim {
    /// Coordinates that do not change, `[nq]`.
    Still(Vec<f64>),
    /// Coordinates over time, `[nq]` a row.
    Moving(Series),
}

/// Numbers over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// Times in order, s.
    pub times: Vec<f64>,
    /// One row a time, each as long as q or v; quaternions have norm one.
    pub rows: Vec<Vec<f64>>,
    /// Each row holds until the next; otherwise linear between them.
    pub hold: bool,
}

impl Series {
    /// The numbers at the time `t`, each by itself (a quaternion is none between two rows); before
    /// the first row and after the last the nearest of them.
    pub fn at(&self, t: f64, out: &mut [f64]) {
        if let Some(([since, span], [from, to])) = self.between(t) {
            let part = since / span;
            out.iter_mut().zip(from.iter().zip(to)).for_each(|(out, (a, b))| *out = a + part * (b - a));
        } else if let Some(row) = self.rows.get(self.after(t).saturating_sub(1)) {
            out.iter_mut().zip(row).for_each(|(out, x)| *out = *x);
        }
    }

    /// Of the rows around `t`, if it is between two that are joined by a straight way: the time
    /// since the first, s, that between them; and both.
    pub fn between(&self, t: f64) -> Option<([f64; 2], [&[f64]; 2])> {
        let next = self.after(t);
        let before = next.checked_sub(1).filter(|_| !self.hold)?;
        let begin = self.times[before];
        Some(([t - begin, self.times.get(next)? - begin], [self.rows.get(before)?, self.rows.get(next)?]))
    }

    /// The first of the times after `t`, s: infinite behind the last.
    pub fn next(&self, t: f64) -> f64 {
        self.times.get(self.after(t)).copied().unwrap_or(f64::INFINITY)
    }

    fn after(&self, t: f64) -> usize {
        self.times.partition_point(|x| *x <= t)
    }

    /// Everything that is wrong with it as a table of rows of so many numbers.
    pub fn problems(&self, width: usize) -> Vec<TableError> {
        let (Self { times, rows, .. }, mut wrong) = (self, Vec::new());
        if times.is_empty() {
            wrong.push(TableError::Empty);
        }
        if rows.len() != times.len() {
            wrong.push(TableError::Rows { found: rows.len(), expected: times.len() });
        }
        let other = rows.iter().enumerate().filter(|(_, row)| row.len() != width);
        wrong.extend(other.map(|(row, x)| TableError::Width { row, found: x.len(), expected: width }));
        let row = |k: usize| rows.get(k).map_or(&[][..], Vec::as_slice);
        let bad = (0..times.len()).filter(|&k| !times[k].is_finite() || row(k).iter().any(|x| !x.is_finite()));
        wrong.extend(bad.map(|row| TableError::NotFinite { row }));
        let order = times.windows(2).enumerate().filter(|(_, w)| w[1] <= w[0]);
        wrong.extend(order.map(|(k, w)| TableError::Order { row: k + 1, found: w[1], before: w[0] }));
        wrong
    }
}

/// What is wrong with a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TableError {
    /// It has no row.
    Empty,
    /// The numbers of rows and times differ.
    Rows {
        /// How many rows there are.
        found: usize,
        /// How many times.
        expected: usize,
    },
    /// A row has the wrong length.
    Width {
        /// Which row, from 0.
        row: usize,
        /// How many numbers it has.
        found: usize,
        /// How many it should have.
        expected: usize,
    },
    /// A number is not finite.
    NotFinite {
        /// In which row, from 0.
        row: usize,
    },
    /// A time is not later than the one before.
    Order {
        /// In which row, from 0.
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
            Self::Rows { found, expected } => write!(f, "rows of the table: found {found}, expected {expected}, one for each time"),
            Self::Width { row, found, expected } => write!(f, "row {row} of the table has {found} numbers, expected {expected}"),
            Self::NotFinite { row } => write!(f, "row {row} of the table has a number that is not finite"),
            Self::Order { row, found, before } => write!(f, "row {row} of the table: t = {found} s is not after {before} s"),
        }
    }
}

impl core::error::Error for TableError {}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use super::*;

    #[test]
    fn numbers_are_linear_between_rows_or_held_and_hold_at_the_ends() {
        let series = |hold| Series { times: vec![0.0, 1.0, 3.0], rows: vec![vec![1.0], vec![3.0], vec![-1.0]], hold };
        let at = |hold, t| {
            let mut out = [f64::NAN];
            series(hold).at(t, &mut out);
            out[0]
        };
        assert_eq!([-1.0, 0.0, 0.5, 1.0, 2.0, 3.0, 9.0].map(|t| at(false, t)), [1.0, 1.0, 2.0, 3.0, 1.0, -1.0, -1.0]);
        assert_eq!([-1.0, 0.5, 1.0, 2.9, 3.0, 9.0].map(|t| at(true, t)), [1.0, 1.0, 3.0, 3.0, -1.0, -1.0]);
    }

    #[test]
    fn a_row_of_another_length_is_named() {
        let series = Series { times: vec![0.0, 1.0], rows: vec![vec![1.0], vec![]], hold: false };
        assert_eq!(series.problems(1), [TableError::Width { row: 1, found: 0, expected: 1 }]);
    }

    #[test]
    fn a_table_that_cannot_be_followed_says_why() {
        let problems = |times: &[f64], rows: &[f64]| {
            Series { times: times.to_vec(), rows: rows.iter().map(|x| vec![*x]).collect(), hold: true }.problems(1)
        };
        assert_eq!(problems(&[0.0, 1.0], &[1.0, 2.0]), []);
        assert_eq!(problems(&[], &[]), [TableError::Empty]);
        assert_eq!(problems(&[0.0, 1.0], &[1.0]), [TableError::Rows { found: 1, expected: 2 }]);
        assert_eq!(problems(&[0.0], &[1.0, 2.0]), [TableError::Rows { found: 2, expected: 1 }]);
        assert_eq!(problems(&[0.0, f64::INFINITY], &[1.0, 2.0]), [TableError::NotFinite { row: 1 }]);
        assert_eq!(problems(&[0.0, 1.0], &[f64::NAN, 2.0]), [TableError::NotFinite { row: 0 }]);
        for found in [1.0, 0.5] {
            assert_eq!(problems(&[0.0, 1.0, found], &[1.0; 3]), [TableError::Order { row: 2, found, before: 1.0 }]);
        }
    }
}
