//! Functions that peers compute.

use std::ffi::{CString, c_char, c_int};
use std::rc::Rc;

use super::peer::{H, NativePeer, Opened};
use super::{Lengths, O, P, begin, repeat};

/// A peer's function of its robot, with the lengths it was promised to have. Keeps its robot open.
#[derive(Clone, Debug)]
pub(crate) struct PeerKernel {
    entry: PeerEntry,
    /// The function's name, where it keeps its result until it is asked for.
    kept: Option<CString>,
    lengths: Lengths,
    robot: Rc<Opened>,
}

/// With an array for the result, and without one.
#[derive(Clone, Copy, Debug)]
enum PeerEntry {
    One(unsafe extern "C" fn(H, P, O)),
    Two(unsafe extern "C" fn(H, P, P, O)),
    Three(unsafe extern "C" fn(H, P, P, P, O)),
    Four(unsafe extern "C" fn(H, P, P, P, P, O)),
    QuietOne(unsafe extern "C" fn(H, P)),
    QuietTwo(unsafe extern "C" fn(H, P, P)),
    QuietThree(unsafe extern "C" fn(H, P, P, P)),
    QuietFour(unsafe extern "C" fn(H, P, P, P, P)),
}

impl PeerEntry {
    /// # Safety
    /// The robot is open, there are as many arrays as the function takes, each as long as it reads, and `out` is as long as it writes.
    #[inline(always)]
    unsafe fn run(self, robot: H, [q, v, a, w]: [P; 4], out: O) {
        // SAFETY: what this function asks for is what they ask for.
        unsafe {
            match self {
                Self::One(f) => f(robot, q, out),
                Self::Two(f) => f(robot, q, v, out),
                Self::Three(f) => f(robot, q, v, a, out),
                Self::Four(f) => f(robot, q, v, a, w, out),
                Self::QuietOne(f) => f(robot, q),
                Self::QuietTwo(f) => f(robot, q, v),
                Self::QuietThree(f) => f(robot, q, v, a),
                Self::QuietFour(f) => f(robot, q, v, a, w),
            }
        }
    }
}

impl NativePeer {
    /// The peer's function, which takes arrays of these lengths and gives `out` numbers: into an array, or, if `kept`, when asked for them.
    pub(crate) fn kernel(&self, function: &str, arguments: &[usize], out: usize, kept: bool) -> Option<PeerKernel> {
        let (robot, name) = (&self.0, function);
        let told = CString::new(function).ok()?;
        // SAFETY: the type of the interface.
        let has: Option<extern "C" fn(H, *const c_char) -> c_int> = unsafe { robot.function("has") };
        if has.is_some_and(|has| has(robot.handle, told.as_ptr()) == 0) {
            return None;
        }
        // SAFETY: by the interface a function takes the arrays of its arguments, and one for its result where it does not keep it.
        let entry = unsafe {
            match (arguments.len(), kept) {
                (1, false) => PeerEntry::One(robot.function(name)?),
                (2, false) => PeerEntry::Two(robot.function(name)?),
                (3, false) => PeerEntry::Three(robot.function(name)?),
                (4, false) => PeerEntry::Four(robot.function(name)?),
                (1, true) => PeerEntry::QuietOne(robot.function(name)?),
                (2, true) => PeerEntry::QuietTwo(robot.function(name)?),
                (3, true) => PeerEntry::QuietThree(robot.function(name)?),
                (4, true) => PeerEntry::QuietFour(robot.function(name)?),
                _ => return None,
            }
        };
        let lengths = Lengths { arguments: arguments.to_vec(), out };
        Some(PeerKernel { entry, kept: kept.then_some(told), lengths, robot: robot.clone() })
    }
}

impl PeerKernel {
    /// Calls the function, and asks for its result if it is kept. Whether there is a result.
    ///
    /// # Panics
    /// If a length is not the one promised.
    pub(crate) fn call(&self, x: &[&[f64]], out: &mut [f64]) -> bool {
        assert!(self.lengths.fit(x, out));
        let (robot, out) = (self.robot.handle, out.as_mut_ptr());
        // SAFETY: the arrays have the lengths that the peer reads and writes, and the robot is open as long as the kernel lives; it is used by one thread only.
        unsafe { self.entry.run(robot, begin(x), out) };
        let Some(name) = &self.kept else { return true };
        type Read = unsafe extern "C" fn(H, *const c_char, O) -> c_int;
        // SAFETY: the type of the interface; it writes the result of the function, whose length was checked.
        unsafe { self.robot.function::<Read>("read").is_some_and(|read| read(robot, name.as_ptr(), out) != 0) }
    }

    /// Calls the function on all states, so many rounds: lengths are checked once, and then only called.
    ///
    /// # Panics
    /// If a length is not the one promised.
    pub(crate) fn repeat(&self, rounds: usize, states: &[Vec<&[f64]>], out: &mut [f64]) {
        assert!(states.iter().all(|x| self.lengths.fit(x, out)));
        let (robot, out) = (self.robot.handle, out.as_mut_ptr());
        // One loop for each number of arguments, so that nothing is chosen inside.
        // SAFETY: as in `call`.
        unsafe {
            match self.entry {
                PeerEntry::One(f) => repeat(rounds, states, |[q, ..]| f(robot, q, out)),
                PeerEntry::Two(f) => repeat(rounds, states, |[q, v, ..]| f(robot, q, v, out)),
                PeerEntry::Three(f) => repeat(rounds, states, |[q, v, a, _]| f(robot, q, v, a, out)),
                other => repeat(rounds, states, |x| other.run(robot, x, out)),
            }
        }
    }
}
