//! Functions as the interpreter calls them: without Python code between, and for one state without
//! an allocation besides the result.
//!
//! `unsafe`, for its measured gain: a call of one state costs 0.2 µs here besides the function, and
//! 1 µs by safe means (a Python function, a tuple, three borrowed arrays, an array of the result).

#![allow(unsafe_code)]

use std::ffi::{CString, c_int, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr;
use std::sync::OnceLock;

use numpy::npyffi::flags::{NPY_ARRAY_ALIGNED, NPY_ARRAY_C_CONTIGUOUS};
use numpy::npyffi::{NPY_TYPES, NpyTypes, PY_ARRAY_API, PyArray_Descr, PyArrayObject, get_type_object, npy_intp};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyFloat, PyString, PyTuple, PyType};
use pyo3::{PyTypeInfo, ffi};

use crate::arrays::Real;
use crate::batch::{Kernel, mistake};
use crate::compiled::CompiledFunction;
use crate::robot::Robot;
use crate::signature::{MOST_ARGUMENTS, Signature, Size};

/// NumPy's objects, which live as long as the process.
struct Numpy {
    /// The class `numpy.ndarray`.
    array: *mut ffi::PyTypeObject,
    /// The element type `float64` in the machine's order of bytes. NumPy has one.
    float64: *mut PyArray_Descr,
}

// SAFETY: the pointers are to immortal objects, and used with the interpreter's lock held.
unsafe impl Send for Numpy {}
// SAFETY: as above.
unsafe impl Sync for Numpy {}

impl Numpy {
    fn get(py: Python<'_>) -> &'static Self {
        static NUMPY: OnceLock<Numpy> = OnceLock::new();
        NUMPY.get_or_init(|| {
            // SAFETY: NumPy's functions, called as it documents, with the lock held. The reference
            // to the element type is kept for ever.
            unsafe {
                Self {
                    array: get_type_object(py, NpyTypes::PyArray_Type),
                    float64: PY_ARRAY_API.PyArray_DescrFromType(py, NPY_TYPES::NPY_DOUBLE as c_int),
                }
            }
        })
    }

    /// The numbers of one state: of an array of float64 in C order, of exactly this size, all
    /// finite.
    ///
    /// # Safety
    /// `object` is a live object, and the lock is held, without Python code being run, as long as
    /// the slice is used: an array may be written to by any Python code.
    unsafe fn plain<'a>(&self, object: *mut ffi::PyObject, size: &Size) -> Option<&'a [f64]> {
        const PLAIN: c_int = NPY_ARRAY_C_CONTIGUOUS | NPY_ARRAY_ALIGNED;
        // SAFETY: an object of exactly NumPy's class has NumPy's fields. Its dimensions are `nd`
        // numbers, and an array that is aligned, in C order, of this element type, has as many
        // doubles at `data` as the product of its dimensions.
        unsafe {
            if ffi::Py_TYPE(object) != self.array {
                return None;
            }
            let array = &(*object.cast::<PyArrayObject>()).fields;
            let is_plain = array.descr == self.float64 && array.flags & PLAIN == PLAIN && array.nd as usize == size.dims().len();
            if !is_plain || (0..size.dims().len()).any(|k| *array.dimensions.add(k) != size.dims()[k]) {
                return None;
            }
            let numbers = std::slice::from_raw_parts(array.data.cast::<f64>(), size.len);
            is_finite(numbers).then_some(numbers)
        }
    }

    /// A new array of zeros of this size, and its numbers.
    ///
    /// # Safety
    /// The lock is held. The slice is used before the array is passed on.
    unsafe fn zeros<'a>(&self, py: Python<'_>, size: &Size) -> PyResult<(*mut ffi::PyObject, &'a mut [f64])> {
        let mut dims: [npy_intp; 3] = size.dims;
        // SAFETY: NumPy's function, called as it documents: it takes over a reference to the
        // element type, reads the dimensions, and returns a new array or null with an error set.
        // The numbers are written before there is a slice of them.
        unsafe {
            ffi::Py_INCREF(self.float64.cast());
            let none: *mut c_void = ptr::null_mut();
            let nd = size.dims().len() as c_int;
            let (class, strides) = (self.array, ptr::null_mut());
            let out = PY_ARRAY_API.PyArray_NewFromDescr(py, class, self.float64, nd, dims.as_mut_ptr(), strides, none, 0, ptr::null_mut());
            if out.is_null() {
                return Err(PyErr::fetch(py));
            }
            let data = (*out.cast::<PyArrayObject>()).fields.data.cast::<f64>();
            ptr::write_bytes(data, 0, size.len);
            Ok((out, std::slice::from_raw_parts_mut(data, size.len)))
        }
    }
}

