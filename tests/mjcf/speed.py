#!/usr/bin/env python3
"""Times generated steps beside MuJoCo's mj_step: one process, one core, the same states and controls, without constraints.

    python3 tests/mjcf/speed.py                        the models of MODELS, from the pinned packages
    python3 tests/mjcf/speed.py --file F.xml …         these files
    python3 tests/mjcf/speed.py --accuracy [F.xml]     error and time of each method at several steps
    python3 tests/mjcf/speed.py --check                whether generated steps of CHECKED agree with MuJoCo, by each method
    python3 tests/mjcf/speed.py --write                the tables of docs/steps.md, and a record beside those of docs/speed

speed.rs is compiled for this processor with the generated code of each model, and linked with the library of MuJoCo's wheel. It rolls
STATES random states by STEPS steps with mj_step, with the step alone, and with the step in vectors of f64 and of f32, in turns; a number
is the median of the rounds, ns a step. Generated code translates states from MuJoCo's conventions and back. `mujoco.batch` of Python, on one thread, is timed afterwards.

The ends are compared: f64 to 1e-11, f32 to 1e-4 of 1 and the largest rate. Exit status: 0 if all agree, else 1.
"""

import argparse
import datetime
import json
import platform
import sys
import tempfile
import time
from pathlib import Path

from linked import build, run
from oracle import HERE, enter, packages
from programs import COMMAND, REPOSITORY
from steps import random_starts, smooth

# A package and a file of it, and the method of the file.
MODELS = [
    ("gymnasium", "half_cheetah.xml", "Euler"),
    ("gymnasium", "walker2d_v5.xml", "RK4"),
    ("gymnasium", "ant.xml", "RK4"),
    ("gymnasium", "humanoid.xml", "RK4"),
    ("gymnasium", "humanoid.xml", "Euler"),
    ("openarm-mujoco", "openarm_bimanual.xml", "implicitfast"),
    ("robosuite", "robots/panda/robot.xml", "Euler"),
    ("robosuite", "robots/ur5e/robot.xml", "Euler"),
    ("envpool", "unitree_g1/g1_mjx.xml", "Euler"),
]
METHODS = {"Euler": "implicit_damping", "implicitfast": "implicit_velocity", "RK4": "rk4_mujoco"}
# Of --check: models with limbs, parallel joints, free joints, and every kind of actuator.
CHECKED = [HERE / "models" / "actuated.xml", HERE / "models" / "drone.xml", HERE / "models" / "spatial.xml", ("gymnasium", "half_cheetah.xml"), ("gymnasium", "ant.xml")]
STATES, STEPS, ROUNDS = 64, 20, 31
F64, F32 = 1e-11, 1e-4
# Of --accuracy: the motion, s, and the steps in it.
MOTION, COUNTS, BESIDE = 0.5, [50, 100, 250, 1000], 32
WAYS = [
    ("semi_implicit_euler", None), ("implicit_damping", "Euler"), ("implicit_velocity", "implicitfast"), ("lie_midpoint", None), ("rk4", None),
    ("rk4_mujoco", "RK4"),
]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--file", nargs="+", help="only these files, by the method that they name")
    parser.add_argument("--accuracy", nargs="?", const="", metavar="FILE", help="error against time, of this file [default: Gymnasium's half_cheetah]")
    parser.add_argument("--check", action="store_true", help="compare motions, without a clock")
    parser.add_argument("--write", action="store_true", help="write both tables")
    arguments = parser.parse_args()
    enter("dynamics")
    if arguments.check:
        sys.exit(not check())
    agree = True
    if arguments.accuracy is None or arguments.write:
        rows = []
        wanted = [(Path(file), None) for file in arguments.file] if arguments.file else ours()
        print(HEADER, flush=True)
        for path, integrator in wanted:
            row = timed(path, integrator)
            agree &= row["f64 differs"] < F64 and row["f32 differs"] < F32
            rows.append(row)
            print(line(row), flush=True)
    if arguments.accuracy is not None or arguments.write:
        path = Path(arguments.accuracy) if arguments.accuracy else next(ours())[0]
        curves = accuracy(path)
        print(table(curves))
    if arguments.write:
        write(rows, curves)
    sys.exit(not agree)


HEADER = """| model | freedoms, actuators | method | `mj_step` | `mujoco.batch` | alone | vectors f64 | vectors f32 |
|---|--:|---|--:|--:|--:|--:|--:|"""


def line(row):
    mujoco, batch, single, f64, f32 = row["ns"]
    ratio = lambda own: f"{own:.3g} ({mujoco / own:.0f})"  # noqa: E731
    return f"| {row['model']} | {row['nv']}, {row['nu']} | {row['method']} | {mujoco:.0f} | {batch:.0f} | {ratio(single)} | {ratio(f64)} | {ratio(f32)} |"


