//! A function of a module: its arguments, its results and its bodies. Every choice of a target is
//! made here, by its [`Capabilities`], and none while it prints.

use articulated_core::algorithm::{Dim, Shape};
use articulated_core::lanes::Real;

use crate::capabilities::Capabilities;
use crate::function_spec::{FunctionSpec, Output};
use crate::graph::Graph;
use crate::ledger::Entry;
use crate::lir::lower::{Lowering, SinCosGrouping, read_in_place};
use crate::lir::pass::alias_barrier;
use crate::lir::pass::outline::outline;
use crate::lir::pass::pair_stores::pair_stores;
use crate::lir::pass::rows::WIDTH;
use crate::lir::pass::spill::{self, spill};
use crate::lir::{Array, Bodies, Body, Region, Stmt, Turns, Ty};
use crate::program::{MultiRhsSolve, Program};
use crate::{Arithmetic, Precision};

/// An argument of a function.
#[derive(Clone, Debug)]
pub(crate) struct Argument {
    pub(crate) name: &'static str,
    /// Empty for a single number.
    pub(crate) dims: Vec<Dim>,
    /// The same as numbers.
    pub(crate) lengths: Vec<usize>,
    is_parameters: bool,
}

impl Argument {
    /// An array of these dimensions.
    pub(crate) fn new(name: &'static str, dims: &[Dim], shape: Shape) -> Self {
        Self { name, dims: dims.to_vec(), lengths: dims.iter().map(|d| d.len(shape)).collect(), is_parameters: false }
    }

    /// The constants of the model that stayed inputs.
    fn parameters() -> Self {
        Self { name: "parameters", dims: Vec::new(), lengths: Vec::new(), is_parameters: true }
    }

    /// Whether it is the parameters.
    pub(crate) fn is_parameters(&self) -> bool {
        self.is_parameters
    }
}

/// How the result leaves a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ending {
    /// It is made of all its numbers at the end.
    Value,
    /// The same, written to the caller's memory.
    Written,
    /// In rows of four lanes, as soon as they are known, to memory that may be uninitialised.
    Rows,
    /// Number by number as they are computed, overwriting the memory.
    Filled,
}

/// A function.
pub(crate) struct Function<'a> {
    pub(crate) spec: &'a FunctionSpec,
    pub(crate) entry: &'a Entry,
    pub(crate) arguments: Vec<Argument>,
    /// How long each dimension is.
    pub(crate) shape: Shape,
    /// The results, with their names.
    pub(crate) outputs: Vec<Output>,
    /// Their arrays.
    pub(crate) results: Vec<Array>,
    pub(crate) ending: Ending,
    pub(crate) body: Body,
    /// Whether the body is in several pieces.
    pub(crate) is_outlined: bool,
    /// The body with spill slots, for x86-64 without AVX-512.
    pub(crate) few_registers: Option<Body>,
    /// For a function whose values are vectors: the body with plain numbers, and how it returns its
    /// result.
    pub(crate) scalar: Option<(Body, Ending)>,
    /// The solution for many right-hand sides, which is a loop after the body.
    pub(crate) columns: Option<&'a MultiRhsSolve>,
    /// Operations of the body, and its sines and cosines.
    pub(crate) operations: (u64, u64),
    /// The function of many states.
    pub(crate) states: Option<States>,
}

impl Function<'_> {
    /// Whether it takes or returns something for each actuator.
    pub(crate) fn is_of_actuators(&self) -> bool {
        self.has(&[Dim::Controls, Dim::Activations])
    }

    /// Whether it returns something for each place of contact.
    pub(crate) fn is_of_contacts(&self) -> bool {
        self.has(&[Dim::Contacts])
    }

    /// Whether it takes contacts that a caller finds.
    pub(crate) fn is_of_given(&self) -> bool {
        self.has(&[Dim::Given])
    }

    /// Whether an argument or a result has one of these dimensions.
    fn has(&self, some: &[Dim]) -> bool {
        let has = |dims: &[Dim]| dims.iter().any(|dim| some.contains(dim));
        self.arguments.iter().any(|a| has(&a.dims)) || self.outputs.iter().any(|output| has(&output.dims))
    }
}

/// The function of many states.
pub(crate) struct States {
    pub(crate) body: Body,
    /// The body with spill slots, for x86-64 without AVX-512.
    pub(crate) few_registers: Option<Body>,
}

