#!/usr/bin/env python3
"""Runs every command on robots' files: no panic, documented exit codes, and reports that are JSON.

    python3 tests/every_command.py FILE...

The oracles of formats call `complaints` on each file that they read. Exit status: 0 if no command has a complaint, else 1.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
from programs import COMMAND, build_command  # noqa: E402

# As `articulated --help` lists them: all is well, wrong input, a bound that is exceeded, a motion outside its tolerance.
DOCUMENTED = {0, 1, 4, 5}
# Seconds, and MB of code: larger functions are refused before they are generated.
LIMIT, SIZE = 120, "1"
FUNCTIONS = "placements,inverse_dynamics,mass_matrix,torque_regressor,kinetic_energy_regressor"


def complaints(path, options=()):
    """What is wrong with the answers about a file, a sentence each. `options` are for reading it."""
    found = []
    report = asked(["check", path, *options], found)
    if not report.get("usable"):
        return found
    asked(["generate", path, "--functions", "inverse_dynamics", *options], found)
    asked(["generate", path, "--functions", "inverse_dynamics", "--language", "c", "--prefix", "robot", *options], found)
    with tempfile.NamedTemporaryFile("w", suffix=".json") as states:
        json.dump([state(report)], states)
        states.flush()
        asked(["eval", path, "--function", FUNCTIONS, "--states", states.name, "--generic", *options], found, {0})
    if not options:
        asked(["functions", path, "--max-code-size", SIZE], found)
        asked(["effects", path, "--functions", "inverse_dynamics"], found)
        asked(["simulate", path, "--end", "0.002"], found)
    return found


def asked(words, found, statuses=frozenset(DOCUMENTED)):
    """The report of a command, empty if there is none; adds to what is `found`."""
    words = [str(word) for word in words]
    try:
        done = subprocess.run([str(COMMAND), *words, "--format", "json"], capture_output=True, text=True, timeout=LIMIT)
    except subprocess.TimeoutExpired:
        found.append(f"{words[0]}: no answer in {LIMIT} s")
        return {}
    if done.returncode not in statuses or "panicked" in done.stderr:
        found.append(f"{words[0]}: exit status {done.returncode}: {' '.join(done.stderr.split())[:300]}")
    try:
        report = json.loads(done.stdout)
    except ValueError as error:
        found.append(f"{words[0]}: the report is not JSON: {error}")
        return {}
    return report if isinstance(report, dict) else {}


def state(report):
    """A state of the robot of a report of `check`: quaternions that turn nothing, and small numbers."""
    nq, nv = report["totals"]["coordinates"], report["totals"]["degrees_of_freedom"]
    q = [0.01 * (k + 1) for k in range(nq)]
    for joint in report["joints"]:
        if joint["q"] and joint["kind"] in {"floating", "spherical"}:
            first = joint["q"][0] + (3 if joint["kind"] == "floating" else 0)
            q[first : first + 4] = [0.0, 0.0, 0.0, 1.0]
    return {"q": q, "v": [0.1 * (k + 1) for k in range(nv)], "a": [-0.2 * (k + 1) for k in range(nv)]}


def main():
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        print(__doc__)
        return 0 if sys.argv[1:2] in (["-h"], ["--help"]) else 2
    build_command()
    wrong = 0
    for path in map(Path, sys.argv[1:]):
        for sentence in complaints(path):
            print(f"{path}: {sentence}")
            wrong += 1
    print(f"{len(sys.argv) - 1} files, {wrong} complaints")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
