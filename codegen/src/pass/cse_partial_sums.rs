//! Partial sums.

use std::collections::HashMap;

use super::sums::{Rebuild, Term, flatten, inner, is_sum, open, uses_in_sums};
use super::{cost, dce};
use crate::graph::{Graph, NodeId, Op};

/// Most terms of a searched sum: longer sums have too many pairs.
const MOST: usize = 32;

/// Common-subexpression elimination of partial sums: computes x + y once where several sums have
/// both, which saves an instruction in each but the first.
///
/// The most frequent pairs come first; the remaining terms are searched again, with the pairs as
/// terms. Re-association changes results by rounding only.
pub fn cse_partial_sums(graph: &Graph) -> Graph {
    let inner = inner(graph);
    let nodes = graph.nodes();
    let sums = (0..nodes.len()).map(|k| if is_sum(&nodes[k]) && !inner[k] { flatten(graph, &inner, k) } else { Vec::new() }).collect();
    let mut sums = Sums { fused: fused(graph), changed: vec![false; nodes.len()], sums, pairs: Vec::new() };
    while sums.round() {}
    if sums.pairs.is_empty() {
        return graph.clone();
    }
    let mut gone = vec![false; nodes.len()];
    sums.changed.iter().enumerate().filter(|(_, changed)| **changed).for_each(|(k, _)| open(graph, &inner, k, &mut gone));
    let mut built = vec![None; sums.pairs.len()];
    let new = dce(&Rebuild::graph(graph, &gone, |rebuild, k| sums.changed[k].then(|| sums.built(&sums.sums[k], rebuild, &mut built))));
    // Signs that pairs need may cost more than they save.
    if cost(&new) <= cost(graph) { new } else { graph.clone() }
}

/// Whether each node is a product that multiply-adds take in.
fn fused(graph: &Graph) -> Vec<bool> {
    let uses = graph.uses().into_iter().zip(uses_in_sums(graph));
    graph.nodes().iter().zip(uses).map(|(n, (all, in_sums))| n.op == Op::Mul && all == in_sums).collect()
}

/// Two terms of a sum, the first of them positive.
type Pair = [Term; 2];

/// Two terms whatever the sign of both.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
struct Key {
    nodes: [usize; 2],
    /// Whether their signs differ.
    apart: bool,
}

/// The sums of a graph; terms with numbers from the graph's length on represent pairs.
struct Sums {
    fused: Vec<bool>,
    sums: Vec<Vec<Term>>,
    /// Sums whose terms have changed.
    changed: Vec<bool>,
    pairs: Vec<Pair>,
}

impl Sums {
    /// Extracts pairs that several sums share; returns whether there were any.
    fn round(&mut self) -> bool {
        let mut places: HashMap<Key, Vec<usize>> = HashMap::new();
        let common = self.common();
        for (k, sum) in self.sums.iter().enumerate().filter(|(_, sum)| sum.len() <= MOST) {
            let terms: Vec<Term> = sum.iter().copied().filter(|t| common[t.node]).collect();
            keys(&terms).for_each(|key| places.entry(key).or_default().push(k));
        }
        let mut pairs: Vec<(Key, Vec<usize>)> = places.into_iter().filter(|(key, at)| self.gain(*key, at.len()) > 0).collect();
        pairs.sort_by_key(|(key, at)| (std::cmp::Reverse(self.gain(*key, at.len())), *key));
        let before = self.pairs.len();
        pairs.into_iter().for_each(|(key, at)| self.take_out(key, &at));
        self.pairs.len() > before
    }

    /// Whether several sums have each term.
    fn common(&self) -> Vec<bool> {
        let mut sums = vec![0; self.changed.len() + self.pairs.len()];
        self.sums.iter().flatten().for_each(|t| sums[t.node] += 1);
        sums.into_iter().map(|n| n > 1).collect()
    }

    /// Instructions saved if `sums` sums share a pair: each adds one term less, and the pair takes
    /// one for each of its products, at least one.
    fn gain(&self, key: Key, sums: usize) -> usize {
        let products = key.nodes.iter().filter(|&&n| self.fused.get(n) == Some(&true)).count();
        sums.saturating_sub(products.max(1))
    }

    /// Replaces the terms of a pair by the pair, in those of the sums that still have them.
    fn take_out(&mut self, key: Key, at: &[usize]) {
        let at: Vec<usize> = at.iter().copied().filter(|&k| keys(&self.sums[k]).any(|other| other == key)).collect();
        if self.gain(key, at.len()) == 0 {
            return;
        }
        // Signs as in a sum of these two alone, if there is one: it then needs no sign.
        let alone = at.iter().find(|&&k| self.sums[k].len() == 2).unwrap_or(&at[0]);
        let negative = |sum: &[Term], node: usize| sum.iter().any(|t| t.node == node && t.negative);
        let turned = self.sums[*alone].len() > 2 && negative(&self.sums[*alone], key.nodes[0]);
        let pair = key.nodes.map(|node| Term { negative: negative(&self.sums[*alone], node) != turned, node });
        let number = self.changed.len() + self.pairs.len();
        for k in at {
            let negative = negative(&self.sums[k], pair[0].node) != pair[0].negative;
            self.sums[k].retain(|t| !key.nodes.contains(&t.node));
            self.sums[k].push(Term { negative, node: number });
            self.changed[k] = true;
        }
        self.pairs.push(pair);
    }

