//! The symbolic scalar: a node of the graph that is being traced on this thread.
//!
//! Operations are calls, not inlined: algorithms would become several times as large, and as long
//! to compile, for nothing.

use std::cell::RefCell;
use std::fmt;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};
use std::sync::Arc;

use articulated_core::{Scalar, region};
use num_traits::{One, Zero};

use crate::graph::{CAPTURED, CARRIED, Equation, Graph, Kind, NodeId, Op, ROW, Region, Rule};

thread_local! {
    static TRACE: RefCell<Trace> = RefCell::default();
}

/// A symbol. Its arithmetic adds nodes to the graph that is being traced on this thread.
#[derive(Clone, Copy)]
pub struct Sym {
    node: NodeId,
    /// The graph that has the node: 0, or the number of a region's body.
    level: u32,
}

/// The graphs that are being traced: a program, and the bodies of the regions around the operation
/// that comes next, from the outermost inwards.
#[derive(Default)]
struct Trace {
    program: Graph,
    bodies: Vec<Body>,
    /// How many regions were opened.
    opened: u32,
    /// How often it is differentiated: then regions that only derivatives need are kept.
    orders: usize,
}

/// The body of a region while it is traced.
struct Body {
    level: u32,
    graph: Graph,
    /// The values that it captures, in the graph around it.
    captured: Vec<NodeId>,
}

impl Trace {
    fn level(&self) -> u32 {
        self.bodies.last().map_or(0, |body| body.level)
    }

    fn graph(&mut self) -> &mut Graph {
        self.bodies.last_mut().map_or(&mut self.program, |body| &mut body.graph)
    }

    /// The node of a symbol in the graph that is being traced.
    fn node(&mut self, symbol: Sym) -> NodeId {
        if symbol.level == self.level() { symbol.node } else { self.captured(symbol) }
    }

    /// The same for a symbol of a graph around this one.
    #[cold]
    fn captured(&mut self, symbol: Sym) -> NodeId {
        let place = self.bodies.iter().position(|body| body.level == symbol.level);
        let first = place.map_or(0, |place| place + 1);
        assert!(symbol.level == 0 || place.is_some(), "a value of the body of a region is used outside of it");
        let mut node = symbol.node;
        for k in first..self.bodies.len() {
            let (before, rest) = self.bodies.split_at_mut(k);
            let outer = before.last_mut().map_or(&mut self.program, |body| &mut body.graph);
            node = rest[0].capture(outer, node);
        }
        node
    }

    /// The number that a symbol is.
    fn constant(&self, symbol: Sym) -> Option<f64> {
        let body = self.bodies.iter().find(|body| body.level == symbol.level);
        body.map_or(&self.program, |body| &body.graph).node(symbol.node).constant()
    }
}

impl Body {
    /// The node for one of the graph around it. Masks go in as numbers.
    fn capture(&mut self, outer: &mut Graph, of: NodeId) -> NodeId {
        let node = outer.node(of);
        if node.constant().is_some() {
            return self.graph.leaf(node);
        }
        if node.op == Op::Positive {
            let [one, zero] = [1.0, 0.0].map(|x| outer.constant(x));
            let number = outer.apply(Op::Select, &[of, one, zero]);
            let inside = self.capture(outer, number);
            return self.graph.exactly(Op::Positive, &[inside]);
        }
        let place = self.captured.iter().position(|other| *other == of).unwrap_or_else(|| {
            self.captured.push(of);
            self.captured.len() - 1
        });
        self.graph.input(CAPTURED, place)
    }
}

impl PartialEq for Sym {
    fn eq(&self, other: &Self) -> bool {
        if self.level == other.level {
            return self.node == other.node;
        }
        let [one, two] = [*self, *other].map(|symbol| TRACE.with_borrow(|trace| trace.constant(symbol)));
        one.is_some() && one == two
    }
}

impl Sym {
    /// Element `index` of argument number `argument`.
    ///
    /// # Panics
    /// In the body of a region, which captures what it reads.
    pub fn input(argument: usize, index: usize) -> Self {
        TRACE.with_borrow_mut(|trace| {
            assert!(trace.bodies.is_empty(), "an input is read before the region");
            Self { node: trace.program.input(argument, index), level: 0 }
        })
    }

