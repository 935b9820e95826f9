#!/usr/bin/env python3
"""The robot files of the corpora: those of shipped URDF, MJCF and SDF whose verdicts are in
docs/site/data.

    python3 docs/site/corpora.py --licences    writes docs/site/data/packages.json anew: the licence and the home of each package

The packages are downloaded and unpacked by the scripts that compare them (tests/shipped,
tests/mjcf, tests/sdf), into their folders below target.
"""

import argparse
import importlib.util
import json
import re
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parent.parent
TESTS = REPOSITORY / "tests"
sys.path.insert(0, str(TESTS))
import verdicts  # noqa: E402

FORMATS = {"shipped": "URDF", "mjcf": "MJCF", "sdf": "SDF"}
# Packages with few bytes: `--robots N` takes their files first.
SMALL = ["upkie-description", "gymnasium", "gym-ignition-models"]
LICENCES = verdicts.DATA / "packages.json"


class Unavailable(Exception):
    """A package that cannot be downloaded, or a file that is not in it."""


class Robot(NamedTuple):
    """A file of a package: `corpus` is that of its verdict, `file` its path in the package."""

    corpus: str
    package: str
    file: str

    @property
    def format(self):
        return FORMATS[self.corpus]


def robots(most=None, pattern=""):
    """The recorded files: all, or at most so many, or those with a word in the name of the package
    or the path.

    A limited number is taken from the formats in turn, from small packages as long as they have
    files.
    """
    small, large = ([list_of(corpus, pattern, is_small) for corpus in FORMATS] for is_small in (True, False))
    if most is None:
        return [one for files in zip(small, large) for part in files for one in part]
    found = []
    for lists in (small, large):
        while len(found) < most and any(lists):
            for files in lists:
                if files and len(found) < most:
                    found.append(files.pop(0))
    return found


def list_of(corpus, pattern, is_small):
    """The recorded files of the small packages of a corpus, or of the others."""
    recorded = verdicts.read(corpus)
    names = [name for name in verdicts.pinned(corpus) if name in recorded and (name.partition("==")[0] in SMALL) == is_small]
    return [Robot(corpus, name, file) for name in names for file in recorded[name]["files"] if pattern.lower() in f"{name}/{file}".lower()]


def script(path):
    """The module of a script."""
    spec = importlib.util.spec_from_file_location(path.parent.name + "_" + path.stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def folder(corpus, package):
    """The folder of a package's files, which is downloaded if it is not there."""
    name = package.replace("==", "-")
    try:
        if corpus == "shipped":
            shipped = script(TESTS / "shipped" / "shipped.py")
            shipped.unpack(package)
            return shipped.PLACE / "files" / package
        oracle = script(TESTS / corpus / "oracle.py")
        place = oracle.PLACE / name
        if not (place / "done").exists():
            oracle.fetch(package, place)
        # The comparison has Drake installed, and reads its files there.
        return place / "pydrake" / "share" if package.startswith("drake==") else place
    except (subprocess.CalledProcessError, OSError) as error:
        reason = f"`pip download` ended with status {error.returncode}" if isinstance(error, subprocess.CalledProcessError) else error
        raise Unavailable(f"{package}: cannot be downloaded ({reason}); expected a network with a Python package index, "
                          "or a package below target that is unpacked; --only WORD builds the gallery of other packages") from None


def path_of(robot, folders):
    """The path of a file; `folders` keeps the folders of the packages."""
    key = robot.corpus, robot.package
    if key not in folders:
        folders[key] = folder(*key)
    path = folders[key] / robot.file
    if not path.is_file():
        raise Unavailable(f"{path}: found no such file, but docs/site/data/{robot.corpus}.json has it; "
                          f"`python3 {verdicts.CORPORA[robot.corpus][0]}` records the files of the package")
    return path


def licences():
    """The licence and the home of each package, as its metadata says; None where it says none."""
    found = json.loads(LICENCES.read_text(encoding="utf-8")) if LICENCES.exists() else {}
    missing = sorted({name for corpus in FORMATS for name in verdicts.pinned(corpus)} - set(found))
    if missing:
        raise Unavailable(f"{LICENCES}: found no entry of {', '.join(missing)}; `python3 docs/site/corpora.py --licences` writes it anew")
    return found


def ask_licences():
    """Writes the licences of all packages: pip reads their metadata, and installs nothing."""
    names = sorted({name for corpus in FORMATS for name in verdicts.pinned(corpus)})
    found = {}
    for name in names:
        print(f"{name}: metadata", flush=True)
        words = [sys.executable, "-m", "pip", "install", "--quiet", "--dry-run", "--ignore-installed", "--no-deps", "--report", "-", name]
        done = subprocess.run(words, capture_output=True, text=True)
        if done.returncode:
            raise Unavailable(f"{name}: pip reads no metadata: {done.stderr.strip().splitlines()[-1:]}")
        metadata = json.loads(done.stdout)["install"][0]["metadata"]
        found[name] = {"licence": licence(metadata), "home": home(metadata)}
    LICENCES.write_text(json.dumps(found, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


def licence(metadata):
    """The expression, or the name in the text, or the classifiers."""
    text = (metadata.get("license") or "").strip()
    named = re.search(r"Licensed under (?:the )?([^(;\n]+)", text)
    classes = [one.split(" :: ")[-1] for one in metadata.get("classifier", []) if one.startswith("License ::")]
    if metadata.get("license_expression"):
        return metadata["license_expression"]
    if text and len(text) <= 60:
        return text
    return (named.group(1).strip() if named else None) or ", ".join(classes) or (text.splitlines()[0][:60] if text else None)


def home(metadata):
    """The address of the project."""
    addresses = dict(one.split(", ", 1) for one in metadata.get("project_url", []) if ", " in one)
    lower = {name.lower(): address for name, address in addresses.items()}
    found = metadata.get("home_page") or next((lower[name] for name in ("homepage", "home", "repository", "source", "github") if name in lower), None)
    return found or next(iter(addresses.values()), None)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--licences", action="store_true", required=True, help="ask the metadata of all packages, which takes minutes")
    parser.parse_args()
    try:
        ask_licences()
    except Unavailable as error:
        sys.exit(f"error: {error}")


if __name__ == "__main__":
    main()
