"""Functions of one robot as generated C, compiled by the system's compiler and kept in a cache."""

import ctypes
import hashlib
import os
import platform
import shlex
import shutil
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

import numpy as np

from . import _native

PREFIX = "articulated"
FLAGS = ("-std=c99", "-O2", "-ffp-contract=off", "-fPIC", "-shared")


def compiler():
    """The command of the C compiler: the environment variable CC, or cc."""
    command = shlex.split(os.environ.get("CC", "cc")) or ["cc"]
    if shutil.which(command[0]) is None:
        raise RuntimeError(f"compile: found no C compiler {command[0]!r}, expected one on the path, or its name in the environment variable CC")
    return command


def cache():
    """The folder of compiled robots: the environment variable ARTICULATED_CACHE, or one in the user's cache."""
    folder = os.environ.get("ARTICULATED_CACHE")
    if not folder:
        home = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
        folder = os.path.join(home, "articulated")
    path = Path(folder)
    try:
        path.mkdir(mode=0o700, parents=True, exist_ok=True)
    except OSError as error:
        raise RuntimeError(f"compile: found no folder for compiled robots ({error}), expected one in ARTICULATED_CACHE") from None
    return path


def _loop(function):
    """C of the function for many states: each argument with the step from one state to the next, zero if it is the same."""
    names = [name for name, _, _ in function.takes]
    given = "".join(f"const double *{name}, size_t {name}_step, " for name in names)
    at = ", ".join([*(f"{name} + k * {name}_step" for name in names), "out + k * out_step"])
    return (
        f"\nvoid {PREFIX}_many_{function.name}(size_t states, {given}double *out, size_t out_step) {{\n"
        f"    for (size_t k = 0; k < states; k++) {{\n        {PREFIX}_{function.name}({at});\n    }}\n}}\n"
    )


def library(source, functions, flags):
    """The path of the shared object of these functions, compiled unless it is in the cache."""
    command = compiler()
    files = _native.generate_c(*source, [function.name for function in functions], PREFIX)
    loops = f'#include <stddef.h>\n#include "{PREFIX}.h"\n' + "".join(_loop(function) for function in functions)
    files = [*files, (f"{PREFIX}_many.c", loops)]
    version = subprocess.run([*command, "--version"], capture_output=True, text=True).stdout
    key = repr((files, command, version, FLAGS, flags, platform.machine(), sys.platform))
    path = cache() / f"{hashlib.sha256(key.encode('utf-8', 'surrogatepass')).hexdigest()[:32]}.so"
    if path.exists():
        return path
    with tempfile.TemporaryDirectory(dir=path.parent) as folder:
        for name, text in files:
            Path(folder, name).write_text(text, encoding="utf-8")
        sources = [name for name, _ in files if name.endswith(".c")]
        line = [*command, *FLAGS, *flags, "-o", "robot.so", *sources, "-lm"]
        done = subprocess.run(line, cwd=folder, capture_output=True, text=True)
        if done.returncode != 0:
            message = (done.stderr or done.stdout).strip()[-2000:]
            raise RuntimeError(f"compile: the C compiler refused: {' '.join(line)}\n{message}")
        # At once, so that another process never finds half of it.
        os.replace(os.path.join(folder, "robot.so"), path)
    return path


class CompiledRobot:
    """Some of a robot's functions, compiled. ``Robot.compile`` makes one.

    Its methods take the arguments of the robot's methods, check them in the same way, and return the
    same values up to rounding.
    """

    def __init__(self, robot, functions, flags, document):
        self.robot = robot
        self.functions = tuple(function.name for _, function in functions)
        self.path = library(robot._source[:5], [function for _, function in functions], flags)
        self._library = ctypes.CDLL(str(self.path))
        for index, function in functions:
            setattr(self, function.name, self._method(index, function, document(function)))

    def __repr__(self):
        return f"<articulated.CompiledRobot {self.robot.name!r}: {', '.join(self.functions)}>"

    def __reduce__(self):
        raise TypeError("found a compiled robot to copy or pickle, expected the robot itself: compile it again there")

    def _method(self, index, function, documentation):
        many = self._library[f"{PREFIX}_many_{function.name}"]
        many.restype = None
        many.argtypes = [ctypes.c_size_t, *([ctypes.c_void_p, ctypes.c_size_t] * (len(function.takes) + 1))]
        names, core = [name for name, _, _ in function.takes], self.robot._core

        def run(given, threads):
            states, arrays, shape = core._arguments(index, given)
            threads = _native.threads(threads)
            out = np.empty(shape)
            count = 1 if states is None else states
            dims = [len(dims) for _, dims, _ in function.takes]
            # The step of an argument that is the same for all states is zero.
            steps = [array.size // count if count and array.ndim > n else 0 for array, n in zip(arrays, dims)]
            places = [array.ctypes.data for array in arrays]
            size, begin = (out.size // count if count else 0), out.ctypes.data

            def part(first, end):
                given = [x for place, step in zip(places, steps) for x in (place + 8 * first * step, step)]
                many(end - first, *given, begin + 8 * first * size, size)

            if out.size:
                threads = min(threads, count)
                ends = [count * k // threads for k in range(threads + 1)]
                workers = [threading.Thread(target=part, args=ends[k : k + 2]) for k in range(1, threads)]
                for worker in workers:
                    worker.start()
                part(*ends[:2])
                for worker in workers:
                    worker.join()
            return out if shape else float(out)

        scope = {"run": run}
        given = "".join(f"{name}, " for name in names)
        exec(f"def {function.name}({given}*, threads=None):\n    return run(({given}), threads)\n", scope)
        method = scope[function.name]
        method.__doc__ = documentation
        return method
