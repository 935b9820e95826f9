#!/usr/bin/env python3
"""Loads generated C by casadi.external, and solves the same motion with it and with CasADi's own expressions.

    python3 tests/oracles/external.py [COMMAND]     COMMAND: the articulated command; built if absent

Checks, for the bundled six-axis arm: values of every function against CasADi's own recursion, Jacobians against those of CasADi's automatic
differentiation, second derivatives likewise, sparsity against structural zeros, a function whose arguments are left out, and the solution of a reach
by IPOPT, with the Gauss-Newton Hessian and with the exact one. For the bundled quadruped: derivatives by the numbers of q against differences, and a
motion in free flight by IPOPT with exact Hessians. Prints the time of an iteration. Makes a virtual environment with CasADi in <repository>/.venv where CasADi is missing.
"""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parent.parent
sys.path[:0] = [str(HERE), str(HERE.parent / "peers"), str(HERE.parent)]
from programs import build_command  # noqa: E402

ROBOT = "ur5_like"
FUNCTIONS = ["inverse_dynamics", "forward_dynamics", "mass_matrix", "placements"]
LEGGED, LEGGED_FUNCTIONS = "quadruped", ["inverse_dynamics", "integrate"]
TOLERANCE = 1e-10
BY_DIFFERENCES = 1e-6  # central differences with steps of 1e-6
SAME_SOLUTION = 1e-8  # of the torques, relative to the largest
STEPS, SECONDS = 20, 1.0
TORQUE = 50.0  # N m that weigh as much as an acceleration of 1 rad/s^2
START, END = [0.0, -1.2, 1.0, 0.3, 0.2, 0.0], [0.8, -0.6, 0.4, -0.4, 0.6, 0.5]  # rad


def library(command, folder, robot, functions):
    """The path of the shared library of a robot, with second derivatives."""
    words = [*command, "generate", robot, "--language", "c", "--abi", "casadi", "--derivatives", "2", "--functions", ",".join(functions), "-o", str(folder)]
    subprocess.run(words, check=True, cwd=REPOSITORY)
    shared = folder / "robot.so"
    flags = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror", "-O2", "-shared", "-fPIC"]
    subprocess.run(["cc", *flags, str(folder / f"{robot}.c"), "-o", str(shared), "-lm"], check=True)
    return str(shared)


def far(found, expected):
    """The largest difference, relative to the largest entry."""
    import numpy

    found, expected = (numpy.array(casadi.DM(x).full()) for x in (found, expected))
    assert found.shape == expected.shape, f"shape {found.shape}, expected {expected.shape}"
    return float(abs(found - expected).max() / max(abs(expected).max(), 1e-300))


def values(shared, own, generator):
    """The largest differences of values and of Jacobians over states at random."""
    worst = {}
    for name in ("inverse_dynamics", "forward_dynamics", "mass_matrix"):
        ours = casadi.external(name, shared)
        theirs = own[name]
        assert ours.n_in() == theirs.n_in() and ours.name_in(0) == "q", name
        assert ours.size_out(0) == theirs.size_out(0), name
        jacobians = [f.jacobian() for f in (ours, theirs)] if name != "mass_matrix" else []
        for _ in range(10):
            state = [generator.uniform(-2, 2, theirs.numel_in(k)) for k in range(theirs.n_in())]
            at = ours(*state)
            worst[name] = max(worst.get(name, 0), far(at, theirs(*state)))
            if jacobians:
                pairs = zip(*[f.call([*state, at]) for f in jacobians])
                worst[f"jac_{name}"] = max(worst.get(f"jac_{name}", 0), *[far(x, y) for x, y in pairs])
    return worst


def curvature(function, sizes):
    """The Hessian of λᵀF by all arguments, as a function of the arguments and λ."""
    x, weights = casadi.MX.sym("x", sum(sizes)), casadi.MX.sym("weights", function.numel_out(0))
    ends = [sum(sizes[:k]) for k in range(len(sizes) + 1)]
    parts = [x[a:b] for a, b in zip(ends, ends[1:])]
    hessian, gradient = casadi.hessian(casadi.dot(weights, casadi.vec(function(*parts))), x)
    return casadi.Function("curvature", [x, weights], [hessian, gradient])


def second_derivatives(shared, own, generator):
    """The largest differences of Hessians of weighted results from those of CasADi's automatic differentiation."""
    worst = {}
    for name in ("inverse_dynamics", "forward_dynamics"):
        ours, theirs = casadi.external(name, shared), own[name]
        sizes = [theirs.numel_in(k) for k in range(theirs.n_in())]
        both = [curvature(f, sizes) for f in (ours, theirs)]
        for _ in range(5):
            x, weights = generator.uniform(-2, 2, sum(sizes)), generator.uniform(-1, 1, theirs.numel_out(0))
            for what, found, expected in zip(("hess", "adj"), *[f(x, weights) for f in both]):
                worst[f"{what}_{name}"] = max(worst.get(f"{what}_{name}", 0), far(found, expected))
    return worst


