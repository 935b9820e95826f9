//! The expression graph: a hash-consed arena in which an operand always precedes its use.

mod counts;
mod evaluate;
mod fold;
mod lanes;
mod many;
mod op;
mod region;
mod table;

use std::sync::Arc;

pub use counts::Counts;
pub(crate) use evaluate::value as operation;
pub use lanes::{Lanes, MOST, Value};
pub use op::{OPS, Op, Row};
pub use region::{CAPTURED, CARRIED, Equation, Kind, ROW, Region, Rule};

/// A node's number in its graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct NodeId(pub u32);

impl NodeId {
    /// As an index.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// An operation with its operands. A constant holds its bits in `args`, an input the number of the
/// argument and the index in it; a lane constant its number in [`Lanes`], a lane input the number
/// of the argument and its number there; a region its number after its operand, a value of a region
/// the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Node {
    /// The operation.
    pub op: Op,
    /// Operands; unused ones are 0.
    pub args: [u32; 3],
}

impl Node {
    /// The operands.
    pub fn operands(&self) -> impl Iterator<Item = NodeId> + '_ {
        self.args[..self.op.row().arity].iter().map(|&a| NodeId(a))
    }

    /// The value of a constant.
    pub fn constant(&self) -> Option<f64> {
        (self.op == Op::Constant).then(|| f64::from_bits(u64::from(self.args[0]) << 32 | u64::from(self.args[1])))
    }

    fn of_constant(x: f64) -> Self {
        // −0 becomes 0: no formula here distinguishes them, and one node serves for both.
        let bits = (x + 0.0).to_bits();
        Self { op: Op::Constant, args: [(bits >> 32) as u32, bits as u32, 0] }
    }
}

/// A program: nodes, each after its operands, and the nodes that are its outputs.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    nodes: Vec<Node>,
    /// The results, in order.
    pub outputs: Vec<NodeId>,
    places: table::Places,
    requested: Counts,
    lanes: Lanes,
    regions: Vec<Arc<Region>>,
}

impl Graph {
    /// An empty graph whose values have this many lanes.
    pub fn in_lanes(width: usize) -> Self {
        Self { lanes: Lanes::new(width), ..Self::default() }
    }

    /// An empty graph that leaves of this one can be copied to, with room for as many nodes.
    #[must_use]
    pub fn emptied(&self) -> Self {
        let places = table::Places::with_room(self.nodes.len());
        let regions = self.regions.clone();
        Self { lanes: self.lanes.clone(), regions, nodes: Vec::with_capacity(self.nodes.len()), places, ..Self::default() }
    }

    /// The tables of lane constants and lane inputs.
    pub fn lanes(&self) -> &Lanes {
        &self.lanes
    }

    /// The nodes in order.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// A node.
    pub fn node(&self, id: NodeId) -> Node {
        self.nodes[id.index()]
    }

    /// The operations that were requested while the graph was built, before folding and sharing.
    pub fn requested(&self) -> &Counts {
        &self.requested
    }

    /// The same graph with the requested operations of `other`, of which it is another form.
    #[must_use]
    pub fn requested_as(mut self, other: &Self) -> Self {
        self.requested = other.requested.clone();
        self
    }

    /// The node for a number.
    pub fn constant(&mut self, x: f64) -> NodeId {
        self.intern(Node::of_constant(x))
    }

    /// The node for element `index` of argument number `argument`.
    pub fn input(&mut self, argument: usize, index: usize) -> NodeId {
        self.intern(Node { op: Op::Input, args: [argument as u32, index as u32, 0] })
    }

    /// The node for numbers, one a lane.
    pub fn lane_constant(&mut self, x: Value) -> NodeId {
        if x.iter().take(self.lanes.width).all(|y| *y == x[0]) {
            return self.constant(x[0]);
        }
        // As for constants: −0 is 0.
        let number = self.lanes.add_constant(x.map(|y| y + 0.0));
        self.intern(Node { op: Op::LaneConstant, args: [number, 0, 0] })
    }

    /// The node for elements of an argument, one a lane.
    pub fn lane_input(&mut self, argument: usize, indices: &[usize]) -> NodeId {
        let number = self.lanes.add_input(indices);
        self.intern(Node { op: Op::LaneInput, args: [argument as u32, number, 0] })
    }

    /// The value of a node that is a constant in each lane.
    pub fn constant_value(&self, id: NodeId) -> Option<Value> {
        let node = self.node(id);
        match node.op {
            Op::LaneConstant => Some(self.lanes.constant(node.args[0])),
            _ => node.constant().map(|x| [x; MOST]),
        }
    }

