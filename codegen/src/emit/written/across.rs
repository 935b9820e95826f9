//! Sums over the lanes of several vectors that are results and nothing else: up to four are added up together, which takes half as many instructions as one after the other.

use std::collections::HashMap;

use crate::emit::written::rows::WIDTH;
use crate::graph::{Graph, Op};

/// Which sums are made together.
pub(crate) struct Across {
    sets: Vec<Vec<usize>>,
    /// The set of a node, and its lane there.
    places: HashMap<usize, (usize, usize)>,
}

impl Across {
    /// In the order of results, so that those of a set stand side by side. A sum that is left over is made alone.
    pub(crate) fn of(graph: &Graph) -> Self {
        let mut used = vec![false; graph.nodes().len()];
        graph.nodes().iter().flat_map(|node| node.operands()).for_each(|o| used[o.index()] = true);
        let mut sums: Vec<usize> = Vec::new();
        for k in graph.outputs.iter().map(|o| o.index()) {
            if graph.nodes()[k].op == Op::Across && !used[k] && !sums.contains(&k) {
                sums.push(k);
            }
        }
        let sets: Vec<Vec<usize>> = sums.chunks(WIDTH).filter(|set| set.len() > 1).map(<[usize]>::to_vec).collect();
        let places = sets.iter().enumerate().flat_map(|(s, set)| set.iter().enumerate().map(move |(lane, &k)| (k, (s, lane))));
        Self { places: places.collect(), sets }
    }

    /// The nodes that are made together with a node, itself among them; none if it is made alone.
    pub(crate) fn set(&self, node: usize) -> &[usize] {
        self.places.get(&node).map_or(&[], |(set, _)| &self.sets[*set])
    }

    /// The name of the vector in which a sum is, and its lane there; of what is made alone its own, and the first.
    pub(crate) fn place(&self, node: usize) -> (String, usize) {
        self.places.get(&node).map_or_else(|| (format!("x{node}"), 0), |(set, lane)| (format!("sums_{set}"), *lane))
    }

    /// The statement that makes the set of a node, given what is added up for each.
    pub(crate) fn statement(&self, node: usize, of: impl Fn(usize) -> String) -> String {
        let set = self.set(node);
        let mut vectors: Vec<String> = set.iter().map(|&k| of(k)).collect();
        let function = if set.len() == 2 { "across_of_two" } else { "across_of_four" };
        if set.len() == 3 {
            vectors.push(vectors[2].clone());
        }
        format!("    let {} = {function}({});\n", self.place(node).0, vectors.join(", "))
    }
}
