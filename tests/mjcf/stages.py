#!/usr/bin/env python3
"""Times the stages of a step with constraints beside MuJoCo's: one process, one core, the same states.

    python3 tests/mjcf/stages.py             the models of MODELS, from the pinned packages
    python3 tests/mjcf/stages.py --file F…   these files

stages.rs is compiled for this processor with functions of the file, and is linked with the library of MuJoCo's wheel. A number is the
median of the rounds, ns a state. MuJoCo's stages are its functions: kinematics to smooth acceleration, with the step; `mj_collision` and
`mj_makeConstraint`; `mj_fwdConstraint`. Of generated code they are differences: the step without constraints; what `constrained_error` takes
more, with the mass matrix and one gradient; and what the step with constraints takes more.

Exit status: 0.
"""

import argparse
from pathlib import Path

from contact import motion, prepare
from linked import timed
from oracle import enter
from speed import in_package

MODELS = [("gymnasium", "half_cheetah.xml"), ("gymnasium", "ant.xml"), ("gymnasium", "humanoid.xml")]
STATES, ROUNDS = 64, 11
FUNCTIONS = [
    "smooth = actuated_step_implicit_damping", "step = constrained_step_implicit_damping", "constrained_error", "constrained_search", "mujoco",
]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--file", nargs="+", help="only these files")
    arguments = parser.parse_args()
    enter("dynamics")
    print("| model | | without constraints | contacts and rows | search | whole step | steps of the search |\n|---|---|--:|--:|--:|--:|--:|", flush=True)
    for path in map(Path, arguments.file) if arguments.file else (in_package(*model) for model in MODELS):
        (smooth, error, step, *theirs), steps, their_steps = measured(path)
        before, collision, rows, project, forces, solver, euler, whole = theirs
        cells = [smooth, error - smooth, step - error, step]
        print(f"| {path.stem} | generated | {' | '.join(f'{ns:.0f}' for ns in cells)} | {steps:.1f} |", flush=True)
        cells = [before + project + forces + euler, collision + rows, solver, whole]
        print(f"| | MuJoCo | {' | '.join(f'{ns:.0f}' for ns in cells)} | {their_steps:.1f} |", flush=True)


def measured(path):
    """Medians, and the mean numbers of steps of the search."""
    import mujoco
    import numpy as np

    prepared = prepare(path, "Euler")
    model = prepared[0]
    data = mujoco.MjData(model)
    starts = list(motion(model, data, np.random.default_rng(3), STATES))
    iterations = []
    for q, v, _, act, ctrl in starts:
        data.qpos[:], data.qvel[:], data.act[:], data.ctrl[:] = q, v, act, ctrl
        mujoco.mj_step(model, data)
        mujoco.mj_forward(model, data)
        iterations.append(data.solver_niter.sum())
    medians, steps = timed(path, "stages.rs", ", ".join(FUNCTIONS), prepared, starts, ROUNDS)
    return medians, float(steps.mean()), float(np.mean(iterations))


if __name__ == "__main__":
    main()
