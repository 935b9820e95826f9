"""Derivatives of functions by name, as functions on NumPy arrays."""

import collections
import copy
import math

import numpy as np

from ._compiled import lengths, library, load_derivatives
from ._errors import as_names, as_numbers


# Where numbers at random become a configuration, the path has no derivative of use.
WITHOUT = ("random_configuration",)
# Those that ``articulated.torch`` and ``articulated.jax`` take.
KINDS = ("vjp", "jvp", "hvp")


def by_all(kind, name, takes):
    """The request of a derivative of a function by all of its arguments."""
    return f"{kind}({name}, {' '.join(argument for argument, _, _ in takes)} in coordinates)"


def rows(robot, kinds, functions):
    """For ``library``: by kind and name of a function, a name, a request, and lengths of arguments and results."""
    found = {}
    for function in functions:
        for kind in kinds if function.name not in WITHOUT else ():
            one = Derivative(robot, by_all(kind, function.name, function.takes))
            found[kind, function.name] = (f"{kind}_of_{function.name}", one.request, *one._sizes())
    return found


class Derivative:
    """A derivative of a function, traced for a robot: ``Robot.derivative`` makes one.

    Attributes:
        takes: Name, shape of one state and unit of each argument.
        gives: The same of each result.
    """

    def __init__(self, robot, request):
        if not isinstance(request, str):
            raise TypeError(f"derivative: found {type(request).__name__}, expected a text such as 'vjp(inverse_dynamics, q v)'")
        self._native = robot._derived(f"derivative = {request}")
        self._robot = robot
        self.request = request
        self.takes = tuple((name, lengths(robot, dims), unit) for name, dims, unit in self._native.takes())
        self.gives = tuple((name, lengths(robot, dims), unit) for name, dims, unit in self._native.gives())
        names = [name for name, _, _ in self.gives]
        self._results = collections.namedtuple("Derivatives", names) if len(names) > 1 else None

    def __repr__(self):
        return f"<{self.request} of {', '.join(name for name, _, _ in self.takes)}>"

    def compile(self, *, flags=(), batch=True):
        """The same derivative as C, compiled by the system's C compiler and kept in the cache of ``Robot.compile``.

        Args:
            flags: More options of the compiler, such as ["-march=native"].
            batch: Also compile code that computes a state in each lane of a vector.

        Returns:
            Derivative.

        Raises:
            RuntimeError: There is no C compiler, or it refuses the code.
        """
        one = [("derivative", self.request, *self._sizes())]
        path = library(self._robot, [], tuple(as_names("flags", flags)), bool(batch), one)
        compiled = copy.copy(self)
        (compiled._native,) = load_derivatives(path, one)
        return compiled

    def _sizes(self):
        """How many numbers each argument has, and each result."""
        return [[math.prod(shape) for _, shape, _ in ports] for ports in (self.takes, self.gives)]

    def __call__(self, *arguments, threads=None):
        """The derivative at arguments of one state, or behind any dimensions of a batch, which broadcast.

        Args:
            arguments: In the order of ``takes``; float64.
            threads: None or 1 for one thread, another number for all.

        Returns:
            One array, or a named tuple of arrays if there are several results.
        """
        if len(arguments) != len(self.takes):
            names = ", ".join(name for name, _, _ in self.takes)
            raise TypeError(f"{self.request}: found {len(arguments)} arguments, expected {len(self.takes)}: {names}")
        arrays, batches = [], []
        for value, (name, shape, _) in zip(arguments, self.takes):
            array = np.asarray(as_numbers(name, value), dtype=np.float64)
            if not np.isfinite(array).all():
                raise ValueError(f"{name}: found {array[~np.isfinite(array)].flat[0]}, expected finite numbers")
            if array.ndim < len(shape) or array.shape[array.ndim - len(shape) :] != shape:
                raise ValueError(f"{name}: found shape {array.shape}, expected {shape}, or that behind dimensions of a batch")
            arrays.append(array)
            batches.append(array.shape[: array.ndim - len(shape)])
        try:
            batch = np.broadcast_shapes(*batches)
        except ValueError:
            raise ValueError(f"{self.request}: found dimensions of a batch that do not fit: {batches}") from None
        count = math.prod(batch)
        flat = [np.ascontiguousarray(np.broadcast_to(x, batch + s).reshape(count, math.prod(s))) for x, (_, s, _) in zip(arrays, self.takes)]
        found = self._native.run(flat, 1 if threads in (None, 1) else 0)
        parts = [part.reshape(batch + shape) for part, (_, shape, _) in zip(found, self.gives)]
        return self._results(*parts) if self._results else parts[0]
