//! The measurements as a drawing: a panel for each function, both axes logarithmic.

use std::fmt::Write;

use super::report::{Crossover, Point, Report};
use crate::compare::timing::Summary;
use crate::table::counted;

const PANEL: f64 = 350.0;
const HEIGHT: f64 = 360.0;
/// Room on the left, right, top and bottom of a panel's field.
const MARGIN: [f64; 4] = [76.0, 12.0, 66.0, 44.0];

struct Curve {
    name: &'static str,
    colour: &'static str,
    dashes: &'static str,
    time: fn(&Point) -> &Summary,
}

const GENERATED: &str = "#1b6ca8";
const GENERIC: &str = "#8a8a8a";
const DASHES: &str = "5 4";

const CURVES: [Curve; 4] = [
    Curve { name: "generated, hot", colour: GENERATED, dashes: "none", time: |p| &p.generated_hot },
    Curve { name: "generic, hot", colour: GENERIC, dashes: "none", time: |p| &p.generic_hot },
    Curve { name: "generated, cold", colour: GENERATED, dashes: DASHES, time: |p| &p.generated_cold },
    Curve { name: "generic, cold", colour: GENERIC, dashes: DASHES, time: |p| &p.generic_cold },
];

/// The drawing as SVG.
pub(super) fn svg(report: &Report) -> String {
    let width = PANEL * report.crossovers.len() as f64;
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {HEIGHT}\" width=\"{width}\" height=\"{HEIGHT}\" \
         font-family=\"DejaVu Sans, Verdana, Arial, sans-serif\" font-size=\"11\" fill=\"#222\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
    );
    for (k, ((function, points), crossover)) in report.functions().zip(&report.crossovers).enumerate() {
        let _ = writeln!(out, "<g transform=\"translate({} 0)\">", PANEL * k as f64);
        panel(&mut out, function, &points, crossover);
        out += "</g>\n";
    }
    out + "</svg>\n"
}

fn panel(out: &mut String, function: &str, points: &[&Point], crossover: &Crossover) {
    let [left, right, top, bottom] = MARGIN;
    let joints = Axis::new(points.iter().map(|p| p.joints as f64), left, PANEL - right);
    let times = points.iter().flat_map(|p| CURVES.iter().map(|c| (c.time)(p).median));
    let time = Axis::new(times, HEIGHT - bottom, top);
    text(out, [left, 18.0], "start", &format!("<tspan font-size=\"14\" font-weight=\"bold\">{function}</tspan>"));
    legend(out);
    for n in joints.ticks(&[1.0, 2.0, 5.0]) {
        let x = joints.at(n);
        line(out, [x, top], [x, HEIGHT - bottom], "#ddd", "none", 1.0);
        text(out, [x, HEIGHT - bottom + 15.0], "middle", &format!("{n}"));
    }
    for t in time.ticks(&[1.0]) {
        let y = time.at(t);
        line(out, [left, y], [PANEL - right, y], "#ddd", "none", 1.0);
        text(out, [left - 6.0, y + 4.0], "end", &duration(t));
    }
    text(out, [(left + PANEL - right) / 2.0, HEIGHT - 10.0], "middle", "joints");
    turned_text(out, [14.0, (top + HEIGHT - bottom) / 2.0], "time of a call, median");
    for c in &CURVES {
        let places: Vec<[f64; 2]> = points.iter().map(|p| [joints.at(p.joints as f64), time.at((c.time)(p).median)]).collect();
        curve(out, c, &places);
    }
    // Low down, where curves that rise to the right leave room.
    for (crossing, what, dashes, y) in [(crossover.hot, "hot", "none", 52.0), (crossover.cold, "cold", DASHES, 22.0)] {
        let Some(n) = crossing else { continue };
        let sentence = ["generic faster from".to_owned(), format!("{} ({what})", counted(n.round() as usize, "joint"))];
        crossing_at(out, joints.at(n), &sentence, dashes, HEIGHT - bottom - y);
    }
}

/// A line through what was measured, with a mark at each.
fn curve(out: &mut String, c: &Curve, places: &[[f64; 2]]) {
    let points: Vec<String> = places.iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
    let _ = writeln!(
        out,
        "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\" stroke-dasharray=\"{}\"/>",
        points.join(" "),
        c.colour,
        c.dashes
    );
    places.iter().for_each(|[x, y]| mark(out, [*x, *y], c));
}

/// A full mark for hot caches, an empty one for cold ones.
fn mark(out: &mut String, [x, y]: [f64; 2], c: &Curve) {
    let fill = if c.dashes == DASHES { "#fff" } else { c.colour };
    let _ = writeln!(out, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\" fill=\"{fill}\" stroke=\"{}\" stroke-width=\"1.5\"/>", c.colour);
}

