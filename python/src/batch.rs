//! The loop over states, in one thread or in several.

// For calls of compiled functions, which do no checks.
#![allow(unsafe_code)]

use std::collections::HashMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use articulated::algorithm::Function;
use articulated::{FunctionError, Model, Scalar, Workspace};
use pyo3::exceptions::{PyRuntimeError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBool;
use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::compiled::Loop;
use crate::signature::MOST_ARGUMENTS;

/// Maximum number of threads of a call.
const MOST_THREADS: usize = 1024;

/// States between two looks at signals, so that a user can interrupt a long call.
const BLOCK: usize = 1 << 15;

/// Workspaces that no call uses at the moment.
pub(crate) struct Workspaces<T: Scalar>(Mutex<Vec<Workspace<T>>>);

impl<T: Scalar> Default for Workspaces<T> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<T: Scalar> Workspaces<T> {
    /// Runs with a workspace of the model: one that is free, or a new one. Never waits, so that a
    /// process that was forked in the middle of another thread's call does not wait for ever.
    fn with<R>(&self, model: &Model<T>, run: impl FnOnce(&mut Workspace<T>) -> R) -> R {
        let free = self.0.try_lock().ok().and_then(|mut free| free.pop());
        let mut ws = free.unwrap_or_else(|| Workspace::new(model));
        let out = run(&mut ws);
        if let Ok(mut free) = self.0.try_lock() {
            free.push(ws);
        }
        out
    }
}

/// A function of the library, for a model.
pub(crate) struct Generic<'a, T: Scalar> {
    pub(crate) function: &'static Function<T>,
    pub(crate) model: &'a Model<T>,
    pub(crate) workspaces: &'a Workspaces<T>,
}

/// Implementation of a function.
pub(crate) enum Kernel<'a> {
    /// The library.
    Generic(Generic<'a, f64>),
    /// Compiled code for the robot whose signature checks arguments and results.
    Compiled(Loop),
}

/// The numbers of an argument, those of one state, and the step from one state to the next: zero if
/// it is the same for all.
pub(crate) type Numbers<'a, T> = (&'a [T], usize, usize);

/// Computes many states.
pub(crate) trait Compute<T>: Sync {
    /// The states from number `first` on, as many as `out` has room for; `len` numbers each.
    fn compute(&self, arguments: &[Numbers<'_, T>], len: usize, first: usize, out: &mut [T]) -> Result<(), FunctionError>;
}

impl<T: Scalar + Send + Sync> Compute<T> for Generic<'_, T> {
    fn compute(&self, all: &[Numbers<'_, T>], len: usize, first: usize, out: &mut [T]) -> Result<(), FunctionError> {
        self.workspaces.with(self.model, |ws| {
            let mut arguments: Vec<&[T]> = Vec::with_capacity(all.len());
            for (i, out) in out.chunks_exact_mut(len).enumerate() {
                arguments.clear();
                arguments.extend(all.iter().map(|(numbers, len, step)| &numbers[(first + i) * step..][..*len]));
                self.function.call(self.model, ws, &arguments, out)?;
            }
            Ok(())
        })
    }
}

impl Compute<f64> for Kernel<'_> {
    fn compute(&self, arguments: &[Numbers<'_, f64>], len: usize, first: usize, out: &mut [f64]) -> Result<(), FunctionError> {
        match self {
            Self::Generic(generic) => generic.compute(arguments, len, first, out),
            Self::Compiled(function) => {
                let states = out.len() / len;
                let last = first + states.saturating_sub(1);
                let place = |&(all, len, step): &Numbers<'_, f64>| all[first * step..last * step + len].as_ptr();
                let places: Vec<*const f64> = arguments.iter().map(place).collect();
                let steps: Vec<usize> = arguments.iter().map(|(_, _, step)| *step).collect();
                // SAFETY: for each of `states` states it reads and writes as many numbers, of each
                // argument and of the result, as the signature has; the slices above contain all of
                // them.
                unsafe { function(states, places.as_ptr(), steps.as_ptr(), out.as_mut_ptr()) };
                Ok(())
            }
        }
    }
}

impl Kernel<'_> {
    /// One state, whose arguments and result have the sizes of the robot's signature.
    pub(crate) fn one(&self, arguments: &[&[f64]], out: &mut [f64]) -> PyResult<()> {
        match self {
            Self::Generic(Generic { function, model, workspaces }) => {
                let done = workspaces.with(model, |ws| function.call(model, ws, arguments, out));
                done.map_err(|error| PyValueError::new_err(error.to_string()))
            }
            Self::Compiled(function) => {
                let mut places = [std::ptr::null(); MOST_ARGUMENTS];
                places.iter_mut().zip(arguments).for_each(|(place, argument)| *place = argument.as_ptr());
                // SAFETY: it reads and writes as many numbers, of each argument and of the result,
                // as the signature has.
                unsafe { function(1, places.as_ptr(), [0; MOST_ARGUMENTS].as_ptr(), out.as_mut_ptr()) };
                Ok(())
            }
        }
    }
}

/// A call with its arguments checked.
pub(crate) struct Call<'a, T, K> {
    pub(crate) kernel: &'a K,
    pub(crate) arguments: Vec<Numbers<'a, T>>,
    /// Numbers of one result.
    pub(crate) len: usize,
}

