#!/usr/bin/env python3
"""Runs the quick command lines of the README and of the documentation.

    python3 tests/command_lines.py [--list]

Each line of a code block that begins with `articulated check`, `eval`, `functions`, `generate`, `effects`, `simulate` or `new` runs in a
folder with small files under the names that the pages use, and has to succeed. So does the program of the README's first lines. Lines that
measure (`compare`, `scaling`, `accuracy`, `stress`, `--time`), compile (`--generated`) or need other programs (`--against`) do not run.

Needs the command, from the environment variable ARTICULATED_COMMAND or target/release/articulated, and rustc.
"""

import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent
PAGES = [REPOSITORY / "README.md", REPOSITORY / "python/README.md", *sorted((REPOSITORY / "docs").glob("*.md"))]
QUICK = ("check", "eval", "functions", "generate", "effects", "simulate", "new")
SLOW = ("--time", "--generated", "--against", "--all", "--package")

MODEL = """<mujoco><compiler angle="radian"/><option gravity="0 0 -9.81"/><worldbody><body name="arm"><joint name="hinge" type="hinge" axis="0 1 0" range="-1 1"/>
<geom type="capsule" size="0.05 0.3" pos="0 0 -0.3"/></body></worldbody><actuator><motor name="lift" joint="hinge"/></actuator>
<keyframe><key name="stand" qpos="0.3" ctrl="0.2"/></keyframe></mujoco>"""
SDF = """<sdf version="1.9"><model name="arm"><link name="base"/><link name="fore"><inertial><mass>1</mass></inertial></link>
<joint name="hinge" type="revolute"><parent>base</parent><child>fore</child><axis><xyz>0 1 0</xyz></axis></joint></model></sdf>"""
SCENE = """robot = "panda_like"
[simulation]
end = 0.2
"""
STATES = '{"states": [{"q": [0.1, 0.2, 0.3], "v": [0.0, 0.0, 0.0], "a": [1.0, 0.0, 0.0]}]}'


def files(folder):
    """The files that the lines name."""
    arm = (REPOSITORY / "tests/robots/arm.urdf").read_text(encoding="utf-8")
    quadruped = (REPOSITORY / "models/urdf/quadruped.urdf").read_text(encoding="utf-8")
    texts = {
        **dict.fromkeys(["arm.urdf", "robot.urdf", "robots/arm.urdf", "tests/robots/arm.urdf", "src/none"], arm), "quadruped.urdf": quadruped,
        "model.xml": MODEL, "robot.xml": MODEL, "robot.sdf": SDF, "scene.toml": SCENE, "arm.toml": SCENE, "states.json": STATES,
    }
    for name, text in texts.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    # The scene that a page builds up.
    page = (REPOSITORY / "docs/simulate-start.md").read_text(encoding="utf-8")
    (folder / "drop.toml").write_text("\n".join(re.findall(r"```toml\n(.*?)```", page, re.DOTALL)), encoding="utf-8")


def lines(text):
    """The commands of the code blocks of a page."""
    for block in re.findall(r"```(?:sh|console)?\n(.*?)```", text, re.DOTALL) + ["\n".join(re.findall(r"^    (articulated .*)$", text, re.MULTILINE))]:
        for line in re.sub(r"\\\n\s*", " ", block).splitlines():
            words = shlex.split(line.strip().removeprefix("$ "), comments=True) if re.match(r"(\$ )?articulated ", line.strip()) else []
            if words[:1] == ["articulated"] and words[1:2] and words[1] in QUICK and not any(word in SLOW for word in words):
                yield words[1:]


def run(words, folder, **more):
    """Whether the command succeeds; its errors otherwise."""
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, timeout=300, **more)
    return done.returncode == 0, done.stdout, (done.stderr or done.stdout).strip()


def redirected(words):
    """The words before `>`, and the file behind it."""
    return (words[: words.index(">")], words[words.index(">") + 1]) if ">" in words else (words, None)


def main():
    command = os.environ.get("ARTICULATED_COMMAND") or str(REPOSITORY / "target/release/articulated")
    failed = count = 0
    for page in PAGES:
        seen = set()
        text = page.read_text(encoding="utf-8")
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name, "crate")
            folder.mkdir()
            files(folder)
            for words in lines(text):
                if tuple(words) in seen:
                    continue
                seen.add(tuple(words))
                count += 1
                if "--list" in sys.argv[1:]:
                    print(f"{page.relative_to(REPOSITORY)}: articulated {' '.join(words)}")
                    continue
                given, file = redirected(words)
                succeeded, out, errors = run([command, *given], folder)
                if file:
                    (folder / file).write_text(out, encoding="utf-8")
                if not succeeded:
                    failed += 1
                    print(f"{page.relative_to(REPOSITORY)}: articulated {' '.join(words)}\n{errors}\n", file=sys.stderr)
            if page.name == "README.md" and page.parent == REPOSITORY and "--list" not in sys.argv[1:]:
                failed += not program(text, folder)
    print(f"{count} command lines, {failed} failed")
    return 1 if failed or not count else 0


def program(text, folder):
    """The program of the README's first lines, beside the arm that its first command generated."""
    found = re.search(r"```rust,ignore\n// controller.rs\n(.*?)```", text, re.DOTALL)
    (folder / "controller.rs").write_text(found[1], encoding="utf-8")
    compiled, _, errors = run([os.environ.get("RUSTC") or shutil.which("rustc"), "-O", "--edition", "2024", "-D", "warnings", "controller.rs"], folder)
    ran, out, more = run([str(folder / "controller")], folder) if compiled else (False, "", "")
    if not (ran and out.rstrip().endswith("] N·m")):
        print(f"README.md: controller.rs: {errors}{more}{out}", file=sys.stderr)
        return False
    return True


if __name__ == "__main__":
    sys.exit(main())
