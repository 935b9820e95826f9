#!/usr/bin/env python3
"""Reads SDF files with Drake and with this library, and compares masses, limits and dynamics.

    python3 tests/sdf/oracle.py               the files here and those of packages.txt (0.2 GB of downloads)
    python3 tests/sdf/oracle.py --sample      the files here and Drake's own, as the checks do
    python3 tests/sdf/oracle.py --file F.sdf  one file
    python3 tests/sdf/oracle.py --write       also records the verdicts in docs/site/data/sdf.json, and their summary in docs/sdf.md

For each file that Drake reads: masses, centres of mass and inertias of all links, limits and damping of all joints with one
coordinate, and in random states the mass matrix, the bias force (inverse dynamics without acceleration), and positions and
orientations of all links, as `articulated eval` prints them. An example program prints what no command prints of the file,
and compares inverse dynamics with its regressor.

A file with loops is read without the joints that close them: Drake gets it without these joints, this library with
<must_be_loop_joint> in each of them. A link with an inertia that SDFormat does not allow is 1 kg in Drake: both get the
file without its <inertial>.

Drake goes into a virtual environment in target/sdf, with the versions of requirements.txt; other packages are downloaded,
not installed. Exit status: 0 if every file that Drake reads is read, every number agrees, and every verdict is the recorded
one, else 1.
"""

import argparse
import collections
import json
import os
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import verdicts  # noqa: E402
from every_command import complaints  # noqa: E402
from programs import build_command, build_example, evaluated, example  # noqa: E402
from virtual_environment import python_of  # noqa: E402

REPOSITORY = HERE.parent.parent
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", REPOSITORY / "target"))
PLACE = TARGET / "sdf"
HELPER = example("dynamics")
ENDINGS = {".sdf", ".config"}
STATES = 3
FUNCTIONS = ["mass_matrix", "inverse_dynamics", "placements"]
# Of the scale of each number.
BOUND = 1e-11


def main():
    arguments = parse()
    python = environment()
    if "SDF_ORACLE" not in os.environ:
        build_example("dynamics")
        build_command()
        words = [str(Path(word).resolve()) if Path(word).is_file() else word for word in sys.argv]
        sys.exit(subprocess.run([str(python), *words], cwd=PLACE, env={**os.environ, "SDF_ORACLE": "1"}).returncode)
    if arguments.file:
        verdict, numbers = compare(Path(arguments.file))
        print(verdict, *(f"{name}: {value:.1e}" for name, value in sorted(numbers.items())), sep="\n  ")
        sys.exit(not verdict.startswith("equal"))
    found, worst = {}, collections.Counter()
    for name, folder in [("files of tests/sdf", HERE / "models"), *packages(arguments)]:
        own = collections.Counter()
        found[name] = {"largest_differences": {}, "files": {}}
        for file in sorted(folder.rglob("*.sdf")):
            verdict, numbers = compare(file)
            # Every command reads the file as it is.
            wrong = complaints(file) if verdict.startswith("equal") else []
            verdict = f"differs: {'; '.join(wrong)}" if wrong else verdict
            found[name]["files"][file.relative_to(folder).as_posix()] = {"verdict": verdict}
            print(f"{name}: {file.name}: {verdict}", *(f"{key} {value:.1e}" for key, value in numbers.items() if value > BOUND), flush=True)
            if verdict.startswith("equal"):
                own |= collections.Counter(numbers)
        worst |= own
        found[name]["largest_differences"] = {key: float(f"{value:.1e}") for key, value in sorted(own.items())}
    all_verdicts = [one["verdict"] for package in found.values() for one in package["files"].values()]
    counts = collections.Counter(re.split("[:,]", verdict)[0] for verdict in all_verdicts)
    summary = ", ".join(f"{count} {verdict}" for verdict, count in sorted(counts.items()))
    summary += "; largest differences: " + ", ".join(f"{key} {value:.1e}" for key, value in sorted(worst.items()))
    print(summary)
    if arguments.write:
        verdicts.write("sdf", found)
    changes = verdicts.changed("sdf", found)
    print(*changes, sep="\n", end="\n" if changes else "")
    good = all(verdict.startswith(("equal", "refused by", "refused, ")) for verdict in all_verdicts)
    sys.exit(not good or bool(changes))


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sample", action="store_true", help="only the packages marked so")
    parser.add_argument("--file", help="only this file")
    parser.add_argument("--write", action="store_true", help="record the verdicts of the packages that are read")
    return parser.parse_args()


