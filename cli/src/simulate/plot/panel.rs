//! A field with curves over time, its axes, and the names of the curves at its right.

use super::axis::Axis;
use super::clock::Clock;
use super::drawing::{Anchor, Drawing, Point};
pub(super) use super::stroke::{COLOURS, Curve};
use super::stroke::{Stroke, strokes};

/// What a panel shows.
#[derive(Clone, Debug)]
pub(super) struct Panel {
    /// Over the field, with the unit: `angle, rad`.
    pub(super) title: String,
    pub(super) curves: Vec<Curve>,
}

pub(super) const WIDTH: f64 = 640.0;
pub(super) const HEIGHT: f64 = 250.0;

/// Room left of the field, right of it, over it and under it.
const LEFT: f64 = 64.0;
const RIGHT: f64 = 168.0;
const TOP: f64 = 30.0;
const BOTTOM: f64 = 40.0;

/// Letters of numbers and names, and the room for a name.
pub(super) const SMALL: f64 = 11.0;
pub(super) const NAME: f64 = RIGHT - 42.0;

const INK: &str = "#222222";
const GREY: &str = "#555555";
const GRID: &str = "#e2e2e2";
const EVENT: &str = "#9a9a9a";

/// Draws a panel with its corner at a place.
pub(super) fn draw(out: &mut Drawing, panel: &Panel, clock: &Clock, [x0, y0]: Point) {
    let (left, right, top, bottom) = (x0 + LEFT, x0 + WIDTH - RIGHT, y0 + TOP, y0 + HEIGHT - BOTTOM);
    let time = Axis::exactly(clock.t.iter().copied(), [left, right], 6.0);
    let value = Axis::around(panel.curves.iter().flat_map(|c| c.values.iter().copied()), [bottom, top], 5.0);
    let [along, up] = axes(out, &time, &value);
    out.text([left, y0 + 18.0], Anchor::Start, 12.0, INK, &titled(&panel.title, up));
    out.text([(left + right) / 2.0, y0 + HEIGHT - 8.0], Anchor::Middle, SMALL, GREY, &titled(&clock.title, along));
    for &e in clock.events.iter().filter(|e| (time.range[0]..=time.range[1]).contains(*e)) {
        out.path(vec![[time.at(e), top], [time.at(e), bottom]], EVENT, 0.8, true);
    }
    let strokes = strokes(&panel.curves, &value, right - left);
    for (curve, stroke) in panel.curves.iter().zip(&strokes) {
        for points in thinned(&clock.t, &curve.values, &time, &value) {
            out.line(points, stroke.colour, stroke.width, stroke.dash);
        }
    }
    legend(out, panel, &strokes, !clock.events.is_empty(), [right + 12.0, top + 6.0]);
}

/// What an axis is of, with the power of ten of the numbers at it.
fn titled(what: &str, power: i32) -> String {
    if power == 0 { what.to_owned() } else { format!("{what} (numbers × 10{})", raised(power)) }
}

/// Grid and numbers; the powers of ten of those below and of those at the left.
fn axes(out: &mut Drawing, time: &Axis, value: &Axis) -> [i32; 2] {
    let ([left, right], [bottom, top]) = (time.ends, value.ends);
    let (ticks, along) = time.ticks();
    for (number, text) in &ticks {
        let x = time.at(*number);
        out.path(vec![[x, top], [x, bottom]], GRID, 1.0, false);
        out.text([x, bottom + 15.0], Anchor::Middle, SMALL, GREY, text);
    }
    let (ticks, up) = value.ticks();
    for (number, text) in &ticks {
        let y = value.at(*number);
        let zero = *number == 0.0;
        out.path(vec![[left, y], [right, y]], if zero { "#b0b0b0" } else { GRID }, 1.0, false);
        out.text([left - 6.0, y + 4.0], Anchor::End, SMALL, GREY, text);
    }
    out.path(vec![[left, top], [left, bottom], [right, bottom]], GREY, 1.0, false);
    [along, up]
}

fn legend(out: &mut Drawing, panel: &Panel, strokes: &[Stroke], events: bool, [x, y]: Point) {
    let row = |k: usize| y + 17.0 * k as f64;
    for ((k, curve), stroke) in panel.curves.iter().enumerate().zip(strokes) {
        out.line(vec![[x, row(k)], [x + 18.0, row(k)]], stroke.colour, 2.0, stroke.dash);
        out.text([x + 24.0, row(k) + 4.0], Anchor::Start, SMALL, INK, &curve.name);
    }
    if events {
        let k = panel.curves.len();
        out.path(vec![[x, row(k)], [x + 18.0, row(k)]], EVENT, 1.0, true);
        out.text([x + 24.0, row(k) + 4.0], Anchor::Start, SMALL, GREY, "events");
    }
}

