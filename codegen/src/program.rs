//! One function, from its algorithms to the graph that is emitted.

use std::iter::once;

use articulated_core::algorithm::Way;
use articulated_core::model::pass::model_passes;
use articulated_core::model::{Model, Unturned};

use crate::Options;
use crate::bound::{bounds, in_box};
use crate::graph::{Counts, Graph, Op};
use crate::groups::{self, Groups};
use crate::ledger::{Entry, depth};
use crate::limbs::Alike;
use crate::parameters::Parameter;
use crate::pass::{self, GRAPH_PASSES};
use crate::sym::Sym;
use crate::trace::{Choice, applies, trace, trace_in_lanes, units, unturnable, ways};
use crate::wanted::{Part, Wanted};

/// A function and what it became.
pub(crate) struct Program {
    pub(crate) wanted: Wanted,
    pub(crate) graph: Graph,
    /// The graph with each limb for itself: what a batch runs, a state a lane.
    pub(crate) plain: Graph,
    pub(crate) entry: Entry,
    /// What is left a loop. Then `graph` is what comes before.
    pub(crate) columns: Option<Columns>,
    /// Where joints stand if all of it is left loops over them. Then `graph` is empty.
    pub(crate) groups: Option<Groups>,
}

/// The solution of M X = B column by column, which is the same for each.
pub(crate) struct Columns {
    /// For each row of L, where it has numbers before the diagonal.
    pub(crate) ways: Vec<Vec<usize>>,
}

/// What a function is traced on.
struct Subject<'a> {
    model: &'a Model<f64>,
    parameters: &'a [Parameter],
    /// Whether to trace after each model pass, for the ledger.
    stages: bool,
    /// Limbs to lay on one another.
    alike: Option<Alike>,
}

/// A function by the cheapest of its ways, limbs that are alike in lanes if that is cheaper.
pub(crate) fn program(wanted: Wanted, model: &Model<f64>, parameters: &[Parameter], options: &Options) -> Program {
    let subject = Subject { model, parameters, stages: options.stages, alike: None };
    let columns = columns(&wanted, model, options);
    let whole = (columns.is_none() || !options.batch.is_empty()).then(|| made(&wanted, &subject, None));
    let unsolved = columns.as_ref().and(wanted.parts[0].function.unsolved.as_ref());
    let mut best = match &whole {
        Some(whole) if unsolved.is_none() => whole.clone(),
        _ => made(&wanted, &subject, unsolved),
    };
    let plain = whole.map_or_else(Graph::default, |(graph, _)| graph);
    // Limbs need the vector instructions; constants that stay inputs differ from limb to limb.
    if options.limbs && options.level.has_lanes() && !options.forbid_unsafe && parameters.is_empty() {
        for width in [4, 2] {
            let Some(alike) = Alike::of(model, width) else { continue };
            let other = made(&wanted, &Subject { alike: Some(alike), ..subject }, unsolved);
            if price(&other.0) * WORTH < price(&best.0) {
                best = other;
            }
        }
    }
    let (mut graph, mut entry) = best;
    let groups = groups(&wanted, price(&graph), &subject, options);
    if let Some((_, counts)) = &groups {
        graph = Graph::default();
        in_loops(&mut entry, counts);
    } else if let Some(columns) = &columns {
        columns.count(&mut entry);
    } else if options.stages {
        entry.bounds = in_the_box(&wanted, &graph, model, parameters, options);
    }
    Program { wanted, graph, plain, entry, columns, groups: groups.map(|(groups, _)| groups) }
}

/// The entry of what is left loops, which cost this.
fn in_loops(entry: &mut Entry, counts: &Counts) {
    (entry.ways, entry.lanes) = (vec!["joints in loops".into()], groups::LANES);
    entry.stages.push(("loops", counts.clone()));
}

/// What is fewer instructions than this is never left loops over joints: it is fetched as fast as it is executed, and does nothing that is not asked for.
const WRITTEN_OUT: f64 = 3500.0;

/// An instruction in loops takes this part of the time of one that is written out, or less.
const LOOPED: f64 = 0.95;

