//! A recording as columns with titles and units, for files.

use super::recording::{Named, Recording};
use crate::table::plain;

/// A column of a file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Column {
    pub(super) title: String,
    pub(super) unit: String,
    pub(super) values: Vec<f64>,
}

const MOMENTUM: [&str; 6] = ["angular.x", "angular.y", "angular.z", "linear.x", "linear.y", "linear.z"];

/// `t`, `q.<joint>`, `v.<joint>`, `tau.<joint>`, the energies, and the momentum. What of a name a
/// terminal would obey is escaped.
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
