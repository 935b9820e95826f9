//! A recording as a table: columns with titles and units, and their file.

use super::recording::{Named, Recording};
use crate::table::plain;

/// A column of a table of a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Its title, as `q.elbow`.
    pub title: String,
    /// Its unit; empty for a number without one.
    pub unit: String,
    /// A number for each time.
    pub values: Vec<f64>,
}

const MOMENTUM: [&str; 6] = ["angular.x", "angular.y", "angular.z", "linear.x", "linear.y", "linear.z"];

/// `t`, `q.<joint>`, `v.<joint>`, `tau.<joint>`, the energies, and the momentum. Control characters
/// in names are escaped.
pub(super) fn columns(r: &Recording) -> Vec<Column> {
    let one = |title: &str, unit: &str, values: Vec<f64>| Column { title: title.to_owned(), unit: unit.to_owned(), values };
    let mut all = vec![one("t", "s", r.t.clone())];
    for (letter, names, rows) in [("q", &r.q_names, &r.q), ("v", &r.v_names, &r.v), ("tau", &r.tau_names, &r.tau)] {
        let column = |(k, n): (usize, &Named)| one(&format!("{letter}.{}", plain(&n.name)), n.unit, r.series(names, rows, k));
        all.extend(names.iter().enumerate().map(column));
    }
    all.push(one("kinetic_energy", "J", r.kinetic.clone()));
    all.push(one("potential_energy", "J", r.potential.clone()));
    all.push(one("work", "J", r.work.clone()));
    all.push(one("dissipated", "J", r.dissipated.clone()));
    all.push(one("from_events", "J", r.from_events.clone()));
    all.push(one("imbalance", "J", r.imbalance()));
    for (k, name) in MOMENTUM.into_iter().enumerate() {
        let unit = if k < 3 { "kg·m²/s" } else { "kg·m/s" };
        all.push(one(&format!("momentum.{name}"), unit, r.momentum.iter().map(|p| p[k]).collect()));
    }
    all
}

/// Comma-separated values, a row for each time. Every number reads back as the same double.
pub(super) fn csv(columns: &[Column]) -> String {
    let quoted = |title: &str| match title.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", title.replace('"', "\"\"")),
        false => title.to_owned(),
    };
    let line = |cell: &dyn Fn(&Column) -> String| columns.iter().map(cell).collect::<Vec<_>>().join(",") + "\n";
    let rows = columns.first().map_or(0, |c| c.values.len());
    let head = line(&|c| quoted(&c.title));
    (0..rows).fold(head, |text, k| text + &line(&|c| format!("{:?}", c.values[k])))
}

#[cfg(test)]
mod tests {
    use articulated_lab::states::exact::doubles;

    use super::super::recording::example;
    use super::*;
    use crate::robot::bundled_model;

    #[test]
    fn numbers_read_back_and_titles_are_quoted_where_they_must_be() {
        let column = |title: &str, values: [f64; 2]| Column { title: title.into(), unit: String::new(), values: values.into() };
        let written = csv(&[column("t", [0.1 + 0.2, 1e-300]), column("q.a,b", [-0.0, 1e300])]);
        assert_eq!(written, "t,\"q.a,b\"\n0.30000000000000004,-0.0\n1e-300,1e300\n");
    }

    #[test]
    fn every_number_reads_back_as_the_same_double() {
        let doubles = doubles();
        let written = csv(&[Column { title: "t".into(), unit: String::new(), values: doubles.clone() }]);
        let read: Vec<f64> = written.lines().skip(1).map(|line| line.parse().unwrap()).collect();
        assert!(read.len() == doubles.len() && read.iter().zip(&doubles).all(|(a, b)| a.to_bits() == b.to_bits()));
    }

    #[test]
    fn a_row_a_time_and_a_column_a_name() {
        let written = csv(&columns(&example(&bundled_model("quadruped"), 5)));
        let lines: Vec<&str> = written.lines().collect();
        assert_eq!(lines.len(), 6);
        assert!(lines[0].starts_with("t,q.__floating_base__[0],q.__floating_base__[1]"), "{}", lines[0]);
        assert!(lines.iter().all(|l| l.split(',').count() == 1 + 19 + 18 + 18 + 6 + 6));
    }
}
