"""Many steps of many states, and the gradient of what comes of them."""

import collections
import math
import warnings
import weakref

import numpy as np

from ._errors import RobotWarning, as_numbers

Rollout = collections.namedtuple("Rollout", ["q", "v"])
RolloutGradient = collections.namedtuple("RolloutGradient", ["q", "v", "tau"])
ActuatedRollout = collections.namedtuple("ActuatedRollout", ["q", "v", "act"])
ActuatedRolloutGradient = collections.namedtuple("ActuatedRolloutGradient", ["q", "v", "act", "ctrl"])
State = collections.namedtuple("State", ["q", "v"])
ContactForces = collections.namedtuple("ContactForces", ["acts", "point", "normal", "force", "moment", "relative_error", "search_steps"])
ConstrainedStep = collections.namedtuple("ConstrainedStep", ["q", "v", "act", "warm"])
MujocoState = collections.namedtuple("MujocoState", ["qpos", "qvel"])
# How names of steps begin: with torques, with controls of actuators, and with constraints too.
STEP, ACTUATED, CONSTRAINED = "step_", "actuated_step_", "constrained_step_"
# Robots whose forces of the file are off, after a warning, and those with computed constraints.
_WARNED, _CHECKED = weakref.WeakSet(), weakref.WeakSet()
# Derivatives of steps, by robot and method.
_DERIVATIVES = weakref.WeakKeyDictionary()


class Steps:
    """A method of steps of one kind."""

    def __init__(self, robot, method, kind, takes_contacts=False):
        self.robot, self.actuated, self.constrained = robot, kind != STEP, kind == CONSTRAINED
        self.name = method if str(method).startswith(kind) else f"{kind}{method}"
        if kind == CONSTRAINED and not takes_contacts and robot.given_contacts:
            found = f"{len(robot.given_contacts)} contacts that a caller gives"
            raise ValueError(f"given_contacts: found {found}, expected constrained_step, which takes them, or a robot without")
        if kind == CONSTRAINED and robot not in _CHECKED:
            for warning in robot._check_constraints():
                warnings.warn(RobotWarning(warning), stacklevel=5)
            _CHECKED.add(robot)
        if kind == ACTUATED and not robot._has_actuators:
            raise ValueError(f"actuated_rollout: {robot.name!r} has no actuators, expected a robot of an MJCF with <actuator>")
        if self.actuated and robot not in _WARNED:
            _WARNED.add(robot)
            warning = robot._forces_off()
            if warning:
                warnings.warn(RobotWarning(f'{warning} (load(…, effects="file"))'), stacklevel=5)

    def arrays(self, q, v, act, held):
        """q, v, activations and what is held in each step with the same dimensions of a batch, and these dimensions."""
        count = len(self.robot.actuators)
        states = sum(actuator.has_activation for actuator in self.robot.actuators)
        held_row = ("ctrl", held, (None, count), "(steps, nu)") if self.actuated else ("tau", held, (None, self.robot.nv), "(steps, nv)")
        act = np.zeros(states) if act is None else act
        rows = [("q", q, (self.robot.nq,), None), ("v", v, (self.robot.nv,), None), ("act", act, (states,), None), held_row]
        found = []
        for name, value, tail, words in rows:
            array = np.asarray(as_numbers(name, value), dtype=np.float64)
            own = array.shape[max(array.ndim - len(tail), 0) :]
            if len(own) != len(tail) or any(n is not None and n != m for n, m in zip(tail, own)):
                raise ValueError(f"{name}: found shape {array.shape}, expected {words or f'({tail[0]},)'}, or that behind dimensions of a batch")
            if not np.isfinite(array).all():
                raise ValueError(f"{name}: found {array[~np.isfinite(array)].flat[0]}, expected finite numbers")
            found.append((array, array.shape[: array.ndim - len(tail)], own))
        try:
            batch = np.broadcast_shapes(*(own for _, own, _ in found))
        except ValueError:
            raise ValueError(f"rollout: found dimensions of a batch that do not fit: {[own for _, own, _ in found]}") from None
        count = math.prod(batch)
        return [np.ascontiguousarray(np.broadcast_to(array, batch + own).reshape((count, *own))) for array, _, own in found], batch

    def run(self, flat, h, every, threads):
        """q, v and activations after every so many steps."""
        return self.robot._rollout(self.name, *flat, step_length(h), every, threads)

    def pull(self):
        """The vector–Jacobian product of a step."""
        known = _DERIVATIVES.setdefault(self.robot, {})
        if self.name not in known:
            by = "q v act ctrl" if self.actuated else "q v tau"
            known[self.name] = self.robot.derivative(f"vjp({self.name}, {by})")
        return known[self.name]


def contact_forces(robot, q, v, act, ctrl):
    """The contacts of states, without steps."""
    steps = Steps(robot, "implicit_damping", CONSTRAINED)
    ctrl = np.zeros(len(robot.actuators)) if ctrl is None else np.asarray(as_numbers("ctrl", ctrl), dtype=np.float64)
    (q, v, act, held), batch = steps.arrays(q, v, act, ctrl[..., None, :] if ctrl.ndim else ctrl)
    places, certificates = robot._contacts(q, v, act, np.ascontiguousarray(held[:, 0]))
    places = places.reshape((*batch, *places.shape[1:]))
    vectors = [places[..., k : k + 3] for k in (1, 4, 7, 10)]
    error, count = (certificates[:, k].reshape(batch)[()] for k in (0, 1))
    return ContactForces(places[..., 0] == 1.0, *vectors, error, count.astype(int))


