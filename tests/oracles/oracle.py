"""Inverse dynamics from energies alone: Lagrange for the joints, Hamel for a free base. See README.md.

Nothing here passes forces from link to link. Placements are plain products of 4x4 matrices, velocities are their
derivatives in time, and the torques are what the kinetic energy T and the potential energy U imply.
"""

from decimal import Decimal

import casadi
import numpy
from casadi import SX, gradient, jtimes, substitute, vertcat

import digits

GRAVITY = [0.0, 0.0, -9.81]


class Constants:
    """Constants of a robot stay symbols, or CasADi would multiply them out in double precision before any other."""

    def __init__(self):
        self.symbols, self.values = [], []

    def __call__(self, value):
        value = Decimal(value)
        if value in (-1, 0, 1):
            return SX(int(value))
        self.symbols.append(SX.sym(f"k{len(self.values)}"))
        self.values.append(value)
        return self.symbols[-1]

    def matrix(self, rows):
        return casadi.vertcat(*[casadi.horzcat(*[self(value) for value in row]) for row in rows])

    def vector(self, values):
        return vertcat(*[self(value) for value in values])


def homogeneous(rotation, position):
    return casadi.vertcat(casadi.horzcat(rotation, position), SX([[0, 0, 0, 1]]))


def hat(twist):
    """The 4x4 matrix of a twist [w; v]: d/dt H = H hat(twist) for a body twist."""
    return casadi.vertcat(casadi.horzcat(casadi.skew(twist[:3]), twist[3:]), SX(1, 4))


def vee(matrix):
    """w of the antisymmetric part of a 3x3 matrix."""
    return vertcat(matrix[2, 1] - matrix[1, 2], matrix[0, 2] - matrix[2, 0], matrix[1, 0] - matrix[0, 1]) / 2


def length(vector):
    return casadi.sqrt(casadi.sumsqr(vector))


def joint_motion(kind, axis, q):
    if kind == "prismatic":
        return homogeneous(SX.eye(3), axis * q)
    # Rodrigues: R = 1 + sin q [u] + (1 - cos q) [u]^2
    cross = casadi.skew(axis)
    return homogeneous(SX.eye(3) + casadi.sin(q) * cross + (1 - casadi.cos(q)) * (cross @ cross), SX(3, 1))


def rotation_of_quaternion(quaternion):
    x, y, z, w = casadi.vertsplit(quaternion)
    s = 2 / (x * x + y * y + z * z + w * w)  # a quaternion of doubles is of length 1 only nearly
    return casadi.vertcat(
        casadi.horzcat(1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)),
        casadi.horzcat(s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w)),
        casadi.horzcat(s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)),
    )


def placements_in_base(robot, constants, q):
    """H_i of every link in the root link's frame, with followers already put in terms of their leaders."""
    placement = {robot.root: SX.eye(4)}
    for joint in robot.visits:
        offset = homogeneous(constants.matrix(joint.rotation), constants.vector(joint.xyz))
        step = offset
        if joint.kind != "fixed":
            index, multiplier, shift = robot.follows[joint.name]
            own = constants(multiplier) * q[index] + constants(shift)
            step = offset @ joint_motion(joint.kind, constants.vector(joint.axis), own)
        placement[joint.child] = placement[joint.parent] @ step
    return placement


