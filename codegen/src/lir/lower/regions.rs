//! Regions of a graph as statements.

use super::Lowering;
use super::in_place::read_in_place;
use crate::graph::{CAPTURED, CARRIED, Graph, Kind, Node, NodeId, Op, ROW};
use crate::lir::{Array, Carried, Expr, Operand, Region, Stmt, Stored, Table, TableColumn, Temp, Turns};

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
                table: Table::Values(Vec::new()),
                row: (0..row).map(|k| input(ROW, k)).collect(),
                fixed: Vec::new(),
                results: (0..results).map(|j| end(region.carried + j)).collect(),
                turns,
                read: Vec::new(),
                stored: self.stored(k, region.carried, turns, results),
                is_kept: false,
            },
        };
        let is_input = |statement: &Stmt| matches!(statement, Stmt::Let(_, Expr::Input { .. }));
        let turns = self.with_table(turns, rest);
        let body = inner.definitions().into_iter().flatten().filter(|statement| !is_input(statement)).collect();
        let mut made = Region { turns, carried, captured, columns: Vec::new(), body, after: Vec::new() };
        made.lift_columns();
        let ends: Vec<Operand> = made.ends().copied().collect();
        read_in_place(&mut made.body, &ends);
        made.forget_unread();
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
    /// The turns with the rows of their table: those of a whole argument, or values and columns of
    /// arguments.
    fn with_table(&self, mut turns: Turns, values: &[NodeId]) -> Turns {
        let Turns::Each { table, row, fixed, .. } = &mut turns else { return turns };
        let input = |k: usize| Some(self.graph.node(values[k])).filter(|node| node.op == Op::Input).map(|node| node.args);
        let width = row.len();
        let argument = values.first().and_then(|_| input(0)).map_or(0, |args| args[0]);
        let is_whole = width > 0
            && self.arguments.get(argument as usize) == Some(&values.len())
            && (0..values.len()).all(|k| input(k) == Some([argument, k as u32, 0]));
        if is_whole {
            *table = Table::Argument(argument);
            return turns;
        }
        let column = |k: usize| self.column_of_argument(&values.iter().skip(k).step_by(width).copied().collect::<Vec<_>>());
        let found: Vec<Option<TableColumn>> = (0..width).map(column).collect();
        fixed.extend(row.iter().zip(&found).filter_map(|(temp, column)| Some((*temp, (*column)?))));
        let mut stays = found.iter().map(Option::is_none);
        row.retain(|_| stays.next().unwrap_or(true));
        let stays = values.iter().enumerate().filter(|(k, _)| found[k % width].is_none());
        *table = Table::Values(stays.map(|(_, id)| self.operand(*id)).collect());
        turns
    }

    /// The numbers of one argument that these values are, at equal distances.
    fn column_of_argument(&self, values: &[NodeId]) -> Option<TableColumn> {
        let input =
            |id: &NodeId| Some(self.graph.node(*id)).filter(|node| node.op == Op::Input).map(|node| (node.args[0], node.args[1] as usize));
        let ((argument, first), (_, second)) = (input(values.first()?)?, input(values.get(1)?)?);
        let is_backward = second < first;
        let column = TableColumn::Argument { argument, first, stride: first.abs_diff(second), is_backward };
        let reaches = !is_backward || first >= (values.len() - 1) * (first - second);
        let is_known = self.arguments.get(argument as usize).is_some_and(|length| *length > 1);
        let fits = is_known && reaches && values.iter().enumerate().all(|(k, id)| input(id) == Some((argument, column.place(k))));
        fits.then_some(column)
    }

    /// Where an array of the result has all results of region `k`, turn by turn or from the last
    /// turn to the first, which nothing else reads.
    fn stored(&self, k: usize, carried: usize, turns: usize, results: usize) -> Option<Stored> {
        let count = turns * results;
        if self.arguments.is_empty() || count == 0 {
            return None;
        }
        let value = |id: NodeId| Some(self.graph.node(id)).filter(|node| node.op == Op::RegionValue && node.args[0] as usize == k);
        let has = |stored: Stored| {
            (0..count).all(|j| {
                let place = stored.of_turn(j / results, (turns, results)) + j % results;
                value(self.graph.outputs[place]).is_some_and(|node| node.args[1] as usize == carried + j)
            })
        };
        let fits = |array: &Array| array.numbers() == count && (array.lengths.len() < 2 || array.lengths == [turns, results]);
        let both = |array: &Array| [false, true].map(|is_backward| Stored { first: array.start, is_backward });
        let stored = self.results.iter().filter(|array| fits(array)).flat_map(both).find(|stored| has(*stored))?;
        let own = stored.first..stored.first + count;
        let is_used =
            self.graph.nodes().iter().flat_map(Node::operands).any(|id| value(id).is_some_and(|node| node.args[1] as usize >= carried));
        let again = self
            .graph
            .outputs
            .iter()
            .enumerate()
            .any(|(at, id)| !own.contains(&at) && value(*id).is_some_and(|node| node.args[1] as usize >= carried));
        (!is_used && !again).then_some(stored)
    }
}

/// The numbers of values of a graph, those of its regions included. Each region has some more for
/// values that its body does not read.
fn values(graph: &Graph) -> usize {
    let regions = graph.nodes().iter().filter(|node| node.op == Op::Region).map(|node| graph.region_of(node));
    graph.nodes().len() + regions.map(|region| values(&region.body) + region.inputs() + 1).sum::<usize>()
}
