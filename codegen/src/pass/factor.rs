//! Common factors.

use std::collections::HashMap;

use super::sums::{Term, flatten, inner, is_sum};
use super::{copy, live};
use crate::graph::{Graph, Node, NodeId, Op};

/// Writes a·x + a·y as a·(x + y): a multiplication less and as many additions, and as many instructions once sums are chains of multiply-adds.
///
/// Of products that nothing but the sum uses; of several factors first the one that most of the products have. Re-association changes results by roundings only.
pub fn factor(graph: &Graph) -> Graph {
    let inner = inner(graph);
    let nodes = graph.nodes();
    let single: Vec<bool> = nodes.iter().zip(graph.uses()).map(|(n, uses)| n.op == Op::Mul && uses == 1).collect();
    let sum = |k: usize| (is_sum(&nodes[k]) && !inner[k]).then(|| Sum::of(nodes, flatten(graph, &inner, k), &single));
    let sums: Vec<Option<Sum>> = (0..nodes.len()).map(|k| sum(k).filter(|s| !s.factored.is_empty())).collect();
    let mut gone = vec![false; nodes.len()];
    for (root, sum) in sums.iter().enumerate() {
        let products = sum.iter().flat_map(|s| &s.factored).flat_map(|f| &f.products);
        products.for_each(|p| gone[p.node] = true);
        if sum.is_some() {
            open(nodes, &inner, root, &mut gone);
        }
    }
    live(&rebuilt(graph, &sums, &gone))
}

/// Marks the sums within a sum.
fn open(nodes: &[Node], inner: &[bool], root: usize, gone: &mut [bool]) {
    let mut stack = vec![root];
    while let Some(k) = stack.pop() {
        for a in nodes[k].operands().map(NodeId::index).filter(|&a| inner[a]) {
            gone[a] = true;
            stack.push(a);
        }
    }
}

/// A sum, what has a common factor apart from the rest.
struct Sum {
    rest: Vec<Term>,
    factored: Vec<Factored>,
}

/// Products with a common factor.
struct Factored {
    factor: usize,
    products: Vec<Term>,
}

impl Sum {
    fn of(nodes: &[Node], terms: Vec<Term>, single: &[bool]) -> Self {
        let mut sum = Self { rest: terms, factored: Vec::new() };
        while let Some(factor) = most_common(nodes, sum.rest.iter().filter(|t| single[t.node])) {
            let has_it = |t: &Term| single[t.node] && nodes[t.node].operands().any(|a| a.index() == factor);
            let (products, rest) = sum.rest.into_iter().partition(has_it);
            sum.rest = rest;
            sum.factored.push(Factored { factor, products });
        }
        sum
    }
}

/// The factor that most of the products have, if two have it; of several such the last of the graph, which is known latest.
fn most_common<'a>(nodes: &[Node], products: impl Iterator<Item = &'a Term>) -> Option<usize> {
    let mut counts: HashMap<usize, usize> = HashMap::new();
    for product in products {
        let [a, b, _] = nodes[product.node].args.map(|a| a as usize);
        *counts.entry(a).or_default() += 1;
        if b != a {
            *counts.entry(b).or_default() += 1;
        }
    }
    counts.into_iter().filter(|(_, n)| *n > 1).max_by_key(|(factor, n)| (*n, *factor)).map(|(factor, _)| factor)
}

/// The graph with these sums in place of those of the same place, and without what is gone.
fn rebuilt(graph: &Graph, sums: &[Option<Sum>], gone: &[bool]) -> Graph {
    let nodes = graph.nodes();
    let mut builder = Builder { nodes, new: graph.emptied(), ids: vec![NodeId(u32::MAX); nodes.len()] };
    for (k, node) in nodes.iter().enumerate().filter(|(k, _)| !gone[*k]) {
        builder.ids[k] = match &sums[k] {
            Some(sum) => builder.sum(sum),
            None if node.op.row().arity == 0 => builder.new.leaf(*node),
            None => {
                let operands: Vec<NodeId> = node.operands().map(|a| builder.ids[a.index()]).collect();
                copy(&mut builder.new, *node, &operands)
            }
        };
    }
    builder.new.outputs = graph.outputs.iter().map(|o| builder.ids[o.index()]).collect();
    builder.new
}

struct Builder<'a> {
    nodes: &'a [Node],
    new: Graph,
    /// The new node of each old one that has one.
    ids: Vec<NodeId>,
}

