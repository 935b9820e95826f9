//! Derivatives of traced functions.
//!
//! With respect to a configuration q they are those of f(q ⊕ δ) at δ = 0: the function is traced
//! with q ⊕ δ in the place of q, differentiated by the inputs δ, and then δ is zero. In coordinates
//! they are those of f(q/|q|), in which each quaternion has length one. A result that is a
//! configuration has derivatives in the tangent space where it ends.

use articulated_core::Scalar;
use articulated_core::algorithm::{Argument, Shape, divide_by_length, small_difference, small_step};
use articulated_core::model::Model;
use num_traits::Zero;

use crate::function_spec::{Derivative, FunctionSpec, FunctionTerm, Output, Transform};
use crate::graph::{Graph, NodeId};
use crate::pass::{self, adjoint, dce, splice, tangent};
use crate::sym::Sym;

/// A requested derivative, with the inputs by which the function is differentiated.
pub(crate) struct Steps<'a> {
    transform: &'a Transform,
    arguments: &'a [Argument],
    /// Those that are weights.
    weights: Vec<Argument>,
    /// Lengths of the function's results.
    results: Vec<usize>,
    shape: Shape,
}

impl<'a> Steps<'a> {
    /// For a derivative; `arguments`: those of the function and of the derivative.
    pub(crate) fn of(spec: &'a FunctionSpec, arguments: &'a [Argument], model: &Model<f64>) -> Option<Self> {
        let transform = spec.transform.as_ref()?;
        let (part, shape) = (&spec.parts[0], model.shape());
        let length = |output: &Output| output.dims.iter().map(|d| d.len(shape)).product();
        let results = transform.results(part).iter().map(length).collect();
        Some(Self { transform, arguments, weights: transform.weights(part), results, shape })
    }

    /// How many times in a row the function is differentiated.
    pub(crate) fn orders(&self) -> usize {
        if matches!(self.transform.kind, Derivative::Hvp | Derivative::Hessian) { 2 } else { 1 }
    }

    /// The number of the argument δ of a configuration; `None` for arguments that are
    /// differentiated by themselves. Numbers above those of arguments and parameters are free.
    fn step(&self, argument: Argument) -> Option<usize> {
        let place = self.transform.wrt.iter().position(|a| *a == argument)?;
        (argument.is_configuration() && !self.transform.in_coordinates).then_some(self.arguments.len() + 1 + place)
    }

    /// q ⊕ δ for a configuration by which the function is differentiated; other arguments as given.
    pub(crate) fn moved(&self, argument: Argument, mut given: Vec<Sym>, model: &Model<Sym>) -> Vec<Sym> {
        let is_known = argument.is_configuration() && self.transform.wrt.contains(&argument);
        if is_known && self.transform.in_coordinates {
            divide_by_length(model, &mut given);
            return given;
        }
        let Some(step) = self.step(argument) else { return given };
        let delta: Vec<Sym> = (0..self.shape.nv).map(|k| Sym::input(step, k)).collect();
        let mut moved = vec![Sym::zero(); given.len()];
        small_step(model, &given, &delta, &mut moved);
        moved
    }

    /// The results of the function, of configurations target ⊖ value with the value held.
    pub(crate) fn charted(&self, part: &FunctionTerm, results: Vec<Sym>, model: &Model<Sym>) -> Vec<Sym> {
        let mut rest = results.as_slice();
        if self.transform.in_coordinates || part.function.outputs.is_empty() {
            return results;
        }
        let mut all = Vec::with_capacity(results.len());
        for output in part.function.outputs {
            let (own, others) = rest.split_at(output.len(self.shape));
            rest = others;
            if output.is_configuration() {
                let (mut held, mut step) = (own.to_vec(), vec![Sym::zero(); self.shape.nv]);
                Sym::held(&mut held, |_| {});
                small_difference(model, &held, own, &mut step);
                all.extend(step);
            } else {
                all.extend(own);
            }
        }
        all
    }

    /// The number of directions of an argument.
    fn count(&self, argument: Argument) -> usize {
        self.transform.dims(argument).iter().map(|d| d.len(self.shape)).product()
    }

    /// The inputs by which the function is differentiated, argument by argument.
    fn inputs(&self) -> Vec<(usize, usize)> {
        let of = |argument: &Argument| {
            let own = self.arguments.iter().position(|a| a == argument).unwrap_or_default();
            let count = self.count(*argument);
            let number = self.step(*argument).unwrap_or(own);
            (0..count).map(move |k| (number, k)).collect::<Vec<_>>()
        };
        self.transform.wrt.iter().flat_map(of).collect()
    }

    /// The node of the weight of number `k` of all results.
    fn weight(&self, graph: &mut Graph, mut k: usize) -> NodeId {
        for weights in &self.weights {
            let count = weights.len(self.shape);
            if k < count {
                let number = self.arguments.iter().rposition(|a| a == weights).unwrap_or_default();
                return graph.input(number, k);
            }
            k -= count;
        }
        graph.constant(0.0)
    }

    /// The number of an argument of the derivative.
    fn argument(&self, name: &str) -> usize {
        self.arguments.iter().rposition(|a| a.name() == name).unwrap_or_default()
    }

    /// The node of the direction of an input.
    fn direction(&self, graph: &mut Graph, input: (usize, usize)) -> Option<NodeId> {
        let argument = self.transform.wrt.iter().find(|argument| {
            let own = self.arguments.iter().position(|a| a == *argument);
            self.step(**argument).or(own) == Some(input.0)
        })?;
        let number = self.argument(&format!("d{}", argument.name()));
        Some(graph.input(number, input.1))
    }

    /// The graph with directions of the inputs, differentiated along them.
    fn along(&self, graph: &Graph) -> Graph {
        tangent(graph, |new, argument, index| self.direction(new, (argument, index)))
    }

