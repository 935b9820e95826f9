//! The medians as dots, in SVG: a panel for each function, a row for each contender, on a logarithmic axis. A bar would have a length, which says nothing there.

use std::fmt::Write;

use super::batch::BatchReport;
use super::report::{FunctionReport, Report};
use crate::robot::named;
use crate::table::{counted, freedom};

/// A row: whose time, ns, how many times that of generated code it is, and the colour.
struct Row {
    label: String,
    time: f64,
    ratio: Option<f64>,
    colour: &'static str,
}

const WIDTH: f64 = 860.0;
/// From the left edge to the axis.
const LABELS: f64 = 250.0;
/// From the end of the axis to the right edge, for the numbers beside the dots.
const NUMBERS: f64 = 110.0;
/// The height of a row.
const ROW: f64 = 19.0;
const RADIUS: f64 = 5.0;
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
    let axis = Axis::over(times().fold(f64::INFINITY, f64::min), times().fold(0.0, f64::max));
    let count: usize = panels.iter().map(|(_, rows)| rows.len()).sum();
    let bottom = HEAD + panels.len() as f64 * TITLE + count as f64 * ROW;
    let mut out = head(report, bottom + FOOT);
    axis.draw(&mut out, bottom);
    let mut y = HEAD;
    for (function, rows) in &panels {
        text(&mut out, 12.0, y + TITLE - 8.0, "font-weight=\"bold\"", function);
        y += TITLE;
        for row in rows {
            draw(&mut out, &axis, row, y + ROW / 2.0);
            y += ROW;
        }
    }
    out + "</svg>\n"
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

/// A logarithmic axis of ns, between powers of ten or halves of them.
struct Axis {
    low: f64,
    high: f64,
}

impl Axis {
    fn over(least: f64, most: f64) -> Self {
        let (least, most) = if least <= most { (least, most) } else { (1.0, 10.0) };
        // Ends are 1, 2 or 5 times a power of ten, the lower one left of the first dot.
        let low = ticks().rev().find(|t| *t <= least / 1.2).unwrap_or(1e-3);
        let high = ticks().find(|t| *t >= most).unwrap_or(1e12);
        Self { low, high }
    }

    /// Where a time stands, from the left edge.
    fn x(&self, time: f64) -> f64 {
        let part = (time / self.low).log10() / (self.high / self.low).log10();
        LABELS + (WIDTH - LABELS - NUMBERS) * part.clamp(0.0, 1.0)
    }

    fn draw(&self, out: &mut String, bottom: f64) {
        let wide = self.high / self.low > 3e3;
        for tick in ticks().filter(|t| (self.low..=self.high).contains(t)) {
            let (x, top) = (self.x(tick), HEAD + 4.0);
            let _ = writeln!(out, "<path d=\"M{x:.1} {top:.1}V{bottom:.1}\" stroke=\"#dddddd\"/>");
            let power = (tick.log10() - tick.log10().round()).abs() < 1e-9;
            if power || !wide {
                text(out, x, bottom + 16.0, "text-anchor=\"middle\" fill=\"#555555\"", &number(tick));
            }
        }
        let middle = (LABELS + WIDTH - NUMBERS) / 2.0;
        text(
            out,
            middle,
            bottom + 34.0,
            "text-anchor=\"middle\" fill=\"#555555\"",
            "ns per call, median; logarithmic: equal ratios are equal distances",
        );
    }
}

/// 1, 2 and 5 times the powers of ten.
fn ticks() -> impl DoubleEndedIterator<Item = f64> {
    (-3..=12).flat_map(|k| [1.0, 2.0, 5.0].map(|x| x * 10f64.powi(k)))
}

fn head(report: &Report, height: f64) -> String {
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{height:.0}\" viewBox=\"0 0 {WIDTH} {height:.0}\" \
         font-family=\"DejaVu Sans, Verdana, Arial, sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
    );
    let title = format!("{}, {} base, {}", named(&report.robot, report.scene.as_deref()), report.base, freedom(report.degrees_of_freedom));
    text(&mut out, 12.0, 22.0, "font-size=\"15\" font-weight=\"bold\"", &title);
    let engines = if report.engines().is_empty() { "" } else { "; of each engine its fastest build" };
    let how = format!(
        "{} interleaved repetitions on {}, one core{engines}; {}",
        report.repetitions,
        counted(report.states as usize, "random state"),
        report.compiler
    );
    text(&mut out, 12.0, 42.0, "fill=\"#555555\" font-size=\"11\"", &how);
    out
}

/// A dot with its name before the axis, a dotted line from one to the other, and its numbers beside it. `y` is the middle of the row.
fn draw(out: &mut String, axis: &Axis, row: &Row, y: f64) {
    let (x, line) = (axis.x(row.time), y + 4.0);
    text(out, LABELS - 8.0, line, "text-anchor=\"end\"", &row.label);
    let _ = writeln!(out, "<path d=\"M{LABELS:.1} {y:.1}H{x:.1}\" stroke=\"#aaaaaa\" stroke-dasharray=\"1 4\"/>");
    let _ = writeln!(out, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{RADIUS}\" fill=\"{}\"/>", row.colour);
    let times = row.ratio.map_or_else(String::new, |ratio| format!(" ({}×)", digits(ratio)));
    text(out, x + RADIUS + 4.0, line, "", &format!("{} ns{times}", digits(row.time)));
}

fn text(out: &mut String, x: f64, y: f64, attributes: &str, text: &str) {
    let space = if attributes.is_empty() { "" } else { " " };
    let _ = writeln!(out, "<text x=\"{x:.1}\" y=\"{y:.1}\"{space}{attributes}>{}</text>", escaped(text));
}

fn escaped(text: &str) -> String {
    text.chars().fold(String::new(), |out, c| match c {
        '&' => out + "&amp;",
        '<' => out + "&lt;",
        '>' => out + "&gt;",
        c if c.is_control() => out + " ",
        c => out + c.encode_utf8(&mut [0; 4]),
    })
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
    fn a_time_between_two_ends_stands_at_its_logarithm() {
        let axis = Axis::over(20.0, 900.0);
        assert_eq!((axis.low, axis.high), (10.0, 1000.0));
        let [a, b, c] = [10.0, 100.0, 1000.0].map(|t| axis.x(t));
        assert!((b - (a + c) / 2.0).abs() < 1e-9 && a == LABELS && c == WIDTH - NUMBERS);
    }

    #[test]
    fn a_time_is_a_dot_with_its_numbers_and_has_no_length() {
        let mut out = String::new();
        let axis = Axis::over(20.0, 900.0);
        draw(&mut out, &axis, &Row { label: "generic".into(), time: 100.0, ratio: Some(2.5), colour: GENERIC }, 50.0);
        let circle = format!("<circle cx=\"{:.1}\" cy=\"50.0\"", axis.x(100.0));
        assert!(out.contains(&circle) && out.contains(">100 ns (2.50×)<") && out.contains(">generic<") && !out.contains("<rect"), "{out}");
    }

    #[test]
    fn a_name_cannot_end_its_element() {
        assert_eq!(escaped("</text>&\n"), "&lt;/text&gt;&amp; ");
    }
}