def ours():
    """Paths of MODELS, and methods."""
    for package, name, integrator in MODELS:
        yield in_package(package, name), integrator


def in_package(package, name):
    """The path of a file of a package: a name, or its beginning if no other has it."""
    found = list(packages(argparse.Namespace(sample=False, only=package)))
    folder = next((folder for full, folder in found if full.startswith(package + "==")), found[0][1])
    return next(path for path in sorted(folder.rglob(Path(name).name)) if str(path).endswith(name))


def check():
    """Whether generated steps move as MuJoCo's: of each method on each model of CHECKED."""
    agree = True
    for one in CHECKED:
        path = one if isinstance(one, Path) else in_package(*one)
        for integrator in METHODS:
            _, ours, _ = compared(path, integrator, 1)
            text = ", ".join(f"{name} {far:.1e}" for name, far in zip(("alone", "vectors f64", "vectors f32"), ours))
            print(f"{path.name:20}{integrator:14}{text}", flush=True)
            agree &= all(far < bound for far, bound in zip(ours, (F64, F64, F32)))
    return agree


def own_method(path):
    """The method that a file names."""
    import mujoco

    kinds = {mujoco.mjtIntegrator.mjINT_RK4: "RK4", mujoco.mjtIntegrator.mjINT_IMPLICITFAST: "implicitfast"}
    return kinds.get(mujoco.MjSpec.from_file(str(path)).option.integrator, "Euler")


class Program:
    """speed.rs with the step of a robot."""

    def __init__(self, path, method, folder, constrained=False):
        actuated = json.loads(run(COMMAND, "rollout", path, "--steps", "1", "--format", "json")).get("actuators", [])
        if not actuated and not constrained:
            raise RuntimeError(f"{path.name}: found no actuators, expected one at least")
        kind, own, cfg = "actuated", [], []
        if constrained:
            kind, own, cfg = "constrained", ["--leave-out", "constraint,solver"], ["--cfg", "constrained"]
        functions = f"step = {kind}_step_{method}, mujoco"
        self.file = build(path, "speed.rs", folder, functions, "--batch", "f64,f32", *own, units=1, cfg=cfg)
        self.folder = folder

    def rolled(self, prepared, starts, steps, rounds, h):
        """Medians, ns a step, and the ends (qpos, qvel, act) of MuJoCo, of the step alone, and of vectors of f64 and f32."""
        import mujoco
        import numpy as np

        model, _, controls, states = prepared
        model.opt.timestep = h
        mujoco.mj_saveModel(model, str(self.folder / "model.mjb"), None)
        contents = [getattr(mujoco.mjtState, f"mjSTATE_{name}") for name in ("QPOS", "QVEL", "ACT", "CTRL")]
        parts = sum(map(int, contents))
        numbers = [part for q, v, _, act, ctrl in starts for part in (q, v, act, ctrl, q, v, act[states], ctrl[controls])]
        (self.folder / "starts").write_bytes(np.concatenate(numbers).astype("<f8").tobytes())
        words = ["model.mjb", "starts", "ends", len(starts), steps, rounds, repr(float(h)), parts]
        medians = json.loads(run(self.file, *words, cwd=self.folder))
        numbers, ends, at = np.fromfile(self.folder / "ends", "<f8"), [], 0

        def take(count):
            nonlocal at
            at += count
            return numbers[at - count : at]

        theirs = []
        for _ in starts:
            theirs.append((take(model.nq), take(model.nv), take(model.na)))
            take(model.nu)
        ends.append(theirs)
        for _ in range(3):
            own = []
            for _ in starts:
                q, v, act = take(model.nq), take(model.nv), np.zeros(model.na)
                act[states] = take(len(states))
                own.append((q, v, act))
            ends.append(own)
        return medians, ends


def apart(model, states, one, other):
    """The largest difference over 1 and the largest rate."""
    import mujoco
    import numpy as np

    way = np.zeros(model.nv)
    mujoco.mj_differentiatePos(model, way, 1.0, one[0], other[0])
    parts = np.concatenate([way, one[1] - other[1], (one[2] - other[2])[states]])
    return float(np.abs(parts).max()) / (1 + float(np.abs(other[1]).max()))


def compared(path, integrator, rounds):
    """Medians, the largest difference of the three forms of ours, and (model, names of actuators, starts)."""
    import numpy as np

    prepared = smooth(path, integrator)
    model, own, _, states = prepared
    starts = list(random_starts(prepared, np.random.default_rng(7), STATES, 0.3))
    with tempfile.TemporaryDirectory() as folder:
        program = Program(path, METHODS[integrator], Path(folder))
        medians, (theirs, *ours) = program.rolled(prepared, starts, STEPS, rounds, model.opt.timestep)
    return medians, [float(np.max([apart(model, states, a, b) for a, b in zip(one, theirs)])) for one in ours], (model, own, starts)


