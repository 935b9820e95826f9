"""The programs of this workspace that scripts run: the command, and examples of `articulated-formats`.

Cargo builds them, unless these variables say where they are, as the checks do, which build everything once:

    ARTICULATED_COMMAND    the command
    ARTICULATED_EXAMPLES   a folder of examples
"""

import json
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


def evaluated(path, functions, states, code, options=()):
    """The numbers of `articulated eval` by "generic" or "generated" code: of each state (q, v, a) those of the functions, in order."""
    sent = json.dumps({"states": [dict(zip("qva", map(list, one))) for one in states]})
    words = ["--function", ",".join(functions), "--states", "-", f"--{code}", "--format", "json", *options]
    answer = subprocess.run([str(COMMAND), "eval", str(path), *words], input=sent, capture_output=True, text=True, timeout=600)
    if answer.returncode:
        raise RuntimeError(answer.stderr)
    found = {one["function"]: one["states"] for one in json.loads(answer.stdout)["functions"]}
    return [x for k in range(len(states)) for name in functions for x in flat(found[name][k][code])]


def flat(value):
    """The numbers of nested objects and lists, in their order."""
    if isinstance(value, dict):
        value = list(value.values())
    return [x for part in value for x in flat(part)] if isinstance(value, list) else [value]


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
