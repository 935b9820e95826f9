#!/usr/bin/env python3
"""Compares steps with limits, dry friction and contacts with MuJoCo's mj_step, in states with contacts.

    python3 tests/mjcf/contact.py                   the models of MODELS, from the pinned packages
    python3 tests/mjcf/contact.py --file F.xml …    these files
    python3 tests/mjcf/contact.py --check           the files of CHECKED by one method, and generated code of GENERATED, in this folder
    python3 tests/mjcf/contact.py --all             every file of the packages, by Euler, in 4 states: an hour
    python3 tests/mjcf/contact.py --all --write     the same, recorded in docs/site/data/contact.json, and docs/contact-files.md
    python3 tests/mjcf/contact.py --states N        so many states of each model
    python3 tests/mjcf/contact.py --speed [F.xml]   time of a step beside mj_step, alone and in vectors, in the states of a motion

MuJoCo's solver is Newton's method without a tolerance, on dense matrices. It rolls each model with random controls, and each state on
the way is a start. What is not computed here is off in MuJoCo too: pairs of shapes, limits and friction of tendons around geoms.

* "contacts", "rows": the largest numbers of both in a state.
* "one step": the largest difference of rates after one step, over 1 and the largest rate. The median and the worst of all states.
* "forces": the largest difference of points, normals, forces and moments of contacts after this step, over 1 and the largest force.
* "steps": after 1000 steps from 3 states, the difference over the largest of four MuJoCo rollouts whose starts differ by one unit
  in the last place of each number, or over one rounding of each step if that is more. Left out where a state grows without bound.

Exit status: 0 if one step differs by at most 1e-10, its contacts by 1e-8, and 1000 steps by at most 10 times the latter (30 with a free body), else 1.
With --all: 0 if every verdict is the recorded one, else 1.
"""

import argparse
import collections
import math
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from oracle import HERE, enter, packages, verdicts
from speed import METHODS, Program, apart, in_package
from steps import LONGEST, MANY, MANY_OF_FREE, ROUNDING, mjcf_files, of_mujoco, reported, rolled, smooth

ONE_STEP = 1e-10
# The tilt of an upright cylinder says where it touches a plane: errors of these places are
# roundings over the tilt.
FORCES = 1e-8
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
CHECKED = [HERE / "models" / f"{name}.xml" for name in ("touching", "pyramids", "boxes", "equations", "loops", "spatial")]
GENERATED = HERE / "models" / "standing.xml"
CHECKED_STATES = 12
ALL_STATES = 4
# Files with more have no rollouts of many steps.
MOST_FREEDOMS = 60
FORMS = ["plane", "height field", "sphere", "capsule", "ellipsoid", "cylinder", "box", "mesh", "signed distance"]
COMPUTED = [
    ("plane", "sphere"), ("plane", "capsule"), ("plane", "ellipsoid"), ("plane", "cylinder"), ("plane", "box"), ("sphere", "sphere"), ("sphere", "capsule"),
    ("sphere", "cylinder"), ("sphere", "box"), ("capsule", "capsule"), ("capsule", "box"), ("box", "box"),
]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--file", nargs="+", help="only these files")
    parser.add_argument("--check", action="store_true", help="only the files of this folder")
    parser.add_argument("--all", action="store_true", help="every file of the packages")
    parser.add_argument("--states", type=int, default=STATES, help=f"states of each model [default: {STATES}]")
    parser.add_argument("--integrator", choices=["Euler", "implicitfast", "RK4"], help="only this one")
    parser.add_argument("--write", action="store_true", help="records the verdicts; with --all")
    parser.add_argument("--leave-out", nargs="*", default=["constraint", "solver", "contact"], help="kinds of constraints that are left out here, of files that have them")
    parser.add_argument("--speed", nargs="*", metavar="FILE", help="time steps of generated code, of these files [default: MODELS]")
    arguments = parser.parse_args()
    enter("dynamics")
    if arguments.speed is not None:
        sys.exit(not speed([Path(file) for file in arguments.speed] or [in_package(*model) for model in MODELS], arguments))
    if arguments.check:
        arguments.states, arguments.integrator = CHECKED_STATES, "Euler"
    if arguments.all:
        sys.exit(every(arguments))
    integrators = [arguments.integrator] if arguments.integrator else ["Euler", "implicitfast", "RK4"]
    print(f"{'model':40}{'nv':>4}{'contacts':>9}{'rows':>6}  {'integrator':14}{'median':>10}{'one step':>10}{'forces':>10}{'steps':>8}")
    paths = CHECKED if arguments.check else map(Path, arguments.file or [])
    if not (arguments.check or arguments.file):
        paths = [in_package(*model) for model in MODELS]
    agrees = True
    for path in paths:
        for integrator in integrators:
            try:
                row = measure(path, integrator, arguments)
            except RuntimeError as error:
                agrees = False
                print(f"{path.name:40}{reason(error)}", flush=True)
                break
            if row is None:
                break
            agrees &= is_equal(row)
            nv, contacts, rows, median, worst, forces, many, _, lost = row
            text = "left out" if many is None else f"{many:.2f}"
            print(f"{path.name:40}{nv:4}{contacts:9}{rows:6}  {integrator:14}{median:10.1e}{worst:10.1e}{forces:10.1e}{text:>8}  {lost}", flush=True)
    if arguments.check:
        agrees &= speed([GENERATED], arguments, 1)
    sys.exit(not agrees)