def constrained_step(robot, q, v, act, ctrl, h, contacts, warm, method):
    steps = Steps(robot, method, CONSTRAINED, takes_contacts=True)
    ctrl = np.zeros(len(robot.actuators)) if ctrl is None else np.asarray(as_numbers("ctrl", ctrl), dtype=np.float64)
    (q, v, act, held), batch = steps.arrays(q, v, act, ctrl[..., None, :] if ctrl.ndim else ctrl)
    given = len(robot.given_contacts)
    if contacts is not None and not given:
        raise ValueError("contacts: found contacts, expected a robot with pairs for them: load(…, given_contacts=[…])")
    flat = [
        _beside(name, np.zeros(tail) if value is None else value, tail, batch)
        for name, value, tail in (("contacts", contacts, (given, 8)), ("warm", warm, (robot.nv,)))
    ]
    ends = robot._given_step(steps.name.removeprefix(CONSTRAINED), q, v, act, np.ascontiguousarray(held[:, 0]), *flat, step_length(h))
    return ConstrainedStep(*(end.reshape((*batch, end.shape[1])) for end in ends))


def _beside(name, value, tail, batch):
    """Numbers for each state of a batch: a row for each."""
    array = np.asarray(as_numbers(name, value), dtype=np.float64)
    try:
        full = np.broadcast_to(array, (*batch, *tail))
    except ValueError:
        raise ValueError(f"{name}: found shape {array.shape}, expected {tail}, or that behind the dimensions of the batch {batch}") from None
    if not np.isfinite(array).all():
        raise ValueError(f"{name}: found {array[~np.isfinite(array)].flat[0]}, expected finite numbers")
    return np.ascontiguousarray(full.reshape(math.prod(batch), math.prod(tail)))


def exchanged(robot, name, given):
    """Positions and rates of each state, by a function that translates conventions."""
    found = []
    for (label, value), size in zip(given.items(), (robot.nq, robot.nv)):
        array = np.asarray(as_numbers(label, value), dtype=np.float64)
        if array.ndim == 0 or array.shape[-1] != size:
            raise ValueError(f"{label}: found shape {array.shape}, expected ({size},), or that behind dimensions of a batch")
        found.append(array)
    try:
        batch = np.broadcast_shapes(*(array.shape[:-1] for array in found))
    except ValueError:
        raise ValueError(f"{name}: found dimensions of a batch that do not fit: {[array.shape[:-1] for array in found]}") from None
    flat = [np.ascontiguousarray(np.broadcast_to(array, (*batch, array.shape[-1])).reshape(-1, array.shape[-1])) for array in found]
    return [end.reshape((*batch, end.shape[-1])) for end in robot._exchange(name, *flat)]


def step_length(h):
    h = float(h)
    if not (math.isfinite(h) and h > 0):
        raise ValueError(f"h: found {h}, expected a positive number of seconds")
    return h


def rollout(robot, q, v, act, held, h, method, every, threads, kind):
    if isinstance(every, bool) or not isinstance(every, int) or every < 1:
        raise ValueError(f"every: found {every!r}, expected a number of steps, at least 1")
    steps = Steps(robot, method, kind)
    flat, batch = steps.arrays(q, v, act, held)
    ends = [end.reshape(batch + end.shape[1:]) for end in steps.run(flat, h, every, threads)]
    return ActuatedRollout(*ends) if steps.actuated else Rollout(*ends[:2])


def gradient(robot, q, v, act, held, h, weights, method, threads, kind):
    """`weights`: of q, v and activations after each step."""
    method = Steps(robot, method, kind)
    (q, v, act, held), batch = method.arrays(q, v, act, held)
    count, steps, _ = held.shape
    ends = method.run((q, v, act, held), h, 1, threads)
    given = []
    for (label, own), size in zip(weights.items(), (robot.nv, robot.nv, act.shape[-1])):
        array = np.zeros(()) if own is None else np.asarray(as_numbers(label, own), dtype=np.float64)
        try:
            given.append(np.broadcast_to(array, (*batch, steps, size)).reshape(count, steps, size))
        except ValueError:
            raise ValueError(f"{label}: found shape {array.shape}, expected {(*batch, steps, size)}") from None
    pull, by_held = method.pull(), np.empty_like(held)
    # Where the search of an acceleration begins, and the weights of where it ended: neither counts.
    search = [np.zeros((count, robot.nv))] if method.constrained else []
    by = [np.zeros((count, own.shape[-1])) for own in given]
    # From the last step to the first; by q in the tangent space at the state before the step.
    for k in reversed(range(steps)):
        before = (q, v, act) if k == 0 else [end[:, k - 1] for end in ends]
        after = [own + one[:, k] for own, one in zip(by, given)]
        if method.actuated:
            *by, by_held[:, k] = pull(*before, held[:, k], *search, h, *after, *search, threads=threads)
        else:
            *by, by_held[:, k] = pull(*before[:2], held[:, k], h, *after, threads=threads)
    parts = [*by, by_held]
    shaped = [own.reshape((*batch, *own.shape[1:])) for own in parts]
    return ActuatedRolloutGradient(*shaped) if method.actuated else RolloutGradient(*shaped)
