//! What a function is traced on, and what it costs there.

use articulated_core::algorithm::{Form, Way};
use articulated_core::model::Model;
use articulated_core::model::pass::model_passes;

use super::search::{by_axes, cheapest, in_the_best_unit};
use super::strategy::{Strategy, Transform};
use crate::graph::{Counts, Graph};
use crate::ledger::{Entry, depth};
use crate::limbs::IsomorphicLimbs;
use crate::parameters::Parameter;
use crate::pass;
use crate::spec::FunctionSpec;
use crate::sym::Sym;
use crate::trace::{trace, trace_in_lanes};

/// What a function is traced on.
pub(super) struct Candidate<'a> {
    pub(super) model: &'a Model<f64>,
    pub(super) parameters: &'a [Parameter],
    /// Whether to trace after each model pass, for the ledger.
    pub(super) stages: bool,
    /// Limbs to lay on one another.
    pub(super) alike: Option<IsomorphicLimbs>,
}

impl Candidate<'_> {
    /// The graph of a function by the choices that cost least, or of what comes before a loop, and what became of it on the way.
    pub(super) fn made(&self, wanted: &FunctionSpec, unsolved: Option<&'static Way<Sym>>) -> (Graph, Entry) {
        let all = model_passes::<Sym>().len();
        let choose = |part| unsolved.map_or_else(|| cheapest(part, self, all), |way| Strategy::plain(way, all));
        let choices = by_axes(wanted, wanted.parts.iter().map(choose).collect(), self);
        let choices = in_the_best_unit(wanted, choices, self);
        let (traced, mut stages) = self.traced(wanted, &choices, all);
        let mut graph = pass::run_all(traced, |name, graph| stages.push((name, graph.counts())));
        if wanted.parts.iter().all(|part| part.function.forms.contains(&Form::FromTheLast)) {
            graph = pass::run("from the last", pass::from_the_last, &graph);
        }
        let ways = choices.iter().flat_map(Strategy::names).collect();
        let arguments = wanted.arguments();
        let entry = Entry { function: wanted.name.clone(), ways, stages, depth: depth(&graph), lanes: graph.lanes().width, arguments };
        (graph, entry)
    }

    /// The graph as it is traced, and its counts after each model pass, `all` of them, and each addition that a choice has.
    fn traced(&self, wanted: &FunctionSpec, choices: &[Strategy], all: usize) -> (Graph, Vec<(&'static str, Counts)>) {
        let mut graph = Graph::default();
        let mut stages: Vec<(&'static str, Counts)> = Vec::new();
        for passes in if self.stages { 0 } else { all }..=all {
            let limited: Vec<Strategy> = choices.iter().map(|c| Strategy::plain(c.way, c.passes.min(passes))).collect();
            graph = self.trace(wanted, &limited);
            if stages.is_empty() {
                stages.push(("asked", graph.asked().clone()));
            }
            stages.push((if passes == 0 { "trace" } else { model_passes::<Sym>()[passes - 1].0 }, graph.counts()));
        }
        for (addition, name, _) in Transform::ALL {
            if choices.iter().any(|c| c.adds(addition)) {
                graph = self.trace(wanted, &choices.iter().map(|c| c.up_to(addition)).collect::<Vec<_>>());
                stages.push((name, graph.counts()));
            }
        }
        (graph, stages)
    }

    fn trace(&self, wanted: &FunctionSpec, choices: &[Strategy]) -> Graph {
        match &self.alike {
            None => trace(wanted, choices, self.model, self.parameters),
            Some(alike) => trace_in_lanes(wanted, choices, self.model, alike),
        }
    }

    /// What is traced, after all graph passes.
    pub(super) fn finished(&self, wanted: &FunctionSpec, choices: &[Strategy]) -> Graph {
        pass::run_all_unchecked(self.trace(wanted, choices))
    }

    /// What choices cost, in instructions, and with each multiplication counted twice: cores have fewer multipliers than they have places for instructions.
    pub(super) fn price(&self, wanted: &FunctionSpec, choices: &[Strategy]) -> (u32, u64) {
        let graph = self.finished(wanted, choices);
        let cost = pass::cost(&graph);
        (cost, u64::from(cost) + graph.counts().multiplications())
    }
}