/// Whether no number is infinite or not a number.
pub(crate) fn is_finite<T: Real>(numbers: &[T]) -> bool {
    // Zero times a number is zero, unless it is not finite. Without branches, for vectors.
    let zero = T::from_f64(0.0);
    let mut sums = [zero; 8];
    let mut chunks = numbers.chunks_exact(8);
    for chunk in &mut chunks {
        for (sum, x) in sums.iter_mut().zip(chunk) {
            *sum += *x * zero;
        }
    }
    let rest = chunks.remainder().iter().fold(zero, |sum, x| sum + *x * zero);
    sums.iter().fold(rest, |sum, x| sum + *x).wide() == 0.0
}

/// The result of a call with one state whose arguments are plain arrays; `None`: another call.
///
/// # Safety
/// `given` are live objects, and the lock is held.
unsafe fn of_one_state(
    py: Python<'_>,
    robot: &Robot,
    kernel: &Kernel<'_>,
    signature: &Signature,
    given: &[*mut ffi::PyObject],
) -> Option<PyResult<*mut ffi::PyObject>> {
    if given.len() != signature.arguments.len() || !robot.is_defined(signature.function) {
        return None;
    }
    let numpy = Numpy::get(py);
    let mut arguments: [&[f64]; MOST_ARGUMENTS] = [&[]; MOST_ARGUMENTS];
    for ((argument, object), size) in arguments.iter_mut().zip(given).zip(&signature.arguments) {
        // SAFETY: no Python code runs below before the last use of the slices: creating an array of
        // numbers does not run any.
        *argument = unsafe { numpy.plain(*object, size) }?;
    }
    let arguments = &arguments[..given.len()];
    if signature.result.dims().is_empty() {
        let mut number = [0.0];
        return Some(kernel.one(arguments, &mut number).map(|()| PyFloat::new(py, number[0]).into_ptr()));
    }
    // SAFETY: as above.
    let (out, numbers) = match unsafe { numpy.zeros(py, &signature.result) } {
        Ok(made) => made,
        Err(error) => return Some(Err(error)),
    };
    Some(match kernel.one(arguments, numbers) {
        Ok(()) => Ok(out),
        Err(error) => {
            // SAFETY: the only reference to the new array.
            unsafe { ffi::Py_DECREF(out) };
            Err(error)
        }
    })
}

/// The arguments in order, of a call with `positional` ones and one for each name after them.
/// `None`: names are wrong or missing, or `threads` is given, which needs the other path.
///
/// # Safety
/// As [`respond`].
unsafe fn in_order(
    py: Python<'_>,
    signature: &Signature,
    given: &[*mut ffi::PyObject],
    positional: usize,
    names: *mut ffi::PyObject,
) -> Option<[*mut ffi::PyObject; MOST_ARGUMENTS]> {
    let mut out = [ptr::null_mut(); MOST_ARGUMENTS];
    let takes = signature.function.takes;
    if given.len() != takes.len() || takes.len() > MOST_ARGUMENTS {
        return None;
    }
    out[..positional].copy_from_slice(&given[..positional]);
    // SAFETY: a tuple of strings.
    let names = unsafe { Bound::from_borrowed_ptr(py, names) };
    for (name, value) in names.cast::<PyTuple>().ok()?.iter_borrowed().zip(&given[positional..]) {
        let name = name.cast::<PyString>().ok()?;
        let name = name.to_str().ok()?;
        let at = takes.iter().position(|argument| argument.name() == name)?;
        if !out[at].is_null() {
            return None;
        }
        out[at] = *value;
    }
    Some(out)
}

