//! The native half of the Python package `articulated`: robots, and the table of functions on NumPy
//! arrays.
//!
//! The Python half (`articulated/`) makes a method of each row of the table. This half checks every
//! argument, so that no call from Python panics.

mod arrays;
mod batch;
mod compiled;
mod contacts;
mod derived;
mod errors;
mod exchange;
mod given;
mod method;
mod robot;
mod rollout;
mod scene;
mod signature;

use std::ffi::OsString;
use std::path::PathBuf;

use articulated::algorithm::{Dim, Function, functions};
use articulated::formats::{MOST_BYTES, read_file};
use articulated_core::diagnostic::{Code, Diagnostic, Place};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyList, PyTuple};

/// Names of dimensions, in small letters; numbers stay numbers.
fn dimensions<'py>(py: Python<'py>, dims: &[Dim]) -> PyResult<Bound<'py, PyTuple>> {
    let one = |dim: &Dim| match dim {
        Dim::Of(n) => n.into_pyobject(py).map(Bound::into_any),
        named => Ok(named.to_string().to_lowercase().into_pyobject(py)?.into_any()),
    };
    PyTuple::new(py, dims.iter().map(one).collect::<Result<Vec<_>, _>>()?)
}

fn row<'py>(py: Python<'py>, function: &Function<f64>) -> PyResult<Bound<'py, PyDict>> {
    let takes = PyList::empty(py);
    for argument in function.takes {
        takes.append((argument.name(), dimensions(py, argument.dims())?, argument.unit()))?;
    }
    let out = PyDict::new(py);
    out.set_item("name", function.name)?;
    out.set_item("summary", function.summary)?;
    out.set_item("takes", takes)?;
    out.set_item("gives", dimensions(py, function.gives)?)?;
    out.set_item("unit", function.unit)?;
    out.set_item("group", function.group.name())?;
    out.set_item("source", function.source)?;
    Ok(out)
}

/// All functions of the table, in its order: dicts of name, summary, takes, gives, unit, group and
/// source.
#[pyfunction]
fn table(py: Python<'_>) -> PyResult<Bound<'_, PyList>> {
    let rows = PyList::empty(py);
    for function in functions::<f64>() {
        rows.append(row(py, function)?)?;
    }
    Ok(rows)
}

/// The bundled robots: name, text of the file, base, summary.
#[pyfunction]
fn bundled_robots() -> Vec<(&'static str, &'static str, &'static str, &'static str)> {
    let all = articulated_models::ROBOTS.iter().chain(articulated_models::MJCF);
    all.map(|r| (r.name, r.urdf, robot::name_of(r.base), r.summary)).collect()
}

/// The bytes of a robot's file.
#[pyfunction]
fn read<'py>(py: Python<'py>, path: PathBuf) -> PyResult<Bound<'py, PyBytes>> {
    let bytes = read_file(&path, MOST_BYTES).map_err(|error| {
        let near = articulated::formats::nearest_file(&path);
        let finding = Diagnostic::refusal(&path.display().to_string(), Place::DOCUMENT, Code::File, error.to_string());
        errors::refused(py, &finding.with_nearest(near).into())
    })?;
    Ok(PyBytes::new(py, &bytes))
}

/// The name most like `wrong`, if one is like it.
#[pyfunction]
fn nearest(wrong: &str, names: Vec<String>) -> Option<String> {
    articulated_core::suggest::nearest(wrong, names.iter().map(String::as_str))
}

/// Runs the command `articulated` with these words, the program's name first. Its exit status.
#[pyfunction]
fn command(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| articulated_cli::run(words))
}

#[pymodule(gil_used = true)]
mod _native {
    #[pymodule_export]
    use super::compiled::{load_compiled, load_derivatives};
    #[pymodule_export]
    use super::method::method_of_robots;
    #[pymodule_export]
    use super::robot::Robot;
    #[pymodule_export]
    use super::scene::{Recorded, Scene, bundled_scenes};
    #[pymodule_export]
    use super::{bundled_robots, command, nearest, read, table};
}
