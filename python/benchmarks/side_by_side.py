#!/usr/bin/env python3
"""Times per state of Pinocchio, MuJoCo and articulated, in loops and in one call for all states, in one process.

    python side_by_side.py [--seconds 0.3] [--compiled] [--robots panda_like,quadruped] [--million]

Prints a table in Markdown. Each time is the shortest of several runs. Needs this package; Pinocchio
(`pip install pin`) and MuJoCo (`pip install mujoco`) are left out where they are not installed. `--million`
adds 10⁶ states of inverse dynamics.
"""

import argparse
import os
import platform
import sys
import time

import articulated
import numpy as np

try:
    import pinocchio as pin
except ImportError:
    pin = None
try:
    import mujoco
except ImportError:
    mujoco = None

COUNTS = [1, 64, 4096]
MILLION = 10**6
ROBOTS = ["panda_like", "quadruped", "humanoid"]
# Name here, arguments after q, Pinocchio's function, and its function of many states.
FUNCTIONS = [
    ("inverse_dynamics", 2, "rnea", "rneaInParallel"),
    ("mass_matrix", 0, "crba", None),
    ("forward_dynamics", 2, "aba", "abaInParallel"),
    ("inverse_dynamics_derivatives", 2, "computeRNEADerivatives", None),
    ("forward_dynamics_derivatives", 2, "computeABADerivatives", None),
    ("placements", 0, "framesForwardKinematics", None),
]


def best(run, seconds):
    """The shortest time of a run, s, of those that fit into so many seconds."""
    run()
    shortest, end = float("inf"), time.perf_counter() + seconds
    while time.perf_counter() < end:
        start = time.perf_counter()
        run()
        shortest = min(shortest, time.perf_counter() - start)
    return shortest


def processor():
    """The processor's name and the number of its threads that may be used."""
    name = platform.processor() or platform.machine()
    if os.path.exists("/proc/cpuinfo"):
        with open("/proc/cpuinfo", encoding="utf-8") as lines:
            name = next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), name)
    return f"{name}, {threads()} threads"


def threads():
    """How many threads may be used."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()


def pinocchio_runs(robot, urdf, name, parallel, arguments, states):
    """Pinocchio's function in a loop, and its function of many states with all threads or None."""
    base = [pin.JointModelFreeFlyer()] if robot.base == "floating" else []
    model = pin.buildModelFromXML(urdf, *base)
    data, function = model.createData(), getattr(pin, name)

    def loop():
        for state in states:
            function(model, data, *state)

    if parallel is None:
        return loop, None
    # A column a state.
    pool, columns = pin.ModelPool(model, threads()), [np.asfortranarray(array.T) for array in arguments]
    out = np.empty_like(columns[-1])
    return loop, lambda: getattr(pin, parallel)(threads(), pool, *columns, out)


def mujoco_run(robot, urdf, name, states):
    """MuJoCo's function in a loop, or None: recursive Newton-Euler with the kinematics that it needs, or composite inertias."""
    spec = mujoco.MjSpec.from_string(urdf)
    if robot.base == "floating":
        spec.worldbody.first_body().add_freejoint()
    model = spec.compile()
    data = mujoco.MjData(model)
    if name == "inverse_dynamics":
        out = np.zeros(model.nv)

        def run(q, v, a):
            data.qpos[:], data.qvel[:], data.qacc[:] = q, v, a
            mujoco.mj_kinematics(model, data)
            mujoco.mj_comPos(model, data)
            mujoco.mj_comVel(model, data)
            mujoco.mj_rne(model, data, 1, out)
    elif name == "placements":

        def run(q):
            data.qpos[:] = q
            mujoco.mj_kinematics(model, data)
    else:
        return None

    def loop():
        for state in states:
            run(*state)

    return loop


def rows(robot_name, seconds, rng, with_compiled, with_million):
    robot = articulated.bundled(robot_name)
    urdf = next(urdf for name, urdf, *_ in articulated._native.bundled_robots() if name == robot_name)
    compiled = robot.compile([name for name, *_ in FUNCTIONS], flags=["-march=native"], batch=True) if with_compiled else None
    for name, extra, peer, parallel in FUNCTIONS:
        method = getattr(robot, name)
        for count in COUNTS + [MILLION] * (with_million and name == "inverse_dynamics"):
            arguments = [robot.random_configuration(rng, count), *rng.normal(size=(extra, count, robot.nv))]
            states = list(zip(*arguments))

            def loop():
                for state in states:
                    method(*state)

            runs = [loop, lambda: method(*arguments), lambda: method(*arguments, threads=0)]
            # Any state takes as long as any other, whatever the order of its joints.
            runs = ([mujoco_run(robot, urdf, name, states)] if mujoco else []) + runs
            runs = (list(pinocchio_runs(robot, urdf, peer, parallel, arguments, states)) if pin else []) + runs
            if compiled:
                fast = getattr(compiled, name)
                runs += [lambda: fast(*arguments), lambda: fast(*arguments, threads=0)]
            yield robot_name, name, count, [best(run, seconds) / count * 1e6 if run else None for run in runs]


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--seconds", type=float, default=0.3, help="for each time")
    options.add_argument("--compiled", action="store_true", help="measure compiled functions too; this needs a C compiler")
    options.add_argument("--robots", default=",".join(ROBOTS), help="names of bundled robots")
    options.add_argument("--million", action="store_true", help="measure a million states of inverse dynamics too")
    options = options.parse_args()
    peers = [f"Pinocchio {pin.__version__}, loop", "Pinocchio in parallel"] if pin else []
    peers += [f"MuJoCo {mujoco.__version__}, loop"] if mujoco else []
    print(f"Microseconds per state; {processor()}; Python {platform.python_version()}, NumPy {np.__version__}.\n")
    heads = ["robot", "function", "N", *peers, "here, loop", "here, one call", "here, one call, all threads"]
    heads += ["compiled, one call", "compiled, all threads"] if options.compiled else []
    print("| " + " | ".join(heads) + " |\n|---|---|--:|" + "--:|" * (len(heads) - 3))
    for robot in options.robots.split(","):
        for name, function, count, times in rows(robot, options.seconds, np.random.default_rng(0), options.compiled, options.million):
            print(f"| `{name}` | `{function}` | {count} | " + " | ".join("" if one is None else f"{one:.2f}" for one in times) + " |")
            sys.stdout.flush()


if __name__ == "__main__":
    main()
