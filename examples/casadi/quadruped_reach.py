#!/usr/bin/env python3
"""A quadruped on three feet reaches out with its fourth and stands still, by IPOPT.

    python3 examples/casadi/quadruped_reach.py

The torques are the least. Unknowns are the configuration and the forces of the ground on three feet.
These feet stay where they are. Forces are within their cones of friction, joints and torques are
within their limits, and no force is left on the trunk, which floats.

The functions are `placements` and `static_torque` of generated C. Derivatives are by the seven
numbers of the trunk's position and quaternion. A constraint keeps the quaternion's length at one.
"""

import tempfile

from generated import HEADING, Problem, casadi, library

FEET = ["front_left_foot", "front_right_foot", "hind_left_foot", "hind_right_foot"]
STANCE = [0.0, 0.7, -1.4] * 2 + [0.0, -0.7, 1.4] * 2  # rad
# Limits of the robot's file: rad, and N·m of each joint.
LOWER = [-0.6, -0.9, -2.45, -1.2, -0.9, -2.45, -0.6, -1.2, 0.35, -1.2, -1.2, 0.35]
UPPER = [1.2, 1.2, -0.35, 0.6, 1.2, -0.35, 1.2, 0.9, 2.45, 0.6, 0.9, 2.45]
TORQUE = 150.0
FRICTION = 0.6
LEAST = 10.0  # N, that each foot presses on the ground
UNIT = 100.0  # N or N·m, so that unknowns and constraints are near 1
TARGETS = [(0.0, 0.0, 0.02), (0.1, 0.0, 0.1), (0.2, 0.05, 0.2), (0.3, 0.1, 0.3), (0.35, 0.2, 0.5), (0.5, 0.0, 0.5)]  # m from the foot's place


def standing(placements):
    """The configuration in which all feet are on the ground (z = 0), and where they are: [3][4], m.
    """
    q = casadi.DM([0, 0, 0, 0, 0, 0, 1] + STANCE)
    q[2] = -placements(q)[0, 11]
    return q, placements(q)[:, 9:].T


def reach(placements, static_torque, target):
    """The problem, and functions of its solution: q [19], forces on three feet [3][3] (N, columns),
    torques [18] (N·m).

    `placements(q)`: [4][12], of the feet. `static_torque(q, wrenches)`: [18], wrenches [m; f] on
    the feet in axes of the world. `target`: where the first foot goes to from its place, m.
    """
    first, feet = standing(placements)
    problem = Problem()
    free = [casadi.inf] * 7
    q = problem.variable("q", 19, start=first, lower=[-x for x in free] + LOWER, upper=free + UPPER)
    force = problem.variable("force", 3, 3, start=[0, 0, 90.0 * 9.81 / 3 / UNIT], lower=[-casadi.inf, -casadi.inf, LEAST / UNIT])
    nothing = casadi.MX.zeros(3)
    wrenches = casadi.vertcat(nothing, nothing, *[casadi.vertcat(nothing, UNIT * force[:, k]) for k in range(3)])
    torques = static_torque(q, wrenches)
    places = placements(q)[:, 9:].T

    problem.constrain(casadi.sumsqr(q[3:7]), 1, 1)
    problem.constrain(places[:, 1:] - feet[:, 1:])
    problem.constrain(places[:, 0] - (feet[:, 0] + casadi.DM(target)))
    problem.constrain(torques[:6] / UNIT)
    problem.constrain(torques[6:] / UNIT, -TORQUE / UNIT, TORQUE / UNIT)
    problem.constrain((FRICTION * force[2, :]) ** 2 - force[0, :] ** 2 - force[1, :] ** 2, 0, casadi.inf)
    problem.cost = casadi.sumsqr(torques[6:] / UNIT) + 0.1 * casadi.sumsqr(q[7:] - first[7:])
    return problem, casadi.Function("parts", [casadi.vertcat(*problem.x)], [q, UNIT * force, torques])


def main():
    with tempfile.TemporaryDirectory() as folder:
        shared = library(folder, "quadruped", ["placements", "static_torque"], "--frames", ",".join(FEET), "--wrenches-in", "world_aligned")
        placements, static_torque = (casadi.external(name, shared) for name in ("placements", "static_torque"))
        print(f"{'target, m':<20}{'Hessian':<16}{HEADING}  largest torque, N·m")
        results = []
        for target in TARGETS:
            problem, parts = reach(placements, static_torque, target)
            solutions = [problem.solve(exact) for exact in (True, False)]
            for name, solution in zip(("exact", "limited memory"), solutions):
                largest = float(casadi.mmax(casadi.fabs(parts(solution.x)[2])))
                print(f"{', '.join(map(str, target)):<20}{name:<16}{solution.row():<52}{largest:8.1f}")
            results.append((target, solutions, parts(solutions[0].x)))
    exact, limited = (sum(solutions[k].iterations for _, solutions, _ in results) for k in (0, 1))
    print(f"all targets: {exact} iterations with exact Hessians, {limited} with limited memory")
    return results


if __name__ == "__main__":
    main()
