//! The report for people.

use std::fmt::Write;

use super::report::Report;
use super::row::Row;
use crate::table::{Table, WIDTH, counted, number, plain, wrapped};

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
    out += &legend(&out);
    report.notes.iter().for_each(|note| out += &wrapped(&format!("note: {}\n", plain(note))));
    let _ = writeln!(out, "{}, {rows_failed} beyond their limits", counted(*rows_measured, "row"));
    out
}

/// The meaning of letters and names, each with its mark in the tables.
const LEGEND: [(&str, &str); 6] = [
    (
        " u  ",
        "u: the rounding of one operation relative to its result, 2⁻⁵³ of f64 and 2⁻²⁴ of f32; of errors, times the magnitudes of the terms",
    ),
    (" ulp  ", "ulp: the distance of the exact result to the next number"),
    (
        "η",
        "η: backward error, how far the torques that the accelerations need are from those given, over the sum of the magnitudes of their terms",
    ),
    ("κ₂", "κ₂(M): the condition number of the mass matrix M in the 2-norm; an error over it is in units of u κ₂(M)"),
    ("LTDL", "LTDL: by the factors of the mass matrix, M = Lᵀ D L"),
    ("ABA", "ABA: by the articulated-body algorithm, which forms no mass matrix"),
];

/// The lines for the marks in the tables, and an empty one.
fn legend(tables: &str) -> String {
    let lines: String = LEGEND.iter().filter(|(mark, _)| tables.contains(mark)).map(|(_, line)| wrapped(&format!("{line}\n"))).collect();
    if lines.is_empty() { lines } else { lines + "\n" }
}

/// Maximum width of a table's first column.
const FIRST: usize = 60;

fn table(rows: &[Row], all: bool) -> String {
    let mut table = Table::new([("  case", ""), ("measured", ""), ("limit", ""), ("unit", ""), ("", "")]).first_within(FIRST);
    let mut rest = rows;
    while let Some(first) = rest.first() {
        let count = rest.iter().take_while(|r| r.case == first.case).count();
        let (case, after) = rest.split_at(count);
        heading(first).lines().for_each(|line| table.heading(line));
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

/// The case and why it is hard, on lines of their own where one is too short.
fn heading(row: &Row) -> String {
    let (case, why) = (plain(&row.case), plain(row.why));
    let one = format!("  {case} ({why})");
    if one.chars().count() <= WIDTH { one } else { wrapped(&format!("  {case}\n  ({why})")) }
}

/// How near to its limit.
fn part(row: &Row) -> f64 {
    match row.limit {
        Some(0.0) | None => row.measured,
        Some(limit) => row.measured / limit,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stress::row::Case;

    fn report(rows: Vec<Row>) -> Report {
        Report { pass: true, rows_measured: rows.len(), rows_failed: 0, notes: Vec::new(), rows }
    }

    #[test]
    fn no_line_is_longer_than_a_page_is_wide() {
        let why = "masses fall by 8 and lengths by 2 from link to link, so that κ(M) grows as 32 to the number of rods";
        let case = Case::new("chains", "25 rods, each half as long as the one before", why);
        let long = "solve_mass_matrix by LTDL, error over ‖M⁻¹‖₂‖terms of M‖₂, scaled to a diagonal of ones, f32";
        let text = text(&report(vec![case.row(long, 0.5, 4.0, "u"), case.row("forward_dynamics by ABA, η, f64", 1.0, 64.0, "u")]), true);
        assert!(text.lines().all(|l| l.chars().count() <= WIDTH), "{text}");
        assert!(text.contains("\n  25 rods, each half as long as the one before\n  (masses fall"), "{text}");
        assert!(text.contains(&format!("\n    {long}\n")), "{text}");
    }

    #[test]
    fn what_is_in_the_tables_is_explained_and_nothing_else() {
        let case = Case::new("chains", "a", "b");
        let text = |what: &str, unit| text(&report(vec![case.row(what, 0.5, 4.0, unit)]), true);
        let solved = text("forward_dynamics by LTDL, η, f64", "u");
        assert!(
            ["\nu: ", "\nη: ", "\nLTDL: "].iter().all(|line| solved.contains(line)) && !solved.contains("ABA") && !solved.contains("κ₂")
        );
        let plain = text("is finite", "wrong");
        assert!(plain.ends_with("pass\n\n1 row, 0 beyond their limits\n"), "{plain}");
        assert!(text("error over κ₂(M)", "u").contains("\nκ₂(M): "));
    }
}
