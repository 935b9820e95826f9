//! `articulated simulate --all`: how fast each bundled scene is.

use std::path::Path;

use articulated_lab::session::Generic;
use serde::Serialize;

use super::Compiler;
use crate::arguments::Format;
use crate::console::{self, Progress};
use crate::failure::{Failure, OK, OUT_OF_TOLERANCE};
use crate::named_scene;
use crate::simulate::arguments::SimulateArguments;
use crate::simulate::summary::Summary;
use crate::simulate::{motion, settings};
use crate::table::{Table, number};

#[derive(Clone, Debug, Serialize)]
struct Row {
    scene: &'static str,
    degrees_of_freedom: usize,
    effects: Vec<&'static str>,
    integrator: &'static str,
    simulated_s: f64,
    steps: u64,
    evaluations: u64,
    /// `ok`, or `out_of_tolerance`: the balance of energy of one of the two runs is not kept.
    status: &'static str,
    /// Largest imbalance of energy over the largest energy moved.
    relative_imbalance: f64,
    /// Simulated seconds per second.
    generated: f64,
    generic: f64,
}

/// Runs every bundled scene, by generated and by generic code, without writing files. The status is
/// the worst one.
pub(in crate::simulate) fn run(arguments: &SimulateArguments, format: Format) -> Result<u8, Failure> {
    let compiler = Compiler::find()?;
    let progress = Progress::new(articulated_models::SCENES.len());
    let mut rows = Vec::new();
    for scene in articulated_models::SCENES {
        progress.doing(scene.name.to_owned());
        rows.push(row(scene.name, arguments, &compiler)?);
        progress.step();
    }
    drop(progress);
    console::report(format, || text(&rows), || crate::json(&rows))?;
    Ok(status(&rows))
}

/// The command's status: as for a single scene, if one ended outside its own tolerance.
fn status(rows: &[Row]) -> u8 {
    if rows.iter().all(|row| row.status == "ok") { OK } else { OUT_OF_TOLERANCE }
}

fn row(name: &'static str, arguments: &SimulateArguments, compiler: &Compiler) -> Result<Row, Failure> {
    let session = named_scene::session(Path::new(name))?;
    let settings = settings::of(&session, arguments)?;
    let initial = session.start()?;
    let code = compiler.code(&session, &settings)?;
    let quiet = Progress::hidden();
    let fast = motion::run(&session, &initial, &code, &settings, &quiet, &mut || true)?;
    let slow = motion::run(&session, &initial, &Generic, &settings, &quiet, &mut || true)?;
    let (fast, slow) = (Summary::new(&session, &fast, &settings, "generated"), Summary::new(&session, &slow, &settings, "generic"));
    if let Some(error) = fast.error.as_ref().or(slow.error.as_ref()) {
        return Err(Failure::input([format!("{name}: {error}")]));
    }
    for (run, code) in [(&fast, "generated"), (&slow, "generic")] {
        if let Some(warning) = run.out_of_balance() {
            console::warn(&format!("{name}: {code} code: {warning}"));
        }
    }
    Ok(Row {
        scene: name,
        status: [fast.status, slow.status].into_iter().find(|status| *status != "ok").unwrap_or("ok"),
        degrees_of_freedom: fast.degrees_of_freedom,
        effects: fast.effects,
        integrator: fast.integrator.name,
        simulated_s: fast.end_s - fast.start_s,
        steps: fast.counts.steps,
        evaluations: fast.counts.evaluations,
        relative_imbalance: fast.energy.relative_imbalance,
        generated: fast.simulated_s_per_wall_s,
        generic: slow.simulated_s_per_wall_s,
    })
}

fn text(rows: &[Row]) -> String {
    let columns = [
        ("scene", ""),
        ("effects", ""),
        ("degrees", "of freedom"),
        ("integrator", ""),
        ("motion", "s"),
        ("steps", ""),
        ("evaluations", ""),
        ("imbalance", "of energy"),
        ("generated", "s/s"),
        ("generic", "s/s"),
    ];
    let mut table = Table::new(columns).left(2);
    for r in rows {
        let counts = [r.steps.to_string(), r.evaluations.to_string(), format!("{:.0e}", r.relative_imbalance)];
        let speeds = [number(r.generated.round()), number(r.generic.round())];
        let head =
            [r.scene.to_owned(), r.effects.join(", "), r.degrees_of_freedom.to_string(), r.integrator.to_owned(), number(r.simulated_s)];
        table.row(head.into_iter().chain(counts).chain(speeds));
    }
    format!(
        "Simulated seconds per second of wall time, recording included, of generated code and of the generic library\n\n{}",
        table.text()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_scene_outside_its_tolerance_is_the_status_of_all() {
        let row = |status| Row {
            scene: "pendulum",
            degrees_of_freedom: 1,
            effects: Vec::new(),
            integrator: "rk4",
            simulated_s: 1.0,
            steps: 1,
            evaluations: 4,
            status,
            relative_imbalance: 0.0,
            generated: 1.0,
            generic: 1.0,
        };
        assert_eq!(status(&[row("ok"), row("ok")]), OK);
        assert_eq!(status(&[row("ok"), row("out_of_tolerance"), row("ok")]), OUT_OF_TOLERANCE);
    }
}
