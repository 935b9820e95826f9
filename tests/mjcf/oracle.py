#!/usr/bin/env python3
"""Reads every MJCF file that a list of Python packages ships, and compares masses, limits and dynamics with MuJoCo's.

    python3 tests/mjcf/oracle.py                  all packages of packages.txt (0.4 GB of downloads)
    python3 tests/mjcf/oracle.py --sample         a few of them, as CI does
    python3 tests/mjcf/oracle.py --only robosuite packages whose name contains a word
    python3 tests/mjcf/oracle.py --file F.xml     one file
    python3 tests/mjcf/oracle.py --generated      a dozen files, by generated code
    python3 tests/mjcf/oracle.py --write          also records the verdicts in docs/site/data/mjcf.json, and docs/mjcf-files.md

For each file that MuJoCo compiles: masses, centres of mass and inertias of all bodies, armature, damping, friction, stiffness,
rest and limits of all joints but free ones (nothing where a flag turns it off), and in random states the mass matrix, the bias force (inverse dynamics
without acceleration), positions and orientations of all bodies, and the centre of mass of the whole, as `articulated eval` prints them. An example
program prints what no command prints of the file, and compares inverse dynamics with its regressor. Of the rest, see world.py:
gravity, step, integrator, the state at the start, keyframes, planes, which actuators are read and their forces, those of springs
and dampers, and equations of joints.

Law: nothing is taken out of MuJoCo's model unless a warning of the reader names it. What is outside of every comparison is
printed by name. A file with flexible bodies or plugins is read where an option leaves them out, and not compared.

Every command then runs on the file (tests/every_command.py): no panic, documented exit codes, and reports that are JSON.

Packages are downloaded, not installed: their models are unpacked into target/mjcf. MuJoCo goes into a virtual environment
there, with the versions of requirements.txt.

Exit status: 0 if every file that MuJoCo compiles is read, every number agrees, and every verdict is the recorded one, else 1.
"""

import argparse
import collections
import json
import os
import re
import subprocess
import sys
import tarfile
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
PLACE = TARGET / "mjcf"
HELPER = example("dynamics")
ENDINGS = {".xml", ".mjcf", ".stl", ".obj", ".msh", ".png", ".skn", ".bin", ".jpg", ".hf"}
# Those that simulate.py moves, and of which code is generated.
MODELS = {
    "gymnasium": ["half_cheetah.xml", "hopper.xml", "walker2d_v5.xml", "ant.xml", "inverted_double_pendulum.xml", "humanoid.xml"],
    "openarm-mujoco": ["openarm_bimanual.xml"],
    "playground": ["cartpole.xml", "acrobot.xml", "finger.xml", "pendulum.xml", "reacher.xml"],
}
STATES = 3
FUNCTIONS = ["mass_matrix", "inverse_dynamics", "placements"]
# MuJoCo's types of joints; 0 is free.
BALL, SLIDE, HINGE = 1, 2, 3
# Of the scale of each number.
BOUND = 1e-10
# MuJoCo stops to diagonalize an inertia where the next turn has a cosine above 1 - 1e-12, or an entry beside the diagonal is
# below 1e-12 (for meshes before the density): what is left is up to 1.5e-6 of the inertia. It is no part of the comparison.
LEFT_BY_MUJOCO = 1.5e-6


