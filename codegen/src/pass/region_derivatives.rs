//! Derivatives of regions: of each a region, or two.
//!
//! * An iteration ends at a fixed point x = F(x, p). Its tangent is the fixed point of
//!   dx = F_x dx + F_p dp, and its adjoint that of w = x̄ + F_xᵀ w, with p̄ = F_pᵀ w (Christianson,
//!   "Reverse accumulation and attractive fixed points", Optimization Methods and Software 3,
//!   1994). Both are iterations with the same rate of convergence. The start does not matter.
//! * What runs where a mask holds has its derivative there, and the identity elsewhere.
//! * What solves r(x, p) = 0 has dx = −A⁻¹ ∂r/∂p dp and p̄ = −(∂r/∂p)ᵀ A⁻¹ x̄, A = ∂r/∂x symmetric.
//! * Turns of a table have tangents turn by turn, and adjoints from the last turn to the first, for
//!   which the states are stored.

use std::sync::Arc;

use super::{dce, gradients, splice, tangents};
use crate::graph::{CAPTURED, CARRIED, Equation, Graph, Kind, NodeId, Op, ROW, Region, Rule};

/// Turns of the iteration for a derivative, for each turn of the iteration itself.
const LONGER: usize = 2;

/// Relative change of a derivative at which its iteration ends.
const TOLERANCE: f64 = 256.0 * f64::EPSILON / 2.0;

/// A region of a graph, the values that go into it, and their tangents.
pub(super) struct Occurrence {
    /// Its node.
    pub(super) of: NodeId,
    /// The region.
    pub(super) region: Arc<Region>,
    /// The values that go in.
    pub(super) given: Vec<NodeId>,
}

impl Occurrence {
    pub(super) fn new(graph: &Graph, of: NodeId) -> Self {
        let node = graph.node(of);
        Self { of, region: graph.region_of(&node).clone(), given: graph.given(&node) }
    }

    fn starts(&self) -> &[NodeId] {
        &self.given[..self.region.carried]
    }

    fn captured(&self) -> &[NodeId] {
        &self.given[self.region.carried..self.region.carried + self.region.captured]
    }

    fn table(&self) -> &[NodeId] {
        &self.given[self.region.carried + self.region.captured..]
    }

    /// The state at which its derivative is taken: where it ends, or where it begins.
    fn state(&self, graph: &mut Graph) -> Vec<NodeId> {
        match self.region.kind {
            Kind::Repeat { .. } => (0..self.region.carried).map(|k| graph.region_value(self.of, k)).collect(),
            _ => self.starts().to_vec(),
        }
    }

    /// A body with the state and then the captured values as captured values, for its derivative.
    fn at_state(&self) -> (Graph, Vec<NodeId>) {
        let (mut graph, n) = (Graph::default(), self.region.carried);
        let outputs =
            splice(&mut graph, &self.region.body, |g, argument, k| Some(g.input(CAPTURED, if argument == CARRIED { k } else { n + k })));
        (graph, outputs)
    }

    /// The columns of the table in which a value is `active`.
    fn columns(&self, active: impl Fn(usize) -> bool) -> Vec<usize> {
        let Kind::ForEach { turns, row, .. } = self.region.kind else { return Vec::new() };
        let first = self.region.carried + self.region.captured;
        (0..row).filter(|column| (0..turns).any(|turn| active(first + turn * row + column))).collect()
    }

