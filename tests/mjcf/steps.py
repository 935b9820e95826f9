#!/usr/bin/env python3
"""Compares steps of `articulated rollout` with MuJoCo's mj_step, in random states with random controls or forces.

    python3 tests/mjcf/steps.py                   the dozen files of oracle.py, from the pinned packages
    python3 tests/mjcf/steps.py --file F.xml …    these files
    python3 tests/mjcf/steps.py --all             every file of the packages: a row for each that differs, and the counts of all verdicts

Contacts, limits, dry friction and equality constraints are off in MuJoCo, and so are actuators that are not read ("off": how
many). A file with other actuators has random controls and activations, any other file random forces on its joints.

* "one step": the largest difference after one step from 20 states, over 1 and the largest rate.
* "steps": after 1000 steps from 5 states, the difference over the largest of four MuJoCo rollouts whose starts differ by one
  unit in the last place of each number, or over one rounding of each step if that is more. Left out where MuJoCo's own
  state grows beyond any bound.

Exit status: 0 if one step differs by at most 1e-12, and 1000 steps by at most 10 times the latter (30 times with a free
body, whose velocity is turned into axes of the body in each step), else 1.
"""

import argparse
import collections
import json
import math
import re
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path

from oracle import BALL, HELPER, enter, models, packages
from programs import COMMAND
from simulate import order

ONE_STEP = 1e-12
MANY = 10.0
# A group of actuators that the comparison turns off.
OFF = 30
# Of free bodies, whose velocity here is in axes of the body: a step turns it into axes of the world and back, with a rounding.
MANY_OF_FREE = 30.0
STEPS = 1000
# s: a rollout that takes longer is stopped.
LONGEST = 120
# Of one step, in f64: a rollout rounds in each step, also where the steps of one ulp at the start vanish.
ROUNDING = 2.0**-53


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--file", nargs="+", help="only these files")
    parser.add_argument("--all", action="store_true", help="every file of the packages")
    arguments = parser.parse_args()
    enter("dynamics")
    print(f"{'model':40}{'nv':>4}{'nu':>4}{'na':>4}{'off':>4}  {'integrator':14}{'one step':>10}{'steps':>10}")
    paths = every_file() if arguments.all else map(Path, arguments.file) if arguments.file else models()
    verdicts, worst = collections.Counter(), 0.0
    for path in paths:
        for integrator in ("Euler", "implicitfast", "RK4"):
            try:
                row = measure(path, integrator)
            except RuntimeError as error:
                refused = "refused by MuJoCo" if str(error).startswith("MuJoCo") else "refused here"
                verdicts[refused] += 1
                if not arguments.all:
                    print(f"{path.name:40}{str(error).splitlines()[0][:100]}", flush=True)
                break
            if row is None:
                verdicts["without freedoms"] += 1
                break
            counts, one, many, most = row
            is_equal = one <= ONE_STEP and (many is None or many <= most)
            verdicts["equal" if is_equal else "differs"] += 1
            worst = max(worst, one if is_equal else 0.0)
            text = "left out" if many is None else f"{many:.2f}"
            if not (is_equal and arguments.all):
                print(f"{path.name:40}{''.join(f'{count:4}' for count in counts)}  {integrator:14}{one:10.1e}{text:>10}", flush=True)
    if arguments.all:
        print(", ".join(f"{count} {verdict}" for verdict, count in sorted(verdicts.items())), f"(three integrators each); one step: {worst:.1e}")
    allowed = {"equal", "without freedoms", *(["refused by MuJoCo", "refused here"] if arguments.all else [])}
    sys.exit(any(verdict not in allowed for verdict in verdicts))


def every_file():
    """All MJCF files of the packages."""
    for _, folder in packages(argparse.Namespace(sample=False, only="")):
        yield from mjcf_files(folder)


def mjcf_files(folder):
    """All MJCF files in a folder."""
    for path in sorted(folder.rglob("*")):
        if path.suffix.lower() in {".xml", ".mjcf"} and re.search(rb"<mujoco[\s>/]", path.read_bytes()):
            yield path


