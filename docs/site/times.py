#!/usr/bin/env python3
"""Measures the generated code of robots of the gallery, and keeps the times in
docs/site/times.json.

    python3 docs/site/times.py --robots 10     ten robots of small packages
    python3 docs/site/times.py --only panda    robots whose package or path has this word
    python3 docs/site/times.py --all           all robots, which takes hours
    python3 docs/site/times.py --only g1 --again    also those that have times already

`articulated compare FILE` generates inverse and forward dynamics, compiles them with rustc, and
measures one call: the median in ns. The times of one table are those of one processor: on another
one `--anew` begins a new table. A robot that `compare` does not measure is named with its reason,
and gets no times.

Needs rustc, and the command of ARTICULATED_COMMAND, or cargo, which builds it. Exit status: 0, or 1
where nothing is measured.
"""

import argparse
import json
import platform
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
TABLE = HERE / "times.json"
FUNCTIONS = ["inverse_dynamics", "forward_dynamics"]
SECONDS = 600


def recorded():
    """The table: processor, compiler, flags, and `times`, ns by package, file and function."""
    return json.loads(TABLE.read_text(encoding="utf-8")) if TABLE.exists() else {}


def processor():
    """The name of the processor."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        return next(line.split(":", 1)[1].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.processor() or platform.machine()


def measure(command, path):
    """The report of `compare`, or the reason for none."""
    words = [str(command), "compare", str(path), "--functions", ",".join(FUNCTIONS), "--repetitions", "31", "--states", "4", "--format", "json"]
    try:
        done = subprocess.run(words, capture_output=True, text=True, timeout=SECONDS)
        report = json.loads(done.stdout)
    except subprocess.TimeoutExpired:
        return None, f"takes more than {SECONDS} s"
    except ValueError:
        return None, done.stderr.strip()[:200] or f"exit status {done.returncode}"
    if report.get("degrees_of_freedom") == 0:
        return None, "no freedoms"
    if not report.get("functions"):
        return None, "; ".join(error["message"] for error in report.get("errors", []))[:200] or "no function is defined"
    return report, None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    chosen = parser.add_mutually_exclusive_group(required=True)
    chosen.add_argument("--robots", type=int, metavar="N", help="so many robots, those of small packages first")
    chosen.add_argument("--only", metavar="WORD", help="robots whose package or path has this word")
    chosen.add_argument("--all", action="store_true", help="all robots")
    parser.add_argument("--again", action="store_true", help="also robots that have times")
    parser.add_argument("--anew", action="store_true", help="begin a new table")
    arguments = parser.parse_args()
    import corpora
    from programs import build_command

    table = {} if arguments.anew else recorded()
    if table and table["processor"] != processor():
        sys.exit(f"error: {TABLE}: found times of {table['processor']}, but this is {processor()}; --anew begins a new table")
    wanted = corpora.robots(arguments.robots, arguments.only or "")
    if not wanted:
        sys.exit("error: found no such robot in docs/site/data, expected a part of the name of a package or of a path")
    command, folders, count = build_command(), {}, 0
    for robot in wanted:
        times = table.get("times", {})
        if robot.file in times.get(robot.package, {}) and not arguments.again:
            continue
        try:
            report, reason = measure(command, corpora.path_of(robot, folders))
        except corpora.Unavailable as error:
            sys.exit(f"error: {error}")
        except OSError as error:
            sys.exit(f"error: {command}: {error}; expected the path of `articulated` in ARTICULATED_COMMAND")
        if reason:
            print(f"{robot.package} {robot.file}: not measured: {reason}", flush=True)
            continue
        found = {one["function"]: round(one["generated"]["median"], 1) for one in report["functions"]}
        times.setdefault(robot.package, {})[robot.file] = found
        head = {"written_by": "python3 docs/site/times.py", "processor": processor(), "compiler": report["compiler"], "flags": report["flags"]}
        table = {**head, "times": {name: dict(sorted(files.items())) for name, files in sorted(times.items())}}
        TABLE.write_text(json.dumps(table, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
        count += 1
        print(f"{robot.package} {robot.file}: " + ", ".join(f"{name} {ns} ns" for name, ns in found.items()), flush=True)
    print(f"{count} robots measured")
    return 0 if count or not arguments.again else 1


if __name__ == "__main__":
    sys.exit(main())
