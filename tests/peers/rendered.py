"""Tables and sentences made of a record of tables.py, and where they stand in the documents: between `<!-- speed: NAME -->` and `<!-- /speed -->`."""

import math
import re
import statistics

from environment import REPOSITORY

PLACE = REPOSITORY / "docs" / "speed"
README, SPEED, BATCHES_PAGE = (REPOSITORY / name for name in ("README.md", "docs/speed.md", "docs/batches.md"))
DOCUMENTS = (README, SPEED, BATCHES_PAGE)
# A sentence or a picture begins on its own line: Markdown takes the rest of a line that begins with a comment for HTML.
BLOCK = re.compile(r"(<!-- speed: ([a-z ]+) -->(?:\n(?=\w|!\[))?)(.*?)(<!-- /speed -->)", re.DOTALL)
FILE = re.compile(r"speed/([0-9][0-9a-z-]*\.json)")

BUNDLED = ["ur5_like", "panda_like", "quadruped", "humanoid"]
FUNCTIONS = ["inverse_dynamics", "mass_matrix", "forward_dynamics", "inverse_dynamics_derivatives"]
MORE = ["forward_dynamics_derivatives", "mass_matrix_inverse", "jacobians_world_aligned"]
BATCHES = ["inverse_dynamics", "forward_dynamics"]
ENGINES = {
    "Pinocchio": lambda engine: engine.startswith("Pinocchio") and "CasADi" not in engine,
    "CasADi": lambda engine: "CasADi" in engine and "inlined sine" not in engine and "vectors" not in engine,
    "CasADi, inlined sine": lambda engine: "CasADi" in engine and "inlined sine" in engine,
    "MuJoCo": lambda engine: engine.startswith("MuJoCo"),
}
ANY_C = lambda engine: "CasADi" in engine and "vectors" not in engine  # noqa: E731
RATIOS = {"Pinocchio / generated": ENGINES["Pinocchio"], "fastest generated C / generated": ANY_C}


# ---- numbers

def median(numbers):
    return statistics.median(numbers) if numbers else math.nan


def shown(number):
    if math.isnan(number):
        return "–"
    return f"{number:.0f}" if number >= 100 else f"{number:.3g}"


def times(ratio):
    if math.isnan(ratio):
        return "–"
    return f"{ratio:.1f}" if ratio < 100 else f"{ratio:.0f}"


class Record:
    """What was measured, by who is asked for."""

    def __init__(self, made):
        self.made, self.robots, self.builds = made, made["robots"], made["builds"]

    def fastest(self, times_of, wanted):
        """The least median of the builds of the wanted engines."""
        own = [median(numbers) for peer, numbers in times_of.items() if wanted(self.builds[peer][0])]
        return min(own, default=math.nan)

    def function(self, robot, name):
        return self.robots[robot]["functions"].get(name)

    def over(self, robot, name, wanted):
        """How many times our time of a call that is."""
        f = self.function(robot, name)
        return self.fastest(f["peers"], wanted) / median(f["generated"])


def titles(record, robot, functions):
    """The first cells of a robot's rows."""
    return [f"{record.robots[robot]['title'] if k == 0 else '—'}{':' if k == 0 else ''} `{f}`" for k, f in enumerate(functions)]


def row(*cells):
    return "| " + " | ".join(cells) + " |"


def table(first, heads, rows):
    return "\n".join([row(first, *heads), "|---|" + "--:|" * len(heads), *(row(*line) for line in rows)])


# ---- tables

def single(record, names):
    """ns per call, and ratios to the fastest."""
    def rows():
        for robot in names:
            for title, name in zip(titles(record, robot, FUNCTIONS), FUNCTIONS):
                f = record.function(robot, name)
                ours = [median(f["generated"]), median(f["any processor"] or f["generated"]), median(f["generic"])]
                yield [title, *map(shown, ours), *(shown(record.fastest(f["peers"], e)) for e in ENGINES.values()),
                       *(times(record.over(robot, name, e)) for e in RATIOS.values())]
    return table("ns per call", ["generated", "any processor", "generic", *ENGINES, *RATIOS], rows())


def ratios(record, names):
    """Pinocchio's fastest build and the fastest generated C over ours."""
    rows = ([f"`{f}`", *(" · ".join(times(record.over(robot, f, e)) for e in RATIOS.values()) for robot in names)] for f in FUNCTIONS)
    return table("Pinocchio · fastest C by CasADi", [record.robots[robot]["title"].split(",")[0] for robot in names], rows)