def by_differences(shared, generator):
    """The largest differences of first and second derivatives of a floating robot from central differences of values and gradients."""
    import numpy

    worst, step = {}, 1e-6
    for name in LEGGED_FUNCTIONS:
        function = casadi.external(name, shared)
        sizes = [function.numel_in(k) for k in range(function.n_in())]
        both = curvature(function, sizes)
        x, weights = generator.uniform(-1, 1, sum(sizes)), generator.uniform(-1, 1, function.numel_out(0))
        x[3:7] /= numpy.linalg.norm(x[3:7])
        parts = lambda x: numpy.split(x, numpy.cumsum(sizes)[:-1])  # noqa: E731
        value = lambda x: float(casadi.dot(weights, casadi.vec(function(*parts(x)))))  # noqa: E731
        hessian, gradient = both(x, weights)
        slopes, rows = numpy.zeros(len(x)), numpy.zeros((len(x), len(x)))
        for k in range(len(x)):
            off = numpy.zeros(len(x))
            off[k] = step
            slopes[k] = (value(x + off) - value(x - off)) / (2 * step)
            rows[k] = (both(x + off, weights)[1] - both(x - off, weights)[1]).full()[:, 0] / (2 * step)
        jacobian = casadi.horzcat(*function.jacobian()(*parts(x), 0))
        worst[f"adj_{name}"] = far(gradient, slopes[:, None])
        worst[f"jac_{name}"] = far(jacobian.T @ casadi.DM(weights), slopes[:, None])
        worst[f"hess_{name}"] = far(hessian, rows)
    return worst


def flight(shared, knots=6, seconds=0.3):
    """A quadruped in free flight draws its legs in with the least torque, by IPOPT with exact Hessians: the wrench on its trunk is zero.

    Iterations, seconds, and the largest wrench that is left, N m or N.
    """
    dynamics, integrate = casadi.external("inverse_dynamics", shared), casadi.external("integrate", shared)
    nq, nv, h = dynamics.numel_in(0), dynamics.numel_in(1), seconds / knots
    q, v = casadi.MX.sym("q", nq, knots + 1), casadi.MX.sym("v", nv, knots + 1)
    first = casadi.DM([0, 0, 1, 0, 0, 0, 1] + [0.0, 0.7, -1.4] * 4)
    drawn = casadi.DM([0.1, 1.1, -2.0] * 4)
    zero, cost = [q[:, 0] - first, q[7:, knots] - drawn], 0
    for k in range(knots):
        tau = dynamics(q[:, k], v[:, k], (v[:, k + 1] - v[:, k]) / h)
        zero += [q[:, k + 1] - integrate(q[:, k], h * v[:, k + 1]), tau[:6] / 10]
        cost += casadi.sumsqr(tau[6:] / 10) + 1e-3 * casadi.sumsqr(v[:, k])
    x = casadi.veccat(q, v)
    problem = {"x": x, "f": cost, "g": casadi.vertcat(*zero)}
    solver = casadi.nlpsol("solver", "ipopt", problem, {"ipopt": {"print_level": 0, "sb": "yes", "tol": 1e-9, "max_iter": 200}, "print_time": False})
    start = time.perf_counter()
    solution = solver(x0=casadi.veccat(casadi.repmat(first, 1, knots + 1), casadi.DM.zeros(nv, knots + 1)), lbg=0, ubg=0)
    seconds, statistics = time.perf_counter() - start, solver.stats()
    assert statistics["success"], statistics["return_status"]
    return statistics["iter_count"], seconds, float(casadi.mmax(casadi.fabs(solution["g"])))


def check_sparsity(shared):
    """A joint's acceleration has no part in others' torques that the mass matrix does not have; always-zero entries are left out."""
    import numpy

    derivatives = casadi.external("jac_inverse_dynamics", shared)
    assert [derivatives.name_out(k) for k in range(3)] == ["jac_out_q", "jac_out_v", "jac_out_a"]
    # Gravity torques do not depend on the first angle: its axis is along gravity.
    first = derivatives.sparsity_out(0)
    assert first.nnz() < first.numel() and not any(first.has_nz(row, 0) for row in range(6)), first
    # Missing arguments are zero, and a call without arguments is one with zeros.
    ours = casadi.external("inverse_dynamics", shared)
    buffer, memory = ours.buffer()
    result = numpy.zeros(6)
    buffer.set_res(0, memoryview(result))
    memory()
    assert far(result, ours(0, 0, 0)) == 0.0


