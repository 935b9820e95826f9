//! Passes over statements. Each keeps what a body computes; the interpreter holds it to that.

pub(crate) mod alias_barrier;
pub(crate) mod outline;
pub(crate) mod pair_stores;
mod registers;
pub(crate) mod rows;
pub(crate) mod spill;
pub(crate) mod zeros;
