//! Folding where nodes are born: zeros and ones of a robot's file never become nodes.
//!
//! Each rule is exact in real arithmetic for finite values; in floating point, an inexact rule only
//! leaves out a rounding.

use super::evaluate::value;
use super::{Graph, MOST, NodeId, Op, Value};

/// The node for `op` on `x`, made as simple as its operands allow.
pub(super) fn fold(g: &mut Graph, op: Op, x: &[NodeId]) -> NodeId {
    if let Some(value) = constant_value(g, op, x) {
        return g.lane_constant(value);
    }
    match op {
        Op::Add => add(g, x[0], x[1]),
        Op::Sub => sub(g, x[0], x[1]),
        Op::Mul => mul(g, x[0], x[1]),
        Op::Div => div(g, x[0], x[1]),
        Op::Neg => neg(g, x[0]),
        Op::Sin => sin(g, x[0]),
        Op::Cos => cos(g, x[0]),
        Op::Select => select(g, x),
        _ => g.exactly(op, x),
    }
}

fn constant_value(g: &Graph, op: Op, x: &[NodeId]) -> Option<Value> {
    if matches!(op, Op::Broadcast | Op::ReduceAdd | Op::List) {
        return None;
    }
    let mut operands = [[0.0; MOST]; 3];
    for (operand, id) in operands.iter_mut().zip(x) {
        *operand = g.constant_value(*id)?;
    }
    let found = std::array::from_fn(|k| value(op, operands.map(|x| x[k])));
    found.iter().all(|y| y.is_finite()).then_some(found)
}

fn is(g: &Graph, x: NodeId, value: f64) -> bool {
    g.node(x).constant() == Some(value)
}

/// y where x is −y: of a negation its operand, of a negative constant its magnitude.
fn negated(g: &mut Graph, x: NodeId) -> Option<NodeId> {
    let node = g.node(x);
    match node.op {
        Op::Neg => Some(NodeId(node.args[0])),
        Op::Constant => node.constant().filter(|c| *c < 0.0).map(|c| g.constant(-c)),
        _ => None,
    }
}

fn add(g: &mut Graph, a: NodeId, b: NodeId) -> NodeId {
    if is(g, a, 0.0) {
        return b;
    }
    if is(g, b, 0.0) {
        return a;
    }
    // a + (−b) = a − b;  (−a) + b = b − a
    if let Some(b) = negated(g, b) {
        return sub(g, a, b);
    }
    if let Some(a) = negated(g, a) {
        return sub(g, b, a);
    }
    if let Some(rest) = without_common(g, a, b, false) {
        return rest;
    }
    g.exactly(Op::Add, &[a, b])
}

fn sub(g: &mut Graph, a: NodeId, b: NodeId) -> NodeId {
    if a == b {
        return g.constant(0.0);
    }
    if is(g, b, 0.0) {
        return a;
    }
    if is(g, a, 0.0) {
        return neg(g, b);
    }
    // a − (−b) = a + b;  (−a) − b = −(a + b)
    if let Some(b) = negated(g, b) {
        return add(g, a, b);
    }
    if let Some(a) = negated(g, a) {
        let sum = add(g, a, b);
        return neg(g, sum);
    }
    if let Some(rest) = without_common(g, a, b, true) {
        return rest;
    }
    // One subtraction serves for both signs.
    if let Some(other) = g.find(Op::Sub, b, a) {
        return g.exactly(Op::Neg, &[other]);
    }
    g.exactly(Op::Sub, &[a, b])
}

/// A node with a sign, true for minus.
type Signed = (bool, NodeId);