    /// Adds the region of the tangents; `known`: those of the values that go in.
    pub(super) fn tangent(&self, graph: &mut Graph, known: &[Option<NodeId>]) -> NodeId {
        let (n, m) = (self.region.carried, self.region.captured);
        let zero = graph.constant(0.0);
        let active: Vec<usize> = (0..m).filter(|j| known[n + j].is_some()).collect();
        let moved = || active.iter().filter_map(|j| known[n + j]);
        let starts = || known[..n].iter().map(|start| start.unwrap_or(zero));
        if let Rule::Equation(equation) = &self.region.rule {
            return self.tangent_by(equation, graph, &active, moved());
        }
        if let Kind::ForEach { turns, row, results } = self.region.kind {
            return self.tangent_of_turns(graph, known, (turns, row, results), &active);
        }
        let (mut body, outputs) = self.at_state();
        let count = body.nodes().len();
        let mut slopes = tangents(&mut body, &outputs[..n], count, |g, _, k| {
            if k < n {
                return Some(g.input(CARRIED, k));
            }
            let place = active.iter().position(|j| n + j == k)?;
            Some(g.input(CAPTURED, n + m + place))
        });
        let mut given: Vec<NodeId> = if self.region.kind == Kind::When { starts().collect() } else { vec![zero; n] };
        given.extend(self.state(graph));
        given.extend(self.captured().iter().copied().chain(moved()));
        let kind = match self.region.kind {
            Kind::Repeat { most } => {
                slopes.push(settled(&mut body, &slopes));
                Kind::Repeat { most: LONGER * most }
            }
            kind => {
                given.extend(self.table());
                kind
            }
        };
        body.outputs = slopes;
        graph.region(Arc::new(Region { kind, carried: n, captured: n + m + active.len(), body, rule: Rule::OfItsKind }), &given)
    }

    /// The values of an equation: results of one turn.
    fn solution(&self, graph: &mut Graph) -> Vec<NodeId> {
        (0..self.region.values()).map(|k| graph.region_value(self.of, k)).collect()
    }

    /// dx = −A⁻¹ ∂r/∂p dp; captured values: x, p, dp.
    fn tangent_by(&self, equation: &Equation, graph: &mut Graph, active: &[usize], moved: impl Iterator<Item = NodeId>) -> NodeId {
        let (n, m) = (self.region.values(), self.region.captured);
        let (mut body, residual) = at_solution(&equation.residual, n);
        let count = body.nodes().len();
        let slopes = tangents(&mut body, &residual, count, |g, _, k| {
            let place = active.iter().position(|j| n + j == k)?;
            Some(g.input(CAPTURED, n + m + place))
        });
        let b: Vec<NodeId> = slopes.iter().map(|slope| body.apply(Op::Neg, &[*slope])).collect();
        body.outputs = solved(&mut body, equation, &b);
        let given: Vec<NodeId> = self.solution(graph).into_iter().chain(self.captured().iter().copied()).chain(moved).collect();
        graph.region(Arc::new(once(body, n + m + active.len())), &given)
    }

    /// p̄ = −(∂r/∂p)ᵀ A⁻¹ x̄; captured values: x, p, x̄.
    fn adjoint_by(&self, equation: &Equation, graph: &mut Graph, weights: &[Option<NodeId>], active: &[bool]) -> Vec<(usize, NodeId)> {
        let (n, m) = (self.region.values(), self.region.captured);
        let zero = graph.constant(0.0);
        let wanted: Vec<usize> = (0..m).filter(|j| active[*j]).collect();
        let (mut body, residual) = at_solution(&equation.residual, n);
        let count = body.nodes().len();
        let seeds: Vec<NodeId> = (0..n).map(|k| body.input(CAPTURED, n + m + k)).collect();
        let mu = solved(&mut body, equation, &seeds);
        let wrt: Vec<(usize, usize)> = wanted.iter().map(|j| (CAPTURED, n + j)).collect();
        let found = gradients(&mut body, &residual, count, &wrt, |_, k| mu[k]);
        body.outputs = found.iter().map(|x| body.apply(Op::Neg, &[*x])).collect();
        let mut given: Vec<NodeId> = self.solution(graph).into_iter().chain(self.captured().iter().copied()).collect();
        given.extend(weights.iter().map(|weight| weight.unwrap_or(zero)));
        let back = graph.region(Arc::new(once(body, n + m + n)), &given);
        wanted.into_iter().enumerate().map(|(k, place)| (place, graph.region_value(back, k))).collect()
    }

