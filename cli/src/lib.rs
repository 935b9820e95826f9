//! The command `articulated`, as a library: what it does, and what the tests of the workspace share with it.
pub mod compiled;
pub mod magnitude;
mod native;
pub mod precise;
