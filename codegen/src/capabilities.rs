//! What a target can do: it decides how functions are lowered.

use crate::Precision;

/// What a target can do.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Capabilities {
    /// How accurate functions are.
    pub(crate) level: Precision,
    /// Whether values may be vectors.
    pub(crate) vectors: bool,
    /// Whether a function can write into memory that holds no value yet, and name the slots in
    /// which values wait.
    pub(crate) raw_memory: bool,
    /// Whether there are functions of many states.
    pub(crate) states: bool,
}
