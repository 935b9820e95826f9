//! A graph as statements.

mod in_place;
mod regions;
mod tables;

use std::collections::{BTreeMap, HashMap, HashSet};

use crate::graph::{Graph, Lanes, Node, NodeId, Op};
use crate::lir::order::{Step, order};
use crate::lir::pass::rows::{Cell, Column, Group, WIDTH, groups};
use crate::lir::pass::zeros::zeros;
use crate::lir::{Angle, Array, Expr, Number, Operand, Rows, Stmt, Store, Temp, Ty};

pub(crate) use in_place::read_in_place;

/// How sines are computed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SinCosGrouping {
    /// Largest number of angles computed together.
    pub(crate) together: usize,
    /// Whether there are functions of one, two and four angles only, and not one of up to
    /// `together`.
    pub(crate) are_powers_of_two: bool,
    /// From this many angles on they are computed together.
    pub(crate) from: usize,
}

/// Writes a graph as statements of one type.
pub(crate) struct Lowering<'a> {
    pub(crate) graph: &'a Graph,
    pub(crate) ty: Ty,
    pub(crate) sines: SinCosGrouping,
    /// The arrays of the result.
    pub(crate) results: &'a [Array],
    /// The number of the first value: those of bodies of regions follow those around them.
    pub(crate) first: usize,
    /// How long each argument is, where results are stored as they are made: regions then read
    /// whole arguments and store whole results. Empty elsewhere.
    pub(crate) arguments: &'a [usize],
}

