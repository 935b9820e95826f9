//! Work–precision diagrams of integrators.

use super::super::plot::{FIELD, HEIGHT, ROOM, WIDTH, frame};
use super::{Motion, Sample};
use crate::plot::{Anchor, Axis, Drawing, INK, SMALL};
use crate::table::{counted, number};

const COLOURS: [&str; 9] = ["#777777", "#1b6ca8", "#c03d20", "#2a8a3e", "#8e44ad", "#b8860b", "#d6277f", "#17a2b8", "#5d4037"];

type What = fn(&Sample) -> Option<f64>;

/// Of the error over evaluations and over time, and of the energy over evaluations.
pub(super) fn diagrams(m: &Motion) -> Vec<(String, Drawing)> {
    let error: What = |s| (s.resolved && s.error > 0.0).then_some(s.error);
    let evaluations: What = |s| Some(s.evaluations as f64);
    let wall: What = |s| Some(s.wall * 1e3);
    let energy: What = |s| s.energy.filter(|e| *e > 0.0);
    [
        ("error_over_evaluations", "evaluations of forward dynamics and its derivatives", evaluations, "error of the last state", error),
        ("error_over_time", "wall time, ms", wall, "error of the last state", error),
        (
            "energy_over_evaluations",
            "evaluations of forward dynamics and its derivatives",
            evaluations,
            "energy missing at the end, relative",
            energy,
        ),
    ]
    .into_iter()
    .map(|(name, below, x, beside, y)| (name.to_owned(), diagram(m, (below, x), (beside, y))))
    .collect()
}

/// Note that lost runs are not drawn: next to their errors all others would look like one line.
pub(super) fn lost(m: &Motion) -> Option<String> {
    let count = m.curves.iter().flat_map(|c| &c.samples).filter(|s| s.lost).count();
    let runs = counted(count, "run");
    let off = format!("off by more than the motion itself ({} rad, m, and those a second)", number(m.extent));
    (count > 0).then(|| format!("{runs} not drawn: {off}"))
}

fn diagram(m: &Motion, (below, of_x): (&str, What), (beside, of_y): (&str, What)) -> Drawing {
    let [left, right, top, bottom] = FIELD;
    let places = |s: &Sample| if s.lost { None } else { Some((of_x(s)?, of_y(s)?)) };
    let all = || m.curves.iter().flat_map(|c| c.samples.iter().filter_map(places));
    let x = Axis::logarithmic(all().map(|p| p.0), [left, right], ROOM);
    let y = Axis::logarithmic(all().map(|p| p.1), [bottom, top], ROOM);
    let mut out = Drawing::new(WIDTH, HEIGHT);
    out.text([16.0, 22.0], Anchor::Start, 14.0, INK, &format!("{}, {} s", m.scene, m.seconds));
    if let Some(line) = lost(m) {
        out.text([16.0, 38.0], Anchor::Start, SMALL, INK, &line);
    }
    if all().next().is_none() {
        let why = format!("nothing to draw: {beside} could be told of no run");
        out.text([left, 0.5 * (top + bottom)], Anchor::Start, 12.0, INK, &why);
        return out;
    }
    frame(&mut out, &x, &y, below, beside);
    for (k, c) in m.curves.iter().enumerate() {
        let colour = COLOURS[k % COLOURS.len()];
        let points: Vec<[f64; 2]> = c.samples.iter().filter_map(places).map(|(a, b)| [x.at(a), y.at(b)]).collect();
        for [a, b] in &points {
            out.path(vec![[a - 1.5, *b], [a + 1.5, *b]], colour, 3.0);
        }
        out.path(points, colour, 1.3);
        out.key([right + 14.0, top + 18.0 * (k as f64 + 1.0) - 4.0], (colour, None), colour, &c.integrator);
    }
    out
}
