//! Errors of all levels of a function in one state.
//!
//! Two references, each of 320 bits: the textbook's formulas on the numbers of the robot's file,
//! which are independent of the judged code (with effects, which they do not include, the generic
//! library), and the emitted graph itself, with its constants. The difference to the second is
//! rounding alone.

use articulated_codegen::graph::Graph;
use articulated_codegen::{Generated, Precision, bound};
use articulated_core::Scalar;
use articulated_core::algorithm::Function;
use articulated_core::model::Model;
use articulated_reference::{Big, Exact, ROUNDOFF, scales};

use crate::compare::accuracy::{above_residues, backward, singular};
use crate::residual::{exact, inverse_of, largest, worse};

/// The result of one state for one contender.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Verdict {
    /// Against the first, relative to the scale.
    pub(super) relative: f64,
    /// In units in the last place.
    pub(super) ulps: f64,
    /// Against the graph.
    pub(super) rounding: Option<f64>,
    pub(super) backward: Option<f64>,
    /// The largest guaranteed error, relative to the scale.
    pub(super) bound: Option<f64>,
    /// The largest ratio of an error to its bound.
    pub(super) reached: Option<f64>,
}

/// Source of a result: generated code of a precision with its graph and bounds, or another library.
pub(super) struct Found<'a> {
    pub(super) result: Vec<f64>,
    pub(super) own: Option<(&'a Graph, Precision)>,
}

/// The graph of a function.
pub(super) fn graph<'a>(generated: &'a Generated, function: &str) -> Option<&'a Graph> {
    let place = generated.ledger.functions.iter().position(|f| f.function == function)?;
    generated.graphs.get(place)
}

/// The results of a state for each; `None` without a valid reference. `state`: the arguments in the
/// function's order.
pub(super) fn verdicts(
    reference: &Exact,
    model: &Model<f64>,
    function: &'static Function<f64>,
    state: &[&[f64]],
    found: &[Found<'_>],
) -> Option<Vec<Verdict>> {
    Big::scope(|| {
        let by_reference = exact(reference, model, function.name, state)?;
        if singular(&by_reference) {
            return None;
        }
        let scale = above_residues(scales(model, function.name, state).ok()?);
        let mut graphs: Vec<(*const Graph, Vec<Big>)> = Vec::new();
        Some(found.iter().map(|f| one(f, (reference, model, function), state, (&by_reference, &scale), &mut graphs)).collect())
    })
}

type Place<'a> = (&'a Exact, &'a Model<f64>, &'static Function<f64>);

fn one(
    found: &Found<'_>,
    (reference, model, function): Place<'_>,
    state: &[&[f64]],
    (by_reference, scale): (&[Big], &[f64]),
    graphs: &mut Vec<(*const Graph, Vec<Big>)>,
) -> Verdict {
    let mut verdict = Verdict {
        relative: ROUNDOFF * largest(by_reference, &found.result, scale),
        ulps: in_ulps(by_reference, &found.result),
        ..Verdict::default()
    };
    if let Some(inverse) = inverse_of(function) {
        verdict.backward = backward(reference, model, inverse, state, &found.result).map(|units| ROUNDOFF * units);
    }
    let Some((graph, level)) = found.own else { return verdict };
    let key: *const Graph = graph;
    if !graphs.iter().any(|(k, _)| *k == key) {
        graphs.push((key, graph.evaluate_as(|argument, k| Big::from_f64(state[argument][k]))));
    }
    let Some((_, by_graph)) = graphs.iter().find(|(k, _)| *k == key) else { return verdict };
    verdict.rounding = Some(ROUNDOFF * largest(by_graph, &found.result, scale));
    let given = |argument: usize, k: usize| (state[argument][k], 0.0);
    if let Some(bounds) = bound::bounds(graph, level, &given) {
        verdict.bound = Some(bounds.iter().zip(scale).map(|(b, s)| if *b == 0.0 { 0.0 } else { b / s }).fold(0.0, f64::max));
        // An overflow exceeds every bound, so it has no ratio to it.
        let finite = by_graph.iter().zip(&found.result).zip(&bounds).filter(|((_, f), _)| f.is_finite());
        let parts = finite.map(|((e, f), b)| e.error_of(*f, *b));
        verdict.reached = Some(parts.fold(0.0, worse));
    }
    verdict
}

/// In units in the last place of the exact result as a double; exact zeros are left out.
fn in_ulps(exact: &[Big], found: &[f64]) -> f64 {
    let one = |(e, f): (&Big, &f64)| {
        let size = e.to_f64().abs();
        // A remainder of the 96 digits counts as zero.
        if size < 1e-60 { 0.0 } else { e.error_of(*f, size.next_up() - size) }
    };
    exact.iter().zip(found).map(one).fold(0.0, worse)
}