    /// The derivative of the graph of the function.
    pub(crate) fn derivative(&self, graph: &Graph) -> Graph {
        let inputs = self.inputs();
        let weight = |graph: &mut Graph, k: usize| self.weight(graph, k);
        let found = match self.transform.kind {
            Derivative::Vjp => adjoint(graph, &inputs, weight),
            Derivative::Gradient => adjoint(graph, &inputs, |new, _| new.constant(1.0)),
            Derivative::Jvp => self.along(graph),
            Derivative::Hvp => self.along(&dce(&adjoint(graph, &inputs, weight))),
            Derivative::Hessian => self.hessian(&dce(&adjoint(graph, &inputs, weight)), &inputs),
            Derivative::Jacobian => self.jacobian(graph, &inputs),
        };
        pass::inline(&self.at_rest(&found))
    }

    /// The columns of the derivative of the gradient by forward mode, on and below the diagonal.
    /// The matrix is symmetric.
    fn hessian(&self, gradient: &Graph, inputs: &[(usize, usize)]) -> Graph {
        let (count, n) = (gradient.nodes().len(), inputs.len());
        let mut graph = gradient.clone();
        let one = graph.constant(1.0);
        let mut below = vec![one; n * n];
        for (column, input) in inputs.iter().enumerate() {
            let along = |_: &mut Graph, argument, index| ((argument, index) == *input).then_some(one);
            let entries = pass::tangents(&mut graph, &gradient.outputs[column..], count, along);
            entries.into_iter().enumerate().for_each(|(k, entry)| below[(column + k) * n + column] = entry);
        }
        let lengths: Vec<usize> = self.transform.wrt.iter().map(|a| self.count(*a)).collect();
        let starts: Vec<usize> = (0..lengths.len()).map(|k| lengths[..k].iter().sum()).collect();
        let mut outputs = Vec::with_capacity(n * n);
        for (first, rows) in starts.iter().zip(&lengths) {
            for (start, columns) in starts.iter().zip(&lengths) {
                for row in *first..first + rows {
                    outputs.extend((*start..start + columns).map(|column| below[row.max(column) * n + row.min(column)]));
                }
            }
        }
        graph.outputs = outputs;
        graph
    }

    /// All columns by forward mode, or all rows by reverse mode, whichever is cheaper.
    fn jacobian(&self, graph: &Graph, inputs: &[(usize, usize)]) -> Graph {
        let rows = graph.outputs.len();
        // A mode with many times as many sweeps is not tried.
        let (is_wide, is_tall) = (inputs.len() > 4 * rows.max(1), rows > 4 * inputs.len().max(1));
        let mut forward = graph.clone();
        let columns: Vec<Vec<NodeId>> = inputs
            .iter()
            .filter(|_| !is_wide)
            .map(|input| {
                let one = forward.constant(1.0);
                pass::tangents(&mut forward, &graph.outputs, graph.nodes().len(), |_, argument, index| {
                    ((argument, index) == *input).then_some(one)
                })
            })
            .collect();
        let mut reverse = graph.clone();
        let gradients: Vec<Vec<NodeId>> = (0..if is_tall { 0 } else { rows })
            .map(|row| {
                let one = reverse.constant(1.0);
                pass::gradients(&mut reverse, &[graph.outputs[row]], graph.nodes().len(), inputs, |_, _| one)
            })
            .collect();
        // One array for each result and argument: its rows, one after the other.
        let (mut below, mut by_columns, mut by_rows) = (0, Vec::new(), Vec::new());
        for result in &self.results {
            let mut first = 0;
            for argument in &self.transform.wrt {
                let count = self.count(*argument);
                for row in below..below + result {
                    by_columns.extend((first..first + count).filter_map(|column| Some(columns.get(column)?[row])));
                    by_rows.extend((first..first + count).filter_map(|column| Some(gradients.get(row)?[column])));
                }
                first += count;
            }
            below += result;
        }
        (forward.outputs, reverse.outputs) = (by_columns, by_rows);
        let [forward, reverse] = [forward, reverse].map(|graph| pass::inline(&self.at_rest(&graph)));
        if is_wide || is_tall {
            return if is_wide { reverse } else { forward };
        }
        if pass::cost(&reverse) < pass::cost(&forward) { reverse } else { forward }
    }

    /// The function of the table that has this jacobian, with the number of the block for each
    /// requested argument.
    pub(crate) fn own_algorithm(&self, part: &FunctionTerm) -> Option<(FunctionTerm, Vec<usize>)> {
        let fits = self.transform.kind == Derivative::Jacobian && !self.transform.in_coordinates;
        let (function, blocks) = part.function.jacobian().filter(|_| fits)?;
        let place = |argument: &Argument| blocks.iter().position(|block| block.contains(argument));
        let blocks = self.transform.wrt.iter().map(place).collect::<Option<_>>()?;
        Some((FunctionTerm { function, ..part.clone() }, blocks))
    }

    /// These blocks of its result.
    pub(crate) fn blocks(&self, mut graph: Graph, blocks: &[usize]) -> Graph {
        let size = self.shape.nv * self.shape.nv;
        let outputs = std::mem::take(&mut graph.outputs);
        graph.outputs = blocks.iter().flat_map(|block| outputs[block * size..][..size].to_vec()).collect();
        graph
    }

    /// The graph with δ = 0.
    fn at_rest(&self, graph: &Graph) -> Graph {
        let steps: Vec<usize> = self.transform.wrt.iter().filter_map(|argument| self.step(*argument)).collect();
        let graph = dce(graph);
        let mut new = graph.emptied();
        new.outputs = splice(&mut new, &graph, |new, argument, _| steps.contains(&argument).then(|| new.constant(0.0)));
        new
    }
}
