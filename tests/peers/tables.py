#!/usr/bin/env python3
"""Tables of docs/speed.md and numbers of other pages: measures, keeps what was measured in one file, and makes the tables of that file.

    python3 tests/peers/build.py --all         first: the peers
    python3 tests/peers/tables.py --runs 6     measures this machine, writes docs/speed/<date>-<processor>.json
    python3 tests/peers/tables.py --from FILE  prints the tables of such a file
    python3 tests/peers/tables.py --from FILE --write
                                               puts them into docs/speed.md, docs/batches.md and README.md, and draws docs/speed.svg
    python3 tests/peers/tables.py --check      exit status 1 where those pages are not what their file gives
    python3 tests/peers/tables.py --runs 1 --robots ur5 quadruped --repetitions 31 --no-cargo --out /tmp/try.json
                                               a short try

Robots take turns. Of each robot count those runs, half of them rounded up, that took all contenders together least time; the tables have the median over
these. Takes some six minutes a run and, for cargo's part, five more.
"""

import argparse
import json
import shlex
import sys
import tempfile
from pathlib import Path

import chart
import rendered
from environment import REPOSITORY


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--from", dest="file", type=Path, metavar="FILE", help="measure nothing: the tables of this file")
    parser.add_argument("--write", action="store_true", help="with --from: put them into the documents")
    parser.add_argument("--check", action="store_true", help="measure nothing: exit status 1 where the documents are not what their file gives")
    parser.add_argument("--runs", type=int, default=3, metavar="N", help="runs of each robot [default: 3]")
    parser.add_argument("--robots", nargs="+", metavar="NAME", help="these only [default: all of robots.py]")
    parser.add_argument("--repetitions", type=int, default=61, metavar="N", help="of `compare`, 31 at least [default: 61]")
    parser.add_argument("--no-cargo", action="store_true", help="leave out how long cargo takes")
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="where the answers of `compare` are kept, and not asked for again [default: nowhere]")
    parser.add_argument("--out", type=Path, metavar="FILE", help="where the record goes [default: docs/speed/<date>-<processor>.json]")
    parser.add_argument("--articulated", metavar="COMMAND", help="the command, in words: 'taskset -c 1 target/release/articulated' [default: built by cargo]")
    arguments = parser.parse_args()
    if arguments.check:
        return check()
    if arguments.write and not arguments.file:
        parser.error("--write: needs --from")
    if arguments.file:
        show(json.loads(arguments.file.read_text()), arguments.file, arguments.write)
        return 0
    if arguments.runs < 1:
        parser.error("--runs: at least one")
    measure(arguments, parser)
    return 0


def measure(arguments, parser):
    import environment

    environment.ensure_packages()
    import record
    import robots

    wanted = arguments.robots or list(robots.ALL)
    unknown = [name for name in wanted if name not in robots.ALL]
    if unknown:
        parser.error(f"--robots: no {', '.join(unknown)}; expected some of {', '.join(robots.ALL)}")
    if not record.MANIFEST.exists():
        raise SystemExit(f"{record.MANIFEST.relative_to(REPOSITORY)} is not there: python3 tests/peers/build.py --all")
    command = shlex.split(arguments.articulated) if arguments.articulated else ["cargo", "run", "--quiet", "--release", "-p", "articulated-cli", "--"]
    with tempfile.TemporaryDirectory() as scratch:
        folder = arguments.keep or Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        made = record.measured(command, arguments.runs, folder, arguments.repetitions, wanted, not arguments.no_cargo)
    file = arguments.out or record.file_of(made)
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(record.written(made), encoding="utf-8")
    print(f"{file}: python3 tests/peers/tables.py --from {file} --write", file=sys.stderr)


def show(made, file, write):
    if not write:
        for name, text in rendered.blocks(made, file.name).items():
            print(f"{name}\n\n{text}\n")
        return
    if file.resolve().parent != rendered.PLACE:
        raise SystemExit(f"{file}: documents are made of files in {rendered.PLACE.relative_to(REPOSITORY)}, which are in the repository")
    for document in rendered.DOCUMENTS:
        document.write_text(rendered.filled(document.read_text(encoding="utf-8"), made, file.name), encoding="utf-8")
    chart.CHART.write_text(chart.chart(), encoding="utf-8")


def check():
    """Whether the documents have what the file gives that docs/speed.md names."""
    file = rendered.named()
    made = json.loads((rendered.PLACE / file).read_text())
    status = 0
    for document in rendered.DOCUMENTS:
        text = document.read_text(encoding="utf-8")
        for name in rendered.differing(text, made, file):
            print(f"{document.relative_to(REPOSITORY)}: block {name} is not what docs/speed/{file} gives: "
                  f"python3 tests/peers/tables.py --from docs/speed/{file} --write", file=sys.stderr)
            status = 1
    if not made["clean"]:
        print(f"docs/speed/{file}: measured with changes that are not committed", file=sys.stderr)
        status = 1
    return status


if __name__ == "__main__":
    sys.exit(main())