impl Lowering<'_> {
    /// All definitions, then the result.
    pub(crate) fn results_at_end(&self) -> Vec<Stmt> {
        let mut statements: Vec<Stmt> = self.definitions().into_iter().flatten().collect();
        statements.extend(self.graph.outputs.iter().enumerate().map(|(at, output)| Stmt::Result(at, self.number(*output))));
        statements
    }

    /// Each number of the result is stored as soon as it is known; zeros between the definitions,
    /// as far as they are `read`. Of states all numbers are stored with their definitions.
    pub(crate) fn stores_as_made(&self, is_read: impl Fn(usize) -> bool, barrier: bool) -> Vec<Stmt> {
        let definitions = self.definitions();
        let mut by_regions: HashSet<usize> = HashSet::new();
        for statement in definitions.iter().flatten() {
            if let Stmt::Region(region) = statement {
                by_regions.extend(region.stores());
            }
        }
        let mut defined: HashMap<Temp, usize> = HashMap::new();
        for (unit, statements) in definitions.iter().enumerate() {
            statements.iter().filter(|s| !is_light(s)).for_each(|s| s.defines(|temp| _ = defined.insert(temp, unit)));
        }
        let mut first = Vec::new();
        let mut behind: Vec<Vec<(Temp, Stmt)>> = vec![Vec::new(); definitions.len()];
        for (at, output) in self.graph.outputs.iter().enumerate() {
            let number = self.number(*output);
            if number.is_zero() && self.ty != Ty::States || by_regions.contains(&at) {
                continue;
            }
            let store = Stmt::Store(Store::One(at, number));
            // A lane that has a name is stored behind it.
            let named = self.temp(output.index());
            match [Some(named), number.of.temp()].into_iter().flatten().find_map(|temp| Some((temp, *defined.get(&temp)?))) {
                Some((temp, unit)) => behind[unit].push((temp, store)),
                None => first.push(store),
            }
        }
        let zeros = if self.ty == Ty::States { Vec::new() } else { zeros(self.results, |at| is_read(at) && self.is_zero(at), barrier) };
        let heavy = definitions.iter().filter(|statements| statements.iter().any(|s| !is_light(s))).count();
        let mut out = if heavy == 0 { zeros.clone() } else { Vec::new() };
        out.append(&mut first);
        let mut passed = 0;
        for (statements, mut stores) in definitions.into_iter().zip(behind) {
            let is_heavy = statements.iter().any(|s| !is_light(s));
            let order: HashMap<Temp, usize> = defined_in(&statements).into_iter().enumerate().map(|(k, temp)| (temp, k)).collect();
            out.extend(statements);
            stores.sort_by_key(|(temp, _)| order[temp]);
            out.extend(stores.into_iter().map(|(_, store)| store));
            if is_heavy {
                let until = |passed: usize| passed * zeros.len() / heavy;
                out.extend_from_slice(&zeros[until(passed)..until(passed + 1)]);
                passed += 1;
            }
        }
        out
    }

    /// Stores of neighbouring numbers of the result: constants first, half of them before the sines
    /// and half between and after them, so that the stores fill the time in which nothing else can
    /// run; then each group as soon as its last number is known. For vectors of four lanes. Also
    /// returns the lane constants, which may be more than those of the graph.
    pub(crate) fn stores_in_rows(&self) -> (Vec<Stmt>, Lanes) {
        let cells: Vec<Cell> = self.graph.outputs.iter().map(|&output| Cell::of(self.graph, output)).collect();
        let all = self.results.iter().flat_map(|array| {
            let own = groups(&cells[array.start..array.start + array.numbers()]);
            own.into_iter().map(move |group| (array.start, group))
        });
        let mut writer = RowWriter::new(self);
        writer.place(all.collect());
        let lanes = std::mem::take(&mut writer.lanes);
        (writer.statements(), lanes)
    }

    /// The definitions of all values that have a name: of each node, and of sines of several
    /// angles.
    fn definitions(&self) -> Vec<Vec<Stmt>> {
        let inner = inner(self.graph);
        let mut units = Vec::with_capacity(self.graph.nodes().len());
        for step in order(self.graph) {
            match step {
                Step::Node(k) if inner[k] => units.extend(self.definition(k).map(|statement| vec![statement])),
                Step::Node(_) => {}
                Step::Batch(angles) => {
                    let angles: Vec<Angle> = in_order(&angles, self.graph)
                        .iter()
                        .map(|a| Angle { angle: self.operand(a.angle), sin: a.sin.map(|k| self.temp(k)), cos: a.cos.map(|k| self.temp(k)) })
                        .collect();
                    let alone = angles.len() < self.sines.from;
                    for some in angles.chunks(self.sines.together) {
                        units.push(self.sines_of(some, alone));
                    }
                }
            }
        }
        units
    }

    fn sines_of(&self, angles: &[Angle], alone: bool) -> Vec<Stmt> {
        let mut statements = Vec::new();
        let mut rest = angles;
        while !rest.is_empty() {
            let count = match rest.len() {
                _ if alone => 1,
                n if !self.sines.are_powers_of_two => n,
                n @ 1..=3 => n.min(2),
                _ => 4,
            };
            let (now, others) = rest.split_at(count);
            statements.push(Stmt::SinCos { angles: now.to_vec(), alone });
            rest = others;
        }
        statements
    }

    fn definition(&self, k: usize) -> Option<Stmt> {
        let node = &self.graph.nodes()[k];
        let expression = match node.op {
            // The region defines its values.
            Op::Constant | Op::List | Op::RegionValue => return None,
            Op::Region => return Some(Stmt::Region(Box::new(self.region(k)))),
            Op::LaneConstant if matches!(self.ty, Ty::Vector(_)) => return None,
            Op::Input => Expr::Input { argument: node.args[0], index: node.args[1] },
            Op::LaneInput => Expr::LaneInput { argument: node.args[0], indices: node.args[1] },
            Op::Broadcast => Expr::Broadcast(self.lane(node)),
            op => {
                let mut operands = [Operand::Constant(0.0); 3];
                operands.iter_mut().zip(node.operands()).for_each(|(slot, id)| *slot = self.operand(id));
                Expr::Op(op, operands)
            }
        };
        Some(Stmt::Let(self.temp(k), expression))
    }

    fn temp(&self, node: usize) -> Temp {
        Temp::of(self.first + node)
    }

    fn operand(&self, id: NodeId) -> Operand {
        let node = self.graph.node(id);
        match (node.op, node.constant()) {
            (_, Some(x)) => Operand::Constant(x),
            (Op::LaneConstant, _) => Operand::Lanes(node.args[0]),
            _ => Operand::Temp(self.temp(id.index())),
        }
    }

    /// The lane that a node spreads.
    fn lane(&self, broadcast: &Node) -> Number {
        let lane = self.graph.node(NodeId(broadcast.args[1])).constant().unwrap_or_default() as usize;
        Number { of: self.operand(NodeId(broadcast.args[0])), lane }
    }

    fn number(&self, id: NodeId) -> Number {
        let node = self.graph.node(id);
        if node.op == Op::Broadcast && self.ty != Ty::States { self.lane(&node) } else { Number { of: self.operand(id), lane: 0 } }
    }

    fn is_zero(&self, at: usize) -> bool {
        self.number(self.graph.outputs[at]).is_zero()
    }
}