/// A function of states is cut into pieces from this many nodes on.
const CUT_STATES_FROM: usize = 20_000;

/// Statements of a piece.
const LENGTH: usize = 200;

/// From this many nodes on a function is cut: below, one piece is faster to run and as fast to
/// compile.
const CUT_FROM: usize = 4500;

/// The same for plain numbers with a loop over columns: from here on pieces are as fast as one, and
/// for a seven-axis arm faster.
const CUT_BESIDE_COLUMNS_FROM: usize = 2000;

/// The same for sums of two doubles, where each node is some twenty instructions.
const CUT_PAIRS_FROM: usize = 400;

/// From this many results and nodes on, each result is written as soon as it is computed: kept
/// until the end, results would fill the registers. Compilers optimise a small function better if
/// its results are stored together.
const WRITE_FROM: (usize, usize) = (32, 700);

/// From this many angles on it is faster to compute their sines together.
const TOGETHER_FROM: usize = 3;

impl<'a> Function<'a> {
    /// Lowers a program.
    pub(crate) fn of(program: &'a Program, shape: Shape, has_parameters: bool, can: Capabilities) -> Self {
        let Program { spec, graph, entry, .. } = program;
        let mut arguments: Vec<Argument> = spec.arguments().iter().map(|a| Argument::new(a.name(), a.dims(), shape)).collect();
        if has_parameters {
            arguments.push(Argument::parameters());
        }
        let columns = program.columns.as_ref();
        let plan = Plan { graph, spec, shape, can, columns, is_outlined: is_long(graph, columns.is_some(), can.level) };
        let ending = plan.ending();
        let counts = graph.counts();
        Self {
            spec,
            entry,
            arguments,
            shape,
            outputs: spec.outputs(),
            results: results(spec, shape),
            ending,
            body: plan.body(ending, plan.is_outlined, false),
            is_outlined: plan.is_outlined,
            few_registers: plan.few_registers(ending),
            scalar: (can.scalar_too && plan.in_lanes()).then(|| {
                let can = Capabilities { vectors: false, ..can };
                let graph = &program.scalar;
                let plan = Plan { graph, can, is_outlined: is_long(graph, columns.is_some(), can.level), ..plan };
                (plan.body(plan.ending(), plan.is_outlined, false), plan.ending())
            }),
            columns,
            operations: (counts.instructions(), counts.trigonometric()),
            states: can.states.then(|| plan.states(&program.plain)),
        }
    }

    /// Whether the values are vectors.
    pub(crate) fn in_lanes(&self) -> bool {
        matches!(self.body.ty, Ty::Vector(_))
    }

    /// " at most" where a loop may end early, or statements run only where a mask holds; else
    /// empty.
    pub(crate) fn at_most(&self) -> &'static str {
        let is_bound = |region: &Region| matches!(region.turns, Turns::Until { .. } | Turns::Where(_));
        let all = self.body.statements();
        let has_bound = all.into_iter().any(|statement| matches!(statement, Stmt::Region(region) if is_bound(region)));
        if has_bound { " at most" } else { "" }
    }

    /// Its bodies alone.
    pub(crate) fn into_bodies(self) -> Bodies {
        let (states, states_few_registers) = match self.states {
            Some(States { body, few_registers }) => (Some(body), few_registers),
            None => (None, None),
        };
        Bodies {
            single: self.body,
            few_registers: self.few_registers,
            scalar: self.scalar.map(|(body, _)| body),
            states,
            states_few_registers,
            is_followed_by_columns: self.columns.is_some(),
        }
    }
}

/// Time of a sine or cosine, in operations.
const SINE: u64 = 10;

/// To turn two numbers of a result from blocks into states takes as long as a block saves on so
/// many operations (AVX-512, Emerald Rapids).
const TWO_NUMBERS: u64 = 5;

/// A result is dense if more than three fifths of it are computed: then storing it takes the
/// function of one state as long.
const DENSE: (usize, usize) = (3, 5);

