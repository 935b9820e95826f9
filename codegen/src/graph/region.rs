//! Regions: parts of a graph that run several times, once, or not at all.
//!
//! A region is a graph of its own, the body, traced once. Three operations connect it to the graph
//! around it:
//!
//! ```text
//! List(List(…, b), c)    the values that go in: starts, captured values, then a mask or a table
//! Region(list)           the region
//! RegionValue(region)    value number k that comes out
//! ```
//!
//! Inside, argument [`CARRIED`] has the carried values, [`CAPTURED`] the captured ones, [`ROW`] the
//! row of the turn. The results of the body are the next carried values, then the mask that ends an
//! iteration or the results of the turn. Passes that know nothing of regions treat them as any
//! other operation.

use std::sync::Arc;

use articulated_core::Scalar;

use super::{Counts, Graph, Node, NodeId, Op};

/// The argument of a body with the carried values.
pub const CARRIED: usize = 0;
/// The argument of a body with the captured values.
pub const CAPTURED: usize = 1;
/// The argument of a body with the row of the turn.
pub const ROW: usize = 2;

/// How often a region runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// Until its mask holds, at most so many times. Its last value is 1 where the mask held, else
    /// 0.
    Repeat {
        /// The bound.
        most: usize,
    },
    /// Once where a mask holds.
    When,
    /// Once for each row of a table.
    ForEach {
        /// The number of rows.
        turns: usize,
        /// The length of a row.
        row: usize,
        /// The number of results of a turn.
        results: usize,
    },
}

/// A part of a graph that runs several times, once, or not at all.
#[derive(Clone, Debug)]
pub struct Region {
    /// How often it runs.
    pub kind: Kind,
    /// The number of carried values.
    pub carried: usize,
    /// The number of captured values.
    pub captured: usize,
    /// The body.
    pub body: Graph,
    /// How it is differentiated.
    pub rule: Rule,
}

/// How a region is differentiated.
#[derive(Clone, Debug)]
pub enum Rule {
    /// As its kind says.
    OfItsKind,
    /// The results of its one turn solve an equation.
    Equation(Box<Equation>),
    /// Its results are constants.
    Held,
}

/// r(x, p) = 0, with x as carried values and p as the captured values of the region.
#[derive(Clone, Debug)]
pub struct Equation {
    /// r.
    pub residual: Graph,
    /// (∂r/∂x)⁻¹ b, with b as carried values; ∂r/∂x is symmetric.
    pub solve: Graph,
}

impl Region {
    /// The number of values that go in.
    pub fn inputs(&self) -> usize {
        let more = match self.kind {
            Kind::Repeat { .. } => 0,
            Kind::When => 1,
            Kind::ForEach { turns, row, .. } => turns * row,
        };
        self.carried + self.captured + more
    }

    /// The number of values that come out.
    pub fn values(&self) -> usize {
        let more = match self.kind {
            Kind::Repeat { .. } => 1,
            Kind::When => 0,
            Kind::ForEach { turns, results, .. } => turns * results,
        };
        self.carried + more
    }

    /// The number of results of the body.
    pub fn results(&self) -> usize {
        let more = match self.kind {
            Kind::Repeat { .. } => 1,
            Kind::When => 0,
            Kind::ForEach { results, .. } => results,
        };
        self.carried + more
    }

    /// How often it runs at most.
    pub fn most(&self) -> usize {
        match self.kind {
            Kind::Repeat { most } => most,
            Kind::When => 1,
            Kind::ForEach { turns, .. } => turns,
        }
    }

    /// The values that come out, computed in `S` from those that go in.
    pub(crate) fn run<S: Scalar>(&self, given: &[S]) -> Vec<S> {
        let (starts, rest) = given.split_at(self.carried);
        let (captured, rest) = rest.split_at(self.captured);
        let turn = |state: &[S], row: &[S]| {
            self.body.evaluate_as(|argument, k| match argument {
                CARRIED => state[k],
                CAPTURED => captured[k],
                _ => row[k],
            })
        };
        let mut state = starts.to_vec();
        match self.kind {
            Kind::Repeat { most } => {
                let held = S::repeat(most, &mut state, |state| {
                    let next = turn(state, &[]);
                    state.copy_from_slice(&next[..self.carried]);
                    next[self.carried].positive()
                });
                state.push(S::select(held, S::one(), S::zero()));
            }
            Kind::When => S::when(rest[0].positive(), &mut state, |state| {
                let next = turn(state, &[]);
                state.copy_from_slice(&next);
            }),
            Kind::ForEach { turns, results, .. } => {
                let mut all = vec![S::zero(); turns * results];
                S::for_each(turns, rest, &mut state, &mut all, |row, state, results| {
                    let next = turn(state, row);
                    state.copy_from_slice(&next[..self.carried]);
                    results.copy_from_slice(&next[self.carried..]);
                });
                state.extend(all);
            }
        }
        state
    }