/// a ± b for a and b of one or two terms each, where a term of one cancels a term of the other: the
/// sum of the remaining terms.
fn without_common(g: &mut Graph, a: NodeId, b: NodeId, minus: bool) -> Option<NodeId> {
    let (left, right) = (terms(g, false, a), terms(g, minus, b));
    let opposite = |x: &Signed, y: &Signed| x.0 != y.0 && x.1 == y.1;
    let (i, j) =
        (0..2).flat_map(|i| (0..2).map(move |j| (i, j))).find(|&(i, j)| left[i].zip(right[j]).is_some_and(|(x, y)| opposite(&x, &y)))?;
    let rest = match (left[1 - i], right[1 - j]) {
        (None, None) => return Some(g.constant(0.0)),
        (Some(x), None) | (None, Some(x)) => x,
        // The positive term comes first.
        (Some(x), Some(y)) if x.0 && !y.0 => return Some(sub(g, y.1, x.1)),
        (Some(x), Some(y)) if x.0 == y.0 => (x.0, add(g, x.1, y.1)),
        (Some(x), Some(y)) => return Some(sub(g, x.1, y.1)),
    };
    Some(if rest.0 { neg(g, rest.1) } else { rest.1 })
}

/// The terms of a sum of two, or the node itself, with a sign in front.
fn terms(g: &Graph, minus: bool, x: NodeId) -> [Option<Signed>; 2] {
    let node = g.node(x);
    let term = |k: usize, other: bool| Some((minus != other, NodeId(node.args[k])));
    match node.op {
        Op::Add => [term(0, false), term(1, false)],
        Op::Sub => [term(0, false), term(1, true)],
        _ => [Some((minus, x)), None],
    }
}

fn mul(g: &mut Graph, a: NodeId, b: NodeId) -> NodeId {
    // A constant comes first.
    let (a, b) = if g.node(b).op == Op::Constant { (b, a) } else { (a, b) };
    if is(g, a, 0.0) {
        return a;
    }
    if is(g, a, 1.0) {
        return b;
    }
    // Signs move outward, so that products are shared whatever their sign.
    let (minus_a, minus_b) = (negated(g, a), negated(g, b));
    if minus_a.is_some() || minus_b.is_some() {
        let product = mul(g, minus_a.unwrap_or(a), minus_b.unwrap_or(b));
        return if minus_a.is_some() == minus_b.is_some() { product } else { neg(g, product) };
    }
    // c · (d · x) = (c d) · x
    if let (Some(c), node) = (g.node(a).constant(), g.node(b))
        && node.op == Op::Mul
        && let Some(d) = g.node(NodeId(node.args[0])).constant().or_else(|| g.node(NodeId(node.args[1])).constant())
        && (c * d).is_normal()
    {
        let x = if g.node(NodeId(node.args[0])).op == Op::Constant { node.args[1] } else { node.args[0] };
        let cd = g.constant(c * d);
        return mul(g, cd, NodeId(x));
    }
    g.exactly(Op::Mul, &[a, b])
}

fn div(g: &mut Graph, a: NodeId, b: NodeId) -> NodeId {
    if is(g, b, 1.0) || is(g, a, 0.0) {
        return a;
    }
    g.exactly(Op::Div, &[a, b])
}

fn neg(g: &mut Graph, a: NodeId) -> NodeId {
    let node = g.node(a);
    match node.op {
        Op::Neg => NodeId(node.args[0]),
        Op::Constant => {
            let c = node.constant().unwrap_or_default();
            g.constant(-c)
        }
        // −(a − b) = b − a
        Op::Sub => match g.find(Op::Sub, NodeId(node.args[1]), NodeId(node.args[0])) {
            Some(other) => other,
            None => g.exactly(Op::Neg, &[a]),
        },
        _ => g.exactly(Op::Neg, &[a]),
    }
}

fn sin(g: &mut Graph, a: NodeId) -> NodeId {
    match negated(g, a) {
        Some(x) => {
            let s = g.exactly(Op::Sin, &[x]);
            neg(g, s)
        }
        None => g.exactly(Op::Sin, &[a]),
    }
}

fn cos(g: &mut Graph, a: NodeId) -> NodeId {
    let x = negated(g, a).unwrap_or(a);
    g.exactly(Op::Cos, &[x])
}

