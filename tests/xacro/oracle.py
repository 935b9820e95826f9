#!/usr/bin/env python3
"""Expands xacro files with PyPI's `xacro` and with our reader, and compares the robots.

    python3 tests/xacro/oracle.py --sample          the files of tests/xacro/models, as CI does
    python3 tests/xacro/oracle.py                   those, and the files of repositories.txt (cloned into target/xacro)
    python3 tests/xacro/oracle.py --folder FOLDER   every xacro file below a folder of checkouts; nothing is downloaded
    python3 tests/xacro/oracle.py --file F.xacro [--arg NAME=VALUE] [--package NAME=FOLDER]

Each file is expanded by `xacro`, the expanded URDF is read by our reader, and so is the file itself. Both robots are written as
plain URDFs, which have to be equal but for the names of meshes: `$(find NAME)` is a folder in the one, and `package://NAME` in the
other. A file that `xacro` refuses is counted, and whether we refuse it too. Packages are the folders with a package.xml.

`xacro` goes into a virtual environment in target/xacro, with the versions of requirements.txt.

Exit status: 0 if every file that `xacro` expands gives the same robot, or is refused for the same reasons after it was expanded.
"""

import argparse
import collections
import os
import re
import subprocess
import sys
import types
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from programs import build_example, example  # noqa: E402
from virtual_environment import python_of  # noqa: E402

REPOSITORY = HERE.parent.parent
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", REPOSITORY / "target"))
PLACE = TARGET / "xacro"
HELPER = example("urdf_of")


def main():
    arguments = parse()
    if "XACRO_ORACLE" not in os.environ:
        prepare()
        python = environment()
        code = subprocess.run([str(python), *sys.argv], env={**os.environ, "XACRO_ORACLE": "1"}).returncode
        sys.exit(code)
    cases = list(chosen(arguments))
    counts = collections.Counter()
    for folder, file, mappings in cases:
        # A package of the file's own repository has precedence over one of the same name elsewhere.
        inside = file.relative_to(folder).parts[0] if folder in file.parents else "."
        packages = packages_of(folder) | packages_of(folder / inside) | dict(pair.split("=", 1) for pair in arguments.package)
        verdict, detail = compare(file, mappings, packages)
        counts[verdict] += 1
        if verdict != "equal":
            words = " ".join(f"{name}={value}" for name, value in mappings.items())
            print(f"{file.relative_to(folder) if folder in file.parents else file} {words}: {verdict}: {detail}", flush=True)
    print(", ".join(f"{count} {verdict}" for verdict, count in sorted(counts.items())))
    sys.exit(any(verdict.startswith("WRONG") for verdict in counts) or not counts["equal"])


def parse():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--sample", action="store_true")
    parser.add_argument("--folder", type=Path)
    parser.add_argument("--file", type=Path)
    parser.add_argument("--arg", action="append", default=[])
    parser.add_argument("--package", action="append", default=[])
    return parser.parse_args()


def prepare():
    if not os.environ.get("XACRO_HELPER"):
        build_example("urdf_of")


def environment():
    """The Python with PyPI's xacro."""
    return python_of(PLACE / "venv", HERE / "requirements.txt")


def chosen(arguments):
    """The folder of each file, the file, and its arguments."""
    given = dict(pair.split("=", 1) for pair in arguments.arg)
    if arguments.file:
        yield arguments.file.resolve().parent, arguments.file.resolve(), given
        return
    if arguments.folder:
        folder = arguments.folder.resolve()
        wanted = listed_arguments()
        for file in sorted(folder.rglob("*.xacro")):
            known = [mappings for name, mappings in wanted if str(file).endswith(name)]
            for mappings in known or [given]:
                yield folder, file, mappings
        return
    for file in sorted((HERE / "models").glob("*.xacro")):
        yield HERE / "models", file, {}
    if arguments.sample:
        return
    for address, commit in repositories():
        folder = PLACE / Path(address).name
        if not folder.exists():
            subprocess.run(["git", "init", "-q", str(folder)], check=True)
            subprocess.run(["git", "-C", str(folder), "fetch", "-q", "--depth", "1", f"https://github.com/{address}", commit], check=True)
            subprocess.run(["git", "-C", str(folder), "checkout", "-q", "FETCH_HEAD"], check=True)
        wanted = listed_arguments()
        for file in sorted(folder.rglob("*.xacro")):
            known = [mappings for name, mappings in wanted if str(file).endswith(name)]
            for mappings in known or [given]:
                yield PLACE, file, mappings


