#!/usr/bin/env python3
"""Tables as in the README and docs/speed.md: `articulated compare` on four robots, several times over, with all peers.

    python3 tests/peers/build.py --all      first: the peers
    python3 tests/peers/tables.py           three runs of every robot; tables in Markdown
    python3 tests/peers/tables.py --runs 5 --keep FOLDER
                                            five runs; what `compare` says is kept in FOLDER, and not asked for again where it lies there

Robots take turns. Of each robot count those runs, half of them rounded up, that took all contenders together least time; the tables have the median over
these. Takes two minutes a run.
"""

import argparse
import json
import math
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from environment import REPOSITORY

MANIFEST = REPOSITORY / "target" / "peers" / "peers.json"
ROBOTS = {
    "ur5_like": "`ur5_like`, 6 joints",
    "panda_like": "`panda_like`, 7 joints",
    "quadruped": "`quadruped`, floating, 12 joints",
    "humanoid": "`humanoid`, floating, 30 joints",
}
FUNCTIONS = ["inverse_dynamics", "mass_matrix", "forward_dynamics", "inverse_dynamics_derivatives"]
BATCHES = ["inverse_dynamics", "forward_dynamics"]
ENGINES = {
    "Pinocchio": lambda engine: engine.startswith("Pinocchio") and "CasADi" not in engine,
    "CasADi, textbook": lambda engine: engine.startswith("CasADi"),
    "CasADi, templates": lambda engine: "by CasADi" in engine,
    "MuJoCo": lambda engine: engine.startswith("MuJoCo"),
}
RATIOS = {"Pinocchio / generated": ENGINES["Pinocchio"], "fastest generated C / generated": lambda engine: "CasADi" in engine}


class Run:
    """What `compare` said of one robot."""

    def __init__(self, report):
        self.functions = {f["function"]: f for f in report["functions"]}
        self.making = report["making"]

    def time(self, function, key):
        return self.functions[function][key]["median"]

    def variant(self, function):
        return self.functions[function]["variants"][0]["time"]["median"]

    def peer(self, function, wanted):
        """The fastest build of the wanted engines, ns."""
        times = [p["time"]["median"] for p in self.functions[function]["peers"] if wanted(p["engine"])]
        return min(times, default=math.nan)

    def batch(self, function, numbers, layout):
        return next(b for b in self.functions[function]["batches"] if (b["numbers"], b["layout"]) == (numbers, layout))["time"]["median"]

    def fastest_made(self):
        """Seconds to generate and compile of each function that generated C code whose calls take the least time."""
        fastest = lambda f: min((p for p in f["peers"] if "CasADi" in p["engine"] and p["cost"]), key=lambda p: p["time"]["median"])
        costs = [fastest(self.functions[f])["cost"] for f in FUNCTIONS]
        return sum(cost["generation_seconds"] + cost["compilation_seconds"] for cost in costs)

    def over(self, function, wanted):
        """How many times our time of a call that is."""
        return self.peer(function, wanted) / self.time(function, "generated")

    def over_batch(self, function, numbers):
        """How many times our time of a state in blocks Pinocchio's time of a call is."""
        return self.peer(function, ENGINES["Pinocchio"]) / self.batch(function, numbers, "blocks")

    def noise(self):
        """Grows with every contender's time, each weighing the same."""
        contenders = lambda f: [f["generated"], f["generic"], *(p["time"] for p in f["peers"])]
        return sum(math.log(c["median"]) for f in self.functions.values() for c in contenders(f))


def asked(command, robot, extra, file):
    """The run in a file; made first, if it is not there."""
    if not file.exists():
        print(f"{file.name} …", file=sys.stderr, flush=True)
        line = [*command, "compare", robot, *extra, "--peers-manifest", str(MANIFEST), "--format", "json"]
        done = subprocess.run(line, cwd=REPOSITORY, stdout=subprocess.PIPE, check=False)
        if done.returncode:
            raise SystemExit(f"{' '.join(line)}: exit status {done.returncode}")
        file.write_bytes(done.stdout)
    return Run(json.loads(file.read_text()))


