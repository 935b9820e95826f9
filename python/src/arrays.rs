//! Arguments of a call: NumPy arrays of one state or of many, checked.

use articulated::Scalar;
use numpy::{Element, PyArrayDyn, PyArrayMethods, PyReadonlyArray2, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;

use crate::method::is_finite;

/// A type of numbers that arrays may have.
pub(crate) trait Real: Element + Scalar + Copy + Send + Sync {
    /// Its name in NumPy.
    const NAME: &str;
    /// As float64.
    fn wide(self) -> f64;
}

impl Real for f64 {
    const NAME: &str = "float64";
    fn wide(self) -> f64 {
        self
    }
}

impl Real for f32 {
    const NAME: &str = "float32";
    fn wide(self) -> f64 {
        self.into()
    }
}

/// The numbers of arrays with a row for each of the same states, row k of `sizes[k]` numbers.
pub(crate) fn of_same_states<'a, const N: usize>(
    arrays: [&'a PyReadonlyArray2<'_, f64>; N],
    sizes: [usize; N],
) -> PyResult<[&'a [f64]; N]> {
    let states = arrays.first().map_or(0, |array| array.shape()[0]);
    let mut parts: [&[f64]; N] = [&[]; N];
    for ((into, array), size) in parts.iter_mut().zip(arrays).zip(sizes) {
        let own = array.as_slice().ok().filter(|_| array.shape() == [states, size]);
        *into = own.ok_or_else(other_states)?;
    }
    Ok(parts)
}

/// The error of arrays that are not of the same states.
pub(crate) fn other_states() -> PyErr {
    PyValueError::new_err("found arrays of other shapes, expected those of the same states")
}

/// An argument with its states.
pub(crate) struct Argument<'py, T: Real> {
    array: PyReadonlyArrayDyn<'py, T>,
    /// The dimensions of the batch: empty for one state.
    pub(crate) batch: Vec<usize>,
    /// Numbers of one state.
    pub(crate) len: usize,
}

impl<'py, T: Real> Argument<'py, T> {
    /// All numbers, state by state.
    pub(crate) fn numbers(&self) -> PyResult<&[T]> {
        self.array.as_slice().map_err(|error| PyValueError::new_err(error.to_string()))
    }

    /// The argument for a batch of these dimensions: itself if it has them or is one state.
    pub(crate) fn broadcast(self, py: Python<'py>, batch: &[usize]) -> PyResult<Self> {
        static BROADCAST: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
        if self.batch.is_empty() || self.batch == batch {
            return Ok(self);
        }
        let one = &self.array.shape()[self.batch.len()..];
        let whole: Vec<usize> = batch.iter().chain(one).copied().collect();
        let broadcast = BROADCAST.get_or_try_init(py, || py.import("articulated._errors")?.getattr("broadcast").map(Bound::unbind))?;
        let array = broadcast.bind(py).call1((&*self.array, whole))?.cast_into::<PyArrayDyn<T>>()?;
        let array = array.try_readonly().map_err(|error| PyValueError::new_err(error.to_string()))?;
        Ok(Self { array, batch: batch.to_vec(), len: self.len })
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
fn first_not_finite<T: Real>(numbers: &[T]) -> Option<usize> {
    if is_finite(numbers) { None } else { numbers.iter().position(|x| !x.wide().is_finite()) }
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
fn is_plain<T: Real>(array: &Bound<'_, PyArrayDyn<T>>) -> bool {
    array.is_c_contiguous() && array.data().is_aligned() && array.get_type().is(array.py().get_type::<PyArrayDyn<T>>())
}

/// Python's conversion of anything that is not such an array.
fn converted<'py, T: Real>(name: &str, value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    static CONVERT: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let py = value.py();
    let convert = CONVERT.get_or_try_init(py, || py.import("articulated._errors")?.getattr("as_numbers").map(Bound::unbind))?;
    let array = convert.bind(py).call1((name, value, T::NAME))?.cast_into::<PyArrayDyn<T>>()?;
    if is_plain(&array) { Ok(array) } else { Err(PyValueError::new_err(format!("{name}: found no array of {}", T::NAME))) }
}

/// Whether a value is an array of float32.
pub(crate) fn is_single(value: &Bound<'_, PyAny>) -> bool {
    static SINGLE: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    if value.cast::<PyArrayDyn<f64>>().is_ok() {
        return false;
    }
    let py = value.py();
    let single = SINGLE.get_or_try_init(py, || py.import("articulated._errors")?.getattr("is_single").map(Bound::unbind));
    single.and_then(|single| single.bind(py).call1((value,))?.extract()).unwrap_or(false)
}

/// Reads an argument, of `shape` for one state, behind any dimensions of a batch.
pub(crate) fn argument<'py, T: Real>(name: &str, value: &Bound<'py, PyAny>, shape: &[usize]) -> PyResult<Argument<'py, T>> {
    let array = match value.cast::<PyArrayDyn<T>>() {
        Ok(array) if is_plain(array) => array.clone(),
        _ => converted(name, value)?,
    };
    let Some(batch) = array.shape().strip_suffix(shape) else {
        let (found, one, many) = (shown(array.shape()), shown(shape), shown_many(shape));
        return Err(PyValueError::new_err(format!("{name}: found shape {found}, expected {one} for one state or {many} for N states")));
    };
    let batch = batch.to_vec();
    let array = array.try_readonly().map_err(|error| PyValueError::new_err(format!("{name}: {error}")))?;
    let argument = Argument { array, batch, len: shape.iter().product() };
    let numbers = argument.numbers()?;
    if let Some(at) = first_not_finite(numbers) {
        let place = place(at, argument.array.shape());
        return Err(PyValueError::new_err(format!("{name}: found {} at {place}, expected finite numbers", spelled(numbers[at].wide()))));
    }
    Ok(argument)
}

