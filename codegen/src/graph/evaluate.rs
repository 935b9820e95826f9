//! A graph in any scalar.

use articulated_core::Scalar;

use super::{Graph, MOST, Node, NodeId, Op};

impl Graph {
    /// The results, computed node by node in `S`; `input(argument, index)` gives the inputs. Of results with several lanes, the first. A multiply-add is a product and a sum.
    pub fn evaluate_as<S: Scalar>(&self, input: impl Fn(usize, usize) -> S) -> Vec<S> {
        if self.lanes().width == 1 { self.evaluate_in_lanes::<S, 1>(input) } else { self.evaluate_in_lanes::<S, MOST>(input) }
    }

    fn evaluate_in_lanes<S: Scalar, const N: usize>(&self, input: impl Fn(usize, usize) -> S) -> Vec<S> {
        let mut values: Vec<[S; N]> = Vec::with_capacity(self.nodes().len());
        let mut masks: Vec<Option<[S::Mask; N]>> = Vec::with_capacity(self.nodes().len());
        let mut waves = (None, [(S::zero(), S::zero()); N]);
        for node in self.nodes() {
            let mask = (node.op == Op::Positive).then(|| values[node.args[0] as usize].map(S::positive));
            if matches!(node.op, Op::Sin | Op::Cos) && waves.0 != Some(node.args[0]) {
                // The sine and the cosine of an angle come one after the other.
                waves = (Some(node.args[0]), values[node.args[0] as usize].map(S::sin_cos));
            }
            let value = match node.op {
                Op::Sin => waves.1.map(|w| w.0),
                Op::Cos => waves.1.map(|w| w.1),
                _ => self.value_as(node, &values, &masks, &input),
            };
            values.push(value);
            masks.push(mask);
        }
        self.outputs.iter().map(|id| values[id.index()][0]).collect()
    }

    fn value_as<S: Scalar, const N: usize>(
        &self,
        node: &Node,
        values: &[[S; N]],
        masks: &[Option<[S::Mask; N]>],
        input: &impl Fn(usize, usize) -> S,
    ) -> [S; N] {
        let (at, width) = (|k: usize| values[node.args[k] as usize], self.lanes().width);
        let each = |f: &dyn Fn(usize) -> S| {
            let mut out = [S::zero(); N];
            (0..width).for_each(|k| out[k] = f(k));
            (width..N).for_each(|k| out[k] = out[k % width]);
            out
        };
        let two = |f: &dyn Fn(S, S) -> S| each(&|k| f(at(0)[k], at(1)[k]));
        let one = |f: &dyn Fn(S) -> S| each(&|k| f(at(0)[k]));
        let product = |k: usize| at(0)[k] * at(1)[k];
        match node.op {
            Op::Constant => [S::from_f64(node.constant().unwrap_or(f64::NAN)); N],
            Op::LaneConstant => std::array::from_fn(|k| S::from_f64(self.lanes().constant(node.args[0])[k])),
            Op::Input => [input(node.args[0] as usize, node.args[1] as usize); N],
            Op::LaneInput => each(&|k| input(node.args[0] as usize, self.lanes().input(node.args[1])[k] as usize)),
            Op::Add => two(&|a, b| a + b),
            Op::Sub => two(&|a, b| a - b),
            Op::Mul => two(&|a, b| a * b),
            Op::Div => two(&|a, b| a / b),
            Op::Neg => one(&|a| -a),
            Op::Sqrt => one(&S::sqrt),
            Op::Atan2 => two(&|a, b| a.atan2(b)),
            // These three are not looked up here.
            Op::Positive | Op::Sin | Op::Cos => [S::zero(); N],
            Op::Select => {
                let mask = masks[node.args[0] as usize];
                each(&|k| mask.map_or(S::zero(), |m| S::select(m[k], at(1)[k], at(2)[k])))
            }
            Op::MulAdd => each(&|k| product(k) + at(2)[k]),
            Op::MulSub => each(&|k| product(k) - at(2)[k]),
            Op::NegMulAdd => each(&|k| at(2)[k] - product(k)),
            Op::NegMulSub => each(&|k| -product(k) - at(2)[k]),
            Op::Spread => {
                let lane = self.node(NodeId(node.args[1])).constant().unwrap_or_default() as usize;
                [at(0)[lane]; N]
            }
            Op::Across => [(1..width).fold(at(0)[0], |sum, k| sum + at(0)[k]); N],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::OPS;

    #[test]
    fn in_doubles_it_is_the_evaluation_of_doubles() {
        let mut g = Graph::default();
        let (x, y) = (g.input(0, 0), g.input(1, 2));
        let (s, p) = (g.apply(Op::Sin, &[x]), g.apply(Op::Positive, &[y]));
        let (m, a) = (g.apply(Op::MulSub, &[x, s, y]), g.apply(Op::Atan2, &[x, y]));
        let (c, q) = (g.apply(Op::Select, &[p, m, a]), g.apply(Op::Div, &[a, s]));
        g.outputs = vec![c, q, s];
        for (x, y) in [(0.3, 2.0), (-0.7, -1.5)] {
            let at = |argument: usize, _: usize| if argument == 0 { x } else { y };
            assert_eq!(g.evaluate_as::<f64>(at), g.evaluate(at));
        }
    }

    #[test]
    fn every_operation_is_that_of_doubles_in_every_lane() {
        for width in [2, 4] {
            let mut g = Graph::in_lanes(width);
            let numbers = std::array::from_fn(|k| [0.4, -1.1, 2.2, -0.6][k % width]);
            let (x, y, z) = (g.lane_input(0, &[0, 1, 2, 3][..width]), g.lane_constant(numbers), g.input(1, 5));
            let mut results = vec![g.exactly(Op::Sin, &[y]), g.exactly(Op::Cos, &[z])];
            for row in OPS.iter().filter(|row| row.arity > 0 && !matches!(row.op, Op::Positive | Op::Select | Op::Spread)) {
                results.push(g.exactly(row.op, &[x, y, z][..row.arity]));
            }
            let positive = g.exactly(Op::Positive, &[x]);
            results.push(g.exactly(Op::Select, &[positive, y, z]));
            for lane in 0..width {
                let lane = g.constant(lane as f64);
                let of_lane: Vec<NodeId> = results.iter().map(|&r| g.exactly(Op::Spread, &[r, lane])).collect();
                g.outputs.extend(of_lane);
            }
            let at = |argument: usize, k: usize| [0.9, -0.8, 1.7, -0.3, 0.0, 2.6][k] + argument as f64;
            // Of a negative number the root is none.
            let numbers = |values: Vec<f64>| values.into_iter().map(|x| (!x.is_nan()).then_some(x)).collect::<Vec<_>>();
            assert_eq!(numbers(g.evaluate_as::<f64>(at)), numbers(g.evaluate(at)), "{width} lanes");
        }
    }
}
