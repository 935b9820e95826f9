//! Many states over all cores: slices of states are halved until the parts are small, and each part
//! is computed at once by a batch function.

use std::sync::atomic::{AtomicUsize, Ordering};

/// Slices with an element a state, or a block of states, read or written: `&[T]`, `&mut [T]`, and
/// tuples of them.
pub trait States: Sized + Send {
    /// Whether an element is a block, which fills vectors by itself: a block begins a cache line,
    /// as the `Lanes` of generated modules do.
    const BLOCKS: bool;

    /// How many elements there are; `None` if the slices of a tuple do not agree.
    fn count(&self) -> Option<usize>;

    /// The first `count` elements, and the rest.
    ///
    /// # Panics
    /// If there are fewer.
    fn split(self, count: usize) -> (Self, Self);
}

impl<T: Sync> States for &[T] {
    const BLOCKS: bool = align_of::<T>() >= LINE;

    fn count(&self) -> Option<usize> {
        Some(self.len())
    }

    fn split(self, count: usize) -> (Self, Self) {
        self.split_at(count)
    }
}

impl<T: Send> States for &mut [T] {
    const BLOCKS: bool = align_of::<T>() >= LINE;

    fn count(&self) -> Option<usize> {
        Some(self.len())
    }

    fn split(self, count: usize) -> (Self, Self) {
        self.split_at_mut(count)
    }
}

macro_rules! tuples {
    ($($first:ident $($other:ident)*;)+) => { $(
        #[allow(non_snake_case)]
        impl<$first: States, $($other: States),*> States for ($first, $($other,)*) {
            const BLOCKS: bool = $first::BLOCKS $(|| $other::BLOCKS)*;

            fn count(&self) -> Option<usize> {
                let ($first, $($other,)*) = self;
                let count = $first.count()?;
                ($($other.count() == Some(count) &&)* true).then_some(count)
            }

            fn split(self, count: usize) -> (Self, Self) {
                let ($first, $($other,)*) = self;
                let ($first, $($other,)*) = ($first.split(count), $($other.split(count),)*);
                (($first.0, $($other.0,)*), ($first.1, $($other.1,)*))
            }
        }
    )+ };
}

tuples! {
    A;
    A B;
    A B C;
    A B C D;
    A B C D E;
    A B C D E F;
    A B C D E F G;
    A B C D E F G H;
}

/// The most states that are computed between two calls of the progress.
const MOST: usize = 1024;

/// Parts have a multiple of this many states, so that vectors are full: the states of a block of
/// `f32`. Parts of blocks have any number of them.
const BLOCK: usize = 16;

/// Bytes of a cache line, at the start of which each number of a block is.
const LINE: usize = 64;

/// Computes many states by all threads of the current `rayon` pool: `function` on parts of the
/// slices, at the same time.
///
/// A generated batch function returns the same bits for a state whatever the other states are, so
/// the result does not depend on the number of threads. Nothing is allocated for a state or a part.
///
/// ```
/// use articulated::in_threads;
///
/// // As many::batch_f64::kinetic_energy is called: reads q and v, writes the energies.
/// fn energies(q: &[[f64; 2]], v: &[[f64; 2]], out: &mut [f64]) -> Result<(), String> {
///     q.iter().zip(v).zip(out).for_each(|((q, v), out)| *out = 0.5 * (v[0] * v[0] + q[0].cos() * v[1] * v[1]));
///     Ok(())
/// }
///
/// let (q, v) = (vec![[0.3, 0.1]; 5000], vec![[1.0, -2.0]; 5000]);
/// let mut out = vec![0.0; 5000];
/// in_threads((&q[..], &v[..], &mut out[..]), |(q, v, out)| energies(q, v, out), |done| eprintln!("{done} states of 5000"))?;
/// # Ok::<(), String>(())
/// ```
///
/// Blocks of states (`…_blocks` of a generated module) are parted between any two, and counted as
/// blocks.
///
/// `progress` receives the number of states (or blocks) done, from the thread that has just
/// computed a part: every number once, but not always in rising order. The last part makes it the
/// number of all states.
///
/// # Errors
/// The error of `function`: of all parts the first. Slices of different lengths are passed to it
/// unchanged, for it to refuse.
///
/// # Panics
/// If `function` or `progress` does.
pub fn in_threads<S: States, E: Send>(
    states: S,
    function: impl Fn(S) -> Result<(), E> + Sync,
    progress: impl Fn(usize) + Sync,
) -> Result<(), E> {
    let Some(count) = states.count() else { return function(states) };
    // Some parts for each thread, so that no thread waits long for the last.
    let part = count.div_ceil(8 * rayon::current_num_threads()).next_multiple_of(if S::BLOCKS { 1 } else { BLOCK }).min(MOST);
    Work { function, progress, done: AtomicUsize::new(0), part }.halve(states, count)
}

struct Work<F, P> {
    function: F,
    progress: P,
    done: AtomicUsize,
    /// The most states of a part.
    part: usize,
}

impl<F: Sync, P: Fn(usize) + Sync> Work<F, P> {
    fn halve<S: States, E: Send>(&self, states: S, count: usize) -> Result<(), E>
    where
        F: Fn(S) -> Result<(), E>,
    {
        if count <= self.part {
            (self.function)(states)?;
            (self.progress)(self.done.fetch_add(count, Ordering::Relaxed) + count);
            return Ok(());
        }
        let half = (count / 2).next_multiple_of(self.part);
        let (first, rest) = states.split(half);
        let (first, rest) = rayon::join(|| self.halve(first, half), || self.halve(rest, count - half));
        first.and(rest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Clone, Copy)]
    #[repr(align(64))]
    struct Lanes([f32; 16]);

    /// How many parts four threads get.
    fn parts<S: States>(states: S) -> usize {
        let count = AtomicUsize::new(0);
        let function = |_| {
            count.fetch_add(1, Ordering::Relaxed);
            Ok::<(), ()>(())
        };
        rayon::ThreadPoolBuilder::new().num_threads(4).build().unwrap().install(|| in_threads(states, function, |_| ())).unwrap();
        count.into_inner()
    }

    #[test]
    fn a_part_is_one_block_or_sixteen_states() {
        let (blocks, states, mut out) = ([[Lanes([0.5; 16]); 3]; 32], [[0.5_f32; 3]; 32], [Lanes([0.0; 16]); 32]);
        assert_eq!((parts(&blocks[..]), parts((&states[..], &blocks[..], &mut out[..]))), (32, 32));
        assert_eq!((parts(&states[..]), parts((&states[..], (&states[..], &states[..])))), (2, 2));
        assert!(blocks[31][2].0[15] == 0.5);
    }
}
