//! A compiled function of a level, called and timed.

use std::hint::black_box;
use std::time::Instant;

use articulated_codegen::Precision;
use articulated_core::algorithm::Function;

use crate::compiled::{Compiled, packed, unpacked};
use crate::native::Kernel;
use crate::timing::Run;

/// A function with the arguments of every state, as it takes them.
pub(super) struct Contender {
    kernel: Kernel,
    arguments: Vec<Vec<Vec<f64>>>,
    single: bool,
    count: usize,
}

impl Contender {
    /// `None` if the library does not have the function.
    pub(super) fn new(compiled: &Compiled, level: Precision, function: &Function<f64>, states: &[Vec<&[f64]>]) -> Option<Self> {
        let single = level.is_single();
        let form = |x: &&[f64]| if single { packed(x) } else { x.to_vec() };
        let arguments = states.iter().map(|state| state.iter().map(form).collect()).collect();
        Some(Self { kernel: compiled.kernel(function.name)?.clone(), arguments, single, count: function.len(compiled.shape()) })
    }

    fn room(&self) -> Vec<f64> {
        vec![0.0; if self.single { self.count.div_ceil(2) } else { self.count }]
    }

    /// The result in state `k`.
    pub(super) fn call(&self, k: usize) -> Vec<f64> {
        let mut out = self.room();
        let arguments: Vec<&[f64]> = self.arguments[k].iter().map(Vec::as_slice).collect();
        self.kernel.call(&arguments, &mut out);
        if self.single { unpacked(&out, self.count) } else { out }
    }

    /// The arguments of the first `states` states.
    pub(super) fn slices(&self, states: usize) -> Vec<Vec<&[f64]>> {
        self.arguments.iter().take(states).map(|x| x.iter().map(Vec::as_slice).collect()).collect()
    }

    /// The timed run.
    pub(super) fn run<'a>(&'a self, states: &'a [Vec<&'a [f64]>]) -> Run<'a> {
        let mut out = self.room();
        Run::new(states.len(), move |rounds| {
            let start = Instant::now();
            self.kernel.repeat(rounds, states, black_box(&mut out));
            start.elapsed()
        })
    }
}
