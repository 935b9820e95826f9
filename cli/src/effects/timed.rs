//! Times of effects. Without the feature `measure`, `untimed.rs` is in place of this.

use articulated_codegen::Generated;
use articulated_core::algorithm::function;
use articulated_lab::compare::contender::Contender;
use articulated_lab::compiled::{Compiled, Rustc};
use articulated_lab::session::Session;
use articulated_lab::timing::{self, Run};

use super::cost::FIRST;
use super::report::Cost;
use crate::console::Progress;
use crate::failure::Failure;
use crate::{parallel, states};

/// States that functions are timed on.
const STATES: usize = 64;

/// The compiler of the timed code.
pub(super) struct Compiler(Rustc);

impl Compiler {
    pub(super) fn find() -> Result<Self, Failure> {
        Rustc::find().map(Self).map_err(|e| Failure::tool(&e))
    }

    pub(super) fn version(&self) -> String {
        self.0.version.clone()
    }

    /// Compiles all of it and times each function, all variants in turn.
    pub(super) fn time(
        &self,
        session: &Session,
        made: &[Generated],
        repetitions: usize,
        costs: &mut [Cost],
        progress: &Progress,
    ) -> Result<(), Failure> {
        progress.doing("rustc".to_owned());
        let compiled = parallel::map(made, |generated| Compiled::build(&self.0, generated));
        let compiled: Vec<Compiled> = compiled.into_iter().collect::<Result<_, _>>().map_err(|e| Failure::tool(&e))?;
        let states = states::random(&session.model, STATES, 1);
        for cost in costs {
            let Some(row) = function::<f64>(&cost.function) else { continue };
            progress.doing(format!("{}: times", row.name));
            let arguments: Vec<Vec<&[f64]>> = states.iter().map(|s| s.arguments(row).unwrap_or_default()).collect();
            let contenders: Vec<Contender> = compiled.iter().map(|c| Contender::generated(c, row)).collect();
            let mut runs: Vec<Run<'_>> = contenders.iter().map(|c| c.run(&arguments)).collect();
            let times = timing::interleaved(&mut runs, repetitions);
            drop(runs);
            if let Some(whole) = cost.without.as_mut().or(cost.only_with.as_mut().map(|only| &mut only.cost)) {
                whole.ns = Some(timing::summary(&times[FIRST]));
            }
            for (added, time) in cost.adds.iter_mut().zip(&times[1..]) {
                let sign = if added.what == "gravity" { -1.0 } else { 1.0 };
                let more: Vec<f64> = time.iter().zip(&times[FIRST]).map(|(with, without)| sign * (with - without)).collect();
                added.ns = Some(timing::summary(&more));
            }
            progress.step();
        }
        Ok(())
    }
}
