//! A contender: a computation of a function of a robot.

use std::cell::RefCell;
use std::hint::black_box;
use std::time::{Duration, Instant};

use articulated_core::algorithm::{Function, Workspace};
use articulated_core::model::Model;

use crate::compiled::Compiled;
use crate::native::{Kernel, PeerKernel};
use crate::timing::Run;

/// One way to compute a function. A run through all states is timed, so that contenders that
/// compute several at once have a time per state too.
pub struct Contender<'a> {
    way: Variant<'a>,
    out: usize,
}

enum Variant<'a> {
    Generated(Kernel),
    Peer(PeerKernel),
    Generic { function: &'static Function<f64>, model: &'a Model<f64>, workspace: Box<RefCell<Workspace<f64>>> },
}

impl<'a> Contender<'a> {
    /// Code of another library.
    pub(crate) fn peer(kernel: PeerKernel, out: usize) -> Self {
        Self { way: Variant::Peer(kernel), out }
    }

    /// The compiled function.
    pub fn generated(compiled: &Compiled, function: &Function<f64>) -> Self {
        let kernel = compiled.kernel(function.name).expect("every function of a ledger was loaded");
        Self { way: Variant::Generated(kernel.clone()), out: function.len(compiled.shape()) }
    }

    /// The same algorithm at run time.
    pub fn generic(model: &'a Model<f64>, function: &'static Function<f64>) -> Self {
        let workspace = Box::new(RefCell::new(Workspace::new(model)));
        Self { way: Variant::Generic { function, model, workspace }, out: function.len(model.shape()) }
    }

    /// The result in one state; empty if a peer does not return it.
    pub fn call(&self, arguments: &[&[f64]]) -> Vec<f64> {
        let mut out = vec![0.0; self.out];
        match &self.way {
            Variant::Generated(kernel) => kernel.call(arguments, &mut out),
            Variant::Peer(kernel) => {
                if !kernel.call(arguments, &mut out) {
                    out.clear();
                }
            }
            Variant::Generic { function, model, workspace } => {
                let called = function.call(model, &mut workspace.borrow_mut(), arguments, &mut out);
                debug_assert!(called.is_ok(), "arguments were made to measure");
            }
        }
        out
    }

    /// Whether the next call can wait for the result of a call.
    pub fn can_wait(&self) -> bool {
        self.out > 0
            && match &self.way {
                Variant::Generated(_) | Variant::Generic { .. } => true,
                Variant::Peer(kernel) => kernel.writes(),
            }
    }

    /// The timed run: `rounds` rounds through the nearest states.
    pub fn run<'b>(&'b self, states: &'b [Vec<&'b [f64]>]) -> Run<'b> {
        self.timed(states, Calls::Independent)
    }

    /// The same for calls that each wait for the result of the call before;
    /// [`can_wait`](Self::can_wait).
    pub fn run_dependent<'b>(&'b self, states: &'b [Vec<&'b [f64]>]) -> Run<'b> {
        self.timed(states, Calls::Dependent)
    }

    fn timed<'b>(&'b self, states: &'b [Vec<&'b [f64]>], calls: Calls) -> Run<'b> {
        let (states, mut room) = (near(states), Room::new(self.out));
        Run::new(states.len(), move |rounds| {
            let out = black_box(room.next());
            match (&self.way, calls) {
                (Variant::Generated(kernel), Calls::Independent) => clock(|| kernel.repeat(rounds, states, out)),
                (Variant::Generated(kernel), Calls::Dependent) => clock(|| kernel.repeat_waiting(rounds, states, out)),
                (Variant::Peer(kernel), Calls::Independent) => clock(|| kernel.repeat(rounds, states, out)),
                (Variant::Peer(kernel), Calls::Dependent) => clock(|| kernel.repeat_waiting(rounds, states, out)),
                // A generic call is a hundred times as long as the work that a processor starts
                // early.
                (Variant::Generic { function, model, workspace }, _) => {
                    let workspace = &mut workspace.borrow_mut();
                    clock(|| {
                        for state in std::iter::repeat_n(states, rounds).flatten() {
                            let _ = black_box(function.call(model, workspace, black_box(state), black_box(&mut *out)));
                        }
                    })
                }
            }
        })
    }
}

/// Whether each call waits for the result of the call before.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Calls {
    /// As a batch of states would call it: the processor may begin a call before the last one has
    /// ended.
    Independent,
    /// As a controller calls it: the next state follows from the last result.
    Dependent,
}

/// Maximum bytes of arguments in a round, half of a small first-level cache: a caller has usually
/// just computed the arguments.
const NEAR: usize = 16 << 10;

/// The first of the states, as many as are near.
fn near<'s, 'x>(states: &'s [Vec<&'x [f64]>]) -> &'s [Vec<&'x [f64]>] {
    let bytes = states.first().map_or(0, |x| x.iter().map(|x| size_of_val(*x)).sum::<usize>());
    &states[..states.len().min((NEAR / bytes.max(1)).max(1))]
}

/// Buffer for results. A processor waits if the last twelve bits of an address that it reads equal
/// those of one just written: a function that writes much then takes up to a third longer,
/// depending on the place of its result. So the place moves from batch to batch, through a page.
struct Room {
    numbers: Vec<f64>,
    out: usize,
    turn: usize,
}

impl Room {
    const PAGE: usize = 4096 / size_of::<f64>();
    /// A step of some cache lines, so that all lines of a page are used before a place repeats.
    const STEP: usize = 5 * 64 / size_of::<f64>();

    fn new(out: usize) -> Self {
        Self { numbers: vec![0.0; out + Self::PAGE], out, turn: 0 }
    }

    /// The next place.
    fn next(&mut self) -> &mut [f64] {
        self.turn = (self.turn + Self::STEP) % Self::PAGE;
        &mut self.numbers[self.turn..][..self.out]
    }
}

/// How long it takes.
pub(super) fn clock(batch: impl FnOnce()) -> Duration {
    let start = Instant::now();
    batch();
    start.elapsed()
}
