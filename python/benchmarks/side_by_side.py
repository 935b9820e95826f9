#!/usr/bin/env python3
"""Times per state of Pinocchio in a loop, of articulated in a loop, and of articulated in one call for all states.

    python side_by_side.py [--seconds 0.3] [--compiled]

Prints a table in Markdown. Each time is the shortest of several runs. Needs this package; Pinocchio
(`pip install pin`) is left out where it is not installed.
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

COUNTS = [1, 64, 4096]
ROBOTS = ["panda_like", "quadruped", "humanoid"]
# Name here, arguments after q, Pinocchio's function.
FUNCTIONS = [
    ("inverse_dynamics", 2, "rnea"),
    ("mass_matrix", 0, "crba"),
    ("forward_dynamics", 2, "aba"),
    ("inverse_dynamics_derivatives", 2, "computeRNEADerivatives"),
    ("forward_dynamics_derivatives", 2, "computeABADerivatives"),
    ("placements", 0, "framesForwardKinematics"),
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
    count = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    return f"{name}, {count} threads"


def pinocchio_run(robot, urdf, name, states):
    base = [pin.JointModelFreeFlyer()] if robot.base == "floating" else []
    model = pin.buildModelFromXML(urdf, *base)
    data, function = model.createData(), getattr(pin, name)

    def run():
        for state in states:
            function(model, data, *state)

    return run


def rows(robot_name, seconds, rng, with_compiled):
    robot = articulated.bundled(robot_name)
    urdf = next(urdf for name, urdf, *_ in articulated._native.bundled_robots() if name == robot_name)
    compiled = robot.compile([name for name, *_ in FUNCTIONS], flags=["-march=native"]) if with_compiled else None
    for name, extra, peer in FUNCTIONS:
        method = getattr(robot, name)
        for count in COUNTS:
            arguments = [robot.random_configuration(rng, count), *rng.normal(size=(extra, count, robot.nv))]
            states = list(zip(*arguments))

            def loop():
                for state in states:
                    method(*state)

            runs = [loop, lambda: method(*arguments), lambda: method(*arguments, threads=0)]
            if pin:
                # Any state takes as long as any other, whatever the order of its joints.
                runs.insert(0, pinocchio_run(robot, urdf, peer, states))
            if compiled:
                fast = getattr(compiled, name)
                runs.append(lambda: fast(*arguments))
            yield robot_name, name, count, [best(run, seconds) / count * 1e6 for run in runs]


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--seconds", type=float, default=0.3, help="for each time")
    options.add_argument("--compiled", action="store_true", help="measure compiled functions too; this needs a C compiler")
    options = options.parse_args()
    peers = [f"Pinocchio {pin.__version__}, loop"] if pin else []
    print(f"Microseconds per state; {processor()}; Python {platform.python_version()}, NumPy {np.__version__}.\n")
    heads = ["robot", "function", "N", *peers, "here, loop", "here, one call", "here, one call, all threads"]
    heads += ["compiled, one call"] if options.compiled else []
    print("| " + " | ".join(heads) + " |\n|---|---|--:|" + "--:|" * (len(heads) - 3))
    for robot in ROBOTS:
        for name, function, count, times in rows(robot, options.seconds, np.random.default_rng(0), options.compiled):
            print(f"| `{name}` | `{function}` | {count} | " + " | ".join(f"{one:.2f}" for one in times) + " |")
            sys.stdout.flush()


if __name__ == "__main__":
    main()
