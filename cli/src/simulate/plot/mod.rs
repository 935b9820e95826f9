//! Pictures of a recording: angles, velocities, torques and energies over time, as SVG and as PNG.

mod axis;
mod clock;
pub(crate) mod drawing;
mod font;
mod label;
mod panel;
pub(crate) mod png;
mod stroke;
pub(crate) mod svg;

use super::recording::{Named, Recording};
use clock::Clock;
use drawing::{Anchor, Drawing};
use panel::{Curve, Panel};

/// A picture in both forms.
pub(super) struct Picture {
    /// Of its files, without the ending.
    pub(super) name: &'static str,
    pub(super) svg: String,
    pub(super) png: Vec<u8>,
}

/// More events than this are counted and not drawn: they would be all that is seen.
const EVENTS: usize = 60;

/// Of the largest number of a picture: what is no more than this throughout is rounding of it as a rule, and a line at zero beside it.
const UNSEEN: f64 = 1e-12;

/// What there can be pictures of; of energy there always is one.
pub(super) const PICTURES: [&str; 4] = ["positions", "velocities", "torques", "energy"];

/// All pictures of a motion called `title`; one without a curve that is worth drawing is none.
pub(super) fn pictures(r: &Recording, title: &str) -> Result<Vec<Picture>, String> {
    let moving = |names: &[Named], rows: &[f64]| (panels(&seen(coordinates(names, r, rows))), names.len());
    let kinds = [moving(&r.q_names, &r.q), moving(&r.v_names, &r.v), moving(&r.tau_names, &r.tau), (energies(r), 0)];
    let worth = PICTURES.into_iter().zip(kinds).filter(|(_, (panels, _))| !panels.is_empty());
    worth.map(|(name, (panels, all))| picture(name, &panels, &notes(r, &panels, all), r, title)).collect()
}

/// Without those that are zero throughout, or as good as that beside the largest.
fn seen(mut all: Vec<Series>) -> Vec<Series> {
    let numbers = all.iter().flat_map(|(_, values)| values).map(|x| x.abs());
    let least = UNSEEN * numbers.filter(|x| x.is_finite()).fold(0.0, f64::max);
    all.retain(|(_, values)| values.iter().any(|x| x.is_nan() || x.abs() > least));
    all
}

/// What a picture leaves out of so many curves, and of the events.
fn notes(r: &Recording, panels: &[Panel], all: usize) -> String {
    let left = all.saturating_sub(panels.iter().map(|p| p.curves.len()).sum());
    let curves =
        (left > 0).then(|| format!("{left} of {all} curves are not drawn: zero, or at most {UNSEEN:e} of the largest number here"));
    let events = (r.events.len() > EVENTS).then(|| format!("{} events, not drawn", r.events.len()));
    curves.into_iter().chain(events).collect::<Vec<_>>().join("; ")
}

fn picture(name: &'static str, panels: &[Panel], notes: &str, r: &Recording, title: &str) -> Result<Picture, String> {
    let head = if notes.is_empty() { 30.0 } else { 48.0 };
    let events: Vec<f64> = if r.events.len() <= EVENTS { r.events.iter().map(|e| e.time).collect() } else { Vec::new() };
    let columns = if panels.len() > 3 { 2 } else { 1 };
    let rows = panels.len().div_ceil(columns);
    let mut out = Drawing { width: panel::WIDTH * columns as f64, height: head + panel::HEIGHT * rows as f64, ..Drawing::default() };
    out.text([16.0, 22.0], Anchor::Start, 14.0, "#222222", &format!("{title}: {name}"));
    if !notes.is_empty() {
        out.text([16.0, 40.0], Anchor::Start, 11.0, "#555555", notes);
    }
    let clock = Clock::of(&r.t, &events);
    for (k, p) in panels.iter().enumerate() {
        let corner = [panel::WIDTH * (k % columns) as f64, head + panel::HEIGHT * (k / columns) as f64];
        panel::draw(&mut out, p, &clock, corner);
    }
    Ok(Picture { name, svg: svg::text(&out), png: png::bytes(&out)? })
}

