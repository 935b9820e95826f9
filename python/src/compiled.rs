//! Compiled functions: a shared object's, called as those of the library are.

#![allow(unsafe_code)]

use std::path::{Path, PathBuf};
use std::sync::Arc;

use libloading::Library;
use numpy::{IntoPyArray, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::batch::Kernel;
use crate::derived::{PART, Parts, rows, wrong};
use crate::method::callable;
use crate::robot::Robot;

/// `void NAME(size_t states, const double *const *given, const size_t *steps, double *out)`: for
/// each state, argument i is at `given[i] + state * steps[i]`; results follow each other.
/// `articulated/_compiled.py` writes it.
pub(crate) type Loop = unsafe extern "C" fn(usize, *const *const f64, *const usize, *mut f64);

/// A function of a shared object, for a robot.
#[pyclass(frozen, module = "articulated._native")]
pub(crate) struct CompiledFunction {
    pub(crate) robot: Py<Robot>,
    pub(crate) index: usize,
    function: Loop,
    /// Keeps `function` loaded.
    _library: Arc<Library>,
}

impl CompiledFunction {
    pub(crate) fn kernel(&self) -> Kernel<'static> {
        Kernel::Compiled(self.function)
    }
}

/// `void NAME(size_t states, const double *const *given, double *const *out)`: argument i of state
/// k is at `given[i] + k * length of i`, result j at `out[j] + k * length of j`.
type RowsLoop = unsafe extern "C" fn(usize, *const *const f64, *const *mut f64);

/// A derivative of a shared object, for a robot.
#[pyclass(frozen, module = "articulated._native")]
pub(crate) struct CompiledDerivative {
    function: RowsLoop,
    takes: Vec<usize>,
    gives: Vec<usize>,
    /// Keeps `function` loaded.
    _library: Arc<Library>,
}

#[pymethods]
impl CompiledDerivative {
    /// The results: arrays with a row for each state. So are the arguments.
    fn run<'py>(&self, py: Python<'py>, arguments: Vec<PyReadonlyArray2<'py, f64>>, threads: usize) -> PyResult<Parts<'py>> {
        let (states, lengths, given) = rows(&arguments)?;
        if lengths != self.takes {
            return Err(wrong());
        }
        let mut results: Vec<Vec<f64>> = self.gives.iter().map(|size| vec![0.0; states * size]).collect();
        py.detach(|| {
            let part = if threads == 1 { states.max(1) } else { PART };
            // Rows of each part: those of the arguments, and those of the results.
            let mut parts: Vec<(usize, Vec<&mut [f64]>)> = (0..states).step_by(part).map(|first| (first, Vec::new())).collect();
            for (all, size) in results.iter_mut().zip(&self.gives) {
                let mut rest = all.as_mut_slice();
                for (first, own) in &mut parts {
                    let (rows, others) = core::mem::take(&mut rest).split_at_mut(part.min(states - *first) * size);
                    own.push(rows);
                    rest = others;
                }
            }
            let run = |(first, mut out): (usize, Vec<&mut [f64]>)| {
                let count = part.min(states - first);
                let from: Vec<*const f64> = given.iter().zip(&lengths).map(|(all, size)| all[first * size..].as_ptr()).collect();
                let to: Vec<*mut f64> = out.iter_mut().map(|rows| rows.as_mut_ptr()).collect();
                // SAFETY: the loop was written for rows of these lengths, `count` in each.
                unsafe { (self.function)(count, from.as_ptr(), to.as_ptr()) };
            };
            if threads == 1 {
                parts.into_iter().for_each(run);
            } else {
                parts.into_par_iter().for_each(run);
            }
        });
        let array = |(numbers, size): (Vec<f64>, &usize)| numbers.into_pyarray(py).reshape([states, *size]);
        results.into_iter().zip(&self.gives).map(array).collect()
    }
}

/// Derivatives of a shared object that was compiled for a robot: of each the name of its loop, and
/// the lengths of its arguments and results.
#[pyfunction]
pub(crate) fn load_derivatives(path: PathBuf, rows: Vec<(String, Vec<usize>, Vec<usize>)>) -> PyResult<Vec<CompiledDerivative>> {
    let library = opened(&path)?;
    let one = |(symbol, takes, gives): (String, Vec<usize>, Vec<usize>)| {
        // SAFETY: `_compiled.py` writes a function of this type under this name, for these lengths.
        let function: RowsLoop = *unsafe { library.get::<RowsLoop>(symbol.as_bytes()) }.map_err(|error| missing(&path, &error))?;
        Ok(CompiledDerivative { function, takes, gives, _library: Arc::clone(&library) })
    };
    rows.into_iter().map(one).collect()
}

fn opened(path: &Path) -> PyResult<Arc<Library>> {
    // SAFETY: `_compiled.py` compiled it from generated code, which runs nothing when loaded.
    unsafe { Library::new(path) }.map(Arc::new).map_err(|error| missing(path, &error))
}

fn missing(path: &Path, error: &libloading::Error) -> PyErr {
    PyRuntimeError::new_err(format!("compile: found no library in {}: {error}", path.display()))
}

/// Functions of a shared object that was compiled for a robot: rows of the table, each with the
/// name of its loop, its own name and its text.
#[pyfunction]
pub(crate) fn load_compiled<'py>(
    py: Python<'py>,
    robot: &Bound<'py, Robot>,
    path: PathBuf,
    rows: Vec<(usize, String, String, String)>,
) -> PyResult<Vec<Bound<'py, PyAny>>> {
    let library = opened(&path)?;
    let one = |(index, symbol, name, text): (usize, String, String, String)| {
        // SAFETY: `_compiled.py` writes a function of this type under this name, for a robot of
        // these sizes: it is part of the key of the file in the cache.
        let function: Loop = *unsafe { library.get::<Loop>(symbol.as_bytes()) }.map_err(|error| missing(&path, &error))?;
        let compiled = CompiledFunction { robot: robot.clone().unbind(), index, function, _library: Arc::clone(&library) };
        callable(py, &name, &text, compiled)
    };
    rows.into_iter().map(one).collect()
}
