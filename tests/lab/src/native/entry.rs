//! Types of functions by how many arrays they read: from one to four.

use std::mem::transmute;

use super::peer::H;
use super::{Native, O, P};

/// A type of functions that take the arguments before the semicolon, then the arrays that they
/// read, then the rest.
macro_rules! entry {
    ($(#[$doc:meta])* $name:ident($($first:ident: $First:ty)?; $($rest:ident: $Rest:ty),*)) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub(super) enum $name {
            One(unsafe extern "C" fn($($First,)? P, $($Rest),*)),
            Two(unsafe extern "C" fn($($First,)? P, P, $($Rest),*)),
            Three(unsafe extern "C" fn($($First,)? P, P, P, $($Rest),*)),
            Four(unsafe extern "C" fn($($First,)? P, P, P, P, $($Rest),*)),
        }

        impl $name {
            /// The function `symbol` of a library, if there is one and it reads `arrays` arrays.
            ///
            /// # Safety
            /// By its library's interface it takes that many arrays, and the other arguments of
            /// this type.
            pub(super) unsafe fn open(library: &Native, symbol: &str, arrays: usize) -> Option<Self> {
                // SAFETY: a function's address is a pointer; the caller satisfies the other
                // conditions.
                unsafe { Self::at(library.symbol::<P>(symbol)?, arrays) }
            }

            /// The function at this address, which takes `arrays` arrays.
            ///
            /// # Safety
            /// As [`open`](Self::open); the address is null or that of such a function.
            pub(super) unsafe fn at(address: P, arrays: usize) -> Option<Self> {
                if address.is_null() {
                    return None;
                }
                // SAFETY: by the caller's promise, the address has the type that it gets here.
                unsafe {
                    Some(match arrays {
                        1 => Self::One(transmute::<P, unsafe extern "C" fn($($First,)? P, $($Rest),*)>(address)),
                        2 => Self::Two(transmute::<P, unsafe extern "C" fn($($First,)? P, P, $($Rest),*)>(address)),
                        3 => Self::Three(transmute::<P, unsafe extern "C" fn($($First,)? P, P, P, $($Rest),*)>(address)),
                        4 => Self::Four(transmute::<P, unsafe extern "C" fn($($First,)? P, P, P, P, $($Rest),*)>(address)),
                        _ => return None,
                    })
                }
            }

            /// Calls the function on all states, for `rounds` rounds: one loop for each number of
            /// arrays, so that there is no choice inside.
            ///
            /// # Safety
            /// The library is open, each state has as many arrays as the function reads, and all
            /// arrays are as long as it reads or writes.
            #[inline(always)]
            pub(super) unsafe fn run(self, rounds: usize, states: &[[P; 4]], $($first: $First,)? $($rest: $Rest),*) {
                // SAFETY: the caller satisfies the conditions of the called functions.
                unsafe {
                    match self {
                        Self::One(f) => each(rounds, states, |[q, ..]| f($($first,)? q, $($rest),*)),
                        Self::Two(f) => each(rounds, states, |[q, v, ..]| f($($first,)? q, v, $($rest),*)),
                        Self::Three(f) => each(rounds, states, |[q, v, a, _]| f($($first,)? q, v, a, $($rest),*)),
                        Self::Four(f) => each(rounds, states, |[q, v, a, w]| f($($first,)? q, v, a, w, $($rest),*)),
                    }
                }
            }
        }
    };
}

/// For types of functions with a result that the next call can wait for.
macro_rules! waiting {
    ($name:ident($($first:ident: $First:ty)?; $($rest:ident: $Rest:ty),*)) => {
        impl $name {
            /// The same, each call after the one before: its first array is a copy that waits for
            /// the result before (see [`Waiting`]).
            ///
            /// # Safety
            /// As [`run`](Self::run); the function writes at least one number to the waiting call's
            /// result.
            #[inline(always)]
            pub(super) unsafe fn run_waiting(self, rounds: usize, states: &[[P; 4]], waiting: &mut Waiting, $($first: $First,)? $($rest: $Rest),*) {
                // SAFETY: the caller satisfies the conditions of the called functions.
                unsafe {
                    match self {
                        Self::One(f) => each(rounds, states, |[q, ..]| f($($first,)? waiting.after(q), $($rest),*)),
                        Self::Two(f) => each(rounds, states, |[q, v, ..]| f($($first,)? waiting.after(q), v, $($rest),*)),
                        Self::Three(f) => each(rounds, states, |[q, v, a, _]| f($($first,)? waiting.after(q), v, a, $($rest),*)),
                        Self::Four(f) => each(rounds, states, |[q, v, a, w]| f($($first,)? waiting.after(q), v, a, w, $($rest),*)),
                    }
                }
            }
        }
    };
}

/// Makes a call wait for the call before it: q + 0·(first + last number of the result), in an array
/// of its own. A processor cannot begin the arithmetic of such a call early, as it does with calls
/// that do not depend on each other.
pub(super) struct Waiting {
    q: Vec<f64>,
    out: *const f64,
    last: usize,
}

impl Waiting {
    /// For arrays of `length` numbers and a result of `out` numbers, at least one, that is written
    /// where `result` points.
    pub(super) fn new(length: usize, result: *const f64, out: usize) -> Self {
        Self { q: vec![0.0; length], out: result, last: out - 1 }
    }

    /// # Safety
    /// `q` points to as many numbers as were promised, and the result is as long as promised, and
    /// alive.
    #[inline(always)]
    unsafe fn after(&mut self, q: P) -> P {
        // SAFETY: both are as long as promised; volatile reads, so that no compiler knows the
        // numbers.
        unsafe {
            let wait = 0.0 * (self.out.read_volatile() + self.out.add(self.last).read_volatile());
            std::ptr::copy_nonoverlapping(q.cast::<f64>(), self.q.as_mut_ptr(), self.q.len());
            self.q.iter_mut().for_each(|x| *x += wait);
        }
        self.q.as_ptr().cast()
    }
}

entry! {
    /// A function of one state, which the command has compiled.
    OfState(; out: O)
}

waiting!(OfState(; out: O));

entry! {
    /// A function of many states at once, compiled by the command.
    OfStates(; out: O, count: usize)
}

entry! {
    /// A peer's function of its robot that writes its result.
    Writing(robot: H; out: O)
}

waiting!(Writing(robot: H; out: O));

entry! {
    /// A peer's function of its robot that keeps its result until it is requested.
    Keeping(robot: H; )
}

#[inline(always)]
fn each(rounds: usize, states: &[[P; 4]], mut call: impl FnMut([P; 4])) {
    for _ in 0..rounds {
        for state in states {
            call(*state);
        }
    }
}
