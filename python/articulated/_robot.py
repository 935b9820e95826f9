"""The class Robot. Its functions are made from the library's table."""

import os
import warnings
from typing import NamedTuple

import numpy as np

from . import _native
from ._compiled import CompiledRobot
from ._errors import RobotWarning

GRAVITY = (0.0, 0.0, -9.81)


class Joint(NamedTuple):
    """A joint that has coordinates of its own."""

    name: str
    kind: str
    q: slice
    v: slice


class Function(NamedTuple):
    """A row of the table of functions.

    ``takes`` holds a name, dimensions and a unit for each argument, ``gives`` the dimensions of the
    result. A dimension is a number, "nq", "nv", "frames" or "links".
    """

    name: str
    summary: str
    takes: tuple
    gives: tuple
    unit: str
    group: str
    source: str


_TABLE = tuple(Function(**{**row, "takes": tuple(row["takes"])}) for row in _native.table())
_INDEX = {function.name: index for index, function in enumerate(_TABLE)}


def functions():
    """All functions of a robot, in the order of the documentation."""
    return _TABLE


def _shape(dimensions):
    return "(" + ", ".join(str(one) for one in dimensions) + ("," if len(dimensions) == 1 else "") + ")"


def _unknown(what, found, names, expected):
    near = _native.nearest(str(found), list(names))
    return ValueError(f"{what}: found {found!r}, expected {expected}" + (f"; did you mean {near!r}?" if near else ""))


def _names(what, names):
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


def _vector(name, value):
    from ._errors import as_numbers

    array = as_numbers(name, value)
    if array.shape != (3,) or not np.isfinite(array).all():
        found = f"shape {array.shape}" if array.shape != (3,) else f"{array.tolist()}"
        raise ValueError(f"{name}: found {found}, expected three finite numbers, m/s² in the world frame")
    return tuple(array.tolist())


