//! Types of functions by how many arrays they read: from one to four.

use super::peer::H;
use super::{Native, O, P};

/// A type of functions that take what stands before the semicolon, then the arrays that they read, then the rest.
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
            /// The function `symbol` of a library, if there is one and it reads so many arrays.
            ///
            /// # Safety
            /// By its library's interface it takes that many arrays, and beside them what this type says.
            pub(super) unsafe fn open(library: &Native, symbol: &str, arrays: usize) -> Option<Self> {
                // SAFETY: what this function asks for is what it asks for.
                unsafe {
                    Some(match arrays {
                        1 => Self::One(library.symbol(symbol)?),
                        2 => Self::Two(library.symbol(symbol)?),
                        3 => Self::Three(library.symbol(symbol)?),
                        4 => Self::Four(library.symbol(symbol)?),
                        _ => return None,
                    })
                }
            }

            /// Calls the function on all states, so many rounds: one loop for each number of arrays, so that nothing is chosen inside.
            ///
            /// # Safety
            /// The library is open, each state has as many arrays as the function reads, and all arrays are as long as it reads or writes.
            #[inline(always)]
            pub(super) unsafe fn run(self, rounds: usize, states: &[[P; 4]], $($first: $First,)? $($rest: $Rest),*) {
                // SAFETY: what this function asks for is what they ask for.
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

entry! {
    /// A function of one state, which the command has compiled.
    OfState(; out: O)
}

entry! {
    /// A function of so many states at once, which the command has compiled.
    OfStates(; out: O, count: usize)
}

entry! {
    /// A peer's function of its robot that writes its result.
    Writing(robot: H; out: O)
}

entry! {
    /// A peer's function of its robot that keeps its result until it is asked for.
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
