//! One function, from its algorithms to the graph that is emitted.

use articulated_core::model::Model;
use articulated_core::model::pass::model_passes;

use crate::graph::{Counts, Graph};
use crate::ledger::{Entry, depth};
use crate::parameters::Parameter;
use crate::pass::{self, GRAPH_PASSES};
use crate::sym::Sym;
use crate::trace::{Choice, trace, ways};
use crate::wanted::{Part, Wanted};

/// The graph of a function, traced on the model as it was read and after each model pass, and taken through the graph passes.
pub(crate) fn program(wanted: &Wanted, model: &Model<f64>, parameters: &[Parameter]) -> (Graph, Entry) {
    let all = model_passes::<Sym>().len();
    let choices: Vec<Choice> = wanted.parts.iter().map(|part| cheapest(part, model, parameters, all)).collect();
    let mut graph = Graph::default();
    let mut stages: Vec<(&'static str, Counts)> = Vec::new();
    for passes in 0..=all {
        let limited: Vec<Choice> = choices.iter().map(|c| Choice { passes: c.passes.min(passes), ..*c }).collect();
        graph = trace(wanted, &limited, model, parameters);
        if passes == 0 {
            stages.push(("asked", graph.asked().clone()));
        }
        stages.push((if passes == 0 { "trace" } else { model_passes::<Sym>()[passes - 1].0 }, graph.counts()));
    }
    for (name, pass, _) in GRAPH_PASSES {
        graph = pass::run(name, *pass, &graph);
        stages.push((name, graph.counts()));
    }
    let ways = choices.iter().map(|c| c.way.name).filter(|name| !name.is_empty()).collect();
    let entry = Entry { function: wanted.name.clone(), ways, stages, depth: depth(&graph) };
    (graph, entry)
}

/// The way that costs least once the graph passes are done. With parameters, model passes may cost more than they save: then they are not taken.
fn cheapest(part: &Part, model: &Model<f64>, parameters: &[Parameter], all: usize) -> Choice {
    let few = if parameters.is_empty() { all..=all } else { 0..=all };
    let ways = ways(part, model);
    let candidates: Vec<(Choice, u64)> =
        ways.iter().flat_map(|(way, least)| few.clone().map(move |passes| (Choice { way, passes }, *least))).collect();
    if let [(one, _)] = candidates.as_slice() {
        return *one;
    }
    let alone = Wanted { name: String::new(), parts: vec![part.clone()] };
    let mut best: Option<(Choice, u32)> = None;
    for (choice, least) in candidates {
        // A way whose least is more than another's cost is not tried: the factorisation of a long chain grows with the cube of its length.
        if best.is_some_and(|(_, cost)| least > u64::from(cost)) {
            continue;
        }
        let cost = cost(&alone, choice, model, parameters);
        if best.is_none_or(|(_, other)| cost < other) {
            best = Some((choice, cost));
        }
    }
    best.map_or(Choice { way: &part.function.ways[0], passes: all }, |(choice, _)| choice)
}

fn cost(wanted: &Wanted, choice: Choice, model: &Model<f64>, parameters: &[Parameter]) -> u32 {
    let graph = trace(wanted, &[choice], model, parameters);
    pass::cost(&GRAPH_PASSES.iter().fold(graph, |graph, (_, pass, _)| pass(&graph)))
}
