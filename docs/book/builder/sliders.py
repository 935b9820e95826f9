"""Sliders in the pages: a reader moves q, v and a, and generated C computes torques and energies.

Clang compiles the C to WebAssembly, which is part of the page.
"""

import base64
import json
import math
import shutil
import subprocess
import tempfile
import time
from html import escape
from pathlib import Path

from . import shapes
from .problems import Stop, listed

HERE = Path(__file__).resolve().parent
FUNCTIONS = "inverse_dynamics,kinetic_energy,potential_energy,placements"
# Units of the coordinate, its rate and acceleration, and of the joint's force.
UNITS = {"revolute": ["rad", "rad/s", "rad/s²", "N·m"], "continuous": ["rad", "rad/s", "rad/s²", "N·m"], "prismatic": ["m", "m/s", "m/s²", "N"]}
# The ends of the sliders, in these units, where the file of the robot has no narrower ones.
ENDS = {"revolute": [math.pi, 5.0, 10.0], "continuous": [math.pi, 5.0, 10.0], "prismatic": [1.0, 2.0, 5.0]}
START = [0.5, 1.0, 0.0]


def robot_file(root, robot):
    return root / "models" / "urdf" / f"{robot}.urdf"


def check(root, file, line, robot, problems):
    """Whether a robot is bundled; a problem if not."""
    if robot_file(root, robot).is_file():
        return True
    robots = {path.stem for path in (root / "models" / "urdf").glob("*.urdf")}
    problems.add(file, line, f"sliders of {robot!r}: no such robot, expected one of {listed(robots)}")
    return False


def compilers():
    """Clang and its linker for WebAssembly, or what is missing."""
    clang = shutil.which("clang")
    linker = next(filter(None, map(shutil.which, ("wasm-ld", "wasm-ld-14", "wasm-ld-15", "wasm-ld-16", "wasm-ld-19"))), None)
    if clang and "wasm32" not in run([clang, "--print-targets"]):
        clang = None
    missing = [name for name, there in (("clang for wasm32", clang), ("wasm-ld", linker)) if not there]
    return clang, linker, " and no ".join(missing)


def module(command, compilers, file, links):
    """WebAssembly of the robot of a file, with placements of these links."""
    clang, linker, _ = compilers
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        run([command, "generate", file, "--functions", FUNCTIONS, "--language", "c", "--no-libm", "--prefix", "robot",
             "--frames", ",".join(links), "-o", folder / "robot.h"])
        run([clang, "--target=wasm32", "-std=c99", "-O2", "-nostdlib", "-ffp-contract=off", f"-I{folder}", "-c", HERE / "sliders.c", "-o", folder / "robot.o"])
        run([linker, "--no-entry", "--strip-all", folder / "robot.o", "-o", folder / "robot.wasm"])
        return (folder / "robot.wasm").read_bytes()


def data(command, compilers, root, robot, say):
    """What the script of the page needs about a robot."""
    start = time.monotonic()
    file = robot_file(root, robot)
    found = json.loads(run([command, "check", file, "--format", "json"]))
    odd = [joint["joint"] for joint in found["joints"] if joint["kind"] != "fixed" and (joint["kind"] not in UNITS or joint["mimic"] or joint["locked"] is not None)]
    if odd or found["base"] != "fixed":
        raise Stop(f"sliders of {robot}: expected a fixed base, and joints that are revolute, continuous or prismatic; "
                   f"found a {found['base']} base, and of other kinds: {listed(odd)}")
    joints = sorted((joint for joint in found["joints"] if joint["kind"] != "fixed"), key=lambda joint: joint["v"][0])
    links = [link["link"] for link in found["links"]]
    wasm = module(command, compilers, file, links)
    say(f"sliders {robot}: {len(wasm)} bytes of WebAssembly, {time.monotonic() - start:.1f} s")
    return {
        "robot": robot,
        "joints": [{"name": joint["joint"], "units": UNITS[joint["kind"]], "ranges": ranges(joint)} for joint in joints],
        "start": START,
        "wasm": base64.b64encode(wasm).decode(),
        "drawing": shapes.drawing(file, links),
    }


def ranges(joint):
    """The least and the largest number of each slider of a joint."""
    most = ENDS[joint["kind"]]
    lower, upper = (joint[name] if joint[name] is not None else sign * math.inf for name, sign in (("lower", -1), ("upper", 1)))
    rate = joint["velocity"] or math.inf
    return [[max(lower, -most[0]), min(upper, most[0])], [-min(rate, most[1]), min(rate, most[1])], [-most[2], most[2]]]


def html(data):
    """The place of the widget, and its data."""
    robot = escape(data["robot"])
    # No text can end the script that contains it.
    text = json.dumps(data, ensure_ascii=False).replace("<", "\\u003c")
    size = len(base64.b64decode(data["wasm"]))
    return (f'<figure class="sliders"><div class="board"><noscript>The sliders need JavaScript.</noscript></div><script type="application/json">{text}</script>\n'
            f"<figcaption>The C of <code>articulated generate {robot} --language c --no-libm</code> runs in this page, as {size} bytes of WebAssembly. "
            "Move q, v and a: it computes torques and energies.</figcaption></figure>\n")


def hint(robot):
    """What a book without sliders says in their place."""
    return (f'<p class="hint"><code>articulated eval {escape(robot)} --function inverse_dynamics --states states.json</code> computes torques of '
            f"<code>{escape(robot)}</code> in the states of a file.</p>\n")


def run(words):
    """The standard output of a program."""
    done = subprocess.run(words, capture_output=True, text=True, encoding="utf-8", timeout=300)
    if done.returncode:
        raise Stop(f"`{' '.join(map(str, words))}` ended with status {done.returncode}:\n{done.stderr.strip()}")
    return done.stdout
