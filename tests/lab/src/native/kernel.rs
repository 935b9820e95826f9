//! Functions of one state in code that the command has compiled.

use super::entry::{OfState, Waiting};
use super::{Lengths, Native, all_pointers, pointers};

/// A function on arrays of doubles, with the lengths it was promised to have. Keeps its library
/// open.
#[derive(Clone, Debug)]
pub(crate) struct Kernel {
    entry: OfState,
    lengths: Lengths,
    _library: Native,
}

impl Native {
    /// The function `name`, which takes arrays of these lengths and writes `out` numbers: the
    /// interface of [`crate::compiled`].
    pub(crate) fn kernel(&self, name: &str, arguments: &[usize], out: usize) -> Option<Kernel> {
        // SAFETY: compiled functions take their arguments' arrays, and then the one of the result.
        let entry = unsafe { OfState::open(self, name, arguments.len())? };
        Some(Kernel { entry, lengths: Lengths { arguments: arguments.to_vec(), out }, _library: self.clone() })
    }
}

impl Kernel {
    /// Calls the function.
    ///
    /// # Panics
    /// If a length is not the one promised.
    #[inline]
    pub(crate) fn call(&self, x: &[&[f64]], out: &mut [f64]) {
        assert!(self.fits(x, out));
        // SAFETY: the arrays have the lengths that the library reads and writes, and it is open as
        // long as the kernel lives.
        unsafe { self.entry.run(1, &[pointers(x)], out.as_mut_ptr().cast()) }
    }

    /// Whether these are arguments and a result of the lengths promised.
    #[inline]
    pub(crate) fn fits(&self, x: &[&[f64]], out: &[f64]) -> bool {
        self.lengths.fit(x, out)
    }

    /// Calls the function on all states, for `rounds` rounds: lengths are checked once, before the
    /// calls.
    ///
    /// # Panics
    /// If a length differs from the promised one.
    pub(crate) fn repeat(&self, rounds: usize, states: &[Vec<&[f64]>], out: &mut [f64]) {
        assert!(states.iter().all(|x| self.fits(x, out)));
        // SAFETY: as in `call`.
        unsafe { self.entry.run(rounds, &all_pointers(states), out.as_mut_ptr().cast()) }
    }

    /// The same, each call after the result of the one before.
    ///
    /// # Panics
    /// If a length is not the one promised.
    pub(crate) fn repeat_waiting(&self, rounds: usize, states: &[Vec<&[f64]>], out: &mut [f64]) {
        assert!(states.iter().all(|x| self.fits(x, out)));
        out.fill(0.0);
        let mut waiting = Waiting::new(self.lengths.arguments[0], out.as_ptr(), out.len());
        // SAFETY: as in `call`; the result has at least one number, or `Waiting::new` panicked.
        unsafe { self.entry.run_waiting(rounds, &all_pointers(states), &mut waiting, out.as_mut_ptr().cast()) }
    }
}
