//! Graphs as formulas.

use articulated_codegen::graph::{Graph, NodeId, Op};

/// The outputs of a graph as formulas, one a line; `names[k]` has the names of argument k. Values
/// that are used twice are written twice.
pub fn formulas(graph: &Graph, names: &[&[&str]]) -> String {
    let lines: Vec<String> = graph.outputs.iter().map(|&output| formula(graph, names, output, 0)).collect();
    lines.join("\n")
}

/// One value, in parentheses if its operation binds less than `binding`: 1 a sum, 2 a product, 3 a
/// factor.
fn formula(graph: &Graph, names: &[&[&str]], id: NodeId, binding: u32) -> String {
    let node = graph.node(id);
    let operands: Vec<NodeId> = node.operands().collect();
    let at = |k: usize, binding: u32| formula(graph, names, operands[k], binding);
    let (own, text) = match node.op {
        Op::Constant => (3, format!("{}", node.constant().unwrap_or_default())),
        Op::Input => (3, names[node.args[0] as usize][node.args[1] as usize].to_owned()),
        Op::Add => (1, format!("{} + {}", at(0, 1), at(1, 1))),
        Op::Sub => (1, format!("{} − {}", at(0, 1), at(1, 2))),
        Op::Mul => (2, format!("{} {}", at(0, 2), at(1, 2))),
        Op::Div => (2, format!("{} / {}", at(0, 2), at(1, 3))),
        Op::Neg => (2, format!("−{}", at(0, 2))),
        Op::Sin => (3, format!("sin({})", at(0, 0))),
        Op::Cos => (3, format!("cos({})", at(0, 0))),
        Op::MulAdd => (1, format!("{} {} + {}", at(0, 2), at(1, 2), at(2, 1))),
        Op::MulSub => (1, format!("{} {} − {}", at(0, 2), at(1, 2), at(2, 2))),
        Op::NegMulAdd => (1, format!("{} − {} {}", at(2, 1), at(0, 2), at(1, 2))),
        Op::NegMulSub => (1, format!("−{} {} − {}", at(0, 2), at(1, 2), at(2, 2))),
        other => (3, format!("{other:?}({})", operands.iter().enumerate().map(|(k, _)| at(k, 0)).collect::<Vec<_>>().join(", "))),
    };
    if own < binding { format!("({text})") } else { text }
}
