//! Work–precision diagrams: error over time, both logarithmic.

use super::labels::{self, Area, Labels};
use super::report::{FunctionReport, Point, Report};
use crate::plot::{Anchor, Axis, Drawing, INK, SMALL, Text};

pub(super) const WIDTH: f64 = 720.0;
pub(super) const HEIGHT: f64 = 430.0;
/// Left, right, top and bottom of the field.
pub(super) const FIELD: [f64; 4] = [70.0, 530.0, 44.0, 380.0];
/// Position of the line about colours.
const LEGEND: f64 = 38.0;
const OURS: &str = "#1b6ca8";
const FRONT: &str = "#c03d20";
const PEER: &str = "#777777";

/// A diagram for each function: its file's name and the picture.
pub(super) fn diagrams(report: &Report) -> Vec<(String, Drawing)> {
    report.functions.iter().map(|f| (format!("work_precision_{}", f.function), diagram(f, report))).collect()
}

/// Room at the ends of an axis, in decades.
pub(super) const ROOM: f64 = 0.15;

fn diagram(f: &FunctionReport, report: &Report) -> Drawing {
    let [left, right, top, bottom] = FIELD;
    let x = Axis::logarithmic(f.points.iter().map(|p| p.time.median), [left, right], ROOM);
    let y = Axis::logarithmic(f.points.iter().flat_map(|p| [p.relative.median, p.relative.largest]), [bottom, top], ROOM);
    let mut out = Drawing::new(WIDTH, HEIGHT);
    out.text([16.0, 22.0], Anchor::Start, 14.0, INK, &format!("{} of {}: error over time", f.function, report.robot));
    legend(&mut out, &f.points);
    frame(&mut out, &x, &y, "time of a call, ns", "largest error, relative to its terms (thin: from the median)");
    for point in &f.points {
        mark(&mut out, &x, &y, point);
    }
    names(&mut out, &x, &y, &f.points);
    out
}

/// Axes with their ticks and titles.
pub(super) fn frame(out: &mut Drawing, x: &Axis, y: &Axis, below: &str, beside: &str) {
    let [left, right, top, bottom] = FIELD;
    out.ticks_below(x, &x.decades(plain), [top, bottom]);
    out.ticks_beside(y, &y.decades(|tick| format!("{tick:.0e}")), [left, right]);
    out.text([(left + right) / 2.0, bottom + 36.0], Anchor::Middle, SMALL, INK, below);
    out.write(Text::new([18.0, (top + bottom) / 2.0], Anchor::Middle, SMALL, INK, beside).turned());
}

fn plain(x: f64) -> String {
    if (1.0..1e5).contains(&x) { format!("{x:.0}") } else { format!("{x:.0e}") }
}

fn colour(p: &Point) -> &'static str {
    if p.peer {
        PEER
    } else if p.front {
        FRONT
    } else {
        OURS
    }
}

/// A diamond at the largest error and a line to the median.
fn mark(out: &mut Drawing, x: &Axis, y: &Axis, p: &Point) {
    let (a, b) = (x.at(p.time.median), y.at(p.relative.largest));
    out.path(vec![[a, y.at(p.relative.median)], [a, b]], colour(p), 1.0);
    out.path(vec![[x.at(p.time.lower_quartile), b], [x.at(p.time.upper_quartile), b]], colour(p), 1.0);
    diamond(out, [a, b], colour(p));
}

fn diamond(out: &mut Drawing, [a, b]: [f64; 2], colour: &'static str) {
    out.path(vec![[a - 2.0, b], [a, b - 2.0], [a + 2.0, b], [a, b + 2.0], [a - 2.0, b], [a, b - 2.0]], colour, 4.0);
}

/// The names next to their marks; without room, farther off with a line.
fn names(out: &mut Drawing, x: &Axis, y: &Axis, points: &[Point]) {
    let [left, _, top, bottom] = FIELD;
    let at = |p: &Point| [x.at(p.time.median), y.at(p.relative.largest)];
    let mut labels = Labels::new([left, top, WIDTH - 4.0, bottom + 5.0], points.iter().map(|p| taken(x, y, p)).collect());
    let mut order: Vec<&Point> = points.iter().collect();
    order.sort_by(|a, b| b.relative.largest.total_cmp(&a.relative.largest));
    for p in order {
        let place = labels.place(at(p), &p.level);
        if let Some(end) = place.leader {
            out.path(vec![at(p), end], colour(p), 0.6);
        }
        out.text(place.at, place.anchor, labels::SIZE, colour(p), &p.level);
    }
}

/// The area of a mark, with its line down to the median.
fn taken(x: &Axis, y: &Axis, p: &Point) -> Area {
    let [low, high, at] = [p.time.lower_quartile, p.time.upper_quartile, p.time.median].map(|t| x.at(t));
    let (largest, median) = (y.at(p.relative.largest), y.at(p.relative.median));
    [low.min(at - 4.0), largest - 4.0, high.max(at + 4.0), median.max(largest + 4.0)]
}

/// The meaning of the colours, in a line below the title.
fn legend(out: &mut Drawing, points: &[Point]) {
    let lines = [
        (FRONT, "nothing else is both faster and more accurate", true),
        (OURS, "something else is both", points.iter().any(|p| !p.peer && !p.front)),
        (PEER, "another library", points.iter().any(|p| p.peer)),
    ];
    let mut at = 20.0;
    for (colour, words, _) in lines.into_iter().filter(|(.., there)| *there) {
        diamond(out, [at, LEGEND - 4.0], colour);
        out.text([at + 8.0, LEGEND], Anchor::Start, labels::SIZE, INK, words);
        at += labels::width(words) + 28.0;
    }
}

#[cfg(test)]
mod tests {
    use super::super::report::example;
    use super::*;

    #[test]
    fn a_diagram_has_every_level() {
        let (name, drawing) = diagrams(&example()).remove(0);
        assert_eq!(name, "work_precision_inverse_dynamics");
        let text = drawing.svg();
        assert!(["f32", "f64+no_fma", "double_double"].iter().all(|level| text.contains(&format!(">{level}<"))));
        assert!(text.contains(">nothing else is both faster and more accurate<") && text.contains(">something else is both<"));
        assert!(!text.contains("another library"));
    }
}
