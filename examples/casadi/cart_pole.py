#!/usr/bin/env python3
"""A cart swings its pole up in two seconds with the least force, by IPOPT.

    python3 examples/casadi/cart_pole.py

Multiple shooting over 40 steps. The step x⁺ = f(x, u) is one call of generated C: `step_rk4` of
50 ms, with its Jacobian (A, B) and the Hessian of λᵀf.
"""

import tempfile

from generated import HEADING, Problem, casadi, library

KNOTS, H = 40, 0.05  # s
HANGING, STANDING = [0.0, casadi.pi], [0.0, 0.0]  # m and rad; the pole stands up at 0
TRACK, FORCE = 2.4, 10.0  # m and N, limits of the robot's file


def swing_up(step):
    """The problem, and functions of its solution x: states [4][KNOTS + 1] (m, rad, m/s, rad/s) and
    forces [1][KNOTS] (N).

    `step(q, v, tau)` returns q and v after H seconds.
    """
    problem = Problem()
    first, last = casadi.DM(HANGING + [0, 0]), casadi.DM(STANDING + [0, 0])
    guess = casadi.horzcat(*[first + (last - first) * k / KNOTS for k in range(KNOTS + 1)])
    x = problem.variable("x", 4, KNOTS + 1, start=guess, lower=[-TRACK] + [-casadi.inf] * 3, upper=[TRACK] + [casadi.inf] * 3)
    u = problem.variable("u", 1, KNOTS, start=0.0, lower=-FORCE, upper=FORCE)
    problem.constrain(x[:, 0] - first)
    for k in range(KNOTS):
        q, v = step(x[:2, k], x[2:, k], casadi.vertcat(u[k], 0))  # no motor turns the pole
        problem.constrain(x[:, k + 1] - casadi.vertcat(q, v))
        problem.cost += H * u[k] ** 2
    problem.constrain(x[:, KNOTS] - last)
    return problem, casadi.Function("parts", [casadi.vertcat(*problem.x)], [x, u])


def main():
    with tempfile.TemporaryDirectory() as folder:
        step = casadi.external("step", library(folder, "cart_pole", [f"step = step_rk4(h = {H})"]))
        problem, parts = swing_up(step)
        print(f"{'Hessian':<16}{HEADING}")
        solutions = {}
        for name, exact in [("exact", True), ("limited memory", False)]:
            solutions[name] = problem.solve(exact)
            print(f"{name:<16}{solutions[name].row()}")
        states, forces = parts(solutions["exact"].x)
    print(f"\n{'s':>5}{'cart, m':>10}{'pole, rad':>12}{'force, N':>11}")
    for k in range(0, KNOTS, 5):
        print(f"{k * H:5.2f}{float(states[0, k]):10.3f}{float(states[1, k]):12.3f}{float(forces[k]):11.3f}")
    return solutions, states, forces


if __name__ == "__main__":
    main()