def smooth(path, integrator, constrained=False):
    """The model of MuJoCo without constraints, the names of the actuators that are read, and the places of their controls and activations."""
    import mujoco

    # Motions without a bound are left out by measure.
    mujoco.set_mju_user_warning(lambda _: None)
    warnings.filterwarnings("ignore", message="compiler attribute")
    try:
        spec = mujoco.MjSpec.from_file(str(path))
        for body in spec.bodies:
            body.simple = 0  # so that inertias may be set
        model = spec.compile()
    except (ValueError, mujoco.FatalError) as error:
        raise RuntimeError(f"MuJoCo: {error}") from error
    if model.nv == 0:
        return None
    turn_axes(model, path)
    disable = mujoco.mjtDisableBit
    if not constrained:
        model.opt.disableflags |= disable.mjDSBL_CONTACT | disable.mjDSBL_LIMIT | disable.mjDSBL_FRICTIONLOSS | disable.mjDSBL_EQUALITY
    # Without a reset where a motion has no bound.
    model.opt.disableflags |= disable.mjDSBL_AUTORESET
    own = actuators(path)
    names = [model.actuator(k).name or f"actuator_{k}" for k in range(model.nactuator)]
    used = [k for k, name in enumerate(names) if name in own]
    for k in set(range(model.nactuator)) - set(used):
        model.actuator_group[k] = OFF
    model.opt.disableactuator |= 1 << OFF
    # The place of the control and of the activation of each actuator that is read, in the order of the command.
    controls = [model.actuator_ctrladr[names.index(name)] for name in own]
    states = [model.actuator_actadr[names.index(name)] for name in own if model.actuator_actnum[names.index(name)] > 0]
    model.opt.integrator = getattr(mujoco.mjtIntegrator, {"Euler": "mjINT_EULER", "implicitfast": "mjINT_IMPLICITFAST", "RK4": "mjINT_RK4"}[integrator])
    return model, own, controls, states


def random_starts(prepared, random, count, spread=1.0):
    """Of each start (qpos, qvel, qfrc_applied, act, ctrl): positions, rates, and controls, or forces without actuators."""
    import mujoco
    import numpy as np

    model, own, controls, states = prepared
    for _ in range(count):
        q = np.array(model.qpos0)
        mujoco.mj_integratePos(model, q, spread * random.uniform(-1, 1, model.nv), 1.0)
        force = 0.1 * random.uniform(-1, 1, model.nv)
        for kind, _, at, _ in parts(model):
            # A held force on the origin of a free body is in world axes there, and in body axes here.
            force[at : at + 3] *= kind != 0
        ctrl, act = np.zeros(model.nu), np.zeros(model.na)
        if own:
            force *= 0
            ctrl[controls] = spread * random.uniform(-1, 1, len(controls))
            act[states] = spread * random.uniform(-1, 1, len(states))
        yield q, spread * random.uniform(-1, 1, model.nv), force, act, ctrl


def measure(path, integrator):
    """nv, nu, na and actuators that are off; difference of one step, and of many over that of two rollouts of MuJoCo."""
    import mujoco
    import numpy as np

    prepared = smooth(path, integrator)
    if prepared is None:
        return None
    model, own, controls, states = prepared
    disable = mujoco.mjtDisableBit
    data, random = mujoco.MjData(model), np.random.default_rng(7)
    starts = list(random_starts(prepared, random, 20))

    def ended(start, steps):
        mujoco.mj_resetData(model, data)
        data.qpos[:], data.qvel[:], data.qfrc_applied[:], data.act[:], data.ctrl[:] = start
        for _ in range(steps):
            mujoco.mj_step(model, data)
        return np.array(data.qpos), np.array(data.qvel), np.array(data.act)

    def apart(one, other):
        way = np.zeros(model.nv)
        mujoco.mj_differentiatePos(model, way, 1.0, one[0], other[0])
        scale = 1 + np.abs(other[1]).max(initial=0.0)
        activations = (one[2] - other[2])[states] / (1 + np.abs(other[2]).max(initial=0.0))
        return float(np.abs(np.concatenate([way, one[1] - other[1], activations])).max(initial=0.0)) / scale

    # Without eulerdamp, Euler is explicit in damping.
    is_explicit = integrator == "Euler" and model.opt.disableflags & disable.mjDSBL_EULERDAMP
    method = "semi_implicit_euler" if is_explicit else integrator
    # A difference that is not a number stays one.
    single = float(np.max([apart(one, ended(start, 1)) for one, start in zip(rolled(path, model, (states, controls), starts, method, 1), starts)]))
    few = starts[:5]
    ratios = []
    for one, start in zip(rolled(path, model, (states, controls), few, method, STEPS), few):
        reference = ended(start, STEPS)
        if not np.isfinite(reference[1]).all() or np.abs(reference[1]).max(initial=0.0) > 1e6:
            continue
        ulp = [[np.nextafter(x, random.choice([-1, 1], len(x)) * np.inf) for x in start[:2]] for _ in range(4)]
        beside = max(apart(ended((q, v, *start[2:]), STEPS), reference) for q, v in ulp)
        if np.isfinite(beside):
            ratios.append(apart(one, reference) / max(beside, STEPS * ROUNDING))
    is_free = (model.jnt_type == mujoco.mjtJoint.mjJNT_FREE).any()
    counts = model.nv, len(own), len(states), model.nactuator - len(own)
    return counts, single, float(np.max(ratios)) if ratios else None, MANY_OF_FREE if is_free else MANY


