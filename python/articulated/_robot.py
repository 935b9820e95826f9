"""The class Robot. Its functions are made from the library's table."""

import os
import warnings
from typing import NamedTuple, Optional

import numpy as np

from . import _native, _rollout, _wheel
from ._compiled import CompiledRobot
from ._derivative import KINDS, Derivative, rows
from ._errors import RobotWarning, as_names, as_numbers


class Actuator(NamedTuple):
    """An actuator of the robot's file."""

    name: str
    lower: float
    upper: float
    has_activation: bool


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


def _missing(robot, name, functions):
    """The error for an attribute that a robot does not have."""
    near = None if name.startswith("_") else _native.nearest(name, list(functions))
    hint = f"; did you mean {near!r}?" if near else ""
    return AttributeError(f"{type(robot).__name__!r} object has no attribute {name!r}{hint}", name=name, obj=robot)


def _unknown(what, found, names, expected):
    near = _native.nearest(str(found), list(names))
    return ValueError(f"{what}: found {found!r}, expected {expected}" + (f"; did you mean {near!r}?" if near else ""))


def _name(what, name):
    if not isinstance(name, str):
        raise TypeError(f"{what}: found {type(name).__name__}, expected a name")
    return name


def _number(what, value, unit=""):
    number = as_numbers(what, value)
    if number.shape != () or not np.isfinite(number):
        raise ValueError(f"{what}: found {value!r}, expected a finite number{unit}")
    return float(number)


def _path(what, path):
    try:
        return os.fsdecode(path)
    except TypeError:
        raise TypeError(f"{what}: found {type(path).__name__}, expected the name of a file") from None


def _reference(name):
    if name not in ("body", "world", "world_aligned"):
        raise ValueError(f'wrenches_in: found {name!r}, expected "body", "world" or "world_aligned"')
    return name


def _vector(name, value, expected):
    """Finite numbers; three of them, unless nothing is expected."""
    array = as_numbers(name, value)
    if expected is None:
        expected = "finite numbers"
        is_shape = array.ndim == 1
    else:
        is_shape = array.shape == (3,)
    if not is_shape or not np.isfinite(array).all():
        found = f"{array.tolist()}" if is_shape else f"shape {array.shape}"
        raise ValueError(f"{name}: found {found}, expected {expected}")
    return tuple(array.tolist())


def _inertia(value):
    array = as_numbers("inertia", value)
    if array.shape == (3, 3) and np.array_equal(array, array.T):
        array = array[np.triu_indices(3)]
    if array.shape != (6,) or not np.isfinite(array).all():
        found = "a matrix that is not symmetric" if array.shape == (3, 3) else f"shape {array.shape}"
        found = found if array.shape != (6,) else f"{array.tolist()}"
        raise ValueError(f"inertia: found {found}, expected a symmetric (3, 3), or xx, xy, xz, yy, yz, zz, kg·m²")
    return tuple(array.tolist())


# No exception for suspicious content, nothing left out, and no snapped angle.
_AS_WRITTEN = ((False, False, False), (), None, ())


class _Source(NamedTuple):
    """What makes a robot: its document, and what is requested of it."""

    file: str
    document: bytes
    base: str
    gravity: Optional[tuple]
    includes: bool
    wrenches_in: str = "body"
    frames: Optional[tuple] = None
    append: tuple = ()
    payloads: tuple = ()
    locks: tuple = ()
    args: tuple = ()
    packages: tuple = ()
    # See `_reading`.
    reading: tuple = _AS_WRITTEN
    # Whether joints follow others according to the file, and according to calls.
    coupling: tuple = (False, ())
    # Whether the smooth effects of the file act.
    effects: bool = False