def reason(error):
    """The first line of an error, without places of files."""
    lines = [line for line in str(error).splitlines() if line and not line.startswith("warning")]
    return re.sub(r"/\S*/", "", (lines or [str(error)])[0])[:150]


def is_equal(row):
    """Whether one step is that of MuJoCo, and many are as near as MuJoCo is to itself."""
    *_, worst, forces, many, most, _ = row
    return worst <= ONE_STEP and forces <= FORCES and (many is None or many <= most)


def every(arguments):
    """All files of the packages: a row each. Returns 1 if a verdict is not the recorded one."""
    arguments.states = min(arguments.states, ALL_STATES)
    counts, found = collections.Counter(), {}
    for package, folder in packages(argparse.Namespace(sample=False, only="")):
        files = found[package] = {"files": {}}
        for path in mjcf_files(folder):
            try:
                row = measure(path, "Euler", arguments)
                if row is None:
                    continue
                one = finding(row)
            except (RuntimeError, subprocess.TimeoutExpired) as error:
                if str(error).startswith("MuJoCo"):
                    continue
                if "found no constraint" in str(error):
                    continue
                is_slow = isinstance(error, subprocess.TimeoutExpired)
                one = {"verdict": f"refused: no answer in {LONGEST} s" if is_slow else f"refused: {reason(error)}", "without": ""}
            name = path.relative_to(folder).as_posix()
            files["files"][name] = one
            counts[one["verdict"].partition(":")[0]] += 1
            print(package, name, ", ".join(f"{key} {value}" for key, value in one.items() if value not in (None, "")), flush=True)
    print(", ".join(f"{count} {verdict}" for verdict, count in sorted(counts.items())))
    if arguments.write:
        verdicts.write("contact", found)
    changes = verdicts.changed("contact", found, ("verdict", "without"))
    print(*changes, sep="\n", end="\n" if changes else "")
    return int(bool(changes))


def finding(row):
    """What verdicts.py keeps of a row of `measure`; differences have one digit, and infinite ones are words."""
    nv, contacts, rows, _, worst, forces, many, _, lost = row
    verdict = ("equal" if worst <= ONE_STEP and forces <= FORCES else "differs") + (" without" if lost else "")
    numbers = {"one_step": f"{worst:.0e}", "forces": f"{forces:.0e}", "steps": "" if many is None else f"{many:.2g}"}
    numbers = {key: float(text) if text and math.isfinite(float(text)) else text or None for key, text in numbers.items()}
    return {"verdict": verdict, "without": lost, "freedoms": int(nv), "contacts": int(contacts), "rows": int(rows), **numbers}


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
    # MuJoCo 4.0.0 has a wrong factor of sparse matrices (fixed in 4.0.1).
    model.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    return prepared


