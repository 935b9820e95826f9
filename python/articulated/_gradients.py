"""Vector-Jacobian products of functions, from the library's derivative functions. For ``torch`` and ``jax``.

Derivatives with respect to q are along q ⊕ δ, of nv numbers. Gradients here have the nq numbers of q.
They are those of the function of q with its quaternions normalised, so that they are exact for any
quaternion, and orthogonal to it.
"""

import math
from typing import Callable, NamedTuple

import numpy as np

from ._compiled import CompiledRobot, lengths
from ._robot import _TABLE, Robot


class Rule(NamedTuple):
    """The derivative of a function: of a gradient of its result, those of its arguments."""

    takes: tuple
    gives: tuple
    gradients: Callable


def _quaternions(robot):
    """Where q has quaternions, and v their rates, with the position and its rate if there is one."""
    for joint in robot.joints:
        if joint.kind == "floating":
            q, v = joint.q.start, joint.v.start
            yield slice(q + 3, q + 7), slice(v, v + 3), (slice(q, q + 3), slice(v + 3, v + 6))
        elif joint.kind == "spherical":
            yield joint.q, joint.v, None


def _rotation(x):
    """The rotation matrices of unit quaternions (x, y, z, w)."""
    i, j, k, w = np.moveaxis(x, -1, 0)
    rows = [
        [1 - 2 * (j * j + k * k), 2 * (i * j - k * w), 2 * (i * k + j * w)],
        [2 * (i * j + k * w), 1 - 2 * (i * i + k * k), 2 * (j * k - i * w)],
        [2 * (i * k - j * w), 2 * (j * k + i * w), 1 - 2 * (i * i + j * j)],
    ]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))


def _rates(x):
    """E(x), (…, 4, 3): a quaternion's rate is ½ E(x) ω, with ω in the body's axes. EᵀE = 1 for unit quaternions."""
    i, j, k, w = np.moveaxis(x, -1, 0)
    return np.moveaxis(np.array([[w, -k, j], [k, w, -i], [-j, i, w], [-i, -j, -k]]), (0, 1), (-2, -1))


def normalized(robot, q):
    """q with unit quaternions."""
    places = list(_quaternions(robot))
    if not places:
        return q
    q = np.array(q)
    with np.errstate(invalid="ignore", divide="ignore"):
        for at, _, _ in places:
            q[..., at] /= np.linalg.norm(q[..., at], axis=-1, keepdims=True)
    return q


def _to_coordinates(robot, q, gradient):
    """The gradient by q, (…, nq), of one along q ⊕ δ, (…, nv)."""
    out = np.zeros(np.broadcast_shapes(q.shape[:-1], gradient.shape[:-1]) + (robot.nq,))
    for joint in robot.joints:
        if joint.kind not in ("floating", "spherical"):
            out[..., joint.q] = gradient[..., joint.v]
    for at, rate, position in _quaternions(robot):
        size = np.linalg.norm(q[..., at], axis=-1, keepdims=True)
        unit = q[..., at] / size
        # The inverse of ½ E on its range is 2 Eᵀ.
        out[..., at] = 2 * np.einsum("...ij,...j->...i", _rates(unit), gradient[..., rate]) / size
        if position:
            out[..., position[0]] = np.einsum("...ij,...j->...i", _rotation(unit), gradient[..., position[1]])
    return out


def _to_tangent(robot, q, gradient):
    """The gradient along q ⊕ δ, (…, nv), of one by q, (…, nq), at unit quaternions."""
    out = np.zeros(gradient.shape[:-1] + (robot.nv,))
    for joint in robot.joints:
        if joint.kind not in ("floating", "spherical"):
            out[..., joint.v] = gradient[..., joint.q]
    for at, rate, position in _quaternions(robot):
        out[..., rate] = np.einsum("...ij,...i->...j", _rates(q[..., at]), gradient[..., at]) / 2
        if position:
            out[..., position[1]] = np.einsum("...ij,...i->...j", _rotation(q[..., at]), gradient[..., position[0]])
    return out


class _Calls:
    """Functions of a robot by name: compiled where there are such, the library's else."""

    def __init__(self, robot, threads):
        self.fast = robot if isinstance(robot, CompiledRobot) else None
        self.robot = robot.robot if self.fast else robot
        self.threads = threads

    def __call__(self, name, *arguments):
        robot = self.fast if self.fast and name in self.fast.functions else self.robot
        return np.asarray(getattr(robot, name)(*arguments, threads=self.threads))

    def jacobians(self, q):
        """Those that external wrenches act along."""
        return self("jacobians_" + self.robot.wrenches_in, q)