class Robot(_native.Robot):
    """A robot's dynamics. ``articulated.load``, ``loads`` and ``bundled`` make one.

    Each function takes one state, such as q of shape (nq,), or N states, of shape (N, nq), and
    returns one result or N. There may be several dimensions in place of N; those of the arguments
    broadcast as NumPy's do. A single argument beside arguments of N states is the same for all of
    them. ``threads``: None or 1 for one thread, 0 for all, or their number.

    Arguments that are all float32 are computed in float32, and so is the result; all others in
    float64. ``out``: an array for the result, of its shape and type, which the call returns.

    SI units, radians. Six-vectors are [angular, linear]. A floating base comes first: of q its
    position and unit quaternion (x, y, z, w), of v its twist in its own axes. Joints and their places
    in q and v are in ``joints``.
    """

    __slots__ = ("_source", "__weakref__")

    def __new__(cls, *_arguments, **_named):
        raise TypeError("Robot: found a call of the class, expected one of articulated.load, loads and bundled, which make robots")

    @classmethod
    def _made(cls, source, like=None):
        robot = _native.Robot.__new__(cls, *source, like)
        robot._source = source
        return robot

    def __getattr__(self, name):
        raise _missing(self, name, _INDEX)

    def __reduce__(self):
        return _remade, (type(self), self._source)

    def __repr__(self):
        return f"<articulated.Robot {self.name!r}: {self.base} base, nq={self.nq}, nv={self.nv}, {len(self.frames)} frames>"

    @property
    def joints(self):
        """The joints that have coordinates of their own, in the order of q and v."""
        return tuple(Joint(name, kind, slice(*q), slice(*v)) for name, kind, q, v in self._joints)

    @property
    def actuators(self):
        """The actuators of the robot's file (MJCF), in the order of controls: name, bounds of the control (or
        infinite ones), and whether it has an activation."""
        return tuple(Actuator(*actuator) for actuator in self._actuators)

    def with_gravity(self, gravity):
        """The same robot under another gravity, m/s² in the world frame."""
        return self._made(self._source._replace(gravity=_vector("gravity", gravity, "three finite numbers, m/s² in the world frame")), self)

    def with_frames(self, frames):
        """The same robot with these frames only, in this order. Fewer frames take less time."""
        return self._made(self._source._replace(frames=tuple(as_names("frames", frames))), self)

    def with_wrenches_in(self, reference):
        """The same robot, with the external wrenches that functions take in other axes.

        Args:
            reference: "body": axes of each frame, about its origin. "world": axes of the world frame,
                about the world frame's origin. "world_aligned": axes of the world frame, about the
                frame's origin.
        """
        return self._made(self._source._replace(wrenches_in=_reference(reference)), self)

    def lock(self, joint, at=0.0):
        """The robot with a joint held. Its coordinates leave q and v; links keep their names.

        Args:
            joint: The joint's name; or a dict of several names and their coordinates.
            at: Its coordinate, rad or m; several for a joint that has several.

        Raises:
            RobotError: There is no such joint, or the coordinates do not fit it.
        """
        joints = joint if isinstance(joint, dict) else {joint: at}
        for name in joints:
            _name("joint", name)
        locks = tuple((name, _vector("at", np.atleast_1d(as_numbers("at", one)), None)) for name, one in joints.items())
        return self._edited(self._source._replace(locks=self._source.locks + locks))

    def couple(self, joint, leaders, offset=0.0, *, polynomial=None, reference=0.0):
        """The same robot with a joint that follows others: its coordinate is Σ coefficient · q + offset.

        With a polynomial it follows one joint: its coordinate is Σ polynomial[k] · (q − reference)ᵏ.

        Args:
            joint: The name of the joint, of one coordinate.
            leaders: The coefficient of each joint that it follows, by name: ``{"m1": 0.5, "m2": -0.5}``.
                With a polynomial, the name of the joint that it follows.
            offset: Its coordinate where all of them are 0, rad or m. Not with a polynomial.
            polynomial: (1,) to (5,), the coefficients from power 0 on, rad or m over powers of rad or m.
            reference: The coordinate of the leader about which the polynomial is written, rad or m.

        Raises:
            RobotError: There is no such joint, or it cannot follow.
            ValueError: The polynomial has a degree above 4, or an offset beside it.
        """
        if polynomial is not None:
            if not isinstance(leaders, str):
                raise TypeError(f"leaders: found {type(leaders).__name__}, expected the name of one joint with a polynomial")
            if offset != 0.0:
                raise ValueError(f"offset: found {offset!r} with a polynomial, expected polynomial[0] to have it")
            numbers = [float(x) for x in np.atleast_1d(as_numbers("polynomial", polynomial))]
            law = (_name("leaders", leaders), numbers, _number("reference", reference))
            of_file, rest = self._source.coupling
            return self._edited(self._source._replace(coupling=(of_file, (*rest, (_name("joint", joint), (), 0.0, law)))))
        if not hasattr(leaders, "items"):
            raise TypeError(f"leaders: found {type(leaders).__name__}, expected a dict of joints and coefficients")
        rows = tuple((_name("leaders", name), _number(f"leaders[{name!r}]", value)) for name, value in leaders.items())
        of_file, rest = self._source.coupling
        return self._edited(self._source._replace(coupling=(of_file, (*rest, (_name("joint", joint), rows, _number("offset", offset), None)))))

    def payload(self, link, mass, center_of_mass=(0.0, 0.0, 0.0), inertia=None):
        """The robot with a load on a link or frame.

        Args:
            link: The name of the link or frame.
            mass: kg.
            center_of_mass: (3,), m, in that frame.
            inertia: About the centre of mass, in axes of that frame, kg·m²: (3, 3), or xx, xy, xz, yy,
                yz, zz. None for a point mass.

        Raises:
            RobotError: There is no such link, or no such body.
        """
        numbers = _number("mass", mass, ", kg")
        center = _vector("center_of_mass", center_of_mass, "three finite numbers, m in the frame of the link")
        inertia = (0.0,) * 6 if inertia is None else _inertia(inertia)
        payloads = (*self._source.payloads, (_name("link", link), numbers, center, inertia))
        return self._edited(self._source._replace(payloads=payloads))

    def append(self, other, at, prefix="", position=(0.0, 0.0, 0.0), rpy=(0.0, 0.0, 0.0)):
        """The robot with another one, such as a gripper, fixed to a link or frame.

        Args:
            other: A robot without edits, or the path of a file.
            at: The link or frame that carries it.
            prefix: What its names of joints and links begin with here.
            position: (3,), m: its root's origin in that frame.
            rpy: (3,), rad: roll, pitch and yaw of its root there.

        Raises:
            RobotError: There is no such link, or a name occurs twice.
        """
        packages = dict(self._source.packages)
        if isinstance(other, Robot):
            source = other._source
            if source.append or source.payloads or source.locks or source.coupling != (False, ()):
                raise ValueError("other: found a robot with edits, expected one as loaded; append it first, and edit the result")
            if source.effects and not self._source.effects:
                raise ValueError('other: found a robot with effects="file", expected that of the robot that carries it to have them')
            if source.args:
                raise ValueError("other: found a robot with args, expected one without: args are those of the robot that carries it")
            if source.reading not in (self._source.reading, _AS_WRITTEN):
                raise ValueError("other: found a robot read with other options, expected those of the robot that carries it")
            for name, folder in source.packages:
                if packages.setdefault(name, folder) != folder:
                    raise ValueError(f"other: found package {name!r} in {folder!r}, expected {packages[name]!r} as in this robot")
            file, document, includes = source.file, source.document, source.includes
        else:
            file = _path("other", other)
            document, includes = _native.read(file), True
        position = _vector("position", position, "three finite numbers, m in the frame of the link")
        rpy = _vector("rpy", rpy, "three finite numbers, rad")
        row = (file, document, includes, _name("at", at), _name("prefix", prefix), position, rpy)
        return self._edited(self._source._replace(append=(*self._source.append, row), packages=tuple(packages.items())))

    def _edited(self, source):
        known = {finding["message"] for finding in self._warnings}
        robot = self._made(source)
        for finding in robot._warnings:
            if finding["message"] not in known:
                warnings.warn(RobotWarning(finding["message"], finding), stacklevel=3)
        return robot

    def call(self, name, *arguments, threads=None, out=None):
        """The function of this name, with its arguments in order."""
        index = _INDEX.get(name) if isinstance(name, str) else None
        if index is None:
            raise _unknown("name", name, _INDEX, "a function of articulated.functions()")
        return self._call(index, arguments, threads, out)

    def compile(self, functions, *, flags=(), batch=False, derivatives=()):
        """Some of the functions as straight-line C for this robot, compiled by the system's C compiler.

        Compiled robots are kept in the user's cache, or in the folder that the environment variable
        ARTICULATED_CACHE names. CC names another compiler than cc.

        Args:
            functions: Names of functions, such as ["inverse_dynamics"].
            flags: More options of the compiler, such as ["-march=native"].
            batch: Also compile code that computes a state in each lane of a vector: a call of N states
                takes a third of the time or less, and the compiler two to four times as long.
            derivatives: Also compile derivatives of these functions, those that ``articulated.torch`` and
                ``articulated.jax`` take: "vjp" for gradients, "jvp" for forward mode, "hvp" for second ones.

        Returns:
            CompiledRobot, with the functions as methods.

        Raises:
            RuntimeError: There is no C compiler, or it refuses the code.
            ValueError: A function or a derivative is unknown.
        """
        chosen = [(index, _TABLE[index]) for index in self._chosen("compile", functions)]
        kinds = as_names("derivatives", derivatives)
        for kind in kinds:
            if kind not in KINDS:
                raise _unknown("derivatives", kind, KINDS, f"some of {', '.join(KINDS)}")
        derived = rows(self, kinds, [function for _, function in chosen])
        return CompiledRobot(self, chosen, tuple(as_names("flags", flags)), bool(batch), _text, derived)

    def derivative(self, request):
        """A derivative of a function by name, as a function on NumPy arrays.

        >>> robot = articulated.bundled("panda_like")                          # doctest: +SKIP
        >>> pull = robot.derivative("vjp(inverse_dynamics, q v)")              # doctest: +SKIP
        >>> pull(q, v, a, weights).grad_q                                      # doctest: +SKIP

        Args:
            request: ``vjp``, ``jvp``, ``hvp``, ``hessian``, ``jacobian`` or ``gradient`` of a function, and the
                arguments that it is taken with respect to; all if there are none. By q it is in the tangent
                space, with nv numbers, or by the nq numbers behind ``q in coordinates``.

        Returns:
            Derivative, which is called with arrays. It is traced now, and needs no compiler.

        Raises:
            ValueError: The text is no such request, or names no function.
        """
        return Derivative(self, request)

    def rollout(self, q, v, tau, h, *, method="semi_implicit_euler", every=1, threads=None):
        """Steps states, with the torques of each step.

        >>> robot = articulated.bundled("panda_like")                          # doctest: +SKIP
        >>> ends = robot.rollout(q, v, torques, 0.001, threads=0)              # doctest: +SKIP
        >>> ends.q[..., -1, :]                                                 # doctest: +SKIP

        Args:
            q: Configurations, [..., nq].
            v: Velocities, [..., nv].
            tau: Torques, [..., steps, nv], N·m or N, held during each step. Dimensions of a batch broadcast.
            h: The length of a step, s.
            method: semi_implicit_euler, implicit_damping (MuJoCo's Euler), implicit_velocity (its implicitfast), lie_midpoint, rk4, or
                rk4_mujoco.
            every: Every so many steps are recorded.
            threads: None or 1 for one thread, 0 for all, or a number.

        Returns:
            Rollout: q, [..., steps // every, nq], and v, [..., steps // every, nv], after the steps.

        Raises:
            ValueError: Another method, shapes that do not fit, or numbers that are not finite.
        """
        return _rollout.rollout(self, q, v, None, tau, h, method, every, threads, _rollout.STEP)

    def rollout_gradient(self, q, v, tau, h, *, weights_q=None, weights_v=None, method="semi_implicit_euler", threads=None):
        """The gradient of a weighted sum of all states of a rollout, from the last step to the first.

        It keeps all states, (nq + nv) numbers a step, and needs no compiler: steps are differentiated exactly.

        Args:
            q, v, tau, h, method, threads: As for ``rollout``.
            weights_q: ∂cost/∂q after each step in the tangent space, [..., steps, nv]; None for zeros.
            weights_v: ∂cost/∂v after each step, [..., steps, nv]; None for zeros.

        Returns:
            RolloutGradient: by the start q (in the tangent space) and v, [..., nv], and by tau, [..., steps, nv].
        """
        weights = {"weights_q": weights_q, "weights_v": weights_v}
        return _rollout.gradient(self, q, v, None, tau, h, weights, method, threads, _rollout.STEP)

    def actuated_rollout(self, q, v, ctrl, h, *, act=None, method="implicit_velocity", every=1, threads=None):
        """Steps states of a robot with actuators (of an MJCF), with the controls of each step, as MuJoCo without contacts.

        >>> robot = articulated.load("model.xml")                              # doctest: +SKIP
        >>> ends = robot.actuated_rollout(q, v, controls, 0.002, threads=0)    # doctest: +SKIP
        >>> ends.q[..., -1, :]                                                 # doctest: +SKIP

        Args:
            q: Configurations, [..., nq].
            v: Velocities, [..., nv].
            ctrl: Controls, [..., steps, nu], of ``robot.actuators``, each in its own unit, held during each step.
                Dimensions of a batch broadcast.
            h: The length of a step, s.
            act: Activations of the actuators that have one, [..., na]; None for zeros.
            method: implicit_velocity (MuJoCo's implicitfast), implicit_damping (its Euler), semi_implicit_euler,
                lie_midpoint, rk4, or rk4_mujoco.
            every: Every so many steps are recorded.
            threads: None or 1 for one thread, 0 for all, or a number.

        Returns:
            ActuatedRollout: q, [..., steps // every, nq], v, [..., steps // every, nv], and act,
            [..., steps // every, na], after the steps.

        Raises:
            ValueError: Another method, a robot without actuators, shapes that do not fit, or numbers that are not finite.
        """
        return _rollout.rollout(self, q, v, act, ctrl, h, method, every, threads, _rollout.ACTUATED)

    def constrained_rollout(self, q, v, ctrl, h, *, act=None, method="implicit_damping", every=1, threads=None):
        """Steps states of a robot of an MJCF with actuators and all constraints, as MuJoCo.

        Limits, dry friction, equations and contacts act by MuJoCo's law.

        >>> robot = articulated.load("model.xml", effects="file")              # doctest: +SKIP
        >>> ends = robot.constrained_rollout(q, v, controls, 0.002, threads=0)  # doctest: +SKIP
        >>> ends.q[..., -1, :]                                                 # doctest: +SKIP

        Args:
            q, v, h, act, every, threads: As for ``actuated_rollout``.
            ctrl: Controls, [..., steps, nu]; of a robot without actuators [..., steps, 0].
            method: implicit_damping (MuJoCo's Euler), implicit_velocity (its implicitfast), semi_implicit_euler, or rk4_mujoco.

        Returns:
            ActuatedRollout: q, [..., steps // every, nq], v, [..., steps // every, nv], and act,
            [..., steps // every, na], after the steps.

        Raises:
            RobotError: A file without constraints, or with one that is not computed: ``load(…, leave_out=["contact"])`` goes on without
                it, with a warning.
            ValueError: Another method, shapes that do not fit, or numbers that are not finite.
        """
        return _rollout.rollout(self, q, v, act, ctrl, h, method, every, threads, _rollout.CONSTRAINED)

    def actuated_rollout_gradient(
        self, q, v, ctrl, h, *, act=None, weights_q=None, weights_v=None, weights_act=None, method="implicit_velocity", threads=None
    ):
        """The gradient of a weighted sum of all states of an ``actuated_rollout``, from the last step to the first.

        Args:
            q, v, ctrl, h, act, method, threads: As for ``actuated_rollout``.
            weights_q: ∂cost/∂q after each step in the tangent space, [..., steps, nv]; None for zeros.
            weights_v: ∂cost/∂v after each step, [..., steps, nv]; None for zeros.
            weights_act: ∂cost/∂act after each step, [..., steps, na]; None for zeros.

        Returns:
            ActuatedRolloutGradient: by the start q (in the tangent space) and v, [..., nv], by act, [..., na], and
            by ctrl, [..., steps, nu].
        """
        weights = {"weights_q": weights_q, "weights_v": weights_v, "weights_act": weights_act}
        return _rollout.gradient(self, q, v, act, ctrl, h, weights, method, threads, _rollout.ACTUATED)

    def contact_forces(self, q, v, ctrl=None, *, act=None):
        """What touches in states of a robot of an MJCF, with which forces, by MuJoCo's law.

        >>> found = robot.contact_forces(q, v)                   # doctest: +SKIP
        >>> found.force[found.acts].sum(axis=0)                  # doctest: +SKIP
        >>> [robot.contact_shapes[k] for k in np.flatnonzero(found.acts)]  # doctest: +SKIP

        Args:
            q: Coordinates, [..., nq]. v: Rates, [..., nv].
            ctrl: Controls, [..., nu]; None for zeros.
            act: Activations of the actuators that have one, [..., na]; None for zeros.

        Returns:
            ContactForces: for each place of ``contact_shapes`` whether it touches, acts [..., contacts], and point, m, normal,
            force, N, and moment about the point, N·m, [..., contacts, 3] in axes of the world; zeros where nothing touches.
            The normal is from the world to the body, or from the first body to the second; force and moment act on this body.
            relative_error [...]: no less than the error of the acceleration, over that without constraints, both in the norm of
            the mass matrix. search_steps [...]: steps of Newton's method.

        Raises:
            RobotError, ValueError: As ``constrained_rollout``.
        """
        return _rollout.contact_forces(self, q, v, act, ctrl)

    def constrained_step(self, q, v, ctrl, h, *, act=None, contacts=None, warm=None, method="implicit_damping"):
        """A step of states of a robot of an MJCF with all constraints, among them contacts that you found.

        >>> robot = articulated.load("model.xml", effects="file", given_contacts=[("floor", "gem", 4)])  # doctest: +SKIP
        >>> found = np.zeros((4, 8))                                                                  # doctest: +SKIP
        >>> found[0] = [1, -0.001, *point, 0, 0, 1]                                                   # doctest: +SKIP
        >>> after = robot.constrained_step(q, v, ctrl, 0.002, contacts=found)                         # doctest: +SKIP

        Args:
            q: Coordinates, [..., nq]. v: Rates, [..., nv].
            ctrl: Controls, [..., nu]; None for zeros.
            h: The length of the step, s.
            act: Activations of the actuators that have one, [..., na]; None for zeros.
            contacts: For each pair of ``given_contacts`` 1 or 0, the distance, m, the point, m, and the normal, in axes of the world,
                from the first geom of the pair to the second, [..., given, 8]; None: none touches.
            warm: Where the search begins: ``warm`` of the last step, [..., nv]; None for zeros.
            method: implicit_damping (MuJoCo's Euler), implicit_velocity (its implicitfast) or semi_implicit_euler; without given
                contacts also rk4_mujoco.

        Returns:
            ConstrainedStep: q [..., nq], v [..., nv], act [..., na] and warm [..., nv] after the step.

        Raises:
            RobotError, ValueError: As ``constrained_rollout``.
        """
        return _rollout.constrained_step(self, q, v, act, ctrl, h, contacts, warm, method)

    @property
    def given_contacts(self):
        """Names of the two geoms of each contact that ``constrained_step`` takes, (given, 2)."""
        return [tuple(names) for names in self._given_contacts()]

    @property
    def contact_shapes(self):
        """Names of the two geoms of each place where geoms of an MJCF may touch, (contacts, 2)."""
        return [tuple(names) for names in self._contact_shapes()]

    def constrained_rollout_gradient(
        self, q, v, ctrl, h, *, act=None, weights_q=None, weights_v=None, weights_act=None, method="implicit_damping", threads=None
    ):
        """The gradient of a weighted sum of all states of a ``constrained_rollout``, from the last step to the first.

        What touches in a step stays as it is: where a contact begins or ends, the gradient is that of one side.

        Args:
            q, v, ctrl, h, act, method, threads: As for ``constrained_rollout``.
            weights_q, weights_v, weights_act: As for ``actuated_rollout_gradient``.

        Returns:
            ActuatedRolloutGradient: by the start q (in the tangent space) and v, [..., nv], by act, [..., na], and
            by ctrl, [..., steps, nu].

        Raises:
            RobotError, ValueError: As ``constrained_rollout``.
        """
        weights = {"weights_q": weights_q, "weights_v": weights_v, "weights_act": weights_act}
        return _rollout.gradient(self, q, v, act, ctrl, h, weights, method, threads, _rollout.CONSTRAINED)

    def mujoco_state(self, q, v):
        """The state in MuJoCo's conventions: quaternions (w, x, y, z), and rates of free joints as the velocity in axes of
        the parent, then ω in axes of the body. Joints that follow others, and locked ones, have no coordinates here.

        Args:
            q: (..., nq). v: (..., nv).

        Returns:
            MujocoState: qpos (..., nq) and qvel (..., nv).
        """
        return _rollout.MujocoState(*_rollout.exchanged(self, "mujoco_state", {"q": q, "v": v}))

    def state_of_mujoco(self, qpos, qvel):
        """The state of MuJoCo's qpos and qvel, the inverse of ``mujoco_state``.

        Args:
            qpos: (..., nq). qvel: (..., nv).

        Returns:
            State: q (..., nq) and v (..., nv).
        """
        return _rollout.State(*_rollout.exchanged(self, "state_of_mujoco", {"qpos": qpos, "qvel": qvel}))

    def wheel(self, folder, functions=_wheel.FUNCTIONS, *, name=None, version="0.1.0", flags=(), batch=False):
        """Writes a wheel of this robot: a package of its functions that needs NumPy alone, neither
        articulated nor a compiler where it is installed.

        Args:
            folder: Where the wheel goes; made if it is not there.
            functions: Names of functions. The package has them under these names.
            name: The name of the package and of its module; None for the robot's.
            version: The version of the package.
            flags: More options of the C compiler. With -march=native the wheel needs such a processor.
            batch: Also compile code for many states at once, see ``compile``.

        Returns:
            The path of the wheel.

        Raises:
            RuntimeError: There is no C compiler, or it refuses the code.
        """
        rows = [_TABLE[index] for index in self._chosen("wheel", functions)]
        return _wheel.write(self, _path("folder", folder), rows, name, version, tuple(as_names("flags", flags)), bool(batch), _documentation)

    def _chosen(self, what, functions):
        chosen = list(dict.fromkeys(as_names("functions", functions)))
        for name in chosen:
            if name not in _INDEX:
                raise _unknown("functions", name, _INDEX, "functions of articulated.functions()")
        if not chosen:
            raise ValueError("functions: found none, expected at least one")
        if self.nv == 0:
            raise ValueError(f"{what}: found a robot without degrees of freedom, expected one that moves")
        return [_INDEX[name] for name in chosen]

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

        Rotations of a ball joint with a range are uniform among those within it.

        Args:
            rng: A numpy.random.Generator, or a seed for one, or None for any.
            size: None for one configuration, or their number N, or a tuple of dimensions.
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
                batch = () if size is None else tuple(size) if isinstance(size, (tuple, list)) else (size,)
                uniform = rng.random((*batch, self.nq))
            except (TypeError, ValueError) as error:
                raise type(error)(f"size: found {size!r} ({error}), expected None or a number of configurations") from None
        elif rng is not None or size is not None:
            raise TypeError("random_configuration: found uniform beside rng or size, expected one of them")
        return self._call(_INDEX["random_configuration"], (uniform,), threads)