def dependent(record):
    """Calls that wait for each other, of functions whose result peers write out."""
    def rows():
        for robot in record.robots:
            for title, name in zip(titles(record, robot, BATCHES), BATCHES):
                f = record.function(robot, name)
                ours, waiting = median(f["dependent"]["generated"]), f["dependent"]["peers"]
                theirs = [record.fastest(waiting, e) for e in (*ENGINES.values(), ANY_C)]
                yield [title, shown(ours), times(ours / median(f["generated"])), *map(shown, theirs[:-1]), times(theirs[0] / ours), times(theirs[-1] / ours)]
    return table("ns per call that waits", ["generated", "waits / does not", *ENGINES, *RATIOS], rows())


def more(record):
    """Other functions of the bundled robots."""
    def rows():
        for robot in (name for name in BUNDLED if name in record.robots):
            for title, name in zip(titles(record, robot, MORE), MORE):
                f = record.function(robot, name)
                yield [title, shown(median(f["generated"])), *(shown(record.fastest(f["peers"], e)) for e in list(ENGINES.values())[:3]),
                       *(times(record.over(robot, name, e)) for e in RATIOS.values())]
    return table("ns per call", ["generated", *list(ENGINES)[:3], *RATIOS], rows())


def generic(record):
    """Times of generic code over those of Pinocchio's fastest build."""
    def rows():
        for name in FUNCTIONS + MORE:
            known = [(robot, record.function(robot, name)) for robot in record.robots]
            yield [f"`{name}`", *(f"{median(f['generic']) / record.fastest(f['peers'], ENGINES['Pinocchio']):.2f}" if f else "–" for _, f in known)]
    return table("generic / Pinocchio", [r["title"].split(",")[0] for r in record.robots.values()], rows())


def many(record):
    """ns per state, and ratios of a call of Pinocchio's and a state of CasADi's code in vectors."""
    kinds = ["f64 blocks", "f64 states", "f32 blocks", "f32 states"]

    def rows():
        for robot, own in record.robots.items():
            for title, name in zip(titles(record, robot, BATCHES), BATCHES):
                b = own["batches"][name]
                ours = {kind: median(b[kind]) for kind in kinds}
                pinocchio = record.fastest(b["peers"], ENGINES["Pinocchio"])
                lanes = record.fastest(b["lanes"], lambda engine: True)
                yield [title, *(shown(x) for x in ours.values()), shown(median(b["one at a time"])), shown(lanes), times(lanes / ours["f64 blocks"]),
                       times(pinocchio / ours["f64 blocks"]), times(pinocchio / ours["f32 blocks"])]
    heads = [*(f"`{kind.split()[0]}` {kind.split()[1]}" for kind in kinds), "one at a time", "CasADi in vectors", "CasADi in vectors / `f64` blocks",
             "Pinocchio's call / `f64` blocks", "Pinocchio's call / `f32` blocks"]
    return table("ns per state", heads, rows())


def making(record):
    """Seconds to generate and compile the four functions."""
    known = {robot: own["making"] for robot, own in record.robots.items() if own["making"]}
    compilers = {}
    for own in known.values():
        for peer, seconds in own["peers"].items():
            engine, compiler, version, _ = record.builds[peer]
            source = "CasADi's C of Pinocchio's templates" if engine.startswith("Pinocchio") else "CasADi's C of the textbook"
            kind = f"{source}, {compiler.split('-')[0]} {version.split('.')[0]}"
            compilers.setdefault(kind, []).append(peer)
    theirs = lambda own, peers: min((own["peers"][p] for p in peers if p in own["peers"]), default=math.nan)
    seconds = lambda x: "–" if math.isnan(x) else f"{x:.2f}" if x < 10 else f"{x:.0f}"
    rows = [["generated Rust", *(seconds(own["generated"]) for own in known.values())]]
    rows += [[kind, *(seconds(theirs(own, peers)) for own in known.values())] for kind, peers in sorted(compilers.items())]
    return table("s", [record.robots[r]["title"].split(",")[0] for r in known], rows)


def cargo(record):
    """Seconds of `cargo build --release` of a user's crate."""
    told = record.made["cargo"]
    if not told:
        return "*Not measured.*"
    names = [name for name in record.robots if all(name in way["crates"] for way in told.values())]
    rows = [[way, f"{own['from nothing']:.0f}", *(f"{own['crates'][name]:.2f}" for name in names)] for way, own in told.items()]
    return table("`cargo build --release`, s", ["all that it needs, from nothing", *(record.robots[n]["title"].split(",")[0] for n in names)], rows)


