//! The report for people.

use std::fmt::Write;

use super::command::Report;
use super::row::Row;
use crate::table::{Table, number, plain};

/// A line a case, with the measurement that comes nearest to its limit; or all rows.
pub(super) fn text(report: &Report, all: bool) -> String {
    let mut out = String::new();
    let mut rest = &report.rows[..];
    while let Some(first) = rest.first() {
        let count = rest.iter().take_while(|r| r.chapter == first.chapter).count();
        let (chapter, after) = rest.split_at(count);
        let _ = writeln!(out, "{}", plain(first.chapter));
        out += &table(chapter, all);
        out.push('\n');
        rest = after;
    }
    let Report { rows_measured, rows_failed, .. } = report;
    let _ = writeln!(out, "{rows_measured} rows, {rows_failed} beyond their limits");
    out
}

fn table(rows: &[Row], all: bool) -> String {
    let mut table = Table::new([("  case", ""), ("measured", ""), ("limit", ""), ("unit", ""), ("", "")]);
    let mut rest = rows;
    while let Some(first) = rest.first() {
        let count = rest.iter().take_while(|r| r.case == first.case).count();
        let (case, after) = rest.split_at(count);
        table.heading(&format!("  {} ({})", first.case, first.why));
        let wrong = case.iter().filter(|r| !r.pass);
        let worst = case.iter().filter(|r| r.limit.is_some()).max_by(|a, b| part(a).total_cmp(&part(b)));
        let shown: Vec<&Row> = match all {
            true => case.iter().collect(),
            false if case.iter().any(|r| !r.pass) => wrong.collect(),
            false => worst.into_iter().collect(),
        };
        for row in shown {
            let limit = row.limit.map_or(String::new(), number);
            let verdict = if row.limit.is_none() {
                ""
            } else if row.pass {
                "pass"
            } else {
                "FAIL"
            };
            table.row([format!("    {}", row.what), number(row.measured), limit, row.unit.to_owned(), verdict.to_owned()]);
        }
        rest = after;
    }
    table.text()
}

/// How near to its limit.
fn part(row: &Row) -> f64 {
    match row.limit {
        Some(0.0) | None => row.measured,
        Some(limit) => row.measured / limit,
    }
}