    fn of(node: impl FnOnce(&mut Graph) -> NodeId) -> Self {
        TRACE.with_borrow_mut(|trace| {
            let level = trace.level();
            Self { node: node(trace.graph()), level }
        })
    }
}

/// Runs `program` and returns the graph that it built, with what it returned as outputs.
///
/// Any function over [`Scalar`] can be traced:
///
/// ```
/// use articulated_codegen::core::Scalar;
/// use articulated_codegen::sym::{Sym, trace};
///
/// let graph = trace(|| {
///     let q = Sym::input(0, 0);
///     vec![q.sin_cos().0 * Sym::from_f64(9.81) + Sym::from_f64(0.0)]
/// });
/// // Adding zero costs nothing.
/// assert_eq!((graph.counts().multiplications(), graph.counts().additions()), (1, 0));
/// ```
///
/// [`Scalar::repeat`], [`Scalar::when`] and [`Scalar::for_each`] are traced once, whatever the
/// number of turns.
///
/// # Panics
/// If a body of a region hands a value to the program around it, other than by its state and its
/// results.
pub fn trace(program: impl FnOnce() -> Vec<Sym>) -> Graph {
    traced(0, program)
}

/// The same for a program that is differentiated so many times in a row: what solves an equation
/// stays a region until [`inline`](crate::pass::inline).
pub(crate) fn trace_with_equations(orders: usize, program: impl FnOnce() -> Vec<Sym>) -> Graph {
    traced(orders, program)
}

fn traced(orders: usize, program: impl FnOnce() -> Vec<Sym>) -> Graph {
    let outer = TRACE.replace(Trace { orders, ..Trace::default() });
    let outputs = program();
    let mut trace = TRACE.replace(outer);
    let outputs = outputs.into_iter().map(|symbol| trace.node(symbol)).collect();
    trace.program.outputs = outputs;
    trace.program
}

fn apply(op: Op, operands: &[Sym]) -> Sym {
    TRACE.with_borrow_mut(|trace| {
        let mut ids = [NodeId(0); 3];
        for (id, symbol) in ids.iter_mut().zip(operands) {
            *id = trace.node(*symbol);
        }
        let level = trace.level();
        Sym { node: trace.graph().apply(op, &ids[..operands.len()]), level }
    })
}

/// Traces a body as a graph of its own. It gets the symbols of `inputs[k]` elements of argument k,
/// and returns the results. `captured`: the nodes of the graph around it that bodies before it
/// captured, behind which its own come.
fn body(inputs: [usize; 3], captured: &mut Vec<NodeId>, body: impl FnOnce([&mut [Sym]; 3]) -> Vec<Sym>) -> Graph {
    let mut symbols = TRACE.with_borrow_mut(|trace| {
        trace.opened += 1;
        let (level, mut graph) = (trace.opened, Graph::default());
        let symbols = [CARRIED, CAPTURED, ROW]
            .map(|argument| (0..inputs[argument]).map(|k| Sym { node: graph.input(argument, k), level }).collect::<Vec<_>>());
        trace.bodies.push(Body { level, graph, captured: std::mem::take(captured) });
        symbols
    });
    let results = body(symbols.each_mut().map(Vec::as_mut_slice));
    TRACE.with_borrow_mut(|trace| {
        let outputs = results.into_iter().map(|symbol| trace.node(symbol)).collect();
        let Some(mut done) = trace.bodies.pop() else { return Graph::default() };
        *captured = done.captured;
        done.graph.outputs = outputs;
        done.graph
    })
}

/// Adds a region on these starts and further values, and returns the values that come out.
fn opened(kind: Kind, body: Graph, rule: Rule, starts: &[Sym], captured: &[NodeId], more: &[Sym]) -> Vec<Sym> {
    TRACE.with_borrow_mut(|trace| {
        let mut given: Vec<NodeId> = starts.iter().map(|symbol| trace.node(*symbol)).collect();
        given.extend(captured);
        given.extend(more.iter().map(|symbol| trace.node(*symbol)).collect::<Vec<_>>());
        let region = Region { kind, carried: starts.len(), captured: captured.len(), body, rule };
        let (values, level) = (region.values(), trace.level());
        let graph = trace.graph();
        let region = graph.region(Arc::new(region), &given);
        (0..values).map(|k| Sym { node: graph.region_value(region, k), level }).collect()
    })
}

