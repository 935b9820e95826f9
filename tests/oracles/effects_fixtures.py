#!/usr/bin/env python3
"""Writes tests/fixtures/effects/mujoco.json: accelerations that MuJoCo gives for arms subject to effects.

    python3 tests/oracles/effects_fixtures.py

Not part of the checks: the output is kept, with the version that made it. Wants mujoco and numpy (pip install mujoco numpy).
Each case turns on one effect, or all: gravity, armature, damping, springs, and drag of the fluid by MuJoCo's model of equivalent boxes.
"""

import json
import random
from pathlib import Path

import mujoco
import numpy as np

REPOSITORY = Path(__file__).resolve().parent.parent.parent
ROBOTS = ["ur5_like", "panda_like"]
CASES = ["gravity", "armature", "damping", "spring", "fluid", "all"]
DENSITY, VISCOSITY = 1000.0, 2.5  # as of water, and of honey, so that both count
STATES = 4


def box(mass, inertia):
    """Half sides of the box of this mass and these principal moments."""
    a, b, c = inertia
    return np.sqrt(np.maximum(np.array([b + c - a, a + c - b, a + b - c]), 0) * 1.5 / mass)


def drag(mass, inertia):
    """Coefficients along and about the axes of a box: quadratic, then viscous, and no wind.

    Source: MuJoCo documentation, Computation, Fluid forces.
    """
    r = box(mass, inertia)
    pairs = [(1, 2), (0, 2), (0, 1)]
    linear = [2 * DENSITY * r[j] * r[k] for j, k in pairs]
    angular = [0.5 * DENSITY * r[i] * (r[j] ** 4 + r[k] ** 4) for i, (j, k) in enumerate(pairs)]
    mean = float(sum(r)) / 3
    return [*linear, *angular, 6 * VISCOSITY * np.pi * mean, 8 * VISCOSITY * np.pi * mean ** 3, 0, 0, 0]


def rpy(quaternion):
    """Roll, pitch and yaw of a quaternion (w, x, y, z)."""
    r = np.zeros(9)
    mujoco.mju_quat2Mat(r, quaternion)
    r = r.reshape(3, 3)
    return [float(np.arctan2(r[2, 1], r[2, 2])), float(-np.arcsin(np.clip(r[2, 0], -1, 1))), float(np.arctan2(r[1, 0], r[0, 0]))]


def applied(effect, on, parameters, xyz=(0, 0, 0), angles=(0, 0, 0)):
    return {"effect": effect, "on": on, "xyz": [float(x) for x in xyz], "rpy": [float(x) for x in angles],
            "parameters": [float(x) for x in parameters]}


def subject(model, case, draw):
    """Turns on the effects of a case in the model, and says which they are."""
    effects, on = [], {case} if case != "all" else set(CASES)
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT | mujoco.mjtDisableBit.mjDSBL_LIMIT | mujoco.mjtDisableBit.mjDSBL_FRICTIONLOSS
    model.opt.gravity[:] = [0.3, -0.5, -9.81] if "gravity" in on else [0, 0, 0]
    model.dof_damping[:], model.dof_armature[:], model.jnt_stiffness[:], model.dof_frictionloss[:] = 0, 0, 0, 0
    for j in range(model.njnt):
        name, dof = model.joint(j).name, model.jnt_dofadr[j]
        if "armature" in on:
            model.dof_armature[dof] = draw.uniform(0.1, 1)
            effects.append(applied("armature", name, [model.dof_armature[dof], 1]))
        if "damping" in on:
            model.dof_damping[dof] = draw.uniform(0.5, 5)
            effects.append(applied("damping", name, [model.dof_damping[dof]]))
        if "spring" in on:
            model.jnt_stiffness[j], model.qpos_spring[j] = draw.uniform(5, 50), draw.uniform(-1, 1)
            effects.append(applied("spring", name, [model.jnt_stiffness[j], model.qpos_spring[j]]))
    if "fluid" in on:
        model.opt.density, model.opt.viscosity = DENSITY, VISCOSITY
        for b in range(1, model.nbody):
            if model.body_mass[b] > 0:
                effects.append(applied("box_drag", model.body(b).name, drag(model.body_mass[b], model.body_inertia[b]),
                                       model.body_ipos[b], rpy(model.body_iquat[b])))
    return effects


def states(model, draw):
    data = mujoco.MjData(model)
    for _ in range(STATES):
        for vector, most in [(data.qpos, 2.0), (data.qvel, 3.0), (data.qfrc_applied, 30.0)]:
            vector[:] = [draw.uniform(-most, most) for _ in vector]
        mujoco.mj_forward(model, data)
        yield {key: [float(x) for x in value] for key, value in
               [("q", data.qpos), ("v", data.qvel), ("tau", data.qfrc_applied), ("a", data.qacc)]}


def main():
    draw = random.Random(20)
    cases = []
    for robot in ROBOTS:
        for case in CASES:
            model = mujoco.MjModel.from_xml_path(str(REPOSITORY / "models" / "urdf" / f"{robot}.urdf"))
            effects = subject(model, case, draw)
            cases.append({"robot": robot, "case": case, "gravity": [float(x) for x in model.opt.gravity],
                          "joints": [model.joint(j).name for j in range(model.njnt)], "effects": effects,
                          "states": list(states(model, draw))})
    out = {"engine": f"MuJoCo {mujoco.__version__}", "cases": cases}
    (REPOSITORY / "tests" / "fixtures" / "effects" / "mujoco.json").write_text(json.dumps(out, indent=1) + "\n")


if __name__ == "__main__":
    main()
