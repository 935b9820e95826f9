//! Running an algorithm on symbols.

use articulated_core::algorithm::{Function, Workspace};
use articulated_core::model::Model;
use num_traits::Zero;

use crate::graph::Graph;
use crate::sym::{self, Sym};

/// The graph of `function` on `model`: argument k of the function is argument k of the graph.
pub(crate) fn trace(function: &Function<Sym>, model: &Model<f64>) -> Graph {
    sym::trace(|| {
        let shape = model.shape();
        let model: Model<Sym> = model.cast();
        let arguments: Vec<Vec<Sym>> =
            function.takes.iter().enumerate().map(|(k, argument)| (0..argument.len(shape)).map(|i| Sym::input(k, i)).collect()).collect();
        let arguments: Vec<&[Sym]> = arguments.iter().map(Vec::as_slice).collect();
        let mut out = vec![Sym::zero(); function.gives.len(shape)];
        let called = function.call(&model, &mut Workspace::new(&model), &arguments, &mut out);
        debug_assert!(called.is_ok(), "arguments were made to measure");
        out
    })
}
