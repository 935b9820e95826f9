//! `articulated effects`.

mod cost;
mod report;
mod text;
#[cfg_attr(not(feature = "measure"), path = "untimed.rs")]
mod timed;

use std::path::PathBuf;

use articulated_core::effect::Applied;
use clap::Args;

use crate::arguments::Format;
use crate::console::{self, Progress};
use crate::failure::Failure;
use crate::named_scene;
use crate::names::{self, Names, known};
use report::Report;
use timed::Compiler;

#[derive(Args, Debug)]
pub(crate) struct EffectsArguments {
    /// A bundled scene's name, or the path of a scene
    #[arg(value_name = "SCENE")]
    pub(crate) scene: PathBuf,
    /// The functions to report costs of, or groups of them
    /// [default: inverse_dynamics,forward_dynamics]
    #[arg(long, alias = "function", value_name = "NAMES", value_parser = known)]
    pub(crate) functions: Vec<Names>,
    /// Also measure nanoseconds: compile everything by rustc and time it
    #[arg(long)]
    pub(crate) time: bool,
    /// Repetitions of each timing
    #[arg(long, value_name = "N", default_value_t = 61, value_parser = clap::value_parser!(u32).range(5..=100_000))]
    pub(crate) repetitions: u32,
}

/// Functions reported by default.
const FUNCTIONS: [&str; 2] = ["inverse_dynamics", "forward_dynamics"];

/// The name of each kind of effect, once; effects are sorted by kind.
pub(crate) fn sorts(effects: &[Applied]) -> Vec<&'static str> {
    let mut names: Vec<&'static str> = effects.iter().map(|one| one.effect.name()).collect();
    names.dedup();
    names
}

/// Prints active, inactive and unused content, and costs.
pub(crate) fn run(arguments: &EffectsArguments, format: Format) -> Result<(), Failure> {
    let session = named_scene::session(&arguments.scene)?;
    let mut functions = names::flat(&arguments.functions);
    if functions.is_empty() {
        functions = FUNCTIONS.map(str::to_owned).to_vec();
    }
    if arguments.time {
        session.is_of_doubles()?;
    }
    let compiler = arguments.time.then(Compiler::find).transpose()?;
    let mut report = Report::of(&session);
    report.compiler = compiler.as_ref().map(Compiler::version);
    let parts = cost::parts(&session, &functions)?;
    let progress = Progress::new(parts.iter().map(|part| part.steps(arguments.time)).sum());
    for part in &parts {
        let made = part.generate(&session, &progress)?;
        report.limbs = made.iter().flat_map(|g| &g.ledger.functions).map(|f| f.lanes).fold(report.limbs, usize::max);
        let mut costs = part.counted(&made);
        if let Some(compiler) = &compiler {
            compiler.time(&session, &made, arguments.repetitions as usize, &mut costs, &progress)?;
        }
        report.costs.extend(costs);
    }
    report.costs.sort_by_key(|cost| functions.iter().position(|name| *name == cost.function));
    drop(progress);
    console::report(format, || text::text(&report), || crate::json(&report))
}
