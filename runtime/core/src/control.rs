//! Controllers of joints, as data in the order of a robot: as scenes contain them, and as
//! simulations use them.

use alloc::vec;
use alloc::vec::Vec;
use core::fmt;

use crate::actuator::Actuators;

/// A controller of the joints.
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
    /// Forces of actuators.
    Actuators {
        /// The actuators.
        actuators: Actuators,
        /// The controls u, a number for each of them.
        controls: Signal,
    },
}

/// Numbers that may change over time.
#[derive(Clone, Debug, PartialEq)]
pub enum Signal {
    /// They do not change.
    Still(Vec<f64>),
    /// One row a time.
    Moving(Series),
}

impl Default for Signal {
    fn default() -> Self {
        Self::Still(Vec::new())
    }
}

/// The target of a controller.
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
    /// The numbers between two rows.
    pub between: Interpolation,
}

/// The numbers between two rows of a table.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Interpolation {
    /// Linear.
    #[default]
    Linear,
    /// Each row holds until the next.
    Hold,
    /// A cubic spline with two continuous derivatives, and rates of zero at its ends:
    /// [`Interpolation::cubic`] makes it. The rates at the rows, each as long as a row.
    Cubic(Vec<Vec<f64>>),
}

impl Interpolation {
    /// The cubic spline of a table without [`Series::problems`]; linear for other tables.
    ///
    /// ```text
    /// m₀ = mₙ = 0,   mᵢ₋₁/hᵢ₋₁ + 2 mᵢ (1/hᵢ₋₁ + 1/hᵢ) + mᵢ₊₁/hᵢ = 3 (δᵢ₋₁/hᵢ₋₁ + δᵢ/hᵢ)
    /// ```
    ///
    /// hᵢ: time from row i to the next; δᵢ: mean rate there; mᵢ: rate at row i.
    pub fn cubic(times: &[f64], rows: &[Vec<f64>]) -> Self {
        let (n, width) = (times.len(), rows.first().map_or(0, Vec::len));
        if n == 0 || rows.len() != n || rows.iter().any(|row| row.len() != width) {
            return Self::Linear;
        }
        let h = |i: usize| times[i + 1] - times[i];
        let mut slopes = vec![vec![0.0; width]; n];
        // Gaussian elimination of a symmetric matrix of three diagonals, with dominant pivots.
        let mut pivots = vec![1.0; n];
        for i in 1..n.saturating_sub(1) {
            let below = if i > 1 { 1.0 / h(i - 1) / pivots[i - 1] } else { 0.0 };
            pivots[i] = 2.0 / h(i - 1) + 2.0 / h(i) - below / h(i - 1);
            for k in 0..width {
                let mean = |i: usize| (rows[i + 1][k] - rows[i][k]) / h(i);
                slopes[i][k] = 3.0 * (mean(i - 1) / h(i - 1) + mean(i) / h(i)) - below * slopes[i - 1][k];
            }
        }
        for i in (1..n.saturating_sub(1)).rev() {
            let (head, tail) = slopes.split_at_mut(i + 1);
            head[i].iter_mut().zip(&tail[0]).for_each(|(slope, next)| *slope = (*slope - next / h(i)) / pivots[i]);
        }
        Self::Cubic(slopes)
    }
}

impl Series {
    /// The numbers at the time `t`, each by itself (between two rows, a quaternion is not a unit
    /// one). Before the first row and after the last, those of the nearest row.
    pub fn at(&self, t: f64, out: &mut [f64]) {
        if let Some(piece) = self.piece(t) {
            out.iter_mut().enumerate().for_each(|(k, out)| *out = piece.at(k)[0]);
        } else if let Some(([since, span], [from, to])) = self.between(t) {
            let part = since / span;
            out.iter_mut().zip(from.iter().zip(to)).for_each(|(out, (a, b))| *out = a + part * (b - a));
        } else if let Some(row) = self.rows.get(self.after(t).saturating_sub(1)) {
            out.iter_mut().zip(row).for_each(|(out, x)| *out = *x);
        }
    }

    /// If `t` is between two rows with linear interpolation: the time since the first, and the time
    /// between them, s; and both rows.
    pub fn between(&self, t: f64) -> Option<([f64; 2], [&[f64]; 2])> {
        let next = self.after(t);
        let before = next.checked_sub(1).filter(|_| self.between == Interpolation::Linear)?;
        let begin = self.times[before];
        Some(([t - begin, self.times.get(next)? - begin], [self.rows.get(before)?, self.rows.get(next)?]))
    }

    /// The rates at the time `t` of a cubic spline; false for other tables.
    pub fn rates(&self, t: f64, out: &mut [f64]) -> bool {
        match self.piece(t) {
            Some(piece) => out.iter_mut().enumerate().for_each(|(k, out)| *out = piece.at(k)[1]),
            None => out.fill(0.0),
        }
        matches!(self.between, Interpolation::Cubic(_))
    }

