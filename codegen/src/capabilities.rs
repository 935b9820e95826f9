//! Capabilities of a target: they decide how functions are lowered.

use crate::Precision;

/// Capabilities of a target.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Capabilities {
    /// How accurate functions are.
    pub(crate) level: Precision,
    /// Whether values may be vectors.
    pub(crate) vectors: bool,
    /// Whether a function can write into memory that holds no value yet.
    pub(crate) raw_memory: bool,
    /// Whether a function whose values are vectors also has a body of plain numbers, for compilers
    /// without vectors.
    pub(crate) scalar_too: bool,
    /// Whether the solution for many right-hand sides can be a loop.
    pub(crate) loops: bool,
    /// Whether a body can name its spill slots.
    pub(crate) spills: bool,
    /// Whether there are functions of many states.
    pub(crate) states: bool,
}
