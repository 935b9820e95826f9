#!/usr/bin/env python3
"""Compares a step of two shapes that touch with mj_step: each kind of pair in random places.

    python3 tests/mjcf/pairs.py                 the table below, of 12 pairs of sizes and 300 states of each
    python3 tests/mjcf/pairs.py --states N      so many states of each pair of sizes
    python3 tests/mjcf/pairs.py --check         3 pairs of sizes and 40 states

Every fourth state is aligned: axes are parallel, faces lie on each other; but not of a capsule and a box, where signs of zeros then
decide which points MuJoCo takes. States without a contact are left out. "one step" is the largest difference of rates after a step,
over 1 and the largest rate.

Exit status: 0 if each step differs by at most 1e-10, else 1.
"""

import argparse
import sys
import tempfile
from pathlib import Path

from contact import COMPUTED, ONE_STEP, prepare
from oracle import enter
from speed import apart
from steps import rolled


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--states", type=int, default=300, help="states of each pair of sizes [default: 300]")
    parser.add_argument("--check", action="store_true", help="fewer of both")
    arguments = parser.parse_args()
    enter("dynamics")
    import numpy as np

    sizes, count = (3, 40) if arguments.check else (12, arguments.states)
    worst = 0.0
    print(f"{'pair':20}{'states':>8}{'most contacts':>15}{'median':>10}{'one step':>10}")
    for pair in COMPUTED:
        random = np.random.default_rng(3)
        rows = [row for _ in range(sizes) for row in measure(pair, count, random)]
        differences = np.array([difference for difference, _ in rows])
        worst = max(worst, differences.max())
        print(
            f"{' x '.join(pair):20}{len(rows):8}{max(contacts for _, contacts in rows):15}{np.median(differences):10.1e}{differences.max():10.1e}",
            flush=True,
        )
    sys.exit(not worst <= ONE_STEP)


def geom(kind, random):
    size = {"plane": [1, 1, 1], "sphere": random.uniform(0.05, 0.15, 1), "box": random.uniform(0.05, 0.3, 3), "ellipsoid": random.uniform(0.05, 0.3, 3)}
    size = size.get(kind, [random.uniform(0.03, 0.15), random.uniform(0.05, 0.4)])
    return f'<geom type="{kind}" size="{" ".join(map(repr, map(float, size)))}"/>'


def measure(pair, count, random):
    """The difference after a step and the number of contacts, of states with contacts."""
    import mujoco
    import numpy as np

    bodies = "".join(
        geom(kind, random) if kind == "plane" else f"<body><freejoint/>{geom(kind, random)}</body>" for kind in pair
    )
    cone = random.choice(["elliptic", "pyramidal"])
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "pair.xml"
        path.write_text(f'<mujoco><option gravity="0 0 0" cone="{cone}"/><worldbody>{bodies}</worldbody></mujoco>')
        prepared = prepare(path, "Euler")
        model, _, controls, places = prepared
        model.opt.tolerance, model.opt.ls_tolerance = 0, 1e-14
        model.opt.iterations, model.opt.ls_iterations = 100, 100
        data, starts, ends, contacts = mujoco.MjData(model), [], [], []
        for k in range(count):
            mujoco.mj_resetData(model, data)
            for first in range(0, model.nq, 7):
                data.qpos[first : first + 3] = random.uniform(-0.2, 0.2, 3)
                data.qpos[first + 3 : first + 7] = turn(random, k % 4 == 0 and pair != ("capsule", "box"))
            data.qvel[:] = random.uniform(-1, 1, model.nv)
            start = data.qpos.copy(), data.qvel.copy(), np.zeros(model.nv), np.zeros(0), np.zeros(0)
            mujoco.mj_step(model, data)
            if data.ncon:
                starts.append(start)
                contacts.append(data.ncon)
                ends.append((data.qpos.copy(), data.qvel.copy(), np.zeros(0)))
        if not starts:
            return []
        own = rolled(path, model, (places, controls), starts, "Euler", 1, "--constraints")
        return [(apart(model, places, one, end), found) for one, end, found in zip(own, ends, contacts)]


def turn(random, is_aligned):
    """A random quaternion; an aligned one has turns by quarters."""
    import numpy as np

    four = random.normal(size=4)
    if is_aligned:
        four = np.array([1.0, 0.0, 0.0, 0.0])
        four[random.integers(1, 4)] = random.choice([-1.0, 0.0, 1.0])
    return four / np.linalg.norm(four)


if __name__ == "__main__":
    main()