    /// The piece of a cubic spline around `t`; `None` outside of the table, and for other tables.
    fn piece(&self, t: f64) -> Option<Piece<'_>> {
        let Interpolation::Cubic(slopes) = &self.between else { return None };
        let next = self.after(t);
        let before = next.checked_sub(1)?;
        let (begin, end) = (self.times[before], self.times.get(next)?);
        let (rows, slopes) = ([self.rows.get(before)?, self.rows.get(next)?], [slopes.get(before)?, slopes.get(next)?]);
        Some(Piece { part: (t - begin) / (end - begin), span: end - begin, rows, slopes })
    }

    /// The first of the times after `t` at which the numbers or their first two derivatives jump,
    /// s: infinite after the last. A cubic spline has its ends alone.
    pub fn next(&self, t: f64) -> f64 {
        let next = self.after(t);
        let next = match self.between {
            Interpolation::Cubic(_) if next > 0 && next < self.times.len() => self.times.len() - 1,
            _ => next,
        };
        self.times.get(next).copied().unwrap_or(f64::INFINITY)
    }

    fn after(&self, t: f64) -> usize {
        self.times.partition_point(|x| *x <= t)
    }

    /// All errors of it as a table with rows of `width` numbers.
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

/// A cubic polynomial between two rows, by their numbers and their rates.
struct Piece<'a> {
    /// From 0 to 1.
    part: f64,
    /// The time between the rows, s.
    span: f64,
    rows: [&'a Vec<f64>; 2],
    slopes: [&'a Vec<f64>; 2],
}

impl Piece<'_> {
    /// Number `k` and its rate.
    fn at(&self, k: usize) -> [f64; 2] {
        let of = |list: &[f64]| list.get(k).copied().unwrap_or(0.0);
        let (s, h) = (self.part, self.span);
        let ([a, b], [m, n]) = (self.rows.map(|row| of(row)), self.slopes.map(|row| of(row)));
        // x = a + s (h m + s (c + s d))
        let (c, d) = (3.0 * (b - a) - h * (2.0 * m + n), h * (m + n) - 2.0 * (b - a));
        [a + s * (h * m + s * (c + s * d)), m + s * (2.0 * c + 3.0 * s * d) / h]
    }
}

/// An error of a table.
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
    use super::*;

    #[test]
    fn numbers_are_linear_between_rows_or_held_and_hold_at_the_ends() {
        let between = |hold| if hold { Interpolation::Hold } else { Interpolation::Linear };
        let series = |hold| Series { times: vec![0.0, 1.0, 3.0], rows: vec![vec![1.0], vec![3.0], vec![-1.0]], between: between(hold) };
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
        let series = Series { times: vec![0.0, 1.0], rows: vec![vec![1.0], vec![]], between: Interpolation::Linear };
        assert_eq!(series.problems(1), [TableError::Width { row: 1, found: 0, expected: 1 }]);
    }

    /// The table, zero rates at its ends, two continuous derivatives, and a cubic in between.
    #[test]
    fn a_cubic_spline_goes_through_its_rows_without_kinks() {
        let times = vec![0.0, 0.5, 1.5, 1.75, 3.0];
        let rows: Vec<Vec<f64>> = [[1.0, 0.0], [3.0, 1.0], [-1.0, 0.5], [0.0, 0.5], [2.0, -2.0]].map(|row| row.to_vec()).into();
        let series = Series { between: Interpolation::cubic(&times, &rows), times, rows };
        let at = |t: f64| {
            let (mut x, mut rate) = ([f64::NAN; 2], [f64::NAN; 2]);
            series.at(t, &mut x);
            assert!(series.rates(t, &mut rate));
            (x, rate)
        };
        for (t, row) in series.times.iter().zip(&series.rows) {
            assert_eq!(at(*t).0.as_slice(), row.as_slice());
        }
        assert!([0.0, 3.0, -1.0, 9.0].iter().all(|t| at(*t).1 == [0.0; 2]));
        assert_eq!((at(-1.0).0, at(9.0).0), ([1.0, 0.0], [2.0, -2.0]));
        let h = 1e-5;
        for t in [0.1, 0.5, 1.0, 1.5, 1.75, 2.9] {
            for k in 0..2 {
                let difference = (at(t + h).0[k] - at(t - h).0[k]) / (2.0 * h);
                assert!((difference - at(t).1[k]).abs() < 1e-7, "{t} {k}");
                // The second derivative from either side.
                let [left, right] = [-h, h].map(|h| (at(t + h).1[k] - at(t).1[k]) / h);
                assert!((left - right).abs() < 1e-2, "{t} {k}: {left} {right}");
            }
        }
        assert_eq!([-1.0, 0.0, 0.7, 2.0, 3.0].map(|t| series.next(t)), [0.0, 3.0, 3.0, 3.0, f64::INFINITY]);
        // A clamped cubic is its own spline: t² (3 − 2 t) on [0, 1].
        let times = vec![0.0, 0.3, 0.8, 1.0];
        let rows: Vec<Vec<f64>> = times.iter().map(|t| vec![t * t * (3.0 - 2.0 * t)]).collect();
        let series = Series { between: Interpolation::cubic(&times, &rows), times, rows };
        for k in 0..=20 {
            let (t, mut x) = (f64::from(k) / 20.0, [0.0]);
            series.at(t, &mut x);
            assert!((x[0] - t * t * (3.0 - 2.0 * t)).abs() < 1e-15);
        }
        assert_eq!(Interpolation::cubic(&[], &[]), Interpolation::Linear);
    }

    #[test]
    fn a_table_that_cannot_be_followed_says_why() {
        let problems = |times: &[f64], rows: &[f64]| {
            Series { times: times.to_vec(), rows: rows.iter().map(|x| vec![*x]).collect(), between: Interpolation::Hold }.problems(1)
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
