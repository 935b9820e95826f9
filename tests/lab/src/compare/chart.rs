//! The medians as dots, in SVG: a panel for each function, a row for each contender, on a
//! logarithmic axis. A bar's length would be meaningless there.

use super::batch::BatchReport;
use super::report::{FunctionReport, Report};
use crate::plot::{Anchor, Axis, Drawing, GREY, GRID, INK, Text};
use crate::robot::named;
use crate::table::{counted, freedom};

/// A row: name, time in ns, ratio to generated code, and colour.
struct Row {
    label: String,
    time: f64,
    ratio: Option<f64>,
    colour: &'static str,
}

const WIDTH: f64 = 860.0;
/// From the left edge to the axis.
const LABELS: f64 = 250.0;
/// From the end of the axis to the right edge, for the numbers next to the dots.
const NUMBERS: f64 = 110.0;
/// The height of a row.
const ROW: f64 = 19.0;
const RADIUS: f64 = 5.0;
const SIZE: f64 = 12.0;
/// Above the rows of a function, its name.
const TITLE: f64 = 26.0;
const HEAD: f64 = 62.0;
const FOOT: f64 = 44.0;

const GENERATED: &str = "#1b6ca8";
const VARIANT: &str = "#7fb2d6";
const GENERIC: &str = "#8a8a8a";
/// Of engines, in turn.
const ENGINES: [&str; 6] = ["#d9822b", "#7a5195", "#3f8f5b", "#c2453f", "#b59f00", "#4a4a8a"];

/// The chart of all functions that were measured.
pub(super) fn svg(report: &Report) -> String {
    let panels: Vec<(&str, Vec<Row>)> = report.functions.iter().map(|f| (f.function, rows(report, f))).collect();
    let times = || panels.iter().flat_map(|(_, rows)| rows).map(|r| r.time).filter(|t| t.is_finite() && *t > 0.0);
    let axis = axis(times());
    let count: usize = panels.iter().map(|(_, rows)| rows.len()).sum();
    let bottom = HEAD + panels.len() as f64 * TITLE + count as f64 * ROW;
    let mut out = Drawing::new(WIDTH, bottom + FOOT);
    head(&mut out, report);
    out.ticks_below(&axis, &axis.decades(number), [HEAD + 4.0, bottom]);
    let about = "ns per call, median; logarithmic: equal ratios are equal distances";
    out.text([(LABELS + WIDTH - NUMBERS) / 2.0, bottom + 34.0], Anchor::Middle, SIZE, GREY, about);
    let mut y = HEAD;
    for (function, rows) in &panels {
        out.write(Text::new([12.0, y + TITLE - 8.0], Anchor::Start, SIZE, INK, function).bold());
        y += TITLE;
        for row in rows {
            draw(&mut out, &axis, row, y + ROW / 2.0);
            y += ROW;
        }
    }
    out.svg()
}

/// Of ns, between the names and the room for numbers.
fn axis(times: impl Iterator<Item = f64>) -> Axis {
    Axis::logarithmic(times, [LABELS, WIDTH - NUMBERS], 0.1)
}

/// Ours, and the fastest build of each engine.
fn rows(report: &Report, f: &FunctionReport) -> Vec<Row> {
    let mut rows = vec![Row { label: "generated".into(), time: f.generated.median, ratio: None, colour: GENERATED }];
    let row = |label: String, time: f64, ratio: f64, colour| Row { label, time, ratio: Some(ratio), colour };
    rows.extend(f.variants.iter().map(|v| row(format!("generated, {}", v.variant), v.time.median, v.over_generated.median, VARIANT)));
    let label = |b: &BatchReport| format!("{} {}, a state of many", b.numbers, b.layout);
    rows.extend(f.batches.iter().map(|b| row(label(b), b.time.median, 1.0 / b.generated_over_batch.median, VARIANT)));
    rows.push(row("generic".into(), f.generic.median, f.generic_over_generated.median, GENERIC));
    for (engine, colour) in report.engines().into_iter().zip(ENGINES.into_iter().cycle()) {
        let Some(peer) = f.fastest_of(engine) else { continue };
        let library = report.peers.iter().find(|p| p.peer == peer.peer).map(|p| &p.library);
        let fast = library.is_some_and(|l| l.flags.as_ref().is_some_and(|f| f.contains("-ffast-math")));
        let single = library.is_some_and(|l| l.element.as_deref() == Some("f32"));
        let compiler = library.and_then(|l| l.compiler.as_ref()).filter(|c| c.starts_with("g++") || c.starts_with("clang"));
        let notes: Vec<String> =
            compiler.cloned().into_iter().chain(fast.then(|| "fast-math".into())).chain(single.then(|| "f32".into())).collect();
        let label = if notes.is_empty() { engine.to_owned() } else { format!("{engine} ({})", notes.join(", ")) };
        rows.push(row(label, peer.time.median, 1.0 / peer.generated_over_peer.median, colour));
    }
    rows
}

fn head(out: &mut Drawing, report: &Report) {
    let title = format!("{}, {} base, {}", named(&report.robot, report.scene.as_deref()), report.base, freedom(report.degrees_of_freedom));
    out.write(Text::new([12.0, 22.0], Anchor::Start, 15.0, INK, &title).bold());
    let engines = if report.engines().is_empty() { "" } else { "; of each engine its fastest build" };
    let how = format!(
        "{} interleaved repetitions on {}, one core{engines}; {}",
        report.repetitions,
        counted(report.states as usize, "random state"),
        report.compiler
    );
    out.text([12.0, 42.0], Anchor::Start, 11.0, GREY, &how);
}

/// A dot with its name before the axis, a dotted line between them, and its numbers next to it. `y`
/// is the middle of the row.
fn draw(out: &mut Drawing, axis: &Axis, row: &Row, y: f64) {
    let (x, line) = (axis.at(row.time), y + 4.0);
    out.text([LABELS - 8.0, line], Anchor::End, SIZE, INK, &row.label);
    out.line(vec![[LABELS, y], [x, y]], GRID, 1.0, Some([1.0, 4.0]));
    out.dot([x, y], RADIUS, row.colour);
    let times = row.ratio.map_or_else(String::new, |ratio| format!(" ({}×)", digits(ratio)));
    out.text([x + RADIUS + 4.0, line], Anchor::Start, SIZE, INK, &format!("{} ns{times}", digits(row.time)));
}

/// Three digits.
fn digits(x: f64) -> String {
    match x {
        x if x < 10.0 => format!("{x:.2}"),
        x if x < 100.0 => format!("{x:.1}"),
        x => format!("{x:.0}"),
    }
}

fn number(x: f64) -> String {
    if x >= 1.0 { format!("{x:.0}") } else { format!("{x}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_is_a_dot_with_its_numbers_and_has_no_length() {
        let mut out = Drawing::new(WIDTH, 100.0);
        let axis = axis([20.0, 900.0].into_iter());
        draw(&mut out, &axis, &Row { label: "generic".into(), time: 100.0, ratio: Some(2.5), colour: GENERIC }, 50.0);
        let svg = out.svg();
        let circle = format!("<circle cx=\"{:.1}\" cy=\"50.0\"", axis.at(100.0));
        assert!(svg.contains(&circle) && svg.contains(">100 ns (2.50×)<") && svg.contains(">generic<"), "{svg}");
    }
}