def timed(path, integrator):
    """A row of the table."""
    import numpy as np

    integrator = integrator or own_method(path)
    medians, differs, (model, own, starts) = compared(path, integrator, ROUNDS)
    return {
        "model": path.stem if path.stem != "robot" else path.parent.name, "nv": model.nv, "nu": len(own), "method": integrator,
        "step": model.opt.timestep, "ns": [medians[0], batch(model, starts), *medians[1:]], "f64 differs": float(np.max(differs[:2])), "f32 differs": differs[2],
    }


def batch(model, starts):
    """The median time of a step of mujoco.batch on one thread, ns."""
    import mujoco.batch
    import numpy as np

    simulations, times = mujoco.batch.Batch(model, len(starts), nthread=1, persistent=True), []
    for _ in range(ROUNDS):
        simulations.reset()
        simulations.qpos[:], simulations.qvel[:], simulations.ctrl[:] = (np.array([start[k] for start in starts]) for k in (0, 1, 4))
        clock = time.perf_counter()
        simulations.step(nstep=STEPS)
        times.append((time.perf_counter() - clock) * 1e9 / (STEPS * len(starts)))
    return float(np.median(times))


def accuracy(path):
    """Rows (method, steps a second, errors and ns of a simulated second of ours, in f64 and f32, and of MuJoCo)."""
    import numpy as np

    prepared = smooth(path, "RK4")
    model, _, _, states = prepared
    starts, rows = list(random_starts(prepared, np.random.default_rng(7), BESIDE, 0.3)), []

    def errors(ends, reference):
        return float(np.median([apart(model, states, a, b) for a, b in zip(ends, reference)]))

    with tempfile.TemporaryDirectory() as folder:
        programs = {}
        for method, _ in WAYS:
            place = Path(folder, method)
            place.mkdir()
            programs[method] = Program(path, method, place)
        many = 20 * COUNTS[-1]
        _, (theirs, reference, *_) = programs["rk4_mujoco"].rolled(prepared, starts, many, 1, MOTION / many)
        print(f"{path.stem}: {MOTION} s; MuJoCo's RK4 and ours at {many} steps differ by {errors(theirs, reference):.1e}", flush=True)
        for method, integrator in WAYS:
            prepared = smooth(path, integrator or "RK4")
            for count in COUNTS:
                h = MOTION / count
                medians, ends = programs[method].rolled(prepared, starts, count, 5, h)
                found = [errors(one, reference) for one in ends]
                rows.append({
                    "method": method, "steps": round(count / MOTION), "errors": [found[1], found[3]], "ns": [medians[1] / h, medians[2] / h, medians[3] / h],
                    **({"mujoco": integrator, "mujoco error": found[0], "mujoco ns": medians[0] / h} if integrator else {}),
                })
    return {"model": path.stem, "motion": MOTION, "rows": rows}


def table(curves):
    lines = [
        "| method | steps a second | error f64 | f32 | alone, µs | vectors f64 | vectors f32 | `mj_step`: error | µs |",
        "|---|--:|--:|--:|--:|--:|--:|--:|--:|",
    ]
    for row in curves["rows"]:
        theirs = f"{row['mujoco error']:.1e} | {row['mujoco ns'] / 1e3:.0f}" if "mujoco" in row else "|"
        times = " | ".join(f"{ns / 1e3:.3g}" for ns in row["ns"])
        lines.append(f"| `step_{row['method']}` | {row['steps']} | {row['errors'][0]:.1e} | {row['errors'][1]:.1e} | {times} | {theirs} |")
    return "\n".join(lines)


def write(rows, curves):
    """The tables of docs/steps.md, between their marks, and the record."""
    import mujoco

    names = [line for line in Path("/proc/cpuinfo").read_text().splitlines() if line.startswith("model name")] if Path("/proc/cpuinfo").exists() else []
    processor = names[0].partition(":")[2].strip() if names else platform.processor()
    date = datetime.date.today().isoformat()
    record = {"date": date, "processor": processor, "mujoco": mujoco.__version__, "rustc": run("rustc", "--version").strip(), "speed": rows, "accuracy": curves}
    name = f"steps-{date}-{'-'.join(processor.lower().split()[:2])}.json"
    (REPOSITORY / "docs" / "speed" / name).write_text(json.dumps(record, indent=1) + "\n")
    page = REPOSITORY / "docs" / "steps.md"
    text = page.read_text()
    for mark, lines in (("steps", "\n".join([HEADER, *map(line, rows)])), ("accuracy", table(curves))):
        before, start, rest = text.partition(f"<!-- {mark}: {'speed.py'} -->\n")
        _, end, after = rest.partition("<!-- end -->")
        if not (start and end):
            raise RuntimeError(f"docs/steps.md: found no mark {mark}")
        text = before + start + lines + "\n" + end + after
    page.write_text(text)


if __name__ == "__main__":
    main()