fn select(g: &mut Graph, x: &[NodeId]) -> NodeId {
    if x[1] == x[2] {
        return x[1];
    }
    match g.node(x[0]).constant() {
        Some(1.0) => x[1],
        Some(_) => x[2],
        None => g.exactly(Op::Select, x),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn xy() -> (Graph, NodeId, NodeId) {
        let mut g = Graph::default();
        let (x, y) = (g.input(0, 0), g.input(0, 1));
        (g, x, y)
    }

    #[test]
    fn zeros_and_ones_never_become_nodes() {
        let (mut g, x, _) = xy();
        let (zero, one, minus) = (g.constant(0.0), g.constant(1.0), g.constant(-1.0));
        let before = g.nodes().len();
        assert_eq!(g.apply(Op::Add, &[x, zero]), x);
        assert_eq!(g.apply(Op::Sub, &[x, zero]), x);
        assert_eq!(g.apply(Op::Mul, &[one, x]), x);
        assert_eq!(g.apply(Op::Mul, &[x, zero]), zero);
        assert_eq!(g.apply(Op::Sub, &[x, x]), zero);
        assert_eq!(g.nodes().len(), before);
        let negative = g.apply(Op::Mul, &[x, minus]);
        assert_eq!(g.node(negative).op, Op::Neg);
        assert_eq!(g.apply(Op::Neg, &[negative]), x);
    }

    #[test]
    fn every_rule_keeps_the_value() {
        let ops = [Op::Add, Op::Sub, Op::Mul, Op::Div];
        let unary = [Op::Neg, Op::Sin, Op::Cos];
        let (mut g, x, y) = xy();
        let values = [0.7, -1.3];
        let at = |_: usize, k: usize| values[k];
        let mut pool = vec![x, y];
        pool.extend([0.0, 1.0, -1.0, 2.5, -0.5].map(|c| g.constant(c)));
        pool.extend(pool.clone().iter().flat_map(|&a| unary.map(|op| g.apply(op, &[a]))).collect::<Vec<_>>());
        let found = |g: &mut Graph, id| {
            g.outputs = vec![id];
            g.evaluate(at)[0]
        };
        for &a in &pool {
            for &b in &pool {
                for op in ops {
                    let (va, vb) = (found(&mut g, a), found(&mut g, b));
                    if op == Op::Div && vb == 0.0 {
                        continue;
                    }
                    let id = g.apply(op, &[a, b]);
                    let (got, expected) = (found(&mut g, id), value(op, [va, vb, 0.0]));
                    assert!((got - expected).abs() <= 4e-16 * expected.abs().max(1e-16), "{op:?} {va} {vb}: {got} {expected}");
                }
            }
        }
        g.verify().unwrap();
    }

    #[test]
    fn what_two_sums_have_in_common_is_not_subtracted() {
        let (mut g, x, y) = xy();
        let z = g.input(0, 2);
        let (xy, xz) = (g.apply(Op::Add, &[x, y]), g.apply(Op::Add, &[x, z]));
        let (y_z, x_y) = (g.apply(Op::Sub, &[y, z]), g.apply(Op::Sub, &[x, y]));
        assert_eq!(g.apply(Op::Sub, &[xy, xz]), y_z);
        assert_eq!(g.apply(Op::Sub, &[xy, y]), x);
        assert_eq!(g.apply(Op::Add, &[x_y, y]), x);
        assert_eq!(g.apply(Op::Sub, &[y, xy]), g.apply(Op::Neg, &[x]));
        let minus = g.apply(Op::Sub, &[x_y, xz]);
        let sum = g.apply(Op::Add, &[y, z]);
        assert_eq!(minus, g.apply(Op::Neg, &[sum]));
    }

    #[test]
    fn sums_of_sums_keep_their_value_whatever_their_signs() {
        let (mut g, x, y) = xy();
        let z = g.input(0, 2);
        let values = [0.7, -1.3, 2.9];
        let terms = [x, y, z].into_iter().zip(values);
        let pairs = terms.clone().flat_map(|a| terms.clone().map(move |b| (a, b)));
        let sums: Vec<(NodeId, f64)> =
            pairs.flat_map(|((a, va), (b, vb))| [(g.apply(Op::Add, &[a, b]), va + vb), (g.apply(Op::Sub, &[a, b]), va - vb)]).collect();
        let mut expected = Vec::new();
        for &(a, va) in &sums {
            for &(b, vb) in &sums {
                let [sum, difference] = [Op::Add, Op::Sub].map(|op| g.apply(op, &[a, b]));
                g.outputs.extend([sum, difference]);
                expected.extend([va + vb, va - vb]);
            }
        }
        for (found, expected) in g.evaluate(|_, k| values[k]).into_iter().zip(expected) {
            assert!((found - expected).abs() < 1e-14, "{found} {expected}");
        }
    }

    #[test]
    fn a_sign_goes_out_of_a_sine_and_is_nothing_to_a_cosine() {
        let (mut g, x, _) = xy();
        let minus = g.apply(Op::Neg, &[x]);
        let [sin, cos] = [Op::Sin, Op::Cos].map(|op| g.apply(op, &[x]));
        assert_eq!(g.apply(Op::Sin, &[minus]), g.apply(Op::Neg, &[sin]));
        assert_eq!(g.apply(Op::Cos, &[minus]), cos);
    }

    #[test]
    fn what_may_be_no_number_is_left_to_the_program() {
        let (mut g, x, _) = xy();
        let [zero, one, minus, huge] = [0.0, 1.0, -1.0, 1e200].map(|c| g.constant(c));
        let cases = [(Op::Div, vec![one, zero]), (Op::Div, vec![x, zero]), (Op::Div, vec![x, x]), (Op::Mul, vec![huge, huge])];
        for (op, operands) in cases.into_iter().chain([(Op::Sqrt, vec![minus]), (Op::Sub, vec![x, huge])]) {
            let id = g.apply(op, &operands);
            assert_eq!(g.node(id).op, op);
        }
    }

    #[test]
    fn constant_factors_are_one_unless_that_would_be_nothing_or_too_much() {
        let (mut g, x, _) = xy();
        let scaled = |g: &mut Graph, c: f64, d: f64, x: NodeId| {
            let [c, d] = [c, d].map(|c| g.constant(c));
            let product = g.apply(Op::Mul, &[d, x]);
            g.apply(Op::Mul, &[product, c])
        };
        assert_eq!(scaled(&mut g, 2.0, 3.0, x), scaled(&mut g, 1.0, 6.0, x));
        // Also for a constant that is older than its factor.
        let late = g.input(0, 2);
        assert_eq!(scaled(&mut g, 2.0, 3.0, late), scaled(&mut g, 1.0, 6.0, late));
        g.outputs = vec![scaled(&mut g, 1e200, 1e200, x), scaled(&mut g, 1e-200, 1e-200, late)];
        let found = g.evaluate(|_, k| [1e-300, 0.0, 1e300][k]);
        assert!((found[0] / 1e100 - 1.0).abs() < 1e-15 && (found[1] / 1e-100 - 1.0).abs() < 1e-15, "{found:?}");
    }

    #[test]
    fn a_choice_that_is_known_is_made() {
        let (mut g, x, y) = xy();
        let [zero, one, minus] = [0.0, 1.0, -1.0].map(|c| g.constant(c));
        for (of, chosen) in [(zero, y), (one, x), (minus, y)] {
            let positive = g.apply(Op::Positive, &[of]);
            assert_eq!(g.apply(Op::Select, &[positive, x, y]), chosen);
        }
        let positive = g.apply(Op::Positive, &[x]);
        assert_eq!(g.apply(Op::Select, &[positive, y, y]), y);
    }

    #[test]
    fn zero_has_one_node_whatever_its_sign() {
        let mut g = Graph::in_lanes(2);
        assert_eq!(g.constant(-0.0), g.constant(0.0));
        let of_lanes = [1.0, -1.0].map(|one| g.lane_constant([-0.0 * one, 1.0, 0.0, 0.0]));
        assert_eq!(of_lanes[0], of_lanes[1]);
    }

    #[test]
    fn an_expression_and_its_negative_share_their_operation() {
        let (mut g, x, y) = xy();
        let d = g.apply(Op::Sub, &[x, y]);
        let e = g.apply(Op::Sub, &[y, x]);
        assert_eq!(g.apply(Op::Neg, &[d]), e);
        assert_eq!(g.counts().of(Op::Sub), 1);
        let minus_x = g.apply(Op::Neg, &[x]);
        let p = g.apply(Op::Mul, &[minus_x, y]);
        let q = g.apply(Op::Mul, &[x, y]);
        assert_eq!(g.apply(Op::Neg, &[q]), p);
    }
}