impl Function<'_> {
    /// Whether it is faster to call the function of one state for each state in turn. A block saves
    /// time for each operation, but its results must be transposed into states, which costs time
    /// for each number: also for zeros and for the other half of a symmetric matrix, which the
    /// function of one state only stores.
    pub(crate) fn is_faster_one_by_one(&self, level: Precision, real: Real) -> bool {
        let Some(States { body, .. }) = &self.states else { return false };
        let is_straight = self.columns.is_none() && level == Precision::default();
        let is_one_array = matches!(self.results.as_slice(), [array] if !array.lengths.is_empty());
        let has_one = is_straight && is_one_array && self.arguments.iter().all(|a| !a.is_parameters());
        let (operations, sines) = self.operations;
        let numbers = body.results.iter().map(Array::numbers).sum::<usize>();
        let is_sparse = DENSE.1 * body.computed() <= DENSE.0 * numbers;
        has_one && real == Real::F64 && is_sparse && 2 * (operations + SINE * sines) < TWO_NUMBERS * numbers as u64
    }
}

/// The arrays of the result, one for each part.
fn results(spec: &FunctionSpec, shape: Shape) -> Vec<Array> {
    let mut start = 0;
    let mut array = |lengths: Vec<usize>| {
        let array = Array { start, lengths };
        start += array.numbers();
        array
    };
    spec.outputs().iter().map(|output| array(output.dims.iter().map(|d| d.len(shape)).collect())).collect()
}

/// The same, each part as one array of numbers.
fn flat(results: &[Array]) -> Vec<Array> {
    results.iter().map(|array| Array { start: array.start, lengths: vec![array.numbers()] }).collect()
}

/// Whether a function is cut into pieces.
fn is_long(graph: &Graph, columns: bool, level: Precision) -> bool {
    let nodes = graph.nodes().len();
    let from = if columns && graph.lanes().width == 1 { CUT_BESIDE_COLUMNS_FROM } else { CUT_FROM };
    nodes >= from || level.of_two() && nodes >= CUT_PAIRS_FROM
}

/// Inputs of the lowering of a program.
struct Plan<'a> {
    graph: &'a Graph,
    spec: &'a FunctionSpec,
    shape: Shape,
    can: Capabilities,
    columns: Option<&'a MultiRhsSolve>,
    is_outlined: bool,
}