/// Whether a statement is repeated wherever its value is needed: inputs, and comparisons, whose
/// values are not numbers.
pub(crate) fn is_light(statement: &Stmt) -> bool {
    statement.compares() || matches!(statement, Stmt::Let(_, Expr::Input { .. } | Expr::LaneInput { .. }))
}

fn defined_in(statements: &[Stmt]) -> Vec<Temp> {
    let mut all = Vec::new();
    statements.iter().for_each(|s| s.defines(|temp| all.push(temp)));
    all
}

/// Angles that are known at once, in the order of memory, so that neighbours are one load; or
/// backwards if more are needed in that order, since the last lane is known last. Computed angles
/// come after them, as they are needed.
fn in_order(needed: &[super::order::Angle], graph: &Graph) -> Vec<super::order::Angle> {
    let place = |angle: &super::order::Angle| {
        let node = graph.node(angle.angle);
        if node.op == Op::Input { (0, node.args[0], node.args[1]) } else { (1, 0, 0) }
    };
    let mut angles = needed.to_vec();
    angles.sort_by_key(place);
    let pairs = || needed.iter().enumerate().flat_map(|(k, one)| needed[k + 1..].iter().map(move |other| place(one) > place(other)));
    if pairs().filter(|backward| *backward).count() * 2 > pairs().count() {
        angles.reverse();
    }
    angles
}

/// The nodes that need a name: those that others use. A lane of a vector that is a result does not.
fn inner(graph: &Graph) -> Vec<bool> {
    let mut inner = vec![false; graph.nodes().len()];
    graph.nodes().iter().flat_map(Node::operands).for_each(|o| inner[o.index()] = true);
    for o in &graph.outputs {
        inner[o.index()] |= graph.node(*o).op != Op::Broadcast;
    }
    inner
}

/// Statements with stores of rows between them.
struct RowWriter<'a, 'b> {
    lowering: &'a Lowering<'b>,
    lanes: Lanes,
    units: Vec<Vec<Stmt>>,
    /// The unit that defines a value.
    defined: HashMap<Temp, usize>,
    sums: Sums,
    /// The stores after each unit, and before the first.
    behind: Vec<Vec<Stmt>>,
    first: Vec<Stmt>,
}

impl<'a, 'b> RowWriter<'a, 'b> {
    fn new(lowering: &'a Lowering<'b>) -> Self {
        let (units, sums) = (lowering.definitions(), Sums::of(lowering.graph));
        let mut defined: HashMap<Temp, usize> = HashMap::new();
        for (unit, statements) in units.iter().enumerate() {
            defined_in(statements).into_iter().for_each(|temp| _ = defined.insert(temp, unit));
        }
        let alone = defined.clone();
        for (temp, unit) in &mut defined {
            *unit = sums.set(temp.index()).iter().map(|&other| alone[&Temp::of(other)]).max().unwrap_or(*unit);
        }
        let lanes = lowering.graph.lanes().clone();
        Self { lowering, lanes, behind: vec![Vec::new(); units.len()], units, defined, sums, first: Vec::new() }
    }