def main():
    arguments = parse()
    enter("dynamics")
    if arguments.file:
        verdict, numbers, counts = compare(Path(arguments.file))
        lines = [f"{name}: {value:.1e}" for name, value in sorted(numbers.items())]
        print(verdict, *lines, *(f"{name}: {value}" for name, value in sorted(counts.items())), sep="\n  ")
        sys.exit(verdict != "equal")
    if arguments.generated:
        good = True
        for path in models():
            verdict, numbers, _ = compare(path, generated=True)
            lines = [f"{name} {value:.1e}" for name, value in sorted(numbers.items()) if name in OF_CODE]
            print(f"{path.name}: {verdict}; {', '.join(lines)}", flush=True)
            good &= verdict == "equal"
        sys.exit(not good)
    own = HERE / "models"
    rows = {}
    for name, path in [("files of this folder", own), *packages(arguments)]:
        rows[name] = files_of(path)
        counts = collections.Counter(verdict.split(":")[0] for _, verdict, *_ in rows[name])
        print(f"{name}: " + ", ".join(f"{count} {verdict}" for verdict, count in sorted(counts.items())), flush=True)
        for file, verdict, numbers, _ in rows[name]:
            if not verdict.startswith(GOOD):
                worst = ", ".join(f"{key} {value:.1e}" for key, value in numbers.items() if value > BOUND)
                print(f"  {file}: {verdict} {worst}", flush=True)
    worst, counts = collections.Counter(), collections.Counter()
    for _, verdict, numbers, own in (row for all_rows in rows.values() for row in all_rows):
        counts.update(own)
        if verdict == "equal":
            for key, value in numbers.items():
                worst[key] = max(worst[key], value)
    print("largest differences: " + ", ".join(f"{key} {value:.1e}" for key, value in sorted(worst.items())))
    print("outside of every comparison: " + "; ".join(outside()))
    print("numbers of things: " + ", ".join(f"{key} {value}" for key, value in sorted(counts.items())))
    found = {name: record(files) for name, files in rows.items()}
    if arguments.write:
        verdicts.write("mjcf", found)
    changes = verdicts.changed("mjcf", found)
    print(*changes, sep="\n", end="\n" if changes else "")
    good = all(verdict.startswith(GOOD) for all_rows in rows.values() for _, verdict, *_ in all_rows)
    sys.exit(not good or bool(changes))


# Verdicts that are no mistake.
GOOD = ("equal", "refused by MuJoCo", "read without")


def outside():
    import world

    return world.OUTSIDE


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sample", action="store_true", help="only the packages marked so")
    parser.add_argument("--only", default="", help="only packages whose name contains this")
    parser.add_argument("--file", help="only this file")
    parser.add_argument("--generated", action="store_true", help="a dozen files, by generated code")
    parser.add_argument("--write", action="store_true", help="record the verdicts of the packages that are read")
    return parser.parse_args()


def environment():
    """The Python with MuJoCo."""
    return python_of(PLACE / "python", HERE / "requirements.txt")


def enter(*examples):
    """Builds the command and these examples, and runs the script again beside MuJoCo, unless it runs there already."""
    python = environment()
    if "MJCF_ORACLE" in os.environ:
        return
    build_command()
    for example in examples:
        build_example(example)
    words = [str(Path(word).resolve()) if Path(word).is_file() else word for word in sys.argv]
    # MuJoCo writes a log into the folder that it runs in.
    sys.exit(subprocess.run([str(python), *words], cwd=PLACE, env={**os.environ, "MJCF_ORACLE": "1"}).returncode)


def models():
    """The paths of MODELS."""
    wanted = argparse.Namespace(sample=False, only="")
    found = {name.partition("==")[0]: folder for name, folder in packages(wanted) if name.partition("==")[0] in MODELS}
    for package, names in MODELS.items():
        for name in names:
            paths = sorted(found[package].rglob(name))
            if paths:
                yield paths[0]
            else:
                print(f"{name:40}is not in {package}")


def packages(arguments):
    """Names and folders of the packages."""
    for line in (HERE / "packages.txt").read_text().splitlines():
        wanted, _, note = line.partition("#")
        wanted = wanted.strip()
        if not wanted or (arguments.sample and note.strip() != "sample") or arguments.only not in wanted:
            continue
        folder = PLACE / wanted.replace("==", "-")
        if not (folder / "done").exists():
            fetch(wanted, folder)
        yield wanted, folder


def fetch(wanted, folder):
    folder.mkdir(parents=True, exist_ok=True)
    download = folder / "download"
    command = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--dest", download, wanted]
    subprocess.run(command, check=True)
    for archive in download.iterdir():
        if archive.suffix in {".whl", ".zip"}:
            with zipfile.ZipFile(archive) as opened:
                opened.extractall(folder, [name for name in opened.namelist() if Path(name).suffix.lower() in ENDINGS])
        else:
            with tarfile.open(archive) as opened:
                members = [m for m in opened.getmembers() if Path(m.name).suffix.lower() in ENDINGS]
                opened.extractall(folder, members, filter="data")
        archive.unlink()
    (folder / "done").touch()


