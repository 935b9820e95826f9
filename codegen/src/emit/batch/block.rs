//! A graph as statements on a part of a block of states.

use crate::emit::statements::dialect::Dialect;
use crate::emit::statements::order::Angle;
use crate::emit::statements::vector::Vector;
use crate::graph::{Node, NodeId, Op};

/// Functions on vectors, to and from blocks.
pub(super) struct Block<'a>(pub(super) Vector<'a>);

impl Dialect for Block<'_> {
    fn statement(&self, k: usize, node: &Node) -> Option<String> {
        let input = (node.op == Op::Input).then(|| &self.0.signature.inputs[node.args[0] as usize]);
        match input {
            Some(input) => Some(format!("    let x{k} = at(&{}, part);\n", input.flat(node.args[1] as usize))),
            None => self.0.statement(k, node),
        }
    }

    fn sines(&self, group: &[Angle], of: usize) -> String {
        self.0.sines(group, of)
    }

    fn group(&self) -> usize {
        1
    }

    fn number(&self, id: NodeId) -> String {
        self.0.operand(id)
    }

    /// Zeros too: there is no telling what stands in a block.
    fn give(&self, place: &str, id: NodeId) -> Option<String> {
        Some(format!("    put(&mut {place}, part, {});\n", self.number(id)))
    }

    fn beginning(&self) -> &'static str {
        self.0.beginning()
    }

    fn value(&self) -> (&'static str, &'static str) {
        self.0.value()
    }
}
