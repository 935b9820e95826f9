//! Passes over statements. Each preserves the results of a body; the interpreter checks that.

pub(crate) mod alias_barrier;
pub(crate) mod outline;
pub(crate) mod pair_stores;
mod registers;
pub(crate) mod rows;
pub(crate) mod spill;
pub(crate) mod zeros;