def all_runs(command, count, folder, name, extra):
    """The runs of each robot that count."""
    runs = {robot: [] for robot in ROBOTS}
    for k in range(count):
        for robot in ROBOTS:
            runs[robot].append(asked(command, robot, extra, folder / f"{name}_{robot}_{k + 1}.json"))
    return {robot: sorted(own, key=Run.noise)[: (count + 1) // 2] for robot, own in runs.items()}


def median(runs, number):
    return statistics.median(number(run) for run in runs)


def shown(number):
    if math.isnan(number):
        return "–"
    return f"{number:.0f}" if number >= 100 else f"{number:.3g}"


def row(*cells):
    return "| " + " | ".join(cells) + " |"


def table(first, heads, rows):
    print(row(first, *heads))
    print("|---|" + "--:|" * len(heads))
    for line in rows:
        print(row(*line))
    print()


def titles(robot, functions):
    """The first cells of a robot's rows."""
    return [f"{ROBOTS[robot] if k == 0 else '—'}{':' if k == 0 else ''} `{f}`" for k, f in enumerate(functions)]


def single(runs):
    """ns per call, and ratios to the fastest."""
    for robot, own in runs.items():
        for title, f in zip(titles(robot, FUNCTIONS), FUNCTIONS):
            ours = median(own, lambda r: r.time(f, "generated"))
            others = [median(own, lambda r, e=engine: r.peer(f, e)) for engine in ENGINES.values()]
            over = [median(own, lambda r, e=engine: r.over(f, e)) for engine in RATIOS.values()]
            beside = [median(own, lambda r: r.variant(f)), median(own, lambda r: r.time(f, "generic"))]
            yield [title, *map(shown, [ours, *beside, *others]), *(f"{x:.1f}" for x in over)]


def ratios(one, many):
    """Times of Pinocchio's fastest build and of the fastest generated C over ours, a column for each robot; of batches, Pinocchio's over a state's in `f64` and `f32` blocks."""
    for f in FUNCTIONS:
        yield [f"`{f}`", *(" · ".join(f"{median(own, lambda r, e=e: r.over(f, e)):.1f}" for e in RATIOS.values()) for own in one.values())]
    for f in BATCHES:
        yield [f"`{f}`, many states", *(" · ".join(f"{median(own, lambda r, n=n: r.over_batch(f, n)):.0f}" for n in ("f64", "f32")) for own in many.values())]


def batches(runs):
    """ns per state, and ratios to a call of Pinocchio's fastest build."""
    for robot, own in runs.items():
        for title, f in zip(titles(robot, BATCHES), BATCHES):
            kinds = [(numbers, layout) for numbers in ("f64", "f32") for layout in ("blocks", "states")]
            times = [median(own, lambda r, k=kind: r.batch(f, *k)) for kind in kinds]
            over = [median(own, lambda r, n=n: r.over_batch(f, n)) for n in ("f64", "f32")]
            yield [title, *map(shown, [*times, median(own, lambda r: r.time(f, "generated"))]), *(f"{x:.0f}" for x in over)]


def making(runs):
    """Seconds to generate and compile all functions of the table, ours the least of the runs, and how many times that a generator of C takes with each compiler, and for those
    builds that its times of a call are of."""
    for robot, own in runs.items():
        sets = [m for r in own for m in r.making if len(m["functions"]) == len(FUNCTIONS)]
        ours = min(m["generation_seconds"] + m["compilation_seconds"] for m in sets)
        theirs = {}
        for peer in (p for m in sets for p in m["peers"] if p["generation_seconds"]):
            code = peer["peer"].removesuffix("_fastmath").removesuffix("_O3_native")
            seconds = peer["generation_seconds"] + peer["compilation_seconds"]
            theirs[code] = min(seconds, theirs.get(code, seconds))
        theirs = {f"`{code}`": seconds for code, seconds in theirs.items()}
        theirs["each function's fastest build"] = median(own, Run.fastest_made)
        for code, seconds in sorted(theirs.items(), key=lambda item: item[1]):
            yield [ROBOTS[robot], code, f"{ours:.2f}", f"{seconds:.1f}", f"{seconds / ours:.1f}"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=3, metavar="N", help="runs of each robot [default: 3]")
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="where the answers of `compare` are kept [default: nowhere]")
    parser.add_argument("--articulated", metavar="PATH", help="the command [default: built by cargo]")
    arguments = parser.parse_args()
    if arguments.runs < 1:
        parser.error("--runs: at least one")
    if not MANIFEST.exists():
        raise SystemExit(f"{MANIFEST.relative_to(REPOSITORY)} is not there: python3 tests/peers/build.py --all")
    command = [arguments.articulated] if arguments.articulated else ["cargo", "run", "--quiet", "--release", "-p", "articulated-cli", "--"]
    with tempfile.TemporaryDirectory() as scratch:
        folder = arguments.keep or Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        one = all_runs(command, arguments.runs, folder, "one", ["--functions", ",".join(FUNCTIONS)])
        many = all_runs(command, arguments.runs, folder, "many", ["--functions", ",".join(BATCHES), "--batch", "f64,f32"])
    table("ns per call", ["generated", "any processor", "generic", *ENGINES, *RATIOS], single(one))
    layouts = ["`f64` blocks", "`f64` states", "`f32` blocks", "`f32` states", "one at a time"]
    table("ns per state", [*layouts, "Pinocchio / `f64` blocks", "Pinocchio / `f32` blocks"], batches(many))
    table("Pinocchio · fastest generated C; of many states, `f64` · `f32` blocks", [f"`{robot}`" for robot in ROBOTS], ratios(one, many))
    table("all four functions generated and compiled", ["by", "ours, s", "theirs, s", "theirs / ours"], making(one))
    return 0


if __name__ == "__main__":
    sys.exit(main())
