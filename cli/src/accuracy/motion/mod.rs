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

use sweep::{Motion, Sample};

/// Measures and prints.
pub(super) fn run(arguments: &AccuracyArguments, format: Format) -> Result<(), Failure> {
    let (stage, subject) = scene::find(&arguments.robot.robot)?;
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
    arguments.output.as_ref().map_or(Ok(()), |folder| write(folder, &motion)).map_err(Failure::after_report)
}

fn write(folder: &Path, motion: &Motion) -> Result<(), Failure> {
    let failed = |path: &Path, e: &dyn std::fmt::Display| Failure::input([format!("{}: {e}", path.display())]);
    std::fs::create_dir_all(folder).map_err(|e| failed(folder, &e))?;
    let put = |name: &str, bytes: &[u8]| {
        let path = folder.join(name);
        std::fs::write(&path, bytes).map_err(|e| failed(&path, &e))
    };
    let diagrams = plot::diagrams(motion);
    for (name, drawing) in &diagrams {
        put(&format!("{name}.svg"), picture::svg(drawing).as_bytes())?;
        put(&format!("{name}.png"), &picture::png(drawing).map_err(|e| failed(folder, &e))?)?;
    }
    put("integrators.csv", text::csv(motion).as_bytes())?;
    put("integrators.json", crate::json(motion).as_bytes())?;
    put("integrators.html", page::html(motion, &diagrams).as_bytes())
}
