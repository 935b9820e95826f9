//! Functions of many states, as generated modules have them.

use std::fmt::Display;

use articulated::Shape;
use articulated::algorithm::Function;

/// What a batch function has for one state: a number, or an array of what is a `State`.
pub trait State: Sized + private::Sealed {
    /// How many numbers.
    const LEN: usize;

    /// The states in a row of numbers.
    fn states(numbers: &[f64]) -> &[Self];

    /// The same, to be written.
    fn states_mut(numbers: &mut [f64]) -> &mut [Self];
}

mod private {
    pub trait Sealed {}
    impl Sealed for f64 {}
    impl<T: Sealed, const N: usize> Sealed for [T; N] {}
}

impl State for f64 {
    const LEN: usize = 1;

    fn states(numbers: &[f64]) -> &[Self] {
        numbers
    }

    fn states_mut(numbers: &mut [f64]) -> &mut [Self] {
        numbers
    }
}

impl<T: State, const N: usize> State for [T; N] {
    const LEN: usize = T::LEN * N;

    fn states(numbers: &[f64]) -> &[Self] {
        const { assert!(N > 0, "found arrays of no numbers") };
        T::states(numbers).as_chunks().0
    }

    fn states_mut(numbers: &mut [f64]) -> &mut [Self] {
        const { assert!(N > 0, "found arrays of no numbers") };
        T::states_mut(numbers).as_chunks_mut().0
    }
}

/// A function of many states: slices with an element for each state, the result the last. The
/// functions of a generated module's `batch_f64` are such functions. `Kind` is inferred.
pub trait Batch<Kind>: Send + Sync + 'static {
    /// How many numbers each argument has for one state, and the result last.
    fn lens() -> Vec<usize>;

    /// Computes all states; the arguments in their order, each of all states.
    ///
    /// # Errors
    /// The message of the function.
    fn run(&self, arguments: &[&[f64]], out: &mut [f64]) -> Result<(), String>;
}

macro_rules! batches {
    ($($($argument:ident $index:literal),+;)+) => { $(
        impl<F, $($argument: State,)+ Out: State, E: Display> Batch<($($argument,)+ Out, E)> for F
        where
            F: Fn($(&[$argument],)+ &mut [Out]) -> Result<(), E> + Send + Sync + 'static,
        {
            fn lens() -> Vec<usize> {
                vec![$($argument::LEN,)+ Out::LEN]
            }

            fn run(&self, arguments: &[&[f64]], out: &mut [f64]) -> Result<(), String> {
                self($($argument::states(arguments[$index]),)+ Out::states_mut(out)).map_err(|error| error.to_string())
            }
        }
    )+ };
}

batches! {
    A 0;
    A 0, B 1;
    A 0, B 1, C 2;
    A 0, B 1, C 2, D 3;
}

/// What a batch function is called as, by any of its names.
pub(crate) type Run = dyn Fn(&[&[f64]], &mut [f64]) -> Result<(), String> + Send + Sync;

/// Why functions of these sizes are not batches of this function; all reasons.
pub(crate) fn mismatches(function: &Function<f64>, shape: Shape, lens: &[usize]) -> Vec<String> {
    let (out, arguments) = lens.split_last().unwrap_or((&0, &[]));
    if arguments.len() != function.takes.len() {
        let names: Vec<&str> = function.takes.iter().map(|argument| argument.name()).collect();
        return vec![format!("found {} arguments, expected {}: {}", arguments.len(), names.len(), names.join(", "))];
    }
    let expected = function.takes.iter().map(|argument| (argument.name(), argument.len(shape)));
    let all = expected.chain([("the result", function.len(shape))]).zip(arguments.iter().chain([out]));
    let wrong = all.filter(|((_, expected), found)| expected != *found);
    wrong.map(|((name, expected), found)| format!("{name}: found {found} numbers for each state, expected {expected}")).collect()
}
