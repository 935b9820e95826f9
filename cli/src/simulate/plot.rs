//! Plots of a recording over time, in SVG: positions, velocities, torques and energy.

use articulated_lab::plot::{Anchor, Axis, Dash, Drawing, GREY, INK, Point, SMALL};

use super::label;
use super::recording::{Named, Recording};

/// A picture.
pub(super) struct Picture {
    /// Of its files, without the ending.
    pub(super) name: &'static str,
    pub(super) svg: String,
}

/// More events than this are counted and not drawn: they would hide the curves.
const EVENTS: usize = 60;

/// Relative to the largest number of a picture: a curve that is never larger is usually a rounding
/// error, and looks like zero.
const UNSEEN: f64 = 1e-12;

/// Pictures of a motion; energy is always drawn.
pub(super) const PICTURES: [&str; 4] = ["positions", "velocities", "torques", "energy"];

/// All pictures of a motion called `title`, without those that have no curve worth drawing.
pub(super) fn pictures(r: &Recording, title: &str) -> Vec<Picture> {
    let moving = |names: &[Named], rows: &[f64]| (panels(&seen(coordinates(names, r, rows))), names.len());
    let kinds = [moving(&r.q_names, &r.q), moving(&r.v_names, &r.v), moving(&r.tau_names, &r.tau), (energies(r), 0)];
    let worth = PICTURES.into_iter().zip(kinds).filter(|(_, (panels, _))| !panels.is_empty());
    worth.map(|(name, (panels, all))| picture(name, &panels, &notes(r, &panels, all), r, title)).collect()
}

/// Without curves that are zero, or negligible relative to the largest, throughout.
fn seen(mut all: Vec<Series>) -> Vec<Series> {
    let numbers = all.iter().flat_map(|(_, values)| values).map(|x| x.abs());
    let least = UNSEEN * numbers.filter(|x| x.is_finite()).fold(0.0, f64::max);
    all.retain(|(_, values)| values.iter().any(|x| x.is_nan() || x.abs() > least));
    all
}

/// Curves and events left out of a picture.
fn notes(r: &Recording, panels: &[Panel], all: usize) -> String {
    let left = all.saturating_sub(panels.iter().map(|p| p.curves.len()).sum());
    let curves =
        (left > 0).then(|| format!("{left} of {all} curves are not drawn: zero, or at most {UNSEEN:e} of the largest number here"));
    let events = (r.events.len() > EVENTS).then(|| format!("{} events, not drawn", r.events.len()));
    curves.into_iter().chain(events).collect::<Vec<_>>().join("; ")
}

fn picture(name: &'static str, panels: &[Panel], notes: &str, r: &Recording, title: &str) -> Picture {
    let head = if notes.is_empty() { 30.0 } else { 48.0 };
    let events: Vec<f64> = if r.events.len() <= EVENTS { r.events.iter().map(|e| e.time).collect() } else { Vec::new() };
    let columns = if panels.len() > 3 { 2 } else { 1 };
    let rows = panels.len().div_ceil(columns);
    let mut out = Drawing::new(WIDTH * columns as f64, head + HEIGHT * rows as f64);
    out.text([16.0, 22.0], Anchor::Start, 14.0, INK, &format!("{title}: {name}"));
    if !notes.is_empty() {
        out.text([16.0, 40.0], Anchor::Start, SMALL, GREY, notes);
    }
    let clock = Clock::of(&r.t, &events);
    for (k, p) in panels.iter().enumerate() {
        let corner = [WIDTH * (k % columns) as f64, head + HEIGHT * (k / columns) as f64];
        draw(&mut out, p, &clock, corner);
    }
    Picture { name, svg: out.svg() }
}

type Series = (Named, Vec<f64>);

fn coordinates(names: &[Named], r: &Recording, rows: &[f64]) -> Vec<Series> {
    names.iter().enumerate().map(|(k, n)| (n.clone(), r.series(names, rows, k))).collect()
}

/// The quantity of a panel of numbers of this unit.
fn quantity(unit: &str) -> &'static str {
    match unit {
        "rad" => "angle, rad",
        "m" => "displacement, m",
        "rad/s" => "angular velocity, rad/s",
        "m/s" => "velocity, m/s",
        "N·m" => "torque, N·m",
        "N" => "force, N",
        _ => "orientation, a unit quaternion",
    }
}