    fn tangent_of_turns(
        &self,
        graph: &mut Graph,
        known: &[Option<NodeId>],
        (turns, row, results): (usize, usize, usize),
        active: &[usize],
    ) -> NodeId {
        let (n, m) = (self.region.carried, self.region.captured);
        let zero = graph.constant(0.0);
        let columns = self.columns(|k| known[k].is_some());
        let mut body = Graph::default();
        let outputs = splice(&mut body, &self.region.body, |_, _, _| None);
        let count = body.nodes().len();
        let slopes = tangents(&mut body, &outputs, count, |g, argument, k| match argument {
            CARRIED => Some(g.input(CARRIED, n + k)),
            CAPTURED => active.iter().position(|j| *j == k).map(|place| g.input(CAPTURED, m + place)),
            _ => columns.iter().position(|column| *column == k).map(|place| g.input(ROW, row + place)),
        });
        let (next, along) = slopes.split_at(n);
        body.outputs = [&outputs[..n], next, along].concat();
        let mut given = self.starts().to_vec();
        given.extend(known[..n].iter().map(|start| start.unwrap_or(zero)));
        given.extend(self.captured().iter().copied().chain(active.iter().filter_map(|j| known[n + j])));
        for turn in 0..turns {
            let first = n + m + turn * row;
            given.extend(&self.given[first..first + row]);
            given.extend(columns.iter().map(|column| known[first + column].unwrap_or(zero)));
        }
        let kind = Kind::ForEach { turns, row: row + columns.len(), results };
        graph.region(Arc::new(Region { kind, carried: 2 * n, captured: m + active.len(), body, rule: Rule::OfItsKind }), &given)
    }

    /// The tangent of value `k` that comes out, from the region of the tangents.
    pub(super) fn tangent_value(&self, graph: &mut Graph, tangents: NodeId, k: usize) -> Option<NodeId> {
        let n = self.region.carried;
        match self.region.kind {
            Kind::Repeat { .. } if k >= n => None,
            Kind::ForEach { .. } => Some(graph.region_value(tangents, n + k)),
            _ => Some(graph.region_value(tangents, k)),
        }
    }

    /// Adds the regions of the adjoints. `weights`: the adjoints of the values that come out;
    /// `active`: which of the values that go in have one. Returns those.
    pub(super) fn adjoint(&self, graph: &mut Graph, weights: &[Option<NodeId>], active: &[bool]) -> Vec<(usize, NodeId)> {
        match &self.region.rule {
            Rule::OfItsKind => {}
            Rule::Equation(equation) => return self.adjoint_by(equation, graph, weights, active),
            Rule::Held => return Vec::new(),
        }
        match self.region.kind {
            Kind::Repeat { most } => self.adjoint_of_iteration(graph, weights, active, most),
            Kind::When => self.adjoint_where(graph, weights, active),
            Kind::ForEach { turns, row, results } => self.adjoint_of_turns(graph, weights, active, (turns, row, results)),
        }
    }