    /// The node of a sum; `pairs` are those that are built already.
    fn built(&self, terms: &[Term], rebuild: &mut Rebuild, pairs: &mut Vec<Option<NodeId>>) -> NodeId {
        let mut parts = Vec::new();
        for term in terms {
            let node = match term.node.checked_sub(self.changed.len()) {
                None => rebuild.ids[term.node],
                Some(pair) => {
                    let node = pairs[pair].unwrap_or_else(|| self.built(&self.pairs[pair], rebuild, pairs));
                    pairs[pair] = Some(node);
                    node
                }
            };
            parts.push((term.negative, node));
        }
        rebuild.add(&parts)
    }
}

/// The pairs of some terms of a sum, without those of a node that is a term twice.
fn keys(terms: &[Term]) -> impl Iterator<Item = Key> + '_ {
    let once = move |node: usize| terms.iter().filter(|t| t.node == node).count() == 1;
    let pairs = terms.iter().enumerate().flat_map(|(j, b)| terms[..j].iter().map(move |a| (a, b)));
    pairs
        .filter(move |(a, b)| once(a.node) && once(b.node))
        .map(|(a, b)| Key { nodes: [a.node.min(b.node), a.node.max(b.node)], apart: a.negative != b.negative })
}

#[cfg(test)]
mod tests {
    use super::super::fma_contract;
    use super::*;

    fn at(_: usize, k: usize) -> f64 {
        [0.3, -0.8, 1.7, 2.9, -0.45, 0.62][k]
    }

    /// Sums of inputs, each with its sign: k stands for input k − 1.
    fn graph(sums: &[&[i32]]) -> Graph {
        let mut g = Graph::default();
        for sum in sums {
            let zero = g.constant(0.0);
            let total = sum.iter().fold(zero, |total, &k| {
                let x = g.input(0, k.unsigned_abs() as usize - 1);
                if total == zero && k > 0 { x } else { g.exactly(if k > 0 { Op::Add } else { Op::Sub }, &[total, x]) }
            });
            g.outputs.push(total);
        }
        g
    }

    fn check(g: &Graph, instructions: u64) {
        let new = cse_partial_sums(g);
        new.verify().unwrap();
        let new = dce(&fma_contract(&new));
        assert_eq!(new.counts().instructions(), instructions);
        for (a, b) in new.evaluate(at).into_iter().zip(g.evaluate(at)) {
            assert!((a - b).abs() < 1e-15, "{a} {b}");
        }
    }

    #[test]
    fn what_two_sums_have_in_common_is_added_once() {
        check(&graph(&[&[1, 2, 3], &[1, 2, 4]]), 3);
        check(&graph(&[&[1, 2, 3], &[4, 2, 1]]), 3);
    }

    #[test]
    fn signs_may_all_be_turned() {
        check(&graph(&[&[1, -2, 3], &[4, 2, -1]]), 3);
        check(&graph(&[&[1, 2, 3], &[4, -2, -1], &[5, 1, 2]]), 4);
    }

    #[test]
    fn a_difference_is_not_a_sum() {
        check(&graph(&[&[1, 2, 3], &[1, -2, 4]]), 4);
    }

    #[test]
    fn a_sum_of_a_pair_alone_is_the_pair() {
        check(&graph(&[&[3, 2, 1], &[1, 2]]), 2);
        check(&graph(&[&[3, 2, -1], &[1, -2]]), 2);
    }

    #[test]
    fn pairs_have_pairs_in_common() {
        check(&graph(&[&[1, 2, 3, 5], &[1, 2, 3, 6], &[3, 2, 1, 4]]), 5);
    }

    #[test]
    fn a_term_that_stands_twice_is_left_alone() {
        check(&graph(&[&[2, 1, 1, 1], &[3, 1, 1, 1]]), 5);
        check(&graph(&[&[3, 1, 1, 2], &[4, 1, 2, 3], &[5, 1, 1, 2]]), 8);
    }

    #[test]
    fn two_products_need_three_sums() {
        for (sums, instructions) in [(2, 4), (3, 5)] {
            let mut g = Graph::default();
            let [a, b, c] = [0, 1, 2].map(|k| g.input(0, k));
            let [ab, bc] = [[a, b], [b, c]].map(|p| g.apply(Op::Mul, &p));
            for k in 3..3 + sums {
                let x = g.input(0, k);
                let two = g.exactly(Op::Add, &[x, ab]);
                let three = g.exactly(Op::Sub, &[two, bc]);
                g.outputs.push(three);
            }
            check(&g, instructions);
            assert_eq!(cse_partial_sums(&g).nodes().len() == g.nodes().len(), sums == 2);
        }
    }
}
