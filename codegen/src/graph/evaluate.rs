//! A graph in any scalar.

use std::collections::HashMap;

use articulated_core::Scalar;

use super::{Graph, MOST, Node, NodeId, Op};

/// The value of an operation on numbers. For leaves and operations across lanes, the first operand.
pub(crate) fn value<S: Scalar>(op: Op, [a, b, c]: [S; 3]) -> S {
    match op {
        Op::Add => a + b,
        Op::Sub => a - b,
        Op::Mul => a * b,
        Op::Div => a / b,
        Op::Neg => -a,
        Op::Sqrt => a.sqrt(),
        Op::Sin => a.sin_cos().0,
        Op::Cos => a.sin_cos().1,
        Op::Atan2 => a.atan2(b),
        Op::Positive => S::select(a.positive(), S::one(), S::zero()),
        Op::Select => S::select(a.positive(), b, c),
        Op::MulAdd => a * b + c,
        Op::MulSub => a * b - c,
        Op::NegMulAdd => c - a * b,
        Op::NegMulSub => -(a * b) - c,
        Op::Constant
        | Op::Input
        | Op::LaneConstant
        | Op::LaneInput
        | Op::Broadcast
        | Op::ReduceAdd
        | Op::List
        | Op::Region
        | Op::RegionValue => a,
    }
}

impl Graph {
    /// The results in doubles; `input(argument, index)` gives the inputs. Of results with several
    /// lanes, the first.
    pub fn evaluate(&self, input: impl Fn(usize, usize) -> f64) -> Vec<f64> {
        self.evaluate_as(input)
    }

    /// The results, computed node by node in `S`; `input(argument, index)` gives the inputs. Of
    /// results with several lanes, the first. A multiply-add is a product and a sum.
    pub fn evaluate_as<S: Scalar>(&self, input: impl Fn(usize, usize) -> S) -> Vec<S> {
        if self.lanes().width == 1 { self.evaluate_in_lanes::<S, 1>(input) } else { self.evaluate_in_lanes::<S, MOST>(input) }
    }

    fn evaluate_in_lanes<S: Scalar, const N: usize>(&self, input: impl Fn(usize, usize) -> S) -> Vec<S> {
        let mut values: Vec<[S; N]> = Vec::with_capacity(self.nodes().len());
        let mut waves = (None, [(S::zero(), S::zero()); N]);
        let mut regions: HashMap<u32, Vec<S>> = HashMap::new();
        for node in self.nodes() {
            if matches!(node.op, Op::Sin | Op::Cos) && waves.0 != Some(node.args[0]) {
                // The sine and the cosine of an angle come one after the other.
                waves = (Some(node.args[0]), values[node.args[0] as usize].map(S::sin_cos));
            }
            let value = match node.op {
                Op::Sin => waves.1.map(|w| w.0),
                Op::Cos => waves.1.map(|w| w.1),
                Op::List => [S::zero(); N],
                Op::Region => {
                    let given: Vec<S> = self.given(node).iter().map(|id| values[id.index()][0]).collect();
                    regions.insert(values.len() as u32, self.region_of(node).run(&given));
                    [S::zero(); N]
                }
                Op::RegionValue => [regions[&node.args[0]][node.args[1] as usize]; N],
                _ => self.value_as(node, &values, &input),
            };
            values.push(value);
        }
        self.outputs.iter().map(|id| values[id.index()][0]).collect()
    }

    /// The value of a node from those before it.
    fn value_as<S: Scalar, const N: usize>(&self, node: &Node, values: &[[S; N]], input: &impl Fn(usize, usize) -> S) -> [S; N] {
        let width = self.lanes().width;
        let at = |k: usize| values[node.args[k] as usize];
        match node.op {
            Op::Constant => [S::from_f64(node.constant().unwrap_or(f64::NAN)); N],
            Op::LaneConstant => std::array::from_fn(|k| S::from_f64(self.lanes().constant(node.args[0])[k])),
            Op::Input => [input(node.args[0] as usize, node.args[1] as usize); N],
            Op::LaneInput => each(width, |k| input(node.args[0] as usize, self.lanes().input(node.args[1])[k] as usize)),
            Op::Broadcast => {
                let lane = self.node(NodeId(node.args[1])).constant().unwrap_or_default() as usize;
                [at(0)[lane]; N]
            }
            Op::ReduceAdd => [(1..width).fold(at(0)[0], |sum, k| sum + at(0)[k]); N],
            op => {
                let [a, b, c] = [at(0), at(1), at(2)];
                each(width, |k| value(op, [a[k], b[k], c[k]]))
            }
        }
    }
}

/// One number for each lane, then the same again.
fn each<S: Scalar, const N: usize>(width: usize, of: impl Fn(usize) -> S) -> [S; N] {
    let mut out = [S::zero(); N];
    (0..width).for_each(|k| out[k] = of(k));
    (width..N).for_each(|k| out[k] = out[k % width]);
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::OPS;

    #[test]
    fn every_operation_is_done_in_every_lane() {
        let (x, y, z) = ([0.9, -0.8, 1.7, -0.3], [0.4, 1.1, 2.2, 0.6], 2.6);
        for width in [2, 4] {
            let mut g = Graph::in_lanes(width);
            let lane_constant = g.lane_constant(std::array::from_fn(|k| y[k % width]));
            let operands = [g.lane_input(0, &[0, 1, 2, 3][..width]), lane_constant, g.input(1, 0)];
            let mut expected = Vec::new();
            for row in OPS.iter().filter(|row| row.arity > 0 && row.cost > 0 && !matches!(row.op, Op::Broadcast | Op::ReduceAdd)) {
                let result = g.exactly(row.op, &operands[..row.arity]);
                for lane in 0..width {
                    let of_all = g.constant(lane as f64);
                    let broadcast = g.exactly(Op::Broadcast, &[result, of_all]);
                    g.outputs.push(broadcast);
                    expected.push(value(row.op, [x[lane], y[lane], z]));
                }
            }
            // The root of a negative number is NaN.
            let numbers = |values: Vec<f64>| values.into_iter().map(|x| (!x.is_nan()).then_some(x)).collect::<Vec<_>>();
            assert_eq!(numbers(g.evaluate(|argument, k| if argument == 0 { x[k] } else { z })), numbers(expected), "{width} lanes");
        }
    }

    #[test]
    fn operations_are_those_that_they_are_called() {
        let of = |op| value(op, [3.0, 2.0, 0.5]);
        let ops = [Op::Add, Op::Sub, Op::Mul, Op::Div, Op::Neg, Op::Sqrt, Op::Sin, Op::Cos, Op::Atan2];
        let expected = [5.0, 1.0, 6.0, 1.5, -3.0, 3_f64.sqrt(), 3_f64.sin(), 3_f64.cos(), 3_f64.atan2(2.0)];
        assert_eq!(ops.map(of), expected);
        assert_eq!([Op::MulAdd, Op::MulSub, Op::NegMulAdd, Op::NegMulSub].map(of), [6.5, 5.5, -5.5, -6.5]);
        for (asked, holds) in [(3.0, true), (0.0, false), (-3.0, false)] {
            let mask = value(Op::Positive, [asked, 0.0, 0.0]);
            assert_eq!((mask, value(Op::Select, [mask, 2.0, 0.5])), if holds { (1.0, 2.0) } else { (0.0, 0.5) });
        }
    }
}
