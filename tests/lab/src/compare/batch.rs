//! Generated functions of many states at once, compared with all others, on one core.

use articulated_core::algorithm::Function;
use articulated_core::lanes::Real;
use articulated_core::model::Model;
use serde::Serialize;

use super::contender::{Contender, clock};
use super::manifest::{BOUND, SINGLE_BOUND};
use super::peer::{self, Peer};
use crate::compiled::{Batch, CompiledBatches};
use crate::native::Numbers;
use crate::timing::{self, Run, Summary};

/// A function of many states at once, in one type and layout.
#[derive(Clone, Debug, Serialize)]
pub(super) struct BatchReport {
    pub(super) numbers: &'static str,
    pub(super) layout: &'static str,
    /// ns per state.
    pub(super) time: Summary,
    pub(super) generated_over_batch: Summary,
    pub(super) peers: Vec<PeerOverBatch>,
    /// `rustc`, of all types and layouts together.
    pub(super) compilation_seconds: f64,
    /// From generic code of double precision on the same numbers, relative to the magnitude.
    pub(super) largest_difference: Option<f64>,
    /// The largest that is right.
    pub(super) bound: f64,
}

/// A peer's time of a call against the time of a state.
#[derive(Clone, Debug, Serialize)]
pub(super) struct PeerOverBatch {
    pub(super) peer: String,
    pub(super) engine: String,
    pub(super) peer_over_batch: Summary,
}

impl BatchReport {
    /// The fastest build of an engine.
    pub(super) fn fastest_of(&self, engine: &str) -> Option<&PeerOverBatch> {
        let own = self.peers.iter().filter(|p| p.engine == engine);
        own.min_by(|a, b| a.peer_over_batch.median.total_cmp(&b.peer_over_batch.median))
    }
}

/// A function with states laid out for it.
pub(super) struct Many<'a> {
    batch: &'a Batch,
    compilation_seconds: f64,
    /// As many as the function takes, blocks or states.
    count: usize,
    states: usize,
    arguments: Vec<Numbers>,
    out: Numbers,
    /// Numbers of one state.
    out_len: usize,
}

impl<'a> Many<'a> {
    /// Every type and layout there is.
    pub(super) fn all(compiled: &'a CompiledBatches, states: &[Vec<&[f64]>], out_len: usize) -> Vec<Self> {
        let seconds = compiled.time.as_secs_f64();
        compiled.batches.iter().map(|batch| Self::of(batch, seconds, states, out_len)).collect()
    }

    /// An incomplete last block is filled with repetitions of the last state.
    fn of(batch: &'a Batch, compilation_seconds: f64, states: &[Vec<&[f64]>], out_len: usize) -> Self {
        let lanes = batch.layout.states(batch.real);
        let count = states.len().div_ceil(lanes);
        let argument = |a: usize| {
            let n = states[0][a].len();
            let number = |k: usize| states[(k / (n * lanes) * lanes + k % lanes).min(states.len() - 1)][a][k / lanes % n];
            Numbers::new(batch.real, (0..count * lanes * n).map(number))
        };
        let arguments = (0..states.first().map_or(0, Vec::len)).map(argument).collect();
        let out = Numbers::new(batch.real, (0..count * lanes * out_len).map(|_| f64::NAN));
        Self { batch, compilation_seconds, count, states: states.len(), arguments, out, out_len }
    }

    /// The timed run: `rounds` rounds through all states.
    pub(super) fn run(&self) -> Run<'_> {
        let mut out = self.out.clone();
        Run::new(self.states, move |rounds| clock(|| self.batch.kernel.repeat(rounds, self.count, &self.arguments, &mut out)))
    }

    /// The result in each state.
    fn results(&self) -> Vec<Vec<f64>> {
        let (mut out, lanes) = (self.out.clone(), self.batch.layout.states(self.batch.real));
        self.batch.kernel.repeat(1, self.count, &self.arguments, &mut out);
        let number = |state: usize, k: usize| out.get((state / lanes * self.out_len + k) * lanes + state % lanes);
        (0..self.states).map(|state| (0..self.out_len).map(|k| number(state, k)).collect()).collect()
    }

    /// The largest difference from generic code on the numbers given to the function.
    fn difference(&self, f: &'static Function<f64>, model: &Model<f64>, states: &[Vec<&[f64]>], generic: &Contender<'_>) -> Option<f64> {
        let round = |x: &f64| if self.batch.real == Real::F32 { f64::from(*x as f32) } else { *x };
        let rounded: Vec<Vec<Vec<f64>>> = states.iter().map(|s| s.iter().map(|x| x.iter().map(round).collect()).collect()).collect();
        let rounded: Vec<Vec<&[f64]>> = rounded.iter().map(|s| s.iter().map(Vec::as_slice).collect()).collect();
        let results = self.results();
        peer::difference(f, model, &rounded, generic, |k, _| results.get(k).cloned())
    }
}

/// Further inputs of the reports.
pub(super) struct Beside<'a> {
    pub(super) function: &'static Function<f64>,
    pub(super) model: &'a Model<f64>,
    pub(super) states: &'a [Vec<&'a [f64]>],
    pub(super) generic: &'a Contender<'a>,
    /// ns per call of generated code.
    pub(super) generated: &'a [f64],
    /// Peers and ns per call of each.
    pub(super) peers: Vec<(&'a Peer, &'a [f64])>,
    /// Whether the results mean anything.
    pub(super) regular: bool,
}

impl Beside<'_> {
    /// `time`: ns per state.
    pub(super) fn report(&self, many: &Many<'_>, time: &[f64]) -> BatchReport {
        let over = |(peer, own): &(&Peer, &[f64])| PeerOverBatch {
            peer: peer.name.clone(),
            engine: peer.engine().to_owned(),
            peer_over_batch: timing::ratio(own, time),
        };
        let difference = || many.difference(self.function, self.model, self.states, self.generic);
        BatchReport {
            numbers: many.batch.real.name(),
            layout: many.batch.layout.name(),
            time: timing::summary(time),
            generated_over_batch: timing::ratio(self.generated, time),
            peers: self.peers.iter().map(over).collect(),
            compilation_seconds: many.compilation_seconds,
            largest_difference: self.regular.then(difference).flatten(),
            bound: if many.batch.real == Real::F32 { SINGLE_BOUND } else { BOUND },
        }
    }
}
