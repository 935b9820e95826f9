"""What `articulated compare` and cargo said of a machine, as one file: all that the tables are made of."""

import datetime
import json
import math
import os
import platform
import re
import statistics
import subprocess
import sys
from importlib import metadata

import cargo_times
import robots
from environment import REPOSITORY

MANIFEST = REPOSITORY / "target" / "peers" / "peers.json"
PLACE = REPOSITORY / "docs" / "speed"
FUNCTIONS = ["inverse_dynamics", "mass_matrix", "forward_dynamics", "inverse_dynamics_derivatives"]
BATCHES = ["inverse_dynamics", "forward_dynamics"]
MORE = ["forward_dynamics_derivatives", "mass_matrix_inverse", "jacobians_world_aligned"]
# kind of run -> robots, functions, further words, and the peers that take part
KINDS = {
    "one": (list(robots.ALL), FUNCTIONS, [], lambda peer: "lanes" not in peer),
    "more": (robots.BUNDLED, MORE, [], lambda peer: "lanes" not in peer and ("pinocchio" in peer or "casadi" in peer)),
    "many": (list(robots.ALL), BATCHES, ["--batch", "f64,f32"], lambda peer: "lanes" in peer or "eigen" in peer),
}
# family and model of a processor, if its own name does not identify it
PROCESSORS = {(6, 143): "Sapphire Rapids", (6, 207): "Emerald Rapids", (6, 173): "Granite Rapids", (6, 106): "Ice Lake", (25, 1): "Zen 3", (25, 17): "Zen 4",
              (25, 97): "Zen 4", (26, 2): "Zen 5", (26, 17): "Zen 5"}


def processor():
    """(what it calls itself, what it is)."""
    try:
        text = open("/proc/cpuinfo").read()
    except OSError:
        return platform.processor(), platform.processor()
    of = lambda key: re.search(rf"^{key}\s*: (.*)", text, re.MULTILINE)
    name = of("model name").group(1) if of("model name") else platform.machine()
    if not of("cpu family"):
        return name, name
    kind = int(of("cpu family").group(1)), int(of("model").group(1))
    return f"{name}, family {kind[0]}, model {kind[1]}", PROCESSORS.get(kind, name)


def said(*words):
    return subprocess.run(words, cwd=REPOSITORY, capture_output=True, text=True, check=True).stdout.strip()


def asked(command, kind, robot, scratch, number, repetitions):
    """What `compare` says of a robot."""
    _, functions, words, wanted = KINDS[kind]
    manifest = scratch / f"{kind}.json"
    manifest.write_text(json.dumps([peer for peer in json.loads(MANIFEST.read_text()) if wanted(peer)]))
    kept = scratch / f"{kind}_{robot.name}_{number}.json"
    if not kept.exists():
        print(f"{kept.stem} …", file=sys.stderr, flush=True)
        # A bundled robot's name implies its base.
        which = [str(robot.urdf), f"--{robot.base}"] if robot.file else [robot.name]
        line = [*command, "compare", *which, "--functions", ",".join(functions), *words, "--peers-manifest", str(manifest), "--format", "json",
                "--repetitions", str(repetitions)]
        done = subprocess.run(line, cwd=REPOSITORY, stdout=subprocess.PIPE, check=False)
        if done.returncode:
            raise SystemExit(f"{' '.join(line)}: exit status {done.returncode}")
        kept.write_bytes(done.stdout)
    return json.loads(kept.read_text())


def noise(report):
    """Grows with every contender's time, each weighing the same."""
    contenders = lambda f: [f["generated"], f["generic"], *(p["time"] for p in f["peers"]), *(b["time"] for b in f["batches"])]
    return sum(math.log(c["median"]) for f in report["functions"] for c in contenders(f))