def files_of(folder):
    """Name, verdict, numbers and counts of each MJCF file."""
    rows = []
    for path in sorted(folder.rglob("*")):
        if path.suffix.lower() not in {".xml", ".mjcf"} or not re.search(rb"<mujoco[\s>/]", path.read_bytes()):
            continue
        try:
            verdict, numbers, counts = compare(path)
            wrong = complaints(path) if verdict == "equal" else []
            verdict = f"differs: {'; '.join(wrong)}" if wrong else verdict
        except subprocess.TimeoutExpired:
            verdict, numbers, counts = "differs: no answer in two minutes", {}, {}
        rows.append((path.relative_to(folder).as_posix(), verdict, numbers, counts))
    return rows


def without_folders(message, path):
    """A message without the places of files on this machine."""
    for folder in (path.parent, PLACE, REPOSITORY):
        message = message.replace(str(folder), "…")
    return message


def compare(path, generated=False):
    """A verdict, the largest difference of each kind of number, and how many things there are of a kind."""
    import warnings

    import mujoco
    import numpy as np

    import world

    warnings.simplefilter("ignore")
    mujoco.set_mju_user_warning(lambda text: None)
    try:
        mujoco.MjModel.from_xml_path(str(path))
        spec = mujoco.MjSpec.from_file(str(path))
        for body in spec.bodies:
            body.simple = 0  # so that inertias may be set
        model = spec.compile()
    except (ValueError, mujoco.FatalError) as error:
        return "refused by MuJoCo: " + without_folders(str(error).splitlines()[0], path)[:120], {}, {}
    data = mujoco.MjData(model)
    armature = model.dof_armature.copy()
    for one in np.flatnonzero(getattr(model, "actuator_armature", np.zeros(0))):
        found = world.of_one_joint(model, one)
        if found:
            armature[found[0]] += model.actuator_armature[one] * found[1] ** 2
    if model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_GRAVITY:
        model.opt.gravity[:] = 0
    states = [state(model, np.random.default_rng(seed)) for seed in range(STATES)]
    sent = b"".join(np.concatenate(one[2]).astype("<f8").tobytes() for one in states) if model.nv else b""
    command = [str(HELPER), str(path), *(repr(float(g)) for g in model.opt.gravity)]
    answer = subprocess.run(command, input=sent, capture_output=True, timeout=120)
    kinds = sorted(set(re.findall(r"`--leave-out (\w+)`", answer.stderr.decode()))) if answer.returncode else []
    if kinds and subprocess.run([*command, *kinds], input=sent, capture_output=True, timeout=120).returncode == 0:
        return f"read without {' and '.join(kinds)}, which an option leaves out", {}, {}
    if answer.returncode:
        first = answer.stderr.decode().splitlines()[0]
        return "refused: " + without_folders(first, path)[:300], {}, {}
    robot = json.loads(answer.stdout.partition(b"\n")[0])
    if (robot["nq"], robot["nv"]) != (model.nq, model.nv):
        return f"differs: {robot['nq']} coordinates and {robot['nv']} freedoms, MuJoCo {model.nq} and {model.nv}", {}, {}
    code = "generated" if generated else "generic"
    numbers = np.array(evaluated(path, FUNCTIONS, [one[2] for one in states], code) if model.nv else [])
    names = [mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_BODY, body) for body in range(model.nbody)]
    by_name = {link["name"]: index for index, link in enumerate(robot["links"])}
    # Bodies that MuJoCo fuses are links here.
    fused = len(robot["links"]) != model.nbody
    index = [by_name.get(name, -1) for name in names] if fused else list(range(model.nbody))
    if -1 in index:
        return f"differs: {len(robot['links'])} links, MuJoCo {model.nbody} bodies", {}, {}
    off = collections.Counter()

    def differ(kind, found, expected, scale=None):
        found, expected = np.asarray(found, float), np.asarray(expected, float)
        scale = np.abs(expected).max(initial=0) if scale is None else scale
        value = (np.abs(found - expected) / np.maximum(scale, 1e-300)).max(initial=0)
        off[kind] = max(off[kind], float(value) if np.isfinite(value) else float("inf"))

    counts = collections.Counter()
    silent = world.compare(model, states, robot, differ, lambda kind, number: counts.update({kind: number}))
    warned = world.Warned(robot)
    world.reduce_armature(model, warned)
    silent += warned.silent
    masses(model, robot, fused, differ, mujoco, np)
    joints(model, robot, armature, differ, np)
    mujoco.mj_setConst(model, data)
    at, frames, nv = 0, robot["frames"], model.nv

    def take(count):
        nonlocal at
        at += count
        return numbers[at - count : at]

    for q, v, _, change in states if nv else []:
        matrix, bias, poses = take(nv * nv).reshape(nv, nv), take(nv), take(12 * frames).reshape(frames, 12)
        data.qpos[:], data.qvel[:] = q, v
        mujoco.mj_forward(model, data)
        expected = np.zeros((nv, nv))
        mujoco.mj_fullM(model, data, expected)
        size = np.sqrt(np.outer(np.diag(expected), np.diag(expected))) + 1e-300
        differ("mass matrix", change.T @ matrix @ change / size, expected / size, 1.0)
        differ("bias force", change.T @ bias, data.qfrc_bias, max(np.abs(data.qfrc_bias).max(), np.abs(expected).max()))
        length = max(1e-3, np.abs(data.xpos).max())
        differ("position", poses[index, 9:], data.xpos, length)
        differ("orientation", poses[index, :9], data.xmat, 1.0)
        weights = np.array([link["mass"] for link in robot["links"]])
        centers = [pose[9:] + pose[:9].reshape(3, 3) @ np.array(link["center"]) for pose, link in zip(poses, robot["links"])]
        if weights.sum() > 0:
            differ("centre of mass", weights @ np.array(centers) / weights.sum(), data.subtree_com[0], length)
    if silent:
        return f"differs: in MuJoCo's model and without a warning: {', '.join(silent)[:300]}", dict(off), counts
    return "equal" if all(value <= BOUND for value in off.values()) else "differs:", dict(off), counts