def _rows(gradient, jacobian):
    return np.einsum("ni,nij->nj", gradient, jacobian)


def _of_dynamics(call, name, gradient, q, *rest):
    """Of functions with a (3, nv, nv) of derivatives; wrenches w act as Jᵀ w."""
    derivatives = call(name, q, *rest)
    first = [_rows(gradient, derivatives[:, k]) for k in range(3)]
    if len(rest) < 3:
        return first
    # Of inverse dynamics τ = … − Jᵀ w, of forward dynamics a = M⁻¹ (… + Jᵀ w).
    force = first[2] if name.startswith("forward") else -gradient
    return [*first, np.einsum("nfij,nj->nfi", call.jacobians(q), force)]


def _of_static_torque(call, gradient, q, wrenches):
    derivative = call("static_torque_derivative", q, wrenches)
    return [_rows(gradient, derivative), -np.einsum("nfij,nj->nfi", call.jacobians(q), gradient)]


def _at_rest(call, q, *rest):
    return [q, *rest, *([np.zeros((len(q), call.robot.nv))] * (2 - len(rest)))]


def _of_integrate(call, gradient, q, step):
    end = call("integrate", q, step)
    derivatives = call("integrate_derivatives", step)
    along = _to_tangent(call.robot, end, gradient)
    return [_rows(along, derivatives[:, 0]), _rows(along, derivatives[:, 1])]


def _of_difference(call, gradient, q, target):
    derivatives = call("difference_derivatives", q, target)
    return [_rows(gradient, derivatives[:, 0]), _rows(gradient, derivatives[:, 1])]


_DERIVATIVES = {
    "inverse_dynamics": lambda call, g, *x: _of_dynamics(call, "inverse_dynamics_derivatives", g, *x),
    "inverse_dynamics_with_wrenches": lambda call, g, *x: _of_dynamics(call, "inverse_dynamics_derivatives_with_wrenches", g, *x),
    "forward_dynamics": lambda call, g, *x: _of_dynamics(call, "forward_dynamics_derivatives", g, *x),
    "forward_dynamics_with_wrenches": lambda call, g, *x: _of_dynamics(call, "forward_dynamics_derivatives_with_wrenches", g, *x),
    "bias_forces": lambda call, g, *x: _of_dynamics(call, "inverse_dynamics_derivatives", g, *_at_rest(call, *x))[:2],
    "gravity_torque": lambda call, g, *x: _of_dynamics(call, "inverse_dynamics_derivatives", g, *_at_rest(call, *x))[:1],
    "static_torque": _of_static_torque,
    "placements": lambda call, g, q: [np.einsum("nfi,nfij->nj", g, call("placement_derivatives", q))],
    "center_of_mass": lambda call, g, q: [_rows(g, call("center_of_mass_jacobian", q))],
    "potential_energy": lambda call, g, q: [g[:, None] * call("gravity_torque", q)],
    "integrate": _of_integrate,
    "difference": _of_difference,
}

RULES = {f.name: Rule(f.takes, f.gives, _DERIVATIVES[f.name]) for f in _TABLE if f.name in _DERIVATIVES}

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


def gradients(robot, name, threads, arguments, gradient):
    """Gradients of all arguments, of the gradient of the result, in float64."""
    call = _Calls(robot, threads)
    takes, gives = sizes(robot, name)
    arguments = [np.asarray(array, dtype=np.float64) for array in arguments]
    batch, flat = _flat(call.robot, takes, arguments)
    gradient = np.broadcast_to(np.asarray(gradient, dtype=np.float64), batch + gives).reshape((math.prod(batch), *gives))
    out = RULES[name].gradients(call, gradient, *flat)
    for k, (argument, shape) in enumerate(takes):
        if argument in _CONFIGURATIONS:
            given = np.broadcast_to(arguments[k], batch + shape).reshape((math.prod(batch), *shape))
            out[k] = _to_coordinates(call.robot, given, out[k])
    return [part.reshape(batch + shape) for part, (_, shape) in zip(out, takes)]


def document(function, name, tensor):
    """Gives a wrapper its name and its documentation."""
    takes = ", ".join(argument for argument, _, _ in RULES[name].takes)
    function.__name__ = function.__qualname__ = name
    function.__doc__ = f"""``Robot.{name}`` with exact derivatives.

    Args:
        robot: A robot, or a compiled one, whose compiled functions are used where it has them.
        {takes}: {tensor}, of one state or behind any dimensions of a batch, which broadcast.
        threads: None or 1 for one thread, 0 for all, or their number.

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