def environment():
    """The Python with Drake."""
    return python_of(PLACE / "python", HERE / "requirements.txt")


def packages(arguments):
    """Names and folders of the packages."""
    for line in (HERE / "packages.txt").read_text().splitlines():
        wanted, _, note = line.partition("#")
        wanted = wanted.strip()
        if not wanted or (arguments.sample and note.strip() != "sample"):
            continue
        if wanted.startswith("drake=="):
            import pydrake

            yield wanted, Path(pydrake.__file__).parent / "share"
            continue
        folder = PLACE / wanted.replace("==", "-")
        if not (folder / "done").exists():
            fetch(wanted, folder)
        yield wanted, folder


def fetch(wanted, folder):
    download = folder / "download"
    command = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--only-binary", ":all:", "--dest", download, wanted]
    subprocess.run(command, check=True)
    for archive in download.iterdir():
        with zipfile.ZipFile(archive) as opened:
            opened.extractall(folder, [name for name in opened.namelist() if Path(name).suffix.lower() in ENDINGS])
        archive.unlink()
    (folder / "done").touch()


def variants(path):
    """The texts for Drake and for this library, and what is not in them; None where both read the file as it is."""
    tree = ElementTree.fromstring(path.read_text())
    group, changes = {}, []
    for link in tree.iter("link"):
        inertial = link.find("inertial")
        if inertial is not None and not is_possible(inertial):
            link.remove(inertial)
            changes.append("impossible inertias left out")

    def first(name):
        while group.get(name, name) != name:
            name = group[name]
        return name

    closing = []
    # Drake cannot reverse a ball joint: those close loops, where others can be in the tree.
    for joint in sorted(tree.iter("joint"), key=lambda joint: joint.get("type") in ("ball", "gearbox")):
        ends = [first((joint.findtext(end) or "").strip()) for end in ("parent", "child")]
        if ends[0] == ends[1]:
            closing.append(joint)
        group[ends[0]] = ends[1]
    if closing:
        changes.append("loops cut")
    for joint in closing:
        physics = ElementTree.SubElement(ElementTree.SubElement(joint, "physics"), "simbody")
        ElementTree.SubElement(physics, "must_be_loop_joint").text = "true"
    ours = ElementTree.tostring(tree, encoding="unicode")
    for model in tree.iter("model"):
        for joint in [child for child in model if child in closing]:
            model.remove(joint)
    changes = sorted(set(changes))
    return (ElementTree.tostring(tree, encoding="unicode"), ours, changes) if changes else None


def is_possible(inertial):
    """Whether SDFormat accepts a mass and its moments of inertia."""
    import numpy as np

    moments = inertial.find("inertia")
    if float(inertial.findtext("mass") or 1.0) <= 0.0 or moments is None:
        return moments is None
    xx, xy, xz, yy, yz, zz = (float(moments.findtext(key) or default) for key, default in zip(("ixx", "ixy", "ixz", "iyy", "iyz", "izz"), (1, 0, 0, 1, 0, 1)))
    least, middle, greatest = np.linalg.eigvalsh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    return least >= -1e-12 * greatest and greatest <= (least + middle) * (1 + 1e-6)


def compare(path):
    """The verdict about a file, and the largest differences."""
    changed = variants(path)
    if changed is None:
        return compare_files(path, path)
    with tempfile.TemporaryDirectory() as folder:
        paths = [Path(folder) / name for name in ("drake.sdf", "ours.sdf")]
        for file, text in zip(paths, changed):
            file.write_text(text)
        verdict, numbers = compare_files(*paths)
    return ", ".join([verdict, *changed[2]]) if verdict == "equal" else verdict, numbers