impl fmt::Debug for Sym {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "x{}", self.node.0)
    }
}

macro_rules! operator {
    ($op:ident, $trait:ident::$method:ident, $assign:ident::$assign_method:ident) => {
        impl $trait for Sym {
            type Output = Sym;
            #[inline(never)]
            fn $method(self, other: Sym) -> Sym {
                apply(Op::$op, &[self, other])
            }
        }
        impl $assign for Sym {
            #[inline(never)]
            fn $assign_method(&mut self, other: Sym) {
                *self = apply(Op::$op, &[*self, other]);
            }
        }
    };
}

operator!(Add, Add::add, AddAssign::add_assign);
operator!(Sub, Sub::sub, SubAssign::sub_assign);
operator!(Mul, Mul::mul, MulAssign::mul_assign);

impl Div for Sym {
    type Output = Sym;
    #[inline(never)]
    fn div(self, other: Sym) -> Sym {
        apply(Op::Div, &[self, other])
    }
}

impl Neg for Sym {
    type Output = Sym;
    #[inline(never)]
    fn neg(self) -> Sym {
        apply(Op::Neg, &[self])
    }
}

impl Zero for Sym {
    fn zero() -> Self {
        Self::from_f64(0.0)
    }
    fn is_zero(&self) -> bool {
        TRACE.with_borrow(|trace| trace.constant(*self)) == Some(0.0)
    }
}

impl One for Sym {
    fn one() -> Self {
        Self::from_f64(1.0)
    }
}

impl Scalar for Sym {
    const FOLDS: bool = true;

    type Mask = Sym;

    fn from_f64(x: f64) -> Self {
        Self::of(|graph| graph.constant(x))
    }

    fn sin_cos(self) -> (Self, Self) {
        (apply(Op::Sin, &[self]), apply(Op::Cos, &[self]))
    }

    fn sqrt(self) -> Self {
        apply(Op::Sqrt, &[self])
    }

    fn atan2(self, x: Self) -> Self {
        apply(Op::Atan2, &[self, x])
    }

    fn positive(self) -> Sym {
        apply(Op::Positive, &[self])
    }

    fn select(mask: Sym, a: Self, b: Self) -> Self {
        apply(Op::Select, &[mask, a, b])
    }

    fn repeat(most: usize, state: &mut [Self], mut turn: impl FnMut(&mut [Self]) -> Self) -> Self {
        if most == 0 {
            return Self::zero().positive();
        }
        let mut captured = Vec::new();
        let graph = body([state.len(), 0, 0], &mut captured, |[carried, ..]| {
            let ends = turn(carried);
            [&*carried, &[ends]].concat()
        });
        let values = opened(Kind::Repeat { most }, graph, Rule::OfItsKind, state, &captured, &[]);
        let (next, held) = values.split_at(state.len());
        state.copy_from_slice(next);
        held[0].positive()
    }

    fn when(mask: Self, state: &mut [Self], turn: impl FnOnce(&mut [Self])) {
        match TRACE.with_borrow(|trace| trace.constant(mask)) {
            Some(0.0) => return,
            Some(_) => return turn(state),
            None => {}
        }
        let mut captured = Vec::new();
        let graph = body([state.len(), 0, 0], &mut captured, |[carried, ..]| {
            turn(carried);
            carried.to_vec()
        });
        let values = opened(Kind::When, graph, Rule::OfItsKind, state, &captured, &[mask]);
        state.copy_from_slice(&values);
    }