def reach(torque, exact=False):
    """The motion of least torque and acceleration from one configuration to another, at rest at both ends, by IPOPT with the Gauss-Newton Hessian, or
    with the exact one.

    Torques, iterations, seconds. The unknowns are the configurations in between; rates and accelerations are their differences.
    """
    h, inner = SECONDS / STEPS, casadi.MX.sym("x", 6, STEPS - 1)
    q = casadi.horzcat(casadi.DM(START), casadi.DM(START), inner, casadi.DM(END), casadi.DM(END))
    v = (q[:, 1:] - q[:, :-1]) / h
    a = (v[:, 1:] - v[:, :-1]) / h
    tau = casadi.horzcat(*[torque(q[:, k + 1], v[:, k], a[:, k]) for k in range(STEPS + 1)])
    x, residual = casadi.vec(inner), casadi.vertcat(casadi.vec(tau) / TORQUE, casadi.vec(a))
    slopes = casadi.jacobian(residual, x)
    factor = casadi.MX.sym("factor")
    hessian = casadi.Function("hessian", [x, casadi.MX(0, 1), factor, casadi.MX(0, 1)], [2 * factor * casadi.triu(slopes.T @ slopes)])
    options = {"print_level": 0, "sb": "yes", "tol": 1e-10, "max_iter": 300}
    problem = {"x": x, "f": casadi.sumsqr(residual)}
    more = {} if exact else {"hess_lag": hessian}
    solver = casadi.nlpsol("solver", "ipopt", problem, {"ipopt": options, "print_time": False, **more})
    guess = [s + (e - s) * k / STEPS for k in range(1, STEPS) for s, e in zip(START, END)]
    start = time.perf_counter()
    solution = solver(x0=guess)
    seconds = time.perf_counter() - start
    statistics = solver.stats()
    assert statistics["success"], statistics["return_status"]
    torques = casadi.Function("torques", [x], [tau])(solution["x"]).full()
    return torques, statistics["iter_count"], seconds


def main():
    import numpy
    from casadi_code import Robot

    command = sys.argv[1:] or [build_command()]
    read = Robot(REPOSITORY / "models" / "urdf" / f"{ROBOT}.urdf", False)
    own = {name: casadi.Function(name, arguments, outputs(), {"cse": True}) for name, (arguments, outputs) in read.functions().items()
           if name in ("inverse_dynamics", "forward_dynamics")}
    own["mass_matrix"] = casadi.Function("mass_matrix", [read.q], [casadi.triu2symm(read.functions()["mass_matrix"][1]()[0])])
    with tempfile.TemporaryDirectory() as folder:
        shared = library(command, Path(folder, "arm"), ROBOT, FUNCTIONS)
        generator = numpy.random.default_rng(1)
        for name, worst in {**values(shared, own, generator), **second_derivatives(shared, own, generator)}.items():
            print(f"{name:<24}{worst:9.1e} of the largest entry")
            assert worst <= TOLERANCE, name
        check_sparsity(shared)
        generated = casadi.external("inverse_dynamics", shared)
        ours, theirs, exact = reach(generated), reach(own["inverse_dynamics"]), reach(generated, exact=True)
        legged = library(command, Path(folder, "legged"), LEGGED, LEGGED_FUNCTIONS)
        for name, worst in by_differences(legged, generator).items():
            print(f"{LEGGED}: {name:<24}{worst:9.1e} of the largest entry, from differences")
            assert worst <= BY_DIFFERENCES, name
        iterations, seconds, left = flight(legged)
    difference = abs(ours[0] - theirs[0]).max() / abs(theirs[0]).max()
    for whose, (_, iterations, seconds) in (("generated C", ours), ("CasADi's expressions", theirs)):
        print(f"IPOPT with {whose:<22}{iterations:5d} iterations{1e3 * seconds / iterations:9.2f} ms an iteration")
    _, iterations_exact, seconds_exact = exact
    print(f"IPOPT with exact Hessians            {iterations_exact:5d} iterations{1e3 * seconds_exact / iterations_exact:9.2f} ms an iteration")
    print(f"IPOPT on {LEGGED} in flight        {iterations:5d} iterations{1e3 * seconds / iterations:9.2f} ms an iteration, largest residual {left:.1e}")
    assert left < 1e-8 and abs(exact[0] - theirs[0]).max() <= SAME_SOLUTION * abs(theirs[0]).max()
    print(f"solutions differ by {difference:.1e} of the largest torque")
    assert difference <= SAME_SOLUTION
    print("1 passed, 0 failed")
    return 0


if __name__ == "__main__":
    from make import ensure_casadi

    ensure_casadi()
    import casadi

    sys.exit(main())