/// Numbers of one unit share panels, separate from those of the base; at most eight per panel,
/// evenly distributed.
fn panels(series: &[Series]) -> Vec<Panel> {
    let mut kinds: Vec<(bool, &str)> = Vec::new();
    for (n, _) in series {
        if !kinds.contains(&(n.base, n.unit)) {
            kinds.push((n.base, n.unit));
        }
    }
    let labels: Vec<String> = series.iter().map(|(n, _)| crate::table::plain(&n.label)).collect();
    let labels = label::told_apart(&labels, SMALL, NAME);
    let mut out = Vec::new();
    for kind in kinds {
        let alike: Vec<_> = series.iter().zip(&labels).filter(|((n, _), _)| (n.base, n.unit) == kind).collect();
        let count = alike.len().div_ceil(COLOURS.len());
        for part in alike.chunks(alike.len().div_ceil(count)) {
            let curves = part.iter().map(|((_, values), label)| Curve { name: (*label).clone(), values: values.clone() }).collect();
            let whose = if kind.0 { "base: " } else { "" };
            out.push(Panel { title: format!("{whose}{}", quantity(kind.1)), curves });
        }
    }
    out
}

fn energies(r: &Recording) -> Vec<Panel> {
    let curve = |name: &str, values: Vec<f64>| Curve { name: name.to_owned(), values };
    let change: Vec<f64> = {
        let energy = r.energy();
        let start = energy.first().copied().unwrap_or(0.0);
        energy.iter().map(|e| e - start).collect()
    };
    let all = vec![curve("kinetic T", r.kinetic.clone()), curve("potential U", r.potential.clone()), curve("T + U", r.energy())];
    let mut flows =
        vec![curve("T + U − start", change), curve("work of motors", r.work.clone()), curve("dissipated", r.dissipated.clone())];
    let mapped = r.from_events.iter().any(|e| *e != 0.0);
    if mapped {
        flows.push(curve("from events", r.from_events.clone()));
    }
    let missing = vec![curve("imbalance", r.imbalance())];
    vec![
        Panel { title: "energy, J".to_owned(), curves: all },
        Panel { title: "where it came from and went, J".to_owned(), curves: flows },
        Panel {
            title: format!("T + U − start − work − dissipated{}, J", if mapped { " − from events" } else { "" }), curves: missing
        },
    ]
}

/// Contents of a panel.
#[derive(Clone, Debug)]
struct Panel {
    /// Over the field, with the unit: `angle, rad`.
    title: String,
    curves: Vec<Curve>,
}

const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 250.0;

/// Room left of the field, right of it, over it and under it.
const LEFT: f64 = 64.0;
const RIGHT: f64 = 168.0;
const TOP: f64 = 30.0;
const BOTTOM: f64 = 40.0;

/// The room for a name.
const NAME: f64 = RIGHT - 42.0;

const EVENT: &str = "#9a9a9a";
/// Of lines at events.
const DASH: Dash = [4.0, 3.0];

/// Draws a panel with its corner at a place.
fn draw(out: &mut Drawing, panel: &Panel, clock: &Clock, [x0, y0]: Point) {
    let (left, right, top, bottom) = (x0 + LEFT, x0 + WIDTH - RIGHT, y0 + TOP, y0 + HEIGHT - BOTTOM);
    let time = Axis::exactly(clock.t.iter().copied(), [left, right], 6.0);
    let value = Axis::around(panel.curves.iter().flat_map(|c| c.values.iter().copied()), [bottom, top], 5.0);
    let [along, up] = axes(out, [&time, &value], [left, right, top, bottom]);
    out.text([left, y0 + 18.0], Anchor::Start, 12.0, INK, &titled(&panel.title, up));
    out.text([(left + right) / 2.0, y0 + HEIGHT - 8.0], Anchor::Middle, SMALL, GREY, &titled(&clock.title, along));
    for &e in clock.events.iter().filter(|e| time.holds(**e)) {
        out.line(vec![[time.at(e), top], [time.at(e), bottom]], EVENT, 0.8, Some(DASH));
    }
    let strokes = strokes(&panel.curves, &value, right - left);
    for (curve, stroke) in panel.curves.iter().zip(&strokes) {
        for points in thinned(&clock.t, &curve.values, &time, &value) {
            out.line(points, stroke.colour, stroke.width, stroke.dash);
        }
    }
    legend(out, panel, &strokes, !clock.events.is_empty(), [right + 12.0, top + 6.0]);
}

/// Title of an axis, with the power of ten of its numbers.
fn titled(what: &str, power: i32) -> String {
    if power == 0 { what.to_owned() } else { format!("{what} (numbers × 10{})", raised(power)) }
}

/// Grid and numbers; the powers of ten of those below and of those at the left.
fn axes(out: &mut Drawing, [time, value]: [&Axis; 2], [left, right, top, bottom]: [f64; 4]) -> [i32; 2] {
    let ((below, along), (beside, up)) = (time.ticks(), value.ticks());
    out.ticks_below(time, &below, [top, bottom]);
    out.ticks_beside(value, &beside, [left, right]);
    out.path(vec![[left, top], [left, bottom], [right, bottom]], GREY, 1.0);
    [along, up]
}

