//! Arguments of a call: NumPy arrays of one state or of many, checked.

use numpy::{PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;

use crate::method::is_finite;

/// An argument with its states.
pub(crate) struct Argument<'py> {
    array: PyReadonlyArrayDyn<'py, f64>,
    /// Number of states; `None` for one state without a dimension of its own.
    pub(crate) states: Option<usize>,
    /// Numbers of one state.
    pub(crate) len: usize,
}

impl<'py> Argument<'py> {
    /// All numbers, state by state.
    pub(crate) fn numbers(&self) -> PyResult<&[f64]> {
        self.array.as_slice().map_err(|error| PyValueError::new_err(error.to_string()))
    }
}

/// A shape as Python writes it.
pub(crate) fn shown(shape: &[usize]) -> String {
    match shape {
        [one] => format!("({one},)"),
        several => format!("({})", several.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")),
    }
}

/// The same of N states.
fn shown_many(shape: &[usize]) -> String {
    let rest: String = shape.iter().map(|n| format!(", {n}")).collect();
    if shape.is_empty() { "(N,)".into() } else { format!("(N{rest})") }
}

/// The index of number `at` of an array of this shape.
fn place(at: usize, shape: &[usize]) -> String {
    let mut rest = at;
    let mut index: Vec<usize> = shape.iter().rev().map(|n| (rest % n, rest /= n).0).collect();
    index.reverse();
    format!("{index:?}")
}

/// The first number that is infinite or not a number.
fn first_not_finite(numbers: &[f64]) -> Option<usize> {
    if is_finite(numbers) { None } else { numbers.iter().position(|x| !x.is_finite()) }
}

/// A number that is not finite, as Python writes it.
fn spelled(x: f64) -> &'static str {
    if x.is_nan() {
        "nan"
    } else if x > 0.0 {
        "inf"
    } else {
        "-inf"
    }
}

/// Whether an array's numbers can be borrowed as they are.
fn is_plain(array: &Bound<'_, PyArrayDyn<f64>>) -> bool {
    array.is_c_contiguous() && array.data().is_aligned() && array.get_type().is(array.py().get_type::<PyArrayDyn<f64>>())
}

/// Python's conversion of anything that is not such an array.
fn converted<'py>(name: &str, value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    static CONVERT: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let py = value.py();
    let convert = CONVERT.get_or_try_init(py, || py.import("articulated._errors")?.getattr("as_numbers").map(Bound::unbind))?;
    let array = convert.bind(py).call1((name, value))?.cast_into::<PyArrayDyn<f64>>()?;
    if is_plain(&array) { Ok(array) } else { Err(PyValueError::new_err(format!("{name}: found no array of float64"))) }
}

/// Reads an argument, of `shape` for one state.
pub(crate) fn argument<'py>(name: &str, value: &Bound<'py, PyAny>, shape: &[usize]) -> PyResult<Argument<'py>> {
    let array = match value.cast::<PyArrayDyn<f64>>() {
        Ok(array) if is_plain(array) => array.clone(),
        _ => converted(name, value)?,
    };
    let states = match array.shape() {
        one if one == shape => None,
        [n, one @ ..] if one == shape => Some(*n),
        other => {
            let (other, one, many) = (shown(other), shown(shape), shown_many(shape));
            return Err(PyValueError::new_err(format!("{name}: found shape {other}, expected {one} for one state or {many} for N states")));
        }
    };
    let array = array.try_readonly().map_err(|error| PyValueError::new_err(format!("{name}: {error}")))?;
    let argument = Argument { array, states, len: shape.iter().product() };
    let numbers = argument.numbers()?;
    if let Some(at) = first_not_finite(numbers) {
        let place = place(at, argument.array.shape());
        return Err(PyValueError::new_err(format!("{name}: found {} at {place}, expected finite numbers", spelled(numbers[at]))));
    }
    Ok(argument)
}

/// The number of states that the arguments agree on; `None` for one state.
pub(crate) fn states(names: &[&str], arguments: &[Argument<'_>]) -> PyResult<Option<usize>> {
    let mut agreed: Option<(usize, &str)> = None;
    for (name, argument) in names.iter().zip(arguments) {
        match (agreed, argument.states) {
            (Some((expected, first)), Some(found)) if found != expected => {
                let sentence = format!("{name}: found {found} states, expected {expected} as in {first}, or one state for all of them");
                return Err(PyValueError::new_err(sentence));
            }
            (None, Some(found)) => agreed = Some((found, name)),
            _ => {}
        }
    }
    Ok(agreed.map(|(count, _)| count))
}

/// A new array. A large one is NumPy's, which raises `MemoryError` where there is no room.
pub(crate) fn output<'py>(py: Python<'py>, shape: &[usize]) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    const LARGE: usize = 1 << 16;
    static EMPTY: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    if shape.iter().try_fold(1_usize, |size, n| size.checked_mul(*n)).is_some_and(|size| size <= LARGE) {
        return Ok(PyArrayDyn::zeros(py, shape, false));
    }
    let empty = EMPTY.get_or_try_init(py, || py.import("numpy")?.getattr("empty").map(Bound::unbind))?;
    Ok(empty.bind(py).call1((shape.to_vec(),))?.cast_into::<PyArrayDyn<f64>>()?)
}
