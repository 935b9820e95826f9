"""Programs of generated code that are linked with the library of MuJoCo's wheel: speed.rs, gradients.rs and stages.rs."""

import json
import os
import subprocess
import tempfile
from pathlib import Path

from oracle import HERE
from programs import COMMAND


def run(*words, **options):
    """What a program prints. Its message is an error if it fails."""
    done = subprocess.run(list(map(str, words)), capture_output=True, text=True, **options)
    if done.returncode:
        raise RuntimeError(f"{Path(str(words[0])).name}: {done.stderr[-2000:]}")
    return done.stdout


def build(path, source, folder, functions, *options, units=16, cfg=()):
    """A program of this folder's file `source` with functions generated of a model, for this processor: its path in `folder`."""
    import mujoco

    shared = next(Path(mujoco.__file__).parent.glob("libmujoco.so*"))
    code, program = folder / "generated.rs", folder / Path(source).stem
    run(COMMAND, "generate", path, "--effects", "file", "--functions", functions, "-o", code, *options)
    run(
        "rustc", *cfg, "--edition", "2024", "-C", "opt-level=3", "-C", f"codegen-units={units}", "-C", "target-cpu=native", HERE / source, "-o", program,
        "-C", f"link-arg={shared}", "-C", f"link-arg=-Wl,-rpath,{shared.parent}", env={**os.environ, "GENERATED": str(code)},
    )
    return program


def timed(path, source, functions, prepared, starts, rounds, *options):
    """Medians of a program that steps with constraints from these starts, and the numbers that it leaves."""
    import mujoco
    import numpy as np

    model, _, controls, states = prepared
    contents = [getattr(mujoco.mjtState, f"mjSTATE_{name}") for name in ("QPOS", "QVEL", "ACT", "CTRL")]
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        program = build(path, source, folder, functions, "--leave-out", "constraint,solver", *options)
        mujoco.mj_saveModel(model, str(folder / "model.mjb"), None)
        numbers = [part for q, v, _, act, ctrl in starts for part in (q, v, act, ctrl, q, v, act[states], ctrl[controls])]
        (folder / "starts").write_bytes(np.concatenate(numbers).astype("<f8").tobytes())
        words = ["model.mjb", "starts", "ends", len(starts), rounds, repr(float(model.opt.timestep)), sum(map(int, contents))]
        medians = json.loads(run(program, *words, cwd=folder))
        return medians, np.fromfile(folder / "ends", "<f8")
