#!/usr/bin/env python3
"""Reads every URDF that a list of Python packages ships, and compares the dynamics with Pinocchio's.

    python3 tests/shipped/shipped.py                    all packages of packages.txt (0.8 GB of downloads)
    python3 tests/shipped/shipped.py --sample           a few of them, as CI does
    python3 tests/shipped/shipped.py --only dexmate     packages whose name contains a word
    python3 tests/shipped/shipped.py --json FILE        the table for programs, too
    python3 tests/shipped/shipped.py --write            records the verdicts in docs/site/data/shipped.json

For each file: is it usable, and if not, why? Is it a robot? A robot is a file in which a joint moves a mass, as this project
reads it, or as Pinocchio does where this project refuses it. For each usable robot, on a fixed and on a floating base: inverse dynamics, mass matrix and forward dynamics against Pinocchio in random states.

Packages are downloaded, not installed: only their URDF files are unpacked, into target/shipped. Pinocchio goes into a
virtual environment there, with the versions of requirements.txt.

Exit status: 0 if every refusal is listed in refused.txt, every number agrees, and every verdict is the recorded one, else 1.
"""

import argparse
import concurrent.futures
import json
import os
import re
import subprocess
import sys
import tarfile
import zipfile
import zlib
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import verdicts  # noqa: E402
from every_command import complaints  # noqa: E402
from programs import COMMAND, build_command  # noqa: E402

REPOSITORY = HERE.parent.parent
PLACE = REPOSITORY / "target" / "shipped"
LEFT_OUT = "random_urdfs"  # a thousand blocks of random shape in pybullet: no robots
BOUND = 1e-12  # of the scale of each number; of forward dynamics also ten times what Pinocchio's own are off
STATES = 3
FUNCTIONS = ["inverse_dynamics", "mass_matrix", "forward_dynamics"]
# Options that errors name: each makes one kind of mistake a warning.
OPTIONS = ["--allow-unphysical-inertia", "--first-of-duplicates", "--allow-unknown-version"]
SINGULAR = 1e-13  # least ratio of pivots below which forward dynamics is not compared


def ensure_packages():
    """Runs this script again inside a virtual environment of its own, made on the way."""
    environment = PLACE / "venv"
    python = environment / "bin" / "python"
    if Path(sys.prefix) == environment:
        return
    wanted = (HERE / "requirements.txt").read_text()
    stamp = environment / "installed.txt"
    if not stamp.exists() or stamp.read_text() != wanted:
        subprocess.check_call([sys.executable, "-m", "venv", environment])
        subprocess.check_call([python, "-m", "pip", "install", "--quiet", "-r", HERE / "requirements.txt"])
        stamp.write_text(wanted)
    os.execv(python, [str(python), *sys.argv])


def packages(sample, only):
    """The pinned packages that this run reads."""
    for line in (HERE / "packages.txt").read_text().splitlines():
        pinned, _, note = (part.strip() for part in line.partition("#"))
        if pinned and (not sample or note == "sample") and (not only or only in pinned):
            yield pinned


