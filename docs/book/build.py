#!/usr/bin/env python3
"""Builds the book as static HTML, which needs no server and no network.

    python3 docs/book/build.py                        # into target/book; open target/book/index.html
    python3 docs/book/build.py -o FOLDER
    python3 docs/book/build.py --without-players      # without the command `articulated`
    python3 docs/book/build.py --install              # on Debian, as root: first install what is missing

Needs Python 3.11, and Node.js 18 with npm: KaTeX typesets the formulas. Motions and sliders need
the command `articulated`. The environment variable ARTICULATED_COMMAND is its path; without it Cargo
builds the command. Sliders also need clang and wasm-ld (Debian: clang, lld). Where these are missing
the sliders are left out, and the build says so. Packages of Python and npm are installed into
target/book-tools.

The chapters are those of docs/book/src/SUMMARY.md. In a chapter
    a code block ```math           is a formula in LaTeX
    <!-- player: SCENE -->         is a bundled scene that moves
    <!-- sliders: ROBOT -->        is a bundled robot whose generated C runs in the page
    <!-- quote: FILE -->           is the file that the next block quotes, from the repository's root
    <!-- generated: ROBOT FUNCTION -->   is over a block of generated code
Each comment is on a line of its own.
"""

import argparse
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parent.parent
sys.path.insert(0, str(REPOSITORY / "tests"))
from programs import build_command  # noqa: E402
from virtual_environment import python_of  # noqa: E402

TARGET = Path(os.path.abspath(os.environ.get("CARGO_TARGET_DIR", REPOSITORY / "target")))
TOOLS = TARGET / "book-tools"
# Debian's package of each program.
PACKAGES = {"node": "nodejs", "npm": "npm", "clang": "clang", "wasm-ld": "lld"}
STARTED = time.monotonic()


def say(words):
    print(f"{time.monotonic() - STARTED:5.1f} s  {words}", flush=True)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], epilog=__doc__.partition("\n\n")[2],
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", type=Path, default=TARGET / "book", metavar="FOLDER", help="where the pages go (default: target/book)")
    parser.add_argument("--source", type=Path, default=HERE / "src", metavar="FOLDER",
                        help="the chapters, in a folder docs/book/src of a repository (default: those beside this script)")
    parser.add_argument("--without-players", action="store_true", help="leave out motions and sliders, which need the command `articulated`")
    parser.add_argument("--install", action="store_true", help="install Debian's packages of missing programs, where this is Debian and its administrator")
    return parser.parse_args()


def install():
    """Debian's packages of the programs that are missing."""
    packages = [package for program, package in PACKAGES.items() if not shutil.which(program)]
    if not packages:
        return
    if not shutil.which("apt-get") or getattr(os, "geteuid", lambda: 1)() != 0:
        say(f"--install does nothing: it needs Debian and its administrator; missing are {', '.join(packages)}")
        return
    say(f"installing Debian's {', '.join(packages)}")
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "env": os.environ | {"DEBIAN_FRONTEND": "noninteractive"}}
    words = ["apt-get", "-o", "DPkg::Lock::Timeout=600", "install", "-y", "--no-install-recommends", *packages]
    if subprocess.run(words, **quiet).returncode != 0:
        subprocess.run(["apt-get", "-o", "DPkg::Lock::Timeout=600", "update"], **quiet)
        subprocess.run(words, **quiet)


def command():
    """Builds the command `articulated` where nothing says where it is; returns its path."""
    if "ARTICULATED_COMMAND" not in os.environ:
        say("building the command `articulated` by Cargo, which takes minutes at first (ARTICULATED_COMMAND names one that is there)")
    try:
        return build_command()
    except FileNotFoundError:
        sys.exit("found no cargo on the PATH, which builds the command `articulated`: set ARTICULATED_COMMAND to its path, or use --without-players")


def main():
    options = arguments()
    if sys.version_info < (3, 11):
        sys.exit(f"found Python {sys.version.split()[0]}, expected 3.11 or later")
    environment = TOOLS / "python"
    if not environment.exists() or not os.path.samefile(sys.prefix, environment):
        if options.install:
            install()
        if not (environment / "requirements.txt").exists():
            say(f"installing packages of Python into {environment}")
        try:
            python = python_of(environment, HERE / "requirements.txt")
        except subprocess.CalledProcessError as e:
            sys.exit(f"packages of docs/book/requirements.txt cannot be installed into {environment}: `{' '.join(map(str, e.cmd))}` ended with status {e.returncode}")
        sys.exit(subprocess.run([python, *sys.argv]).returncode)

    from builder import book
    from builder.problems import Stop

    try:
        book.build(options.source.resolve(), options.output, None if options.without_players else command, TOOLS, say)
    except Stop as reason:
        sys.exit(str(reason))
    except subprocess.CalledProcessError as e:
        sys.exit(f"`{' '.join(map(str, e.cmd))}` ended with status {e.returncode}; --without-players builds the book without the command")
    except (OSError, subprocess.TimeoutExpired) as e:
        sys.exit(str(e))


if __name__ == "__main__":
    main()
