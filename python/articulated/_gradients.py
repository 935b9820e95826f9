"""Derivatives of the functions of a robot, for ``torch`` and ``jax``.

They are transforms of the traced functions: ``vjp``, ``jvp`` and ``hvp`` by the numbers of q, of the
function of q with its quaternions normalised. So they are exact for any quaternion, and orthogonal to
it.
"""

import math
import weakref
from typing import NamedTuple

import numpy as np

from ._compiled import CompiledRobot, lengths
from ._derivative import WITHOUT, by_all
from ._robot import _TABLE, Robot


class Rule(NamedTuple):
    """Arguments and result of a function that has derivatives."""

    takes: tuple
    gives: tuple


RULES = {f.name: Rule(f.takes, f.gives) for f in _TABLE if f.name not in WITHOUT}


def _quaternions(robot):
    """Where q has quaternions."""
    for joint in robot.joints:
        if joint.kind == "floating":
            yield slice(joint.q.start + 3, joint.q.start + 7)
        elif joint.kind == "spherical":
            yield joint.q


def normalized(robot, q):
    """q with unit quaternions."""
    places = list(_quaternions(robot))
    if not places:
        return q
    q = np.array(q)
    with np.errstate(invalid="ignore", divide="ignore"):
        for at in places:
            q[..., at] /= np.linalg.norm(q[..., at], axis=-1, keepdims=True)
    return q


class _Calls:
    """Functions of a robot by name: compiled where there are such, the library's else."""

    def __init__(self, robot, threads):
        self.fast = robot if isinstance(robot, CompiledRobot) else None
        self.robot = robot.robot if self.fast else robot
        self.threads = threads

    def __call__(self, name, *arguments):
        robot = self.fast if self.fast and name in self.fast.functions else self.robot
        return np.asarray(getattr(robot, name)(*arguments, threads=self.threads))


# By robot, as long as it lives.
_DERIVED = weakref.WeakKeyDictionary()


def _derived(robot, kind, name):
    """A derivative of a function by all of its arguments, traced for the robot."""
    known = _DERIVED.setdefault(robot, {})
    if (kind, name) not in known:
        known[kind, name] = robot._derived(f"derivative = {by_all(kind, name, RULES[name].takes)}")
    return known[kind, name]


def _run(robot, kind, name, threads, arrays):
    """The results of a derivative, for arrays with one batch dimension."""
    compiled = robot._derivatives.get((kind, name)) if isinstance(robot, CompiledRobot) else None
    robot = check(robot)
    derived = _derived(robot, kind, name)
    flat = [np.ascontiguousarray(array.reshape(len(array), math.prod(array.shape[1:])), dtype=np.float64) for array in arrays]
    found = (compiled or derived).run(flat, 1 if threads in (None, 1) else 0)
    return [part.reshape((len(part), *lengths(robot, dims))) for part, (_, dims, _) in zip(found, derived.gives())]


# Arguments that are configurations.
_CONFIGURATIONS = ("q", "target")


def rule(module, name):
    """The rule of this name, for ``module.__getattr__``."""
    if name.startswith("__") or name not in {function.name for function in _TABLE}:
        raise AttributeError(f"module {module!r} has no attribute {name!r}")
    raise AttributeError(f"{module}: found {name!r}, which has no derivative here, expected one of {', '.join(RULES)}")


def check(robot):
    """The robot whose functions are called."""
    if not isinstance(robot, (Robot, CompiledRobot)):
        raise TypeError(f"robot: found {type(robot).__name__}, expected an articulated.Robot or what its compile returns")
    return robot.robot if isinstance(robot, CompiledRobot) else robot


def sizes(robot, name):
    """Names and shapes of the arguments of one state, and the shape of the result."""
    robot = check(robot)
    return [(argument, lengths(robot, dims)) for argument, dims, _ in RULES[name].takes], lengths(robot, RULES[name].gives)


def batch_shape(arguments, takes):
    """The dimensions before those of one state, which broadcast."""
    batches = []
    for array, (name, shape) in zip(arguments, takes):
        if tuple(array.shape[array.ndim - len(shape) :]) != shape or array.ndim < len(shape):
            raise ValueError(f"{name}: found shape {tuple(array.shape)}, expected {shape}, or that behind dimensions of a batch")
        batches.append(tuple(array.shape[: array.ndim - len(shape)]))
    try:
        return np.broadcast_shapes(*batches)
    except ValueError:
        found = ", ".join(f"{batch} of {name}" for batch, (name, _) in zip(batches, takes))
        raise ValueError(f"found dimensions of a batch that do not fit: {found}") from None


