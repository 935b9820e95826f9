//! Regions made small: what does not change from turn to turn is computed before them, and values
//! that nobody reads neither go in nor come out.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use super::{dce, rebuild};
use crate::graph::{CAPTURED, CARRIED, Graph, Kind, Node, NodeId, Op, ROW, Region, Rule};

/// Moves the operations of bodies that only captured values decide out of their regions, from the
/// inmost region outwards. A body that may not run at all keeps its operations.
pub fn hoist(graph: &Graph) -> Graph {
    if !graph.has_regions() {
        return graph.clone();
    }
    let graph = &dce(graph);
    let mut read: HashMap<u32, HashSet<usize>> = HashMap::new();
    for node in graph.nodes().iter().filter(|node| node.op == Op::RegionValue) {
        read.entry(node.args[0]).or_default().insert(node.args[1] as usize);
    }
    let mut places = graph.nodes().iter().enumerate().filter(|(_, node)| node.op == Op::Region).map(|(k, _)| k as u32);
    let mut values: HashMap<NodeId, Vec<Comes>> = HashMap::new();
    let rewrite = |new: &mut Graph, node: Node, operands: &[NodeId]| match node.op {
        Op::Region => {
            let region = graph.region_of(&node);
            let given = new.given(&Node { args: [operands[0].0, node.args[1], 0], ..node });
            let read = places.next().and_then(|place| read.remove(&place)).unwrap_or_default();
            let (region, given, comes) = split(new, &Region { body: hoist(&region.body), ..(**region).clone() }, &given, &read);
            let id = new.region(region, &given);
            values.insert(id, comes);
            id
        }
        Op::RegionValue => match values[&operands[0]][node.args[1] as usize] {
            Comes::Out(k) => new.region_value(operands[0], k),
            Comes::Held(start) => start,
        },
        _ => new.on_operands(node, operands),
    };
    dce(&rebuild(graph, |_| true, rewrite))
}

/// Where a value that comes out of a region comes from.
#[derive(Clone, Copy)]
enum Comes {
    /// Out of the smaller region, under this number.
    Out(usize),
    /// It does not change.
    Held(NodeId),
}

/// What happens to a carried value.
#[derive(Clone, Copy, PartialEq)]
enum Fate {
    Stays,
    Captured,
    Dropped,
}

/// What happens to each carried value: one that no turn changes is captured, one that neither the
/// graph around nor a turn that is left reads is dropped.
fn fates(region: &Region, read: &HashSet<usize>) -> Vec<Fate> {
    let body = &region.body;
    let input = |k: usize| body.nodes().iter().position(|node| node.op == Op::Input && node.args == [CARRIED as u32, k as u32, 0]);
    let inputs: Vec<Option<usize>> = (0..region.carried).map(input).collect();
    let mut needed: Vec<bool> = vec![false; body.nodes().len()];
    let mut lives: Vec<bool> = (0..region.carried).map(|k| read.contains(&k)).collect();
    loop {
        let ends = body.outputs.iter().enumerate().filter(|(k, _)| lives.get(*k).copied().unwrap_or(true));
        ends.for_each(|(_, output)| needed[output.index()] = true);
        for (k, node) in body.nodes().iter().enumerate().rev() {
            if needed[k] {
                node.operands().for_each(|operand| needed[operand.index()] = true);
            }
        }
        let more: Vec<usize> = (0..region.carried).filter(|k| !lives[*k] && inputs[*k].is_some_and(|input| needed[input])).collect();
        if more.is_empty() {
            break;
        }
        more.into_iter().for_each(|k| lives[k] = true);
    }
    let fate = |k: usize| match inputs[k] {
        Some(input) if body.outputs[k].index() == input => Fate::Captured,
        _ if lives[k] => Fate::Stays,
        _ => Fate::Dropped,
    };
    (0..region.carried).map(fate).collect()
}

