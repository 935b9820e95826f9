//! Regions of one turn as a part of the graph around them: those of equations, which derivatives
//! needed as regions.

use std::collections::HashMap;

use super::{dce, splice};
use crate::graph::{CAPTURED, CARRIED, Graph, Kind, NodeId, Op, Region};

/// Puts the bodies of regions of one turn in the place of these, in bodies too.
pub fn inline(graph: &Graph) -> Graph {
    if !graph.has_regions() {
        return graph.clone();
    }
    let graph = &dce(graph).with_regions(|region| Region { body: inline(&region.body), ..region.clone() });
    let mut new = graph.emptied();
    let mut ids: Vec<NodeId> = Vec::with_capacity(graph.nodes().len());
    // The values of a region that is no longer there.
    let mut values: HashMap<u32, Vec<NodeId>> = HashMap::new();
    for (k, node) in graph.nodes().iter().enumerate() {
        let operands: Vec<NodeId> = node.operands().map(|operand| ids[operand.index()]).collect();
        let region = (node.op == Op::Region).then(|| graph.region_of(node));
        ids.push(match (node.op, region) {
            (_, Some(region)) if matches!(region.kind, Kind::ForEach { turns: 1, .. }) => {
                let given: Vec<NodeId> = graph.given(node).iter().map(|id| ids[id.index()]).collect();
                let (captured, table) = (region.carried, region.carried + region.captured);
                let found = splice(&mut new, &region.body, |_, argument, k| {
                    Some(match argument {
                        CARRIED => given[k],
                        CAPTURED => given[captured + k],
                        _ => given[table + k],
                    })
                });
                values.insert(k as u32, found);
                operands[0]
            }
            (Op::RegionValue, _) if values.contains_key(&node.args[0]) => values[&node.args[0]][node.args[1] as usize],
            (Op::List | Op::Region | Op::RegionValue, _) => new.on_operands(*node, &operands),
            _ if operands.is_empty() => new.leaf(*node),
            (op, _) => new.apply(op, &operands),
        });
    }
    new.outputs = graph.outputs.iter().map(|output| ids[output.index()]).collect();
    dce(&new).requested_as(graph)
}
