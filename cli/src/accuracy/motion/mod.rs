//! `articulated accuracy --simulate`: what accuracy of a motion costs, integrator by integrator.

mod advise;
#[cfg(test)]
mod dop853_digits;
#[cfg(test)]
mod orders;
mod page;
mod peers;
mod plot;
mod scene;
mod subject;
mod sweep;
mod text;

use std::path::Path;

use super::plot as picture;
use crate::accuracy::arguments::AccuracyArguments;
use crate::arguments::Format;
use crate::console;
use crate::failure::Failure;
use crate::folder::Folder;
use crate::output;

use sweep::{Motion, Sample};

/// Measures and prints.
pub(super) fn run(arguments: &AccuracyArguments, format: Format) -> Result<(), Failure> {
    let (stage, subject) = scene::find(&arguments.robot.robot)?;
    arguments.output.as_deref().map_or(Ok(()), |folder| output::folder("--output", folder))?;
    let folder = Folder::new().map_err(|e| Failure::tool(&e))?;
    let peers = peers::Peers::open(&stage, &subject, arguments, folder.path())?;
    let motion = sweep::all(&stage.name, &subject, &peers, arguments.repetitions.min(5) as usize)?;
    console::print(&match (arguments.advise, arguments.error, format) {
        (true, Some(wish), Format::Text) => text::advice(&motion, wish),
        (true, Some(wish), Format::Json) => crate::json(&advise::all(&motion, wish)),
        (_, _, Format::Text) => text::text(&motion),
        (_, _, Format::Json) => crate::json(&motion),
    })?;
    // What took minutes to measure is told even if the files cannot be written.
    arguments.output.as_ref().map_or(Ok(()), |folder| write(folder, &motion)).map_err(Failure::after_report)?;
    match arguments.error.filter(|_| arguments.advise).filter(|wish| advise::all(&motion, *wish).runs.is_empty()) {
        None => Ok(()),
        Some(wish) => Err(Failure::bound_of_report(format!("{}: no run is accurate to {wish:e}", motion.scene))),
    }
}

fn write(folder: &Path, motion: &Motion) -> Result<(), Failure> {
    let put = |name: &str, bytes: &[u8]| output::write(&folder.join(name), bytes);
    let diagrams = plot::diagrams(motion);
    for (name, drawing) in &diagrams {
        put(&format!("{name}.svg"), picture::svg(drawing).as_bytes())?;
        put(&format!("{name}.png"), &picture::png(drawing).map_err(|e| Failure::tool(&e))?)?;
    }
    put("integrators.csv", text::csv(motion).as_bytes())?;
    put("integrators.json", crate::json(motion).as_bytes())?;
    put("integrators.html", page::html(motion, &diagrams).as_bytes())
}