fn legend(out: &mut Drawing, panel: &Panel, strokes: &[Stroke], events: bool, [x, y]: Point) {
    let row = |k: usize| [x, y + 17.0 * k as f64];
    for ((k, curve), stroke) in panel.curves.iter().enumerate().zip(strokes) {
        out.key(row(k), (stroke.colour, stroke.dash), INK, &curve.name);
    }
    if events {
        out.key(row(panel.curves.len()), (EVENT, Some(DASH)), GREY, "events");
    }
}

/// The curve's points, in finite pieces: of many points at the same place of the axis, the first,
/// the least, the largest and the last.
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

/// A curve and its name.
#[derive(Clone, Debug)]
struct Curve {
    name: String,
    values: Vec<f64>,
}

/// Colours of curves, distinguishable with colour blindness, on screen and in print. Their number
/// is the largest number of curves of a panel.
const COLOURS: [&str; 8] = ["#1b6ca8", "#d9822b", "#3f8f5b", "#c2453f", "#7a5195", "#b59f00", "#36a9bf", "#555555"];

/// The stroke of a curve.
#[derive(Clone, Debug, PartialEq)]
struct Stroke {
    colour: &'static str,
    width: f64,
    dash: Option<Dash>,
}

/// Curves closer to each other than this coincide, in points.
const APART: f64 = 0.75;
/// Visible part of each of several coinciding curves, in points.
const SHOWN: f64 = 6.0;
/// Minimum points per oscillation for a line of full width; with fewer it is thinner.
const WAVE: f64 = 12.0;

/// Widths of a line.
const THICK: f64 = 1.5;
const THIN: f64 = 0.5;

/// Strokes of the curves of a panel, over a field of this width in points: curves with too many
/// oscillations to be distinguished are thinner; of coinciding curves all but the first are dashed,
/// later ones with shorter dashes.
fn strokes(curves: &[Curve], value: &Axis, width: f64) -> Vec<Stroke> {
    let first = firsts(curves, value);
    let alike = |k: usize| first.iter().filter(|f| **f == first[k]).count();
    let before = |k: usize| first[..k].iter().filter(|f| **f == first[k]).count();
    let dash = |k: usize| {
        let (all, over) = (alike(k) as f64, before(k) as f64);
        (over > 0.0).then_some([SHOWN * (all - over), SHOWN * over])
    };
    let line = |k: usize| (THICK * width / (WAVE * waves(&curves[k].values, value))).clamp(THIN, THICK);
    (0..first.len()).map(|k| Stroke { colour: COLOURS[k % COLOURS.len()], width: line(k), dash: dash(k) }).collect()
}

/// For each curve the first curve that it coincides with.
fn firsts(curves: &[Curve], value: &Axis) -> Vec<usize> {
    let same = |a: f64, b: f64| (a.is_nan() && b.is_nan()) || (value.at(a) - value.at(b)).abs() < APART;
    let mut out: Vec<usize> = Vec::new();
    for (k, curve) in curves.iter().enumerate() {
        let on = |other: &usize| curves[*other].values.iter().zip(&curve.values).all(|(a, b)| same(*a, *b));
        out.push((0..k).filter(|j| out[*j] == *j).find(on).unwrap_or(k));
    }
    out
}

/// Number of visible oscillations of a curve.
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

/// Times, and the title of their axis.
struct Clock {
    t: Vec<f64>,
    /// Of events.
    events: Vec<f64>,
    title: String,
}

/// A motion that starts this many of its lengths after 0 gets tick labels relative to its start.
/// Otherwise all labels would differ only in their last digits.
const FAR: f64 = 1e4;

impl Clock {
    fn of(t: &[f64], events: &[f64]) -> Self {
        let [first, last] = [t.first(), t.last()].map(|t| t.copied().unwrap_or(0.0));
        if first.abs().max(last.abs()) <= FAR * (last - first) || first == 0.0 {
            return Self { t: t.to_vec(), events: events.to_vec(), title: "time, s".to_owned() };
        }
        let since = |all: &[f64]| all.iter().map(|t| t - first).collect();
        let start = if (1e-4..1e15).contains(&first.abs()) { first.to_string() } else { format!("{first:e}") };
        Self { t: since(t), events: since(events), title: format!("time since {} s, s", start.replace('-', "−")) }
    }
}

#[cfg(test)]
mod tests {
    use articulated_lab::plot::Mark;

    use super::super::recording::example;
    use super::*;
    use crate::robot::bundled_model;

