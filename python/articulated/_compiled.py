"""Functions of one robot as generated C, compiled by the system's compiler and kept in a cache."""

import hashlib
import math
import os
import platform
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

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
    if os.name == "posix":
        status = path.stat()
        # What is loaded from the folder runs in this process.
        if status.st_uid not in (0, os.getuid()) or status.st_mode & 0o022:
            found = f"{path}, of user {status.st_uid}, mode {status.st_mode & 0o7777:o}"
            raise RuntimeError(
                f"compile: found the folder {found}, expected one of this user that others cannot write to:"
                f" chmod go-w {shlex.quote(str(path))}, or another in ARTICULATED_CACHE"
            )
    return path


def lengths(robot, dims):
    """Dimensions as numbers of this robot."""
    named = {"nq": robot.nq, "nv": robot.nv, "frames": len(robot.frames), "links": len(robot.links)}
    named |= {"nu": len(robot.actuators), "na": sum(actuator.has_activation for actuator in robot.actuators)}
    return tuple(named.get(dim, dim) for dim in dims)


# States that are computed at once where an argument is the same for all: it is repeated so often.
BLOCK = 64


def _loop(robot, function, has_batch):
    """C of the function for many states.

    ``given`` and ``steps``: where each argument is, and the step from one state to the next, zero if
    it is the same for all. Results follow each other. States of a batch, of which a step is not
    zero, go to the generated ``PREFIX_NAME_batch_f64(count, arguments, out)`` over rows, if there is
    one: all of them, also a single one, so that results do not depend on how many there are.
    """
    name, takes = f"{PREFIX}_{function.name}", range(len(function.takes))
    sizes, size = [math.prod(lengths(robot, dims)) for _, dims, _ in function.takes], math.prod(lengths(robot, function.gives))
    lines = [f"void {symbol(function)}(size_t states, const double *const *given, const size_t *steps, double *out) {{"]
    if has_batch and any(sizes):
        batch, some = f"{name}_batch_f64", [i for i in takes if sizes[i]]
        rows = ", ".join(f"steps[{i}] ? given[{i}] + first * steps[{i}] : same_{i}" if sizes[i] else f"given[{i}]" for i in takes)
        lines += [
            f"    if ({' && '.join(f'steps[{i}]' for i in some)}) {{",
            f"        {batch}({', '.join(['states', *(f'given[{i}]' for i in takes), 'out'])});",
            "        return;",
            "    }",
            f"    if ({' || '.join(f'steps[{i}]' for i in some)}) {{",
            *(f"        double same_{i}[{BLOCK} * {sizes[i]}];" for i in some),
            f"        for (size_t k = 0; k < {BLOCK}; k++) {{",
            *(f"            for (size_t j = 0; j < {sizes[i]} && !steps[{i}]; j++) {{ same_{i}[k * {sizes[i]} + j] = given[{i}][j]; }}" for i in some),
            "        }",
            f"        for (size_t first = 0; first < states; first += {BLOCK}) {{",
            f"            const size_t count = states - first < {BLOCK} ? states - first : {BLOCK};",
            f"            {batch}(count, {rows}, out + first * {size});",
            "        }",
            "        return;",
            "    }",
        ]
    at = ", ".join([*(f"given[{i}] + k * steps[{i}]" for i in takes), f"out + k * {size}"])
    lines += ["    for (size_t k = 0; k < states; k++) {", f"        {name}({at});", "    }", "}"]
    return "\n" + "\n".join(lines) + "\n"


def _rows_loop(name, takes, gives, has_batch):
    """C of a derivative for many states: ``given`` and ``out`` are where the rows of each argument and result are."""
    function, ins, outs = f"{PREFIX}_{name}", range(len(takes)), range(len(gives))
    lines = [f"void {PREFIX}_loop_{name}(size_t states, const double *const *given, double *const *out) {{"]
    if has_batch:
        lines += [f"    {function}_batch_f64({', '.join(['states', *(f'given[{i}]' for i in ins), *(f'out[{j}]' for j in outs)])});"]
    else:
        at = [*(f"given[{i}] + k * {takes[i]}" for i in ins), *(f"out[{j}] + k * {gives[j]}" for j in outs)]
        lines += ["    for (size_t k = 0; k < states; k++) {", f"        {function}({', '.join(at)});", "    }"]
    return "\n" + "\n".join([*lines, "}"]) + "\n"


def symbol(function):
    """The name of the loop of a function."""
    return f"{PREFIX}_loop_{function.name}"