impl<T: Send + Sync, K: Compute<T>> Call<'_, T, K> {
    fn states(&self, first: usize, out: &mut [T]) -> Result<(), FunctionError> {
        self.kernel.compute(&self.arguments, self.len, first, out)
    }

    /// Computes all states of `out`, in this number of threads.
    pub(crate) fn run(&self, py: Python<'_>, out: &mut [T], threads: usize) -> PyResult<()> {
        if out.is_empty() {
            return Ok(());
        }
        // One state takes less time than other threads need to notice that they may run.
        if out.len() == self.len {
            return told(catch_unwind(AssertUnwindSafe(|| self.states(0, out))));
        }
        let pool = pool(threads)?;
        for (block, out) in out.chunks_mut(BLOCK * self.len).enumerate() {
            let first = block * BLOCK;
            told(py.detach(|| catch_unwind(AssertUnwindSafe(|| self.block(first, out, pool.as_deref())))))?;
            py.check_signals()?;
        }
        Ok(())
    }

    fn block(&self, first: usize, out: &mut [T], pool: Option<&ThreadPool>) -> Result<(), FunctionError> {
        let Some(pool) = pool else { return self.states(first, out) };
        // Some parts for each thread, so that no thread waits long for the last.
        let part = (out.len() / self.len).div_ceil(8 * pool.current_num_threads());
        let one = |(i, out): (usize, &mut [T])| self.states(first + i * part, out);
        pool.install(|| out.par_chunks_mut(part * self.len).enumerate().try_for_each(one))
    }
}

/// The outcome of a call, as Python's error.
fn told(outcome: std::thread::Result<Result<(), FunctionError>>) -> PyResult<()> {
    match outcome {
        Ok(result) => result.map_err(|error| PyValueError::new_err(error.to_string())),
        Err(_) => Err(mistake()),
    }
}

/// The error for a panic.
pub(crate) fn mistake() -> PyErr {
    PyRuntimeError::new_err("found a mistake of articulated itself; please report it with the message above")
}

/// The number of threads that `threads=` means.
pub(crate) fn threads(given: Option<&Bound<'_, PyAny>>) -> PyResult<usize> {
    static ALL: OnceLock<usize> = OnceLock::new();
    let Some(given) = given else { return Ok(1) };
    let expected = format!("expected None or 1 for one thread, 0 for all, or a number to {MOST_THREADS}");
    let wrong = |found: String| PyTypeError::new_err(format!("threads: found {found}, {expected}"));
    if given.is_instance_of::<PyBool>() {
        return Err(wrong("a bool".into()));
    }
    let index = given.call_method0("__index__").map_err(|_| wrong(given.get_type().to_string()))?;
    match index.extract::<usize>() {
        // Requested once: the system takes as long to answer as some ten states take.
        Ok(0) => Ok(*ALL.get_or_init(|| std::thread::available_parallelism().map_or(1, usize::from).min(MOST_THREADS))),
        Ok(count @ ..=MOST_THREADS) => Ok(count),
        _ => Err(PyValueError::new_err(format!("threads: found {index}, {expected}"))),
    }
}

/// Pools by the process and the number of their threads: a forked process has none of its parent's
/// threads.
type Pools = HashMap<(u32, usize), Arc<ThreadPool>>;

/// The pool of this number of threads; `None` for one.
pub(crate) fn pool(threads: usize) -> PyResult<Option<Arc<ThreadPool>>> {
    static POOLS: Mutex<Option<Pools>> = Mutex::new(None);
    if threads == 1 {
        return Ok(None);
    }
    let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    let pools = pools.get_or_insert_default();
    let key = (std::process::id(), threads);
    if let Some(pool) = pools.get(&key) {
        return Ok(Some(Arc::clone(pool)));
    }
    let failed = |error: rayon::ThreadPoolBuildError| PyRuntimeError::new_err(format!("threads: found no {threads} threads: {error}"));
    let pool = Arc::new(ThreadPoolBuilder::new().num_threads(threads).build().map_err(failed)?);
    pools.insert(key, Arc::clone(&pool));
    Ok(Some(pool))
}
