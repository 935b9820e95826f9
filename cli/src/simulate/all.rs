//! `articulated simulate --all`: how fast each bundled scene is.

use serde::Serialize;

use super::arguments::SimulateArguments;
use super::stage::Stage;
use super::straight::Straight;
use super::summary::Summary;
use super::{motion, settings};
use crate::arguments::Format;
use crate::compiled::Rustc;
use crate::console::{self, Progress};
use crate::failure::Failure;
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
    /// Largest imbalance of energy over the largest energy moved.
    relative_imbalance: f64,
    /// Simulated seconds per second.
    generated: f64,
    generic: f64,
}

/// Runs every bundled scene, by generated and by generic code, without writing anything.
pub(super) fn run(arguments: &SimulateArguments, format: Format) -> Result<(), Failure> {
    let rustc = Rustc::find().map_err(|e| Failure::tool(&e))?;
    let progress = Progress::new(articulated_models::SCENES.len());
    let mut rows = Vec::new();
    for scene in articulated_models::SCENES {
        progress.doing(scene.name.to_owned());
        rows.push(row(scene.name, arguments, &rustc)?);
        progress.step();
    }
    drop(progress);
    console::print(&match format {
        Format::Text => text(&rows),
        Format::Json => crate::json(&rows),
    })
}

fn row(name: &'static str, arguments: &SimulateArguments, rustc: &Rustc) -> Result<Row, Failure> {
    let stage = Stage::find(name)?;
    let settings = settings::of(&stage, arguments)?;
    let begin = motion::begin(&stage)?;
    let (generated, frames) = motion::generate(&stage, settings.integrator)?;
    let robot = Straight::build(rustc, &generated).map_err(|e| Failure::tool(&e))?;
    let quiet = Progress::hidden();
    let fast = motion::run(&stage, &begin, (&robot, &frames), &settings, &quiet)?;
    let slow = motion::run(&stage, &begin, (&stage.model, &stage.frame_names()), &settings, &quiet)?;
    let (fast, slow) = (Summary::new(&stage, &fast, &settings, "generated"), Summary::new(&stage, &slow, &settings, "generic"));
    if let Some(error) = fast.error.or(slow.error) {
        return Err(Failure::input([format!("{name}: {error}")]));
    }
    Ok(Row {
        scene: name,
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