class Robot:
    """A robot's dynamics. ``articulated.load``, ``loads`` and ``bundled`` make one.

    Each function takes one state, such as q of shape (nq,), or N states, of shape (N, nq), and
    returns one result or N. A single argument beside arguments of N states is the same for all of
    them. ``threads``: None or 1 for one thread, 0 for all, or their number.

    SI units, radians. Six-vectors are [angular, linear]. A floating base comes first: of q its
    position and unit quaternion (x, y, z, w), of v its twist in its own axes. Joints and their places
    in q and v are in ``joints``.
    """

    __slots__ = ("_core", "_call", "_source", "__weakref__")

    def __init__(self, core, source):
        self._core = core
        self._call = core._call
        self._source = source

    @classmethod
    def _made(cls, file, document, base, gravity, frames, includes):
        core = _native.Robot(file, document, base, gravity, includes)
        if frames is not None:
            core = core._with_frames(frames)
        return cls(core, (file, document, base, gravity, frames, includes))

    def __reduce__(self):
        return _remade, (type(self), self._source)

    def __repr__(self):
        base, frames = self._source[2], len(self.frames)
        return f"<articulated.Robot {self.name!r}: {base} base, nq={self.nq}, nv={self.nv}, {frames} frames>"

    @property
    def name(self):
        """The robot's name."""
        return self._core.name

    @property
    def base(self):
        """ "fixed" or "floating"."""
        return self._source[2]

    @property
    def nq(self):
        """Number of coordinates."""
        return self._core.nq

    @property
    def nv(self):
        """Number of degrees of freedom."""
        return self._core.nv

    @property
    def joints(self):
        """The joints that have coordinates of their own, in the order of q and v."""
        return tuple(Joint(name, kind, slice(*q), slice(*v)) for name, kind, q, v in self._core._joints)

    @property
    def frames(self):
        """Names of the frames, in the order of results such as ``placements``."""
        return tuple(self._core.frames)

    @property
    def links(self):
        """Names of the moving links, in the order of ``joint_wrenches``."""
        return tuple(self._core.links)

    @property
    def lower(self):
        """Lower bounds of q, (nq,), rad or m; -inf where there are none."""
        return self._core.lower

    @property
    def upper(self):
        """Upper bounds of q, (nq,), rad or m; inf where there are none."""
        return self._core.upper

    @property
    def velocity_limit(self):
        """Largest rates, (nv,), rad/s or m/s; inf where there are none."""
        return self._core.velocity_limit

    @property
    def effort_limit(self):
        """Largest torques or forces, (nv,), N·m or N; inf where there are none."""
        return self._core.effort_limit

    @property
    def gravity(self):
        """Gravity in the world frame, (3,), m/s²."""
        return self._core.gravity

    @property
    def moving_mass(self):
        """Mass of the moving links, kg."""
        return self._core.moving_mass

    @property
    def neutral(self):
        """The configuration of zeros, (nq,), with quaternions (0, 0, 0, 1)."""
        return self._core.neutral

    @property
    def unused(self):
        """What the file says and the dynamics do not use, a sentence each."""
        return tuple(self._core.unused)

    def with_gravity(self, gravity):
        """The same robot under another gravity, m/s² in the world frame."""
        gravity = _vector("gravity", gravity)
        file, document, base, _, frames, includes = self._source
        return type(self)(self._core._with_gravity(gravity), (file, document, base, gravity, frames, includes))

    def with_frames(self, frames):
        """The same robot with these frames only, in this order. Fewer frames take less time."""
        frames = _names("frames", frames)
        file, document, base, gravity, _, includes = self._source
        return type(self)(self._core._with_frames(frames), (file, document, base, gravity, frames, includes))

    def call(self, name, *arguments, threads=None):
        """The function of this name, with its arguments in order."""
        index = _INDEX.get(name) if isinstance(name, str) else None
        if index is None:
            raise _unknown("name", name, _INDEX, "a function of articulated.functions()")
        return self._call(index, arguments, threads)

    def compile(self, functions, *, flags=()):
        """Some of the functions as straight-line C for this robot, compiled by the system's C compiler.

        Compiled robots are kept in the user's cache, or in the folder that the environment variable
        ARTICULATED_CACHE names. CC names another compiler than cc.

        Args:
            functions: Names of functions, such as ["inverse_dynamics"].
            flags: More options of the compiler, such as ["-march=native"].

        Returns:
            CompiledRobot, with the functions as methods.

        Raises:
            RuntimeError: There is no C compiler, or it refuses the code.
        """
        chosen = list(dict.fromkeys(_names("functions", functions)))
        for name in chosen:
            if name not in _INDEX:
                raise _unknown("functions", name, _INDEX, "functions of articulated.functions()")
        if not chosen:
            raise ValueError("functions: found none, expected at least one")
        if self.nv == 0:
            raise ValueError("compile: found a robot without degrees of freedom, expected one that moves")
        rows = [(_INDEX[name], _TABLE[_INDEX[name]]) for name in chosen]
        return CompiledRobot(self, rows, tuple(_names("flags", flags)), _documentation)

    def placements_matrices(self, q, *, threads=None):
        """Placements of all frames in the world frame as homogeneous matrices.

        Args:
            q: (nq,) or (N, nq), rad|m|unit quaternion.
            threads: None or 1 for one thread, 0 for all, or their number.

        Returns:
            (frames, 4, 4) or (N, frames, 4, 4).
        """
        numbers = self.placements(q, threads=threads)
        out = np.zeros(numbers.shape[:-1] + (4, 4))
        out[..., :3, :3] = numbers[..., :9].reshape(numbers.shape[:-1] + (3, 3))
        out[..., :3, 3] = numbers[..., 9:]
        out[..., 3, 3] = 1.0
        return out

    def random_configuration(self, rng=None, size=None, *, uniform=None, threads=None):
        """Configurations at random within limits; ±π rad and ±1 m where there are none, rotations uniform.

        Args:
            rng: A numpy.random.Generator, or a seed for one, or None for any.
            size: None for one configuration, or their number N.
            uniform: (nq,) or (N, nq), numbers in [0, 1) in place of rng and size.
            threads: None or 1 for one thread, 0 for all, or their number.

        Returns:
            (nq,) or (N, nq).
        """
        if uniform is None:
            if not isinstance(rng, np.random.Generator):
                try:
                    rng = np.random.default_rng(rng)
                except (TypeError, ValueError) as error:
                    raise TypeError(f"rng: found {type(rng).__name__} ({error}), expected a numpy.random.Generator, a seed, or None") from None
            try:
                uniform = rng.random(self.nq if size is None else (size, self.nq))
            except (TypeError, ValueError) as error:
                raise type(error)(f"size: found {size!r} ({error}), expected None or a number of configurations") from None
        elif rng is not None or size is not None:
            raise TypeError("random_configuration: found uniform beside rng or size, expected one of them")
        return self._call(_INDEX["random_configuration"], (uniform,), threads)