def repositories():
    for line in (HERE / "repositories.txt").read_text().splitlines():
        words = line.split("#")[0].split()
        if len(words) == 2 and "/" in words[0]:
            yield words


def listed_arguments():
    """The files that need arguments, with each set of them."""
    out = []
    for line in (HERE / "repositories.txt").read_text().splitlines():
        words = line.split("#")[0].split()
        if words and words[0].endswith(".xacro"):
            out.append((words[0], dict(word.split("=", 1) for word in words[1:])))
    return out


FOUND = {}


def packages_of(folder):
    """The folders with a package.xml, by their names."""
    if folder not in FOUND:
        FOUND[folder] = {}
        for file in folder.rglob("package.xml"):
            name = re.search(r"<name>\s*(.*?)\s*</name>", file.read_text(errors="replace"))
            if name:
                FOUND[folder][name.group(1)] = str(file.parent)
    return FOUND[folder]


def compare(file, mappings, packages):
    own = helper(file, mappings, packages)
    text, reason = expanded(file, mappings, packages)
    if text is None:
        if own.returncode:
            return "refused by xacro and by us", reason
        return "refused by xacro alone", reason
    plain = PLACE / "expanded.urdf"
    plain.parent.mkdir(parents=True, exist_ok=True)
    plain.write_text(text)
    other = helper(plain, {}, {})
    if own.returncode and other.returncode:
        first, second = ({message(line) for line in result.stderr.splitlines() if not line.startswith("warning")} for result in (own, other))
        if first == second:
            return "refused after it is expanded", next(iter(sorted(first)), "")[:160]
        return "WRONG errors", f"{sorted(first - second)[:3]} and not {sorted(second - first)[:3]}"[:600]
    if own.returncode or other.returncode:
        refused = own if own.returncode else other
        return "WRONG refusal", " ".join(line for line in refused.stderr.splitlines() if not line.startswith("warning"))[:600]
    first, second = (re.sub(r'filename="[^"]*"', "", result.stdout) for result in (own, other))
    if first == second:
        return "equal", ""
    lines = [pair for pair in zip(first.splitlines(), second.splitlines()) if pair[0] != pair[1]]
    return "WRONG robot", str(lines[:1])[:400]


def message(line):
    """An error without its place, and without the macro that it is in."""
    line = re.sub(r"; in the macro .* calls$", "", re.sub(r"^\S+?:(\d+:)? ", "", line))
    return re.sub(r"(in )?line \d+", "line", line)


def helper(file, mappings, packages):
    words = [word for name, value in mappings.items() for word in ("--arg", f"{name}={value}")]
    words += [word for name, value in packages.items() for word in ("--package", f"{name}={value}")]
    return subprocess.run([os.environ.get("XACRO_HELPER", str(HELPER)), str(file), *words], capture_output=True, text=True, timeout=300)


def expanded(file, mappings, packages):
    """The expanded document, or why there is none."""
    import xacro

    def find(name):
        if name not in packages:
            raise LookupError(f"package {name!r} not found")
        return packages[name]

    module = types.ModuleType("ament_index_python.packages")
    module.get_package_share_directory = find
    sys.modules["ament_index_python"] = types.ModuleType("ament_index_python")
    sys.modules["ament_index_python.packages"] = module
    xacro.verbosity = 0
    xacro._global_symbols = xacro.create_global_symbols()
    try:
        with open(os.devnull, "w") as silent:
            before, sys.stderr = sys.stderr, silent
            try:
                document = xacro.process_file(str(file), mappings=dict(mappings))
            finally:
                sys.stderr = before
        return document.toxml(), None
    except Exception as error:
        return None, f"{type(error).__name__} {error}".replace("\n", " ")[:160]


if __name__ == "__main__":
    main()
