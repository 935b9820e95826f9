"""The summaries of docs/site/data in the documentation: a line for each package. verdicts.py says
who writes the data.
"""

import collections

from verdicts import REPOSITORY, read

DOCS = REPOSITORY / "docs"
BEGIN, END = "<!-- files: written by tests/sdf/oracle.py --write -->", "<!-- end of files -->"


def write(corpus):
    """Writes the summary of a corpus, if it has one."""
    if corpus in PAGES and read(corpus):
        path, text = PAGES[corpus]
        path.write_text(text(), encoding="utf-8")


def complaints():
    """Sentences about pages that are not those of the data."""
    again = "`python3 tests/verdicts.py --write` writes it"
    return [f"{path}: it is not the summary of docs/site/data/{corpus}.json; {again}"
            for corpus, (path, text) in PAGES.items() if read(corpus) and path.read_text(encoding="utf-8") != text()]


def table(titles, rows):
    """A Markdown table; all columns but the first are numbers."""
    lines = ["| " + " | ".join(titles) + " |", "| --- " + "| ---: " * (len(titles) - 1) + "|"]
    return lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows]


def total(rows):
    """A last row with the sums of the columns."""
    return ["**all**", *(sum(column) for column in list(zip(*rows))[1:])]


def merged(corpus, key, how):
    """The numbers of all packages under a key, put together by `how`."""
    found = {}
    for package in read(corpus).values():
        for name, value in package.get(key, {}).items():
            found[name] = how(found[name], value) if name in found else value
    return sorted(found.items())


def listed(corpus, kinds):
    """A line for each file whose verdict is of one of these kinds."""
    files = [(name, file, found["verdict"]) for name, package in read(corpus).items() for file, found in package["files"].items()]
    return [f"* {name}: {file}: {verdict}" for name, file, verdict in files if verdict.startswith(kinds)]


def details(corpus, example):
    """How to see each file."""
    return [
        f"All files with their verdicts, or those of a package: `python3 tests/verdicts.py {corpus}`, `python3 tests/verdicts.py {corpus} {example}`.",
        "The data: [docs/site/data](site/data). `python3 docs/site/build.py` makes a gallery of them, with a picture of each robot.",
    ]


def mjcf():
    """docs/mjcf-files.md"""
    rows = []
    for name, package in read("mjcf").items():
        verdicts = [found["verdict"] for found in package["files"].values()]
        compiled = [verdict for verdict in verdicts if not verdict.startswith("refused by MuJoCo")]
        rows.append([name, len(verdicts), len(compiled), sum(not verdict.startswith("refused") for verdict in compiled), compiled.count("equal")])
    out = ["# MJCF files of Python packages", ""]
    out += ["Written by `python3 tests/mjcf/oracle.py --write`; [mjcf.md](mjcf.md) says what is compared.", ""]
    out += [*table(["package", "files", "MuJoCo compiles", "read here", "equal"], [*rows, total(rows)]), ""]
    out += ["Files that MuJoCo refuses are parts of others, or their meshes are not in the package.", ""]
    wrong = listed("mjcf", ("differs", "refused:"))
    out += ["Files that differ or are refused here:", "", *wrong, ""] if wrong else ["No file differs, and none that MuJoCo compiles is refused here.", ""]
    out += [*details("mjcf", "robosuite"), "", "## Largest differences", ""]
    out += ["Of the scale of each number, of all equal files:", ""]
    out += [*table(["number", "difference"], [[name, f"{value:.1e}"] for name, value in merged("mjcf", "largest_differences", max)]), ""]
    out += ["## What was compared", ""]
    out += table(["thing", "count"], merged("mjcf", "compared", lambda a, b: a + b))
    return "\n".join(out) + "\n"


CONTACT = """# Files with constraints

Every MJCF file of nine packages that MuJoCo 4.0.0 compiles and that has constraints, by `python3 tests/mjcf/contact.py --all --write`:
steps with all constraints beside `mj_step`, by Euler, in 4 states of a motion. What is left out is off on both sides. See [contact](contact.md).

* Equal: one step differs by at most 1e-10 of the largest rate, and the contacts after it (points, normals, forces, moments) by at most 1e-8.
* Equal without: kinds of pairs or constraints that are not computed are left out on both sides, and the rest is equal.
* Steps, in the list of files: the difference after 1000 steps over that of two MuJoCo rollouts whose starts differ by one unit in the last
  place; 10 are allowed, 30 with a free body.
"""


def contact():
    """docs/contact-files.md"""
    rows, without = [], collections.Counter()
    kinds = ["equal", "equal without", "differs", "differs without", "refused"]
    for name, package in read("contact").items():
        counts = collections.Counter(found["verdict"].partition(":")[0] for found in package["files"].values())
        rows.append([name, len(package["files"]), *(counts[kind] for kind in kinds)])
        without.update(kind for found in package["files"].values() for kind in found["without"].split(", ") if kind)
    shown = [0, 1, *(k + 2 for k, kind in enumerate(kinds) if k < 3 or any(row[k + 2] for row in rows))]
    titles = ["package", "files", *kinds]
    rows = [[row[k] for k in shown] for row in [*rows, total(rows)]]
    out = [CONTACT, *table([titles[k] for k in shown], rows), ""]
    wrong = listed("contact", ("differs", "refused"))
    out += ["Files that differ or are refused ([why](contact.md#limits)):", "", *wrong, ""] if wrong else []
    out += [*details("contact", "robosuite"), "", "## What is left out", ""]
    out += [*table(["pair or constraint", "files that may have it"], sorted(without.items(), key=lambda one: (-one[1], one[0])))]
    return "\n".join(out) + "\n"


def sdf():
    """docs/sdf.md, with the summary between its marks."""
    rows = []
    for name, package in read("sdf").items():
        verdicts = [found["verdict"] for found in package["files"].values()]
        kinds = ("equal", "refused by Drake", "refused by both")
        counts = [sum(verdict.startswith(kind) for verdict in verdicts) for kind in kinds]
        rows.append([name, len(verdicts), *counts, len(verdicts) - sum(counts)])
    differences = ", ".join(f"{name} {value:.1e}" for name, value in merged("sdf", "largest_differences", max))
    out = table(["package", "files", "equal", "refused by Drake alone", "refused by both", "others"], [*rows, total(rows)])
    out += ["", f"Largest differences: {differences}." if differences else "", "", *details("sdf", "drake")]
    path = DOCS / "sdf.md"
    text = path.read_text(encoding="utf-8")
    before, rest = text.split(BEGIN)
    return before + "\n".join([BEGIN, *out, END]) + rest.split(END)[1]


PAGES = {"mjcf": (DOCS / "mjcf-files.md", mjcf), "contact": (DOCS / "contact-files.md", contact), "sdf": (DOCS / "sdf.md", sdf)}
