//! Results that lie side by side, stored through two pointers in turn of which a compiler cannot
//! know that they are one.
//!
//! Where a compiler sees two neighbours it looks for two vectors to make them from, all the way
//! back to the inputs, and reorders the statements of the whole function each time. Of the
//! derivatives of a seven-axis arm that was a third of the time to compile, and saved no time when
//! they ran. Values that pieces of a long function hand on are kept apart by their places
//! ([`super::outline`]).

use crate::graph::Graph;

/// From this many nodes on. Below, it is little time, and the code is a little faster without.
const FROM: usize = 1500;

/// Whether a body of plain numbers gets the barrier.
pub(crate) fn pays(graph: &Graph) -> bool {
    graph.nodes().len() >= FROM && graph.lanes().width == 1
}
