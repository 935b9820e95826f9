//! A graph on many states: node by node, on a block of states at a time, which shares the cost of
//! finding out what to do.

use std::collections::HashMap;

use super::evaluate::value;
use super::{Graph, Op};

/// States at a time.
const BLOCK: usize = 32;

impl Graph {
    /// The results in each of `states` states, one state after the other in `out`; `input(argument,
    /// index, state)` gives the inputs. For graphs without lanes.
    ///
    /// # Panics
    /// If the graph has lanes, or `out` is shorter than that.
    pub fn evaluate_many(&self, states: usize, input: impl Fn(usize, usize, usize) -> f64, out: &mut [f64]) {
        assert!(self.lanes().width == 1, "a graph without lanes");
        let results = self.outputs.len();
        let mut values = vec![[0.0_f64; BLOCK]; self.nodes().len()];
        let mut regions: HashMap<u32, Vec<Vec<f64>>> = HashMap::new();
        for first in (0..states).step_by(BLOCK) {
            let count = BLOCK.min(states - first);
            for (k, node) in self.nodes().iter().enumerate() {
                let at = |operand: usize| &values[node.args[operand] as usize];
                let mut own = [0.0; BLOCK];
                match node.op {
                    Op::Constant => own = [node.constant().unwrap_or(f64::NAN); BLOCK],
                    Op::Input => {
                        let [argument, index] = [node.args[0] as usize, node.args[1] as usize];
                        own.iter_mut().enumerate().for_each(|(i, x)| *x = input(argument, index, first + i.min(count - 1)));
                    }
                    Op::Add => each(&mut own, at(0), at(1), |a, b| a + b),
                    Op::Sub => each(&mut own, at(0), at(1), |a, b| a - b),
                    Op::Mul => each(&mut own, at(0), at(1), |a, b| a * b),
                    Op::MulAdd | Op::MulSub | Op::NegMulAdd | Op::NegMulSub => {
                        let c = *at(2);
                        each(&mut own, at(0), at(1), |a, b| a * b);
                        let product = own;
                        match node.op {
                            Op::MulAdd => each(&mut own, &product, &c, |p, c| p + c),
                            Op::MulSub => each(&mut own, &product, &c, |p, c| p - c),
                            Op::NegMulAdd => each(&mut own, &product, &c, |p, c| c - p),
                            _ => each(&mut own, &product, &c, |p, c| -p - c),
                        }
                    }
                    Op::Region => {
                        let (region, given) = (self.region_of(node), self.given(node));
                        let of = |i: usize| region.run(&given.iter().map(|id| values[id.index()][i]).collect::<Vec<_>>());
                        regions.insert(k as u32, (0..count).map(of).collect());
                    }
                    Op::RegionValue => {
                        let found = &regions[&node.args[0]];
                        own.iter_mut().zip(found).for_each(|(x, found)| *x = found[node.args[1] as usize]);
                    }
                    op => {
                        let operands = [0, 1, 2].map(|operand| if operand < op.row().arity { at(operand) } else { &[0.0; BLOCK] });
                        own.iter_mut().enumerate().for_each(|(i, x)| *x = value(op, operands.map(|operand| operand[i])));
                    }
                }
                values[k] = own;
            }
            for (r, output) in self.outputs.iter().enumerate() {
                let found = &values[output.index()];
                (0..count).for_each(|i| out[(first + i) * results + r] = found[i]);
            }
        }
    }
}

fn each(out: &mut [f64; BLOCK], a: &[f64; BLOCK], b: &[f64; BLOCK], of: impl Fn(f64, f64) -> f64) {
    (0..BLOCK).for_each(|k| out[k] = of(a[k], b[k]));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pass;

    #[test]
    fn many_states_give_what_each_gives_by_itself() {
        let mut g = Graph::default();
        let (x, y) = (g.input(0, 0), g.input(1, 2));
        let mut found = vec![x, y];
        for op in [Op::Add, Op::Sub, Op::Mul, Op::Div, Op::Atan2] {
            let next = g.apply(op, &[found[found.len() - 1], y]);
            found.push(next);
        }
        for op in [Op::Neg, Op::Sin, Op::Cos, Op::Positive] {
            let next = g.apply(op, &[found[found.len() - 1]]);
            let product = g.apply(Op::Mul, &[next, x]);
            let sum = g.apply(Op::Add, &[product, y]);
            let chosen = g.apply(Op::Select, &[next, sum, x]);
            found.extend([next, product, sum, chosen]);
        }
        g.outputs = found;
        let input = |argument: usize, k: usize, state: usize| 0.3 + 0.7 * argument as f64 + 0.1 * k as f64 + 0.01 * state as f64;
        for graph in [g.clone(), pass::fma_contract(&g)] {
            for states in [0, 1, 31, 32, 70] {
                let mut out = vec![f64::NAN; states * graph.outputs.len()];
                graph.evaluate_many(states, input, &mut out);
                for (state, row) in out.chunks(graph.outputs.len()).enumerate() {
                    assert_eq!(row, graph.evaluate(|argument, k| input(argument, k, state)));
                }
            }
        }
    }
}
