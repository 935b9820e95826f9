"""A page that a program feeds: `articulated.Player` of the Python package, and a program of another language."""

import contextlib
import json
import os
import subprocess
import urllib.request

# Serves a robot until its input ends; shows the configuration of each line.
PROGRAM = """import json, sys, articulated
robot = articulated.bundled("panda_like")
with articulated.Player(robot, title="live") as player:
    print(player.url, flush=True)
    for line in sys.stdin:
        player.show(**json.loads(line))
        print(player.pages, flush=True)
"""


def python(target):
    """A Python with the package; None where there is none."""
    named = os.environ.get("ARTICULATED_PYTHON")
    own = target / "python-check" / "test" / "bin" / "python"
    path = named or (str(own) if own.exists() else None)
    has = path and subprocess.run([path, "-c", "import articulated; articulated.Player"], capture_output=True, cwd="/").returncode == 0
    if named and not has:
        raise RuntimeError(f"ARTICULATED_PYTHON: found {named}, expected a Python with the package articulated")
    return path if has else None


@contextlib.contextmanager
def served(path):
    """The address of a player, and what shows a configuration on it."""
    program = subprocess.Popen([path, "-c", PROGRAM], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd="/")
    try:
        url = program.stdout.readline().strip()

        def show(q, **more):
            program.stdin.write(json.dumps({"q": q, **more}) + "\n")
            program.stdin.flush()
            return int(program.stdout.readline())

        yield url, show
    finally:
        program.stdin.close()
        program.wait(10)


def post(url, message):
    """What a controller in another language sends; the answer."""
    address, _, token = url.partition("?token=")
    request = urllib.request.Request(f"{address}show", json.dumps(message).encode(), {"Authorization": f"Bearer {token}"})
    with urllib.request.urlopen(request, timeout=10) as answer:
        return json.load(answer)


def get(url):
    """The bytes of an address."""
    with urllib.request.urlopen(url, timeout=10) as answer:
        return answer.read()
