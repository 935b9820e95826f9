#!/usr/bin/env python3
"""Draws the figures of the book, docs/book/src/figures/*.svg.

    python3 docs/book/figures.py            writes them
    python3 docs/book/figures.py --check    exit status 1 where the files are not those of this program

Standard library only. Points in space are computed and projected: poses from joint values, paths by
sampling, and numbers of the text are compared with the text.
"""

import argparse
import sys
from pathlib import Path

from drawing import motion, recursions, robots

PLACE = Path(__file__).resolve().parent / "src" / "figures"
FIGURES = {
    "frames": motion.frames,
    "screw": motion.screw,
    "twist": motion.twist,
    "sweeps": recursions.sweeps,
    "rnea-body": recursions.rnea_body,
    "composite": recursions.composite,
    "sparsity": robots.sparsity,
    "articulated-body": recursions.articulated,
    "hinge": recursions.hinge,
    "wrist": motion.wrist,
    "quaternion": motion.quaternion,
    "pendulum": robots.pendulum,
    "golfer": robots.golfer,
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="write nothing; exit status 1 where a file is not the program's")
    check = parser.parse_args().check
    try:
        drawn = {PLACE / f"{name}.svg": figure().svg() for name, figure in FIGURES.items()}
    except ValueError as error:
        print(error, file=sys.stderr)
        return 1
    if not check:
        PLACE.mkdir(exist_ok=True)
        for path, svg in drawn.items():
            path.write_text(svg, encoding="utf-8")
        return 0
    kept = {path: path.read_text(encoding="utf-8") for path in sorted(PLACE.glob("*.svg"))}
    wrong = [f"{path.name} is not what docs/book/figures.py draws" for path, svg in drawn.items() if kept.get(path) != svg]
    wrong += [f"{path.name} is no figure of docs/book/figures.py" for path in kept if path not in drawn]
    for line in wrong:
        print(f"docs/book/src/figures: {line}; without --check it writes all figures", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
