#!/usr/bin/env python3
"""Solves optimal control problems by IPOPT with exact Hessians of generated C.

    python3 tests/ipopt/run.py

Runs the programs of examples/casadi, and the recipe "Discrete dynamics of an optimal control
problem" of docs/recipes.md. Checks steps, their Jacobians and Hessians against CasADi's automatic
differentiation of its own cart-pole, and against differences; the swing-up against the one with
that cart-pole; and the quadruped against placements and energies of tests/oracles. CasADi is
installed into <repository>/target/ipopt.
"""

import ctypes
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parent.parent
EXAMPLES = REPOSITORY / "examples" / "casadi"
sys.path[:0] = [str(EXAMPLES), str(HERE.parent / "oracles"), str(HERE.parent)]
from programs import TARGET, build_command  # noqa: E402
from virtual_environment import python_of  # noqa: E402

ROUNDING = 1e-12  # of the largest entry
BY_DIFFERENCES = 1e-7
RECIPE = "Discrete dynamics of an optimal control problem"
H = 0.05  # s, as in the recipe


def far(found, expected):
    """The largest difference, relative to the largest entry."""
    found, expected = (numpy.array(casadi.DM(x).full()) for x in (found, expected))
    assert found.shape == expected.shape, f"shape {found.shape}, expected {expected.shape}"
    return float(abs(found - expected).max() / abs(expected).max())


def expect(name, error, allowed):
    print(f"{name:<64}{error:9.1e}", flush=True)
    assert error <= allowed, f"{name}: found {error:.1e}, expected at most {allowed:.1e}"


def whole(step):
    """f, its Jacobian and the Hessian of λᵀf by z = (q, v, tau), as functions of z and λ."""
    z, weights = casadi.MX.sym("z", 6), casadi.MX.sym("weights", 4)
    after = casadi.vertcat(*step(z[:2], z[2:4], z[4:]))
    parts = [after, casadi.jacobian(after, z), casadi.hessian(casadi.dot(weights, after), z)[0]]
    return casadi.Function("whole", [z, weights], [casadi.densify(part) for part in parts])


def differences(function, z, weights, step=1e-5):
    """The Jacobian and the Hessian of λᵀf by central differences of values, and of λᵀ times the
    Jacobian.
    """
    jacobian, hessian = [], []
    for k in range(6):
        off = step * numpy.eye(6)[k]
        ahead, behind = function(z + off, weights), function(z - off, weights)
        jacobian.append((ahead[0] - behind[0]) / (2 * step))
        hessian.append((ahead[1] - behind[1]).T @ casadi.DM(weights) / (2 * step))
    return casadi.horzcat(*jacobian), casadi.horzcat(*hessian)


def recipe(folder):
    """The step of the recipe's library for CasADi, its functions of Python, and its function of C.
    """
    text = (REPOSITORY / "docs" / "recipes.md").read_text(encoding="utf-8")
    section = text.split(f"## {RECIPE}\n")[1].split("\n## ")[0]
    blocks = {kind: re.findall(rf"```{kind}\n(.*?)```", section, re.DOTALL) for kind in ("sh", "python", "c")}
    command = Path(folder, "articulated")
    command.symlink_to(Path(os.environ["ARTICULATED_COMMAND"]).resolve())
    environment = os.environ | {"PATH": f"{folder}{os.pathsep}{os.environ['PATH']}"}
    for block in blocks["sh"]:
        subprocess.run(["bash", "-euc", block], check=True, cwd=folder, env=environment)
    [python], [c] = blocks["python"], blocks["c"]
    names = {}
    before = os.getcwd()
    os.chdir(folder)
    try:
        exec(python, names)
    finally:
        os.chdir(before)
    plain = Path(folder, "plain_step")
    (plain / "discrete.c").write_text(c)
    flags = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror", "-O1", "-shared", "-fPIC"]
    subprocess.run(["cc", *flags, plain / "discrete.c", plain / "cart_pole.c", "-o", plain / "discrete.so", "-lm"], check=True)
    return names, ctypes.CDLL(str(plain / "discrete.so")).discrete


