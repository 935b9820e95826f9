//! How everything is driven out of the caches between two evaluations.

use std::hint::black_box;

use crate::compiled::{CompileError, Filler, Rustc};

/// More than the caches of a core and what it shares with its neighbours.
pub(super) const BUFFER: usize = 64 << 20;

const LINE: usize = 64;

/// Data and code that take the place of whatever is in the caches.
pub(super) struct Cold {
    buffer: Vec<u8>,
    filler: Filler,
}

impl Cold {
    pub(super) fn new(rustc: &Rustc) -> Result<Self, CompileError> {
        Ok(Self { buffer: vec![1; BUFFER], filler: Filler::build(rustc)? })
    }

    /// Writes to every line of the buffer, then runs the code.
    pub(super) fn chill(&mut self) {
        self.buffer.iter_mut().step_by(LINE).for_each(|x| *x = x.wrapping_add(1));
        black_box(&mut self.buffer);
        self.filler.run();
    }
}
