//! Functions that peers compute.

use std::ffi::{CString, c_char, c_int};
use std::rc::Rc;

use super::entry::{Keeping, Waiting, Writing};
use super::peer::{H, NativePeer, Opened};
use super::{Lengths, O, P, all_pointers, pointers};

/// A peer's function of its robot, with the lengths it was promised to have. Keeps its robot open.
#[derive(Clone, Debug)]
pub(crate) struct PeerKernel {
    entry: Entry,
    /// The function's name, if it keeps its result until it is requested.
    kept: Option<CString>,
    lengths: Lengths,
    robot: Rc<Opened>,
}

#[derive(Clone, Copy, Debug)]
enum Entry {
    Writing(Writing),
    Keeping(Keeping),
}

impl Entry {
    /// # Safety
    /// The robot is open, each state has as many arrays as the function takes, each as long as it
    /// reads, and `out` is as long as it writes.
    #[inline(always)]
    unsafe fn run(self, rounds: usize, states: &[[P; 4]], robot: H, out: O) {
        // SAFETY: the caller satisfies the conditions of the called functions.
        unsafe {
            match self {
                Self::Writing(f) => f.run(rounds, states, robot, out),
                Self::Keeping(f) => f.run(rounds, states, robot),
            }
        }
    }
}

impl NativePeer {
    /// The peer's function, which takes arrays of these lengths and returns `out` numbers: in an
    /// array, or, if `kept`, on request.
    pub(crate) fn kernel(&self, function: &str, arguments: &[usize], out: usize, kept: bool) -> Option<PeerKernel> {
        let (robot, symbol) = (&self.0, format!("peer_{function}"));
        let told = CString::new(function).ok()?;
        // SAFETY: the type of the interface.
        let keeps: Option<extern "C" fn(H, *const c_char) -> c_int> = unsafe { robot.function("keeps") };
        let kept = kept || keeps.is_some_and(|keeps| keeps(robot.handle, told.as_ptr()) != 0);
        // SAFETY: the type of the interface.
        let has: Option<extern "C" fn(H, *const c_char) -> c_int> = unsafe { robot.function("has") };
        if has.is_some_and(|has| has(robot.handle, told.as_ptr()) == 0) {
            return None;
        }
        // SAFETY: the type of the interface.
        let at: Option<extern "C" fn(H, *const c_char) -> P> = unsafe { robot.function("entry") };
        // SAFETY: by the interface a function takes the arrays of its arguments, and one for its
        // result unless it keeps it, for a function by name or by address.
        let entry = unsafe {
            match (kept, at.map(|at| at(robot.handle, told.as_ptr()))) {
                (false, None) => Entry::Writing(Writing::open(&robot.native, &symbol, arguments.len())?),
                (true, None) => Entry::Keeping(Keeping::open(&robot.native, &symbol, arguments.len())?),
                (false, Some(address)) => Entry::Writing(Writing::at(address, arguments.len())?),
                (true, Some(address)) => Entry::Keeping(Keeping::at(address, arguments.len())?),
            }
        };
        let lengths = Lengths { arguments: arguments.to_vec(), out };
        Some(PeerKernel { entry, kept: kept.then_some(told), lengths, robot: robot.clone() })
    }
}

impl PeerKernel {
    /// Calls the function, and requests its result if it is kept. Returns whether there is a
    /// result.
    ///
    /// # Panics
    /// If a length differs from the promised one.
    pub(crate) fn call(&self, x: &[&[f64]], out: &mut [f64]) -> bool {
        assert!(self.lengths.fit(x, out));
        let (robot, out) = (self.robot.handle, out.as_mut_ptr().cast());
        // SAFETY: the arrays have the lengths that the peer reads and writes, and the robot is open
        // as long as the kernel lives; it is used by one thread only.
        unsafe { self.entry.run(1, &[pointers(x)], robot, out) };
        let Some(name) = &self.kept else { return true };
        type Read = unsafe extern "C" fn(H, *const c_char, O) -> c_int;
        // SAFETY: the type of the interface; it writes the result of the function, whose length was
        // checked.
        unsafe { self.robot.function::<Read>("read").is_some_and(|read| read(robot, name.as_ptr(), out) != 0) }
    }

    /// Calls the function on all states, for `rounds` rounds: lengths are checked once, before the
    /// calls.
    ///
    /// # Panics
    /// If a length differs from the promised one.
    pub(crate) fn repeat(&self, rounds: usize, states: &[Vec<&[f64]>], out: &mut [f64]) {
        assert!(states.iter().all(|x| self.lengths.fit(x, out)));
        // SAFETY: as in `call`.
        unsafe { self.entry.run(rounds, &all_pointers(states), self.robot.handle, out.as_mut_ptr().cast()) }
    }

    /// The same, each call after the result of the one before.
    ///
    /// # Panics
    /// If a length is not the one promised, or if the peer keeps its result
    /// ([`writes`](Self::writes)).
    pub(crate) fn repeat_waiting(&self, rounds: usize, states: &[Vec<&[f64]>], out: &mut [f64]) {
        assert!(states.iter().all(|x| self.lengths.fit(x, out)));
        let Entry::Writing(entry) = self.entry else { panic!("a result that is kept cannot be waited for") };
        out.fill(0.0);
        let mut waiting = Waiting::new(self.lengths.arguments[0], out.as_ptr(), out.len());
        // SAFETY: as in `call`; the result has at least one number, or `Waiting::new` panicked.
        unsafe { entry.run_waiting(rounds, &all_pointers(states), &mut waiting, self.robot.handle, out.as_mut_ptr().cast()) }
    }

    /// Whether the peer writes a result that the next call can wait for.
    pub(crate) fn writes(&self) -> bool {
        matches!(self.entry, Entry::Writing(_))
    }
}
