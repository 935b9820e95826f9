//! Rust.
//!
//! A module (`module`) has functions (`function`), which are statements (`statements`); `batch` has functions of many
//! states, `spills` the memory in which values wait.

mod batch;
mod columns;
mod derivatives;
mod function;
mod literal;
mod module;
mod several;
mod spills;
mod statements;

pub use module::names::identifier;

pub(crate) use module::module;
pub(crate) use module::names::{Names, is_name};
pub(crate) use module::warnings::warnings;
