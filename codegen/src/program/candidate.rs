//! Candidates: what a function is traced on, its cost, and the search for the cheapest strategies.

use std::iter::once;

use articulated_core::algorithm::Variant;
use articulated_core::model::Model;

use super::forms::Form;
use super::strategy::{self, Strategy};
use crate::function_spec::{Derivative, FunctionSpec, FunctionTerm, Transform};
use crate::graph::{Counts, Graph};
use crate::ledger::{Entry, depth};
use crate::limbs::IsomorphicLimbs;
use crate::model_pass::{FoldedRotations, model_passes};
use crate::parameters::Parameter;
use crate::pass;
use crate::sym::Sym;
use crate::trace::{foldable_rotations, trace, trace_in_lanes, units, ways};

/// A candidate: what a function is traced on.
pub(super) struct Candidate<'a> {
    pub(super) model: &'a Model<f64>,
    pub(super) parameters: &'a [Parameter],
    /// Whether to trace after each model pass, for the ledger.
    pub(super) stages: bool,
    /// Isomorphic limbs to vectorize.
    pub(super) alike: Option<IsomorphicLimbs>,
}

impl Candidate<'_> {
    /// The graph of a function by its cheapest strategies, or of the part before a loop, and its
    /// ledger entry.
    pub(super) fn build(&self, spec: &FunctionSpec, unsolved: Option<&'static Variant<Sym>>) -> (Graph, Entry) {
        let all = model_passes::<Sym>().len();
        let choose = |part| unsolved.map_or_else(|| cheapest(part, tried_transform(spec), self, all), |way| Strategy::plain(way, all));
        let strategies = by_axes(spec, spec.parts.iter().map(choose).collect(), self);
        let strategies = in_the_best_unit(spec, strategies, self);
        let (traced, mut stages) = self.traced(spec, &strategies, all);
        let mut graph = pass::run_all(traced, |name, graph| stages.push((name, graph.counts())));
        if spec.transform.is_none() && spec.parts.iter().all(|part| Form::FromTheLast.fits(part.function)) {
            graph = pass::run("from the last", pass::from_the_last, &graph);
        }
        let ways = strategies.iter().flat_map(Strategy::names).collect();
        let arguments = spec.arguments();
        let entry = Entry { function: spec.name.clone(), ways, stages, depth: depth(&graph), lanes: graph.lanes().width, arguments };
        (graph, entry)
    }

    /// The traced graph, and its counts after each of the `all` model passes and each transform of
    /// the strategies.
    fn traced(&self, spec: &FunctionSpec, strategies: &[Strategy], all: usize) -> (Graph, Vec<(&'static str, Counts)>) {
        let mut graph = Graph::default();
        let mut stages: Vec<(&'static str, Counts)> = Vec::new();
        for passes in if self.stages { 0 } else { all }..=all {
            let limited: Vec<Strategy> = strategies.iter().map(|c| Strategy::plain(c.way, c.passes.min(passes))).collect();
            graph = self.trace(spec, &limited);
            if stages.is_empty() {
                stages.push(("requested", graph.requested().clone()));
            }
            stages.push((if passes == 0 { "trace" } else { model_passes::<Sym>()[passes - 1].0 }, graph.counts()));
        }
        for (transform, name, _) in strategy::Transform::ALL {
            if strategies.iter().any(|c| c.adds(transform)) {
                graph = self.trace(spec, &strategies.iter().map(|c| c.up_to(transform)).collect::<Vec<_>>());
                stages.push((name, graph.counts()));
            }
        }
        (graph, stages)
    }

    fn trace(&self, spec: &FunctionSpec, strategies: &[Strategy]) -> Graph {
        match &self.alike {
            None => trace(spec, strategies, self.model, self.parameters),
            Some(alike) => trace_in_lanes(spec, strategies, self.model, alike),
        }
    }

    /// The traced graph after all graph passes.
    pub(super) fn finished(&self, spec: &FunctionSpec, strategies: &[Strategy]) -> Graph {
        pass::run_all_unchecked(self.trace(spec, strategies))
    }

    /// The cost of strategies, in instructions, and with each multiplication counted twice: cores
    /// have fewer multipliers than issue slots.
    pub(super) fn price(&self, spec: &FunctionSpec, strategies: &[Strategy]) -> (u32, u64) {
        let graph = self.finished(spec, strategies);
        let cost = pass::cost(&graph);
        (cost, u64::from(cost) + graph.counts().multiplications())
    }
}

/// Above this cost, folded rotations and shifted masses are not tried: they would gain 1 % and take
/// long to trace.
const FOLDED_TO: u32 = 2500;

/// Above this number of bodies, neither they nor another unit of length are tried, since each trial
/// traces the function again.
const FOLDED_BODIES: usize = 64;

/// The derivative that strategies are compared with: that of the function, unless it is many times
/// as long as the function, which then is compared by itself.
fn tried_transform(spec: &FunctionSpec) -> Option<Transform> {
    spec.transform.clone().filter(|transform| !matches!(transform.kind, Derivative::Hvp | Derivative::Hessian | Derivative::Jacobian))
}

/// The strategy that costs least after the graph passes. With parameters, model passes may cost
/// more than they save; then they are left out.
fn cheapest(part: &FunctionTerm, transform: Option<Transform>, candidate: &Candidate, all: usize) -> Strategy {
    let few = if candidate.parameters.is_empty() { all..=all } else { 0..=all };
    let ways = ways(part, candidate.model);
    let tried = candidate.parameters.is_empty() && candidate.model.bodies().len() <= FOLDED_BODIES;
    let folded = if tried { foldable_rotations(part, candidate.model) } else { Vec::new() };
    let folded: Vec<Option<FoldedRotations>> = once(None).chain(folded.into_iter().map(Some)).collect();
    let shifted: &[bool] = if tried && Form::ShiftedMasses.fits(part.function) { &[false, true] } else { &[false] };
    let forms = || folded.iter().flat_map(|&folded| shifted.iter().map(move |&shifted| (folded, shifted)));
    let of = |way, passes| forms().map(move |(folded, shifted)| Strategy { folded, shifted, ..Strategy::plain(way, passes) });
    let candidates: Vec<(Strategy, u64)> =
        ways.iter().flat_map(|(way, least)| few.clone().flat_map(move |passes| of(*way, passes)).map(|c| (c, *least))).collect();
    if let [(one, _)] = candidates.as_slice() {
        return *one;
    }
    let alone = FunctionSpec { name: String::new(), parts: vec![part.clone()], transform, normalises: false };
    let mut best: Option<(Strategy, u32)> = None;
    for (strategy, least) in candidates {
        // A way whose lower bound exceeds another's cost is not tried: the factorisation of a long
        // chain grows with the cube of its length.
        if best.is_some_and(|(_, cost)| least > u64::from(cost) || (strategy.folded.is_some() || strategy.shifted) && cost > FOLDED_TO) {
            continue;
        }
        let cost = cost(&alone, strategy, candidate);
        if best.is_none_or(|(_, other)| cost < other) {
            best = Some((strategy, cost));
        }
    }
    best.map_or(Strategy::plain(&part.function.ways[0], all), |(strategy, _)| strategy)
}

fn cost(spec: &FunctionSpec, strategy: Strategy, candidate: &Candidate) -> u32 {
    pass::cost(&candidate.finished(spec, &[strategy]))
}

/// The strategies with axis rates, if that takes fewer multiplications and no further instructions.
/// For robots with many bodies, which take long to trace, without a trial.
pub(super) fn by_axes(spec: &FunctionSpec, strategies: Vec<Strategy>, candidate: &Candidate) -> Vec<Strategy> {
    let turns = |part: &FunctionTerm| Form::AxisAccelerations.fits(part.function);
    if !spec.parts.iter().any(turns) {
        return strategies;
    }
    let with: Vec<Strategy> =
        spec.parts.iter().zip(&strategies).map(|(part, strategy)| Strategy { axes: turns(part), ..*strategy }).collect();
    let better = || {
        let ((cost, price), (other_cost, other_price)) = (candidate.price(spec, &with), candidate.price(spec, &strategies));
        cost <= other_cost && price < other_price
    };
    if candidate.model.bodies().len() > FOLDED_BODIES || better() { with } else { strategies }
}

/// Limit of instructions traced to find the best unit of length: fewer units are tried for long
/// functions.
const TRIED: usize = 20_000;

/// The strategies with lengths in the cheapest unit: a factor of one takes no multiplication.
pub(super) fn in_the_best_unit(spec: &FunctionSpec, strategies: Vec<Strategy>, candidate: &Candidate) -> Vec<Strategy> {
    if !candidate.parameters.is_empty() || candidate.model.bodies().len() > FOLDED_BODIES {
        return strategies;
    }
    let units: Vec<Vec<f64>> = spec.parts.iter().zip(&strategies).map(|(part, strategy)| units(part, strategy, candidate.model)).collect();
    let with = |metres: f64| -> Vec<Strategy> {
        let one = |(strategy, units): (&Strategy, &Vec<f64>)| Strategy { unit: units.contains(&metres).then_some(metres), ..*strategy };
        strategies.iter().zip(&units).map(one).collect()
    };
    let Some(most) = units.iter().max_by_key(|units| units.len()).filter(|units| !units.is_empty()) else { return strategies };
    let (cost, mut least) = candidate.price(spec, &strategies);
    if cost > FOLDED_TO {
        return strategies;
    }
    let mut best = strategies.clone();
    for other in most.iter().take(TRIED / (cost as usize).max(1)).map(|&metres| with(metres)) {
        let (_, price) = candidate.price(spec, &other);
        if price < least {
            (least, best) = (price, other);
        }
    }
    best
}
