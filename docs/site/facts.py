"""What the command says about a robot's file, and its picture.

Results are kept below target/site-cache.
"""

import hashlib
import json
import re
import subprocess
from pathlib import Path

import picture

FUNCTIONS = ["inverse_dynamics", "forward_dynamics"]
# Options that errors name, of which each makes one kind of error a warning.
OPTIONS = re.compile(r"`(--(?:allow-unphysical-inertia|first-of-duplicates|allow-unknown-version|leave-out \w+))`")
SECONDS = 60
MOST_MESSAGES = 40


class Facts:
    """Facts by the command at a path.

    A result depends on the file, its package, the command and these programs.
    """

    def __init__(self, command, cache):
        self.command, self.cache = command, cache
        programs = [Path(__file__), Path(picture.__file__)]
        parts = [hashlib.sha256(path.read_bytes()).digest() for path in [Path(command), *programs]]
        self.base = hashlib.sha256(b"".join(parts)).digest()

    def of(self, robot, path):
        """The facts, and whether they come from the cache."""
        key = hashlib.sha256(self.base + f"{robot.package}\n{robot.file}\n".encode() + path.read_bytes()).hexdigest()
        kept = self.cache / key[:2] / f"{key}.json"
        if kept.exists():
            return json.loads(kept.read_text(encoding="utf-8")), True
        found = self.compute(path)
        kept.parent.mkdir(parents=True, exist_ok=True)
        # A run that is interrupted leaves no half of a file.
        part = kept.with_suffix(".part")
        part.write_text(json.dumps(found, ensure_ascii=False), encoding="utf-8")
        part.replace(kept)
        return found, False

    def compute(self, path):
        report, options = self.check(path)
        found = {"usable": report["usable"], "options": options, "errors": texts(report["errors"], path), "warnings": texts(report["warnings"], path)}
        if not report["usable"]:
            return found
        totals = report["totals"]
        found |= {"robot": report["robot"], "nv": totals["degrees_of_freedom"], "nq": totals["coordinates"], "links": totals["links"],
                  "joints": totals["joints"], "mass": totals["mass"], "unused": unused([shortened(line, path) for line in report["unused"]]), "operations": {}}
        if found["nv"]:
            found["operations"], found["no_operations"] = self.operations(path, options)
            try:
                found["picture"] = picture.still(self.command, path, options)
            except picture.NoPicture as reason:
                found["no_picture"] = shortened(str(reason), path)
        return found

    def check(self, path):
        """The report of `check`, and the options with which the file is read, as its errors name
        them.
        """
        report, options = self.run("check", path, []), []
        while not report.get("usable") and len(options) < 8:
            named = [word for error in report.get("errors", []) for text in OPTIONS.findall(str(error.get("message"))) for word in [text.split(" ")]]
            new = next((words for words in named if not follows(options, words)), None)
            if not new:
                break
            options += new
            again = self.run("check", path, options)
            report = again if again.get("usable") else {**again, "usable": False}
        if not report.get("usable"):
            # The errors of the file as it is.
            return {"warnings": [], "errors": [], **self.run("check", path, []), "usable": False}, []
        return report, options

    def run(self, subcommand, path, words):
        """The JSON of a subcommand."""
        try:
            done = subprocess.run([str(self.command), subcommand, str(path), *words, "--format", "json"], capture_output=True, text=True, timeout=SECONDS)
        except subprocess.TimeoutExpired:
            return {"errors": [{"message": f"`{subcommand}` takes more than {SECONDS} s"}]}
        try:
            return json.loads(done.stdout)
        except ValueError:
            return {"errors": [{"message": (done.stderr or done.stdout).strip()[:300] or f"exit status {done.returncode}"}]}

    def operations(self, path, options):
        """For each function: multiplications, additions, instructions, sines and cosines of the
        emitted code; or the reason for none.
        """
        answer = self.run("generate", path, ["--functions", ",".join(FUNCTIONS), *options])
        reason = None
        if "functions" not in answer:
            reason = texts(answer.get("errors", []), path)[:1]
            answer = self.run("generate", path, ["--functions", FUNCTIONS[0], *options])
        keys = ["multiplications", "additions", "instructions", "sines_and_cosines"]
        return {one["function"]: [one["stages"][-1][key] for key in keys] for one in answer.get("functions", [])}, reason


def follows(options, words):
    """Whether these words are among the options already, next to each other."""
    return any(options[k : k + len(words)] == words for k in range(len(options)))


def texts(messages, path):
    """The messages without the folders of this machine."""
    found = [shortened(one["message"] if isinstance(one, dict) else str(one), path) for one in messages]
    return found[:MOST_MESSAGES] + ([f"and {len(found) - MOST_MESSAGES} more"] if len(found) > MOST_MESSAGES else [])


def shortened(message, path):
    """A message in which the file has its name alone, files beside it have their paths from its
    folder, and other folders are left out.
    """
    message = message.replace(f"{path}:", "").replace(str(path), path.name).replace(f"{path.parent}/", "")
    return re.sub(r"""(?<![\w.:/])/(?:[^/\s"'`]+/)+""", "…/", message).strip()


def unused(lines):
    """What the file contains and the dynamics do not use: pairs of a text and how often it is
    there.
    """
    counts = {}
    for line in lines:
        text = re.sub(r'^line \d+: ', "", line)
        # The file that it is in, where that is an included one.
        text = re.sub(r" \([^() ]*\.(?:xml|urdf|sdf|xacro|mjcf)\)$", "", text)
        text = re.sub(r'^(?:link|joint|body|site|geom|model|frame) "[^"]*": ', "", text)
        counts[text] = counts.get(text, 0) + 1
    found = sorted(counts.items(), key=lambda one: -one[1])
    return [list(one) for one in found[:MOST_MESSAGES]] + ([["other elements", sum(n for _, n in found[MOST_MESSAGES:])]] if len(found) > MOST_MESSAGES else [])