    fn place(&mut self, groups: Vec<(usize, Group)>) {
        let sines: Vec<usize> = (0..self.units.len()).filter(|&u| self.units[u].iter().any(|s| matches!(s, Stmt::SinCos { .. }))).collect();
        let (constant, others): (Vec<_>, Vec<_>) = groups.into_iter().partition(|(_, group)| group.nodes().is_empty());
        let before = constant.len() / 2;
        for (n, (start, group)) in constant.iter().enumerate() {
            let behind = n.checked_sub(before).and_then(|n| sines.get(n * sines.len() / (constant.len() - before)));
            self.store(behind.copied(), *start, group);
        }
        for (start, group) in others {
            let ready = group.nodes().iter().filter_map(|&k| self.defined.get(&Temp::of(k))).max().copied();
            self.store(ready, start, &group);
        }
    }

    /// Stores a group after a unit, or before all.
    fn store(&mut self, behind: Option<usize>, start: usize, group: &Group) {
        let store = Stmt::Store(self.stored(start, group));
        behind.map_or(&mut self.first, |unit| &mut self.behind[unit]).push(store);
    }

    fn stored(&mut self, start: usize, group: &Group) -> Store {
        let mut rows = |rows: Rows, columns: &[Column]| Store::Rows(rows, columns.iter().map(|c| self.column(c)).collect());
        match group {
            Group::Whole(node, at) => Store::Whole(start + at, Operand::Temp(Temp::of(*node))),
            Group::InTurn(columns, at) => rows(Rows::InTurn(start + at), columns),
            Group::Fours(columns, at) => rows(Rows::Fours(at.map(|k| start + k)), columns),
            Group::Twos(columns, at) => rows(Rows::Twos(at.map(|k| start + k)), columns),
            Group::Pair([a, b], at) => Store::Two(start + at, [self.cell(*a), self.cell(*b)]),
            Group::One(cell, at) => Store::One(start + at, self.cell(*cell)),
            Group::Constant(x, at, 1) => Store::One(start + at, Number { of: Operand::Constant(*x), lane: 0 }),
            Group::Constant(x, at, n) => Store::Fill(start + at, *n, *x),
        }
    }

    fn cell(&self, cell: Cell) -> Number {
        match cell {
            Cell::Constant(x) => Number { of: Operand::Constant(x), lane: 0 },
            Cell::Lane(node, 0) => {
                let (temp, lane) = self.sums.place(node);
                Number { of: Operand::Temp(temp), lane }
            }
            Cell::Lane(node, lane) => Number { of: Operand::Temp(Temp::of(node)), lane },
        }
    }

    fn column(&mut self, column: &Column) -> Operand {
        match column {
            Column::Node(node) => Operand::Temp(Temp::of(*node)),
            Column::Constants(x) if x.iter().all(|y| *y == x[0]) => Operand::Constant(x[0]),
            Column::Constants(x) => Operand::Lanes(self.lanes.add_constant(*x)),
        }
    }

    fn statements(self) -> Vec<Stmt> {
        let mut thirds = thirds(self.lowering.graph);
        let mut out = self.first;
        for (unit, (statements, stores)) in self.units.into_iter().zip(self.behind).enumerate() {
            for statement in statements {
                let Stmt::Let(dst, expression) = &statement else {
                    out.push(statement);
                    continue;
                };
                let set = self.sums.set(dst.index());
                if !set.is_empty() {
                    // Where the last of the sums that are made together would be.
                    if self.defined[dst] == unit {
                        out.push(
                            self.sums.statement(dst.index(), |sum| self.lowering.operand(NodeId(self.lowering.graph.nodes()[sum].args[0]))),
                        );
                    }
                } else if let Some(three) = thirds.iter_mut().find(|three| three.dst.contains(dst)) {
                    if !std::mem::replace(&mut three.is_written, true) {
                        out.push(Stmt::Thirds { dst: three.dst, argument: three.argument, first: three.first });
                    }
                } else {
                    out.push(Stmt::Let(*dst, expression.clone()));
                }
            }
            out.extend(stores);
        }
        out
    }
}

