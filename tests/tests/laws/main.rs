//! Laws of dynamics, held against the generic library on random trees. Each file is one family of laws.

mod closed_forms;
mod edits;
mod effects;
mod effects_closed;
mod energy;
mod equivalence;
mod fixtures;
mod interface;
mod manifold;
mod mimic;
mod random_trees;
mod reference;
mod screws;
mod shafts;
mod sines;
mod structure;
mod table;
mod textbook;
mod traps;
