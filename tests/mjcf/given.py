#!/usr/bin/env python3
"""Contacts that a caller finds: generated C with the contacts of MuJoCo's own detection of meshes and ellipsoids, beside its accelerations.

    python3 tests/mjcf/given.py

models/given.xml falls on its floor in MuJoCo. In each state the contacts of `mj_forward` are the argument `contacts` of
`constrained_acceleration_with_contacts`, and its result is compared with qacc. MuJoCo's solver is Newton's method without a tolerance.

Exit status: 0 if all states differ by at most 1e-10 of the largest acceleration, and 30 have contacts, else 1.
"""

import ctypes
import subprocess
import sys
import tempfile
from pathlib import Path

from contact import prepare
from oracle import HERE, enter
from programs import COMMAND
from steps import order, parts, rotation, to_own

MODEL = HERE / "models" / "given.xml"
PAIRS = [("floor", "gem"), ("floor", "egg"), ("floor", "block"), ("step", "gem"), ("step", "egg"), ("step", "block"), ("gem", "egg"), ("gem", "block")]
PLACES = 8
STATES, APART, BOUND = 60, 12, 1e-10


def main():
    enter("dynamics")
    import mujoco
    import numpy as np

    # With exact principal axes of the meshes
    model, *_ = prepare(MODEL, "Euler")
    model.opt.tolerance, model.opt.iterations, model.opt.ls_tolerance, model.opt.ls_iterations = 0, 100, 1e-14, 100
    data = mujoco.MjData(model)
    with tempfile.TemporaryDirectory() as folder:
        call = compiled(Path(folder), model.nv)
        worst, most, touching = 0.0, 0, 0
        for k in range(STATES):
            for _ in range(APART):
                mujoco.mj_step(model, data)
            mujoco.mj_forward(model, data)
            contacts, count = found(model, data)
            q = np.array([data.qpos[place] for place in order(model)])
            own = call(q, np.array(to_own(model, data.qpos, data.qvel)), contacts)
            # v̇ = Rᵀ d²p/dt² − ω × v of a free joint
            theirs = np.array(to_own(model, data.qpos, data.qacc))
            for kind, place, at, first in parts(model):
                if kind == 0:
                    turn = rotation(data.qpos[place + 3 : place + 7])
                    theirs[first + 3 : first + 6] -= np.cross(data.qvel[at + 3 : at + 6], turn.T @ data.qvel[at : at + 3])
            worst = max(worst, float(np.abs(own - theirs).max()) / max(1.0, float(np.abs(theirs).max())))
            most, touching = max(most, count), touching + (count > 0)
    print(f"given.xml: {touching} of {STATES} states with contacts, {most} at most; accelerations differ by {worst:.1e} at most")
    sys.exit(not (worst <= BOUND and touching >= 30))


def found(model, data):
    """MuJoCo's contacts as the argument, and how many they are."""
    import numpy as np

    contacts, used = np.zeros((len(PAIRS), PLACES, 8)), [0] * len(PAIRS)
    for contact in data.contact:
        names = tuple(model.geom(geom).name for geom in contact.geom)
        # Normals are from the first geom of the pair to the second.
        forward = names in PAIRS
        pair = PAIRS.index(names if forward else names[::-1])
        normal = np.array(contact.frame[:3]) * (1 if forward else -1)
        contacts[pair, used[pair]] = [1.0, contact.dist, *contact.pos, *normal]
        used[pair] += 1
    return contacts, sum(used)


def compiled(folder, nv):
    """The function in C, by the system's compiler."""
    import numpy as np

    words = [str(COMMAND), "generate", str(MODEL), "--effects", "file", "--target", "c", "--functions", "constrained_acceleration_with_contacts"]
    for first, second in PAIRS:
        words += ["--given-contact", f"{first},{second},{PLACES}"]
    done = subprocess.run([*words, "-o", str(folder / "given")], capture_output=True, text=True)
    if done.returncode:
        sys.exit(done.stderr)
    sources = [str(path) for path in (folder / "given").rglob("*.c")] if (folder / "given").is_dir() else [str(folder / "given")]
    subprocess.run(["cc", "-O1", "-shared", "-fPIC", *sources, "-o", str(folder / "given.so"), "-lm"], check=True)
    function = ctypes.CDLL(str(folder / "given.so")).given_constrained_acceleration_with_contacts
    function.restype = None

    def call(q, v, contacts):
        out, warm, none = np.zeros(nv), np.zeros(nv), np.zeros(1)
        given = [q, v, none, none, np.ascontiguousarray(contacts), warm, out]
        function(*(array.ctypes.data_as(ctypes.POINTER(ctypes.c_double)) for array in given))
        return out

    return call


if __name__ == "__main__":
    main()
