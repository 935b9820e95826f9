//! Functions of many states at once, and memory for their arguments.

use std::hint::black_box;

use articulated_core::lanes::Real;

use super::entry::OfStates;
use super::{Native, P};

/// Numbers of one type, at the start of a cache line.
#[derive(Clone, Debug)]
pub(crate) struct Numbers {
    lines: Vec<Line>,
    real: Real,
    len: usize,
}

#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
struct Line([u8; LINE]);

const LINE: usize = 64;

impl Numbers {
    /// Rounded to the type.
    pub(crate) fn new(real: Real, numbers: impl ExactSizeIterator<Item = f64>) -> Self {
        let len = numbers.len();
        let mut lines = vec![Line([0; LINE]); (len * real.bytes()).div_ceil(LINE)];
        for (k, x) in numbers.enumerate() {
            let at = k * real.bytes();
            let bytes = &mut lines[at / LINE].0[at % LINE..][..real.bytes()];
            match real {
                Real::F64 => bytes.copy_from_slice(&x.to_ne_bytes()),
                Real::F32 => bytes.copy_from_slice(&(x as f32).to_ne_bytes()),
            }
        }
        Self { lines, real, len }
    }

    /// Number `k`.
    pub(crate) fn get(&self, k: usize) -> f64 {
        let at = k * self.real.bytes();
        let bytes = &self.lines[at / LINE].0[at % LINE..];
        match self.real {
            Real::F64 => bytes.first_chunk().map_or(f64::NAN, |b| f64::from_ne_bytes(*b)),
            Real::F32 => bytes.first_chunk().map_or(f64::NAN, |b| f32::from_ne_bytes(*b).into()),
        }
    }
}

/// A function on slices of a number of states or blocks, with the promised number of numbers of
/// each. Keeps its library open.
#[derive(Clone, Debug)]
pub(crate) struct BatchKernel {
    entry: OfStates,
    real: Real,
    arguments: Vec<usize>,
    out: usize,
    _library: Native,
}

impl Native {
    /// The function `name`, which reads `arguments` numbers of each state, or block of states, and
    /// writes `out` of each.
    pub(crate) fn batch_kernel(&self, name: &str, real: Real, arguments: &[usize], out: usize) -> Option<BatchKernel> {
        // SAFETY: compiled functions of many states take their arguments' arrays, the result's
        // array, and the number of states.
        let entry = unsafe { OfStates::open(self, name, arguments.len())? };
        Some(BatchKernel { entry, real, arguments: arguments.to_vec(), out, _library: self.clone() })
    }
}

impl BatchKernel {
    /// Calls the function on all states, for `rounds` rounds.
    ///
    /// # Panics
    /// If a length differs from the promised one.
    pub(crate) fn repeat(&self, rounds: usize, count: usize, x: &[Numbers], out: &mut Numbers) {
        let is = |numbers: &Numbers, each: usize| numbers.real == self.real && numbers.len == count * each;
        assert!(x.len() == self.arguments.len() && is(out, self.out));
        assert!(x.iter().zip(&self.arguments).all(|(x, each)| is(x, *each)));
        let arrays: [P; 4] = std::array::from_fn(|k| x.get(k).map_or(std::ptr::null(), |x| x.lines.as_ptr().cast()));
        // SAFETY: the arrays have the type and the lengths that the library reads and writes, and
        // it is open as long as the kernel lives.
        unsafe { self.entry.run(rounds, black_box(&[arrays]), out.lines.as_mut_ptr().cast(), count) }
    }
}
