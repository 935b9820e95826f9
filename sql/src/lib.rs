#![doc = include_str!("../README.md")]

mod batch;
mod columns;
mod evaluate;
mod function;
mod robot;

pub use batch::{Batch, State};
pub use robot::Robot;
