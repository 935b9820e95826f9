//! Merges the traces of isomorphic branches into vector operations.

use std::collections::HashMap;

use articulated_core::algorithm::Argument;

use super::{Constants, IsomorphicLimbs};
use crate::graph::{Graph, MOST, Node, NodeId, Op};

/// Where the value of a scalar node is in the new graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum At {
    /// In every lane of a node.
    All(NodeId),
    /// In one lane of a node.
    Lane(NodeId, usize),
    /// A deferred sum over lanes.
    Sum,
}

impl At {
    fn lane(self) -> Option<usize> {
        if let At::Lane(_, lane) = self { Some(lane) } else { None }
    }

    fn node(self) -> Option<NodeId> {
        if let At::Lane(id, _) | At::All(id) = self { Some(id) } else { None }
    }
}

/// A term of a sum: its sign, and where it is; the scalar node that it comes from.
#[derive(Clone, Copy, Debug)]
struct Term {
    negative: bool,
    at: At,
    from: usize,
}

/// Number of terms above which a sum is not expanded to find matching ones.
const MANY: usize = 1000;

/// Vectorizes the trace of a whole robot: equal operations on values of single lanes become one
/// operation on all lanes. Sums over all lanes become one sum of vectors, reduced at the end. The
/// outputs are in lane 0.
pub(crate) fn pack(graph: &Graph, arguments: &[Argument], alike: &IsomorphicLimbs, constants: &Constants) -> Graph {
    let mut packer = Packer { graph, new: Graph::in_lanes(alike.width), at: Vec::with_capacity(graph.nodes().len()) };
    for node in graph.nodes() {
        let at = match node.op {
            Op::Input if node.args[0] as usize == constants.argument => {
                let (numbers, lane) = constants.behind(node.args[1] as usize);
                At::Lane(packer.new.lane_constant(numbers), lane)
            }
            Op::Input => packer.input(node, arguments, alike),
            Op::Constant => At::All(packer.new.leaf(*node)),
            _ => packer.operation(node),
        };
        packer.at.push(at);
    }
    let outputs = graph.outputs.iter().map(|o| packer.everywhere(o.index())).collect();
    packer.new.outputs = outputs;
    packer.new
}

/// How often each node, with its sign, is a term in each lane.
struct Tally {
    width: usize,
    /// Number of all terms, including those in no lane.
    terms: usize,
    places: HashMap<(NodeId, bool), [usize; MOST]>,
}

impl Tally {
    /// How often something is a term in every lane.
    fn everywhere(&self, lanes: &[usize; MOST]) -> usize {
        lanes[..self.width].iter().copied().min().unwrap_or(0)
    }

    /// Whether every lane contains an equal term.
    fn in_all_lanes(&self, term: &Term) -> bool {
        term.at.node().and_then(|id| self.places.get(&(id, term.negative))).is_some_and(|lanes| self.everywhere(lanes) > 0)
    }

    /// Number of terms without those that are in all lanes.
    fn alone(&self) -> usize {
        self.terms - self.places.values().map(|lanes| self.width * self.everywhere(lanes)).sum::<usize>()
    }
}

struct Packer<'a> {
    graph: &'a Graph,
    new: Graph,
    at: Vec<At>,
}

