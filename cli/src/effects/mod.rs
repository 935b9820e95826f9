//! `articulated effects`.

pub(crate) mod arguments;
mod cost;
mod report;
mod text;

use articulated_core::effect::Applied;

use crate::arguments::Format;
use crate::compiled::Rustc;
use crate::console::{self, Progress};
use crate::failure::Failure;
use crate::{named_scene, names};
use arguments::EffectsArguments;
use report::Report;

/// What is told where nobody asks for others.
const FUNCTIONS: [&str; 2] = ["inverse_dynamics", "forward_dynamics"];

/// The name of each sort of effect, once; effects stand by sorts.
pub(crate) fn sorts(effects: &[Applied]) -> Vec<&'static str> {
    let mut names: Vec<&'static str> = effects.iter().map(|one| one.effect.name()).collect();
    names.dedup();
    names
}

/// Prints what is on, off and not used, and what it costs.
pub(crate) fn run(arguments: &EffectsArguments, format: Format) -> Result<(), Failure> {
    let stage = named_scene::stage(&arguments.scene)?;
    let mut functions = names::flat(&arguments.functions);
    if functions.is_empty() {
        functions = FUNCTIONS.map(str::to_owned).to_vec();
    }
    if arguments.time {
        stage.is_of_doubles()?;
    }
    let rustc = arguments.time.then(Rustc::find).transpose().map_err(|e| Failure::tool(&e))?;
    let mut report = Report::of(&stage);
    report.compiler = rustc.as_ref().map(|rustc| rustc.version.clone());
    let parts = cost::parts(&stage, &functions)?;
    let progress = Progress::new(parts.iter().map(|part| part.steps(arguments.time)).sum());
    for part in &parts {
        let made = part.generate(&stage, &progress)?;
        report.limbs = made.iter().flat_map(|g| &g.ledger.functions).map(|f| f.lanes).fold(report.limbs, usize::max);
        let mut costs = part.counted(&made);
        if let Some(rustc) = &rustc {
            cost::time(&stage, &made, rustc, arguments.repetitions as usize, &mut costs, &progress)?;
        }
        report.costs.extend(costs);
    }
    report.costs.sort_by_key(|cost| functions.iter().position(|name| *name == cost.function));
    drop(progress);
    console::print(&match format {
        Format::Text => text::text(&report),
        Format::Json => crate::json(&report),
    })
}
