//! Peers that compute several states per call, one in each lane of a vector: timed with batches.

use articulated_core::algorithm::Function;
use articulated_core::model::Model;
use serde::Serialize;

use super::contender::{Contender, clock};
use super::peer::{self, Peer};
use crate::native::PeerKernel;
use crate::timing::{self, Run, Summary};

/// A peer's function of several states a call.
#[derive(Clone, Debug, Serialize)]
pub(super) struct LanesReport {
    pub(super) peer: String,
    pub(super) engine: String,
    /// States per call.
    pub(super) lanes: usize,
    /// ns per state.
    pub(super) time: Summary,
    /// Relative to the magnitude.
    pub(super) largest_difference: Option<f64>,
    /// The largest that is right.
    pub(super) bound: f64,
}

/// The function, with states laid out for it.
pub(super) struct Lanes<'a> {
    peer: &'a Peer,
    kernel: PeerKernel,
    lanes: usize,
    states: usize,
    /// The arguments of each call.
    blocks: Vec<Vec<Aligned>>,
    /// Numbers of one state.
    out: usize,
}

impl<'a> Lanes<'a> {
    /// `None` for a peer that computes one state per call, or does not have the function. The last
    /// block is filled with repetitions of the last state.
    pub(super) fn of(peer: &'a Peer, f: &Function<f64>, model: &Model<f64>, states: &[Vec<&[f64]>]) -> Option<Self> {
        let (kernel, lanes) = peer.in_lanes(f, model)?;
        let theirs: Vec<Vec<Vec<f64>>> = states.iter().map(|x| peer.arguments(f, model, x)).collect();
        let block = |states: &[Vec<Vec<f64>>]| {
            let state = |lane: usize| &states[lane.min(states.len() - 1)];
            let array = |a: usize| Aligned::new((0..states[0][a].len() * lanes).map(|k| state(k % lanes)[a][k / lanes]));
            (0..f.takes.len()).map(array).collect()
        };
        let blocks = theirs.chunks(lanes).map(block).collect();
        Some(Self { peer, kernel, lanes, states: states.len(), blocks, out: f.len(model.shape()) })
    }

    fn calls(&self) -> Vec<Vec<&[f64]>> {
        self.blocks.iter().map(|block| block.iter().map(Aligned::numbers).collect()).collect()
    }

    fn room(&self) -> Aligned {
        Aligned::new(std::iter::repeat_n(0.0, self.out * self.lanes))
    }

    /// The timed run: `rounds` rounds through all states, each call into the same place.
    pub(super) fn run(&self) -> Run<'_> {
        let (calls, mut out) = (self.calls(), self.room());
        Run::new(self.states, move |rounds| clock(|| self.kernel.repeat(rounds, &calls, out.numbers_mut())))
    }

    /// The largest difference from generic code.
    pub(super) fn difference(
        &self,
        f: &'static Function<f64>,
        model: &Model<f64>,
        states: &[Vec<&[f64]>],
        generic: &Contender<'_>,
    ) -> Option<f64> {
        let mut out = self.room();
        let results: Vec<Vec<f64>> = self
            .calls()
            .iter()
            .map(|call| self.kernel.call(call, out.numbers_mut()).then(|| out.numbers().to_vec()))
            .collect::<Option<_>>()?;
        let result =
            |state: usize| (0..self.out).map(|k| results[state / self.lanes][k * self.lanes + state % self.lanes]).collect::<Vec<f64>>();
        peer::difference(f, model, states, generic, |k, ours| Some(self.peer.in_our_order(&result(k), ours, f, model)))
    }

    /// `time`: ns per state.
    pub(super) fn report(&self, time: &[f64], largest_difference: Option<f64>) -> LanesReport {
        LanesReport {
            peer: self.peer.name.clone(),
            engine: self.peer.engine().to_owned(),
            lanes: self.lanes,
            time: timing::summary(time),
            largest_difference,
            bound: self.peer.library.bound(),
        }
    }
}

/// Numbers from the start of a cache line, the fastest place for vectors.
struct Aligned {
    room: Vec<f64>,
    start: usize,
    len: usize,
}

impl Aligned {
    fn new(numbers: impl ExactSizeIterator<Item = f64>) -> Self {
        const LINE: usize = 64;
        let len = numbers.len();
        let mut room = vec![0.0; len + LINE / size_of::<f64>()];
        let start = room.as_ptr().align_offset(LINE).min(LINE / size_of::<f64>());
        room[start..start + len].iter_mut().zip(numbers).for_each(|(x, y)| *x = y);
        Self { room, start, len }
    }

    fn numbers(&self) -> &[f64] {
        &self.room[self.start..][..self.len]
    }

    fn numbers_mut(&mut self) -> &mut [f64] {
        &mut self.room[self.start..][..self.len]
    }
}
