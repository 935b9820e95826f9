#!/usr/bin/env python3
"""Simulates MJCF files with `articulated simulate` and with MuJoCo's mj_step, and prints time and error side by side.

    python3 tests/mjcf/simulate.py                   the dozen files of oracle.py, from the pinned packages
    python3 tests/mjcf/simulate.py --file F.xml      one file
    python3 tests/mjcf/simulate.py --end 2           until 2 s

Contacts, limits, dry friction and equality constraints are off in both: the smooth motion remains. It begins in the file's
reference state, moved by random numbers of a fixed seed, and all controls are a tenth of their upper bound, or 0.1.

The reference is this library's dop853 with tolerances of 1e-12. "Same motion" is the difference between it and MuJoCo's RK4 with
steps of 1/50 of the file's: it tells that both solve the same equations. Errors are the largest difference of all coordinates at
the end, rad or m. Times are of one simulated second: of dopri5 with a tolerance of 1e-6, by generated code, which
rustc compiles, and by generic code.

Exit status: 0 if all motions are the same within 1e-6, else 1.
"""

import argparse
import csv
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from oracle import BALL, HERE, REPOSITORY, enter, models
from programs import COMMAND

SAME = 1e-6


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--file", help="only this file")
    parser.add_argument("--end", type=float, default=1.0, help="the last time, s [default: 1]")
    arguments = parser.parse_args()
    enter()
    print(f"{'':40}{'':6}{'':13}{'MuJoCo, its step':>24}{'dopri5, generated':>24}{'generic':>12}")
    print(f"{'model':40}{'nv':>6}{'same motion':>13}" + f"{'error':>12}{'time, ms':>12}" * 2 + f"{'time, ms':>12}")
    good = True
    for path in [Path(arguments.file)] if arguments.file else models():
        try:
            row = measure(path, arguments.end)
        except RuntimeError as error:
            print(f"{path.name:40}{str(error).splitlines()[0][:100]}", flush=True)
            good = False
            continue
        good &= row[1] <= SAME
        freedoms, same, generic, *both = row
        columns = "".join(f"{error:12.1e}{1e3 * seconds:12.3f}" for error, seconds in both)
        print(f"{path.name:40}{freedoms:6}{same:13.1e}{columns}{1e3 * generic:12.3f}", flush=True)
    sys.exit(not good)


def measure(path, end):
    """nv, difference of the references, seconds of generic code, and (error, seconds) of MuJoCo and of generated code."""
    import mujoco
    import numpy as np

    try:
        model = mujoco.MjModel.from_xml_path(str(path))
    except ValueError as error:
        raise RuntimeError(f"MuJoCo: {error}") from error
    # A whole number of steps.
    end = round(end / model.opt.timestep) * model.opt.timestep
    disable = mujoco.mjtDisableBit
    model.opt.disableflags |= disable.mjDSBL_CONTACT | disable.mjDSBL_LIMIT | disable.mjDSBL_FRICTIONLOSS | disable.mjDSBL_EQUALITY
    data = mujoco.MjData(model)
    random = np.random.default_rng(1)
    start = np.array(data.qpos)
    mujoco.mj_integratePos(model, start, random.uniform(-0.3, 0.3, model.nv), 1.0)
    upper = np.where(model.actuator_ctrllimited.astype(bool), model.actuator_ctrlrange[:, 1], 1.0)
    control = 0.1 * upper

    def step(by):
        model.opt.timestep = by
        mujoco.mj_resetData(model, data)
        data.qpos[:], data.ctrl[:] = start, control
        count = round(end / by)
        begin = time.perf_counter()
        for _ in range(count):
            mujoco.mj_step(model, data)
        return np.array(data.qpos), (time.perf_counter() - begin) / end

    file_step, integrator = model.opt.timestep, model.opt.integrator
    usual, seconds = min((step(file_step) for _ in range(3)), key=lambda one: one[1])
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    fine, _ = step(file_step / 50)
    model.opt.integrator = integrator
    scene = scene_of(path, model, start, control, end)
    reference, _ = run(scene, model, "--integrator", "dop853", "--rtol", "1e-12", "--atol", "1e-13")
    found, generated = run(scene, model, "--generated")
    _, generic = run(scene, model)
    return [model.nv, difference(model, reference, fine), generic, (difference(model, reference, usual), seconds), (difference(model, reference, found), generated)]


def difference(model, one, other):
    import mujoco
    import numpy as np

    out = np.zeros(model.nv)
    mujoco.mj_differentiatePos(model, out, 1.0, one, other)
    return float(np.abs(out).max()) if len(out) else 0.0


def order(model):
    """Of each number of q here its place in MuJoCo's qpos: quaternions are (x, y, z, w) here, (w, x, y, z) there."""
    places = []
    for joint in range(model.njnt):
        first, kind = model.jnt_qposadr[joint], model.jnt_type[joint]
        if kind > BALL:
            places.append(first)
        else:
            places += [] if kind == BALL else [first, first + 1, first + 2]
            at = first if kind == BALL else first + 3
            places += [at + 1, at + 2, at + 3, at]
    return places


def scene_of(path, model, start, control, end):
    """The scene that the command makes of the file, with this start and these controls."""
    import re

    printed = subprocess.run([str(COMMAND), "simulate", str(path), "--print-scene", "--smooth"], capture_output=True, text=True)
    if printed.returncode:
        raise RuntimeError(printed.stderr)
    text = re.sub(r"^file = .*$", f"file = {json.dumps(str(path))}", printed.stdout, flags=re.MULTILINE)
    text = re.sub(r"^ctrl\..*\n", "", re.sub(r"^end = .*$", f"end = {end!r}\noutput = \"ends\"", text, flags=re.MULTILINE), flags=re.MULTILINE)
    initial = f"[initial]\nq = {[float(start[place]) for place in order(model)]}\n"
    text = text.replace("[initial]\n", initial) if "[initial]" in text else text.replace("[simulation]", initial + "\n[simulation]")
    return text.replace('kind = "actuators"', f'kind = "actuators"\nctrl = {[float(u) for u in control]}')


def run(scene, model, *options):
    """The coordinates at the end, in MuJoCo's order, and seconds a simulated second."""
    import numpy as np

    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scene.toml"
        file.write_text(scene)
        command = [str(COMMAND), "simulate", str(file), "--format", "json", "-o", folder, *options]
        runs = [subprocess.run(command, capture_output=True, text=True) for _ in range(1 if options else 3)]
        if runs[0].returncode not in (0, 5):
            raise RuntimeError(next((line for line in runs[0].stderr.splitlines() if "error" in line), runs[0].stderr))
        with open(Path(folder) / "recording.csv", newline="") as opened:
            rows = list(csv.reader(opened))
        seconds = min(1 / json.loads(one.stdout)["simulated_s_per_wall_s"] for one in runs)
    last = [float(x) for name, x in zip(rows[0], rows[-1]) if name.startswith("q.")]
    q = np.zeros(model.nq)
    q[order(model)] = last
    return q, seconds


if __name__ == "__main__":
    main()