def _flat(robot, takes, arguments):
    """Arguments of one batch dimension, (N, …), with unit quaternions, and the dimensions they had."""
    batch = batch_shape(arguments, takes)
    count = math.prod(batch)
    flat = [np.broadcast_to(array, batch + shape).reshape((count, *shape)) for array, (_, shape) in zip(arguments, takes)]
    return batch, [normalized(robot, array) if name in _CONFIGURATIONS else array for array, (name, _) in zip(flat, takes)]


def value(robot, name, threads, arguments):
    """The function of arrays of any batch dimensions: of float32 if all of them are."""
    call = _Calls(robot, threads)
    takes, gives = sizes(robot, name)
    arrays = [np.asarray(array) for array in arguments]
    dtype = np.float32 if all(array.dtype == np.float32 for array in arrays) else np.float64
    batch, flat = _flat(call.robot, takes, [array.astype(dtype, copy=False) for array in arrays])
    return call(name, *flat).reshape(batch + gives)


def _whole(robot, name, arguments, more):
    """Arguments and further arrays in float64, (N, …), and the dimensions that they had."""
    takes, _ = sizes(robot, name)
    shapes = [shape for _, shape in takes]
    pairs = [(np.asarray(array, dtype=np.float64), shape) for array, shape in [*zip(arguments, shapes), *more(shapes)]]
    batch = batch_shape([array for array, _ in pairs], [*takes, *(("weights", shape) for _, shape in pairs[len(takes) :])])
    flat = [np.broadcast_to(array, batch + shape).reshape((math.prod(batch), *shape)) for array, shape in pairs]
    return batch, flat


def gradients(robot, name, threads, arguments, gradient):
    """Gradients of all arguments, of the gradient of the result, in float64."""
    _, gives = sizes(robot, name)
    batch, flat = _whole(robot, name, arguments, lambda _: [(gradient, gives)])
    found = _run(robot, "vjp", name, threads, flat)
    return [part.reshape(batch + part.shape[1:]) for part in found]


def along(robot, name, threads, arguments, directions):
    """The derivative of the result along directions of all arguments, in float64."""
    _, gives = sizes(robot, name)
    batch, flat = _whole(robot, name, arguments, lambda shapes: zip(directions, shapes))
    return _run(robot, "jvp", name, threads, flat)[0].reshape(batch + gives)


def second(robot, name, threads, arguments, gradient, directions):
    """Gradients of <directions, ``gradients(…)``>: by the gradient of the result, and by all arguments."""
    _, gives = sizes(robot, name)
    batch, flat = _whole(robot, name, arguments, lambda shapes: [(gradient, gives), *zip(directions, shapes)])
    found = _run(robot, "hvp", name, threads, flat)
    return along(robot, name, threads, arguments, directions), [part.reshape(batch + part.shape[1:]) for part in found]


def document(function, name, tensor):
    """Gives a wrapper its name and its documentation."""
    takes = ", ".join(argument for argument, _, _ in RULES[name].takes)
    function.__name__ = function.__qualname__ = name
    function.__doc__ = f"""``Robot.{name}`` with exact derivatives.

    Args:
        robot: A robot, or a compiled one, whose compiled functions are used where it has them.
        {takes}: {tensor}, of one state or behind any dimensions of a batch, which broadcast.
        threads: None or 1 for one thread, 0 for all, or their number; derivatives take one thread or all.

    The gradient by q has nq numbers: it is that of the function of q with its quaternions normalised.
    """
    return function


def in_order(name, arguments, named):
    """The arguments in order, some by position and some by name."""
    takes = [argument for argument, _, _ in RULES[name].takes]
    given = dict(zip(takes, arguments))
    wrong = [argument for argument in named if argument not in takes or argument in given]
    if wrong:
        raise TypeError(f"{name}: found {wrong[0]!r} by name, expected what is not given by position of {', '.join(takes)}")
    given.update(named)
    if len(given) != len(takes) or len(arguments) > len(takes):
        found = len(arguments) + len(named)
        raise TypeError(f"{name}: found {found} arguments after the robot, expected {len(takes)}: {', '.join(takes)}")
    return [given[argument] for argument in takes]
