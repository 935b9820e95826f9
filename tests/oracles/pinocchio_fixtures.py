#!/usr/bin/env python3
"""Writes tests/fixtures: what Pinocchio, and for some robots MuJoCo, give for every function that they have.

    python3 tests/oracles/pinocchio_fixtures.py [robot...]

Not part of the checks: the output is kept, with the versions that made it. Installs pin, mujoco and numpy into
<repository>/target/fixtures-venv where they are missing. Writes nothing that fails `engines/checks.py`.
"""

import json
import os
import subprocess
import sys
import zlib
from pathlib import Path

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parent.parent
FIXTURES = REPOSITORY / "tests" / "fixtures"
PACKAGES = ["pin", "mujoco", "numpy"]
DEFINITIONS = 1e-8  # what the differences of checks.py may be off, relative to the largest entry
ENGINES = 1e-12  # what Pinocchio and MuJoCo may differ, likewise

BUNDLED = [("simple_pendulum", False), ("cart_pole", False), ("ur5_like", False), ("panda_like", False), ("gripper_arm", False),
           ("quadruped", True), ("golfer", True), ("humanoid", True)]
OWN = [
    # name              floating  joints                                                            gravity
    ("planar_cart", False, ["planar", "revolute", "prismatic"], [0.0, 0.0, -9.81]),
    ("spherical_chain", False, ["spherical", "revolute", "spherical"], [0.0, 0.0, -9.81]),
    ("rails", True, ["prismatic", "revolute", "fixed", "prismatic", "continuous"], [1.0, -2.0, -9.0]),
    ("every_joint", False,
     ["revolute", "prismatic", "floating", "spherical", "planar", "mimic", "helical", "universal", "fixed", "continuous"], [0.5, 1.5, -9.5]),
    ("every_joint_floating", True,
     ["universal", "helical", "mimic", "fixed", "planar", "revolute", "spherical", "prismatic", "mimic"], [-1.0, 2.0, -9.0]),
]
MUJOCO = ["ur5_like", "panda_like", "quadruped"]

# Functions for the large robots; the others would be megabytes.
LARGE = ["golfer", "humanoid", "every_joint_floating"]
FEW = ["placements", "accelerations_world_aligned", "inverse_dynamics", "inverse_dynamics_with_wrenches",
       "joint_wrenches", "forward_dynamics", "solve_mass_matrix", "center_of_mass", "center_of_mass_acceleration",
       "centroidal_momentum_rate", "kinetic_energy", "potential_energy", "integrate", "difference", "static_torque"]
ALSO_ONCE = ["operational_space_inertia", "coriolis_matrix"]  # and derivatives, of those that are not the largest
ONCE = 40  # numbers: larger results of a robot with more than three degrees of freedom are kept in one state


def ensure_packages():
    """Runs this script again in a virtual environment of its own, made on the way, unless all packages are at hand."""
    try:
        import mujoco, numpy, pinocchio  # noqa: F401, E401
        return
    except ImportError:
        pass
    environment = REPOSITORY / "target" / "fixtures-venv"
    python = environment / "bin" / "python"
    if Path(sys.prefix) != environment and not python.exists():
        subprocess.check_call([sys.executable, "-m", "venv", environment])
    subprocess.check_call([python, "-m", "pip", "install", "--quiet", *PACKAGES])
    os.execv(python, [str(python), *sys.argv])


def robots():
    from engines import tree as trees
    from states import SplitMix64

    for name, floating in BUNDLED:
        yield trees.read(REPOSITORY / "models" / "urdf" / f"{name}.urdf"), floating, [0.0, 0.0, -9.81], True
    for name, floating, kinds, gravity in OWN:
        yield trees.drawn(name, SplitMix64(name), kinds), floating, gravity, False


def draw(engine, random, turn):
    """Coordinates within limits; `turn`: the quaternion of the first joint that has one."""
    from engines import tree as trees
    from states import bounds

    q = []
    for name in engine.joints:
        kind = "floating" if name == trees.FLOATING_BASE else next(j.kind for j in engine.tree.joints if j.name == name)
        if kind in ("floating", "planar"):
            q += [random.between(-1, 1) for _ in range(3 if kind == "floating" else 2)]
        if kind in ("floating", "spherical"):
            q += turn or random.unit_quaternion()
            turn = None
        elif kind in ("helical", "universal", "planar"):
            q += [random.between(-3, 3) for _ in range(2 if kind == "universal" else 1)]
        else:
            q.append(random.between(*bounds(next(j for j in engine.tree.joints if j.name == name))[:2]))
    return q


# Neutral; half a turn about x; about an axis between x and y; anywhere.
TURNS = [[0.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 0.0], [0.6, 0.8, 0.0, 0.0], None]
REFERENCES = ["body", "world", "world_aligned", "body"]


