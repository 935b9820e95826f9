//! The measurements for people.

use std::fmt::Write;

use super::report::{Crossover, Growth, Point, Report};
use crate::table::{Table, counted, number, wrapped};
use crate::timing::Summary;

pub(super) fn text(report: &Report) -> String {
    let mut out = format!(
        "serial arms of revolute joints; {} {}\n{}, {}; before an evaluation with cold caches {} MiB are written to and {} instructions run\n",
        report.compiler,
        report.flags,
        counted(report.states, "random state"),
        counted(report.repetitions as usize, "repetition"),
        report.buffer_bytes >> 20,
        report.filler_instructions
    );
    report.notes.iter().for_each(|note| out += &format!("note: {note}\n"));
    out = wrapped(&out);
    for (function, points) in report.functions() {
        let _ = write!(out, "\n{function}\n{}", table(&points).text());
    }
    let crossovers: String = report.crossovers.iter().map(|c| crossover(c) + "\n").collect();
    let growth: String = report.growth.iter().map(|g| self::growth(g) + "\n").collect();
    out + "\n" + &wrapped(&(LEGEND.to_owned() + "\n" + &crossovers + &growth))
}

const LEGEND: &str = "\
Times are medians of a call. Hot: again and again; cold: each call after everything was driven out of the caches.
instructions: of generated code (a multiply-add is one; sines and cosines apart); code: its machine code; generation: from the URDF's text to the source; rustc: start and \
linking included. Beside a number of joints stand the ways of computing that the generator chose by count.
";

/// Titles and units of the columns of a chain; the last row is [`cells`].
pub(super) const COLUMNS: [(&str, &str); 12] = [
    ("joints", ""),
    ("generated, hot", "µs"),
    ("generic, hot", "µs"),
    ("generated, cold", "µs"),
    ("generic, cold", "µs"),
    ("generated, hot", "ns per joint"),
    ("generated, cold", "ns per joint"),
    ("instructions", "per joint"),
    ("code", "bytes per joint"),
    ("generation", "ms"),
    ("rustc", "s"),
    ("rustc", "ms per joint"),
];

/// One row, as many as [`COLUMNS`].
pub(super) fn cells(p: &Point) -> Vec<String> {
    let n = p.joints as f64;
    let us = |s: &Summary| three(s.median * 1e-3);
    let joints = if p.ways.is_empty() { p.joints.to_string() } else { format!("{} {}", p.joints, p.ways.join(", ")) };
    vec![
        joints,
        us(&p.generated_hot),
        us(&p.generic_hot),
        us(&p.generated_cold),
        us(&p.generic_cold),
        three(p.generated_hot.median / n),
        three(p.generated_cold.median / n),
        three(p.instructions as f64 / n),
        p.code_bytes.map_or_else(|| "–".into(), |bytes| three(bytes as f64 / n)),
        three(p.generation_seconds * 1e3),
        three(p.compilation_seconds),
        three(p.compilation_seconds * 1e3 / n),
    ]
}

fn table(points: &[&Point]) -> Table {
    let mut table = Table::new(COLUMNS);
    points.iter().for_each(|p| table.row(cells(p)));
    table
}

/// Three digits, or all before the point.
fn three(x: f64) -> String {
    let places = (2.0 - x.abs().max(1e-9).log10().floor()).clamp(0.0, 6.0) as usize;
    number(format!("{x:.places$}").parse().unwrap_or(x))
}

/// From which length on generic code is faster, as a sentence.
pub(super) fn crossover(c: &Crossover) -> String {
    let faster = |n: Option<f64>| match n {
        None => format!("generated code is faster up to {}", counted(c.up_to, "joint")),
        Some(n) => format!("generic code is faster from {} on", counted(n.round() as usize, "joint")),
    };
    format!("{}: with hot caches {}; with cold ones {}", c.function, faster(c.hot), faster(c.cold))
}

/// By how much a joint's costs grow, as a sentence.
pub(super) fn growth(g: &Growth) -> String {
    format!(
        "{}: from {} to {}, time per joint with hot caches changes by a factor of {:.1}, generation by {:.1}, compilation by {:.1}",
        g.function,
        g.from,
        counted(g.to, "joint"),
        g.time,
        g.generation,
        g.compilation
    )
}
