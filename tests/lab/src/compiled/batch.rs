//! Generated functions of many states at once, compiled and loaded.

use std::time::Duration;

use articulated_codegen::Generated;
use articulated_core::algorithm::{Function, function};
use articulated_core::lanes::Real;

use super::Library;
use super::rustc::{CompileError, Rustc, Target};
use super::wrapper::{self, Layout};
use crate::native::BatchKernel;

/// A function in one type and layout.
#[derive(Clone, Debug)]
pub(crate) struct Batch {
    pub(crate) real: Real,
    pub(crate) layout: Layout,
    pub(crate) kernel: BatchKernel,
}

/// One function of many states, in all types that it was generated for.
#[derive(Debug)]
pub(crate) struct CompiledBatches {
    pub(crate) batches: Vec<Batch>,
    /// How long `rustc` took, start and linking included.
    pub(crate) time: Duration,
    // Last, so that the library is closed before its file is removed.
    _library: Library,
}

impl CompiledBatches {
    /// Compiles and loads the first generated function.
    pub(crate) fn build(rustc: &Rustc, generated: &Generated, reals: &[Real]) -> Result<Self, CompileError> {
        let missing = || CompileError::Load("there are no batches in the library that was compiled".into());
        let name = &generated.ledger.functions.first().ok_or_else(missing)?.function;
        let row: &Function<f64> = function(name).ok_or_else(missing)?;
        let library = Library::build(Target::Own, rustc, &generated.source, &wrapper::batches(name, reals))?;
        let shape = generated.model.shape();
        let batch = |real: Real, layout: Layout| {
            let states = layout.states(real);
            let lengths: Vec<usize> = row.takes.iter().map(|a| a.len(shape) * states).collect();
            let symbol = wrapper::batch_symbol(name, real, layout);
            let kernel = library.native.batch_kernel(&symbol, real, &lengths, row.len(shape) * states)?;
            Some(Batch { real, layout, kernel })
        };
        let all = reals.iter().flat_map(|real| Layout::ALL.map(|layout| (*real, layout)));
        let batches = all.map(|(real, layout)| batch(real, layout).ok_or_else(missing)).collect::<Result<_, _>>()?;
        Ok(Self { batches, time: library.time, _library: library })
    }
}
