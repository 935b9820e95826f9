//! A graph in any scalar.

use articulated_core::Scalar;

use super::{Graph, MOST, Node, NodeId, Op};

impl Graph {
    /// The results, computed node by node in `S`; `input(argument, index)` gives the inputs. Of results with several lanes, the first. A multiply-add is a product and a sum.
    pub fn evaluate_as<S: Scalar>(&self, input: impl Fn(usize, usize) -> S) -> Vec<S> {
        let mut values: Vec<[S; MOST]> = Vec::with_capacity(self.nodes().len());
        let mut masks: Vec<Option<[S::Mask; MOST]>> = Vec::with_capacity(self.nodes().len());
        for node in self.nodes() {
            let mask = (node.op == Op::Positive).then(|| values[node.args[0] as usize].map(S::positive));
            values.push(self.value_as(node, &values, &masks, &input));
            masks.push(mask);
        }
        self.outputs.iter().map(|id| values[id.index()][0]).collect()
    }

    fn value_as<S: Scalar>(
        &self,
        node: &Node,
        values: &[[S; MOST]],
        masks: &[Option<[S::Mask; MOST]>],
        input: &impl Fn(usize, usize) -> S,
    ) -> [S; MOST] {
        let (at, width) = (|k: usize| values[node.args[k] as usize], self.lanes().width);
        let each = |f: &dyn Fn(usize) -> S| {
            let mut out = [S::zero(); MOST];
            (0..width).for_each(|k| out[k] = f(k));
            (width..MOST).for_each(|k| out[k] = out[k % width]);
            out
        };
        let two = |f: &dyn Fn(S, S) -> S| each(&|k| f(at(0)[k], at(1)[k]));
        let one = |f: &dyn Fn(S) -> S| each(&|k| f(at(0)[k]));
        let product = |k: usize| at(0)[k] * at(1)[k];
        match node.op {
            Op::Constant => [S::from_f64(node.constant().unwrap_or(f64::NAN)); MOST],
            Op::LaneConstant => self.lanes().constant(node.args[0]).map(S::from_f64),
            Op::Input => [input(node.args[0] as usize, node.args[1] as usize); MOST],
            Op::LaneInput => each(&|k| input(node.args[0] as usize, self.lanes().input(node.args[1])[k] as usize)),
            Op::Add => two(&|a, b| a + b),
            Op::Sub => two(&|a, b| a - b),
            Op::Mul => two(&|a, b| a * b),
            Op::Div => two(&|a, b| a / b),
            Op::Neg => one(&|a| -a),
            Op::Sqrt => one(&S::sqrt),
            Op::Sin => one(&|a| a.sin_cos().0),
            Op::Cos => one(&|a| a.sin_cos().1),
            Op::Atan2 => two(&|a, b| a.atan2(b)),
            Op::Positive => [S::zero(); MOST],
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
                [at(0)[lane]; MOST]
            }
            Op::Across => [(1..width).fold(at(0)[0], |sum, k| sum + at(0)[k]); MOST],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
