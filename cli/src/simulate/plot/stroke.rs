//! How the curves of a field are drawn so that each of them is seen.

use super::axis::Axis;
use super::drawing::Dash;

/// A curve and its name.
#[derive(Clone, Debug)]
pub(super) struct Curve {
    pub(super) name: String,
    pub(super) values: Vec<f64>,
}

/// Colours of curves. Readers with colour blindness can distinguish them, on screen and in print.
/// A panel has at most so many curves.
pub(super) const COLOURS: [&str; 8] = ["#1b6ca8", "#d9822b", "#3f8f5b", "#c2453f", "#7a5195", "#b59f00", "#36a9bf", "#555555"];

/// The look of a curve.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Stroke {
    pub(super) colour: &'static str,
    pub(super) width: f64,
    pub(super) dash: Option<Dash>,
}

/// Curves nearer to each other than this are one, in points.
const APART: f64 = 0.75;
/// What shows of each of several curves that are one, in points.
const SHOWN: f64 = 6.0;
/// Points to an oscillation for a line of full width; with fewer it is thinner.
const WAVE: f64 = 12.0;

const WIDTH: f64 = 1.5;
const THIN: f64 = 0.5;

/// Of the curves of a panel, over a field of this width in points: those that oscillate too often to be told apart are thinner; of those that lie on each other all
/// but the first are dashed, the later the shorter.
pub(super) fn strokes(curves: &[Curve], value: &Axis, width: f64) -> Vec<Stroke> {
    let first = firsts(curves, value);
    let alike = |k: usize| first.iter().filter(|f| **f == first[k]).count();
    let before = |k: usize| first[..k].iter().filter(|f| **f == first[k]).count();
    let dash = |k: usize| {
        let (all, over) = (alike(k) as f64, before(k) as f64);
        (over > 0.0).then_some([SHOWN * (all - over), SHOWN * over])
    };
    let line = |k: usize| (WIDTH * width / (WAVE * waves(&curves[k].values, value))).clamp(THIN, WIDTH);
    (0..first.len()).map(|k| Stroke { colour: COLOURS[k % COLOURS.len()], width: line(k), dash: dash(k) }).collect()
}

/// For each curve the first that lies where it does.
fn firsts(curves: &[Curve], value: &Axis) -> Vec<usize> {
    let same = |a: f64, b: f64| (a.is_nan() && b.is_nan()) || (value.at(a) - value.at(b)).abs() < APART;
    let mut out: Vec<usize> = Vec::new();
    for (k, curve) in curves.iter().enumerate() {
        let on = |other: &usize| curves[*other].values.iter().zip(&curve.values).all(|(a, b)| same(*a, *b));
        out.push((0..k).filter(|j| out[*j] == *j).find(on).unwrap_or(k));
    }
    out
}

/// How often a curve goes up and down by what is seen.
fn waves(values: &[f64], value: &Axis) -> f64 {
    let mut heights = values.iter().map(|x| value.at(*x)).filter(|y| y.is_finite());
    let Some(mut last) = heights.next() else { return 0.0 };
    let (mut turns, mut way) = (0_u32, 0.0);
    for y in heights {
        let change = y - last;
        if change * way > 0.0 {
            last = y;
        } else if change.abs() > 1.0 {
            turns += u32::from(way != 0.0);
            (last, way) = (y, change.signum());
        }
    }
    0.5 * f64::from(turns)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(curves: Vec<Vec<f64>>) -> Vec<Stroke> {
        let value = Axis::around(curves.iter().flatten().copied(), [200.0, 0.0], 4.0);
        let curves: Vec<Curve> = curves.into_iter().map(|values| Curve { name: String::new(), values }).collect();
        strokes(&curves, &value, 400.0)
    }

    #[test]
    fn each_of_the_curves_that_are_one_is_seen() {
        let up: Vec<f64> = (0..50).map(f64::from).collect();
        let down: Vec<f64> = up.iter().map(|x| -x).collect();
        let near: Vec<f64> = up.iter().map(|x| x + 1e-3).collect();
        let dashes: Vec<Option<Dash>> = drawn(vec![up.clone(), down, near, up]).into_iter().map(|s| s.dash).collect();
        assert_eq!(dashes, [None, None, Some([12.0, 6.0]), Some([6.0, 12.0])]);
    }

    #[test]
    fn what_oscillates_too_often_is_thin() {
        let wave = |times: f64| (0..5000).map(|k| (std::f64::consts::TAU * times * f64::from(k) / 5000.0).sin()).collect();
        let widths: Vec<f64> = drawn(vec![wave(30.0), wave(110.0)]).into_iter().map(|s| s.width).collect();
        assert_eq!(widths, [WIDTH, THIN]);
    }
}