class Oracle:
    """Functions of (q, v, a, gravity) for one robot, in double precision and with 60 digits.

    q: fixed base [n]; floating base [position 3, quaternion x y z w, n].
    v: fixed base [n]; floating base [body twist: angular 3, linear 3; n]. a: d/dt of the numbers in v.
    """

    def __init__(self, robot, floating=False):
        self.robot, self.floating = robot, floating
        n, free = len(robot.coordinates), 6 if floating else 0
        self.nq, self.nv = n + (7 if floating else 0), n + free
        state, v, a, gravity = SX.sym("q", self.nq), SX.sym("v", self.nv), SX.sym("a", self.nv), SX.sym("g", 3)
        q, rate, acceleration = state[self.nq - n :], v[free:], a[free:]
        constants = Constants()
        links = [robot.links[name] for name in robot.link_order()]
        placement = placements_in_base(robot, constants, q)
        base = homogeneous(rotation_of_quaternion(state[3:7]), state[:3]) if floating else SX.eye(4)
        twist, small, drift = (v[:6] if floating else SX(6, 1)), SX.sym("xi", 6), SX.sym("drift", 6)
        base = base @ (SX.eye(4) + hat(drift))  # derivatives with respect to the pose of a free base; 0 otherwise

        # dH_i/dt in the axes of the base: hat(twist) H_i + (dH_i/dq) q'
        stacked = casadi.horzcat(*[placement[link.name] for link in links])
        stacked_rate = casadi.horzsplit(jtimes(stacked, q, rate) + hat(twist) @ stacked, 4)

        moving = robot.moving_links(floating)
        kinetic, potential, motions = SX(0), SX(0), {}
        for link, placement_rate in zip(links, stacked_rate):
            if link.name not in moving:
                continue
            here, com = placement[link.name], vertcat(constants.vector(link.com), 1)
            mass, inertia = constants(link.mass), constants.matrix(link.inertia)
            velocity = (placement_rate @ com)[:3]
            omega = vee(here[:3, :3].T @ placement_rate[:3, :3])  # [w] = R^T dR/dt, in link axes
            # T = 1/2 m |c'|^2 + 1/2 w^T I w
            kinetic += (mass * casadi.dot(velocity, velocity) + casadi.dot(omega, inertia @ omega)) / 2
            # U = -m g.c, after a small motion xi of the base on the right
            where = (base @ (SX.eye(4) + hat(small)) @ here @ com)[:3]
            potential -= mass * casadi.dot(gravity, where)
            motions[link.name] = (com, mass, inertia, velocity, omega)

        def at_rest(expression):
            """The value at xi = 0."""
            return substitute(expression, small, SX.zeros(6))

        def settled(expression):
            """The value at drift = 0."""
            return substitute(expression, drift, SX.zeros(6))

        def in_time(expression):
            """d/dt of something that depends on q and v, along q' and a."""
            return jtimes(expression, vertcat(q, v), vertcat(rate, a))

        momentum = gradient(kinetic, v)
        momentum_rate = in_time(momentum)
        # joints: tau = d/dt dT/dq' - dT/dq + dU/dq
        tau = momentum_rate[free:] - gradient(kinetic, q) + at_rest(gradient(potential, q))
        slope = at_rest(gradient(potential, small))
        if floating:
            turn, push, w, u = momentum[:3], momentum[3:6], v[:3], v[3:6]
            # m = d/dt dT/dw + w x dT/dw + u x dT/du + dU/d(turn)
            # f = d/dt dT/du + w x dT/du             + dU/d(shift)
            moment = momentum_rate[:3] + casadi.cross(w, turn) + casadi.cross(u, push) + slope[:3]
            force = momentum_rate[3:6] + casadi.cross(w, push) + slope[3:]
            tau = vertcat(moment, force, tau)
        potential_rate = casadi.dot(at_rest(gradient(potential, q)), rate) + casadi.dot(slope, twist)
        # the power of the torques is the rate of the energies: v.tau - d/dt (T + U) = 0
        imbalance = casadi.dot(v, tau) - in_time(kinetic) - potential_rate

        loads = {
            name: (
                (placement[name] @ com)[:3],
                mass * (length(in_time(velocity)) + length(gravity)),
                length(inertia @ in_time(omega)) + length(casadi.cross(omega, inertia @ omega)),
            )
            for name, (com, mass, inertia, velocity, omega) in motions.items()
        }
        scale = torque_scales(robot, floating, placement, loads)

        known = vertcat(*constants.symbols) if constants.symbols else SX(0, 1)
        inputs = [known, state, v, a, gravity]
        self.constants = constants.values
        poses = [settled(base @ placement[link.name]) for link in links]
        outputs = [settled(x) for x in (tau, kinetic, at_rest(potential), imbalance)]
        self._dynamics = casadi.Function("dynamics", inputs, outputs, {"cse": True})
        self._kinematics = casadi.Function("kinematics", inputs[:2], [casadi.horzcat(*poses)], {"cse": True})
        self._scale = casadi.Function("torque_scale", inputs, [scale], {"cse": True})
        self._exact = {}
        turn = base[:3, :3]
        self._parts = {
            "inputs": inputs, "tau": tau, "settled": settled, "in_time": in_time, "omega": twist[:3], "turn": turn, "origin": base[:3, 3],
            "tangent": (drift, q), "masses": [(mass, (placement[name] @ com)[:3], velocity, placement[name][:3, :3] @ inertia @ omega)
                                              for name, (com, mass, inertia, velocity, omega) in motions.items()],
        }

    def inverse_dynamics(self, q, v, a, gravity=GRAVITY):
        """(tau, T, U, power imbalance) in double precision."""
        tau, *rest = self._dynamics(self._doubles(), q, v, a, gravity)
        return (numpy.array(tau).ravel(), *[float(value) for value in rest])

    def exact_inverse_dynamics(self, q, v, a, gravity=GRAVITY):
        """The same with 60 digits: lists of Decimals."""
        tau, *rest = self._exactly(self._dynamics, q, v, a, gravity)
        return (tau, *[value[0] for value in rest])

    def torque_scale(self, q, v, a, gravity=GRAVITY):
        """Per torque the sum of the sizes of what makes it up: the yardstick of its error."""
        return numpy.array(self._scale(self._doubles(), q, v, a, gravity)).ravel()

    def placements(self, q):
        """Per link nine entries of R by rows, then three of p; in double precision."""
        return per_link([float(x) for x in numpy.array(self._kinematics(self._doubles(), q)).ravel(order="F")])

    def exact_placements(self, q):
        return per_link(self._exactly(self._kinematics, q)[0])

    def _doubles(self):
        return [float(value) for value in self.constants]

    def _exactly(self, function, *inputs):
        if function.name() not in self._exact:
            self._exact[function.name()] = digits.Program(function)
        exact = lambda number: number if isinstance(number, Decimal) else Decimal(float(number))
        decimals = [[exact(number) for number in numbers] for numbers in inputs]
        return self._exact[function.name()](self.constants, *decimals)