# Results of code, rather than of the reader.
OF_CODE = ("mass matrix", "bias force", "position", "orientation")


def state(model, random):
    """q and v of MuJoCo, those that are sent with an acceleration, and the matrix from MuJoCo's v to that."""
    import mujoco
    import numpy as np

    q, v, sent_q = np.zeros(model.nq), random.normal(size=model.nv), []
    change, acceleration = np.zeros((model.nv, model.nv)), np.zeros(model.nv)
    for joint in range(model.njnt):
        kind, at, dof = int(model.jnt_type[joint]), model.jnt_qposadr[joint], model.jnt_dofadr[joint]
        if kind in (SLIDE, HINGE):
            q[at] = random.uniform(-1, 1)
            sent_q.append(q[at])
            change[dof, dof] = 1
            continue
        quaternion = random.normal(size=4)
        quaternion /= np.linalg.norm(quaternion)
        if kind == BALL:
            q[at : at + 4] = quaternion
            sent_q += [*quaternion[1:], quaternion[0]]
            change[dof : dof + 3, dof : dof + 3] = np.eye(3)
            continue
        # Free: here the twist of the body in its axes, there the velocity in the world's and the rates in the body's.
        position = random.normal(size=3)
        q[at : at + 7] = [*position, *quaternion]
        sent_q += [*position, *quaternion[1:], quaternion[0]]
        rotation = np.zeros(9)
        mujoco.mju_quat2Mat(rotation, quaternion)
        rotation = rotation.reshape(3, 3)
        change[dof : dof + 3, dof + 3 : dof + 6] = np.eye(3)
        change[dof + 3 : dof + 6, dof : dof + 3] = rotation.T
        acceleration[dof + 3 : dof + 6] = -np.cross(v[dof + 3 : dof + 6], rotation.T @ v[dof : dof + 3])
    return q, v, (np.array(sent_q), change @ v, acceleration), change


