#!/usr/bin/env python3
"""Compares steps with limits, dry friction and contacts with MuJoCo's mj_step, in states with contacts.

    python3 tests/mjcf/contact.py                   the models of MODELS, from the pinned packages
    python3 tests/mjcf/contact.py --file F.xml …    these files
    python3 tests/mjcf/contact.py --check           the files of CHECKED by one method, and generated code of GENERATED, in this folder
    python3 tests/mjcf/contact.py --all             every file of the packages: a row for each that differs, and the counts of all verdicts
    python3 tests/mjcf/contact.py --states N        so many states of each model
    python3 tests/mjcf/contact.py --speed [F.xml]   time of a step beside mj_step, alone and in vectors, in the states of a motion

MuJoCo's solver is Newton's method without a tolerance. It rolls each model with random controls, and each state on the way is a
start. What is not computed here is off in MuJoCo too, or the file is refused.

* "contacts", "rows": the largest numbers of both in a state.
* "one step": the largest difference of rates after one step, over 1 and the largest rate. The median and the worst of all states.
* "steps": after 1000 steps from 3 states, the difference over the largest of four MuJoCo rollouts whose starts differ by one unit
  in the last place of each number, or over one rounding of each step if that is more. Left out where a state grows without bound.

Exit status: 0 if one step differs by at most 1e-10, and 1000 steps by at most 10 times the latter (30 with a free body), else 1.
"""

import argparse
import collections
import sys
import tempfile
from pathlib import Path

from oracle import HERE, enter
from speed import METHODS, Program, apart, in_package
from steps import MANY, MANY_OF_FREE, ROUNDING, every_file, rolled, smooth

ONE_STEP = 1e-10
STATES, STEPS = 60, 1000
SPEED_STATES, SPEED_STEPS, ROUNDS = 64, 10, 11
MODELS = [
    ("gymnasium", "half_cheetah.xml"),
    ("gymnasium", "hopper.xml"),
    ("gymnasium", "walker2d_v5.xml"),
    ("gymnasium", "ant.xml"),
    ("gymnasium", "humanoid.xml"),
    ("gymnasium", "inverted_double_pendulum.xml"),
]
CHECKED = [HERE / "models" / f"{name}.xml" for name in ("touching", "pyramids", "boxes", "equations", "loops")]
GENERATED = HERE / "models" / "standing.xml"
CHECKED_STATES = 12


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--file", nargs="+", help="only these files")
    parser.add_argument("--check", action="store_true", help="only the files of this folder")
    parser.add_argument("--all", action="store_true", help="every file of the packages")
    parser.add_argument("--states", type=int, default=STATES, help=f"states of each model [default: {STATES}]")
    parser.add_argument("--integrator", choices=["Euler", "implicitfast", "RK4"], help="only this one")
    parser.add_argument("--leave-out", nargs="*", default=["constraint"], help="kinds of constraints that are left out here, of files that have them")
    parser.add_argument("--speed", nargs="*", metavar="FILE", help="time steps of generated code, of these files [default: MODELS]")
    arguments = parser.parse_args()
    enter("dynamics")
    if arguments.speed is not None:
        sys.exit(not speed([Path(file) for file in arguments.speed] or [in_package(*model) for model in MODELS], arguments))
    if arguments.check:
        arguments.states, arguments.integrator = CHECKED_STATES, "Euler"
    integrators = [arguments.integrator] if arguments.integrator else ["Euler", "implicitfast", "RK4"]
    print(f"{'model':40}{'nv':>4}{'contacts':>9}{'rows':>6}  {'integrator':14}{'median':>10}{'one step':>10}{'steps':>8}")
    paths = every_file() if arguments.all else CHECKED if arguments.check else map(Path, arguments.file or [])
    if not (arguments.all or arguments.check or arguments.file):
        paths = [in_package(*model) for model in MODELS]
    verdicts = collections.Counter()
    for path in paths:
        for integrator in integrators:
            try:
                row = measure(path, integrator, arguments)
            except RuntimeError as error:
                verdicts["refused by MuJoCo" if str(error).startswith("MuJoCo") else "refused here"] += 1
                if not arguments.all:
                    lines = [line for line in str(error).splitlines() if not line.startswith("warning")]
                    print(f"{path.name:40}{(lines or [str(error)])[0][:150]}", flush=True)
                break
            if row is None:
                verdicts["without freedoms"] += 1
                break
            nv, contacts, rows, median, worst, many, most = row
            is_equal = worst <= ONE_STEP and (many is None or many <= most)
            verdicts["equal" if is_equal else "differs"] += 1
            text = "left out" if many is None else f"{many:.2f}"
            if not (is_equal and arguments.all):
                print(f"{path.name:40}{nv:4}{contacts:9}{rows:6}  {integrator:14}{median:10.1e}{worst:10.1e}{text:>8}", flush=True)
    if arguments.all:
        print(", ".join(f"{count} {verdict}" for verdict, count in sorted(verdicts.items())))
    agrees = not arguments.check or speed([GENERATED], arguments, 1)
    allowed = {"equal", "without freedoms", *(["refused by MuJoCo", "refused here"] if arguments.all else [])}
    sys.exit(not agrees or any(verdict not in allowed for verdict in verdicts))


