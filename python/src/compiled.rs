//! Compiled functions: a shared object's, called as those of the library are.

#![allow(unsafe_code)]

use std::path::PathBuf;
use std::sync::Arc;

use libloading::Library;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use crate::batch::Kernel;
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

/// Functions of a shared object that was compiled for a robot: rows of the table, each with the
/// name of its loop, its own name and its text.
#[pyfunction]
pub(crate) fn load_compiled<'py>(
    py: Python<'py>,
    robot: &Bound<'py, Robot>,
    path: PathBuf,
    rows: Vec<(usize, String, String, String)>,
) -> PyResult<Vec<Bound<'py, PyAny>>> {
    let wrong = |error: libloading::Error| PyRuntimeError::new_err(format!("compile: found no library in {}: {error}", path.display()));
    // SAFETY: `_compiled.py` compiled it from generated code, which runs nothing when loaded.
    let library = Arc::new(unsafe { Library::new(&path) }.map_err(wrong)?);
    let one = |(index, symbol, name, text): (usize, String, String, String)| {
        // SAFETY: `_compiled.py` writes a function of this type under this name, for a robot of
        // these sizes: it is part of the key of the file in the cache.
        let function: Loop = *unsafe { library.get::<Loop>(symbol.as_bytes()) }.map_err(wrong)?;
        let compiled = CompiledFunction { robot: robot.clone().unbind(), index, function, _library: Arc::clone(&library) };
        callable(py, &name, &text, compiled)
    };
    rows.into_iter().map(one).collect()
}