/// The dimensions of the batch that the arguments agree on, by NumPy's rules; empty for one state.
pub(crate) fn batch<T: Real>(names: &[&str], arguments: &[Argument<'_, T>]) -> PyResult<Vec<usize>> {
    let (mut agreed, mut first): (Vec<usize>, &str) = (Vec::new(), "");
    for (name, argument) in names.iter().zip(arguments).filter(|(_, argument)| !argument.batch.is_empty()) {
        let found = &argument.batch;
        let rank = agreed.len().max(found.len());
        let at = |dims: &[usize], k: usize| (k + dims.len()).checked_sub(rank).map_or(1, |k| dims[k]);
        let pairs: Vec<(usize, usize)> = (0..rank).map(|k| (at(&agreed, k), at(found, k))).collect();
        if pairs.iter().any(|(a, b)| a != b && *a != 1 && *b != 1) {
            let sentence = match (found.as_slice(), agreed.as_slice()) {
                ([found], [expected]) => {
                    format!("{name}: found {found} states, expected {expected} as in {first}, or one state for all of them")
                }
                _ => format!(
                    "{name}: found dimensions {} of a batch, expected those of {first}, {}, or some that broadcast with them",
                    shown(found),
                    shown(&agreed)
                ),
            };
            return Err(PyValueError::new_err(sentence));
        }
        (agreed, first) = (pairs.into_iter().map(|(a, b)| if a == 1 { b } else { a }).collect(), name);
    }
    Ok(agreed)
}

/// The array that a caller passed as `out=`, checked.
pub(crate) fn given_output<'py, T: Real>(value: &Bound<'py, PyAny>, shape: &[usize]) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    let expected = || format!("expected a writable array of {}, of shape {} in C order", T::NAME, shown(shape));
    let wrong = |found: String| PyValueError::new_err(format!("out: found {found}, {}", expected()));
    let Ok(array) = value.cast::<PyArrayDyn<T>>() else {
        let dtype = value.getattr("dtype").map_or_else(|_| value.get_type().to_string(), |dtype| format!("an array of {dtype}"));
        return Err(PyTypeError::new_err(format!("out: found {dtype}, {}", expected())));
    };
    if array.shape() != shape {
        return Err(wrong(format!("shape {}", shown(array.shape()))));
    }
    if !array.is_c_contiguous() || !array.data().is_aligned() {
        return Err(wrong("an array in another order".into()));
    }
    Ok(array.clone())
}

/// A new array. A large one is NumPy's, which raises `MemoryError` where there is no room.
pub(crate) fn output<'py, T: Real>(py: Python<'py>, shape: &[usize]) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    const LARGE: usize = 1 << 16;
    static EMPTY: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    if shape.iter().try_fold(1_usize, |size, n| size.checked_mul(*n)).is_some_and(|size| size <= LARGE) {
        return Ok(PyArrayDyn::zeros(py, shape, false));
    }
    let empty = EMPTY.get_or_try_init(py, || py.import("numpy")?.getattr("empty").map(Bound::unbind))?;
    Ok(empty.bind(py).call1((shape.to_vec(), T::NAME))?.cast_into::<PyArrayDyn<T>>()?)
}
