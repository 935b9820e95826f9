//! Generated code of a robot at a level, compiled.

use articulated_codegen::{Generated, Precision, Request, generate};
use articulated_core::algorithm::FunctionId;
use articulated_core::description::Description;

use crate::compiled::{Compiled, Rustc};
use crate::error::Error;
use crate::stress::judge::State;
use crate::stress::machine::{cast, widened};

/// The generated code and its compilation.
#[derive(Debug)]
pub struct BuiltRobot {
    pub(super) generated: Generated,
    compiled: Compiled,
}

impl BuiltRobot {
    /// Compiles generated code.
    pub(crate) fn of(generated: Generated) -> Result<Self, Error> {
        let rustc = Rustc::find().map_err(|e| Error::tool(&e))?;
        let compiled = Compiled::build(&rustc, &generated).map_err(|e| Error::tool(&e))?;
        Ok(Self { generated, compiled })
    }

    /// From a description, with these functions.
    pub(super) fn of_description(name: &str, robot: &Description, level: Precision, functions: &[FunctionId]) -> Result<Self, Error> {
        let mut request = Request::new(format!("{name}.urdf"), articulated_formats::urdf::write(robot));
        request.options.functions = functions.iter().map(|f| f.name().into()).collect();
        request.options.level = level;
        request.options.stages = false;
        Self::of(generate(&request)?)
    }

    /// How accurate it is.
    pub fn level(&self) -> Precision {
        self.generated.level
    }

    /// Of the functions that it has: their places in the ledger.
    pub(super) fn place(&self, function: FunctionId) -> Option<usize> {
        self.generated.ledger.functions.iter().position(|f| f.function == function.name())
    }

    /// In numbers that the level takes.
    pub(super) fn rounded(&self, state: &State) -> State {
        let round = |x: &[f64]| if self.level().is_single() { widened(&cast::<f32>(x)) } else { x.to_vec() };
        let State { q, v, a, tau } = state;
        State { q: round(q), v: round(v), a: round(a), tau: round(tau) }
    }

    /// `None` if it could not be called.
    pub(super) fn call(&self, function: FunctionId, arguments: &[Vec<f64>]) -> Option<Vec<f64>> {
        let slices: Vec<&[f64]> = arguments.iter().map(Vec::as_slice).collect();
        let mut out = vec![f64::NAN; function.row::<f64>().len(self.generated.model.shape())];
        self.compiled.call(function.name(), &slices, &mut out).ok()?;
        Some(out)
    }
}