    /// The node for an operation on nodes, folded: it may be a simpler one, or an existing one.
    pub fn apply(&mut self, op: Op, operands: &[NodeId]) -> NodeId {
        self.requested.add(op, 1);
        fold::fold(self, op, operands)
    }

    /// The node for exactly this operation on these operands, shared if it exists. No folding.
    pub fn exactly(&mut self, op: Op, operands: &[NodeId]) -> NodeId {
        let mut args = [0; 3];
        for (slot, id) in args.iter_mut().zip(operands) {
            *slot = id.0;
        }
        if op.row().commutes && args[0] > args[1] {
            args.swap(0, 1);
        }
        self.intern(Node { op, args })
    }

    /// This node, if it already exists.
    fn find(&self, op: Op, a: NodeId, b: NodeId) -> Option<NodeId> {
        self.places.find(&self.nodes, &Node { op, args: [a.0, b.0, 0] }).map(NodeId)
    }

    fn intern(&mut self, node: Node) -> NodeId {
        let next = self.nodes.len() as u32;
        let id = self.places.find_or_insert(&self.nodes, &node, next);
        if id == next {
            self.nodes.push(node);
        }
        NodeId(id)
    }

    /// Copies a leaf (constant or input) of another graph.
    pub fn leaf(&mut self, node: Node) -> NodeId {
        debug_assert_eq!(node.op.row().arity, 0);
        self.intern(node)
    }

    /// How often each node is used, by other nodes or as an output.
    pub fn uses(&self) -> Vec<u32> {
        let mut uses = vec![0; self.nodes.len()];
        let operands = self.nodes.iter().flat_map(Node::operands);
        for id in operands.chain(self.outputs.iter().copied()) {
            uses[id.index()] += 1;
        }
        uses
    }

    /// The operations of the graph; those of regions at their bounds.
    pub fn counts(&self) -> Counts {
        let mut counts = Counts::default();
        self.nodes.iter().for_each(|n| counts.add(n.op, 1));
        self.count_regions(&mut counts);
        counts
    }

    /// Checks the invariants of every pass: operands precede their uses, and outputs exist.
    pub fn verify(&self) -> Result<(), String> {
        for (k, node) in self.nodes.iter().enumerate() {
            if let Some(late) = node.operands().find(|a| a.index() >= k) {
                return Err(format!("node {k} ({:?}) uses node {}", node.op, late.0));
            }
        }
        for node in self.nodes.iter().filter(|node| node.op == Op::Region) {
            let region = self.region_of(node);
            let given = self.given(node).len();
            if given != region.inputs() {
                return Err(format!("{given} values go into a region of {}", region.inputs()));
            }
            region.verify()?;
        }
        for node in self.nodes.iter().filter(|node| node.op == Op::RegionValue) {
            let of = self.node(NodeId(node.args[0]));
            if of.op != Op::Region || node.args[1] as usize >= self.region_of(&of).values() {
                return Err(format!("value {} of {:?}, which has no such value", node.args[1], of.op));
            }
        }
        match self.outputs.iter().find(|o| o.index() >= self.nodes.len()) {
            Some(o) => Err(format!("output {} does not exist", o.0)),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_node_before_what_it_needs_and_a_result_that_is_not_there_are_found() {
        let mut graph = Graph::default();
        let x = graph.input(0, 0);
        graph.outputs = vec![graph.apply(Op::Sin, &[x])];
        assert_eq!(graph.verify(), Ok(()));
        for late in [1, 2] {
            let mut wrong = graph.clone();
            wrong.nodes[1].args[0] = late;
            assert!(wrong.verify().is_err(), "node 1 of node {late}");
        }
        graph.outputs.push(NodeId(2));
        assert!(graph.verify().is_err());
    }

    #[test]
    fn inputs_and_constants_of_lanes_are_one_only_where_all_lanes_are() {
        for width in [2, 4] {
            let mut graph = Graph::in_lanes(width);
            let indices = [[3, 5, 7, 9], [3, 5, 7, 8], [3, 4, 7, 9], [5, 3, 7, 9]];
            graph.outputs = indices.iter().map(|i| graph.lane_input(1, &i[..width])).collect();
            // Two lanes of the first and of the second are the same.
            assert_eq!(graph.outputs[0] == graph.outputs[1], width == 2);
            let lanes = graph.outputs.clone();
            for lane in 0..width {
                let lane_of_all = graph.constant(lane as f64);
                graph.outputs = lanes.iter().map(|&id| graph.exactly(Op::Broadcast, &[id, lane_of_all])).collect();
                let expected: Vec<f64> = indices.iter().map(|i| i[lane] as f64).collect();
                assert_eq!(graph.evaluate(|argument, k| if argument == 1 { k as f64 } else { f64::NAN }), expected);
            }
        }
    }
}
