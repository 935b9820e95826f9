//! Torques from a table.

use articulated_core::control::{Interpolation, Series};

use super::{Control, Dependence};
use crate::simulate::{SimulateError, StateError};

/// Torques at given times, linear between them, held before the first and after the last.
#[derive(Clone, Debug, PartialEq)]
pub struct TorqueTable {
    series: Series,
    nv: usize,
}

impl TorqueTable {
    /// times: `[n]`, s, each later than the one before; rows: `[n][nv]`, N·m|N. Errors: all
    /// mistakes.
    pub fn new(times: Vec<f64>, rows: &[f64], nv: usize) -> Result<Self, SimulateError> {
        let rows = rows.chunks(nv.max(1)).map(<[f64]>::to_vec).collect();
        let series = Series { times, rows, between: Interpolation::Linear };
        StateError::none(StateError::of_table("torques", &series, nv))?;
        Ok(Self { series, nv })
    }
}

impl Control for TorqueTable {
    fn torques(&mut self, t: f64, _: &[f64], _: &[f64], tau: &mut [f64]) {
        self.series.at(t, tau);
    }

    fn next_kink(&self, t: f64) -> f64 {
        self.series.next(t)
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
    use super::*;

    #[test]
    fn a_table_is_straight_between_its_rows_and_held_outside() {
        let mut table = TorqueTable::new(vec![1.0, 2.0, 4.0], &[0.0, 1.0, 10.0, 3.0, -10.0, 3.0], 2).unwrap();
        for (t, expected) in [(0.0, [0.0, 1.0]), (1.5, [5.0, 2.0]), (2.0, [10.0, 3.0]), (3.0, [0.0, 3.0]), (9.0, [-10.0, 3.0])] {
            let mut tau = [0.0; 2];
            table.torques(t, &[], &[], &mut tau);
            assert_eq!(tau, expected, "{t}");
        }
        assert_eq!([0.0, 1.0, 2.5, 4.0].map(|t| table.next_kink(t)), [1.0, 2.0, 4.0, f64::INFINITY]);
    }

    #[test]
    fn everything_wrong_with_a_table_is_named() {
        let told = |times: &[f64], rows: &[f64]| TorqueTable::new(times.to_vec(), rows, 1).unwrap_err().to_string();
        assert_eq!(told(&[], &[]), "torques: the table has no row");
        let expected = [
            "torques: rows of the table: found 1, expected 3, one for each time",
            "torques: row 2 of the table has a number that is not finite",
            "torques: row 1 of the table: t = 0 s is not after 0 s",
        ];
        assert_eq!(told(&[0.0, 0.0, f64::NAN], &[1.0]).lines().collect::<Vec<_>>(), expected);
    }
}