type Series = (Named, Vec<f64>);

fn coordinates(names: &[Named], r: &Recording, rows: &[f64]) -> Vec<Series> {
    names.iter().enumerate().map(|(k, n)| (n.clone(), r.series(names, rows, k))).collect()
}

/// What a panel of numbers of this unit is about.
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

/// Numbers of one unit share panels, those of the base apart; at most eight to a panel, and no panel is much emptier than another.
fn panels(series: &[Series]) -> Vec<Panel> {
    let mut kinds: Vec<(bool, &str)> = Vec::new();
    for (n, _) in series {
        if !kinds.contains(&(n.base, n.unit)) {
            kinds.push((n.base, n.unit));
        }
    }
    let labels: Vec<String> = series.iter().map(|(n, _)| crate::table::plain(&n.label)).collect();
    let labels = label::told_apart(&labels, panel::SMALL, panel::NAME);
    let mut out = Vec::new();
    for kind in kinds {
        let alike: Vec<_> = series.iter().zip(&labels).filter(|((n, _), _)| (n.base, n.unit) == kind).collect();
        let count = alike.len().div_ceil(panel::COLOURS.len());
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

#[cfg(test)]
mod tests {
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
        let all = pictures(&r, "few").unwrap();
        assert!(all.iter().all(|p| p.svg.contains("61 events, not drawn") && !p.svg.contains(">events<")));
        assert!(
            all[2].svg.contains("17 of 18 curves are not drawn: zero, or at most 1e-12 of the largest")
                && all[2].svg.matches("time, s").count() == 1
        );
        torque(&mut r, 0.0);
        assert_eq!(pictures(&r, "none").unwrap().iter().map(|p| p.name).collect::<Vec<_>>(), ["positions", "velocities", "energy"]);
        // One angle at zero among others that move; and a robot at rest at zero.
        r.q.iter_mut().skip(9).step_by(19).for_each(|x| *x = 0.0);
        let drawn = &pictures(&r, "few").unwrap()[0].svg;
        assert!(drawn.contains("1 of 19 curves are not drawn") && !drawn.contains(&format!(">{}<", r.q_names[9].label)));
        (r.q, r.v) = (vec![0.0; r.q.len()], vec![0.0; r.v.len()]);
        assert_eq!(pictures(&r, "still").unwrap().iter().map(|p| p.name).collect::<Vec<_>>(), ["energy"]);
        // What is small by itself is there; beside what is large it is rounding.
        torque(&mut r, 9e-13);
        let drawn = &pictures(&r, "small").unwrap()[0];
        assert!(drawn.name == "torques" && drawn.svg.contains("17 of 18 curves") && drawn.svg.contains("torque, N·m (numbers × 10⁻¹"));
        r.tau[0] = f64::NAN;
        r.tau[1] = 1.0;
        r.tau[2] = f64::INFINITY;
        assert!(pictures(&r, "small").unwrap()[0].svg.contains("15 of 18 curves"));
    }

    #[test]
    fn pictures_are_xml_with_every_series_and_png() {
        let r = example(&bundled_model("quadruped"), 50);
        let all = pictures(&r, "a <quadruped> & \"more\"").unwrap();
        assert_eq!(all.iter().map(|p| p.name).collect::<Vec<_>>(), ["positions", "velocities", "torques", "energy"]);
        for p in &all {
            assert_eq!(roxmltree::Document::parse(&p.svg).unwrap().root_element().tag_name().name(), "svg");
            assert!(p.png.starts_with(b"\x89PNG\r\n\x1a\n"));
        }
        assert!(!all[0].svg.contains("not drawn"));
        assert!(r.q_names.iter().filter(|n| n.label.len() < 16).all(|n| all[0].svg.contains(&format!(">{}<", n.label))));
    }
}
