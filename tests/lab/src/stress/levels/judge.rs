//! Errors of a level's code, over what its contract allows.

use articulated_codegen::graph::Graph;
use articulated_codegen::{Arithmetic, TrigAccuracy, bound};
use articulated_core::Scalar;
use articulated_core::algorithm::{Argument, FunctionId};
use articulated_core::model::Model;
use articulated_reference::{Big, Magnitude, norms, scales};

use super::BuiltRobot;
use super::contract::Contract;
use crate::residual::worse;
use crate::stress::judge::{Judge, State, call, called, scale};
use crate::stress::machine::{cast, exact};
use crate::stress::row::{Case, Row};

/// For sums of two doubles: the remainder beyond one rounding of the result, in units of 2⁻¹⁰⁰ of
/// the terms.
const SECOND_ORDER: f64 = 1.0;

/// Every function that the code has, in these states.
pub fn rows(case: &Case, model: &Model<f64>, made: &BuiltRobot, states: &[State]) -> Vec<Row> {
    let states: Vec<State> = states.iter().map(|s| made.rounded(s)).collect();
    let regular: Vec<State> = states.iter().filter(|s| is_regular(case, model, made, s)).cloned().collect();
    let contract = Contract::of(made.level(), model.outward().count());
    let mut rows = Vec::new();
    for function in FUNCTIONS.into_iter().filter(|f| made.place(*f).is_some()) {
        // If M is singular there is no reference: the unchecked form returns any numbers.
        let states = if function.row::<f64>().inverts_mass_matrix() { &regular } else { &states };
        if !states.is_empty() {
            rows.extend(Judged { model, made, contract, function, by_terms: case.by_terms }.rows(case, states));
        }
    }
    rows
}

const FUNCTIONS: [FunctionId; 5] = [
    FunctionId::inverse_dynamics,
    FunctionId::mass_matrix,
    FunctionId::inverse_dynamics_derivatives,
    FunctionId::forward_dynamics,
    FunctionId::forward_dynamics_derivatives,
];

/// Whether M can be inverted in the level's numbers.
fn is_regular(case: &Case, model: &Model<f64>, made: &BuiltRobot, state: &State) -> bool {
    match made.level().arithmetic {
        Arithmetic::Single => Judge::<f32>::new(case, model).checked(state).is_ok(),
        _ => Judge::<f64>::new(case, model).checked(state).is_ok(),
    }
}

/// A function of a robot's code.
struct Judged<'a> {
    model: &'a Model<f64>,
    made: &'a BuiltRobot,
    contract: Contract,
    function: FunctionId,
    /// As [`Case::by_terms`].
    by_terms: bool,
}