def compare_files(path, ours):
    import logging

    import numpy as np
    from pydrake.multibody.parsing import Parser
    from pydrake.multibody.plant import MultibodyPlant

    logging.getLogger("drake").setLevel(logging.ERROR)
    plant = MultibodyPlant(0.0)
    refused = None
    try:
        parser = Parser(plant)
        for folder in path.parent.iterdir():
            if folder.is_dir():
                parser.package_map().Add(folder.name, str(folder))
        instances = parser.AddModels(str(path))
        plant.Finalize()
    except Exception as error:
        refused = first_line(str(error), path)
    answer = subprocess.run([str(HELPER), str(ours), "0", "0", "-9.81"], input=b"", capture_output=True, timeout=120)
    if refused:
        return ("refused by both: " if answer.returncode else "refused by Drake: ") + refused, {}
    if answer.returncode:
        return "refused: " + first_line(answer.stderr.decode(), ours), {}
    robot = json.loads(answer.stdout.partition(b"\n")[0])
    names = [plant.GetModelInstanceName(instance) for instance in instances]
    outer = [name for name in names if not any(name.startswith(f"{other}::") for other in names)]
    # A single model adds no prefix to names, each of several does.
    top = outer[0] if len(outer) == 1 else ""
    off = collections.Counter()

    def differ(kind, found, expected, scale=None):
        found, expected = np.asarray(found, float), np.asarray(expected, float)
        scale = np.abs(expected).max(initial=0) if scale is None else scale
        value = (np.abs(found - expected) / np.maximum(scale, 1e-300)).max(initial=0)
        off[kind] = max(off[kind], float(value) if np.isfinite(value) else float("inf"))

    def name_of(element):
        instance = plant.GetModelInstanceName(element.model_instance())
        return "::".join([*instance.removeprefix(top).removeprefix("::").split("::"), element.name()]).removeprefix("::")

    links = {link["name"]: link for link in robot["links"]}
    bodies = {name_of(plant.get_body(index)): plant.get_body(index) for index in plant.GetBodyIndices(instances[0])}
    for instance in instances[1:]:
        bodies |= {name_of(plant.get_body(index)): plant.get_body(index) for index in plant.GetBodyIndices(instance)}
    if set(links) - {"world"} != set(bodies):
        return f"differs: links {sorted(set(links) ^ set(bodies))}", {}
    context = plant.CreateDefaultContext()
    home = dict((robot["world"]["home"] or {"q": []})["q"])
    for name, body in bodies.items():
        if f"{name}_free" in [joint[0] for joint in robot["order"]]:
            start = plant.GetFreeBodyPose(context, body)
            w, x, y, z = start.rotation().ToQuaternion().wxyz()
            found = np.array(home.get(f"{name}_free", [0, 0, 0, 0, 0, 0, 1]), float)
            sign = 1.0 if found[3:] @ [x, y, z, w] >= 0 else -1.0
            differ("start", [*found[:3], *sign * found[3:]], [*start.translation(), x, y, z, w], max(1.0, np.abs(found).max()))
        inertia = body.CalcSpatialInertiaInBodyFrame(context)
        mass = inertia.get_mass()
        differ("mass", links[name]["mass"], mass)
        if mass > 0:
            differ("centre", links[name]["center"], inertia.get_com(), max(1e-3, np.abs(inertia.get_com()).max()))
            own = inertia.Shift(inertia.get_com()).CalcRotationalInertia().CopyToFullMatrix3()
            differ("inertia", np.reshape(links[name]["inertia"], (3, 3)), own)
    # Drake lists a joint with the model of its child.
    all_joints = [plant.get_joint(index) for index in plant.GetJointIndices()]
    joints = {joint.name(): joint for joint in all_joints} | {name_of(joint): joint for joint in all_joints}
    for found in robot["joints"]:
        joint = joints.get(found["name"])
        if joint is None or joint.num_positions() != 1:
            continue
        for key, bound in (("lower", joint.position_lower_limits()[0]), ("upper", joint.position_upper_limits()[0])):
            own = found[key] if found[key] is not None else (-np.inf if key == "lower" else np.inf)
            differ("limits", 0.0 if own == bound else own, 0.0 if own == bound else bound, 1.0)
        differ("damping", found["damping"] or 0.0, joint.default_damping_vector()[0], 1.0)
    for joint in joints.values():
        if joint.num_velocities():
            joint.SetDampingVector(context, np.zeros(joint.num_velocities())) if hasattr(joint, "SetDampingVector") else None
    states = [state(plant, robot, joints, bodies, np.random.default_rng(seed)) for seed in range(STATES)]
    sent = b"".join(np.concatenate(one[2]).astype("<f8").tobytes() for one in states)
    if not plant.num_velocities():
        # The poses come without a state only if there is none to send.
        return "equal" if all(value <= BOUND for value in off.values()) else "differs:", dict(off)
    at, nv, frames = 0, robot["nv"], robot["frames"]
    if nv != plant.num_velocities():
        return f"differs: {nv} degrees of freedom, Drake {plant.num_velocities()}", {}
    answer = subprocess.run([str(HELPER), str(ours), "0", "0", "-9.81"], input=sent, capture_output=True, timeout=120)
    if answer.returncode:
        return "differs: " + first_line(answer.stderr.decode(), ours), {}
    numbers = np.array(evaluated(ours, FUNCTIONS, [one[2] for one in states], "generic", ["--gravity=0,0,-9.81"]))

    def take(count):
        nonlocal at
        at += count
        return numbers[at - count : at]

    for q, v, _, change, acceleration in states:
        matrix, bias, poses = take(nv * nv).reshape(nv, nv), take(nv), take(12 * frames).reshape(frames, 12)
        plant.SetPositions(context, q)
        plant.SetVelocities(context, v)
        expected = plant.CalcMassMatrix(context)
        expected = change.T @ expected @ change
        size = np.sqrt(np.outer(np.diag(expected), np.diag(expected))) + 1e-300
        differ("mass matrix", matrix / size, expected / size, 1.0)
        # Weight and inertia alone: dampers and springs are no part of it.
        force = plant.CalcMassMatrix(context) @ acceleration + plant.CalcBiasTerm(context) - plant.CalcGravityGeneralizedForces(context)
        force = change.T @ force
        differ("bias force", bias, force, max(np.abs(force).max(), np.abs(expected).max()))
        found = {name: pose for name, pose in zip(robot["frame_names"], poses)}
        real = {name: plant.EvalBodyPoseInWorld(context, body) for name, body in bodies.items()}
        length = max([1e-3, *(np.abs(pose.translation()).max() for pose in real.values())])
        for name, pose in real.items():
            differ("position", found[name][9:], pose.translation(), length)
            differ("orientation", found[name][:9].reshape(3, 3), pose.rotation().matrix(), 1.0)
    return "equal" if all(value <= BOUND for value in off.values()) else "differs:", dict(off)


