//! Neighbouring results, stored in turn through two pointers that a compiler cannot prove equal.
//!
//! A compiler that sees two neighbours looks for two vectors to build them from, back to the
//! inputs, and reorders the statements of the whole function each time. For the derivatives of a
//! seven-axis arm that took a third of the compile time, and saved no run time. Values passed
//! between pieces of a long function are kept apart by their places ([`super::outline`]).

use crate::graph::Graph;

/// From this many nodes on. Below, it is little time, and the code is a little faster without.
const FROM: usize = 1500;

/// Whether a body of plain numbers gets the barrier.
pub(crate) fn pays(graph: &Graph) -> bool {
    graph.nodes().len() >= FROM && graph.lanes().width == 1
}