def _remade(cls, source):
    return cls._made(source)


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
            "        out: An array for the result, of its shape and type; None for a new one.",
            "",
            "    Returns:",
            f"        {result}",
            "",
            f"    {function.source}.",
            "",
        ]
    )


def _text(function):
    """The signature and the documentation of a method, as the interpreter reads them."""
    given = "".join(f"{name}, " for name, _, _ in function.takes)
    return f"{function.name}($self, {given}*, threads=None, out=None)\n--\n\n{_documentation(function)}"


def _reader(function):
    given = "".join(f"{name}, " for name, _, _ in function.takes)
    scope = {}
    # The names are the table's; Python itself parses the keywords of a call, and refuses wrong
    # ones.
    exec(f"def {function.name}(self, {given}*, threads=None, out=None):\n    return ({given}), threads, out\n", scope)
    return scope[function.name]


_READERS = [_reader(function) for function in _TABLE]


def _read(index, given, named):
    """The arguments in order, and ``threads``; called where a call has keywords or another number of arguments."""
    return _READERS[index](None, *given, **named)


for _index, _function in enumerate(_TABLE):
    if not hasattr(Robot, _function.name):
        setattr(Robot, _function.name, _native.method(_index, _function.name, _text(_function)))


def _args(args):
    """Names and texts of the arguments of a file."""
    given = []
    for name, value in _pairs("args", args):
        if isinstance(value, bool):
            value = "true" if value else "false"
        elif isinstance(value, (int, float)):
            value = repr(value)
        elif not isinstance(value, str):
            raise TypeError(f"args[{name!r}]: found {type(value).__name__}, expected a str, a number or a bool")
        given.append((name, value))
    return tuple(given)


