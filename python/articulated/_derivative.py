"""Derivatives of functions by name, as functions on NumPy arrays."""

import collections
import math

import numpy as np

from ._compiled import lengths
from ._errors import as_numbers


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
        self.request = request
        self.takes = tuple((name, lengths(robot, dims), unit) for name, dims, unit in self._native.takes())
        self.gives = tuple((name, lengths(robot, dims), unit) for name, dims, unit in self._native.gives())
        names = [name for name, _, _ in self.gives]
        self._results = collections.namedtuple("Derivatives", names) if len(names) > 1 else None

    def __repr__(self):
        return f"<{self.request} of {', '.join(name for name, _, _ in self.takes)}>"

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
        ends = np.cumsum([math.prod(shape) for _, shape, _ in self.gives])
        parts = [part.reshape(batch + shape) for part, (_, shape, _) in zip(np.split(found, ends[:-1], axis=1), self.gives)]
        return self._results(*parts) if self._results else parts[0]