def unpack(pinned):
    """Downloads one package and unpacks its URDF files; returns their paths below the package's folder."""
    folder = PLACE / "files" / pinned
    if not (folder / "complete").exists():
        download = PLACE / "download" / pinned
        subprocess.check_call([sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check", "--no-deps", "--dest", download, pinned])
        for archive in download.iterdir():
            opened = zipfile.ZipFile(archive) if archive.suffix == ".whl" else tarfile.open(archive)
            names = opened.namelist() if archive.suffix == ".whl" else opened.getnames()
            for name in names:
                if name.lower().endswith(".urdf") and LEFT_OUT not in name and ".." not in name:
                    opened.extract(name, folder)
            opened.close()
            archive.unlink()  # hundreds of megabytes of meshes
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "complete").touch()
    return sorted(path for path in folder.rglob("*") if path.suffix.lower() == ".urdf")


def articulated(path, base, *arguments, standard_input=None):
    """Runs one subcommand; returns its exit status and its JSON, if it printed some."""
    done = subprocess.run([COMMAND, *arguments, base, "--format", "json", path], input=standard_input, capture_output=True, text=True)
    try:
        return done.returncode, json.loads(done.stdout)
    except ValueError:
        return done.returncode, {"errors": [{"message": (done.stderr or done.stdout).strip()[:300]}]}


def rows(named, size, joints):
    """The nested objects of `eval` as a flat list, in the order of the coordinates."""
    flat = []
    for joint in sorted((j for j in joints if j["kind"] != "fixed" and not j["mimic"]), key=lambda j: j["v"][0]):
        value = named[joint["joint"]]
        flat += value if isinstance(value, list) else [value]
    assert len(flat) == size, (len(flat), size)
    return flat


def compare(path, base, report):
    """The largest error of each function over its scale, or the reason why nothing is compared."""
    import numpy
    from engine import Engine, Refused

    joints = report["joints"]
    try:
        engine = Engine(path, joints, base == "--floating")
    except Refused as reason:
        return {"not_compared": f"Pinocchio: {reason}"}
    random = numpy.random.default_rng(zlib.crc32(path.name.encode()))
    states = []
    for _ in range(STATES):
        q = numpy.zeros(engine.nq)
        for joint in joints:
            if joint["kind"] == "fixed" or joint["mimic"]:
                continue
            start, size = joint["q"]
            if size == 7:
                turn = random.normal(size=4)
                q[start : start + 7] = [*random.uniform(-1, 1, 3), *(turn / numpy.linalg.norm(turn))]
            else:
                low, high = (joint[side] if joint[side] is not None else sign * numpy.pi for side, sign in (("lower", -1), ("upper", 1)))
                q[start] = random.uniform(max(low, -numpy.pi), min(high, numpy.pi)) if low < high else low
        states.append((q, *(random.normal(size=engine.nv) for _ in range(3))))
    text = json.dumps({"states": [{"q": list(q), "v": list(v), "a": list(a), "tau": list(tau)} for q, v, a, tau in states]})
    evaluate = lambda functions: articulated(path, base, "eval", "--generic", "--function", ",".join(functions), "--states", "-", standard_input=text)
    status, answer = evaluate(FUNCTIONS)
    undefined = status != 0 and any(error.get("code") == "singular_mass_matrix" for error in answer.get("errors", []))
    if undefined:  # no inverse of M: Pinocchio's M has to say so too
        status, answer = evaluate(FUNCTIONS[:2])
    if status != 0:
        return {"failed": answer.get("errors", [{}])[0].get("message", f"eval: exit status {status}")}
    ours = {f["function"]: [state["generic"] for state in f["states"]] for f in answer["functions"]}
    errors = dict.fromkeys(FUNCTIONS, 0.0)

    def note(function, error, scale):
        ratio = numpy.max(numpy.where(scale > 0, numpy.abs(error) / numpy.where(scale > 0, scale, 1), numpy.where(error == 0, 0, numpy.inf)), initial=0.0)
        errors[function] = max(errors[function], float(ratio) if ratio == ratio else float("inf"))

    singular, own = False, 0.0
    for k, (q, v, a, tau) in enumerate(states):
        scale = engine.torque_scale(q, v, a)
        note("inverse_dynamics", numpy.array(rows(ours["inverse_dynamics"][k], engine.nv, joints)) - engine.inverse_dynamics(q, v, a), scale)
        expected = engine.mass_matrix(q)
        diagonal = numpy.sqrt(numpy.abs(numpy.diag(expected)))
        matrix = numpy.array(unnest(ours["mass_matrix"][k], joints, engine.nv), dtype=float)
        # a diagonal that cancels to zero is compared with the robot's largest entry in that
        # column's unit
        note("mass_matrix", matrix - expected, numpy.outer(diagonal, diagonal) + 1e-4 * BOUND * numpy.max(expected, initial=0.0))
        unit = numpy.where(diagonal > 0, diagonal, 1)
        if not diagonal.all() or numpy.linalg.eigvalsh(expected / numpy.outer(unit, unit))[0] < SINGULAR * engine.nv:
            singular = True
            continue
        if undefined:
            return {"failed": "forward_dynamics is refused, but Pinocchio's mass matrix is not singular"}
        accelerations = numpy.array(rows(ours["forward_dynamics"][k], engine.nv, joints), dtype=float)
        error = backward_error(engine, q, v, tau, accelerations)
        errors["forward_dynamics"] = max(errors["forward_dynamics"], error if error == error else float("inf"))
        # Robots whose light links have no inertia leave more than rounding errors in every engine.
        theirs = engine.forward_dynamics(q, v, tau)
        own = max(own, backward_error(engine, q, v, tau, theirs) if theirs is not None else 0.0)
    return {"errors": errors, "singular": singular, "pinocchio_forward_dynamics": own}


def backward_error(engine, q, v, tau, accelerations):
    """The torques that these accelerations need, less those that were applied, over the scale of each row: the largest."""
    import numpy

    residual = engine.inverse_dynamics(q, v, accelerations) - tau
    return float(numpy.max(numpy.abs(residual) / (engine.torque_scale(q, v, accelerations) + numpy.abs(tau)), initial=0.0))


def unnest(matrix, joints, size):
    """The mass matrix of `eval`, an object of objects, as rows of numbers."""
    out = []
    for joint in sorted((j for j in joints if j["kind"] != "fixed" and not j["mimic"]), key=lambda j: j["v"][0]):
        block = matrix[joint["joint"]]
        out += [rows(row, size, joints) for row in (block if isinstance(block, list) else [block])]
    return out


def examine(task):
    """One file: what it is, whether it is usable, and how its dynamics agree."""
    package, path = task
    name = f"{package.partition('==')[0]}/{path.relative_to(PLACE / 'files' / package)}"
    status, report = articulated(path, "--fixed", "check")
    entry = {"file": name, "usable": status == 0 and report.get("usable", False), "warnings": len(report.get("warnings", []))}
    if not entry["usable"]:
        from engine import moves_mass

        entry["robot"] = moves_mass(path)
        messages = [error["message"].split(path.name + ":")[-1] for error in report["errors"]]
        entry["reason"], entry["mistakes"] = messages[0], len(messages)
        entry["option"] = option(path, messages)
        return entry
    entry["robot"] = report["totals"]["moving_mass"] > 0
    entry["degrees_of_freedom"] = report["totals"]["degrees_of_freedom"]
    if not entry["robot"]:
        return entry
    entry["complaints"] = complaints(path, ["--fixed"])
    entry["fixed"] = compare(path, "--fixed", report)
    status, floating = articulated(path, "--floating", "check")
    entry["floating"] = compare(path, "--floating", floating) if status == 0 else {"not_compared": "no mass on a floating base"}
    return entry


def option(path, messages):
    """The option that the errors name and that makes the file usable, if there is one."""
    named = [word for word in OPTIONS if any(word in message for message in messages)]
    usable = (word for word in named if articulated(path, "--fixed", "check", word)[1].get("usable", False))
    return next(usable, None)


def verdict(entry, listed):
    """Sentences about what is wrong with the entry; none where all is well."""
    wrong = []
    if not entry["usable"] and entry["file"] not in listed:
        wrong.append(f"{entry['file']}: refused, and not in refused.txt: {entry['reason']}")
    if entry["usable"] and entry["file"] in listed:
        wrong.append(f"{entry['file']}: usable, but still in refused.txt")
    wrong += [f"{entry['file']}: {sentence}" for sentence in entry.get("complaints", [])]
    for base in ("fixed", "floating"):
        found = entry.get(base, {})
        if "failed" in found:
            wrong.append(f"{entry['file']}, {base}: {found['failed']}")
        for function, error in found.get("errors", {}).items():
            bound = max(BOUND, 10 * found["pinocchio_forward_dynamics"]) if function == "forward_dynamics" else BOUND
            if not error <= bound:
                wrong.append(f"{entry['file']}, {base}: {function} is off by {error:.1e} of its scale; at most {bound:.0e} is allowed")
    return wrong


def record(tasks, entries, listed):
    """What verdicts.py keeps of these files: for each a verdict, and the option that reads a file that is refused."""
    found = {}
    for (package, path), entry in zip(tasks, entries):
        one = {"verdict": in_words(entry, listed).replace(str(path.parent), "…")}
        if entry.get("option"):
            one["option"] = entry["option"]
        found.setdefault(package, {"files": {}})["files"][path.relative_to(PLACE / "files" / package).as_posix()] = one
    return found


def in_words(entry, listed):
    """The verdict about a file, which begins with its kind."""
    if not entry["usable"]:
        return f"refused: {entry['reason']}"
    wrong = [sentence.removeprefix(entry["file"]).removeprefix(":").removeprefix(",").strip() for sentence in verdict(entry, listed)]
    if wrong:
        return f"differs: {'; '.join(wrong)}"
    if not entry["robot"]:
        return "no moving mass"
    reasons = {base: re.sub(r" \[.*| \(.*", "", entry[base]["not_compared"]) for base in ("fixed", "floating") if "not_compared" in entry[base]}
    if len(reasons) == 2:
        return f"not compared: {reasons['fixed']}"
    return next((f"equal, but not compared on a {base} base: {reason}" for base, reason in reasons.items()), "equal")


def table(entries):
    """A line per package, then totals."""
    kinds = {}
    for entry in entries:
        kinds.setdefault(entry["file"].partition("/")[0], []).append(entry)
    print(f"{'package':28} {'files':>6} {'usable':>7} {'robots':>7} {'usable':>7} {'compared':>9}   {'ID':>8} {'M':>8} {'FD':>8} {'its FD':>8}   largest error over scale")
    for name, group in [*kinds.items(), ("all", entries)]:
        robots = [e for e in group if e["robot"]]
        bases = [e[base] for e in group for base in ("fixed", "floating") if "errors" in e.get(base, {})]
        worst = [max((b["errors"][f] for b in bases), default=float("nan")) for f in FUNCTIONS]
        worst.append(max((b["pinocchio_forward_dynamics"] for b in bases), default=float("nan")))
        print(f"{name:28} {len(group):6} {sum(e['usable'] for e in group):7} {len(robots):7} {sum(e['usable'] for e in robots):7} {len(bases):9}   "
              + " ".join(f"{x:8.1e}" for x in worst))
    reasons = {}
    for entry in entries:
        for base in ("fixed", "floating"):
            if "not_compared" in entry.get(base, {}):
                reasons.setdefault(re.sub(r"\[.*", "", entry[base]["not_compared"]), []).append(entry["file"])
    for reason, files in sorted(reasons.items()):
        print(f"not compared, {len(files)}: {reason} ({files[0]})")
    refused = [entry for entry in entries if not entry["usable"]]
    for entry in refused:
        more = f" (and {entry['mistakes'] - 1} more)" if entry["mistakes"] > 1 else ""
        print(f"refused{'' if entry['robot'] else ' (no robot)'}: {entry['file']}: {entry['reason']}{more}")
    robots = [e for e in entries if e["robot"]]
    usable = sum(e["usable"] for e in robots)
    print(f"{usable} of {len(robots)} robots are usable ({100 * usable / max(len(robots), 1):.1f} %)")
    for word in OPTIONS:
        more = sum(e.get("option") == word for e in robots)
        if more:
            usable += more
            print(f"{more} more are usable with {word}, as the error says ({100 * usable / len(robots):.1f} %)")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sample", action="store_true", help="only the packages marked `sample`")
    parser.add_argument("--only", help="only packages whose name contains this")
    parser.add_argument("--json", type=Path, help="write the entries of all files here")
    parser.add_argument("--write", action="store_true", help="record the verdicts of the packages that are read")
    arguments = parser.parse_args()
    ensure_packages()
    sys.path.insert(0, str(HERE))
    build_command()
    tasks = [(package, path) for package in packages(arguments.sample, arguments.only) for path in unpack(package)]
    if not tasks:
        parser.error("no package matches")
    entries = []
    with concurrent.futures.ProcessPoolExecutor() as pool:
        for entry in pool.map(examine, tasks, chunksize=2):
            entries.append(entry)
            if sys.stderr.isatty():
                print(f"\r{len(entries)} of {len(tasks)} files", end="", file=sys.stderr, flush=True)
    if sys.stderr.isatty():
        print(file=sys.stderr)
    listed = {line.partition("  ")[0] for line in (HERE / "refused.txt").read_text().splitlines() if line and not line.startswith("#")}
    table(entries)
    wrong = [sentence for entry in entries for sentence in verdict(entry, listed)]
    found = record(tasks, entries, listed)
    if arguments.write:
        verdicts.write("shipped", found)
    wrong += verdicts.changed("shipped", found, ("verdict", "option"))
    for sentence in wrong:
        print(sentence)
    if arguments.json:
        arguments.json.write_text(json.dumps(entries, indent=1) + "\n")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
