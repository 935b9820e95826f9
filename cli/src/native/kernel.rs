//! Functions of one state in code that the command has compiled.

use super::{Lengths, Native, O, P, repeat};

/// A function on arrays of doubles, with the lengths it was promised to have. Keeps its library open.
#[derive(Clone, Debug)]
pub(crate) struct Kernel {
    entry: Entry,
    lengths: Lengths,
    _library: Native,
}

#[derive(Clone, Copy, Debug)]
enum Entry {
    One(unsafe extern "C" fn(P, O)),
    Two(unsafe extern "C" fn(P, P, O)),
    Three(unsafe extern "C" fn(P, P, P, O)),
    Four(unsafe extern "C" fn(P, P, P, P, O)),
}

impl Native {
    /// The function `name`, which takes arrays of these lengths and writes `out` numbers: the interface of [`crate::compiled`].
    pub(crate) fn kernel(&self, name: &str, arguments: &[usize], out: usize) -> Option<Kernel> {
        // SAFETY: compiled functions take their arguments' arrays, and then the one of the result.
        let entry = unsafe {
            match arguments.len() {
                1 => Entry::One(self.symbol(name)?),
                2 => Entry::Two(self.symbol(name)?),
                3 => Entry::Three(self.symbol(name)?),
                4 => Entry::Four(self.symbol(name)?),
                _ => return None,
            }
        };
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
        let out = out.as_mut_ptr();
        // SAFETY: the arrays have the lengths that the library reads and writes, and it is open as long as the kernel lives.
        unsafe {
            match self.entry {
                Entry::One(f) => f(x[0].as_ptr(), out),
                Entry::Two(f) => f(x[0].as_ptr(), x[1].as_ptr(), out),
                Entry::Three(f) => f(x[0].as_ptr(), x[1].as_ptr(), x[2].as_ptr(), out),
                Entry::Four(f) => f(x[0].as_ptr(), x[1].as_ptr(), x[2].as_ptr(), x[3].as_ptr(), out),
            }
        }
    }

    /// Whether these are arguments and a result of the lengths promised.
    #[inline]
    pub(crate) fn fits(&self, x: &[&[f64]], out: &[f64]) -> bool {
        self.lengths.fit(x, out)
    }

    /// Calls the function on all states, so many rounds: lengths are checked once, and then only called.
    ///
    /// # Panics
    /// If a length is not the one promised.
    pub(crate) fn repeat(&self, rounds: usize, states: &[Vec<&[f64]>], out: &mut [f64]) {
        assert!(states.iter().all(|x| self.fits(x, out)));
        let out = out.as_mut_ptr();
        // SAFETY: as in `call`.
        unsafe {
            match self.entry {
                Entry::One(f) => repeat(rounds, states, |[q, ..]| f(q, out)),
                Entry::Two(f) => repeat(rounds, states, |[q, v, ..]| f(q, v, out)),
                Entry::Three(f) => repeat(rounds, states, |[q, v, a, _]| f(q, v, a, out)),
                Entry::Four(f) => repeat(rounds, states, |[q, v, a, w]| f(q, v, a, w, out)),
            }
        }
    }
}
