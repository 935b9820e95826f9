//! The measurements as a drawing: a panel for each function, both axes logarithmic.

use std::fmt::Write;

use super::report::{Crossover, Point, Report};
use crate::compare::timing::Summary;

const PANEL: f64 = 350.0;
const HEIGHT: f64 = 360.0;
/// Room on the left, right, top and bottom of a panel's field.
const MARGIN: [f64; 4] = [62.0, 12.0, 66.0, 44.0];

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
    for (crossing, dashes, y) in [(crossover.hot, "none", 12.0), (crossover.cold, DASHES, 26.0)] {
        let Some(n) = crossing else { continue };
        let x = joints.at(n);
        line(out, [x, top], [x, HEIGHT - bottom], "#777", dashes, 1.0);
        text(out, [x - 4.0, top + y], "end", &format!("{n:.0}"));
    }
    for c in &CURVES {
        let places: Vec<String> =
            points.iter().map(|p| format!("{:.1},{:.1}", joints.at(p.joints as f64), time.at((c.time)(p).median))).collect();
        let _ = writeln!(
            out,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\" stroke-dasharray=\"{}\"/>",
            places.join(" "),
            c.colour,
            c.dashes
        );
    }
}

fn legend(out: &mut String) {
    for (k, c) in CURVES.iter().enumerate() {
        let (x, y) = (MARGIN[0] + 135.0 * (k % 2) as f64, 34.0 + 15.0 * (k / 2) as f64);
        line(out, [x, y], [x + 26.0, y], c.colour, c.dashes, 2.0);
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

    #[test]
    fn equal_ratios_are_equal_distances() {
        let axis = Axis::new([10.0, 1000.0].into_iter(), 0.0, 300.0);
        assert!((axis.at(100.0) - axis.at(10.0) - (axis.at(1000.0) - axis.at(100.0))).abs() < 1e-9);
        assert_eq!(axis.ticks(&[1.0, 5.0]), [10.0, 50.0, 100.0, 500.0, 1000.0]);
    }
}