/// The region without what does not change in it, the values that then go in, and where each of its
/// values comes from.
fn split(outer: &mut Graph, region: &Region, given: &[NodeId], read: &HashSet<usize>) -> (Arc<Region>, Vec<NodeId>, Vec<Comes>) {
    let body = &region.body;
    let (starts, rest) = given.split_at(region.carried);
    let (captured, rest) = rest.split_at(region.captured);
    let fates = fates(region, read);
    let number = |k: usize| fates[..k].iter().filter(|fate| **fate == Fate::Stays).count();
    let carried = number(region.carried);
    let is_end = |k: &usize| fates.get(*k).is_none_or(|fate| *fate == Fate::Stays);
    let ends: Vec<NodeId> = (0..body.outputs.len()).filter(is_end).map(|k| body.outputs[k]).collect();
    let mut needed = vec![false; body.nodes().len()];
    ends.iter().for_each(|output| needed[output.index()] = true);
    for (k, node) in body.nodes().iter().enumerate().rev() {
        if needed[k] {
            node.operands().for_each(|operand| needed[operand.index()] = true);
        }
    }
    let stays = region.kind == Kind::When;
    // The columns that are read
    let columns = if let Kind::ForEach { row, .. } = region.kind { row } else { 0 };
    let reads = |k: usize| {
        let mut inputs = body.nodes().iter().zip(&needed).filter(|(node, needed)| **needed && node.op == Op::Input);
        inputs.any(|(node, _)| node.args == [ROW as u32, k as u32, 0])
    };
    let reads: Vec<bool> = (0..columns).map(reads).collect();
    let column = |k: usize| reads[..k].iter().filter(|reads| **reads).count();
    // The node outside for each one that does not change.
    let mut outside: Vec<Option<NodeId>> = Vec::with_capacity(body.nodes().len());
    let mut inside: Vec<NodeId> = Vec::with_capacity(body.nodes().len());
    let mut split = Split { new: body.emptied(), outer, captured: Vec::new() };
    for (k, node) in body.nodes().iter().enumerate() {
        if !needed[k] {
            outside.push(None);
            inside.push(NodeId(u32::MAX));
            continue;
        }
        let operands: Option<Vec<NodeId>> = node.operands().map(|operand| outside[operand.index()]).collect();
        let is_fixed = !stays && !matches!(node.op, Op::Positive | Op::List | Op::Region | Op::RegionValue);
        let [argument, index, _] = node.args.map(|arg| arg as usize);
        outside.push(match (node.op, operands) {
            (Op::Constant, _) => Some(split.outer.leaf(*node)),
            (Op::Input, _) if argument == CAPTURED => Some(captured[index]),
            (Op::Input, _) if argument == CARRIED && fates[index] == Fate::Captured => Some(starts[index]),
            (Op::Input, _) => None,
            (op, Some(operands)) if is_fixed => Some(split.outer.apply(op, &operands)),
            _ => None,
        });
        // One that stays outside is made where it is read.
        inside.push(match outside[k] {
            Some(_) => NodeId(u32::MAX),
            None if node.op == Op::Input && argument == CARRIED => split.new.input(CARRIED, number(index)),
            None if node.op == Op::Input && argument == ROW => split.new.input(ROW, column(index)),
            None if node.op == Op::Input => split.new.leaf(*node),
            None => {
                let operands: Vec<NodeId> = node.operands().map(|operand| split.read(operand, &outside, &inside)).collect();
                split.new.on_operands(*node, &operands)
            }
        });
    }
    split.new.outputs = ends.iter().map(|output| split.read(*output, &outside, &inside)).collect();
    let Split { new, captured, .. } = split;
    let comes = (0..region.values())
        .map(|k| match fates.get(k) {
            Some(Fate::Captured) => Comes::Held(starts[k]),
            Some(_) => Comes::Out(number(k)),
            None => Comes::Out(k - region.carried + carried),
        })
        .collect();
    let starts: Vec<NodeId> = (0..region.carried).filter(|k| fates[*k] == Fate::Stays).map(|k| starts[k]).collect();
    let (kind, rest) = match region.kind {
        Kind::ForEach { turns, results, .. } => {
            let rest = rest.iter().zip(reads.iter().cycle()).filter(|(_, reads)| **reads).map(|(value, _)| *value).collect();
            (Kind::ForEach { turns, row: column(columns), results }, rest)
        }
        kind => (kind, rest.to_vec()),
    };
    let region = Region { kind, carried, captured: captured.len(), body: new, rule: Rule::OfItsKind };
    (Arc::new(region), [&starts[..], &captured, &rest].concat(), comes)
}

/// The two parts of a body.
struct Split<'a> {
    /// What stays.
    new: Graph,
    /// The graph around it.
    outer: &'a mut Graph,
    /// The values that the new body captures.
    captured: Vec<NodeId>,
}

impl Split<'_> {
    /// A node of the old body as an operand in the new one.
    fn read(&mut self, id: NodeId, outside: &[Option<NodeId>], inside: &[NodeId]) -> NodeId {
        let Some(out) = outside[id.index()] else { return inside[id.index()] };
        let node = self.outer.node(out);
        if node.constant().is_some() {
            return self.new.leaf(node);
        }
        let place = self.captured.iter().position(|other| *other == out).unwrap_or_else(|| {
            self.captured.push(out);
            self.captured.len() - 1
        });
        self.new.input(CAPTURED, place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::CARRIED;

    /// x ← x + sin(a)·b while x < 1, traced without care.
    fn loops() -> Graph {
        let mut body = Graph::default();
        let (x, a, b) = (body.input(CARRIED, 0), body.input(CAPTURED, 0), body.input(CAPTURED, 2));
        let sine = body.apply(Op::Sin, &[a]);
        let step = body.apply(Op::Mul, &[sine, b]);
        let next = body.apply(Op::Add, &[x, step]);
        let one = body.constant(1.0);
        let rest = body.apply(Op::Sub, &[next, one]);
        let ends = body.apply(Op::Positive, &[rest]);
        body.outputs = vec![next, ends];
        let mut graph = Graph::default();
        let given: Vec<NodeId> = (0..4).map(|k| graph.input(0, k)).collect();
        let region = graph
            .region(Arc::new(Region { kind: Kind::Repeat { most: 20 }, carried: 1, captured: 3, body, rule: Rule::OfItsKind }), &given);
        graph.outputs = (0..2).map(|k| graph.region_value(region, k)).collect();
        graph
    }

    #[test]
    fn what_does_not_change_is_computed_once() {
        let graph = loops();
        let less = hoist(&graph);
        less.verify().unwrap();
        let [region] = [less.nodes().iter().find(|node| node.op == Op::Region).unwrap()];
        assert_eq!((less.region_of(region).captured, less.region_of(region).body.counts().of(Op::Sin)), (1, 0));
        for start in [-3.0, 0.2, 0.9] {
            let input = |_, k: usize| [start, 0.7, 0.1, 0.4][k];
            assert_eq!(graph.evaluate(input), less.evaluate(input));
        }
        assert_eq!(graph.evaluate(|_, k| [-90.0, 0.7, 0.1, 0.4][k])[1], 0.0);
    }
}