/// The keywords of a call beside its arguments.
#[derive(Default)]
pub(crate) struct Keywords<'py> {
    pub(crate) threads: Option<Bound<'py, PyAny>>,
    /// The array of the result.
    pub(crate) out: Option<Bound<'py, PyAny>>,
}

/// The arguments and the keywords of any other call. Python itself reads keywords, so that its
/// errors are those of a Python function.
fn read<'py>(
    py: Python<'py>,
    index: usize,
    signature: &Signature,
    given: Vec<Bound<'py, PyAny>>,
    names: Option<Bound<'py, PyTuple>>,
) -> PyResult<(Bound<'py, PyTuple>, Keywords<'py>)> {
    static READ: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let keywords = names.as_ref().map_or(0, |names| names.len());
    if keywords == 0 && given.len() == signature.arguments.len() {
        return Ok((PyTuple::new(py, given)?, Keywords::default()));
    }
    let named = PyDict::new(py);
    let positional = given.len() - keywords;
    for (name, value) in names.iter().flatten().zip(&given[positional..]) {
        named.set_item(name, value)?;
    }
    let read = READ.get_or_try_init(py, || py.import("articulated._robot")?.getattr("_read").map(Bound::unbind))?;
    let out = read.bind(py).call1((index, PyTuple::new(py, &given[..positional])?, named))?;
    let (given, threads, out): (Bound<'py, PyTuple>, Bound<'py, PyAny>, Bound<'py, PyAny>) = out.extract()?;
    let unless_none = |value: Bound<'py, PyAny>| if value.is_none() { None } else { Some(value) };
    Ok((given, Keywords { threads: unless_none(threads), out: unless_none(out) }))
}

/// Calls a function with the interpreter's arguments. Null, with an error set, if there is no
/// result.
///
/// # Safety
/// `given` are `count` live objects and those of the keywords in `names`, a tuple or null; the lock
/// is held. The interpreter calls functions of this kind like this.
unsafe fn respond(
    robot: &Robot,
    index: usize,
    kernel: &Kernel<'_>,
    given: *const *mut ffi::PyObject,
    count: ffi::Py_ssize_t,
    names: *mut ffi::PyObject,
) -> PyResult<*mut ffi::PyObject> {
    // SAFETY: the lock is held.
    let py = unsafe { Python::assume_attached() };
    let signature = &robot.signatures[index];
    // SAFETY: `count` objects; no objects may come with a null pointer.
    let objects = |count: usize| if count == 0 { &[][..] } else { unsafe { std::slice::from_raw_parts(given, count) } };
    let ordered;
    let positional = match names.is_null() {
        true => objects(count as usize),
        false => {
            // SAFETY: the size of a tuple; as many objects more.
            let all = count as usize + unsafe { ffi::PyTuple_Size(names) } as usize;
            // SAFETY: as above.
            ordered = unsafe { in_order(py, signature, objects(all), count as usize, names) }.unwrap_or([ptr::null_mut(); MOST_ARGUMENTS]);
            &ordered[..if ordered[0].is_null() { 0 } else { all }]
        }
    };
    // SAFETY: as above.
    if let Some(out) = unsafe { of_one_state(py, robot, kernel, signature, positional) } {
        return out;
    }
    Python::attach(|py| {
        // SAFETY: a tuple or null, and live objects.
        let names = unsafe { Bound::from_borrowed_ptr_or_opt(py, names) }.map(|names| names.cast_into::<PyTuple>()).transpose()?;
        let all = count as usize + names.as_ref().map_or(0, |names| names.len());
        let given = objects(all).iter().map(|object| unsafe { Bound::from_borrowed_ptr(py, *object) }).collect();
        let (given, keywords) = read(py, index, signature, given, names)?;
        robot.call(py, index, kernel, &given, &keywords).map(Bound::into_ptr)
    })
}

/// A result for the interpreter: null with an error set for an error and for a panic.
fn guarded(call: impl FnOnce() -> PyResult<*mut ffi::PyObject>) -> *mut ffi::PyObject {
    let out = catch_unwind(AssertUnwindSafe(call)).unwrap_or_else(|_| Err(mistake()));
    out.unwrap_or_else(|error| {
        Python::attach(|py| error.restore(py));
        ptr::null_mut()
    })
}

/// Row `I` of the table as a method of a robot.
///
/// # Safety
/// As [`respond`]; `object` is a live object.
unsafe extern "C" fn method<const I: usize>(
    object: *mut ffi::PyObject,
    given: *const *mut ffi::PyObject,
    count: ffi::Py_ssize_t,
    names: *mut ffi::PyObject,
) -> *mut ffi::PyObject {
    guarded(|| {
        // SAFETY: the interpreter holds the lock, and keeps the object for the call.
        let object = unsafe { Bound::from_borrowed_ptr(Python::assume_attached(), object) };
        let robot = object.cast::<Robot>()?.get();
        let kernel = robot.kernel(I);
        // SAFETY: the interpreter's call.
        unsafe { respond(robot, I, &kernel, given, count, names) }
    })
}

/// A compiled function, which is `object`.
///
/// # Safety
/// As [`method`].
unsafe extern "C" fn compiled(
    object: *mut ffi::PyObject,
    given: *const *mut ffi::PyObject,
    count: ffi::Py_ssize_t,
    names: *mut ffi::PyObject,
) -> *mut ffi::PyObject {
    guarded(|| {
        // SAFETY: as in `method`.
        let object = unsafe { Bound::from_borrowed_ptr(Python::assume_attached(), object) };
        let function = object.cast::<CompiledFunction>()?.get();
        // SAFETY: the interpreter's call.
        unsafe { respond(function.robot.get(), function.index, &function.kernel(), given, count, names) }
    })
}

macro_rules! methods {
    ($($index:literal)*) => {
        /// A method for each row of the table, and some to spare.
        static METHODS: &[ffi::PyCFunctionFastWithKeywords] = &[$(method::<$index>),*];
    };
}

methods! {
    0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31 32 33 34 35 36 37 38 39 40 41 42 43 44 45 46 47
    48 49 50 51 52 53 54 55 56 57 58 59 60 61 62 63 64 65 66 67 68 69 70 71 72 73 74 75 76 77 78 79
}

/// A function's definition for the interpreter, which keeps a pointer to it for ever. `text` is its
/// signature and its documentation.
fn definition(name: &str, text: &str, function: ffi::PyCFunctionFastWithKeywords) -> PyResult<*mut ffi::PyMethodDef> {
    let owned = |text: &str| CString::new(text).map_err(|error| PyValueError::new_err(error.to_string()));
    let (name, text) = (owned(name)?, owned(text)?);
    Ok(Box::into_raw(Box::new(ffi::PyMethodDef {
        ml_name: name.into_raw(),
        ml_meth: ffi::PyMethodDefPointer { PyCFunctionFastWithKeywords: function },
        ml_flags: ffi::METH_FASTCALL | ffi::METH_KEYWORDS,
        ml_doc: text.into_raw(),
    })))
}

/// Row `index` of the table as a method of the class of robots.
#[pyfunction(name = "method")]
pub(crate) fn method_of_robots<'py>(py: Python<'py>, index: usize, name: &str, text: &str) -> PyResult<Bound<'py, PyAny>> {
    let function = METHODS.get(index).ok_or_else(|| PyValueError::new_err("found no method for this row, expected more in METHODS"))?;
    let class: Bound<'py, PyType> = Robot::type_object(py);
    // SAFETY: the class is alive, and the definition is kept for ever. A new reference, or null
    // with an error set.
    unsafe { Bound::from_owned_ptr_or_err(py, ffi::PyDescr_NewMethod(class.as_ptr().cast(), definition(name, text, *function)?)) }
}

/// A compiled function as the interpreter calls it.
pub(crate) fn callable<'py>(py: Python<'py>, name: &str, text: &str, function: CompiledFunction) -> PyResult<Bound<'py, PyAny>> {
    let function = Bound::new(py, function)?;
    // SAFETY: as above; the callable keeps a reference of its own to the function.
    unsafe {
        let definition = definition(name, text, compiled)?;
        Bound::from_owned_ptr_or_err(py, ffi::PyCFunction_NewEx(definition, function.as_ptr(), ptr::null_mut()))
    }
}
