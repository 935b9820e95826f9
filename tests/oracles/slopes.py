"""What follows from the oracle's torques and energies by one more derivative, and from Newton's and Euler's laws for the whole robot.

    M = dtau/da        dtau/dq in the tangent space: joints by their coordinates, a free base H_0 by H_0 (1 + [xi])
    a = M^-1 (tau - h)        da/dq = -M^-1 dtau/dq, at that a

By CasADi's own Jacobians, evaluated with 60 digits; M is inverted with 60 digits too.
"""

from decimal import Decimal

import casadi
from casadi import jacobian, vertcat

import digits
from oracle import GRAVITY


class Slopes:
    """The registry's functions, by name, for the robot of an oracle."""

    def __init__(self, oracle):
        self.oracle, part = oracle, oracle._parts
        known, state, v, a, gravity = inputs = part["inputs"]
        settled, tau = part["settled"], part["tau"]
        drift, q = part["tangent"]
        tangent = vertcat(drift, q) if oracle.floating else q
        slopes = [settled(jacobian(tau, x)) for x in (tangent, v, a)]
        totals = [settled(x) for x in whole(part, v)]
        self._slopes = casadi.Function("slopes", inputs, slopes, {"cse": True})
        self._totals = casadi.Function("totals", inputs, totals, {"cse": True})

    def _matrices(self, function, *inputs):
        """Outputs as lists of rows of Decimals."""
        flat = self.oracle._exactly(function, *inputs, GRAVITY)
        shapes = [function.sparsity_out(i).shape for i in range(function.n_out())]
        return [[[values[j * rows + i] for j in range(columns)] for i in range(rows)] for values, (rows, columns) in zip(flat, shapes)]

    def results(self, q, v, a, tau):
        """name -> rows, or rows of rows."""
        zero = [0.0] * self.oracle.nv
        torque = lambda v, a: self.oracle.exact_inverse_dynamics(q, v, a)[0]
        bias, (kinetic, potential) = torque(v, zero), self.oracle.exact_inverse_dynamics(q, v, a)[1:3]
        straight = self._matrices(self._slopes, q, v, a)
        inverse = inverted(straight[2])
        acceleration = times(inverse, [[Decimal(t) - h] for t, h in zip(tau, bias)])
        there = self._matrices(self._slopes, q, v, [x for (x,) in acceleration])
        names = ["center_of_mass", "center_of_mass_velocity", "center_of_mass_acceleration", "center_of_mass_jacobian", "centroidal_momentum",
                 "centroidal_momentum_matrix", "centroidal_momentum_rate"]
        out = dict(zip(names, self._matrices(self._totals, q, v, a)))
        out |= {
            "inverse_dynamics": [torque(v, a)], "bias_forces": [bias], "gravity_torque": [torque(zero, zero)],
            "kinetic_energy": [[kinetic]], "potential_energy": [[potential]],
            "mass_matrix": straight[2], "mass_matrix_inverse": inverse, "solve_mass_matrix": times(inverse, [[Decimal(t)] for t in tau]),
            "forward_dynamics": acceleration, "inverse_dynamics_derivatives": [row for matrix in straight for row in matrix],
            "forward_dynamics_derivatives": [[-x for x in row] for d in there[:2] for row in times(inverse, d)] + inverse,
        }
        if not self.oracle.floating:
            # Christoffel symbols are symmetric in the two rates: C = (dtau/dv) / 2, where v are rates of coordinates.
            out["coriolis_matrix"] = [[x / 2 for x in row] for row in straight[1]]
        return out


def whole(part, v):
    """Of the moving links, in world axes: centre of mass, its velocity and acceleration, its Jacobian; momentum about it, its matrix, its
    rate."""
    turn, omega, in_time = part["turn"], part["omega"], part["in_time"]
    total = sum(mass for mass, *_ in part["masses"])
    centre = sum(mass * place for mass, place, *_ in part["masses"]) / total
    force = sum(mass * velocity for mass, _, velocity, _ in part["masses"])
    # about the centre: sum m (c - C) x c' + I w, all in axes of the root link
    moment = sum(mass * casadi.cross(place - centre, velocity) + spin for mass, place, velocity, spin in part["masses"])
    momentum = vertcat(turn @ moment, turn @ force)
    rate = lambda x: turn @ (casadi.cross(omega, x) + in_time(x))  # axes that turn
    velocity = turn @ force / total
    return [
        part["origin"] + turn @ centre, velocity, rate(force) / total, jacobian(velocity, v), momentum, jacobian(momentum, v),
        vertcat(rate(moment), rate(force)),
    ]


def times(a, b):
    with digits.precise():
        columns = list(zip(*b))
        return [[sum(x * y for x, y in zip(row, column)) for column in columns] for row in a]


def inverted(matrix):
    """Gauss and Jordan, with the largest pivot of the column."""
    n = len(matrix)
    with digits.precise():
        rows = [list(row) + [Decimal(int(i == j)) for j in range(n)] for i, row in enumerate(matrix)]
        for k in range(n):
            best = max(range(k, n), key=lambda i: abs(rows[i][k]))
            rows[k], rows[best] = rows[best], rows[k]
            rows[k] = [x / rows[k][k] for x in rows[k]]
            for i in range(n):
                if i != k and rows[i][k]:
                    rows[i] = [x - rows[i][k] * y for x, y in zip(rows[i], rows[k])]
        return [row[n:] for row in rows]