/// An upright line where generic code becomes the faster, with its sentence in two lines from `y` on, on the side that has more room.
fn crossing_at(out: &mut String, x: f64, sentence: &[String; 2], dashes: &str, y: f64) {
    let [left, right, top, bottom] = MARGIN;
    line(out, [x, top], [x, HEIGHT - bottom], "#777", dashes, 1.0);
    let (at, anchor) = if x > (left + PANEL - right) / 2.0 { (x - 5.0, "end") } else { (x + 5.0, "start") };
    for (words, y) in sentence.iter().zip([y, y + 14.0]) {
        let _ = writeln!(
            out,
            "<text x=\"{at:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" stroke=\"#fff\" stroke-width=\"3\" paint-order=\"stroke\">{words}</text>"
        );
    }
}

fn legend(out: &mut String) {
    for (k, c) in CURVES.iter().enumerate() {
        let (x, y) = (MARGIN[0] + 135.0 * (k % 2) as f64, 34.0 + 15.0 * (k / 2) as f64);
        line(out, [x, y], [x + 26.0, y], c.colour, c.dashes, 2.0);
        mark(out, [x + 13.0, y], c);
        text(out, [x + 32.0, y + 4.0], "start", c.name);
    }
}

/// A logarithmic axis.
struct Axis {
    /// Logarithms of the ends.
    range: [f64; 2],
    /// Where the ends are drawn.
    ends: [f64; 2],
}

impl Axis {
    fn new(values: impl Iterator<Item = f64>, from: f64, to: f64) -> Self {
        let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(low, high), x| (low.min(x), high.max(x)));
        Self { range: [(low * 0.93).ln(), (high * 1.07).ln()], ends: [from, to] }
    }

    fn at(&self, value: f64) -> f64 {
        let part = (value.ln() - self.range[0]) / (self.range[1] - self.range[0]);
        self.ends[0] + part * (self.ends[1] - self.ends[0])
    }

    /// These multiples of powers of ten, as far as the axis goes.
    fn ticks(&self, multiples: &[f64]) -> Vec<f64> {
        let powers = (self.range[0] / 10.0_f64.ln()).floor() as i32..=(self.range[1] / 10.0_f64.ln()).ceil() as i32;
        let all = powers.flat_map(|p| multiples.iter().map(move |m| m * 10.0_f64.powi(p)));
        all.filter(|x| (self.range[0]..=self.range[1]).contains(&x.ln())).collect()
    }
}

fn line(out: &mut String, [x1, y1]: [f64; 2], [x2, y2]: [f64; 2], colour: &str, dashes: &str, width: f64) {
    let _ = writeln!(
        out,
        "<line x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\" stroke=\"{colour}\" stroke-width=\"{width}\" stroke-dasharray=\"{dashes}\"/>"
    );
}

fn text(out: &mut String, [x, y]: [f64; 2], anchor: &str, content: &str) {
    let _ = writeln!(out, "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{content}</text>");
}

/// Reads from below upward.
fn turned_text(out: &mut String, [x, y]: [f64; 2], content: &str) {
    let _ = writeln!(out, "<text transform=\"translate({x:.1} {y:.1}) rotate(-90)\" text-anchor=\"middle\">{content}</text>");
}

/// ns in the unit that fits.
fn duration(ns: f64) -> String {
    match ns {
        x if x < 999.0 => format!("{x:.0} ns"),
        x if x < 999e3 => format!("{:.0} µs", x * 1e-3),
        x => format!("{:.0} ms", x * 1e-6),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(joints: usize, generated: f64, generic: f64) -> Point {
        let time = |ns: f64| Summary { median: ns, lower_quartile: ns, upper_quartile: ns };
        Point {
            function: "f",
            joints,
            ways: vec![],
            instructions: 1,
            source_bytes: 1,
            code_bytes: None,
            generation_seconds: 1.0,
            compilation_seconds: 1.0,
            difference: 0.0,
            generated_hot: time(generated),
            generic_hot: time(generic),
            generated_cold: time(generated * 3.0),
            generic_cold: time(generic * 2.0),
        }
    }

    #[test]
    fn a_panel_has_a_mark_at_each_point_titles_and_sentences_at_its_lines() {
        let points = [point(10, 50.0, 500.0), point(100, 700.0, 4000.0), point(400, 9000.0, 11000.0)];
        let crossover = Crossover { function: "f", hot: None, cold: Some(377.2), up_to: 400 };
        let mut out = String::new();
        panel(&mut out, "f", &points.iter().collect::<Vec<_>>(), &crossover);
        assert_eq!(out.matches("<circle").count(), CURVES.len() * (points.len() + 1), "{out}");
        assert!(out.contains(">time of a call, median<") && out.contains(">joints<"), "{out}");
        let words = ["text-anchor=\"end\" stroke=\"#fff\"", ">generic faster from<", ">377 joints (cold)<"];
        assert!(words.iter().all(|w| out.contains(w)) && !out.contains("(hot)<"), "{out}");
    }

    #[test]
    fn equal_ratios_are_equal_distances() {
        let axis = Axis::new([10.0, 1000.0].into_iter(), 0.0, 300.0);
        assert!((axis.at(100.0) - axis.at(10.0) - (axis.at(1000.0) - axis.at(100.0))).abs() < 1e-9);
        assert_eq!(axis.ticks(&[1.0, 5.0]), [10.0, 50.0, 100.0, 500.0, 1000.0]);
    }
}