def torque_scales(robot, floating, placement, loads):
    """Per torque: sum over the links b that it carries of |c_b - o| m (|c_b''| + |g|) + |I w'| + |w x I w|

    o: origin of the joint's frame; a prismatic joint and the linear part of a free base count the force alone. This is
    the torque as it would be with all its terms parallel and of one sign.
    """
    free = 6 if floating else 0
    scale = SX.zeros(free + len(robot.coordinates))
    above = {joint.child: joint for joint in robot.visits}
    for name, (com, force, moment) in loads.items():
        if floating:
            scale[:3] += length(com) * force + moment
            scale[3:6] += force
        joint = above.get(name)
        while joint:
            if joint.kind != "fixed":
                index, multiplier, _ = robot.follows[joint.name]
                reach = length(com - placement[joint.child][:3, 3])
                load = force if joint.kind == "prismatic" else reach * force + moment
                scale[free + index] += float(abs(multiplier)) * load
            joint = above.get(joint.parent)
    return scale


def per_link(columns):
    """4x4 matrices side by side, by columns, to [R by rows, p] each."""
    rows = []
    for start in range(0, len(columns), 16):
        entry = lambda i, j: columns[start + 4 * j + i]
        rows.append([entry(i, j) for i in range(3) for j in range(3)] + [entry(i, 3) for i in range(3)])
    return rows