    fn adjoint_of_iteration(&self, graph: &mut Graph, weights: &[Option<NodeId>], active: &[bool], most: usize) -> Vec<(usize, NodeId)> {
        let (n, m) = (self.region.carried, self.region.captured);
        let zero = graph.constant(0.0);
        let seeds: Vec<NodeId> = weights[..n].iter().map(|weight| weight.unwrap_or(zero)).collect();
        let at: Vec<NodeId> = self.state(graph).into_iter().chain(self.captured().iter().copied()).collect();
        // w = x̄ + F_xᵀ w
        let (mut body, outputs) = self.at_state();
        let (count, wrt) = (body.nodes().len(), (0..n).map(|k| (CAPTURED, k)).collect::<Vec<_>>());
        let back = gradients(&mut body, &outputs[..n], count, &wrt, |g, k| g.input(CARRIED, k));
        let sum = |(k, back): (usize, &NodeId)| {
            let seed = body.input(CAPTURED, n + m + k);
            body.apply(Op::Add, &[seed, *back])
        };
        let mut next: Vec<NodeId> = back.iter().enumerate().map(sum).collect();
        next.push(settled(&mut body, &next));
        body.outputs = next;
        let given = [&seeds[..], &at, &seeds].concat();
        let kind = Kind::Repeat { most: LONGER * most };
        let held = graph.region(Arc::new(Region { kind, carried: n, captured: n + m + n, body, rule: Rule::OfItsKind }), &given);
        // p̄ = F_pᵀ w
        let wanted: Vec<usize> = (0..m).filter(|j| active[n + j]).collect();
        let (mut after, outputs) = self.at_state();
        let (count, wrt) = (after.nodes().len(), wanted.iter().map(|j| (CAPTURED, n + j)).collect::<Vec<_>>());
        after.outputs = gradients(&mut after, &outputs[..n], count, &wrt, |g, k| g.input(CARRIED, k));
        let w: Vec<NodeId> = (0..n).map(|k| graph.region_value(held, k)).collect();
        let found = splice(graph, &dce(&after), |_, argument, k| Some(if argument == CARRIED { w[k] } else { at[k] }));
        wanted.into_iter().map(|j| n + j).zip(found).collect()
    }

    fn adjoint_where(&self, graph: &mut Graph, weights: &[Option<NodeId>], active: &[bool]) -> Vec<(usize, NodeId)> {
        let (n, m) = (self.region.carried, self.region.captured);
        let zero = graph.constant(0.0);
        let wanted: Vec<usize> = (0..m).filter(|j| active[n + j]).collect();
        let (mut body, outputs) = self.at_state();
        let count = body.nodes().len();
        let wrt: Vec<(usize, usize)> = (0..n).chain(wanted.iter().map(|j| n + j)).map(|k| (CAPTURED, k)).collect();
        body.outputs = gradients(&mut body, &outputs, count, &wrt, |g, k| g.input(CARRIED, k));
        let mut given: Vec<NodeId> = weights.iter().map(|weight| weight.unwrap_or(zero)).collect();
        given.extend(wanted.iter().map(|_| zero));
        given.extend(self.starts().iter().chain(self.captured()).chain(self.table()));
        let region = Region { kind: Kind::When, carried: n + wanted.len(), captured: n + m, body, rule: Rule::OfItsKind };
        let found = graph.region(Arc::new(region), &given);
        let places = (0..n).chain(wanted.into_iter().map(|j| n + j));
        places.enumerate().map(|(k, place)| (place, graph.region_value(found, k))).collect()
    }

    fn adjoint_of_turns(
        &self,
        graph: &mut Graph,
        weights: &[Option<NodeId>],
        active: &[bool],
        (turns, row, results): (usize, usize, usize),
    ) -> Vec<(usize, NodeId)> {
        let (n, m) = (self.region.carried, self.region.captured);
        let zero = graph.constant(0.0);
        let states = self.states(graph, turns, row);
        let wanted: Vec<usize> = (0..m).filter(|j| active[n + j]).collect();
        let columns = self.columns(|k| active[k]);
        // A row has the state at the start of its turn, the row of the table, and ȳ.
        let mut body = Graph::default();
        let outputs = splice(&mut body, &self.region.body, |g, argument, k| match argument {
            CARRIED => Some(g.input(ROW, k)),
            ROW => Some(g.input(ROW, n + k)),
            _ => None,
        });
        let count = body.nodes().len();
        let mut wrt: Vec<(usize, usize)> = (0..n).map(|k| (ROW, k)).collect();
        wrt.extend(wanted.iter().map(|j| (CAPTURED, *j)));
        wrt.extend(columns.iter().map(|column| (ROW, n + column)));
        let mut found = gradients(&mut body, &outputs, count, &wrt, |g, k| if k < n { g.input(CARRIED, k) } else { g.input(ROW, row + k) });
        for (k, sum) in found.iter_mut().enumerate().skip(n).take(wanted.len()) {
            let before = body.input(CARRIED, k);
            *sum = body.apply(Op::Add, &[before, *sum]);
        }
        body.outputs = found;
        let mut given: Vec<NodeId> = weights[..n].iter().map(|weight| weight.unwrap_or(zero)).collect();
        given.extend(wanted.iter().map(|_| zero));
        given.extend(self.captured());
        for turn in (0..turns).rev() {
            given.extend(&states[turn * n..][..n]);
            given.extend(&self.table()[turn * row..][..row]);
            given.extend(weights[n + turn * results..][..results].iter().map(|weight| weight.unwrap_or(zero)));
        }
        let carried = n + wanted.len();
        let kind = Kind::ForEach { turns, row: n + row + results, results: columns.len() };
        let back = graph.region(Arc::new(Region { kind, carried, captured: m, body, rule: Rule::OfItsKind }), &given);
        let mut all: Vec<usize> = (0..n).chain(wanted.iter().map(|j| n + j)).collect();
        all.extend((0..turns).rev().flat_map(|turn| columns.iter().map(move |column| n + m + turn * row + column)));
        all.into_iter().enumerate().map(|(k, place)| (place, graph.region_value(back, k))).collect()
    }