def _remade(cls, source):
    return cls._made(*source)


def _documentation(function):
    several = [f"        {name}: {_shape(dims)} or {_shape(('N', *dims))}, {unit}." for name, dims, unit in function.takes]
    if function.gives:
        result = f"{_shape(function.gives)} or {_shape(('N', *function.gives))}: {function.unit}."
    else:
        result = f"A float, or (N,): {function.unit}."
    return "\n".join(
        [
            f"{function.summary}.",
            "",
            "    Args:",
            *several,
            "        threads: None or 1 for one thread, 0 for all, or their number.",
            "",
            "    Returns:",
            f"        {result}",
            "",
            f"    {function.source}.",
            "",
        ]
    )


def _method(index, function):
    names = [name for name, _, _ in function.takes]
    given = "".join(f"{name}, " for name in names)
    scope = {}
    # The names are the table's; a function of this text has the arguments and the errors of one written by hand.
    exec(f"def {function.name}(self, {given}*, threads=None):\n    return self._call({index}, ({given}), threads)\n", scope)
    method = scope[function.name]
    method.__doc__ = _documentation(function)
    method.__qualname__ = f"Robot.{function.name}"
    method.__module__ = "articulated"
    return method


for _index, _function in enumerate(_TABLE):
    if not hasattr(Robot, _function.name):
        setattr(Robot, _function.name, _method(_index, _function))


def _robot(file, document, base, gravity, frames, includes):
    if base not in ("fixed", "floating"):
        raise ValueError(f'base: found {base!r}, expected "fixed" or "floating"')
    gravity = _vector("gravity", gravity)
    frames = None if frames is None else _names("frames", frames)
    robot = Robot._made(file, document, base, gravity, frames, includes)
    for finding in robot._core._warnings:
        warnings.warn(RobotWarning(finding["message"], finding), stacklevel=3)
    return robot


def load(path, base="fixed", gravity=GRAVITY, frames=None):
    """The robot of a file.

    Args:
        path: The file, a URDF.
        base: "fixed" if the root link does not move, "floating" if it has six degrees of freedom.
        gravity: (3,), m/s² in the world frame.
        frames: Names of the frames (links) to compute, in this order; None for all.

    Raises:
        RobotError: The file is not a robot; ``diagnostics`` lists all mistakes at once.

    Warns:
        RobotWarning: Something in the file looks wrong; the values are used as they are.
    """
    try:
        path = os.fsdecode(path)
    except TypeError:
        raise TypeError(f"path: found {type(path).__name__}, expected the name of a file") from None
    return _robot(path, _native.read(path), base, gravity, frames, True)


def loads(text, name="robot.urdf", base="fixed", gravity=GRAVITY, frames=None):
    """The robot of a text, str or bytes; ``name`` is the name of its file in messages. See ``load``."""
    if isinstance(text, str):
        text = text.encode("utf-8", "surrogatepass")
    elif isinstance(text, (bytearray, memoryview)):
        text = bytes(text)
    if not isinstance(text, bytes):
        raise TypeError(f"text: found {type(text).__name__}, expected str or bytes")
    if not isinstance(name, str):
        raise TypeError(f"name: found {type(name).__name__}, expected str")
    return _robot(name, text, base, gravity, frames, False)


def bundled(name, base=None, gravity=GRAVITY, frames=None):
    """One of the robots that come with the package; ``bundled_names`` lists them. ``base``: None for its own."""
    robots = {robot: (urdf, own) for robot, urdf, own, _ in _native.bundled_robots()}
    if not isinstance(name, str) or name not in robots:
        raise _unknown("name", name, robots, "one of " + ", ".join(robots))
    urdf, own = robots[name]
    return _robot(f"{name}.urdf", urdf.encode(), own if base is None else base, gravity, frames, False)


def bundled_names():
    """Names of the robots that come with the package, each with a line about it."""
    return {name: summary for name, _, _, summary in _native.bundled_robots()}
