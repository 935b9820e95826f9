//! Regions of a graph as statements.

use super::Lowering;
use crate::graph::{CAPTURED, CARRIED, Graph, Kind, Node, NodeId, Op, ROW};
use crate::lir::{Carried, Expr, Region, Stmt, Table, Temp, Turns};

impl Lowering<'_> {
    /// The number of the first value of the body of a region.
    fn first_of_body(&self, region: usize) -> usize {
        let before = self.graph.nodes()[..region].iter().filter(|node| node.op == Op::Region);
        self.first
            + self.graph.nodes().len()
            + before.map(|node| self.graph.region_of(node)).map(|region| values(&region.body) + region.inputs() + 1).sum::<usize>()
    }

    /// The region that node `k` is.
    pub(super) fn region(&self, k: usize) -> Region {
        let node = self.graph.nodes()[k];
        let (region, given) = (self.graph.region_of(&node), self.graph.given(&node));
        let (starts, rest) = given.split_at(region.carried);
        let (captured, rest) = rest.split_at(region.captured);
        let first = self.first_of_body(k);
        let inner = Lowering { graph: &region.body, first, results: &[], arguments: &[], ..*self };
        // Values that the body does not read have names beyond all others of it.
        let mut next = first + values(&region.body);
        let mut input = |argument: usize, index: usize| {
            let args = [argument as u32, index as u32, 0];
            let found = region.body.nodes().iter().position(|node| node.op == Op::Input && node.args == args);
            found.map(|k| inner.temp(k)).unwrap_or_else(|| {
                next += 1;
                Temp::of(next - 1)
            })
        };
        let end = |k: usize| inner.operand(region.body.outputs[k]);
        let carried: Vec<Carried> = starts
            .iter()
            .enumerate()
            .map(|(k, start)| Carried { temp: input(CARRIED, k), start: self.operand(*start), next: end(k) })
            .collect();
        let captured = captured.iter().enumerate().map(|(k, of)| (input(CAPTURED, k), self.operand(*of))).collect();
        let turns = match region.kind {
            Kind::Repeat { most } => Turns::Until { most, mask: end(region.carried), held: input(ROW, 0) },
            Kind::When => Turns::Where(self.operand(rest[0])),
            Kind::ForEach { turns, row, results } => Turns::Each {
                name: first as u32,
                table: self.table(rest, row),
                row: (0..row).map(|k| input(ROW, k)).collect(),
                fixed: Vec::new(),
                results: (0..results).map(|j| end(region.carried + j)).collect(),
                turns,
                read: Vec::new(),
                stored: self.stored(k, region.carried, turns, results),
            },
        };
        let is_input = |statement: &Stmt| matches!(statement, Stmt::Let(_, Expr::Input { .. }));
        let body = inner.definitions().into_iter().flatten().filter(|statement| !is_input(statement)).collect();
        let mut made = Region { turns, carried, captured, columns: Vec::new(), body, after: Vec::new() };
        made.lift_columns();
        for (value, node) in self.graph.nodes().iter().enumerate() {
            if node.op != Op::RegionValue || node.args[0] as usize != k {
                continue;
            }
            let (temp, number) = (self.temp(value), node.args[1] as usize);
            match (&mut made.turns, made.carried.get(number)) {
                (_, Some(carried)) => made.after.push((temp, carried.temp)),
                (Turns::Until { held, .. }, None) => made.after.push((temp, *held)),
                (Turns::Each { stored: Some(_), .. }, None) => {}
                (Turns::Each { read, results, .. }, None) => {
                    let place = number - region.carried;
                    read.push((place / results.len(), place % results.len(), temp));
                }
                (Turns::Where(_), None) => {}
            }
        }
        made
    }
}

impl Lowering<'_> {
    /// The rows of a table: those of a whole argument, or values.
    fn table(&self, values: &[NodeId], row: usize) -> Table {
        let input = |k: usize| Some(self.graph.node(values[k])).filter(|node| node.op == Op::Input).map(|node| node.args);
        let argument = values.first().and_then(|_| input(0)).map_or(0, |args| args[0]);
        let is_whole = row > 0
            && self.arguments.get(argument as usize) == Some(&values.len())
            && (0..values.len()).all(|k| input(k) == Some([argument, k as u32, 0]));
        if is_whole { Table::Argument(argument) } else { Table::Values(values.iter().map(|id| self.operand(*id)).collect()) }
    }

    /// The first place of an array of the result that has all results of region `k`, one after the
    /// other, which nothing else reads.
    fn stored(&self, k: usize, carried: usize, turns: usize, results: usize) -> Option<usize> {
        let count = turns * results;
        if self.arguments.is_empty() || count == 0 {
            return None;
        }
        let value = |id: NodeId| Some(self.graph.node(id)).filter(|node| node.op == Op::RegionValue && node.args[0] as usize == k);
        let is_result = |at: usize, j: usize| value(self.graph.outputs[at + j]).is_some_and(|node| node.args[1] as usize == carried + j);
        let array = self.results.iter().find(|array| {
            let rows = array.lengths.len() < 2 || array.lengths == [turns, results];
            rows && array.numbers() == count && (0..count).all(|j| is_result(array.start, j))
        })?;
        let own = array.start..array.start + count;
        let is_used =
            self.graph.nodes().iter().flat_map(Node::operands).any(|id| value(id).is_some_and(|node| node.args[1] as usize >= carried));
        let again = self
            .graph
            .outputs
            .iter()
            .enumerate()
            .any(|(at, id)| !own.contains(&at) && value(*id).is_some_and(|node| node.args[1] as usize >= carried));
        (!is_used && !again).then_some(array.start)
    }
}

/// The numbers of values of a graph, those of its regions included. Each region has some more for
/// values that its body does not read.
fn values(graph: &Graph) -> usize {
    let regions = graph.nodes().iter().filter(|node| node.op == Op::Region).map(|node| graph.region_of(node));
    graph.nodes().len() + regions.map(|region| values(&region.body) + region.inputs() + 1).sum::<usize>()
}
