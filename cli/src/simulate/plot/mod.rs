//! Pictures of a recording: angles, velocities, torques and energies over time, as SVG and as PNG.

mod axis;
pub(crate) mod drawing;
mod font;
mod panel;
pub(crate) mod png;
pub(crate) mod svg;

use super::recording::{Named, Recording};
use drawing::{Anchor, Drawing};
use panel::{Curve, Panel};

/// A picture in both forms.
pub(super) struct Picture {
    /// Of its files, without the ending.
    pub(super) name: &'static str,
    pub(super) svg: String,
    pub(super) png: Vec<u8>,
}

/// More events than this are not drawn: they would be all that is seen.
const EVENTS: usize = 60;

/// All pictures of a motion called `title`.
pub(super) fn pictures(r: &Recording, title: &str) -> Result<Vec<Picture>, String> {
    let kinds = [
        ("positions", panels(&coordinates(&r.q_names, r, &r.q))),
        ("velocities", panels(&coordinates(&r.v_names, r, &r.v))),
        ("torques", panels(&coordinates(&r.tau_names, r, &r.tau))),
        ("energy", energies(r)),
    ];
    kinds.into_iter().filter(|(_, panels)| !panels.is_empty()).map(|(name, panels)| picture(name, &panels, r, title)).collect()
}

fn picture(name: &'static str, panels: &[Panel], r: &Recording, title: &str) -> Result<Picture, String> {
    const HEAD: f64 = 30.0;
    let events: Vec<f64> = if r.events.len() <= EVENTS { r.events.iter().map(|e| e.time).collect() } else { Vec::new() };
    let columns = if panels.len() > 3 { 2 } else { 1 };
    let rows = panels.len().div_ceil(columns);
    let mut out = Drawing { width: panel::WIDTH * columns as f64, height: HEAD + panel::HEIGHT * rows as f64, ..Drawing::default() };
    out.text([16.0, 22.0], Anchor::Start, 14.0, "#222222", &format!("{title}: {name}"));
    for (k, p) in panels.iter().enumerate() {
        let corner = [panel::WIDTH * (k % columns) as f64, HEAD + panel::HEIGHT * (k / columns) as f64];
        panel::draw(&mut out, p, &r.t, &events, corner);
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
    let mut out = Vec::new();
    for kind in kinds {
        let alike: Vec<&Series> = series.iter().filter(|(n, _)| (n.base, n.unit) == kind).collect();
        let count = alike.len().div_ceil(panel::COLOURS.len());
        for part in alike.chunks(alike.len().div_ceil(count)) {
            let curves = part.iter().map(|(n, values)| Curve { name: n.label.clone(), values: values.clone() }).collect();
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
    fn pictures_are_xml_with_every_series_and_png() {
        let r = example(&bundled_model("quadruped"), 50);
        let all = pictures(&r, "a <quadruped> & \"more\"").unwrap();
        assert_eq!(all.iter().map(|p| p.name).collect::<Vec<_>>(), ["positions", "velocities", "torques", "energy"]);
        for p in &all {
            assert_eq!(roxmltree::Document::parse(&p.svg).unwrap().root_element().tag_name().name(), "svg");
            assert!(p.png.starts_with(b"\x89PNG\r\n\x1a\n"));
        }
        assert!(r.q_names.iter().filter(|n| n.label.len() < 16).all(|n| all[0].svg.contains(&format!(">{}<", n.label))));
    }
}