    #[test]
    fn no_panel_has_more_than_eight_curves_and_all_curves_are_there() {
        let r = example(&bundled_model("humanoid"), 4);
        let all = panels(&coordinates(&r.q_names, &r, &r.q));
        assert!(all.iter().all(|p| (1..=8).contains(&p.curves.len())));
        assert_eq!(all.iter().map(|p| p.curves.len()).sum::<usize>(), r.q_names.len());
    }

    #[test]
    fn what_is_left_out_is_said() {
        let mut r = example(&bundled_model("quadruped"), 50);
        r.events = vec![r.events[0].clone(); EVENTS + 1];
        let torque =
            |r: &mut Recording, force: f64| r.tau.iter_mut().enumerate().for_each(|(k, x)| *x = if k % 18 == 7 { force } else { 0.0 });
        torque(&mut r, 1.0);
        let all = pictures(&r, "few");
        assert!(all.iter().all(|p| p.svg.contains("61 events, not drawn") && !p.svg.contains(">events<")));
        assert!(
            all[2].svg.contains("17 of 18 curves are not drawn: zero, or at most 1e-12 of the largest")
                && all[2].svg.matches("time, s").count() == 1
        );
        torque(&mut r, 0.0);
        assert_eq!(pictures(&r, "none").iter().map(|p| p.name).collect::<Vec<_>>(), ["positions", "velocities", "energy"]);
        // One angle at zero among others that move; and a robot at rest at zero.
        r.q.iter_mut().skip(9).step_by(19).for_each(|x| *x = 0.0);
        let drawn = &pictures(&r, "few")[0].svg;
        assert!(drawn.contains("1 of 19 curves are not drawn") && !drawn.contains(&format!(">{}<", r.q_names[9].label)));
        (r.q, r.v) = (vec![0.0; r.q.len()], vec![0.0; r.v.len()]);
        assert_eq!(pictures(&r, "still").iter().map(|p| p.name).collect::<Vec<_>>(), ["energy"]);
        // Small numbers alone are drawn; next to large ones they are rounding errors.
        torque(&mut r, 9e-13);
        let drawn = &pictures(&r, "small")[0];
        assert!(drawn.name == "torques" && drawn.svg.contains("17 of 18 curves") && drawn.svg.contains("torque, N·m (numbers × 10⁻¹"));
        r.tau[0] = f64::NAN;
        r.tau[1] = 1.0;
        r.tau[2] = f64::INFINITY;
        assert!(pictures(&r, "small")[0].svg.contains("15 of 18 curves"));
    }

    #[test]
    fn pictures_are_xml_with_every_series() {
        let r = example(&bundled_model("quadruped"), 50);
        let all = pictures(&r, "a <quadruped> & \"more\"");
        assert_eq!(all.iter().map(|p| p.name).collect::<Vec<_>>(), ["positions", "velocities", "torques", "energy"]);
        for p in &all {
            assert_eq!(roxmltree::Document::parse(&p.svg).unwrap().root_element().tag_name().name(), "svg");
        }
        assert!(!all[0].svg.contains("not drawn"));
        assert!(r.q_names.iter().filter(|n| n.label.len() < 16).all(|n| all[0].svg.contains(&format!(">{}<", n.label))));
    }

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

    /// Each number at the axis, multiplied by the axis's power, is a time.
    #[test]
    fn the_axis_of_time_tells_its_power() {
        for (end, told, last) in
            [(5e-4, "time, s (numbers × 10⁻⁶)", "500"), (1e5, "time, s (numbers × 10³)", "100"), (10.0, "time, s", "10")]
        {
            let panel = Panel { title: String::new(), curves: vec![Curve { name: String::new(), values: vec![0.0, 1.0] }] };
            let mut out = Drawing::default();
            draw(&mut out, &panel, &Clock::of(&[0.0, end], &[]), [0.0, 0.0]);
            let has = |text: &str| out.marks.iter().any(|m| matches!(m, Mark::Text(found) if found.content() == text));
            assert!(has(told) && has(last), "{end} s: {:?}", out.marks);
        }
    }

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
        assert_eq!(widths, [THICK, THIN]);
    }

    #[test]
    fn times_far_from_zero_are_told_from_the_start() {
        let clock = Clock::of(&[-1e6, -1e6 + 0.5], &[-1e6 + 0.25]);
        assert_eq!((clock.t, clock.events, clock.title.as_str()), (vec![0.0, 0.5], vec![0.25], "time since −1000000 s, s"));
        assert_eq!(Clock::of(&[1e20, 1e20], &[]).title, "time since 1e20 s, s");
        for near in [&[0.0, 5e-4][..], &[-0.1, 1.0], &[100.0, 110.0], &[0.0], &[]] {
            let clock = Clock::of(near, &[]);
            assert_eq!((&clock.t[..], clock.title.as_str()), (near, "time, s"));
        }
    }
}