    fn for_each(
        turns: usize,
        table: &[Self],
        state: &mut [Self],
        results: &mut [Self],
        mut turn: impl FnMut(&[Self], &mut [Self], &mut [Self]),
    ) {
        let [row, own] = region::widths(turns, table.len(), results.len());
        if turns < 2 {
            return region::for_each_turn(turns, table, state, results, turn);
        }
        // What is the same in each row is no column.
        let varies: Vec<bool> = (0..row).map(|k| table.iter().skip(k).step_by(row).any(|value| *value != table[k])).collect();
        let mut captured = Vec::new();
        let graph = body([state.len(), 0, varies.iter().filter(|varies| **varies).count()], &mut captured, |[carried, _, row]| {
            let (mut own_columns, mut results) = (row.iter(), vec![Self::zero(); own]);
            let column = |(value, varies): (&Self, &bool)| if *varies { *own_columns.next().unwrap_or(value) } else { *value };
            let row: Vec<Self> = table.iter().zip(&varies).map(column).collect();
            turn(&row, carried, &mut results);
            [&*carried, &results].concat()
        });
        let table: Vec<Self> = table.iter().zip(varies.iter().cycle()).filter(|(_, varies)| **varies).map(|(value, _)| *value).collect();
        let kind = Kind::ForEach { turns, row: table.len() / turns, results: own };
        let values = opened(kind, graph, Rule::OfItsKind, state, &captured, &table);
        let (next, found) = values.split_at(state.len());
        state.copy_from_slice(next);
        results.copy_from_slice(found);
    }

    fn orders() -> usize {
        TRACE.with_borrow(|trace| trace.orders)
    }

    fn held(x: &mut [Self], value: impl FnOnce(&mut [Self])) {
        if !TRACE.with_borrow(|trace| trace.orders > 0) {
            return value(x);
        }
        let (kind, mut captured) = (Kind::ForEach { turns: 1, row: 0, results: x.len() }, Vec::new());
        let graph = body([0, 0, 0], &mut captured, |_| {
            let mut x = x.to_vec();
            value(&mut x);
            x
        });
        x.copy_from_slice(&opened(kind, graph, Rule::Held, &[], &captured, &[]));
    }

    fn implicit<C>(
        context: &mut C,
        x: &mut [Self],
        value: impl FnOnce(&mut C, &mut [Self]),
        residual: impl FnOnce(&mut C, &[Self], &mut [Self]),
        solve: impl FnOnce(&mut C, &mut [Self]),
    ) {
        if !TRACE.with_borrow(|trace| trace.orders > 0) {
            return value(context, x);
        }
        let (n, mut captured) = (x.len(), Vec::new());
        let found = body([0, 0, 0], &mut captured, |_| {
            let mut x = vec![Self::zero(); n];
            value(context, &mut x);
            x
        });
        let residual = body([n, 0, 0], &mut captured, |[x, ..]| {
            let mut r = vec![Self::zero(); n];
            residual(context, x, &mut r);
            r
        });
        let solve = body([n, 0, 0], &mut captured, |[b, ..]| {
            solve(context, b);
            b.to_vec()
        });
        let kind = Kind::ForEach { turns: 1, row: 0, results: n };
        x.copy_from_slice(&opened(kind, found, Rule::Equation(Box::new(Equation { residual, solve })), &[], &captured, &[]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_traced_program_evaluates_to_what_it_says() {
        let program = || {
            let (x, y) = (Sym::input(0, 0), Sym::input(1, 0));
            let (s, c) = x.sin_cos();
            vec![s * s + c * c, Scalar::abs(y), (x / y).sqrt(), y.atan2(x), Sym::one().atan2(Sym::zero())]
        };
        let graph = trace(program);
        let out = graph.evaluate(|argument, _| if argument == 0 { -0.5 } else { -2.0 });
        assert!((out[0] - 1.0).abs() < 1e-15);
        assert_eq!(&out[1..], [2.0, 0.5, f64::atan2(-2.0, -0.5), std::f64::consts::FRAC_PI_2]);
    }

    /// A table drops the column that is the same in all rows, and the column that the body does not
    /// read.
    #[test]
    fn a_table_has_the_columns_that_vary_and_are_read() {
        let graph = trace(|| {
            let x = |k: usize| Sym::input(0, k);
            let (table, mut sum) = ([x(0), x(9), x(3), x(1), x(9), x(4), x(2), x(9), x(5)], [Sym::zero()]);
            Sym::for_each(3, &table, &mut sum, &mut [], |row, sum, _| sum[0] += row[0] * row[1]);
            sum.to_vec()
        });
        let graph = crate::pass::hoist(&graph);
        let region = graph.nodes().iter().find(|node| node.op == Op::Region).map(|node| graph.region_of(node).kind);
        assert_eq!(region, Some(Kind::ForEach { turns: 3, row: 1, results: 0 }));
        let found = graph.evaluate(|_, k| k as f64);
        assert_eq!(found, [9.0 * (0.0 + 1.0 + 2.0)]);
    }
}