def states(engine, name):
    """State 0 steps nowhere, state 1 hardly."""
    from states import SplitMix64

    random, leaves = SplitMix64(f"{name}, engines"), leaf_first(engine.tree)
    vector = lambda n, size: [random.between(-size, size) for _ in range(n)]
    for index, (turn, reference) in enumerate(zip(TURNS, REFERENCES)):
        q = draw(engine, random, turn)
        if index == 0 and turn:
            q = neutral(engine, q)
        frames = [[leaves[0]], leaves[:2], [engine.tree.root, *leaves[:1]], leaves[1:3] or leaves[:1]][index]
        size = [0.0, 1e-7, 1.0, 1.5][index]
        step = [size * x for x in vector(engine.nv, 1)]
        yield {
            "q": q, "v": vector(engine.nv, 2), "a": vector(engine.nv, 3), "tau": vector(engine.nv, 5), "step": step,
            "target": [float(x) for x in engine.integrate(q, step)] if index < 2 else draw(engine, random, None),
            "frames": frames, "wrench_reference": reference, "wrenches": vector(6 * len(frames), 10),
        }


def neutral(engine, q):
    """Free joints at the identity, others where they are."""
    import pinocchio

    full = pinocchio.neutral(engine.model)
    for e, at, nq, _, _ in engine._parts():
        if nq == 7:
            q[e.q : e.q + 7] = full[at : at + 7].tolist()
    return q


def leaf_first(tree):
    """Names of links, tips before those that carry something, the last of the file first."""
    carrying = {joint.parent for joint in tree.joints}
    names = [joint.child for joint in reversed(tree.visits())]
    return sorted(names, key=lambda name: name in carrying) or [tree.root]


def keep(engine, index, name, array):
    """Whether a result is written in this state."""
    import numpy

    if engine.tree.name in LARGE:
        once = name in ALSO_ONCE or name == "inverse_dynamics_derivatives" and engine.nv < 30
        return (name in FEW and index > 0) or (once and index == 3)
    if engine.tree.name == "quadruped" and name.endswith("derivatives_with_wrenches"):
        return False
    small = numpy.size(array) <= ONCE or name == "operational_space_inertia"
    return engine.nv <= 3 or small or index == 1 + zlib.crc32(name.encode()) % 3


def numbers(array):
    """Flat, row by row, in digits that read back exactly; zeros short."""
    import numpy

    return [float(x) if x else 0 for x in numpy.ravel(array).tolist()]


def write(name, engine, entries, versions, file):
    base = "floating" if engine.floating else "fixed"
    head = {"robot": name, "engine": versions, "base": base, "gravity": list(engine.model.gravity.linear), "joints": engine.joints,
            "links": engine.links, "nq": engine.nq, "nv": engine.nv}
    own = [key for key, *_ in OWN]
    if name in own:
        head["description"] = engine.tree.description()
    line = lambda value: json.dumps(value, allow_nan=False, separators=(",", ":"))
    lines = [f" {line(key)}: {line(value)}," for key, value in head.items()]
    blocks = []
    for state, results in entries:
        inside = [f"   {line(key)}: {line(value)}" for key, value in state.items()]
        inner = ",\n".join(f"    {line(key)}: {line(numbers(value))}" for key, value in sorted(results.items()))
        blocks.append("  {\n" + ",\n".join(inside) + ',\n   "results": {\n' + inner + "\n   }\n  }")
    FIXTURES.mkdir(exist_ok=True)
    (FIXTURES / file).write_text("{\n" + "\n".join(lines) + '\n "states": [\n' + ",\n".join(blocks) + "\n ]\n}\n")
    return (FIXTURES / file).stat().st_size


def main():
    ensure_packages()
    sys.path.insert(0, str(HERE))
    import mujoco
    import numpy
    import pinocchio

    from engines import checks, mujoco_engine
    from engines.pinocchio_engine import Engine
    from engines.results import results

    wanted, failed, total = sys.argv[1:], False, 0
    for tree, floating, gravity, _ in robots():
        if wanted and tree.name not in wanted:
            continue
        engine, worst, entries, second = Engine(tree, floating, gravity), {}, [], []
        other = mujoco_engine.Engine(tree, engine, gravity) if tree.name in MUJOCO else None
        apart = 0.0
        for index, state in enumerate(states(engine, tree.name)):
            out = results(engine, state)
            for key, error in checks.errors(engine, state, out).items():
                worst[key] = max(worst.get(key, 0.0), error)
            entries.append((state, {key: value for key, value in out.items() if keep(engine, index, key, value)}))
            if other:
                theirs = other.results(state)
                for key, value in theirs.items():
                    error = abs(numpy.array(value) - out[key]).max() / max(1.0, abs(numpy.array(out[key])).max())
                    apart = max(apart, error)
                    if error > ENGINES:
                        print(f"  {tree.name}, state {index}: {key} of the engines differ by {error:.1e}")
                second.append((state, {key: value for key, value in theirs.items() if keep(engine, index, key, value)}))
        bad = {key: f"{error:.1e}" for key, error in worst.items() if not error <= DEFINITIONS}
        print(f"{tree.name}: definitions to {max(worst.values()):.1e}, engines to {apart:.1e}", bad or "")
        if bad or apart > ENGINES:
            failed = True
            continue
        total += write(tree.name, engine, entries, f"pinocchio {pinocchio.__version__}, numpy {numpy.__version__}", f"{tree.name}.json")
        if other:
            total += write(tree.name, engine, second, f"mujoco {mujoco.__version__}", f"{tree.name}.mujoco.json")
    print(f"{total // 1024} kB written")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
