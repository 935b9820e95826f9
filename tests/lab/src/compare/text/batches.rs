//! The table of functions of many states at once.

use super::super::report::Report;
use super::{nanoseconds, spread, times_of};
use crate::table::Table;

/// A row for each function, type and layout.
pub(super) fn batches(report: &Report) -> Table {
    let engines = report.engines();
    let titles = [("function", ""), ("numbers", ""), ("layout", ""), ("a state", "ns"), ("IQR", "ns"), ("generated/it", "ratio")];
    let peers = engines.iter().map(|engine| (format!("{engine}/it"), "ratio"));
    let columns = titles.map(|(title, unit)| (title.to_owned(), unit)).into_iter().chain(peers);
    let mut table = Table::new(columns.chain([("largest difference".to_owned(), "of magnitude")])).left(3);
    for (f, b) in report.functions.iter().flat_map(|f| f.batches.iter().map(move |b| (f, b))) {
        let mut cells = [f.function, b.numbers, b.layout].map(str::to_owned).to_vec();
        cells.extend([nanoseconds(b.time.median), nanoseconds(spread(&b.time)), times_of(b.generated_over_batch.median)]);
        cells.extend(engines.iter().map(|e| b.fastest_of(e).map_or_else(|| "–".into(), |p| times_of(p.peer_over_batch.median))));
        cells.push(b.largest_difference.map_or_else(|| "not compared".into(), |d| format!("{d:.1e}")));
        table.row(cells);
    }
    table
}