    /// Checks that the body has the results of its kind and takes no other arguments.
    pub(super) fn verify(&self) -> Result<(), String> {
        self.body.verify()?;
        if self.body.outputs.len() != self.results() {
            return Err(format!("the body of a region has {} results, not {}", self.body.outputs.len(), self.results()));
        }
        let row = if let Kind::ForEach { row, .. } = self.kind { row } else { 0 };
        let lengths = [self.carried, self.captured, row];
        let beyond = |node: &Node| node.op == Op::Input && lengths.get(node.args[0] as usize).is_none_or(|n| node.args[1] as usize >= *n);
        match self.body.nodes().iter().find(|node| beyond(node)) {
            Some(node) => Err(format!("the body of a region reads {:?}, which it does not have", node.args)),
            None => Ok(()),
        }
    }
}

impl Graph {
    /// The regions, by their numbers.
    pub fn regions(&self) -> &[Arc<Region>] {
        &self.regions
    }

    /// Whether a node is a region.
    pub fn has_regions(&self) -> bool {
        self.nodes().iter().any(|node| node.op == Op::Region)
    }

    /// Whether a node is a region with a table.
    pub(crate) fn has_turns(&self) -> bool {
        let regions = self.nodes().iter().filter(|node| node.op == Op::Region);
        regions.map(|node| self.region_of(node)).any(|region| matches!(region.kind, Kind::ForEach { .. }))
    }

    /// The region that a node is.
    pub(crate) fn region_of(&self, node: &Node) -> &Arc<Region> {
        &self.regions[node.args[1] as usize]
    }

    /// The node for a region with the values that go in.
    ///
    /// # Panics
    /// If there are more or fewer values than the region takes.
    pub fn region(&mut self, region: Arc<Region>, given: &[NodeId]) -> NodeId {
        assert_eq!(given.len(), region.inputs(), "values that go into a region");
        for (op, n) in region.body.requested.each().filter(|(_, n)| *n > 0) {
            self.requested.add(op, n * region.most() as u64);
        }
        let number = self.add_region(region);
        let start = self.constant(0.0);
        let list = given.iter().fold(start, |list, value| self.exactly(Op::List, &[list, *value]));
        self.intern(Node { op: Op::Region, args: [list.0, number, 0] })
    }

    /// Value number `k` that comes out of a region.
    pub fn region_value(&mut self, region: NodeId, k: usize) -> NodeId {
        self.intern(Node { op: Op::RegionValue, args: [region.0, k as u32, 0] })
    }

    fn add_region(&mut self, region: Arc<Region>) -> u32 {
        let known = self.regions.iter().position(|other| Arc::ptr_eq(other, &region));
        known.unwrap_or_else(|| {
            self.regions.push(region);
            self.regions.len() - 1
        }) as u32
    }

    /// A node of another graph on operands of this one.
    pub(crate) fn adopted(&mut self, other: &Self, node: Node, operands: &[NodeId]) -> NodeId {
        if node.op != Op::Region {
            return self.on_operands(node, operands);
        }
        let number = self.add_region(other.region_of(&node).clone());
        self.intern(Node { op: Op::Region, args: [operands[0].0, number, 0] })
    }

    /// A node of a graph with the same tables on other operands.
    pub(crate) fn on_operands(&mut self, node: Node, operands: &[NodeId]) -> NodeId {
        match node.op {
            Op::Region | Op::RegionValue => self.intern(Node { args: [operands[0].0, node.args[1], 0], ..node }),
            op => self.exactly(op, operands),
        }
    }

    /// The values that go into a region.
    pub(crate) fn given(&self, region: &Node) -> Vec<NodeId> {
        let mut given = Vec::new();
        let mut list = self.node(NodeId(region.args[0]));
        while list.op == Op::List {
            given.push(NodeId(list.args[1]));
            list = self.node(NodeId(list.args[0]));
        }
        given.reverse();
        given
    }

    /// The same with other regions in the place of these, which take and return as many values.
    pub(crate) fn with_regions(mut self, mut change: impl FnMut(&Region) -> Region) -> Self {
        for region in &mut self.regions {
            *region = Arc::new(change(region));
        }
        self
    }

    /// The number of operations as they are written: those of a region once.
    pub(crate) fn written(&self) -> u64 {
        let own = self.nodes().iter().filter(|node| !matches!(node.op, Op::List | Op::Region | Op::RegionValue)).count();
        let regions = self.nodes().iter().filter(|node| node.op == Op::Region).map(|node| self.region_of(node));
        own as u64 + regions.map(|region| region.body.written()).sum::<u64>()
    }

    /// The operations of the regions, at their bounds.
    pub(super) fn count_regions(&self, counts: &mut Counts) {
        for region in self.nodes().iter().filter(|node| node.op == Op::Region).map(|node| self.region_of(node)) {
            for (op, n) in region.body.counts().each() {
                counts.add(op, n.saturating_mul(region.most() as u64));
            }
        }
    }
}