/// Where joints stand, if a function that would be so many instructions is fewer as loops over them: these need vectors, and constants that are known.
fn groups(wanted: &Wanted, written: f64, subject: &Subject, options: &Options) -> Option<(Groups, Counts)> {
    let meant = written > WRITTEN_OUT && wanted.as_function().is_some_and(|f| f.name == "inverse_dynamics_derivatives");
    let can = options.limbs && options.level.has_lanes() && !options.forbid_unsafe && subject.parameters.is_empty();
    let groups = (meant && can).then(|| Groups::of(subject.model)).flatten()?;
    let counts = groups.counts(subject.model);
    (counts.instructions() as f64 * LOOPED < written).then_some((groups, counts))
}

/// From so many degrees of freedom on, and up to so many, the solution column by column is a loop: with six the whole function takes a quarter longer than written out, with seven
/// a twentieth to a fifth less, with eight and nine a seventh to a fifth less; with 18 and 36 it has a third of the code and of the time to compile it.
const COLUMNS: std::ops::RangeInclusive<usize> = 7..=60;

/// What of a function is left a loop, if that is faster: it needs vectors.
fn columns(wanted: &Wanted, model: &Model<f64>, options: &Options) -> Option<Columns> {
    let [part] = wanted.parts.as_slice() else { return None };
    let unsolved = part.function.unsolved.as_ref()?;
    let applies = COLUMNS.contains(&model.nv) && options.level.has_lanes() && !options.forbid_unsafe && applies(unsolved, model);
    applies.then(|| Columns { ways: model.ways_to_base() })
}

impl Columns {
    /// Whether the loop reads number `k` of the three matrices: both B, and of the factors what is on the diagonal or on a way.
    pub(crate) fn reads(&self, k: usize) -> bool {
        let n = self.ways.len();
        let (matrix, row, column) = (k / n / n, k / n % n, k % n);
        matrix < 2 || row == column || self.ways[row].contains(&column)
    }

    /// Adds what the loop computes, in vectors of four columns, to every stage.
    fn count(&self, entry: &mut Entry) {
        let (n, entries) = (self.ways.len() as u64, self.ways.iter().map(|way| way.len() as u64).sum::<u64>());
        let vectors = 3 * n.div_ceil(4);
        for (_, counts) in &mut entry.stages {
            counts.add(Op::NegMulAdd, 2 * entries * vectors);
            counts.add(Op::Mul, n * vectors);
        }
        entry.ways = vec!["columns in a loop".into()];
    }
}

/// Guaranteed bounds of the results, for the ledger.
fn in_the_box(wanted: &Wanted, graph: &Graph, model: &Model<f64>, parameters: &[Parameter], options: &Options) -> Vec<f64> {
    let arguments = wanted.arguments();
    let nominal: Vec<f64> = parameters.iter().flat_map(|p| &p.nominal).copied().collect();
    let input = |argument: usize, k: usize| match arguments.get(argument) {
        Some(a) => in_box(model, *a, k),
        None => (nominal[k], 0.0),
    };
    bounds(graph, options.level, &input).unwrap_or_default()
}

/// Lanes cost what no count shows (values that come and go one by one): they must be cheaper by this.
const WORTH: f64 = 1.15;

/// Functions whose statements go column by column, not as they are traced.
const COLUMN_BY_COLUMN: [&str; 2] = ["mass_matrix", "mass_matrix_inverse"];