def plain(function, z, weights):
    """What the recipe's function of C gives, as `whole` has it."""
    numbers = lambda values: (ctypes.c_double * len(values))(*values)  # noqa: E731
    results = [numbers([0.0] * size) for size in (4, 24, 36)]
    function(numbers(z), numbers(weights), *results)
    return [numpy.array(result[:]).reshape(shape) for result, shape in zip(results, ((4, 1), (4, 6), (6, 6)))]


def check_step():
    """The step, its Jacobian and its Hessians, of CasADi's library and of plain C."""
    expected = whole(own.step(H))
    generator = numpy.random.default_rng(1)
    worst = {}
    with tempfile.TemporaryDirectory() as folder:
        names, discrete = recipe(folder)
        generated = whole(names["step"])
        for _ in range(10):
            z, weights = generator.uniform(-3, 3, 6), generator.uniform(-1, 1, 4)
            right, found, in_c = expected(z, weights), generated(z, weights), plain(discrete, z, weights)
            seen = {}
            for whose, parts in (("C for CasADi", found), ("plain C", in_c)):
                for what, x, y in zip(("value", "Jacobian", "Hessian"), parts, right):
                    seen[f"{what} of the step, {whose}"] = far(x, y)
            for what, x, y in zip(("Jacobian", "Hessian"), found[1:], differences(generated, z, weights)):
                seen[f"{what} from differences"] = far(y, x)
            x, u = z[:4], z[4]
            z[5] = 0.0
            right = expected(z, weights)
            after, a, b = names["dynamics"](x, u)
            seen["f, A and B of the recipe"] = max(far(after, right[0]), far(a, right[1][:, :4]), far(b, right[1][:, 4]))
            seen["Hessian of the recipe"] = far(names["curvature"](x, u, weights), right[2][:4, :4])
            for name, error in seen.items():
                worst[name] = max(worst.get(name, 0), error)
    for name, error in worst.items():
        expect(name, error, BY_DIFFERENCES if "differences" in name else ROUNDING)


def check_cart_pole():
    """The swing-up ends upright, obeys its own equations, and is that of the cart-pole of CasADi's
    expressions.
    """
    import cart_pole

    solutions, states, forces = cart_pole.main()
    exact, limited = solutions["exact"], solutions["limited memory"]
    assert exact.status == limited.status == "Solve_Succeeded"
    own_step = own.step(cart_pole.H)
    problem, parts = cart_pole.swing_up(own_step)
    reference = problem.solve()
    assert reference.status == "Solve_Succeeded"
    expect("swing-up: iterations with exact Hessians over others", exact.iterations / limited.iterations, 0.95)
    expect("swing-up: iterations, less those with CasADi's expressions", abs(exact.iterations - reference.iterations), 2)
    expect("swing-up: forces, from those with CasADi's expressions", far(forces, parts(reference.x)[1]), 1e-6)
    expect("swing-up: objective, from that of limited memory", abs(exact.objective / limited.objective - 1), 1e-7)
    now, gap = casadi.DM([0, casadi.pi, 0, 0]), 0.0
    for k in range(cart_pole.KNOTS):
        now = casadi.vertcat(*own_step(states[:2, k], states[2:, k], casadi.vertcat(forces[k], 0)))
        gap = max(gap, float(casadi.mmax(casadi.fabs(now - states[:, k + 1]))))
    expect("swing-up: residual of the dynamics", gap, 1e-8)
    expect("swing-up: distance from upright at rest", float(casadi.norm_2(now)), 1e-7)
    assert abs(forces).full().max() <= cart_pole.FORCE + 1e-6 and abs(states[0, :]).full().max() <= cart_pole.TRACK + 1e-6


