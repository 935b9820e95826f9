"""Errors, warnings, and the conversion of arguments."""

import numpy as np


class RobotError(ValueError):
    """A robot that cannot be read, or that does not have what a function needs.

    ``diagnostics`` lists all findings about the file at once. Each is a dict with the keys severity,
    code, file, line, column, subject, field, found, expected, hint and message; line, column, subject
    and hint may be None.
    """

    def __init__(self, message="", diagnostics=()):
        super().__init__(message)
        self.diagnostics = list(diagnostics)

    def __reduce__(self):
        return type(self), (str(self), self.diagnostics)


class RobotWarning(UserWarning):
    """What looks wrong in a robot's file. The values are used as they are.

    ``diagnostic`` is the finding, a dict as in ``RobotError.diagnostics``.
    """

    def __init__(self, message="", diagnostic=None):
        super().__init__(message)
        self.diagnostic = diagnostic

    def __reduce__(self):
        return type(self), (str(self), self.diagnostic)


def _shared(name, value):
    """An array over the memory of an object of another library (DLPack); None where it is not to be had."""
    if isinstance(value, (np.ndarray, np.generic)) or not hasattr(value, "__dlpack__"):
        return None
    try:
        kind = int(value.__dlpack_device__()[0])
    except Exception:
        return None
    # 1: the CPU. 3, 11, 13: GPU memory that the CPU can read.
    if kind not in (1, 3, 11, 13):
        found = getattr(value, "device", f"kind {kind} of DLPack")
        raise TypeError(f"{name}: found {type(value).__name__} on device {found}, expected one on the CPU")
    try:
        return np.from_dlpack(value)
    except Exception:
        return None


def is_single(value):
    """Whether ``value`` is an array of float32, of NumPy or of another library."""
    dtype = getattr(value, "dtype", None)
    if dtype is None and hasattr(value, "__dlpack__"):
        try:
            dtype = np.from_dlpack(value).dtype
        except Exception:
            return False
    return dtype is not None and str(dtype) in ("float32", "torch.float32")


def as_names(what, names):
    """``names`` as a list of texts; the errors name the argument."""
    if isinstance(names, (str, bytes)):
        raise TypeError(f"{what}: found {names!r}, expected a list of names, such as [{names!r}]")
    try:
        names = list(names)
    except TypeError:
        raise TypeError(f"{what}: found {type(names).__name__}, expected a list of names") from None
    for name in names:
        if not isinstance(name, str):
            raise TypeError(f"{what}: found {type(name).__name__} in the list, expected names")
    return names


def broadcast(array, shape):
    """The array with the dimensions of a batch that it lacks, in C order."""
    return np.ascontiguousarray(np.broadcast_to(array, shape))


def narrow(result, out):
    """A result of float64 as float32, in ``out`` if that is given."""
    if out is None:
        return np.float32(result) if np.ndim(result) == 0 else result.astype(np.float32)
    if not isinstance(out, np.ndarray) or out.dtype != np.float32 or out.shape != np.shape(result) or not out.flags.writeable:
        found = f"{out.dtype} of shape {out.shape}" if isinstance(out, np.ndarray) else type(out).__name__
        raise ValueError(f"out: found {found}, expected a writable array of float32, of shape {np.shape(result)}")
    out[...] = result
    return out


def as_numbers(name, value, dtype="float64"):
    """``value`` as a C-contiguous array of this type; the errors name the argument."""
    shared = _shared(name, value)
    if shared is not None:
        if shared.dtype == dtype and shared.flags.c_contiguous and shared.flags.aligned:
            return shared
        value = shared
    try:
        array = np.asarray(value)
    except MemoryError:
        raise
    except ValueError as error:
        raise ValueError(f"{name}: found no rectangular array ({error}), expected an array of real numbers") from None
    except Exception as error:
        raise TypeError(f"{name}: found {type(value).__name__} ({error}), expected an array of real numbers") from None
    if array.dtype.kind not in "iuf":
        found = f"dtype {array.dtype}" if array.dtype.kind != "O" else f"objects ({type(value).__name__})"
        raise TypeError(f"{name}: found {found}, expected real numbers, such as float64")
    if isinstance(value, np.ma.MaskedArray) and np.ma.is_masked(value):
        raise TypeError(f"{name}: found a masked array with masked elements, expected an array without")
    # A copy, unless only the class or the layout of a single row differs.
    with np.errstate(over="ignore"):
        return np.require(np.array(array, dtype=dtype, copy=True, order="C", subok=False), requirements=["C", "A"])
