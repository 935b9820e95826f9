//! How nodes are written: in plain arithmetic or in lanes. What is common to both.

use crate::emit::function::results::ZERO;
use crate::emit::statements::flat::flat;
use crate::emit::statements::literal::bare;
use crate::emit::statements::order::{Angle, Step, order};
use crate::graph::{Graph, Node, NodeId, Op};

/// A way to write statements.
pub(crate) trait Dialect {
    /// `let x7 = …;`, nothing for what has no name.
    fn statement(&self, k: usize, node: &Node) -> Option<String>;

    /// The sines and cosines of a group of angles, of so many in all that are known at once.
    fn sines(&self, group: &[Angle], of: usize) -> String;

    /// How many angles go together.
    fn group(&self) -> usize;

    /// A result, as a number.
    fn number(&self, id: NodeId) -> String;

    /// The statement that puts a result in its place; nothing for a zero, which is there from the start or has statements of its own ([`super::zeros`]).
    fn give(&self, place: &str, id: NodeId) -> Option<String> {
        let value = self.number(id);
        (value != ZERO).then(|| format!("    {place} = {};\n", bare(&value)))
    }

    /// Whether two numbers that stand side by side can be written by one instruction, `store` of `lanes`.
    fn stores_two(&self) -> bool {
        false
    }

    /// What stands at the beginning of a function.
    fn beginning(&self) -> &'static str {
        ""
    }

    /// The type of a value, and a value of it.
    fn value(&self) -> (&'static str, &'static str);
}

/// A step that is written as a whole.
#[derive(Clone, Debug)]
pub(crate) enum Unit {
    Node(usize),
    /// Angles, and of how many.
    Sines(Vec<Angle>, usize),
}

impl Unit {
    /// The nodes that it makes.
    pub(crate) fn makes(&self) -> Vec<usize> {
        match self {
            Unit::Node(k) => vec![*k],
            Unit::Sines(angles, _) => angles.iter().flat_map(|a| [a.sin, a.cos]).flatten().collect(),
        }
    }

    /// The nodes that it needs.
    pub(crate) fn needs(&self, graph: &Graph) -> Vec<usize> {
        match self {
            Unit::Node(k) => graph.nodes()[*k].operands().map(NodeId::index).collect(),
            Unit::Sines(angles, _) => angles.iter().map(|a| a.angle.index()).collect(),
        }
    }

    /// As text.
    pub(crate) fn written(&self, graph: &Graph, dialect: &dyn Dialect) -> Option<String> {
        match self {
            Unit::Node(k) => dialect.statement(*k, &graph.nodes()[*k]),
            Unit::Sines(angles, of) => Some(dialect.sines(angles, *of)),
        }
    }
}

/// The graph's nodes that need a name, in the order in which they are written.
pub(crate) fn units(graph: &Graph, group: usize) -> Vec<Unit> {
    let inner = inner(graph);
    let mut units = Vec::with_capacity(graph.nodes().len());
    for step in order(graph) {
        match step {
            Step::Node(k) if inner[k] => units.push(Unit::Node(k)),
            Step::Node(_) => {}
            Step::Batch(angles) => {
                units.extend(in_order(&angles, graph).chunks(group).map(|some| Unit::Sines(some.to_vec(), angles.len())));
            }
        }
    }
    units
}

/// Angles that are known at once, as they lie in memory, so that neighbours are one load, or backwards where more are needed in that order, for the last lane is the last to be had.
/// What was computed comes after them, as it is needed.
fn in_order(needed: &[Angle], graph: &Graph) -> Vec<Angle> {
    let place = |angle: &Angle| {
        let node = graph.node(angle.angle);
        if node.op == Op::Input { (0, node.args[0], node.args[1]) } else { (1, 0, 0) }
    };
    let mut angles = needed.to_vec();
    angles.sort_by_key(place);
    let pairs = || needed.iter().enumerate().flat_map(|(k, one)| needed[k + 1..].iter().map(move |other| place(one) > place(other)));
    if pairs().filter(|backward| *backward).count() * 2 > pairs().count() {
        angles.reverse();
    }
    angles
}

/// What other nodes use, and so needs a name. A lane of a vector does not where it is a result.
fn inner(graph: &Graph) -> Vec<bool> {
    let mut inner = vec![false; graph.nodes().len()];
    graph.nodes().iter().flat_map(Node::operands).for_each(|o| inner[o.index()] = true);
    for o in &graph.outputs {
        inner[o.index()] |= graph.node(*o).op != Op::Spread;
    }
    inner
}

/// All statements, as `rewritten` has them.
pub(crate) fn statements(out: &mut String, graph: &Graph, dialect: &dyn Dialect, rewritten: impl FnOnce(String) -> String) {
    let lines = units(graph, dialect.group()).into_iter().filter_map(|unit| unit.written(graph, dialect));
    *out += &flat(&rewritten(lines.collect()), dialect.value().0);
}