/// Three vectors of inputs that are read together: the first, second and third numbers of each
/// lane, where the lanes lie one after the other.
struct Three {
    dst: [Temp; 3],
    argument: u32,
    first: u32,
    is_written: bool,
}

fn thirds(graph: &Graph) -> Vec<Three> {
    let lanes = graph.lanes();
    let mut inputs: BTreeMap<(u32, &[u32]), usize> = BTreeMap::new();
    for (k, node) in graph.nodes().iter().enumerate().filter(|(_, node)| node.op == Op::LaneInput) {
        inputs.insert((node.args[0], lanes.input(node.args[1])), k);
    }
    let three = |(&(argument, numbers), &k): (&(u32, &[u32]), &usize)| {
        let [a, b, c, d] = *numbers else { return None };
        let next = |n: u32| inputs.get(&(argument, &[a + n, b + n, c + n, d + n][..])).copied();
        let nodes = (b == a + 3 && c == b + 3 && d == c + 3).then_some([k, next(1)?, next(2)?])?;
        Some(Three { dst: nodes.map(Temp::of), argument, first: a, is_written: false })
    };
    inputs.iter().filter_map(three).collect()
}

/// Sums over the lanes of several vectors that are only results. Up to four are added up together,
/// which takes half as many instructions as one after the other.
struct Sums {
    sets: Vec<Vec<usize>>,
    /// The set of a node, and its lane there.
    places: HashMap<usize, (usize, usize)>,
    /// The number of the first value that holds a set.
    first: usize,
}

impl Sums {
    /// In the order of results, so that those of a set lie side by side. A sum that is left over is
    /// made alone.
    fn of(graph: &Graph) -> Self {
        let mut used = vec![false; graph.nodes().len()];
        graph.nodes().iter().flat_map(|node| node.operands()).for_each(|o| used[o.index()] = true);
        let mut sums: Vec<usize> = Vec::new();
        for k in graph.outputs.iter().map(|o| o.index()) {
            if graph.nodes()[k].op == Op::ReduceAdd && !used[k] && !sums.contains(&k) {
                sums.push(k);
            }
        }
        let sets: Vec<Vec<usize>> = sums.chunks(WIDTH).filter(|set| set.len() > 1).map(<[usize]>::to_vec).collect();
        let places = sets.iter().enumerate().flat_map(|(s, set)| set.iter().enumerate().map(move |(lane, &k)| (k, (s, lane))));
        Self { places: places.collect(), sets, first: graph.nodes().len() }
    }

    /// The nodes computed together with a node, including itself; empty if it is computed alone.
    fn set(&self, node: usize) -> &[usize] {
        self.places.get(&node).map_or(&[], |(set, _)| &self.sets[*set])
    }

    /// The value that holds a sum, and its lane there. A sum that is made alone has its own, and
    /// lane 0.
    fn place(&self, node: usize) -> (Temp, usize) {
        self.places.get(&node).map_or_else(|| (Temp::of(node), 0), |(set, lane)| (Temp::of(self.first + set), *lane))
    }

    /// The statement that computes the set of a node, given the summed vector of each.
    fn statement(&self, node: usize, of: impl Fn(usize) -> Operand) -> Stmt {
        Stmt::SumLanes(self.place(node).0, self.set(node).iter().map(|&k| of(k)).collect())
    }
}

#[cfg(test)]
mod tests;