    /// The states at the start of each turn.
    fn states(&self, graph: &mut Graph, turns: usize, row: usize) -> Vec<NodeId> {
        let n = self.region.carried;
        if n == 0 {
            return Vec::new();
        }
        let mut body = self.region.body.clone();
        body.outputs.truncate(n);
        let before: Vec<NodeId> = (0..n).map(|k| body.input(CARRIED, k)).collect();
        body.outputs.extend(before);
        let kind = Kind::ForEach { turns, row, results: n };
        let stored = graph.region(
            Arc::new(Region { kind, carried: n, captured: self.region.captured, body: dce(&body), rule: Rule::OfItsKind }),
            &self.given,
        );
        (0..turns * n).map(|k| graph.region_value(stored, n + k)).collect()
    }
}

/// A body with x as captured values, and p behind them.
fn at_solution(residual: &Graph, n: usize) -> (Graph, Vec<NodeId>) {
    let mut body = Graph::default();
    let outputs = splice(&mut body, residual, |g, argument, k| Some(g.input(CAPTURED, if argument == CARRIED { k } else { n + k })));
    (body, outputs)
}

/// A⁻¹ b in a body with x and p as captured values.
fn solved(body: &mut Graph, equation: &Equation, b: &[NodeId]) -> Vec<NodeId> {
    let n = b.len();
    splice(body, &equation.solve, |g, argument, k| Some(if argument == CARRIED { b[k] } else { g.input(CAPTURED, n + k) }))
}

/// A region of one turn without a table.
fn once(body: Graph, captured: usize) -> Region {
    let kind = Kind::ForEach { turns: 1, row: 0, results: body.outputs.len() };
    Region { kind, carried: 0, captured, body, rule: Rule::OfItsKind }
}

/// The mask that the carried values no longer change, as in `articulated_core::region`.
fn settled(body: &mut Graph, next: &[NodeId]) -> NodeId {
    let (zero, one, half, tolerance) = (body.constant(0.0), body.constant(1.0), body.constant(0.5), body.constant(TOLERANCE));
    let mut moves = zero;
    for (k, new) in next.iter().enumerate() {
        let old = body.input(CARRIED, k);
        let change = body.apply(Op::Sub, &[*new, old]);
        let [change, size] = [change, *new].map(|x| {
            let (is_positive, minus) = (body.apply(Op::Positive, &[x]), body.apply(Op::Neg, &[x]));
            body.apply(Op::Select, &[is_positive, x, minus])
        });
        let allowed = body.apply(Op::Mul, &[tolerance, size]);
        let beyond = body.apply(Op::Sub, &[change, allowed]);
        let beyond = body.apply(Op::Positive, &[beyond]);
        moves = body.apply(Op::Select, &[beyond, one, moves]);
    }
    let rest = body.apply(Op::Sub, &[half, moves]);
    body.apply(Op::Positive, &[rest])
}
