//! What a target can do: it decides how functions are lowered.

use crate::Precision;

/// What a target can do.
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
    /// Whether a body can name the slots in which values wait.
    pub(crate) spills: bool,
    /// Whether there are functions of many states.
    pub(crate) states: bool,
}