def prepare(path, integrator):
    """The model of MuJoCo with its constraints, as `smooth` returns it."""
    import mujoco
    import numpy as np

    prepared = smooth(path, integrator, constrained=True)
    if prepared is None:
        return None
    model = prepared[0]
    # The mass of bodies that slide alone is their inertia in MuJoCo; `smooth` turned that off.
    original = mujoco.MjModel.from_xml_path(str(path))
    for body in np.flatnonzero(original.body_simple == 2):
        model.body_invweight0[body] = original.body_invweight0[body]
        freedoms = slice(original.body_dofadr[body], original.body_dofadr[body] + original.body_dofnum[body])
        model.dof_invweight0[freedoms] = original.dof_invweight0[freedoms]
    model.opt.solver = mujoco.mjtSolver.mjSOL_NEWTON
    model.opt.noslip_iterations = 0
    return prepared


def motion(model, data, random, count, gap=40):
    """States of a motion with random controls (qpos, qvel, qfrc_applied, act, ctrl), some steps apart."""
    import mujoco
    import numpy as np

    low, high = model.actuator_ctrlrange.T if model.nu else (np.zeros(0), np.zeros(0))
    bounded = model.actuator_ctrllimited.astype(bool) if model.nu else np.zeros(0, bool)
    mujoco.mj_resetData(model, data)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    for k in range(count):
        if model.nu:
            within = random.uniform(np.where(bounded, low, -0.4), np.where(bounded, high, 0.4))
            data.ctrl[:] = within
        for _ in range(1 + k % gap):
            mujoco.mj_step(model, data)
        if not np.isfinite(data.qvel).all() or np.abs(data.qvel).max(initial=0) > 1e4:
            mujoco.mj_resetData(model, data)
        yield data.qpos.copy(), data.qvel.copy(), np.zeros(model.nv), data.act.copy(), data.ctrl.copy()


def speed(paths, arguments, rounds=ROUNDS):
    """Prints times of generated steps beside mj_step with its own tolerance; whether the motions agree."""
    import mujoco
    import numpy as np

    print("| model | freedoms | method | `mj_step`, ns | alone | vectors f64 | vectors f32 |\n|---|--:|---|--:|--:|--:|--:|", flush=True)
    agree = True
    for path in paths:
        integrator = arguments.integrator or "Euler"
        prepared = prepare(path, integrator)
        model, _, _, states = prepared
        starts = list(motion(model, mujoco.MjData(model), np.random.default_rng(3), SPEED_STATES))
        with tempfile.TemporaryDirectory() as folder:
            program = Program(path, METHODS[integrator], Path(folder), constrained=True)
            medians, (theirs, *ours) = program.rolled(prepared, starts, SPEED_STEPS, rounds, model.opt.timestep)
        far = [float(np.median([apart(model, states, a, b) for a, b in zip(one, theirs)])) for one in ours]
        ratios = " | ".join(f"{own:.0f} ({medians[0] / own:.1f})" for own in medians[1:])
        print(f"| {path.stem} | {model.nv} | {integrator} | {medians[0]:.0f} | {ratios} |   {' '.join(f'{x:.0e}' for x in far)}", flush=True)
        agree &= all(x < bound for x, bound in zip(far, (1e-6, 1e-6, 1e-3)))
    return agree


def measure(path, integrator, arguments):
    """nv, contacts and rows, median and worst difference of one step, and that of many over that of two rollouts of MuJoCo."""
    import mujoco
    import numpy as np

    prepared = prepare(path, integrator)
    if prepared is None:
        return None
    model, own, controls, states = prepared
    model.opt.tolerance, model.opt.ls_tolerance = 0, 1e-14
    model.opt.iterations, model.opt.ls_iterations = 100, 100
    data, random = mujoco.MjData(model), np.random.default_rng(3)
    starts, contacts, rows = [], 0, 0
    for start in motion(model, data, random, arguments.states):
        starts.append(start)
        mujoco.mj_forward(model, data)
        contacts, rows = max(contacts, data.ncon), max(rows, data.nefc)

    def ended(start, steps):
        mujoco.mj_resetData(model, data)
        data.qpos[:], data.qvel[:], data.qfrc_applied[:], data.act[:], data.ctrl[:] = start
        for _ in range(steps):
            mujoco.mj_step(model, data)
        return np.array(data.qpos), np.array(data.qvel), np.array(data.act)

    def differ(one, other):
        return apart(model, states, one, other)

    disable = mujoco.mjtDisableBit
    is_explicit = integrator == "Euler" and model.opt.disableflags & disable.mjDSBL_EULERDAMP
    method = "semi_implicit_euler" if is_explicit else integrator
    flags = ["--constraints", *(word for kind in arguments.leave_out for word in ("--leave-out", kind))]
    single = [differ(one, ended(start, 1)) for one, start in zip(rolled(path, model, (states, controls), starts, method, 1, *flags), starts)]
    few = starts[:: max(1, len(starts) // 3)][:3]
    ratios = []
    for one, start in zip(rolled(path, model, (states, controls), few, method, STEPS, *flags), few):
        reference = ended(start, STEPS)
        if not np.isfinite(reference[1]).all() or np.abs(reference[1]).max(initial=0.0) > 1e6:
            continue
        ulp = [[np.nextafter(x, random.choice([-1, 1], len(x)) * np.inf) for x in start[:2]] for _ in range(4)]
        beside = max(differ(ended((q, v, *start[2:]), STEPS), reference) for q, v in ulp)
        if np.isfinite(beside):
            ratios.append(differ(one, reference) / max(beside, STEPS * ROUNDING))
    is_free = (model.jnt_type == mujoco.mjtJoint.mjJNT_FREE).any()
    many = float(np.max(ratios)) if ratios else None
    return model.nv, contacts, rows, float(np.median(single)), float(np.max(single)), many, MANY_OF_FREE if is_free else MANY


if __name__ == "__main__":
    main()
