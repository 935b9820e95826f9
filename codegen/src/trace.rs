//! Running algorithms on symbols.

use articulated_core::Scalar;
use articulated_core::algorithm::{Argument, Way, Workspace};
use articulated_core::model::Model;
use articulated_core::model::pass::model_passes;
use num_traits::Zero;

use crate::graph::Graph;
use crate::parameters::Parameter;
use crate::sym::{self, Sym};
use crate::wanted::{Part, Wanted};

/// How to compute a part.
#[derive(Clone, Copy)]
pub(crate) struct Choice {
    pub(crate) way: &'static Way<Sym>,
    /// How many model passes to take.
    pub(crate) passes: usize,
}

/// The graph of a function on `model`: its argument k is argument k of the graph, parameters come after the last; the results of the parts one after the other.
pub(crate) fn trace(wanted: &Wanted, choices: &[Choice], model: &Model<f64>, parameters: &[Parameter]) -> Graph {
    sym::trace(|| {
        let arguments = wanted.arguments();
        let mut symbolic: Model<Sym> = model.cast();
        for p in parameters {
            p.put(&mut symbolic, |k| Sym::input(arguments.len(), k));
        }
        wanted.parts.iter().zip(choices).flat_map(|(part, choice)| run(part, choice, &symbolic, &arguments)).collect()
    })
}

fn run(part: &Part, choice: &Choice, model: &Model<Sym>, arguments: &[Argument]) -> Vec<Sym> {
    let passes = model_passes::<Sym>().iter().take(if part.function.regrouped { choice.passes } else { 0 });
    let model = passes.fold(model.clone(), |model, (_, pass, _)| pass(model));
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
    let called = part.function.call_by(choice.way, &model, &mut Workspace::new(&model), &slices, &mut out);
    debug_assert!(called.is_ok(), "arguments were made to measure");
    out
}

/// The ways of a function that can be had for the model.
pub(crate) fn ways(part: &Part, model: &Model<f64>) -> Vec<&'static Way<Sym>> {
    let mut ways: Vec<&'static Way<Sym>> = Vec::new();
    let _ = sym::trace(|| {
        let symbolic = model.cast();
        ways = part.function.ways.iter().filter(|w| (w.applies)(&symbolic)).collect();
        Vec::new()
    });
    ways
}