def masses(model, robot, fused, differ, mujoco, np):
    """Compares the bodies, and gives MuJoCo the inertias to all digits."""
    links = robot["links"]
    differ("total mass", sum(link["mass"] for link in links), model.body_mass.sum())
    if fused:
        return
    for body in range(1, model.nbody):
        link = links[body]
        differ("mass", link["mass"], model.body_mass[body])
        if model.body_mass[body] <= 0:
            continue
        differ("centre", link["center"], model.body_ipos[body], max(1e-3, np.abs(model.body_ipos[body]).max()))
        rotation = np.zeros(9)
        mujoco.mju_quat2Mat(rotation, model.body_iquat[body])
        rotation = rotation.reshape(3, 3)
        found = np.array(link["inertia"]).reshape(3, 3)
        own = rotation.T @ found @ rotation
        size = np.abs(model.body_inertia[body]).max()
        rest = np.abs(own - np.diag(model.body_inertia[body])).max()
        differ("inertia", rest if rest > LEFT_BY_MUJOCO * size else 0.0, 0.0, size)
        moments, axes = np.linalg.eigh(found)
        if np.linalg.det(axes) < 0:
            axes[:, 0] *= -1
        quaternion = np.zeros(4)
        mujoco.mju_mat2Quat(quaternion, axes.flatten())
        model.body_iquat[body], model.body_inertia[body] = quaternion, moments
    model.body_sameframe[:] = 0


# The flags of <option> that turn off effects of joints.
OFF_BY = {"friction": ("FRICTIONLOSS", "CONSTRAINT"), "limits": ("LIMIT", "CONSTRAINT"), "damping": ("DAMPER",), "stiffness": ("SPRING",)}


def joints(model, robot, armature, differ, np):
    """Compares what joints with one coordinate and ball joints have; what a flag turns off is not there."""
    import world

    of = {name: 0.0 if world.disabled(model, *flags) else 1.0 for name, flags in OFF_BY.items()}
    limited = model.jnt_limited * of["limits"]
    for joint, found in zip(range(model.njnt), robot["joints"]):
        kind = int(model.jnt_type[joint])
        if kind not in (BALL, SLIDE, HINGE):
            continue
        dof, at = model.jnt_dofadr[joint], model.jnt_qposadr[joint]
        differ("armature", found["armature"] or 0, armature[dof])
        differ("friction", found["friction"] or 0, model.dof_frictionloss[dof] * of["friction"])
        differ("damping", found["damping"] or 0, model.dof_damping[dof] * of["damping"])
        differ("stiffness", found["stiffness"] or 0, model.jnt_stiffness[joint] * of["stiffness"])
        if model.jnt_stiffness[joint] * of["stiffness"] and kind != BALL:
            differ("rest", found["rest"] or 0, model.qpos_spring[at], 1.0)
        if limited[joint] and kind == BALL:
            differ("limits", found["upper"], max(model.jnt_range[joint]), 1.0)
        elif limited[joint]:
            differ("limits", [found["lower"], found["upper"]], model.jnt_range[joint], 1.0)
        elif found["lower"] is not None or found["upper"] is not None:
            differ("limits", 1, 0, 1.0)


def record(files):
    """What verdicts.py keeps of a package: the largest differences of its equal files, counts of things, and the verdicts."""
    worst, things = collections.Counter(), collections.Counter()
    for _, verdict, numbers, counts in files:
        things.update(counts)
        if verdict == "equal":
            for key, value in numbers.items():
                worst[key] = max(worst[key], float(f"{value:.1e}"))
    compared = {key: int(value) for key, value in sorted(things.items())}
    return {"largest_differences": dict(sorted(worst.items())), "compared": compared, "files": {file: {"verdict": verdict} for file, verdict, *_ in files}}


if __name__ == "__main__":
    main()
