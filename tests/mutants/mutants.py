#!/usr/bin/env python3
"""Makes mistakes on purpose, one at a time, and says which of them no test notices.

    python3 tests/mutants/mutants.py                 every mistake of places.toml
    python3 tests/mutants/mutants.py motor contact   those whose description or file contains a word

Works on a copy of the last commit in target/mutants. A mistake that does not compile, or whose place is not found once, is
an error: the list is out of date. Exit status: 0 if tests notice every mistake, else 1.

The list holds places where a mistake once went unnoticed. For a systematic run: `cargo install cargo-mutants`, then, for
one file, `cargo mutants -p articulated-core -f runtime/core/src/joint/helical.rs`, or a part of all,
`cargo mutants -p articulated-core --shard 1/100` (.cargo/mutants.toml has the settings).
"""

import os
import subprocess
import sys
import time
import tomllib
from pathlib import Path

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parent.parent
COPY = REPOSITORY / "target" / "mutants" / "tree"


def copy():
    """A worktree of the last commit, with a build directory of its own."""
    if not COPY.exists():
        subprocess.check_call(["git", "worktree", "prune"], cwd=REPOSITORY)
        subprocess.check_call(["git", "worktree", "add", "--quiet", "--detach", COPY], cwd=REPOSITORY)
    head = subprocess.check_output(["git", "rev-parse", "HEAD"], cwd=REPOSITORY, text=True).strip()
    subprocess.check_call(["git", "checkout", "--quiet", "--force", head], cwd=COPY)


def cargo(*arguments):
    environment = {**os.environ, "CARGO_TARGET_DIR": str(COPY.parent / "build"), "CARGO_INCREMENTAL": "1"}
    return subprocess.run(["cargo", *arguments], cwd=COPY, env=environment, capture_output=True, text=True, timeout=1800)


def tests_pass(package):
    return cargo("test", "--quiet", "-p", package, "--lib", "--tests").returncode == 0


def main():
    words = [word.lower() for word in sys.argv[1:]]
    if any(word.startswith("-") for word in words):
        print(__doc__)
        return 0 if words[0] in ("-h", "--help") else 2
    mutants = tomllib.loads((HERE / "places.toml").read_text())["mutant"]
    chosen = [m for m in mutants if not words or any(word in f"{m['what']} {m['file']}".lower() for word in words)]
    if not chosen:
        print(f"no mistake contains {' or '.join(words)}")
        return 2
    copy()
    for package in sorted({m["package"] for m in chosen}):
        if not tests_pass(package):
            print(f"the tests of {package} fail without any mistake")
            return 1
    survivors = errors = 0
    for mutant in chosen:
        path, start = COPY / mutant["file"], time.monotonic()
        text = path.read_text()
        if text.count(mutant["find"]) != 1:
            verdict = f"ERROR: found {text.count(mutant['find'])} places in {mutant['file']}, expected one"
            errors += 1
        else:
            try:
                path.write_text(text.replace(mutant["find"], mutant["replace"]))
                built = cargo("test", "--quiet", "-p", mutant["package"], "--lib", "--no-run")
                if built.returncode != 0:
                    verdict = "ERROR: does not compile"
                    errors += 1
                elif tests_pass(mutant["package"]):
                    verdict = "SURVIVES"
                    survivors += 1
                else:
                    verdict = "noticed"
            finally:
                path.write_text(text)
        print(f"{verdict:9} {time.monotonic() - start:5.0f} s  {mutant['package']}: {mutant['what']}", flush=True)
    print(f"{len(chosen) - survivors - errors} of {len(chosen)} are noticed, {survivors} survive, {errors} errors")
    return 1 if survivors or errors else 0


if __name__ == "__main__":
    sys.exit(main())
