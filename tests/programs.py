"""The programs of this workspace that scripts run: the command, and examples of `articulated-formats`.

Cargo builds them, unless these variables say where they are, as the checks do, which build everything once:

    ARTICULATED_COMMAND    the command
    ARTICULATED_EXAMPLES   a folder of examples
"""

import os
import subprocess
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", REPOSITORY / "target"))
ENDING = ".exe" if os.name == "nt" else ""
COMMAND = Path(os.environ.get("ARTICULATED_COMMAND", TARGET / "release" / f"articulated{ENDING}"))


def build_command():
    """Builds the command; returns its path."""
    if "ARTICULATED_COMMAND" not in os.environ:
        cargo("-p", "articulated-cli")
    return COMMAND


def example(name):
    """The path of an example."""
    return Path(os.environ.get("ARTICULATED_EXAMPLES", TARGET / "release" / "examples")) / f"{name}{ENDING}"


def build_example(name):
    """Builds an example; returns its path."""
    if "ARTICULATED_EXAMPLES" not in os.environ:
        cargo("-p", "articulated-formats", "--example", name)
    return example(name)


def cargo(*words):
    subprocess.run(["cargo", "build", "--quiet", "--release", *words], check=True, cwd=REPOSITORY)
