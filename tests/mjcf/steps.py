#!/usr/bin/env python3
"""Compares steps of `articulated rollout` with MuJoCo's mj_step, in random states with random forces.

    python3 tests/mjcf/steps.py                   the dozen files of oracle.py, from the pinned packages
    python3 tests/mjcf/steps.py --file F.xml      one file

Contacts, limits, dry friction, equality constraints and actuators are off in MuJoCo; forces are applied to the joints. Euler
and implicitfast are compared with step_implicit_damping, RK4 with step_rk4_mujoco. implicitfast is compared where no body is
free, since MuJoCo solves the rotation of free bodies by themselves.

* "one step": the largest difference after one step from 20 states, over 1 and the largest rate.
* "steps": after 1000 steps from 5 states, the difference over the largest of four MuJoCo rollouts whose starts differ by one
  unit in the last place of each number. Left out where MuJoCo's own state grows beyond any bound.

Exit status: 0 if one step differs by at most 1e-12, and 1000 steps by at most 10 times the latter (100 times with a free
body, whose velocity is turned into axes of the body in each step), else 1.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from oracle import BALL, PLACE, build_command, environment, models
from programs import COMMAND
from simulate import order

ONE_STEP = 1e-12
MANY = 10.0
# Of free bodies, whose velocity here is in axes of the body: a step turns it into axes of the world and back, with a rounding.
MANY_OF_FREE = 100.0
STEPS = 1000


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--file", help="only this file")
    arguments = parser.parse_args()
    python = environment()
    if "MJCF_ORACLE" not in os.environ:
        build_command()
        words = [str(Path(word).resolve()) if Path(word).is_file() else word for word in sys.argv]
        sys.exit(subprocess.run([str(python), *words], cwd=PLACE, env={**os.environ, "MJCF_ORACLE": "1"}).returncode)
    print(f"{'model':40}{'nv':>4}  {'integrator':14}{'one step':>10}{'steps':>10}")
    good = True
    for path in [Path(arguments.file)] if arguments.file else models():
        for integrator in ("Euler", "implicitfast", "RK4"):
            try:
                row = measure(path, integrator)
            except RuntimeError as error:
                print(f"{path.name:40}{str(error).splitlines()[0][:100]}", flush=True)
                good = False
                break
            if row is None:
                continue
            freedoms, one, many, most = row
            good &= one <= ONE_STEP and (many is None or many <= most)
            text = "left out" if many is None else f"{many:.2f}"
            print(f"{path.name:40}{freedoms:4}  {integrator:14}{one:10.1e}{text:>10}", flush=True)
    sys.exit(not good)


def measure(path, integrator):
    """nv, difference of one step, and of many over that of two rollouts of MuJoCo."""
    import mujoco
    import numpy as np

    try:
        model = mujoco.MjModel.from_xml_path(str(path))
    except ValueError as error:
        raise RuntimeError(f"MuJoCo: {error}") from error
    if integrator == "implicitfast" and (model.jnt_type == mujoco.mjtJoint.mjJNT_FREE).any():
        return None
    disable = mujoco.mjtDisableBit
    model.opt.disableflags |= disable.mjDSBL_CONTACT | disable.mjDSBL_LIMIT | disable.mjDSBL_FRICTIONLOSS | disable.mjDSBL_EQUALITY
    # Without a reset where a motion has no bound.
    model.opt.disableflags |= disable.mjDSBL_ACTUATION | disable.mjDSBL_AUTORESET
    model.opt.integrator = getattr(mujoco.mjtIntegrator, {"Euler": "mjINT_EULER", "implicitfast": "mjINT_IMPLICITFAST", "RK4": "mjINT_RK4"}[integrator])
    data, random = mujoco.MjData(model), np.random.default_rng(7)
    starts = []
    for _ in range(20):
        q = np.array(model.qpos0)
        mujoco.mj_integratePos(model, q, random.uniform(-1, 1, model.nv), 1.0)
        force = 0.1 * random.uniform(-1, 1, model.nv)
        for kind, _, at, _ in parts(model):
            # A held force on the origin of a free body is in world axes there, and in body axes here.
            force[at : at + 3] *= kind != 0
        starts.append((q, random.uniform(-1, 1, model.nv), force))

    def ended(start, steps):
        mujoco.mj_resetData(model, data)
        data.qpos[:], data.qvel[:], data.qfrc_applied[:] = start
        for _ in range(steps):
            mujoco.mj_step(model, data)
        return np.array(data.qpos), np.array(data.qvel)

    def apart(one, other):
        way = np.zeros(model.nv)
        mujoco.mj_differentiatePos(model, way, 1.0, one[0], other[0])
        scale = 1 + np.abs(other[1]).max(initial=0.0)
        return float(np.abs(np.concatenate([way, one[1] - other[1]])).max(initial=0.0)) / scale

    # Without eulerdamp, Euler is explicit in damping.
    is_explicit = integrator == "Euler" and model.opt.disableflags & disable.mjDSBL_EULERDAMP
    method = "semi_implicit_euler" if is_explicit else integrator
    single = max(apart(one, ended(start, 1)) for one, start in zip(rolled(path, model, starts, method, 1), starts))
    few = starts[:5]
    ratios = []
    for one, start in zip(rolled(path, model, few, method, STEPS), few):
        reference = ended(start, STEPS)
        if not np.isfinite(reference[1]).all() or np.abs(reference[1]).max(initial=0.0) > 1e6:
            continue
        ulp = [[np.nextafter(x, random.choice([-1, 1], len(x)) * np.inf) for x in start[:2]] for _ in range(4)]
        beside = max(apart(ended((q, v, start[2]), STEPS), reference) for q, v in ulp)
        if np.isfinite(beside):
            ratios.append(apart(one, reference) / max(beside, 1e-14))
    is_free = (model.jnt_type == mujoco.mjtJoint.mjJNT_FREE).any()
    return model.nv, single, max(ratios) if ratios else None, MANY_OF_FREE if is_free else MANY


def rolled(path, model, starts, method, steps):
    """The ends of the command's rollouts, in MuJoCo's order and axes."""
    import numpy as np

    places = order(model)
    states = []
    for q, v, tau in starts:
        rates, torques = to_own(model, q, v), to_own(model, q, tau)
        states.append({"q": [float(q[place]) for place in places], "v": rates, "tau": torques})
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "states.json"
        file.write_text(json.dumps({"states": states}))
        command = [str(COMMAND), "rollout", str(path), "--steps", str(steps), "--states", str(file), "--method", method]
        done = subprocess.run([*command, "--time-step", repr(model.opt.timestep), "--format", "json"], capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(done.stderr)
    ends = []
    for end in json.loads(done.stdout)["states"]:
        q = np.zeros(model.nq)
        q[places] = end["q"]
        ends.append((q, from_own(model, q, end["v"])))
    return ends


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
