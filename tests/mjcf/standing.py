#!/usr/bin/env python3
"""Robots of the package playground stand: `articulated simulate` beside mj_step, from the state in which their files begin.

    python3 tests/mjcf/standing.py

A robot stands if its base has sunk by at most a fifth after 2 s, is turned by at most 0.1 rad, and rests on contacts that carry its
weight. "Apart": how far the base is from that of MuJoCo then, whose solver has a tolerance of 0. At most 1e-9 m is allowed.

Exit status: 0 if all stand, else 1.
"""

import csv
import json
import subprocess
import sys
import tempfile
from pathlib import Path

from oracle import enter
from programs import COMMAND
from speed import in_package

FOLDER = "playground/_src/locomotion"
MODELS = [
    "go1/xmls/scene_mjx_feetonly_flat_terrain.xml",
    "spot/xmls/scene_mjx_feetonly_flat_terrain.xml",
    "h1/xmls/scene_mjx_feetonly.xml",
    "op3/xmls/scene_mjx_feetonly.xml",
    "apollo/xmls/scene_mjx_feetonly_flat_terrain.xml",
]
END = 2.0
SUNK, TURNED, APART, WEIGHT = 0.2, 0.1, 1e-9, 0.02


def main():
    enter("dynamics")
    import mujoco
    import numpy as np

    print(f"{'robot':10}{'freedoms':>9}{'contacts':>9}{'height, m':>11}{'turned, rad':>12}{'weight':>8}{'apart, m':>10}")
    stands = True
    for name in MODELS:
        path = in_package("playground", f"{FOLDER}/{name}")
        model = without_looks(path)
        data = mujoco.MjData(model)
        home = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_KEY, "home")
        if home >= 0:
            mujoco.mj_resetDataKeyframe(model, data, home)
        start = float(data.qpos[2])
        # The exact law: files for MJX end the search of accelerations early.
        model.opt.solver, model.opt.iterations, model.opt.ls_iterations = mujoco.mjtSolver.mjSOL_NEWTON, 100, 100
        model.opt.tolerance, model.opt.ls_tolerance = 0, 1e-14
        model.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
        for _ in range(round(END / model.opt.timestep)):
            mujoco.mj_step(model, data)
        with tempfile.TemporaryDirectory() as folder:
            words = [str(COMMAND), "simulate", str(path), "--end", str(END), "--every", str(END), "--leave-out", "constraint,solver", "-o", folder]
            done = subprocess.run(words, capture_output=True, text=True)
            if done.returncode:
                sys.exit(f"{path.name}: {done.stderr}")
            last = list(csv.reader(Path(folder, "recording.csv").open()))[-1]
            summary = json.loads(Path(folder, "summary.json").read_text())
        place, turn = np.array([float(x) for x in last[1:4]]), np.array([float(x) for x in last[4:8]])
        turned = 2 * np.arcsin(min(1.0, float(np.linalg.norm(turn[:3]))))
        apart = float(np.abs(place - data.qpos[:3]).max())
        weight = carried(path, model)
        good = place[2] > (1 - SUNK) * start and turned < TURNED and apart < APART and abs(weight - 1) < WEIGHT
        stands &= bool(good)
        contacts = summary["constraints"]["most_contacts"]
        print(f"{name.split('/')[0]:10}{model.nv:9}{contacts:9}{place[2]:11.4f}{turned:12.4f}{weight:8.4f}{apart:10.1e}{'' if good else '  does not stand'}", flush=True)
    sys.exit(not stands)


def without_looks(path):
    """The model of MuJoCo without meshes, which are of other packages: they are only drawn, and bodies state their inertia."""
    import mujoco

    spec = mujoco.MjSpec.from_file(str(path))
    for geom in [geom for geom in spec.geoms if geom.type == mujoco.mjtGeom.mjGEOM_MESH]:
        assert not (geom.contype or geom.conaffinity), geom.name
        spec.delete(geom)
    for geom in spec.geoms:
        geom.material = ""
    for asset in [*spec.meshes, *spec.materials, *spec.textures]:
        spec.delete(asset)
    return spec.compile()


def carried(path, model):
    """The force of the contacts along gravity over the weight, after 2 s."""
    import numpy as np

    words = [str(COMMAND), "rollout", str(path), "--constraints", "--contacts", "--leave-out", "constraint,solver", "--format", "json"]
    done = subprocess.run([*words, "--steps", str(round(END / model.opt.timestep))], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{path.name}: {done.stderr}")
    contacts = json.loads(done.stdout)["states"][0]["contacts"]
    force = sum((np.array(one["force"]) for one in contacts), np.zeros(3))
    return float(-force @ model.opt.gravity / (model.opt.gravity @ model.opt.gravity) / model.body_mass.sum())


if __name__ == "__main__":
    main()
