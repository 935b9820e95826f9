//! Which numbers of a result are stored together: the lanes of vectors of four, transposed so that
//! neighbours in the result are written by one store. A processor stores once a cycle, whatever the
//! width.

use std::collections::BTreeMap;

use crate::graph::{Graph, Node, NodeId, Op};

/// Lanes of a vector.
pub(crate) const WIDTH: usize = 4;

/// A number of a result.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Cell {
    Constant(f64),
    /// A lane of a node.
    Lane(usize, usize),
}

impl Cell {
    /// The cell of an output.
    pub(crate) fn of(graph: &Graph, output: NodeId) -> Self {
        let node = graph.node(output);
        if let Some(x) = node.constant() {
            return Self::Constant(x);
        }
        let (of, lane) = match node.op {
            Op::Broadcast => (NodeId(node.args[0]), graph.node(NodeId(node.args[1])).constant().unwrap_or_default() as usize),
            _ => (output, 0),
        };
        match (graph.node(of), graph.node(of).constant()) {
            (_, Some(x)) => Self::Constant(x),
            (Node { op: Op::LaneConstant, args }, _) => Self::Constant(graph.lanes().constant(args[0])[lane]),
            _ => Self::Lane(of.index(), lane),
        }
    }
}

/// One column of a group, one number per lane.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Column {
    /// The lanes of a node.
    Node(usize),
    Constants([f64; WIDTH]),
}

/// Numbers that are written together.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Group {
    /// The lanes of a node one after the other.
    Whole(usize, usize),
    /// Three numbers of each lane, the lanes one after the other.
    InTurn([Column; 3], usize),
    /// Four numbers of each lane, each lane's at a place of its own.
    Fours([Column; 4], [usize; WIDTH]),
    /// Two of each.
    Twos([Column; 2], [usize; WIDTH]),
    /// Two neighbouring numbers, of any nodes.
    Pair([Cell; 2], usize),
    /// One number.
    One(Cell, usize),
    /// Equal neighbouring constants: value, first place, count.
    Constant(f64, usize, usize),
}

impl Group {
    /// The nodes whose values it writes.
    pub(crate) fn nodes(&self) -> Vec<usize> {
        let node = |cell: &Cell| if let Cell::Lane(node, _) = cell { Some(*node) } else { None };
        let columns: &[Column] = match self {
            Self::Whole(node, _) => return vec![*node],
            Self::Pair(cells, _) => return cells.iter().filter_map(node).collect(),
            Self::One(cell, _) => return node(cell).into_iter().collect(),
            Self::Constant(..) => &[],
            Self::InTurn(columns, _) => columns,
            Self::Fours(columns, _) => columns,
            Self::Twos(columns, _) => columns,
        };
        columns.iter().filter_map(|column| if let Column::Node(node) = column { Some(*node) } else { None }).collect()
    }
}

/// Each number of the result in one group.
pub(crate) fn groups(cells: &[Cell]) -> Vec<Group> {
    let mut open = Open { cells, taken: vec![false; cells.len()] };
    let mut groups: Vec<Group> = families(cells).iter().filter_map(|at| open.group(at)).collect();
    for k in 0..cells.len() {
        if !open.taken[k] {
            groups.push(open.rest(k));
        }
    }
    groups
}

/// The places of the four lanes of each node whose lanes are all results, for the first occurrence
/// of each lane, the second and so on; in the order of places.
fn families(cells: &[Cell]) -> Vec<[usize; WIDTH]> {
    let mut places: BTreeMap<usize, [Vec<usize>; WIDTH]> = BTreeMap::new();
    for (k, cell) in cells.iter().enumerate() {
        if let Cell::Lane(node, lane) = *cell {
            places.entry(node).or_default()[lane].push(k);
        }
    }
    let each =
        |[a, b, c, d]: &[Vec<usize>; WIDTH]| a.iter().zip(b).zip(c).zip(d).map(|(((a, b), c), d)| [*a, *b, *c, *d]).collect::<Vec<_>>();
    let mut families: Vec<[usize; WIDTH]> = places.values().flat_map(each).collect();
    families.sort_unstable();
    families
}

/// The cells that are in no group yet.
struct Open<'a> {
    cells: &'a [Cell],
    taken: Vec<bool>,
}