# ---- sentences

def listed(words):
    words = list(words)
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


def fast(record):
    """The README's first claim."""
    what = {"panda_like": "a seven-axis arm", "quadruped": "a quadruped on a floating base", "humanoid": "a 30-joint humanoid"}
    names = [name for name in what if name in record.robots]
    f = "inverse_dynamics"
    took = listed(f"{what[name]} in {shown(median(record.function(name, f)['generated']))} ns" for name in names)
    over = [listed(times(record.over(name, f, e)) for name in names) for e in RATIOS.values()]
    article = "an" if record.made["processor"][0] in "AEIOU" else "a"
    anywhere = listed(shown(median(record.function(name, f)["any processor"])) for name in names)
    return (f"Inverse dynamics of {took}, sines and cosines included: {over[0]} times as fast as Pinocchio's fastest build and {over[1]} times as fast as the "
            f"fastest C code by CasADi, measured side by side on one core of {article} {record.made['processor']}. These builds are for that processor, and calls "
            f"do not wait for each other's results; a build without flags takes {anywhere} ns")


def machine(record, file):
    """What the numbers were measured on, and with."""
    made = record.made
    commit = made["commit"] + ("" if made["clean"] else " with changes that are not committed")
    packages = ", ".join(f"{name} {version}" for name, version in made["packages"].items())
    return (f"{made['date']}, commit {commit}, {made['processor']} ({made['processor_name']}), {made['cores']} cores, one of them used; {made['rustc']}, "
            f"{listed(made['compilers'])}; {packages}. Of {made['runs']} runs of each robot with {made['repetitions']} repetitions the {made['counted']} with least time of all contenders together "
            f"count: [all numbers]({file}).")


def alternative(record, chart):
    """What the chart shows, in words."""
    def span(wanted):
        found = [record.over(robot, f, wanted) for robot in record.robots if robot not in BUNDLED for f in FUNCTIONS]
        found = [x for x in found if not math.isnan(x)]
        return f"{min(found):.2g} to {max(found):.2g}"
    return ("![How many times as long as generated code others take: C code by CasADi "
            f"{span(ANY_C)}, Pinocchio {span(ENGINES['Pinocchio'])}, MuJoCo {span(ENGINES['MuJoCo'])}]({chart})")


def states(record):
    """Of many states at once, in docs/batches.md."""
    names = [name for name in BUNDLED if name in record.robots]
    of = lambda kind: listed(shown(median(record.robots[name]["batches"]["inverse_dynamics"][kind])) for name in names)
    robots = listed(f"`{name}`" for name in names)
    return (f"On the machine of [the tables](speed.md) a state in blocks takes {of('f64 blocks')} ns (`f32`: {of('f32 blocks')}) for inverse dynamics of {robots}, from states "
            f"one after the other {of('f64 states')} (`f32`: {of('f32 states')}).")


def blocks(made, file):
    """Name -> text."""
    record = Record(made)
    bundled = [name for name in BUNDLED if name in record.robots]
    real = [name for name in record.robots if name not in BUNDLED]
    return {
        "fast": fast(record) if "panda_like" in record.robots else "",
        "machine of speed": machine(record, f"speed/{file}"),
        "bundled": single(record, bundled), "real": single(record, real), "ratios": ratios(record, real),
        "chart": alternative(record, "docs/speed.svg") if real else "", "chart of speed": alternative(record, "speed.svg") if real else "",
        "dependent": dependent(record), "more": more(record), "generic": generic(record), "many": many(record), "states": states(record) if bundled else "",
        "making": making(record), "cargo": cargo(record),
    }


# ---- documents

def placed(text):
    """Tables and lists stand on lines of their own."""
    return f"\n{text}\n" if text.startswith("|") else text


def filled(document, made, file):
    """The document with what the record gives."""
    known = blocks(made, file)
    return BLOCK.sub(lambda m: m.group(1) + placed(known[m.group(2)]) + m.group(4), document)


def differing(document, made, file):
    """The names of blocks that are not what the record gives."""
    known = blocks(made, file)
    return [m.group(2) for m in BLOCK.finditer(document) if m.group(3) != placed(known.get(m.group(2), ""))]


def named():
    """The file that docs/speed.md is made of."""
    found = set(FILE.findall(SPEED.read_text(encoding="utf-8")))
    if len(found) != 1:
        raise SystemExit(f"{SPEED.relative_to(REPOSITORY)}: found {len(found)} names of records, expected one")
    return found.pop()
