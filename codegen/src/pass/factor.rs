//! Like terms and common factors.

use std::iter::once;

use super::dce;
use super::sums::{Rebuild, Term, flatten, inner, is_sum, open};
use crate::graph::{Graph, Node, NodeId, Op};

/// Adds the constants of a sum now, leaves out x − x, and writes a·x + a·y as a·(x + y): a
/// multiplication less and as many additions, and as many instructions once sums are chains of
/// multiply-adds.
///
/// Only factors of products that the sum alone uses are taken, most frequent first. Re-association
/// changes results by roundings only.
pub fn factor(graph: &Graph) -> Graph {
    let inner = inner(graph);
    let nodes = graph.nodes();
    let single: Vec<bool> = nodes.iter().zip(graph.uses()).map(|(n, uses)| n.op == Op::Mul && uses == 1).collect();
    let sum = |k: usize| if is_sum(&nodes[k]) && !inner[k] { Sum::of(nodes, flatten(graph, &inner, k), &single) } else { None };
    let sums: Vec<Option<Sum>> = (0..nodes.len()).map(sum).collect();
    if sums.iter().all(Option::is_none) {
        return graph.clone();
    }
    let mut gone = vec![false; nodes.len()];
    for (root, sum) in sums.iter().enumerate().filter_map(|(k, sum)| Some((k, sum.as_ref()?))) {
        sum.factored.iter().flat_map(|f| &f.products).for_each(|p| gone[p.node] = true);
        open(graph, &inner, root, &mut gone);
    }
    dce(&Rebuild::graph(graph, &gone, |rebuild, k| Some(sums[k].as_ref()?.built(rebuild))))
}

/// A sum: constants, terms with a common factor, and the rest.
struct Sum {
    constants: Vec<Term>,
    rest: Vec<Term>,
    factored: Vec<Factored>,
}

/// Products with a common factor.
struct Factored {
    factor: usize,
    products: Vec<Term>,
}

impl Sum {
    /// The sum of these terms, if there is anything to collect.
    fn of(nodes: &[Node], terms: Vec<Term>, single: &[bool]) -> Option<Self> {
        let all = terms.len();
        let (constants, rest) = terms.into_iter().partition(|t| matches!(nodes[t.node].op, Op::Constant | Op::LaneConstant));
        let mut sum = Self { constants, rest: without_opposites(rest), factored: Vec::new() };
        let vanished = sum.constants.len() + sum.rest.len() < all;
        while let Some(factor) = most_common(nodes, sum.rest.iter().filter(|t| single[t.node])) {
            let has_it = |t: &Term| single[t.node] && nodes[t.node].operands().any(|a| a.index() == factor);
            let (products, rest) = sum.rest.into_iter().partition(has_it);
            sum.rest = rest;
            sum.factored.push(Factored { factor, products });
        }
        (vanished || sum.constants.len() > 1 || !sum.factored.is_empty()).then_some(sum)
    }

    fn built(&self, rebuild: &mut Rebuild) -> NodeId {
        // Constants come first: they are one before anything else is added.
        let terms = self.constants.iter().chain(&self.rest);
        let mut terms: Vec<(bool, NodeId)> = terms.map(|t| (t.negative, rebuild.ids[t.node])).collect();
        terms.extend(self.factored.iter().map(|f| (f.products[0].negative, f.built(rebuild))));
        rebuild.add(&terms)
    }
}

impl Factored {
    /// The product with the sign of the first of the products.
    fn built(&self, rebuild: &mut Rebuild) -> NodeId {
        let beside = |rebuild: &Rebuild, product: usize| {
            let [a, b, _] = rebuild.graph.nodes()[product].args.map(|a| a as usize);
            rebuild.ids[if a == self.factor { b } else { a }]
        };
        let others: Vec<(bool, NodeId)> =
            self.products.iter().map(|t| (t.negative != self.products[0].negative, beside(rebuild, t.node))).collect();
        let others = rebuild.add(&others);
        rebuild.new.apply(Op::Mul, &[rebuild.ids[self.factor], others])
    }
}

/// The terms without pairs that cancel.
fn without_opposites(mut terms: Vec<Term>) -> Vec<Term> {
    let mut k = 0;
    while k < terms.len() {
        let Term { negative, node } = terms[k];
        match terms[..k].iter().position(|t| t.node == node && t.negative != negative) {
            Some(other) => {
                terms.remove(k);
                terms.remove(other);
                k -= 1;
            }
            None => k += 1,
        }
    }
    terms
}

/// The factor that most of the products have, if two have it; of several such the last of the
/// graph, which is known latest.
fn most_common<'a>(nodes: &[Node], products: impl Iterator<Item = &'a Term>) -> Option<usize> {
    let factors = products.flat_map(|product| {
        let [a, b, _] = nodes[product.node].args.map(|a| a as usize);
        once(a).chain((a != b).then_some(b))
    });
    let mut factors: Vec<usize> = factors.collect();
    factors.sort_unstable();
    let same = factors.chunk_by(|a, b| a == b).filter(|same| same.len() > 1);
    same.max_by_key(|same| same.len()).map(|same| same[0])
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
    fn constants_are_added_at_once_and_opposites_are_gone() {
        let mut g = Graph::default();
        let [a, b, c] = [0, 1, 2].map(|k| g.input(0, k));
        let [two, three] = [2.0, 3.0].map(|x| g.constant(x));
        let terms = [(Op::Add, b), (Op::Sub, two), (Op::Sub, c), (Op::Sub, b), (Op::Sub, three), (Op::Add, c), (Op::Sub, b)];
        let sum = terms.into_iter().fold(a, |sum, (op, term)| g.exactly(op, &[sum, term]));
        let nothing = g.exactly(Op::Sub, &[a, a]);
        g.outputs = vec![sum, nothing];
        check(&g, 0, 2);
    }

    #[test]
    fn constants_alone_are_collected_and_what_stands_twice_stays() {
        let mut g = Graph::default();
        let [a, b] = [0, 1].map(|k| g.input(0, k));
        let [two, three] = [2.0, 3.0].map(|x| g.constant(x));
        let add = |g: &mut Graph, terms: &[NodeId]| terms[1..].iter().fold(terms[0], |sum, term| g.exactly(Op::Add, &[sum, *term]));
        g.outputs = vec![add(&mut g, &[a, two, b, three]), add(&mut g, &[a, b, a])];
        check(&g, 0, 4);
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
