//! The corpus of hard cases: every row of every chapter keeps its limit. `articulated stress`
//! prints the same rows as a report.

mod checked;
mod generated;
mod hostile;
mod monitors;

use articulated_lab::stress::corpus::{CHAPTERS, Effort};
use articulated_lab::stress::row::Row;

fn chapter(name: &str) {
    let (_, rows) = CHAPTERS.iter().find(|(n, _)| *n == name).expect("a chapter of the corpus");
    hold(&rows(Effort::Quick));
}

/// Every row keeps its limit. The variable SHOW prints them all.
fn hold(rows: &[Row]) {
    let show = std::env::var_os("SHOW").is_some();
    let line = |r: &Row| format!("{}: {}: found {:.3e} {}, limit {:?}", r.case, r.what, r.measured, r.unit, r.limit);
    if show {
        rows.iter().for_each(|r| println!("{} {}", if r.pass { "ok " } else { "BAD" }, line(r)));
    }
    let failed: Vec<String> = rows.iter().filter(|r| !r.pass).map(line).collect();
    assert!(failed.is_empty(), "{} of {} rows:\n{}", failed.len(), rows.len(), failed.join("\n"));
}

#[test]
fn chains() {
    chapter("chains");
}

#[test]
fn masses() {
    chapter("masses");
}

#[test]
fn inertias() {
    chapter("inertias");
}

#[test]
fn scaling() {
    chapter("scaling");
}

#[test]
fn axes() {
    chapter("axes");
}

#[test]
fn screws() {
    chapter("screws");
}

#[test]
fn turns() {
    chapter("turns");
}

#[test]
fn passes() {
    chapter("passes");
}

#[test]
fn stiff() {
    chapter("stiff");
}

#[test]
fn motions() {
    chapter("motions");
}
