//! The order of statements: sines and cosines in batches, everything else as it was traced.

use crate::graph::{Graph, NodeId, Op};

/// A step of the function.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Step {
    /// One node.
    Node(usize),
    /// The sines and cosines of some angles at once.
    Batch(Vec<Angle>),
}

/// An angle of a batch: its node and, where they are used, those of its sine and cosine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Angle {
    pub(crate) angle: NodeId,
    pub(crate) sin: Option<usize>,
    pub(crate) cos: Option<usize>,
}

/// All nodes as steps. A batch comes as soon as its angles are known: first the nodes that they
/// need, then the batch, then the rest in its order.
pub(crate) fn order(graph: &Graph) -> Vec<Step> {
    let stages = stages(graph);
    let last = stages.iter().copied().max().unwrap_or(0);
    let mut steps = Vec::with_capacity(graph.nodes().len());
    let mut done = vec![false; graph.nodes().len()];
    for stage in 1..=last {
        let angles = angles(graph, &stages, stage);
        needed(graph, &angles, &mut done).into_iter().for_each(|k| steps.push(Step::Node(k)));
        angles.iter().flat_map(|a| [a.sin, a.cos]).flatten().for_each(|k| done[k] = true);
        steps.push(Step::Batch(angles));
    }
    steps.extend((0..graph.nodes().len()).filter(|&k| !done[k]).map(Step::Node));
    steps
}

/// Length of the longest chain of sines or cosines up to each node, itself included.
fn stages(graph: &Graph) -> Vec<u32> {
    let mut stages: Vec<u32> = Vec::with_capacity(graph.nodes().len());
    for node in graph.nodes() {
        let below = node.operands().map(|a| stages[a.index()]).max().unwrap_or(0);
        stages.push(below + u32::from(matches!(node.op, Op::Sin | Op::Cos)));
    }
    stages
}

/// The angles of one stage, in the order in which their sines and cosines are needed.
fn angles(graph: &Graph, stages: &[u32], stage: u32) -> Vec<Angle> {
    let mut angles: Vec<Angle> = Vec::new();
    let mut place = std::collections::HashMap::new();
    for (k, node) in graph.nodes().iter().enumerate() {
        if stages[k] != stage || !matches!(node.op, Op::Sin | Op::Cos) {
            continue;
        }
        let angle = NodeId(node.args[0]);
        let at = *place.entry(angle).or_insert_with(|| {
            angles.push(Angle { angle, sin: None, cos: None });
            angles.len() - 1
        });
        let slot = if node.op == Op::Sin { &mut angles[at].sin } else { &mut angles[at].cos };
        *slot = Some(k);
    }
    let first = first_uses(graph);
    let at = |k: Option<usize>| k.map_or(usize::MAX, |k| first[k]);
    angles.sort_by_key(|a| at(a.sin).min(at(a.cos)));
    angles
}

/// The first node that uses each node.
fn first_uses(graph: &Graph) -> Vec<usize> {
    let mut first = vec![usize::MAX; graph.nodes().len()];
    for (k, node) in graph.nodes().iter().enumerate().rev() {
        node.operands().for_each(|a| first[a.index()] = k);
    }
    first
}

/// The nodes that the angles need and that are not done yet, in order. Marks them done.
fn needed(graph: &Graph, angles: &[Angle], done: &mut [bool]) -> Vec<usize> {
    let mut wanted = vec![false; graph.nodes().len()];
    angles.iter().for_each(|a| wanted[a.angle.index()] = true);
    for k in (0..graph.nodes().len()).rev().filter(|&k| !done[k]).collect::<Vec<_>>() {
        if wanted[k] {
            graph.nodes()[k].operands().for_each(|a| wanted[a.index()] = true);
        }
    }
    let list: Vec<usize> = (0..wanted.len()).filter(|&k| wanted[k] && !done[k]).collect();
    list.iter().for_each(|&k| done[k] = true);
    list
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_node_comes_once_and_after_what_it_needs() {
        let mut g = Graph::default();
        let (x, y) = (g.input(0, 0), g.input(0, 1));
        let s = g.apply(Op::Sin, &[x]);
        let t = g.apply(Op::Add, &[s, y]);
        let (u, w) = (g.apply(Op::Cos, &[t]), g.apply(Op::Cos, &[x]));
        g.outputs = vec![g.clone().apply(Op::Mul, &[u, w])];
        let mut seen = vec![false; g.nodes().len()];
        let mut see = |k: usize| {
            assert!(g.nodes()[k].operands().all(|a| seen[a.index()]) && !seen[k], "node {k}");
            seen[k] = true;
        };
        let steps = order(&g);
        assert_eq!(steps.iter().filter(|s| matches!(s, Step::Batch(_))).count(), 2);
        for step in steps {
            match step {
                Step::Node(k) => see(k),
                Step::Batch(angles) => angles.iter().flat_map(|a| [a.sin, a.cos]).flatten().for_each(&mut see),
            }
        }
        assert!(seen.iter().all(|s| *s));
    }
}