def state(plant, robot, joints, bodies, random):
    """q and v of Drake, those that are sent with no acceleration, the matrix from the rates here to Drake's, and Drake's acceleration."""
    import numpy as np
    from pydrake.math import RigidTransform, RollPitchYaw, RotationMatrix
    from pydrake.common.eigen_geometry import Quaternion

    context = plant.CreateDefaultContext()
    nq, nv = robot["nq"], robot["nv"]
    sent_q, sent_v = np.zeros(nq), random.normal(size=nv)
    change, acceleration = np.zeros((plant.num_velocities(), nv)), np.zeros(plant.num_velocities())
    for name, kind, q, v in robot["order"]:
        if kind == "floating":
            body = bodies[name.removesuffix("_free")]
            quaternion = random.normal(size=4)
            quaternion /= np.linalg.norm(quaternion)
            rotation, place = RotationMatrix(Quaternion(quaternion)), random.normal(size=3)
            plant.SetFreeBodyPose(context, body, RigidTransform(rotation, place))
            sent_q[q : q + 7] = [*place, *quaternion[1:], quaternion[0]]
            first = body.floating_velocities_start_in_v()
            matrix = rotation.matrix()
            # Here the twist in axes of the body, there in axes of the world.
            change[first : first + 3, v : v + 3] = matrix
            change[first + 3 : first + 6, v + 3 : v + 6] = matrix
            acceleration[first + 3 : first + 6] = matrix @ np.cross(sent_v[v : v + 3], sent_v[v + 3 : v + 6])
            continue
        joint = joints[name]
        first, count = joint.velocity_start(), joint.num_velocities()
        if kind == "spherical":
            angles = random.uniform(-1, 1, size=3)
            joint.set_angles(context, angles)
            rotation = RollPitchYaw(angles).ToRotationMatrix().matrix()
            child = joint.frame_on_child().GetFixedPoseInBodyFrame().rotation().matrix()
            own = RotationMatrix(child @ rotation @ child.T).ToQuaternion().wxyz()
            sent_q[q : q + 4] = [*own[1:], own[0]]
            # Here in axes of the child, there in axes of the parent's side.
            change[first : first + 3, v : v + 3] = rotation @ child.T
            continue
        sent_q[q : q + count] = random.uniform(-1, 1, size=count)
        positions = plant.GetPositions(context).copy()
        positions[joint.position_start() : joint.position_start() + count] = sent_q[q : q + count]
        plant.SetPositions(context, positions)
        change[first : first + count, v : v + count] = np.eye(count)
    return plant.GetPositions(context).copy(), change @ sent_v, (sent_q, sent_v, np.zeros(nv)), change, acceleration


def first_line(text, path):
    """The first finding, without the place in the file."""
    line = (text.strip().splitlines() or [""])[0].replace(str(path), "…").replace(str(path.parent), "…")
    return re.sub(r"^.*?error: |At XML path \S+: ", "", line)[:120]


if __name__ == "__main__":
    main()
