#!/usr/bin/env python3
"""Bars of the table of real robots in docs/speed.md: how many times as long as generated code others take.

    python3 tests/peers/chart.py            writes docs/speed.svg
    python3 tests/peers/chart.py --check    exit status 1 where that is not what the table gives
"""

import argparse
import json
import sys

import rendered
from environment import REPOSITORY

CHART = REPOSITORY / "docs" / "speed.svg"
BLOCK = "<!-- speed: real -->"
HEAD = "| ns per call |"
# The name of a bar, its number in a row, and its colour.
BARS = [
    ("fastest C code by CasADi", lambda row: row["fastest generated C / generated"], "#3f8f5b"),
    ("Pinocchio", lambda row: row["Pinocchio / generated"], "#d9822b"),
    ("MuJoCo", lambda row: row["MuJoCo"] and row["MuJoCo"] / row["generated"], "#7a5195"),
]

WIDTH, MARGIN, TOP = 900, 16, 92
BAR, BETWEEN, TITLE = 13, 8, 26
LABELS, NUMBERS = 120, 34


def machine():
    """What the table was measured on, by the record that it is made of."""
    processor = json.loads((rendered.PLACE / rendered.named()).read_text())["processor"]
    return f"One core, {processor}, built for it; sines and cosines inside; of each its fastest build"


def number(cell):
    return None if cell == "–" else float(cell)


def rows():
    """Robot, function, and the bars of each row."""
    lines = iter(rendered.SPEED.read_text(encoding="utf-8").partition(BLOCK)[2].splitlines())
    heads = cells(next(line for line in lines if line.startswith(HEAD)))[1:]
    next(lines)
    robot = ""
    for line in lines:
        if not line.startswith("|"):
            return
        title, *values = cells(line)
        name, function = title.rsplit(" ", 1)
        robot = robot if name == "—" else name.rstrip(":").replace("`", "")
        row = dict(zip(heads, map(number, values)))
        yield robot, function.strip("`"), [measure(row) for _, measure, _ in BARS]


def cells(line):
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def panels():
    """The functions of each robot."""
    out = {}
    for robot, function, bars in rows():
        out.setdefault(robot, []).append((function, bars))
    return out


def text(x, y, words, more=""):
    return f'<text x="{x:.1f}" y="{y:.1f}"{more}>{words}</text>'


def panel(x, y, width, scale, robot, functions):
    """One robot: a group of bars for each function. What is drawn, and where it ends."""
    yield text(x, y + 16, robot, ' font-weight="bold"')
    y += TITLE
    start = x + LABELS
    for function, bars in functions:
        words = function.replace("_derivatives", " derivatives").split(" ")
        for k, word in enumerate(words):
            yield text(start - 8, y + 0.5 * len(BARS) * BAR + 4 + 14 * (k - 0.5 * (len(words) - 1)), word, ' text-anchor="end"')
        for (name, _, colour), ratio in zip(BARS, bars):
            if ratio is not None:
                long = (width - LABELS - NUMBERS) * ratio / scale
                yield f'<rect x="{start:.1f}" y="{y + 1:.1f}" width="{long:.1f}" height="{BAR - 2}" fill="{colour}"><title>{function}: {name} {ratio:.1f}×</title></rect>'
                yield text(start + long + 4, y + BAR - 3, f"{ratio:.1f}", ' font-size="10.5" fill="#444444"')
            else:
                yield text(start + 14, y + BAR - 3, "–", ' font-size="10.5" fill="#888888"')
            y += BAR
        # Generated code is one.
        one = start + (width - LABELS - NUMBERS) / scale
        yield f'<path d="M{one:.1f} {y - len(BARS) * BAR - 3:.1f}V{y + 3:.1f}" stroke="#1b6ca8" stroke-width="2"/>'
        y += BETWEEN


def chart():
    robots = panels()
    width = (WIDTH - 3 * MARGIN) / 2
    high = TITLE + max(len(f) for f in robots.values()) * (len(BARS) * BAR + BETWEEN) + 14
    scale = max(b for f in robots.values() for _, bars in f for b in bars if b is not None)
    height = TOP + (len(robots) + 1) // 2 * high
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{height}" viewBox="0 0 {WIDTH} {height}" '
        'font-family="DejaVu Sans, Verdana, Arial, sans-serif" font-size="12">',
        '<rect width="100%" height="100%" fill="white"/>',
        text(MARGIN, 26, "How many times as long as generated code others take", ' font-size="16" font-weight="bold"'),
        text(MARGIN, 46, machine(), ' fill="#555555"'),
    ]
    x = MARGIN
    for name, _, colour in [*BARS, ("generated: 1", None, "#1b6ca8")]:
        out.append(f'<rect x="{x}" y="60" width="12" height="12" fill="{colour}"/>')
        out.append(text(x + 18, 70, name))
        x += 44 + 7.2 * len(name)
    for k, (robot, functions) in enumerate(robots.items()):
        out += panel(MARGIN + k % 2 * (width + MARGIN), TOP + k // 2 * high, width, scale, robot, functions)
    return "\n".join([*out, "</svg>\n"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="write nothing; exit status 1 where the chart is not that of the table")
    if not parser.parse_args().check:
        CHART.write_text(chart(), encoding="utf-8")
    elif not CHART.exists() or CHART.read_text(encoding="utf-8") != chart():
        print(f"{CHART.relative_to(REPOSITORY)} is not that of the table in docs/speed.md: python3 tests/peers/chart.py", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