def turn_axes(model, path):
    """Gives MuJoCo the inertias to all digits: it stops to turn their axes at some 1e-6."""
    import mujoco
    import numpy as np

    answer = subprocess.run([str(HELPER), str(path), "0", "0", "0"], input=b"", capture_output=True)
    if answer.returncode:
        raise RuntimeError(answer.stderr.decode())
    links = json.loads(answer.stdout.partition(b"\n")[0])["links"]
    for body in range(1, model.nbody if len(links) == model.nbody else 1):
        if model.body_mass[body] <= 0:
            continue
        rotation = np.zeros(9)
        mujoco.mju_quat2Mat(rotation, model.body_iquat[body])
        rotation = rotation.reshape(3, 3)
        inertia = np.array(links[body]["inertia"]).reshape(3, 3)
        rest = rotation.T @ inertia @ rotation - np.diag(model.body_inertia[body])
        # Of equal moments MuJoCo's axes stay: those of the box in a medium.
        if np.abs(rest).max() > 1e-13 * np.abs(inertia).max():
            moments, axes = np.linalg.eigh(inertia)
            axes[:, 0] *= np.linalg.det(axes)
            mujoco.mju_mat2Quat(model.body_iquat[body], axes.flatten())
            model.body_inertia[body] = moments
    model.body_sameframe[:] = 0
    mujoco.mj_setConst(model, mujoco.MjData(model))
    # MuJoCo puts geoms and sites whose frame is nearly that of the inertia there.
    model.body_sameframe[:], model.geom_sameframe[:], model.site_sameframe[:] = 0, 0, 0


def actuators(path):
    """The names of the actuators that are read, in the order of the command."""
    command = [str(COMMAND), "rollout", str(path), "--steps", "1", "--format", "json"]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(done.stderr)
    return json.loads(done.stdout).get("actuators", [])


def rolled(path, model, places_of, starts, method, steps, *flags):
    """The ends of the command's rollouts, in MuJoCo's order and axes."""
    return [of_mujoco(model, places_of[0], end) for end in reported(path, model, places_of, starts, method, steps, *flags)]


def of_mujoco(model, activations, end):
    """A state that the command reports, in MuJoCo's order and axes."""
    import numpy as np

    # A number without a bound is null.
    q, v, act = ([math.nan if x is None else x for x in end.get(name, [])] for name in ("q", "v", "act"))
    own, states = np.zeros(model.nq), np.zeros(model.na)
    own[order(model)], states[activations] = q, act
    return own, from_own(model, own, v), states


def reported(path, model, places_of, starts, method, steps, *flags):
    """What the command reports of the ends of its rollouts."""

    places, (activations, controls) = order(model), places_of
    states = []
    for q, v, tau, act, ctrl in starts:
        state = {"q": [float(q[place]) for place in places], "v": to_own(model, q, v)}
        if controls or flags:
            state |= {"act": [float(act[place]) for place in activations], "ctrl": [float(ctrl[place]) for place in controls]}
        else:
            state["tau"] = to_own(model, q, tau)
        states.append(state)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "states.json"
        file.write_text(json.dumps({"states": states}))
        command = [str(COMMAND), "rollout", str(path), "--steps", str(steps), "--states", str(file), "--method", method, *flags]
        command += ["--time-step", repr(model.opt.timestep), "--format", "json"]
        done = subprocess.run(command, capture_output=True, text=True, timeout=LONGEST)
    if done.returncode:
        raise RuntimeError(done.stderr)
    return json.loads(done.stdout)["states"]


def parts(model):
    """The type of each joint, its first place in qpos and in qvel, and in v here."""
    own = 0
    for joint in range(model.njnt):
        kind = model.jnt_type[joint]
        yield kind, model.jnt_qposadr[joint], model.jnt_dofadr[joint], own
        own += 6 if kind == 0 else 3 if kind == BALL else 1


def rotation(q):
    import mujoco
    import numpy as np

    matrix = np.zeros(9)
    mujoco.mju_quat2Mat(matrix, q / np.linalg.norm(q))
    return matrix.reshape(3, 3)


def to_own(model, q, v):
    """Rates or torques: of a free joint [angular; linear] in axes of the body, from [linear in world axes; angular]."""
    out = []
    for kind, place, at, _ in parts(model):
        if kind == 0:
            turn = rotation(q[place + 3 : place + 7])
            out += [*v[at + 3 : at + 6], *(turn.T @ v[at : at + 3])]
        else:
            out += list(v[at : at + (3 if kind == BALL else 1)])
    return [float(x) for x in out]


def from_own(model, q, v):
    import numpy as np

    out = np.zeros(model.nv)
    for kind, place, at, own in parts(model):
        if kind == 0:
            turn = rotation(q[place + 3 : place + 7])
            out[at + 3 : at + 6], out[at : at + 3] = v[own : own + 3], turn @ np.array(v[own + 3 : own + 6])
        else:
            count = 3 if kind == BALL else 1
            out[at : at + count] = v[own : own + count]
    return out


if __name__ == "__main__":
    main()