/// The graph of a function, traced on the model as it was read and after each model pass, and taken through the graph passes.
fn made(wanted: &Wanted, subject: &Subject, unsolved: Option<&'static Way<Sym>>) -> (Graph, Entry) {
    let all = model_passes::<Sym>().len();
    let choose = |part| unsolved.map_or_else(|| cheapest(part, subject, all), |way| Choice::plain(way, all));
    let choices = by_axes(wanted, wanted.parts.iter().map(choose).collect(), subject);
    let choices = in_the_best_unit(wanted, choices, subject);
    let mut graph = Graph::default();
    let mut stages: Vec<(&'static str, Counts)> = Vec::new();
    for passes in if subject.stages { 0 } else { all }..=all {
        let limited: Vec<Choice> = choices.iter().map(|c| Choice::plain(c.way, c.passes.min(passes))).collect();
        graph = subject.trace(wanted, &limited);
        if stages.is_empty() {
            stages.push(("asked", graph.asked().clone()));
        }
        stages.push((if passes == 0 { "trace" } else { model_passes::<Sym>()[passes - 1].0 }, graph.counts()));
    }
    if choices.iter().any(|c| c.lent) {
        graph =
            subject.trace(wanted, &choices.iter().map(|c| Choice { unit: None, unturned: None, axes: false, ..*c }).collect::<Vec<_>>());
        stages.push(("lent", graph.counts()));
    }
    if choices.iter().any(|c| c.axes) {
        graph = subject.trace(wanted, &choices.iter().map(|c| Choice { unit: None, unturned: None, ..*c }).collect::<Vec<_>>());
        stages.push(("axes", graph.counts()));
    }
    if choices.iter().any(|c| c.unturned.is_some()) {
        graph = subject.trace(wanted, &choices.iter().map(|c| Choice { unit: None, ..*c }).collect::<Vec<_>>());
        stages.push(("unturned", graph.counts()));
    }
    if choices.iter().any(|c| c.unit.is_some()) {
        graph = subject.trace(wanted, &choices);
        stages.push(("unit", graph.counts()));
    }
    for (name, pass, _) in GRAPH_PASSES {
        graph = pass::run(name, *pass, &graph);
        stages.push((name, graph.counts()));
    }
    if wanted.parts.iter().all(|part| COLUMN_BY_COLUMN.contains(&part.function.name)) {
        graph = pass::run("from the last", pass::from_the_last, &graph);
    }
    let ways = choices.iter().flat_map(Choice::names).collect();
    let entry = Entry { function: wanted.name.clone(), ways, stages, depth: depth(&graph), lanes: graph.lanes().width, bounds: Vec::new() };
    (graph, entry)
}

impl Subject<'_> {
    fn trace(&self, wanted: &Wanted, choices: &[Choice]) -> Graph {
        match &self.alike {
            None => trace(wanted, choices, self.model, self.parameters),
            Some(alike) => trace_in_lanes(wanted, choices, self.model, alike),
        }
    }

    /// What is traced, after all graph passes.
    fn finished(&self, wanted: &Wanted, choices: &[Choice]) -> Graph {
        GRAPH_PASSES.iter().fold(self.trace(wanted, choices), |graph, (_, pass, _)| pass(&graph))
    }

    /// What choices cost, in instructions, and with each multiplication counted twice: cores have fewer multipliers than they have places for instructions.
    fn price(&self, wanted: &Wanted, choices: &[Choice]) -> (u32, u64) {
        let graph = self.finished(wanted, choices);
        let cost = pass::cost(&graph);
        (cost, u64::from(cost) + graph.counts().multiplications())
    }
}

/// What costs more than this is not tried with frames that do not turn or mass that is lent: it would gain a hundredth, and takes long to trace.
const UNTURNED_TO: u32 = 2500;

/// Nor is any function of a robot with more bodies than this, nor with another unit of length: to find out what it costs is to trace it twice.
const UNTURNED_BODIES: usize = 64;

/// Functions with an inverse dynamics in them in which bodies turn: of these mass that is lent takes numbers away.
const WITH_INVERSE_DYNAMICS: [&str; 5] =
    ["inverse_dynamics", "inverse_dynamics_with_wrenches", "bias_forces", "forward_dynamics", "forward_dynamics_with_wrenches"];

/// The way that costs least once the graph passes are done. With parameters, model passes may cost more than they save: then they are not taken.
fn cheapest(part: &Part, subject: &Subject, all: usize) -> Choice {
    let few = if subject.parameters.is_empty() { all..=all } else { 0..=all };
    let ways = ways(part, subject.model);
    let tried = subject.parameters.is_empty() && subject.model.bodies.len() <= UNTURNED_BODIES;
    let unturned = if tried { unturnable(part, subject.model) } else { Vec::new() };
    let unturned: Vec<Option<Unturned>> = once(None).chain(unturned.into_iter().map(Some)).collect();
    let lending: &[bool] = if tried && WITH_INVERSE_DYNAMICS.contains(&part.function.name) { &[false, true] } else { &[false] };
    let forms = || unturned.iter().flat_map(|&unturned| lending.iter().map(move |&lent| (unturned, lent)));
    let of = |way, passes| forms().map(move |(unturned, lent)| Choice { unturned, lent, ..Choice::plain(way, passes) });
    let candidates: Vec<(Choice, u64)> =
        ways.iter().flat_map(|(way, least)| few.clone().flat_map(move |passes| of(*way, passes)).map(|c| (c, *least))).collect();
    if let [(one, _)] = candidates.as_slice() {
        return *one;
    }
    let alone = Wanted { name: String::new(), parts: vec![part.clone()] };
    let mut best: Option<(Choice, u32)> = None;
    for (choice, least) in candidates {
        // A way whose least is more than another's cost is not tried: the factorisation of a long chain grows with the cube of its length.
        if best.is_some_and(|(_, cost)| least > u64::from(cost) || (choice.unturned.is_some() || choice.lent) && cost > UNTURNED_TO) {
            continue;
        }
        let cost = cost(&alone, choice, subject);
        if best.is_none_or(|(_, other)| cost < other) {
            best = Some((choice, cost));
        }
    }
    best.map_or(Choice::plain(&part.function.ways[0], all), |(choice, _)| choice)
}