def _packages(packages):
    """Names and folders of packages."""
    return tuple((name, _path(f"packages[{name!r}]", folder)) for name, folder in _pairs("packages", packages))


def _pairs(what, given):
    if given is None:
        return ()
    if not hasattr(given, "items"):
        raise TypeError(f"{what}: found {type(given).__name__}, expected a dict")
    return tuple((_name(what, name), value) for name, value in given.items())


def _given(pairs):
    """Pairs of geoms with the number of their places."""
    found = []
    for pair in pairs:
        words = tuple(pair) if isinstance(pair, (tuple, list)) else ()
        places = words[2] if len(words) == 3 else 1
        fits = len(words) in (2, 3) and all(isinstance(word, str) for word in words[:2])
        if not fits or isinstance(places, bool) or not isinstance(places, (int, np.integer)) or places < 1:
            raise TypeError(f"given_contacts: found {pair!r}, expected two names of geoms, and in how many places they touch")
        found.append((*words[:2], int(places)))
    return tuple(found)


def _reading(leave_out, snap_angles, given_contacts, **allowed):
    """How to read a file: what is allowed, what is left out, the tolerance of snapped angles, and contacts of the caller."""
    for name, value in allowed.items():
        if not isinstance(value, (bool, np.bool_)):
            raise TypeError(f"{name}: found {type(value).__name__}, expected True or False")
    if snap_angles is not None and (isinstance(snap_angles, bool) or not isinstance(snap_angles, (int, float, np.integer, np.floating))):
        raise TypeError(f"snap_angles: found {type(snap_angles).__name__}, expected a number, rad, or None")
    kinds = tuple(sorted(set(as_names("leave_out", leave_out))))
    tolerance = None if snap_angles is None else float(snap_angles)
    return tuple(bool(value) for value in allowed.values()), kinds, tolerance, _given(given_contacts)


