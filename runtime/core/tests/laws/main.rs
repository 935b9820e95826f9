//! Laws of dynamics, checked for the generic library on random trees. Each file is one family of
//! laws.
//!
//! `cargo test -p articulated-core` runs them, and compiles neither the generator nor the command
//! for it.

mod balls;
mod base_parameters;
mod closed_forms;
mod edits;
mod effects;
mod effects_closed;
mod energy;
mod equivalence;
mod manifold;
mod mimic;
mod paths;
mod pivots;
mod polynomial;
mod reference;
mod screws;
mod shafts;
mod sines;
mod structure;
mod table;
mod textbook;
mod traps;
mod trees;
