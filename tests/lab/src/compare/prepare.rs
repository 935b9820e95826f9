//! Everything about a function except its time: generated, compiled, judged. Functions are prepared
//! in parallel; they are timed when all are ready.

use std::time::{Duration, Instant};

use articulated_codegen::ledger::Entry;
use articulated_core::algorithm::Function;
use articulated_core::diagnostic::Diagnostics;
use articulated_core::lanes::Real;
use articulated_core::model::Model;

use super::accuracy::{self, Errors, Reference};
use super::contender::Contender;
use crate::compiled::{Cc, Compiled, CompiledBatches, Rustc, Target};
use crate::console::Progress;
use crate::error::{Error, undefined};
use crate::robot::Robot;
use crate::states::{self, State};
use crate::tips::{FEW, Tips};

/// Inputs of the prepared functions.
pub(super) struct Plan {
    pub(super) robot: Robot,
    /// The frames of each function, unless the user chose them.
    pub(super) tips: Option<Tips>,
    pub(super) reference: Reference,
    pub(super) rustc: Rustc,
    pub(super) states: usize,
    pub(super) seed: u64,
    /// The types in which many states at once are compared too.
    pub(super) batch: Vec<Real>,
    /// The compilers of the same functions in C.
    pub(super) compilers: Vec<Cc>,
    /// Whether the user named the functions: otherwise those that take rustc minutes are left out.
    pub(super) named: bool,
}

/// With more instructions than this a function is compared only if it is named: rustc takes longer
/// than all others together.
const MOST: u64 = 20_000;

/// The name of code compiled without options for this machine.
const DEFAULT_BUILD: &str = "any processor";

/// A function that is ready to run.
pub(super) struct Prepared {
    pub(super) function: &'static Function<f64>,
    /// With the function's frames.
    pub(super) model: Model<f64>,
    pub(super) states: Vec<State>,
    pub(super) compiled: Compiled,
    /// Our other code, with its name: the same source for any processor, if that differs, and C.
    pub(super) variants: Vec<(String, Compiled)>,
    /// Of many states at once.
    pub(super) batches: Option<CompiledBatches>,
    pub(super) entry: Entry,
    pub(super) source_bytes: usize,
    pub(super) generation: Duration,
    pub(super) errors: Option<Errors>,
}

/// Why a function is not.
pub(super) enum PrepareError {
    /// It does not exist for this robot.
    Undefined(String),
    Failed(Error),
}

impl Plan {
    pub(super) fn prepare(&self, function: &'static Function<f64>, progress: &Progress) -> Result<Prepared, PrepareError> {
        progress.doing(format!("{}: generation", function.name));
        let robot = self.robot_for(function)?;
        let start = Instant::now();
        let generated = robot.generate(&[function.name.to_owned()])?;
        let generation = start.elapsed();
        let instructions = generated.ledger.functions[0].emitted().instructions();
        if instructions > MOST && !self.named {
            let why = format!("{instructions} instructions take rustc minutes; name it in --functions to have it compared");
            return Err(PrepareError::Undefined(why));
        }
        progress.doing(format!("{}: rustc", function.name));
        let build = |target| Compiled::build_for(target, &self.rustc, &generated).map_err(|e| Error::tool(&e));
        let compiled = build(Target::Own)?;
        let mut variants = Vec::new();
        if Target::differ() {
            variants.push((DEFAULT_BUILD.to_owned(), build(Target::Any)?));
        }
        variants.extend(self.in_c(&robot, function, progress)?);
        let batches = (!self.batch.is_empty()).then(|| self.batches(&robot, function)).transpose()?;
        let (model, source_bytes, entry) = (generated.model, generated.source.len(), generated.ledger.functions.into_iter().next());
        let entry = entry.ok_or_else(|| Error::tool(&"the generator kept no account"))?;
        let states = states::random(&model, self.states, self.seed);
        progress.doing(format!("{}: errors", function.name));
        let ours = Contender::generated(&compiled, function);
        let errors = accuracy::errors(&self.reference, &model, function, &arguments(&states, function), &ours);
        progress.step();
        Ok(Prepared { function, model, states, compiled, variants, batches, entry, source_bytes, generation, errors })
    }

    /// The function in C, by each compiler.
    fn in_c(&self, robot: &Robot, function: &Function<f64>, progress: &Progress) -> Result<Vec<(String, Compiled)>, PrepareError> {
        if self.compilers.is_empty() {
            return Ok(Vec::new());
        }
        let mut robot = robot.clone();
        robot.options.target = Compiled::c_target();
        let generated = robot.generate(&[function.name.to_owned()])?;
        let one = |cc: &Cc| {
            progress.doing(format!("{}: {}", function.name, cc.name()));
            Ok((cc.name(), Compiled::build_c(cc, &generated).map_err(|e| Error::tool(&e))?))
        };
        self.compilers.iter().map(one).collect()
    }

    /// Which compilers of C there are, if they were `requested`.
    pub(super) fn note_of_c(&self, requested: bool) -> Option<String> {
        let all: Vec<String> = self.compilers.iter().map(|cc| format!("{} {}", cc.version, cc.flags().join(" "))).collect();
        let found = if all.is_empty() { "no compiler of C was found".to_owned() } else { format!("C by {}", all.join("; by ")) };
        requested.then_some(found)
    }

    /// The function of many states.
    fn batches(&self, robot: &Robot, function: &Function<f64>) -> Result<CompiledBatches, PrepareError> {
        let mut robot = robot.clone();
        robot.options.batch.clone_from(&self.batch);
        let generated = robot.generate(&[function.name.to_owned()])?;
        Ok(CompiledBatches::build(&self.rustc, &generated, &self.batch).map_err(|e| Error::tool(&e))?)
    }

    /// The robot with the frames that the function is compared on.
    fn robot_for(&self, function: &Function<f64>) -> Result<Robot, PrepareError> {
        let Some(tips) = &self.tips else { return Ok(self.robot.clone()) };
        let frames = tips.of_function(function).ok_or_else(|| PrepareError::Undefined(FEW.into()))?;
        Ok(self.robot.clone().on(frames))
    }
}

/// The arguments of a function in each state.
pub(super) fn arguments<'a>(states: &'a [State], function: &Function<f64>) -> Vec<Vec<&'a [f64]>> {
    states.iter().map(|s| s.arguments(function).unwrap_or_default()).collect()
}

impl From<Diagnostics> for PrepareError {
    fn from(findings: Diagnostics) -> Self {
        match undefined(findings) {
            Ok(why) => Self::Undefined(why),
            Err(other) => Self::Failed(other.into()),
        }
    }
}

impl From<Error> for PrepareError {
    fn from(failure: Error) -> Self {
        Self::Failed(failure)
    }
}
