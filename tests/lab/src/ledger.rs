//! The generator's ledger as data for reports.

use articulated_codegen::ledger::Entry;
use serde::Serialize;

/// Counts after one stage of the generator.
#[derive(Clone, Debug, Serialize)]
pub struct Stage {
    /// Its name.
    pub stage: String,
    /// A multiply-add is one too.
    pub multiplications: u64,
    /// A multiply-add is one too.
    pub additions: u64,
    /// A multiply-add counted once; no sines and cosines.
    pub instructions: u64,
    /// Each by itself.
    pub sines_and_cosines: u64,
}

/// All stages of one function.
pub fn stages(entry: &Entry) -> Vec<Stage> {
    let stage = |(name, c): &(&'static str, articulated_codegen::graph::Counts)| Stage {
        stage: (*name).to_owned(),
        multiplications: c.multiplications(),
        additions: c.additions(),
        instructions: c.instructions(),
        sines_and_cosines: c.trigonometric(),
    };
    entry.stages.iter().map(stage).collect()
}
