"""Many steps of many states, and the gradient of what comes of them."""

import collections
import math
import weakref

import numpy as np

from ._errors import as_numbers

Rollout = collections.namedtuple("Rollout", ["q", "v"])
RolloutGradient = collections.namedtuple("RolloutGradient", ["q", "v", "tau"])
# Derivatives of steps, by robot and method.
_DERIVATIVES = weakref.WeakKeyDictionary()


def arrays(robot, q, v, tau):
    """q, v and torques with the same dimensions of a batch, and these dimensions."""
    found = []
    for name, value, tail in (("q", q, (robot.nq,)), ("v", v, (robot.nv,)), ("tau", tau, (None, robot.nv))):
        array = np.asarray(as_numbers(name, value), dtype=np.float64)
        own = array.shape[max(array.ndim - len(tail), 0) :]
        if len(own) != len(tail) or any(n is not None and n != m for n, m in zip(tail, own)):
            expected = "(steps, nv)" if name == "tau" else f"({tail[0]},)"
            raise ValueError(f"{name}: found shape {array.shape}, expected {expected}, or that behind dimensions of a batch")
        if not np.isfinite(array).all():
            raise ValueError(f"{name}: found {array[~np.isfinite(array)].flat[0]}, expected finite numbers")
        found.append((array, array.shape[: array.ndim - len(tail)], own))
    try:
        batch = np.broadcast_shapes(*(own for _, own, _ in found))
    except ValueError:
        raise ValueError(f"rollout: found dimensions of a batch that do not fit: {[own for _, own, _ in found]}") from None
    count = math.prod(batch)
    flat = [np.ascontiguousarray(np.broadcast_to(array, batch + own).reshape((count, *own))) for array, _, own in found]
    return flat, batch


def step_length(h):
    h = float(h)
    if not (math.isfinite(h) and h > 0):
        raise ValueError(f"h: found {h}, expected a positive number of seconds")
    return h


def rollout(robot, q, v, tau, h, method, every, threads):
    if isinstance(every, bool) or not isinstance(every, int) or every < 1:
        raise ValueError(f"every: found {every!r}, expected a number of steps, at least 1")
    flat, batch = arrays(robot, q, v, tau)
    ends = robot._rollout(str(method), *flat, step_length(h), every, threads)
    return Rollout(*(end.reshape(batch + end.shape[1:]) for end in ends))


def gradient(robot, q, v, tau, h, weights_q, weights_v, method, threads):
    name = method if str(method).startswith("step_") else f"step_{method}"
    flat, batch = arrays(robot, q, v, tau)
    q, v, tau = flat
    count, steps, nv = tau.shape
    ends = robot._rollout(name, q, v, tau, step_length(h), 1, threads)
    given = []
    for label, weights in (("weights_q", weights_q), ("weights_v", weights_v)):
        array = np.zeros(()) if weights is None else np.asarray(as_numbers(label, weights), dtype=np.float64)
        try:
            given.append(np.broadcast_to(array, (*batch, steps, nv)).reshape(count, steps, nv))
        except ValueError:
            raise ValueError(f"{label}: found shape {array.shape}, expected {(*batch, steps, nv)}") from None
    known = _DERIVATIVES.setdefault(robot, {})
    pull = known.get(name)
    if pull is None:
        pull = known[name] = robot.derivative(f"vjp({name}, q v tau)")
    by_tau = np.empty_like(tau)
    by_q, by_v = np.zeros((count, nv)), np.zeros((count, nv))
    # From the last step to the first; by q in the tangent space at the state before the step.
    for k in reversed(range(steps)):
        before_q, before_v = (q, v) if k == 0 else (ends[0][:, k - 1], ends[1][:, k - 1])
        by_q, by_v, by_tau[:, k] = pull(before_q, before_v, tau[:, k], h, by_q + given[0][:, k], by_v + given[1][:, k], threads=threads)
    return RolloutGradient(by_q.reshape((*batch, nv)), by_v.reshape((*batch, nv)), by_tau.reshape((*batch, steps, nv)))