def quiet(reports):
    """Half of the runs, rounded up: those in which all contenders together took least time."""
    return sorted(reports, key=noise)[: (len(reports) + 1) // 2]


def numbers(values):
    """Medians of the runs that count, to four digits."""
    return [float(f"{value:.4g}") for value in values]


def each(reports, number):
    """One number of each run."""
    return numbers(number(report) for report in reports)


def of_function(reports, name):
    """ns per call of a function by everybody."""
    found = [next(f for f in report["functions"] if f["function"] == name) for report in reports]
    peers = {p["peer"] for f in found for p in f["peers"]}
    peer = lambda f, who: next(p for p in f["peers"] if p["peer"] == who)
    out = {
        "generated": each(found, lambda f: f["generated"]["median"]),
        "any processor": each(found, lambda f: f["variants"][0]["time"]["median"]) if all(f["variants"] for f in found) else None,
        "generic": each(found, lambda f: f["generic"]["median"]),
        "peers": {who: each(found, lambda f, w=who: peer(f, w)["time"]["median"]) for who in sorted(peers)},
    }
    waiting = {who: each(found, lambda f, w=who: peer(f, w)["dependent"]["median"]) for who in sorted(peers) if peer(found[0], who)["dependent"]}
    if waiting:
        out["dependent"] = {"generated": each(found, lambda f: f["dependent"]["median"]), "peers": waiting}
    return out


def of_batch(reports, name):
    """ns per state of a function of many states, and of a call of Pinocchio and of ours in the same runs."""
    found = [next(f for f in report["functions"] if f["function"] == name) for report in reports]
    kinds = [(b["numbers"], b["layout"]) for b in found[0]["batches"]]
    batch = lambda f, kind: next(b for b in f["batches"] if (b["numbers"], b["layout"]) == kind)
    lanes = sorted({p["peer"] for p in found[0]["peers_in_lanes"]})
    of = lambda f, key, who: next(p for p in f[key] if p["peer"] == who)
    return {
        **{" ".join(kind): each(found, lambda f, k=kind: batch(f, k)["time"]["median"]) for kind in kinds},
        "one at a time": each(found, lambda f: f["generated"]["median"]),
        "peers": {p["peer"]: each(found, lambda f, w=p["peer"]: of(f, "peers", w)["time"]["median"]) for p in found[0]["peers"]},
        "lanes": {who: each(found, lambda f, w=who: of(f, "peers_in_lanes", w)["time"]["median"]) for who in lanes},
    }


def of_making(reports):
    """Seconds to generate and compile the functions of the tables: ours, the least of the runs, and theirs."""
    found = [m for report in reports for m in report["making"] if m["functions"] == FUNCTIONS]
    if not found:
        return None
    ours = min(m["generation_seconds"] + m["compilation_seconds"] for m in found)
    theirs = {p["peer"]: p["generation_seconds"] + p["compilation_seconds"] for p in found[0]["peers"] if p["generation_seconds"]}
    return {"generated": numbers([ours])[0], "peers": {who: numbers([seconds])[0] for who, seconds in sorted(theirs.items())}}


def builds(reports):
    """Of each peer that took part: engine, compiler, its version, flags."""
    known = {p["peer"]: [p.get(key) for key in ("engine", "compiler", "version", "flags")] for report in reports for p in report["peers"]}
    return dict(sorted(known.items()))


def measured(command, count, scratch, repetitions, wanted, with_cargo):
    """The record of this machine."""
    peers = json.loads(MANIFEST.read_text())
    begun, clean = datetime.date.today().isoformat(), not said("git", "status", "--porcelain")
    reports = {(kind, name): [] for kind, (names, *_) in KINDS.items() for name in names if name in wanted}
    for k in range(count):
        for (kind, name), own in reports.items():
            own.append(asked(command, kind, robots.ALL[name], scratch, k + 1, repetitions))
    reports = {key: quiet(own) for key, own in reports.items()}
    everything = [report for own in reports.values() for report in own]
    out = {}
    for name in wanted:
        robot = robots.ALL[name]
        own = lambda kind: reports.get((kind, name), [])
        functions = {f: of_function(own(kind), f) for kind, known in (("one", FUNCTIONS), ("more", MORE)) if own(kind) for f in known}
        out[name] = {
            "title": robot.title, "base": robot.base, "degrees_of_freedom": own("one")[0]["degrees_of_freedom"],
            "functions": functions, "batches": {f: of_batch(own("many"), f) for f in BATCHES}, "making": of_making(own("one")),
        }
    name, kind = processor()
    packages = {p: metadata.version(p) for p in ("libpinocchio", "cmeel-eigen", "casadi", "mujoco")}
    real, _, version = robots.package().partition("==")
    return {
        "date": begun, "commit": said("git", "rev-parse", "--short=12", "HEAD"), "clean": clean,
        "processor": kind, "processor_name": name, "cores": os.cpu_count(), "system": f"{platform.system()} {platform.release()}",
        "rustc": everything[0]["compiler"], "flags": everything[0]["flags"],
        "compilers": {f"{p['compiler']} {p['version']}": None for p in peers if p.get("compiler")}, "packages": {**packages, real: version},
        "runs": count, "counted": (count + 1) // 2, "repetitions": repetitions, "unit": "ns per call or state, medians of the runs that count; s where made",
        "builds": builds(everything), "robots": out, "cargo": cargo_times.measured(wanted, FUNCTIONS) if with_cargo else None,
    }


def written(record):
    """A line for each list of numbers."""
    record = {**record, "compilers": list(record["compilers"])}
    text = json.dumps(record, indent=1, ensure_ascii=False)
    return re.sub(r"\[\s+([^\[\]{}]*?)\s+\]", lambda m: "[" + re.sub(r",\s+", ", ", m.group(1)) + "]", text) + "\n"


def file_of(record):
    slug = re.sub(r"[^a-z0-9]+", "-", record["processor"].lower()).strip("-")
    return PLACE / f"{record['date']}-{slug}.json"


def least(times):
    """The fastest build's median; NaN where there is none."""
    return min((statistics.median(own) for own in times), default=math.nan)