/// The curve's points, in pieces where it is not finite: of many that share a place along the axis, the first, the least, the most and the last.
fn thinned(t: &[f64], values: &[f64], time: &Axis, value: &Axis) -> Vec<Vec<Point>> {
    let mut pieces: Vec<Vec<Point>> = Vec::new();
    let mut bin: Vec<Point> = Vec::new();
    let mut open = false;
    for (&t, &x) in t.iter().zip(values) {
        if !x.is_finite() {
            flush(&mut pieces, &mut bin);
            open = false;
            continue;
        }
        let p = [time.at(t), value.at(x)];
        if !open {
            pieces.push(Vec::new());
            open = true;
        }
        if bin.first().is_some_and(|first| p[0] - first[0] > 0.5) {
            flush(&mut pieces, &mut bin);
        }
        bin.push(p);
    }
    flush(&mut pieces, &mut bin);
    pieces
}

fn flush(pieces: &mut [Vec<Point>], bin: &mut Vec<Point>) {
    let Some(piece) = pieces.last_mut() else { return };
    let by = |order: std::cmp::Ordering| (0..bin.len()).reduce(|a, b| if bin[b][1].total_cmp(&bin[a][1]) == order { b } else { a });
    let mut keep: Vec<usize> =
        [Some(0), by(std::cmp::Ordering::Less), by(std::cmp::Ordering::Greater), bin.len().checked_sub(1)].into_iter().flatten().collect();
    keep.retain(|k| *k < bin.len());
    keep.sort_unstable();
    keep.dedup();
    piece.extend(keep.into_iter().map(|k| bin[k]));
    bin.clear();
}

fn raised(power: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    power.to_string().chars().map(|c| c.to_digit(10).map_or('⁻', |d| DIGITS[d as usize])).collect()
}

#[cfg(test)]
mod tests {
    use super::super::drawing::Mark;
    use super::*;

    #[test]
    fn a_peak_among_many_points_is_kept() {
        let t: Vec<f64> = (0..100_000).map(f64::from).collect();
        let mut values = vec![0.0; t.len()];
        values[54_321] = 1.0;
        values[12_345] = -1.0;
        let (time, value) = (Axis::exactly(t.iter().copied(), [0.0, 400.0], 5.0), Axis::around(values.iter().copied(), [100.0, 0.0], 4.0));
        let pieces = thinned(&t, &values, &time, &value);
        assert_eq!(pieces.len(), 1);
        assert!(pieces[0].len() < 3300);
        let ys: Vec<f64> = pieces[0].iter().map(|p| p[1]).collect();
        assert!(ys.contains(&value.at(1.0)) && ys.contains(&value.at(-1.0)));
        assert!(pieces[0].windows(2).all(|w| w[0][0] <= w[1][0]));
    }

    #[test]
    fn a_gap_stays_a_gap() {
        let t = [0.0, 1.0, 2.0, 3.0];
        let values = [0.0, f64::NAN, 1.0, 2.0];
        let axis = Axis::exactly(t.iter().copied(), [0.0, 400.0], 5.0);
        assert_eq!(thinned(&t, &values, &axis, &axis).iter().map(Vec::len).collect::<Vec<_>>(), [1, 2]);
    }

    #[test]
    fn powers_are_raised() {
        assert_eq!(raised(-12), "⁻¹²");
    }

    /// Each number at the axis times the power that the axis tells is a time.
    #[test]
    fn the_axis_of_time_tells_its_power() {
        for (end, told, last) in
            [(5e-4, "time, s (numbers × 10⁻⁶)", "500"), (1e5, "time, s (numbers × 10³)", "100"), (10.0, "time, s", "10")]
        {
            let panel = Panel { title: String::new(), curves: vec![Curve { name: String::new(), values: vec![0.0, 1.0] }] };
            let mut out = Drawing::default();
            draw(&mut out, &panel, &Clock::of(&[0.0, end], &[]), [0.0, 0.0]);
            let has = |text: &str| out.marks.iter().any(|m| matches!(m, Mark::Text { content, .. } if content == text));
            assert!(has(told) && has(last), "{end} s: {:?}", out.marks);
        }
    }
}