impl Builder<'_> {
    fn sum(&mut self, sum: &Sum) -> NodeId {
        let mut terms: Vec<(bool, NodeId)> = sum.rest.iter().map(|t| (t.negative, self.ids[t.node])).collect();
        for Factored { factor, products } in &sum.factored {
            let negative = products[0].negative;
            let others: Vec<(bool, NodeId)> = products.iter().map(|t| (t.negative != negative, self.other(t.node, *factor))).collect();
            let others = self.add(&others);
            terms.push((negative, self.new.apply(Op::Mul, &[self.ids[*factor], others])));
        }
        self.add(&terms)
    }

    /// What stands beside a factor in a product.
    fn other(&self, product: usize, factor: usize) -> NodeId {
        let [a, b, _] = self.nodes[product].args.map(|a| a as usize);
        self.ids[if a == factor { b } else { a }]
    }

    /// The sum of terms, each with whether it is negative.
    fn add(&mut self, terms: &[(bool, NodeId)]) -> NodeId {
        let first = terms.iter().position(|(negative, _)| !negative).unwrap_or(0);
        let (negative, node) = terms[first];
        let start = if negative { self.new.apply(Op::Neg, &[node]) } else { node };
        let others = terms.iter().enumerate().filter(|(k, _)| *k != first);
        others.fold(start, |sum, (_, (negative, node))| self.new.apply(if *negative { Op::Sub } else { Op::Add }, &[sum, *node]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(_: usize, k: usize) -> f64 {
        [0.3, -0.8, 1.7, 2.9, -0.45, 0.62][k]
    }

    fn check(g: &Graph, mul: u64, add: u64) {
        let new = factor(g);
        new.verify().unwrap();
        let count = |op: Op| new.nodes().iter().filter(|n| n.op == op).count() as u64;
        assert_eq!((count(Op::Mul), count(Op::Add) + count(Op::Sub) + count(Op::Neg)), (mul, add));
        for (a, b) in new.evaluate(at).into_iter().zip(g.evaluate(at)) {
            assert!((a - b).abs() < 1e-15, "{a} {b}");
        }
    }

    /// Every choice of signs of a·b ± a·c ± d·e ± d·f ± a.
    #[test]
    fn each_common_factor_is_multiplied_once_whatever_the_signs() {
        for signs in 0..32 {
            let mut g = Graph::default();
            let [a, b, c, d, e, f] = [0, 1, 2, 3, 4, 5].map(|k| g.input(0, k));
            let products = [[a, b], [a, c], [d, e], [d, f]].map(|p| g.apply(Op::Mul, &p));
            let zero = g.constant(0.0);
            let terms = products.into_iter().chain([a]).enumerate();
            let sum = terms.fold(zero, |sum, (k, term)| g.exactly(if signs >> k & 1 == 0 { Op::Add } else { Op::Sub }, &[sum, term]));
            g.outputs = vec![sum];
            let new = factor(&g);
            new.verify().unwrap();
            assert_eq!(new.nodes().iter().filter(|n| n.op == Op::Mul).count(), 2);
            assert!((new.evaluate(at)[0] - g.evaluate(at)[0]).abs() < 1e-15);
        }
    }

    #[test]
    fn the_factor_that_most_products_have_comes_first() {
        let mut g = Graph::default();
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| g.input(0, k));
        let [ab, bc, ac, ad] = [[a, b], [b, c], [a, c], [a, d]].map(|p| g.apply(Op::Mul, &p));
        let sum = [bc, ac, ad].into_iter().fold(ab, |sum, term| g.apply(Op::Add, &[sum, term]));
        g.outputs = vec![sum];
        check(&g, 2, 3);
    }

    #[test]
    fn a_square_and_a_product_share_the_factor() {
        let mut g = Graph::default();
        let [a, b] = [0, 1].map(|k| g.input(0, k));
        let [aa, ab] = [[a, a], [a, b]].map(|p| g.apply(Op::Mul, &p));
        let difference = g.apply(Op::Sub, &[aa, ab]);
        g.outputs = vec![difference];
        check(&g, 1, 1);
    }

    #[test]
    fn a_product_that_something_else_uses_stays() {
        let mut g = Graph::default();
        let [a, b, c] = [0, 1, 2].map(|k| g.input(0, k));
        let [ab, ac] = [[a, b], [a, c]].map(|p| g.apply(Op::Mul, &p));
        let sum = g.apply(Op::Add, &[ab, ac]);
        g.outputs = vec![sum, ab];
        check(&g, 2, 1);
    }
}
