//! A graph as statements of the functions of [`articulated_core::level`], on sums of two doubles.

use std::fmt::Write;

use crate::emit::function::signature::Signature;
use crate::emit::statements::dialect::Dialect;
use crate::emit::statements::literal::{literal, operand};
use crate::emit::statements::order::Angle;
use crate::emit::statements::plain::name;
use crate::graph::{Graph, Node, NodeId, Op};
use crate::{Level, Sines};

/// How many angles `trig::four` takes.
const FOUR: usize = 4;

/// Functions on sums of two doubles.
pub(crate) struct Pairs<'a> {
    pub(crate) graph: &'a Graph,
    pub(crate) signature: &'a Signature<'a>,
    pub(crate) level: Level,
}

impl Dialect for Pairs<'_> {
    fn statement(&self, k: usize, node: &Node) -> Option<String> {
        let value = match node.op {
            Op::Constant => return None,
            Op::Input => format!("({}, 0.0)", self.signature.inputs[node.args[0] as usize].at(node.args[1] as usize)),
            op => {
                let operands: Vec<String> = node.operands().map(|o| self.operand(o)).collect();
                format!("{}::<FUSED>({})", op.row().lanes, operands.join(", "))
            }
        };
        Some(format!("    let x{k} = {value};\n"))
    }

    fn sines(&self, group: &[Angle], _: usize) -> String {
        let mut out = String::new();
        match self.level.sines {
            Sines::Two => group.iter().for_each(|a| {
                let _ = writeln!(out, "    let ({}, {}) = sin_cos::<FUSED>({});", name(a.sin), name(a.cos), self.operand(a.angle));
            }),
            Sines::Correct => group.iter().for_each(|a| {
                let angle = self.operand(a.angle);
                let (x, y) = (name(a.sin), name(a.cos));
                let _ = writeln!(
                    out,
                    "    let ({x}, {y}) = {{ let (s, c) = sin_cos_correct::<FUSED>({angle}.0); turned::<FUSED>({angle}, s, c) }};"
                );
            }),
            _ => self.four(&mut out, group),
        }
        out
    }

    fn group(&self) -> usize {
        FOUR
    }

    fn number(&self, id: NodeId) -> String {
        self.graph.node(id).constant().map_or_else(|| format!("number::<FUSED>(x{})", id.0), operand)
    }

    fn value(&self) -> (&'static str, &'static str) {
        ("V", "(0.0, 0.0)")
    }
}

impl Pairs<'_> {
    /// Those of the doubles, and what the rest turns them.
    fn four(&self, out: &mut String, group: &[Angle]) {
        let padded = |mut list: Vec<String>, pad: &str| {
            list.resize(FOUR, pad.into());
            list.join(", ")
        };
        let named = |letter: &str| padded(group.iter().map(|a| format!("{letter}{}", a.angle.0)).collect(), "_");
        let angles = padded(group.iter().map(|a| format!("{}.0", self.operand(a.angle))).collect(), "0.0");
        let _ = writeln!(out, "    let [[{}], [{}]] = trig::four::<MultiplyAdd<FUSED>>({angles});", named("s"), named("c"));
        for a in group {
            let (angle, k) = (self.operand(a.angle), a.angle.0);
            let _ = writeln!(out, "    let ({}, {}) = turned::<FUSED>({angle}, s{k}, c{k});", name(a.sin), name(a.cos));
        }
    }

    /// A name, or a constant.
    fn operand(&self, id: NodeId) -> String {
        self.graph.node(id).constant().map_or_else(|| format!("x{}", id.0), |x| format!("({}, 0.0)", literal(x)))
    }
}