def leave_out(model):
    """Turns off in MuJoCo what is not computed here; returns what that is."""
    import mujoco
    import numpy as np
    import world

    lost = set()
    for tendon in range(model.ntendon):
        if world.goes_around(model, tendon) and (model.tendon_limited[tendon] or model.tendon_frictionloss[tendon]):
            model.tendon_limited[tendon], model.tendon_frictionloss[tendon] = 0, 0
            model.tendon_stiffness[tendon], model.tendon_damping[tendon] = 0, 0
            lost.add("tendons around geoms")
    kinds = [FORMS[kind] for kind in model.geom_type]

    def is_computed(first, second):
        return tuple(sorted((kinds[first], kinds[second]), key=FORMS.index)) in COMPUTED

    def is_left_out(model, data, first, second):
        if is_computed(first, second):
            # As without a filter
            masks = model.geom_contype[first] & model.geom_conaffinity[second] | model.geom_contype[second] & model.geom_conaffinity[first]
            return int(masks == 0)
        return 1

    touching = np.flatnonzero(model.geom_contype | model.geom_conaffinity)
    meets = {
        tuple(sorted((kinds[a], kinds[b]), key=FORMS.index))
        for a in touching for b in touching
        if a < b and model.body_weldid[model.geom_bodyid[a]] != model.body_weldid[model.geom_bodyid[b]]
        and (model.geom_contype[a] & model.geom_conaffinity[b] or model.geom_contype[b] & model.geom_conaffinity[a])
    }
    for pair in range(model.npair):
        first, second = model.pair_geom1[pair], model.pair_geom2[pair]
        if not is_computed(first, second):
            # A filter does not see explicit pairs: this one is never near enough.
            model.pair_margin[pair] = -1e9
            meets.add(tuple(sorted((kinds[first], kinds[second]), key=FORMS.index)))
    missing = sorted(" x ".join(pair) for pair in meets - set(COMPUTED) if pair != ("plane", "plane"))
    mujoco.set_mjcb_contactfilter(is_left_out if missing else None)
    return ", ".join([*sorted(lost), *missing])


def motion(model, data, random, count, most=160):
    """States of a motion with random controls (qpos, qvel, qfrc_applied, act, ctrl), up to so many steps apart."""
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
        for _ in range(1 + 61 * k % most):
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
    """What `every` prints of a file.

    nv, contacts and rows; median and worst difference of one step; that of contacts after it; that of many steps over that of two
    rollouts of MuJoCo, and its bound; what is left out. None: a file without freedoms.
    """
    import mujoco
    import numpy as np

    prepared = prepare(path, integrator)
    if prepared is None:
        return None
    model, own, controls, states = prepared
    lost = leave_out(model)
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
    single, forces = [], 0.0
    for end, start in zip(reported(path, model, (states, controls), starts, method, 1, *flags, "--contacts"), starts):
        single.append(differ(of_mujoco(model, states, end), ended(start, 1)))
        mujoco.mj_forward(model, data)
        forces = max(forces, contacts_apart(model, data, end["contacts"]))
    few = starts[:: max(1, len(starts) // 3)][: 3 if model.nv <= MOST_FREEDOMS else 0]
    ratios = []
    ends = rolled(path, model, (states, controls), few, method, STEPS, *flags) if few else []
    for one, start in zip(ends, few):
        reference = ended(start, STEPS)
        if not np.isfinite(reference[1]).all() or np.abs(reference[1]).max(initial=0.0) > 1e6:
            continue
        ulp = [[np.nextafter(x, random.choice([-1, 1], len(x)) * np.inf) for x in start[:2]] for _ in range(4)]
        beside = max(differ(ended((q, v, *start[2:]), STEPS), reference) for q, v in ulp)
        if np.isfinite(beside):
            ratios.append(differ(one, reference) / max(beside, STEPS * ROUNDING))
    is_free = (model.jnt_type == mujoco.mjtJoint.mjJNT_FREE).any()
    many = float(np.max(ratios)) if ratios else None
    return model.nv, contacts, rows, float(np.median(single)), float(np.max(single)), forces, many, MANY_OF_FREE if is_free else MANY, lost


def contacts_apart(model, data, own):
    """How far contacts are apart: the largest difference of their points, m, and forces, over 1 and the largest force.

    Infinite if one has more of them.
    """
    import mujoco
    import numpy as np

    theirs = []
    for k, contact in enumerate(data.contact):
        if contact.efc_address < 0:
            continue
        six, frame = np.zeros(6), np.array(contact.frame).reshape(3, 3)
        mujoco.mj_contactForce(model, data, k, six)
        # On the body that moves, or on the second of both
        sign = -1 if model.body_weldid[model.geom_bodyid[contact.geom[1]]] == 0 else 1
        theirs.append(np.concatenate([contact.pos, sign * frame[0], sign * frame.T @ six[:3], sign * frame.T @ six[3:]]))
    ours = [np.array(one["point"] + one["normal"] + one["force"] + one["moment"]) for one in own]
    if len(ours) != len(theirs):
        return np.inf
    most = max([1.0, *(np.abs(one[6:]).max() for one in theirs)])
    scale = np.concatenate([np.ones(6), np.full(6, most)])
    largest = 0.0
    for one in ours:
        differences = [np.abs((one - other) / scale).max() for other in theirs]
        nearest = int(np.argmin(differences))
        largest = max(largest, differences[nearest])
        del theirs[nearest]
    return largest


if __name__ == "__main__":
    main()