impl Packer<'_> {
    fn input(&mut self, node: &Node, arguments: &[Argument], alike: &IsomorphicLimbs) -> At {
        let (argument, index) = (node.args[0] as usize, node.args[1] as usize);
        match arguments.get(argument).and_then(|a| alike.lanes(*a, index)) {
            Some((indices, lane)) => At::Lane(self.new.lane_input(argument, &indices), lane),
            None => At::All(self.new.leaf(*node)),
        }
    }

    fn operation(&mut self, node: &Node) -> At {
        let operands: Vec<usize> = node.operands().map(NodeId::index).collect();
        let is_sum = matches!(node.op, Op::Add | Op::Sub | Op::Neg);
        if is_sum && (self.in_several_lanes(&operands) || operands.iter().any(|&o| self.at[o] == At::Sum)) {
            return At::Sum;
        }
        operands.iter().for_each(|&o| self.make(o));
        // A value from several lanes is the same in all.
        if self.in_several_lanes(&operands) {
            let ids: Vec<NodeId> = operands.iter().map(|&o| self.everywhere(o)).collect();
            return At::All(self.new.apply(node.op, &ids));
        }
        let ids: Vec<NodeId> = operands.iter().filter_map(|&o| self.at[o].node()).collect();
        let id = self.new.apply(node.op, &ids);
        operands.iter().find_map(|&o| self.at[o].lane()).map_or(At::All(id), |lane| At::Lane(id, lane))
    }

    fn in_several_lanes(&self, nodes: &[usize]) -> bool {
        let mut lanes = nodes.iter().filter_map(|&n| self.at[n].lane());
        lanes.next().is_some_and(|first| lanes.any(|lane| lane != first))
    }

    /// Builds a deferred sum.
    fn make(&mut self, node: usize) {
        if self.at[node] == At::Sum {
            self.at[node] = At::All(self.sum(node));
        }
    }

    /// The value of a scalar node in every lane.
    fn everywhere(&mut self, node: usize) -> NodeId {
        self.make(node);
        self.broadcast(self.at[node])
    }

    fn broadcast(&mut self, at: At) -> NodeId {
        match at {
            At::All(id) => id,
            At::Lane(id, lane) => {
                let lane = self.new.constant(lane as f64);
                self.new.apply(Op::Broadcast, &[id, lane])
            }
            At::Sum => self.new.constant(0.0),
        }
    }

    /// Builds a sum over lanes.
    fn sum(&mut self, root: usize) -> NodeId {
        let mut terms = Vec::new();
        self.open(Term { negative: false, at: At::Sum, from: root }, &mut terms);
        let mut reduced: Option<NodeId> = None;
        loop {
            while let Some(term) = self.take_all_lanes(&mut terms) {
                reduced = Some(self.add(reduced, term));
            }
            // A term in some lanes only may hide a term that is in all.
            if let Some(place) = terms.iter().position(|t| self.can_open(t)) {
                let term = terms.swap_remove(place);
                self.open(term, &mut terms);
            } else if let Some(opened) = self.opened(&terms) {
                terms = opened;
            } else {
                break;
            }
        }
        let mut sum = reduced.map(|id| self.new.apply(Op::ReduceAdd, &[id]));
        for term in terms {
            let id = self.broadcast(term.at);
            sum = Some(self.add(sum, (term.negative, id)));
        }
        sum.unwrap_or_else(|| self.new.constant(0.0))
    }

    fn add(&mut self, sum: Option<NodeId>, (negative, term): (bool, NodeId)) -> NodeId {
        match (sum, negative) {
            (Some(sum), false) => self.new.apply(Op::Add, &[sum, term]),
            (Some(sum), true) => self.new.apply(Op::Sub, &[sum, term]),
            (None, false) => term,
            (None, true) => self.new.apply(Op::Neg, &[term]),
        }
    }

    /// Whether a term in one lane is a sum of something in every lane and something in this one.
    fn can_open(&self, term: &Term) -> bool {
        let node = &self.graph.nodes()[term.from];
        let in_lane = matches!(term.at, At::Lane(..)) && matches!(node.op, Op::Add | Op::Sub);
        in_lane && node.operands().any(|o| matches!(self.at[o.index()], At::All(_)))
    }

    /// The terms of a sum, with nested sums expanded.
    fn open(&self, root: Term, terms: &mut Vec<Term>) {
        let mut stack = vec![root];
        while let Some(Term { negative, from, .. }) = stack.pop() {
            let node = &self.graph.nodes()[from];
            for (place, operand) in node.operands().enumerate() {
                let minus = node.op == Op::Neg || (node.op == Op::Sub && place == 1);
                let term = Term { negative: negative != minus, at: self.at[operand.index()], from: operand.index() };
                if term.at == At::Sum { stack.push(term) } else { terms.push(term) }
            }
        }
    }

    /// The terms with sums of single lanes opened where other lanes have their terms one by one, as
    /// the lane whose sum was begun first has. Opens as many as leave the fewest terms that are not
    /// in all lanes. `None` if it opens none.
    fn opened(&self, terms: &[Term]) -> Option<Vec<Term>> {
        let mut opened = terms.to_vec();
        let mut tally = self.tally(&opened);
        let (mut best, mut fewest) = (None, tally.alone());
        while let Some(place) = opened.iter().position(|t| self.is_sum_in_lane(t) && !tally.in_all_lanes(t)) {
            let term = opened.swap_remove(place);
            self.open(term, &mut opened);
            if opened.len() > MANY {
                break;
            }
            tally = self.tally(&opened);
            if tally.alone() < fewest {
                (best, fewest) = (Some(opened.clone()), tally.alone());
            }
        }
        best
    }

    /// Whether a term is a sum in its lane.
    fn is_sum_in_lane(&self, term: &Term) -> bool {
        matches!(term.at, At::Lane(..)) && matches!(self.graph.nodes()[term.from].op, Op::Add | Op::Sub | Op::Neg)
    }

    fn tally(&self, terms: &[Term]) -> Tally {
        let mut tally = Tally { width: self.new.lanes().width, terms: terms.len(), places: HashMap::new() };
        for term in terms {
            if let At::Lane(id, lane) = term.at {
                tally.places.entry((id, term.negative)).or_default()[lane] += 1;
            }
        }
        tally
    }

    /// Takes out a term that is there in all lanes with the same sign.
    fn take_all_lanes(&self, terms: &mut Vec<Term>) -> Option<(bool, NodeId)> {
        let width = self.new.lanes().width;
        for first in terms.iter() {
            let At::Lane(id, _) = first.at else { continue };
            let of_lane = |lane| terms.iter().position(|t| t.at == At::Lane(id, lane) && t.negative == first.negative);
            let places: Option<Vec<usize>> = (0..width).map(of_lane).collect();
            if let Some(mut places) = places {
                let negative = first.negative;
                places.sort_unstable();
                places.into_iter().rev().for_each(|k| {
                    terms.remove(k);
                });
                return Some((negative, id));
            }
        }
        None
    }
}
