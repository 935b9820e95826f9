//! The measurements as a drawing: a panel for each function, both axes logarithmic.

use super::report::{Crossover, Point, Report};
use crate::plot::{Anchor, Axis, Dash, Drawing, INK, SMALL, Text};
use crate::table::counted;
use crate::timing::Summary;

const PANEL: f64 = 350.0;
const HEIGHT: f64 = 360.0;
/// Room on the left, right, top and bottom of a panel's field.
const MARGIN: [f64; 4] = [76.0, 12.0, 66.0, 44.0];
/// At the ends of an axis, in decades.
const ROOM: f64 = 0.03;

struct Curve {
    name: &'static str,
    colour: &'static str,
    /// Of cold caches.
    dash: Option<Dash>,
    time: fn(&Point) -> &Summary,
}

const GENERATED: &str = "#1b6ca8";
const GENERIC: &str = "#8a8a8a";
const DASHES: Option<Dash> = Some([5.0, 4.0]);

const CURVES: [Curve; 4] = [
    Curve { name: "generated, hot", colour: GENERATED, dash: None, time: |p| &p.generated_hot },
    Curve { name: "generic, hot", colour: GENERIC, dash: None, time: |p| &p.generic_hot },
    Curve { name: "generated, cold", colour: GENERATED, dash: DASHES, time: |p| &p.generated_cold },
    Curve { name: "generic, cold", colour: GENERIC, dash: DASHES, time: |p| &p.generic_cold },
];

/// The drawing as SVG.
pub(super) fn svg(report: &Report) -> String {
    let mut out = Drawing::new(PANEL * report.crossovers.len() as f64, HEIGHT);
    for (k, ((function, points), crossover)) in report.functions().zip(&report.crossovers).enumerate() {
        panel(&mut out, PANEL * k as f64, function, &points, crossover);
    }
    out.svg()
}

/// A panel with its left edge at `x0`.
fn panel(out: &mut Drawing, x0: f64, function: &str, points: &[&Point], crossover: &Crossover) {
    let [left, right, top, bottom] = [x0 + MARGIN[0], x0 + PANEL - MARGIN[1], MARGIN[2], HEIGHT - MARGIN[3]];
    let joints = Axis::logarithmic(points.iter().map(|p| p.joints as f64), [left, right], ROOM);
    let times = points.iter().flat_map(|p| CURVES.iter().map(|c| (c.time)(p).median));
    let time = Axis::logarithmic(times, [bottom, top], ROOM);
    out.write(Text::new([left, 18.0], Anchor::Start, 14.0, INK, function).bold());
    for (k, c) in CURVES.iter().enumerate() {
        let at = [left + 135.0 * (k % 2) as f64, 34.0 + 15.0 * (k / 2) as f64];
        out.key(at, (c.colour, c.dash), INK, c.name);
        mark(out, [at[0] + 9.0, at[1]], c);
    }
    out.ticks_below(&joints, &joints.decades(|n| format!("{n}")), [top, bottom]);
    out.ticks_beside(&time, &time.decades(duration), [left, right]);
    out.text([(left + right) / 2.0, HEIGHT - 10.0], Anchor::Middle, SMALL, INK, "joints");
    out.write(Text::new([x0 + 14.0, (top + bottom) / 2.0], Anchor::Middle, SMALL, INK, "time of a call, median").turned());
    for c in &CURVES {
        let places: Vec<[f64; 2]> = points.iter().map(|p| [joints.at(p.joints as f64), time.at((c.time)(p).median)]).collect();
        out.line(places.clone(), c.colour, 2.0, c.dash);
        places.iter().for_each(|at| mark(out, *at, c));
    }
    // Low down, where curves that rise to the right leave room.
    for (crossing, what, dash, y) in [(crossover.hot, "hot", None, 52.0), (crossover.cold, "cold", DASHES, 22.0)] {
        let Some(n) = crossing else { continue };
        let x = joints.at(n);
        out.line(vec![[x, top], [x, bottom]], "#777777", 1.0, dash);
        // On the side that has more room.
        let (at, anchor) = if x > (left + right) / 2.0 { (x - 5.0, Anchor::End) } else { (x + 5.0, Anchor::Start) };
        let sentence = ["generic faster from".to_owned(), format!("{} ({what})", counted(n.round() as usize, "joint"))];
        for (words, down) in sentence.iter().zip([0.0, 14.0]) {
            out.write(Text::new([at, bottom - y + down], anchor, SMALL, INK, words).rimmed());
        }
    }
}

/// A full mark for hot caches, an empty one for cold ones.
fn mark(out: &mut Drawing, at: [f64; 2], c: &Curve) {
    if c.dash.is_some() {
        out.ring(at, 3.0, c.colour);
    } else {
        out.dot(at, 3.0, c.colour);
    }
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
        let mut out = Drawing::new(PANEL, HEIGHT);
        panel(&mut out, 0.0, "f", &points.iter().collect::<Vec<_>>(), &crossover);
        let out = out.svg();
        assert_eq!(out.matches("<circle").count(), CURVES.len() * (points.len() + 1), "{out}");
        assert!(out.contains(">time of a call, median<") && out.contains(">joints<"), "{out}");
        let words = ["text-anchor=\"end\" fill=\"#222222\" stroke=\"#ffffff\"", ">generic faster from<", ">377 joints (cold)<"];
        assert!(words.iter().all(|w| out.contains(w)) && !out.contains("(hot)<"), "{out}");
    }
}