def check_limits(reach, robot):
    """The limits that the example writes out are those of the robot's file."""
    assert [(joint.lower, joint.upper) for joint in robot.coordinates] == list(zip(reach.LOWER, reach.UPPER))


def virtual_work(judge, feet, q, force):
    """U(q) - Σ f·p(q), whose slope is the torques of the joints, and zero for the trunk. J."""
    rest = [0.0] * judge.nv
    places = judge.placements(list(q))
    return judge.inverse_dynamics(list(q), rest, rest)[2] - sum(float(force[:, k] @ places[foot][9:]) for k, foot in enumerate(feet[1:]))


def check_quadruped():
    """Feet are where they are meant to be, forces in their cones, torques those of the virtual
    work, and both Hessians find the same.
    """
    import quadruped_reach as reach
    import oracle
    import robot as urdf

    robot = urdf.read(REPOSITORY / "models" / "urdf" / "quadruped.urdf")
    check_limits(reach, robot)
    judge = oracle.Oracle(robot, True)
    names = list(robot.link_order())
    feet = [names.index(name) for name in reach.FEET]
    results = reach.main()
    worst = dict.fromkeys(["objective", "feet", "trunk", "torques", "cones", "limits"], 0.0)
    for target, (exact, limited), parts in results:
        assert exact.status == limited.status == "Solve_Succeeded", (target, exact.status, limited.status)
        q, force, torques = (numpy.array(part.full()) for part in parts)
        q, torques = q[:, 0], torques[:, 0]
        places = judge.placements(list(q))
        first = judge.placements([0, 0, 0, 0, 0, 0, 1, *reach.STANCE])
        moved = [numpy.array(places[foot][9:]) - numpy.array(first[foot][9:]) for foot in feet]
        height = first[feet[0]][11]
        moved = [move + [0, 0, height] for move in moved]
        slopes = []
        for k in range(19):
            off = 1e-6 * numpy.eye(19)[k]
            slopes.append((virtual_work(judge, feet, q + off, force) - virtual_work(judge, feet, q - off, force)) / 2e-6)
        errors = {
            "objective": abs(exact.objective / limited.objective - 1),
            "feet": max(abs(moved[0] - target).max(), *[abs(move).max() for move in moved[1:]]),
            "trunk": max(map(abs, slopes[:7])),
            "torques": abs(numpy.array(slopes[7:]) - torques[6:]).max(),
            "cones": max(0.0, *(numpy.hypot(force[0], force[1]) - reach.FRICTION * force[2])),
            "limits": max(0.0, *(q[7:] - reach.UPPER), *(reach.LOWER - q[7:]), abs(torques[6:]).max() - reach.TORQUE),
        }
        worst = {name: max(worst[name], error) for name, error in errors.items()}
    exact, limited = (sum(solutions[k].iterations for _, solutions, _ in results) for k in (0, 1))
    expect("quadruped: objective, from that of limited memory", worst["objective"], 1e-6)
    expect("quadruped: places of the feet, m", worst["feet"], 1e-7)
    expect("quadruped: what is left on the trunk, N and N·m", worst["trunk"], 1e-5)
    expect("quadruped: torques, from the slope of the virtual work, N·m", worst["torques"], 1e-5)
    expect("quadruped: beyond cones of friction, N", worst["cones"], 1e-4)
    expect("quadruped: beyond limits", worst["limits"], 1e-6)
    expect("quadruped: iterations with exact Hessians over others", exact / limited, 0.6)


def main():
    check_step()
    check_cart_pole()
    check_quadruped()
    print("1 passed, 0 failed")


if __name__ == "__main__":
    python = python_of(TARGET / "ipopt", EXAMPLES / "requirements.txt")
    if Path(sys.prefix).resolve() != python.parent.parent.resolve():
        # CasADi is there.
        sys.exit(subprocess.run([python, __file__, *sys.argv[1:]]).returncode)
    os.environ["ARTICULATED_COMMAND"] = str(build_command())
    import casadi
    import numpy
    import own

    main()