fn cost(wanted: &Wanted, choice: Choice, subject: &Subject) -> u32 {
    pass::cost(&subject.finished(wanted, &[choice]))
}

/// Functions in which bodies turn while they move: the rates of that by the axes of joints may take less than by ω̇.
const TURNING: [&str; 10] = [
    "inverse_dynamics",
    "inverse_dynamics_with_wrenches",
    "joint_wrenches",
    "bias_forces",
    "forward_dynamics",
    "forward_dynamics_with_wrenches",
    "forward_dynamics_derivatives",
    "forward_dynamics_derivatives_with_wrenches",
    "center_of_mass_acceleration",
    "centroidal_momentum_rate",
];

/// The choices with rates by axes, if that takes fewer multiplications and no more instructions; of robots with many bodies, which take long to trace, without trying.
fn by_axes(wanted: &Wanted, choices: Vec<Choice>, subject: &Subject) -> Vec<Choice> {
    let turns = |part: &Part| TURNING.contains(&part.function.name);
    if !wanted.parts.iter().any(turns) {
        return choices;
    }
    let with: Vec<Choice> = wanted.parts.iter().zip(&choices).map(|(part, choice)| Choice { axes: turns(part), ..*choice }).collect();
    let better = || {
        let ((cost, price), (other_cost, other_price)) = (subject.price(wanted, &with), subject.price(wanted, &choices));
        cost <= other_cost && price < other_price
    };
    if subject.model.bodies.len() > UNTURNED_BODIES || better() { with } else { choices }
}

/// So many instructions are traced at most to find the best unit of length: of a long function fewer are tried.
const TRIED: usize = 20_000;

/// The choices with lengths in the unit that costs least: where a constant is one, what it multiplies is only added.
fn in_the_best_unit(wanted: &Wanted, choices: Vec<Choice>, subject: &Subject) -> Vec<Choice> {
    if !subject.parameters.is_empty() || subject.model.bodies.len() > UNTURNED_BODIES {
        return choices;
    }
    let units: Vec<Vec<f64>> = wanted.parts.iter().zip(&choices).map(|(part, choice)| units(part, choice, subject.model)).collect();
    let with = |metres: f64| -> Vec<Choice> {
        let one = |(choice, units): (&Choice, &Vec<f64>)| Choice { unit: units.contains(&metres).then_some(metres), ..*choice };
        choices.iter().zip(&units).map(one).collect()
    };
    let Some(most) = units.iter().max_by_key(|units| units.len()).filter(|units| !units.is_empty()) else { return choices };
    let (cost, mut least) = subject.price(wanted, &choices);
    if cost > UNTURNED_TO {
        return choices;
    }
    let mut best = choices.clone();
    for other in most.iter().take(TRIED / (cost as usize).max(1)).map(|&metres| with(metres)) {
        let (_, price) = subject.price(wanted, &other);
        if price < least {
            (least, best) = (price, other);
        }
    }
    best
}

/// Instructions of sines and cosines of as many angles as there are lanes.
const SINES: f64 = 28.0;

/// What a program costs, in instructions, plain or in lanes: sines go four angles at a time, or the angles of all lanes; inputs of lanes come one by one.
fn price(graph: &Graph) -> f64 {
    let counts = graph.counts();
    let rows = f64::from(pass::cost(graph)) - 10.0 * counts.trigonometric() as f64;
    let mut angles: Vec<u32> = graph.nodes().iter().filter(|n| matches!(n.op, Op::Sin | Op::Cos)).map(|n| n.args[0]).collect();
    angles.sort_unstable();
    angles.dedup();
    let width = graph.lanes().width;
    let calls = (angles.len() * width).div_ceil(4);
    rows + SINES * calls as f64 + (counts.of(Op::LaneInput) as usize * width) as f64
}
