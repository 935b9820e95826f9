//! Who is measured: something that computes a function of a robot.

use std::cell::RefCell;
use std::hint::black_box;
use std::time::{Duration, Instant};

use articulated_core::algorithm::{Function, Workspace};
use articulated_core::model::Model;

use super::timing::Run;
use crate::compiled::Compiled;
use crate::native::{Kernel, PeerKernel};

/// One way to compute a function. What is timed is a run through all states, so that those that take several at once have their time a state too.
pub(crate) struct Contender<'a> {
    way: Way<'a>,
    out: usize,
}

enum Way<'a> {
    Generated(Kernel),
    Peer(PeerKernel),
    Generic { function: &'static Function<f64>, model: &'a Model<f64>, workspace: Box<RefCell<Workspace<f64>>> },
}

impl<'a> Contender<'a> {
    /// Code of another library.
    pub(crate) fn peer(kernel: PeerKernel, out: usize) -> Self {
        Self { way: Way::Peer(kernel), out }
    }

    /// The compiled function.
    pub(crate) fn generated(compiled: &Compiled, function: &Function<f64>) -> Self {
        let kernel = compiled.kernel(function.name).expect("every function of a ledger was loaded");
        Self { way: Way::Generated(kernel.clone()), out: function.len(compiled.shape()) }
    }

    /// The same algorithm at run time.
    pub(crate) fn generic(model: &'a Model<f64>, function: &'static Function<f64>) -> Self {
        let workspace = Box::new(RefCell::new(Workspace::new(model)));
        Self { way: Way::Generic { function, model, workspace }, out: function.len(model.shape()) }
    }

    /// The result in one state; empty where a peer keeps it to itself.
    pub(crate) fn call(&self, arguments: &[&[f64]]) -> Vec<f64> {
        let mut out = vec![0.0; self.out];
        match &self.way {
            Way::Generated(kernel) => kernel.call(arguments, &mut out),
            Way::Peer(kernel) => {
                if !kernel.call(arguments, &mut out) {
                    out.clear();
                }
            }
            Way::Generic { function, model, workspace } => {
                let called = function.call(model, &mut workspace.borrow_mut(), arguments, &mut out);
                debug_assert!(called.is_ok(), "arguments were made to measure");
            }
        }
        out
    }

    /// What the clock is held to: so many rounds through all states.
    pub(crate) fn run<'b>(&'b self, states: &'b [Vec<&'b [f64]>]) -> Run<'b> {
        let mut out = vec![0.0; self.out];
        match &self.way {
            Way::Generated(kernel) => Box::new(move |rounds| clock(|| kernel.repeat(rounds, states, black_box(&mut out)))),
            Way::Peer(kernel) => Box::new(move |rounds| clock(|| kernel.repeat(rounds, states, black_box(&mut out)))),
            Way::Generic { function, model, workspace } => Box::new(move |rounds| {
                let workspace = &mut workspace.borrow_mut();
                clock(|| {
                    for state in std::iter::repeat_n(states, rounds).flatten() {
                        let _ = black_box(function.call(model, workspace, black_box(state), black_box(&mut out)));
                    }
                })
            }),
        }
    }
}

/// How long it takes.
pub(super) fn clock(batch: impl FnOnce()) -> Duration {
    let start = Instant::now();
    batch();
    start.elapsed()
}