def sources(robot, functions, batch, derivatives=()):
    """The C files of these functions and derivatives and of their loops, each a name and a text."""
    requests = [f"{name} = {request}" for name, request, _, _ in derivatives]
    files = robot._generate_c([*(function.name for function in functions), *requests], PREFIX, batch)
    header = "".join(text for name, text in files if name.endswith(".h"))

    def has_batch(name):
        return re.search(rf"\b{PREFIX}_{name}_batch_f64\s*\(", header) is not None

    loops = "".join(_loop(robot, function, has_batch(function.name)) for function in functions)
    loops += "".join(_rows_loop(name, takes, gives, has_batch(name)) for name, _, takes, gives in derivatives)
    return [*files, (f"{PREFIX}_loop.c", f'#include <stddef.h>\n#include "{PREFIX}.h"\n{loops}')]


def build(files, command, flags, folder, name):
    """Compiles C files in a folder into a shared object of this name there."""
    for file, text in files:
        Path(folder, file).write_text(text, encoding="utf-8")
    line = [*command, *FLAGS, *flags, "-o", name, *(file for file, _ in files if file.endswith(".c")), "-lm"]
    done = subprocess.run(line, cwd=folder, capture_output=True, text=True)
    if done.returncode != 0:
        message = (done.stderr or done.stdout).strip()[-2000:]
        raise RuntimeError(f"compile: the C compiler refused: {' '.join(line)}\n{message}")
    return Path(folder, name)


def library(robot, functions, flags, batch, derivatives=()):
    """The path of the shared object of these functions, compiled unless it is in the cache.

    ``derivatives``: a name, a request, and the lengths of arguments and of results of each.
    """
    command = compiler()
    files = sources(robot, functions, batch, derivatives)
    version = subprocess.run([*command, "--version"], capture_output=True, text=True).stdout
    key = repr((files, command, version, FLAGS, flags, processor(flags), platform.machine(), sys.platform))
    path = cache() / f"{hashlib.sha256(key.encode('utf-8', 'surrogatepass')).hexdigest()[:32]}.so"
    record = path.with_suffix(".sha256")
    if _is_whole(path, record):
        return path
    with tempfile.TemporaryDirectory(dir=path.parent) as folder:
        built = build(files, command, flags, folder, "robot.so")
        digest = Path(folder, "robot.sha256")
        digest.write_text(_digest(built), encoding="ascii")
        # Each at once, so that another process never finds half of it. Between the two it finds an
        # object that does not match its digest, and compiles one of its own.
        os.replace(built, path)
        os.replace(digest, record)
    return path


def load_derivatives(path, derivatives):
    """The derivatives of a shared object that ``library`` compiled."""
    return _native.load_derivatives(path, [(f"{PREFIX}_loop_{name}", takes, gives) for name, _, takes, gives in derivatives])


def _digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _is_whole(path, record):
    """Whether the object is there, and is what the compiler wrote: a truncated one would end the process."""
    try:
        return record.read_text(encoding="ascii") == _digest(path)
    except (OSError, UnicodeDecodeError):
        return False


def processor(flags):
    """The processor, if a flag asks the compiler for code of its own: a cache may be shared by machines."""
    if not any("native" in flag for flag in flags):
        return None
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace").split("\n\n")[0].splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    return sorted(line for line in lines if line.split(":")[0].strip() in ("model name", "flags", "CPU implementer", "CPU part", "Features"))


class CompiledRobot:
    """Some of a robot's functions, compiled. ``Robot.compile`` makes one.

    Its methods take the arguments of the robot's methods, check them in the same way, and return the
    same values up to rounding. They compute in float64; of arguments in float32 the result is
    rounded to float32.
    """

    def __init__(self, robot, functions, flags, batch, text, derivatives):
        self.robot = robot
        self.functions = tuple(function.name for _, function in functions)
        rows = list(derivatives.values())
        self.path = library(robot, [function for _, function in functions], flags, batch, rows)
        # For ``articulated.torch`` and ``articulated.jax``, by kind and name of the function.
        self._derivatives = dict(zip(derivatives, load_derivatives(self.path, rows)))
        rows = [(index, symbol(function), function.name, text(function)) for index, function in functions]
        for name, method in zip(self.functions, _native.load_compiled(robot, self.path, rows)):
            setattr(self, name, method)

    def __getattr__(self, name):
        functions = self.__dict__.get("functions", ())
        near = None if name.startswith("_") else _native.nearest(name, list(functions))
        hint = f"; did you mean {near!r}?" if near else f": compiled are {', '.join(functions)}"
        raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}{hint}", name=name, obj=self)

    def __repr__(self):
        return f"<articulated.CompiledRobot {self.robot.name!r}: {', '.join(self.functions)}>"

    def __reduce__(self):
        raise TypeError("found a compiled robot to copy or pickle, expected the robot itself: compile it again there")
