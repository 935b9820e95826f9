//! Running algorithms on symbols.

use articulated_core::Scalar;
use articulated_core::algorithm::{Argument, Way, Workspace};
use articulated_core::model::pass::model_passes;
use articulated_core::model::{Model, Unturned};
use num_traits::Zero;

use crate::graph::{Graph, Op};
use crate::limbs::{Alike, Constants, pack};
use crate::parameters::Parameter;
use crate::pass::{copy, live, rebuild};
use crate::sym::{self, Sym};
use crate::wanted::{Part, Wanted};

/// How to compute a part.
#[derive(Clone, Copy)]
pub(crate) struct Choice {
    pub(crate) way: &'static Way<Sym>,
    /// How many model passes to take.
    pub(crate) passes: usize,
    /// Bodies whose frames do not turn.
    pub(crate) unturned: Option<Unturned>,
}

impl Choice {
    /// What it is called in the ledger.
    pub(crate) fn names(&self) -> impl Iterator<Item = &'static str> {
        let unturned = match self.unturned {
            None => "",
            Some(Unturned::Parallel) => "parallel joints unturned",
            Some(Unturned::ParallelAndLast) => "parallel and last joints unturned",
        };
        [self.way.name, unturned].into_iter().filter(|name| !name.is_empty())
    }
}

/// The graph of a function on `model`: its argument k is argument k of the graph, parameters come after the last; the results of the parts one after the other.
pub(crate) fn trace(wanted: &Wanted, choices: &[Choice], model: &Model<f64>, parameters: &[Parameter]) -> Graph {
    let arguments = wanted.arguments();
    let graph = sym::trace(|| {
        let with_inputs = (!parameters.is_empty()).then(|| {
            let mut symbolic: Model<Sym> = model.cast();
            parameters.iter().for_each(|p| p.put(&mut symbolic, |k| Sym::input(arguments.len(), k)));
            symbolic
        });
        let run = |(part, choice): (&Part, &Choice)| {
            // Where all is numbers, passes go over numbers, which is sooner done.
            let symbolic = with_inputs.as_ref().map_or_else(|| passed(part, choice, model).cast(), |m| passed(part, choice, m));
            run(part, choice, &symbolic, &arguments)
        };
        wanted.parts.iter().zip(choices).flat_map(run).collect()
    });
    sines_given(graph, &arguments)
}

/// Takes the sines and cosines of q from their argument, if there is one.
fn sines_given(graph: Graph, arguments: &[Argument]) -> Graph {
    let place = |argument| arguments.iter().position(|a| *a == argument);
    let (Some(q), Some(sines)) = (place(Argument::Q), place(Argument::SinCos)) else { return graph };
    let given = rebuild(
        &graph,
        |_| true,
        |new, node, operands| {
            let angle = new.node(operands[0]);
            let is_coordinate = angle.op == Op::Input && angle.args[0] as usize == q;
            match node.op {
                Op::Sin if is_coordinate => new.input(sines, 2 * angle.args[1] as usize),
                Op::Cos if is_coordinate => new.input(sines, 2 * angle.args[1] as usize + 1),
                _ => copy(new, node, operands),
            }
        },
    );
    given.asked_as(&graph)
}

/// The same with branches that are alike in lanes.
pub(crate) fn trace_in_lanes(wanted: &Wanted, choices: &[Choice], model: &Model<f64>, alike: &Alike) -> Graph {
    let arguments = wanted.arguments();
    let mut constants = Constants::new(arguments.len());
    let graph = sym::trace(|| {
        let mut run = |(part, choice): (&Part, &Choice)| {
            let symbolic = alike.symbolic(&passed(part, choice, model), &mut constants);
            run(part, choice, &symbolic, &arguments)
        };
        wanted.parts.iter().zip(choices).flat_map(&mut run).collect()
    });
    let graph = sines_given(graph, &arguments);
    pack(&live(&graph), &arguments, alike, &constants).asked_as(&graph)
}

/// The model after the passes that are chosen.
fn passed<S: Scalar>(part: &Part, choice: &Choice, model: &Model<S>) -> Model<S> {
    let mut model = model.clone();
    if !part.function.asks_for_frames() {
        model.frames.clear();
    }
    let passes = model_passes::<S>().iter().take(if part.function.regrouped { choice.passes } else { 0 });
    passes.fold(model, |model, (_, pass, _)| pass(model))
}

/// Which bodies need not turn, on the model after all passes, as the function does not ask where they are.
pub(crate) fn unturnable(part: &Part, model: &Model<f64>) -> Vec<Unturned> {
    let choice = Choice { way: &part.function.ways[0], passes: usize::MAX, unturned: None };
    let free = part.function.regrouped && !part.function.asks_for_frames() && part.function.takes.contains(&Argument::Q);
    let free = free && model.bodies.iter().all(|b| b.effects.body.is_empty());
    if free { passed(part, &choice, model).unturnable() } else { Vec::new() }
}

fn run(part: &Part, choice: &Choice, model: &Model<Sym>, arguments: &[Argument]) -> Vec<Sym> {
    let shape = model.shape();
    let vector = |argument: &Argument| -> Vec<Sym> {
        let place = arguments.iter().position(|a| a == argument);
        let symbol = |k: usize| match (part.constant(*argument), place) {
            (Some(constant), _) => Sym::from_f64(constant.at(k)),
            (None, Some(place)) => Sym::input(place, k),
            (None, None) => Sym::zero(),
        };
        (0..argument.len(shape)).map(symbol).collect()
    };
    let vectors: Vec<Vec<Sym>> = part.function.takes.iter().map(vector).collect();
    let slices: Vec<&[Sym]> = vectors.iter().map(Vec::as_slice).collect();
    let mut out = vec![Sym::zero(); part.function.len(shape)];
    let q = part.function.takes.iter().position(|a| *a == Argument::Q);
    let unturned = q.zip(choice.unturned).map(|(k, which)| model.unturned(slices[k], which));
    let model = unturned.as_ref().unwrap_or(model);
    let called = part.function.call_by(choice.way, model, &mut Workspace::new(model), &slices, &mut out);
    debug_assert!(called.is_ok(), "arguments were made to measure");
    out
}

/// Whether a way can be had for the model.
pub(crate) fn applies(way: &Way<Sym>, model: &Model<f64>) -> bool {
    let mut applies = false;
    let _ = sym::trace(|| {
        applies = (way.applies)(&model.cast());
        Vec::new()
    });
    applies
}

/// The ways of a function that can be had for the model, and what each costs at least; the least first.
pub(crate) fn ways(part: &Part, model: &Model<f64>) -> Vec<(&'static Way<Sym>, u64)> {
    if let [one] = part.function.ways {
        return vec![(one, 0)];
    }
    let mut ways: Vec<(&'static Way<Sym>, u64)> = Vec::new();
    let _ = sym::trace(|| {
        let symbolic = model.cast();
        let applies = part.function.ways.iter().filter(|w| (w.applies)(&symbolic));
        ways = applies.map(|w| (w, (w.least)(&symbolic))).collect();
        Vec::new()
    });
    ways.sort_by_key(|(_, least)| *least);
    ways
}