impl Judged<'_> {
    fn rows(&self, case: &Case, states: &[State]) -> Vec<Row> {
        let worst = |of: &dyn Fn(&State) -> Option<f64>| states.iter().map(|s| of(s).unwrap_or(f64::NAN)).fold(0.0, worse);
        let (limit, unit) = self.contract.unit();
        let solves = self.function == FunctionId::forward_dynamics;
        let (name, what) = (self.function.name(), if solves { ", η" } else { "" });
        let error = worst(&|s| if solves { self.backward(s) } else { self.error(s) });
        let mut rows = vec![case.row(format!("{name}, generated{what}"), error * limit, limit, unit)];
        if let Some(reached) = self.of_bound(states) {
            rows.push(case.row(format!("{name}, generated, rounding over its guaranteed bound"), reached, 1.0, ""));
        }
        if self.made.level().sines == TrigAccuracy::DoubleDouble && self.graph().is_some() {
            let second = worst(&|s| self.second_order(s));
            rows.push(case.row(format!("{name}, generated, beyond one rounding of the result"), second, SECOND_ORDER, "2⁻¹⁰⁰"));
        }
        rows
    }

    /// The graph of the code.
    fn graph(&self) -> Option<&Graph> {
        self.made.generated.graphs.get(self.made.place(self.function)?)
    }

    fn arguments(&self, s: &State) -> Vec<Vec<f64>> {
        let of = |a: &Argument| match *a {
            Argument::Q => &s.q,
            Argument::V => &s.v,
            Argument::A => &s.a,
            Argument::Tau => &s.tau,
            _ => unreachable!("functions of motion and torques"),
        };
        self.function.row::<f64>().takes.iter().map(|a| of(a).clone()).collect()
    }

    /// The magnitudes of the terms as norms; magnitudes themselves for functions and robots without
    /// norms.
    fn norms(&self, function: FunctionId, arguments: &[&[f64]]) -> Option<Vec<f64>> {
        let norms = norms(function, self.model, arguments);
        if norms.is_empty() { scale(function, self.model, arguments) } else { Some(norms) }
    }

    /// The largest ratio of an error to the contract's, against the model in many digits.
    fn error(&self, state: &State) -> Option<f64> {
        let arguments = self.arguments(state);
        let found = self.made.call(self.function, &arguments)?;
        let slices: Vec<&[f64]> = arguments.iter().map(Vec::as_slice).collect();
        let sums = scale(self.function, self.model, &slices)?;
        let norms = self.norms(self.function, &slices)?;
        Some(Big::scope(|| {
            let given: Vec<Vec<Big>> = arguments.iter().map(|x| cast(x)).collect();
            let expected = called(&exact(self.model), self.function, &given);
            let one = |(k, e): (usize, &Big)| self.contract.part(e.error_of(found[k], 1.0), e.to_f64(), sums[k], norms[k]);
            expected.iter().enumerate().map(one).fold(0.0, worse)
        }))
    }

    /// For forward dynamics: the difference between the torques that accelerations need and the
    /// given ones, over the allowed difference.
    fn backward(&self, state: &State) -> Option<f64> {
        let State { q, v, tau, .. } = state;
        let (a, n) = (self.made.call(self.function, &self.arguments(state))?, tau.len());
        let m = call(FunctionId::mass_matrix, self.model, std::slice::from_ref(q));
        let h = call(FunctionId::bias_forces, self.model, &[q.clone(), v.clone()]);
        let driven = call(FunctionId::motor_torques, self.model, &[v.clone(), tau.clone()]);
        let zeros = vec![0.0; n];
        let norms_m = self.norms(FunctionId::mass_matrix, &[q])?;
        let norms_h = self.norms(FunctionId::inverse_dynamics, &[q, v, &zeros])?;
        let terms =
            || Some((scale(FunctionId::mass_matrix, self.model, &[q])?, scale(FunctionId::inverse_dynamics, self.model, &[q, v, &zeros])?));
        let (size_m, size_h) = if self.by_terms { terms()? } else { (m.clone(), h) };
        let moved = |m: &[f64], i: usize| (0..n).map(|k| (m[i * n + k] * a[k]).abs()).sum::<f64>();
        Some(Big::scope(|| {
            let [q, v, precise] = [q, v, &a].map(|x| cast::<Big>(x));
            let needed = called(&exact(self.model), FunctionId::inverse_dynamics, &[q, v, precise]);
            let one = |(i, t): (usize, &Big)| {
                let sum = moved(&size_m, i) + size_h[i].abs() + driven[i].abs();
                self.contract.part(t.error_of(driven[i], 1.0), moved(&m, i), sum, moved(&norms_m, i) + norms_h[i] + driven[i].abs())
            };
            needed.iter().enumerate().map(one).fold(0.0, worse)
        }))
    }

    /// The ratio of the rounding error to its guaranteed bound, if one is finite; `None` at levels
    /// without bounds.
    fn of_bound(&self, states: &[State]) -> Option<f64> {
        let graph = self.graph()?;
        let mut reached = None;
        for state in states {
            let arguments = self.arguments(state);
            let bounds = bound::bounds(graph, self.made.level(), &|argument, k| (arguments[argument][k], 0.0))?;
            let found = self.made.call(self.function, &arguments)?;
            Big::scope(|| {
                let expected = graph.evaluate_as(|argument, k| Big::from_f64(arguments[argument][k]));
                for ((e, f), b) in expected.iter().zip(&found).zip(&bounds).filter(|(_, b)| b.is_finite()) {
                    reached = Some(worse(e.error_of(*f, *b), reached.unwrap_or(0.0)));
                }
            });
        }
        reached
    }

    /// For sums of two doubles: the remainder of the difference from the graph beyond a rounding of
    /// the result, in units of 2⁻¹⁰⁰ of the terms.
    fn second_order(&self, state: &State) -> Option<f64> {
        let arguments = self.arguments(state);
        let graph = self.graph()?;
        let found = self.made.call(self.function, &arguments)?;
        let terms = self.graph_terms(&arguments)?;
        Some(Big::scope(|| {
            let expected = graph.evaluate_as(|argument, k| Big::from_f64(arguments[argument][k]));
            let one = |((e, f), terms): ((&Big, &f64), &f64)| {
                let beyond = e.error_of(*f, 1.0) - f64::EPSILON / 2.0 * e.to_f64().abs();
                if beyond <= 0.0 { 0.0 } else { beyond / (2.0_f64.powi(-100) * terms) }
            };
            expected.iter().zip(&found).zip(&terms).map(one).fold(0.0, worse)
        }))
    }

    /// Magnitudes of the terms of the graph's results; for solutions, the scale of a stable one.
    fn graph_terms(&self, arguments: &[Vec<f64>]) -> Option<Vec<f64>> {
        if self.function.row::<f64>().inverts_mass_matrix() {
            let slices: Vec<&[f64]> = arguments.iter().map(Vec::as_slice).collect();
            return scales(self.model, self.function.name(), &slices).ok();
        }
        let graph = self.graph()?;
        Some(graph.evaluate_as(|argument, k| Magnitude::from_f64(arguments[argument][k])).iter().map(|x| x.magnitude).collect())
    }
}