impl Open<'_> {
    /// The group that starts at or contains the node whose lanes are `at` these places.
    fn group(&mut self, at: &[usize; WIDTH]) -> Option<Group> {
        if at.iter().any(|&k| self.taken[k]) {
            return None;
        }
        let apart = |n: usize| at.windows(2).all(|pair| pair[1] == pair[0] + n);
        if apart(1) {
            return self
                .columns(at, 1)
                .and_then(|[column]| if let Column::Node(node) = column { Some(Group::Whole(node, at[0])) } else { None });
        }
        if apart(3) {
            let found = (0..3.min(at[0] + 1)).find_map(|before| Some((self.columns(&at.map(|k| k - before), 2)?, at[0] - before)));
            if let Some((columns, at)) = found {
                return Some(Group::InTurn(columns, at));
            }
        }
        if let Some(columns) = self.columns(at, 3) {
            return Some(Group::Fours(columns, *at));
        }
        self.columns(at, 1).map(|columns| Group::Twos(columns, *at))
    }

    /// The group of a remaining cell `k`.
    fn rest(&mut self, k: usize) -> Group {
        let next = self.cells[k + 1..].iter().zip(&self.taken[k + 1..]).take_while(|(_, taken)| !**taken).map(|(cell, _)| *cell);
        let (group, n) = match self.cells[k] {
            Cell::Constant(x) => {
                let n = 1 + next.take_while(|cell| *cell == self.cells[k]).count();
                (Group::Constant(x, k, n), n)
            }
            cell => match next.take(1).find(|cell| matches!(cell, Cell::Lane(..))) {
                Some(next) => (Group::Pair([cell, next], k), 2),
                None => (Group::One(cell, k), 1),
            },
        };
        self.taken[k..k + n].fill(true);
        group
    }

    /// Takes the columns from these places on if at least `least` are not constants.
    fn columns<const N: usize>(&mut self, at: &[usize; WIDTH], least: usize) -> Option<[Column; N]> {
        let columns: Vec<Column> = (0..N).map(|n| self.column(at, n)).collect::<Option<_>>()?;
        let mut cells: Vec<usize> = at.iter().flat_map(|k| *k..k + N).collect();
        cells.sort_unstable();
        cells.dedup();
        if columns.iter().filter(|column| matches!(column, Column::Node(_))).count() < least || cells.len() < N * at.len() {
            return None;
        }
        cells.into_iter().for_each(|k| self.taken[k] = true);
        columns.try_into().ok()
    }

    /// Column `n` from these places on: each lane of one node, or constants.
    fn column(&self, at: &[usize; WIDTH], n: usize) -> Option<Column> {
        let cells: Vec<Cell> = at.iter().map(|k| self.cells.get(k + n).filter(|_| !self.taken[k + n]).copied()).collect::<Option<_>>()?;
        match cells[0] {
            Cell::Lane(node, _) => cells.iter().enumerate().all(|(l, cell)| *cell == Cell::Lane(node, l)).then_some(Column::Node(node)),
            Cell::Constant(_) => {
                let number = |cell: &Cell| if let Cell::Constant(x) = cell { Some(*x) } else { None };
                let numbers: Vec<f64> = cells.iter().map(number).collect::<Option<_>>()?;
                numbers.try_into().ok().map(Column::Constants)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The numbers that a group writes, each with its place.
    fn written(group: &Group) -> Vec<(usize, Cell)> {
        let number = |column: &Column, lane: usize| match column {
            Column::Node(node) => Cell::Lane(*node, lane),
            Column::Constants(x) => Cell::Constant(x[lane]),
        };
        let rows = |columns: &[Column], at: &[usize]| {
            let row = |(lane, k): (usize, &usize)| columns.iter().enumerate().map(|(n, c)| (k + n, number(c, lane))).collect::<Vec<_>>();
            at.iter().enumerate().flat_map(row).collect()
        };
        match group {
            Group::Whole(node, at) => (0..4).map(|lane| (at + lane, Cell::Lane(*node, lane))).collect(),
            Group::InTurn(columns, at) => rows(columns, &[0, 3, 6, 9].map(|k| k + at)),
            Group::Fours(columns, at) => rows(columns, at),
            Group::Twos(columns, at) => rows(columns, at),
            Group::Pair([a, b], at) => vec![(*at, *a), (at + 1, *b)],
            Group::One(cell, at) => vec![(*at, *cell)],
            Group::Constant(x, at, n) => (0..*n).map(|k| (at + k, Cell::Constant(*x))).collect(),
        }
    }

    /// The mass matrix of four legs of three joints on a base of six coordinates.
    fn four_legs() -> Vec<Cell> {
        let joint = |i: usize| (i >= 6).then(|| ((i - 6) / 3, (i - 6) % 3));
        let cell = |i: usize, j: usize| match (joint(i), joint(j)) {
            (None, None) => Cell::Lane(100 + i.max(j), 0),
            (Some((leg, n)), None) | (None, Some((leg, n))) => Cell::Lane(10 * n + i.min(j), leg),
            (Some((leg, n)), Some((other, m))) if leg == other => Cell::Lane(50 + n + m, leg),
            _ => Cell::Constant(0.0),
        };
        (0..18).flat_map(|i| (0..18).map(move |j| cell(i, j))).collect()
    }

    #[test]
    fn each_number_is_written_once() {
        let cells = four_legs();
        let mut all: Vec<(usize, Cell)> = groups(&cells).iter().flat_map(written).collect();
        all.sort_by_key(|(k, _)| *k);
        assert_eq!(all, cells.into_iter().enumerate().collect::<Vec<_>>());
    }

    /// Lanes of nodes at equal distances that overlap, and any cells between them.
    fn any(seed: u64) -> Vec<Cell> {
        let mut state = seed;
        let mut below = |n: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 33) % n) as usize
        };
        let mut cells: Vec<Cell> =
            (0..48).map(|_| if below(3) == 0 { Cell::Lane(below(4), below(4)) } else { Cell::Constant(below(2) as f64) }).collect();
        for node in 4..16 {
            let (start, apart, turned) = (below(12), [1, 3, 7, 9][below(4)], usize::from(below(4) == 0));
            (0..4).for_each(|lane| cells[start + apart * (lane ^ turned)] = Cell::Lane(node, lane));
        }
        cells
    }

    #[test]
    fn each_number_is_written_once_wherever_lanes_stand() {
        for seed in 0..500 {
            let cells = any(seed);
            let mut all: Vec<(usize, Cell)> = groups(&cells).iter().flat_map(written).collect();
            all.sort_by_key(|(k, _)| *k);
            assert_eq!(all, cells.into_iter().enumerate().collect::<Vec<_>>(), "seed {seed}");
        }
    }

    #[test]
    fn a_lane_of_an_output_is_that_lane() {
        let mut g = Graph::in_lanes(WIDTH);
        let (input, numbers, number) = (g.lane_input(0, &[1, 2, 3, 4]), g.lane_constant([0.5, 1.5, 2.5, 3.5]), g.constant(7.0));
        for lane in 0..WIDTH {
            let k = g.constant(lane as f64);
            let [of_input, of_numbers] = [input, numbers].map(|x| g.exactly(Op::Broadcast, &[x, k]));
            assert_eq!(Cell::of(&g, of_input), Cell::Lane(input.index(), lane));
            assert_eq!(Cell::of(&g, of_numbers), Cell::Constant(0.5 + lane as f64));
        }
        assert_eq!(Cell::of(&g, number), Cell::Constant(7.0));
        assert_eq!(Cell::of(&g, input), Cell::Lane(input.index(), 0));
    }

    #[test]
    fn lanes_of_legs_are_rows() {
        let cells = four_legs();
        let groups = groups(&cells);
        let count = |is: fn(&Group) -> bool| groups.iter().filter(|g| is(g)).count();
        assert_eq!(count(|g| matches!(g, Group::InTurn(..))), 6);
        assert_eq!(count(|g| matches!(g, Group::Fours(..))), 3);
        assert_eq!(count(|g| matches!(g, Group::Twos(..))), 6);
        assert_eq!(count(|g| matches!(g, Group::Pair(..))), 18);
    }

    #[test]
    fn lanes_side_by_side_are_one_store() {
        let cells: Vec<Cell> = (0..4).map(|lane| Cell::Lane(7, lane)).collect();
        assert_eq!(groups(&cells), [Group::Whole(7, 0)]);
    }
}