def _coupling(coupling):
    if coupling not in (None, "file"):
        raise ValueError(f'coupling: found {coupling!r}, expected "file" or None; Robot.couple lets one joint follow others')
    return coupling == "file", ()


def _effects(effects):
    if effects not in (None, "file"):
        raise ValueError(f'effects: found {effects!r}, expected "file" or None; a Scene has effects of its own')
    return effects == "file"


def _robot(file, document, base, gravity, frames, wrenches_in, includes, **given):
    if base not in ("fixed", "floating"):
        raise ValueError(f'base: found {base!r}, expected "fixed" or "floating"')
    gravity = None if gravity is None else _vector("gravity", gravity, "three finite numbers, m/s² in the world frame")
    frames = None if frames is None else tuple(as_names("frames", frames))
    source = _Source(file, document, base, gravity, includes, _reference(wrenches_in), frames)
    robot = Robot._made(source._replace(**given))
    for finding in robot._warnings:
        warnings.warn(RobotWarning(finding["message"], finding), stacklevel=3)
    return robot


def load(
    path,
    base="fixed",
    gravity=None,
    frames=None,
    wrenches_in="body",
    *,
    args=None,
    packages=None,
    coupling=None,
    effects=None,
    allow_unphysical_inertia=False,
    first_of_duplicates=False,
    leave_out=(),
    allow_unknown_version=False,
    snap_angles=None,
    given_contacts=(),
):
    """The robot of a file.

    Args:
        path: The file: URDF, xacro, MJCF or SDF.
        base: "fixed" if the root link does not move, "floating" if it has six degrees of freedom.
        gravity: (3,), m/s² in the world frame; None for that of the file, or else (0, 0, -9.81).
        frames: Names of the frames (links) to compute, in this order; None for all.
        wrenches_in: What external wrenches are given in, see ``Robot.with_wrenches_in``.
        args: Values of arguments that the file declares, such as ``{"side": "left"}`` for a
            ``<xacro:arg name="side"/>``: texts, numbers, True and False.
        packages: Folders of packages that the file includes files from, such as
            ``{"arm_description": "src/arm_description"}`` for ``$(find arm_description)``.
        coupling: "file" lets joints follow others as linear equations of the file say (MJCF).
        effects: "file" turns on the smooth effects of the file: damping, springs and armature of joints, compensated
            weight, the medium. As MuJoCo has them.
        allow_unphysical_inertia: True accepts negative principal moments, with a warning.
        first_of_duplicates: True takes the first of tags of a URDF or SDF that should be there once, with a warning.
        leave_out: Elements of an MJCF that change the motion and are not read, to leave out with a warning: any of
            "flex", "composite", "plugin", "constraint", "solver", "contact". Those of another kind are errors.
        allow_unknown_version: True reads a URDF of a version other than 1.0, 1.1 and 1.2 as 1.0, with a warning.
        snap_angles: Takes angles within so many rad of a multiple of π/2 as that multiple.
        given_contacts: Pairs of geoms of an MJCF whose contacts you find, for ``Robot.constrained_step``: two names, and in how many
            places they touch at most, 1 if left out, such as ``[("floor", "gem", 4)]``.

    Raises:
        RobotError: The file is not a robot; ``diagnostics`` lists all mistakes at once.

    Warns:
        RobotWarning: Something in the file looks wrong; the values are used as they are.
    """
    path = _path("path", path)
    reading = _reading(
        leave_out,
        snap_angles,
        given_contacts,
        allow_unphysical_inertia=allow_unphysical_inertia,
        first_of_duplicates=first_of_duplicates,
        allow_unknown_version=allow_unknown_version,
    )
    given = {"args": _args(args), "packages": _packages(packages), "reading": reading, "coupling": _coupling(coupling), "effects": _effects(effects)}
    return _robot(path, _native.read(path), base, gravity, frames, wrenches_in, True, **given)