impl Plan<'_> {
    fn in_lanes(&self) -> bool {
        self.graph.lanes().width > 1
    }

    fn ending(&self) -> Ending {
        let (graph, raw_memory) = (self.graph, self.can.raw_memory);
        let (results, nodes) = (graph.outputs.len(), graph.nodes().len());
        match results {
            2.. if graph.lanes().width == WIDTH && raw_memory && nodes < CUT_FROM && self.columns.is_none() => Ending::Rows,
            _ if results >= WRITE_FROM.0 && nodes >= WRITE_FROM.1 || self.columns.is_some() => Ending::Filled,
            2.. if graph.has_turns() => Ending::Filled,
            0 | 1 => Ending::Value,
            _ if !raw_memory || self.is_outlined => Ending::Value,
            _ => Ending::Written,
        }
    }

    /// How long each argument is, for numbers that go in and come out as they are computed with.
    fn lengths(&self) -> Vec<usize> {
        let is_same = matches!(self.can.level.arithmetic, Arithmetic::Double | Arithmetic::Single) && !self.can.level.of_two();
        if is_same { self.spec.arguments().iter().map(|argument| argument.len(self.shape)).collect() } else { Vec::new() }
    }

    fn ty(&self) -> Ty {
        match (self.graph.lanes().width, self.can.level.arithmetic) {
            (1, _) if self.can.level.of_two() => Ty::Pair,
            (1, Arithmetic::Single) => Ty::F32,
            (1, _) => Ty::F64,
            (width, _) => Ty::Vector(width),
        }
    }

    fn sines(&self) -> SinCosGrouping {
        let level = self.can.level;
        match self.graph.lanes().width {
            // Two are those of the standard library.
            1 if level.fused
                && level.sines == crate::TrigAccuracy::Ulp1
                && matches!(level.arithmetic, Arithmetic::Double | Arithmetic::SingleByDouble) =>
            {
                SinCosGrouping { together: 4, are_powers_of_two: false, from: TOGETHER_FROM }
            }
            1 => SinCosGrouping { together: 4, are_powers_of_two: false, from: 0 },
            width => SinCosGrouping { together: 8 / width, are_powers_of_two: true, from: 0 },
        }
    }

    /// The body; `outlined`: in pieces; `spills`: with spill slots.
    fn body(&self, ending: Ending, outlined: bool, spills: bool) -> Body {
        let (graph, ty) = (self.graph, self.ty());
        let mut results = results(self.spec, self.shape);
        let is_matrix = matches!(results.as_slice(), [one] if one.lengths.len() > 1);
        let barrier = is_matrix && (ending == Ending::Filled || outlined) && alias_barrier::pays(graph) && !graph.has_turns();
        // A compiler takes long to check the second index of a matrix.
        if is_matrix && outlined || barrier {
            results = flat(&results);
        }
        let is_read = |at| self.columns.is_none_or(|columns| columns.reads(at));
        // Not stored here: numbers that loops compute, and zeros of a result that is initialised
        // with zeros.
        let is_partial = self.columns.is_some() || outlined && ending != Ending::Filled;
        // Regions read whole arguments and store whole results where inputs are read as needed.
        let lengths = self.lengths();
        let arguments: &[usize] = if ending == Ending::Filled { &lengths } else { &[] };
        let lowering = Lowering { graph, ty, sines: self.sines(), results: &results, first: 0, arguments };
        let stores = || lowering.stores_as_made(|at| ending == Ending::Filled && is_read(at), barrier);
        let mut lanes = graph.lanes().clone();
        let (mut pieces, kept) = match ending {
            _ if outlined => outline(stores(), LENGTH),
            Ending::Filled => outline(stores(), usize::MAX),
            Ending::Rows => {
                let (statements, more) = lowering.stores_in_rows();
                lanes = more;
                (vec![statements], 0)
            }
            Ending::Value | Ending::Written => (vec![lowering.results_at_end()], 0),
        };
        if ending == Ending::Filled && !outlined && ty == Ty::Vector(2) {
            pieces = pieces.into_iter().map(|piece| pair_stores(piece, &results)).collect();
        }
        pieces.iter_mut().for_each(|piece| read_in_place(piece, &[]));
        let mut slots = None;
        if spills && let [piece] = pieces.as_mut_slice() {
            let (statements, found) = spill(std::mem::take(piece), ty);
            (*piece, slots) = (statements, Some(found));
        }
        verified(Body { ty, lanes, results, pieces, kept, slots, barrier, is_partial })
    }

    /// The body with spill slots, if they are read often enough.
    fn few_registers(&self, ending: Ending) -> Option<Body> {
        let nodes = self.graph.nodes().len();
        let fits = (spill::FROM..CUT_FROM).contains(&nodes);
        let can = self.can.spills && !self.can.level.of_two() && self.can.level.fused && !self.graph.has_regions();
        let body = (fits && can).then(|| self.body(ending, false, true))?;
        spill::pays(&body.pieces[0], matches!(body.ty, Ty::Vector(_))).then_some(body)
    }

    /// The function of many states, of this graph.
    fn states(&self, graph: &Graph) -> States {
        let results = flat(&results(self.spec, self.shape));
        let nodes = graph.nodes().len();
        let length = if nodes < CUT_STATES_FROM { usize::MAX } else { LENGTH };
        let sines = SinCosGrouping { together: 1, are_powers_of_two: true, from: 0 };
        let statements = Lowering { graph, ty: Ty::States, sines, results: &results, first: 0, arguments: &self.lengths() };
        let statements = statements.stores_as_made(|_| true, false);
        let (mut pieces, kept) = outline(statements, length);
        pieces.iter_mut().for_each(|piece| read_in_place(piece, &[]));
        let body = |pieces: Vec<Vec<Stmt>>, slots| {
            let (lanes, results) = (graph.lanes().clone(), results.clone());
            verified(Body { ty: Ty::States, lanes, results, pieces, kept, slots, barrier: false, is_partial: false })
        };
        let spilled = match pieces.as_slice() {
            [piece] if self.can.spills && nodes >= spill::FROM && !graph.has_regions() => Some(spill(piece.clone(), Ty::States)),
            _ => None,
        };
        let few_registers = spilled.filter(|(piece, _)| spill::pays(piece, true)).map(|(piece, slots)| body(vec![piece], Some(slots)));
        States { body: body(pieces, None), few_registers }
    }
}

/// The body, which debug builds verify.
fn verified(body: Body) -> Body {
    if cfg!(debug_assertions)
        && let Err(what) = crate::lir::verify(&body)
    {
        panic!("{what}");
    }
    body
}

#[cfg(test)]
mod tests;
