//! From graphs to Rust.

mod across;
mod apart;
mod bare;
mod batch;
mod chunks;
mod columns;
mod derivatives;
mod dialect;
mod flat;
mod function;
mod header;
mod levels;
mod literal;
mod module;
mod names;
mod order;
mod pairs;
mod plain;
mod registers;
mod results;
mod rows;
mod sets;
mod several;
mod signature;
mod spill;
mod style;
mod together;
mod used;
mod vector;
mod warnings;
mod written;
mod zeros;

pub use names::identifier;

pub(crate) use module::module;
pub(crate) use names::{Names, is_name};
pub(crate) use warnings::warnings;
