//! From graphs to Rust.
//!
//! A module (`module`) has functions (`function`), which are statements (`statements`) that keep values in memory (`memory`) and write results (`written`); `batch` has functions of many states.

mod batch;
mod function;
mod memory;
mod module;
mod statements;
mod written;

pub use module::names::identifier;

pub(crate) use module::module;
pub(crate) use module::names::{Names, is_name};
pub(crate) use module::warnings::warnings;
