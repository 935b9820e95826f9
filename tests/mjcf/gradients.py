#!/usr/bin/env python3
"""Times exact derivatives of steps with constraints beside MuJoCo's finite differences: one process, one core, the same states.

    python3 tests/mjcf/gradients.py             the models of MODELS, from the pinned packages
    python3 tests/mjcf/gradients.py --file F…   these files

gradients.rs is compiled for this processor with a step of the file as MuJoCo's Euler, its Jacobian by q, v and ctrl, and its
vector–Jacobian product, and is linked with the library of MuJoCo's wheel. `mjd_transitionFD` has centred differences of 1e-6 and its solver a
tolerance of 1e-15. A number is the median of the rounds, ns.

"Differ": the median over states of the largest difference of ∂v_next/∂(q, v, ctrl), over 1 and the largest number. Where a contact begins within the width
of a difference, MuJoCo's is between both sides. Models with a free joint are not compared: MuJoCo has other axes for it.

Exit status: 0 if the median is at most 1e-4 for all models, else 1.
"""

import argparse
import sys
from pathlib import Path

from contact import motion, prepare
from linked import timed
from oracle import enter
from speed import in_package

MODELS = [("gymnasium", "hopper.xml"), ("gymnasium", "half_cheetah.xml"), ("gymnasium", "walker2d_v5.xml"), ("gymnasium", "ant.xml")]
STATES, ROUNDS, MOST = 64, 11, 1e-4


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--file", nargs="+", help="only these files")
    arguments = parser.parse_args()
    enter("dynamics")
    print("| model | freedoms | step, ns | vector–Jacobian product | Jacobian | `mjd_transitionFD` | differ |\n|---|--:|--:|--:|--:|--:|--:|", flush=True)
    agree = True
    for path in map(Path, arguments.file) if arguments.file else (in_package(*model) for model in MODELS):
        nv, (theirs, step, pull, slopes), differ = measured(path)
        agree &= differ is None or differ <= MOST
        text = "" if differ is None else f"{differ:.0e}"
        print(f"| {path.stem} | {nv} | {step:.0f} | {pull:.0f} | {slopes:.0f} ({theirs / slopes:.0f}) | {theirs:.0f} | {text} |", flush=True)
    sys.exit(not agree)


def measured(path):
    """Freedoms, medians, and the median difference."""
    import mujoco
    import numpy as np

    prepared = prepare(path, "Euler")
    model = prepared[0]
    model.opt.tolerance, model.opt.iterations, model.opt.ls_iterations = 1e-15, 100, 100
    starts = list(motion(model, mujoco.MjData(model), np.random.default_rng(3), STATES))
    name = "constrained_step_implicit_damping"
    functions = f"step = {name}, slopes = jacobian({name}, q v ctrl), pull = vjp({name}, q v ctrl), mujoco"
    medians, numbers = timed(path, "gradients.rs", functions, prepared, starts, ROUNDS, "--max-code-size", "400")
    nv, nu, na = model.nv, model.nu, model.na
    if (model.jnt_type == mujoco.mjtJoint.mjJNT_FREE).any() or na:
        return nv, medians, None
    own, a, b = np.split(numbers, np.cumsum([STATES * nv * (2 * nv + nu), STATES * (2 * nv) ** 2]))
    own = own.reshape(STATES, nv * (2 * nv + nu))
    parts = np.split(own, [nv * nv, 2 * nv * nv], axis=1)
    own = np.concatenate([part.reshape(STATES, nv, -1) for part in parts], axis=2)
    a, b = a.reshape(STATES, 2 * nv, 2 * nv)[:, nv:], b.reshape(STATES, 2 * nv, nu)[:, nv:]
    theirs = np.concatenate([a, b], axis=2)
    apart = np.abs(own - theirs).max(axis=(1, 2)) / np.maximum(1.0, np.abs(theirs).max(axis=(1, 2)))
    return nv, medians, float(np.median(apart))


if __name__ == "__main__":
    main()