def loads(
    text,
    name="robot.urdf",
    base="fixed",
    gravity=None,
    frames=None,
    wrenches_in="body",
    *,
    args=None,
    coupling=None,
    effects=None,
    allow_unphysical_inertia=False,
    first_of_duplicates=False,
    leave_out=(),
    allow_unknown_version=False,
    snap_angles=None,
    given_contacts=(),
):
    """The robot of a text, str or bytes, which includes no files; ``name`` is the name of its file in messages. See ``load``."""
    if isinstance(text, str):
        text = text.encode("utf-8", "surrogatepass")
    elif isinstance(text, (bytearray, memoryview)):
        text = bytes(text)
    if not isinstance(text, bytes):
        raise TypeError(f"text: found {type(text).__name__}, expected str or bytes")
    if not isinstance(name, str):
        raise TypeError(f"name: found {type(name).__name__}, expected str")
    reading = _reading(
        leave_out,
        snap_angles,
        given_contacts,
        allow_unphysical_inertia=allow_unphysical_inertia,
        first_of_duplicates=first_of_duplicates,
        allow_unknown_version=allow_unknown_version,
    )
    given = {"args": _args(args), "reading": reading, "coupling": _coupling(coupling), "effects": _effects(effects)}
    return _robot(name, text, base, gravity, frames, wrenches_in, False, **given)


def bundled(name, base=None, gravity=None, frames=None, wrenches_in="body"):
    """One of the robots that come with the package; ``bundled_names`` lists them. ``base``: None for its own."""
    robots = {robot: (urdf, own) for robot, urdf, own, _ in _native.bundled_robots()}
    if not isinstance(name, str) or name not in robots:
        raise _unknown("name", name, robots, "one of " + ", ".join(robots))
    urdf, own = robots[name]
    ending = "xml" if "<mujoco" in urdf else "urdf"
    return _robot(f"{name}.{ending}", urdf.encode(), own if base is None else base, gravity, frames, wrenches_in, False)


def bundled_names():
    """Names of the robots that come with the package, each with a line about it."""
    return {name: summary for name, _, _, summary in _native.bundled_robots()}
