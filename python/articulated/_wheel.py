"""Wheels of one robot: its compiled functions with a loader that needs NumPy alone."""

import base64
import hashlib
import io
import keyword
import os
import platform
import re
import sys
import sysconfig
import tempfile
import zipfile
from pathlib import Path

from ._compiled import PREFIX, build, compiler, lengths, sources

# Default functions of a wheel.
FUNCTIONS = (
    "placements",
    "jacobians_body",
    "inverse_dynamics",
    "bias_forces",
    "gravity_torque",
    "mass_matrix",
    "forward_dynamics",
    "center_of_mass",
    "kinetic_energy",
    "potential_energy",
    "integrate",
    "difference",
)
FILE = "_robot.so"


def platform_tag():
    """The platform of what is compiled here; of Linux with the version of its C library, the oldest that will do."""
    tag = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    if tag.startswith("linux_"):
        library, version = platform.libc_ver()
        found = re.match(r"(\d+)\.(\d+)", version)
        if library == "glibc" and found:
            return f"manylinux_{found[1]}_{found[2]}_{tag[len('linux_'):]}"
    return tag.replace("universal2", platform.machine())


def module_name(name):
    """A robot's name as a Python name."""
    name = re.sub(r"\W", "_", name.lower(), flags=re.ASCII).strip("_") or "robot"
    return f"robot_{name}" if name[0].isdigit() or keyword.iskeyword(name) else name


def _plain(name):
    """A robot's name for texts: without what ends a string or a line."""
    return "".join(letter if letter.isprintable() and letter not in "\"\\" else "_" for letter in name)


def _checked(name, version):
    if not isinstance(name, str) or not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name) or keyword.iskeyword(name):
        raise ValueError(f"name: found {name!r}, expected a Python name of ASCII letters, digits and underscores")
    if name.lower() in ("articulated", "numpy") or name in sys.stdlib_module_names:
        raise ValueError(f"name: found {name!r}, the name of another package, expected one of its own")
    if not isinstance(version, str) or not re.fullmatch(r"\d+(\.\d+)*((a|b|rc)\d+)?(\.post\d+)?(\.dev\d+)?", version):
        raise ValueError(f"version: found {version!r}, expected a version such as '0.1.0'")


def _module(robot, functions, text):
    rows = [(f.name, [(name, lengths(robot, dims)) for name, dims, _ in f.takes], lengths(robot, f.gives)) for f in functions]
    facts = {
        "NAME": robot.name,
        "BASE": robot.base,
        "NQ": robot.nq,
        "NV": robot.nv,
        "FRAMES": robot.frames,
        "LINKS": robot.links,
        "JOINTS": tuple((j.name, j.kind, (j.q.start, j.q.stop), (j.v.start, j.v.stop)) for j in robot.joints),
        "GRAVITY": tuple(robot.gravity.tolist()),
        "WRENCHES_IN": robot.wrenches_in,
    }
    numbers = {"LOWER": robot.lower, "UPPER": robot.upper, "VELOCITY_LIMIT": robot.velocity_limit, "EFFORT_LIMIT": robot.effort_limit}
    numbers["NEUTRAL"] = robot.neutral
    body = [
        f'"""The robot {_plain(robot.name)}: {len(functions)} functions on NumPy arrays, one state or many. Made by articulated.\n\n'
        'SI units, radians. Six-vectors are [angular, linear]. JOINTS has name, kind, and ranges in q and v of each joint.\n"""\n',
        "import ctypes\nimport math\nimport os\nimport threading\n\nimport numpy as np\n",
        "".join(f"{name} = {value!r}\n" for name, value in facts.items()),
        "".join(f"{name} = np.array({[repr(x) for x in value.tolist()]!r}, dtype=np.float64)\n" for name, value in numbers.items()),
        f"_FILE = {FILE!r}\n_PREFIX = {PREFIX!r}\n_FUNCTIONS = {rows!r}",
        Path(__file__).with_name("_loader.py").read_text(encoding="utf-8").rstrip() + "\n",
    ]
    for index, function in enumerate(functions):
        given = "".join(f"{name}, " for name, _, _ in function.takes)
        body.append(f'\ndef {function.name}({given}*, threads=None):\n    """{text(function)}"""\n    return _run({index}, ({given}), threads)\n')
    return "\n".join(body)


def _types(functions, robot):
    lines = [
        "from typing import Any, Optional\n",
        "import numpy as np",
        "from numpy.typing import ArrayLike, NDArray\n",
        "NAME: str\nBASE: str\nWRENCHES_IN: str\nNQ: int\nNV: int",
        "FRAMES: tuple[str, ...]\nLINKS: tuple[str, ...]\nGRAVITY: tuple[float, float, float]",
        "JOINTS: tuple[tuple[str, str, tuple[int, int], tuple[int, int]], ...]",
        *(f"{name}: NDArray[np.float64]" for name in ("LOWER", "UPPER", "VELOCITY_LIMIT", "EFFORT_LIMIT", "NEUTRAL")),
        "",
    ]
    for function in functions:
        given = "".join(f"{name}: ArrayLike, " for name, _, _ in function.takes)
        # Of one state a single number is a float, of several an array.
        result = "NDArray[np.float64]" if function.gives else "Any"
        lines.append(f"def {function.name}({given}*, threads: Optional[int] = None) -> {result}: ...")
    return "\n".join(lines) + "\n"


def write(robot, folder, functions, name, version, flags, batch, text):
    """Compiles, and writes the wheel into a folder, which is made. Its path."""
    name = module_name(robot.name) if name is None else name
    _checked(name, version)
    command = compiler()
    files = sources(robot, functions, batch)
    with tempfile.TemporaryDirectory() as work:
        library = build(files, command, flags, work, FILE).read_bytes()
    tag = f"py3-none-{platform_tag()}"
    info = f"{name}-{version}.dist-info"
    summary = f"Dynamics of the robot {_plain(robot.name)}: {', '.join(function.name for function in functions)}"
    metadata = [
        "Metadata-Version: 2.1",
        f"Name: {name}",
        f"Version: {version}",
        f"Summary: {summary}",
        "Requires-Python: >=3.9",
        "Requires-Dist: numpy>=1.22",
    ]
    members = {
        f"{name}/__init__.py": _module(robot, functions, text).encode(),
        f"{name}/__init__.pyi": _types(functions, robot).encode(),
        f"{name}/py.typed": b"",
        f"{name}/{FILE}": library,
        f"{info}/METADATA": ("\n".join(metadata) + "\n").encode(),
        f"{info}/WHEEL": f"Wheel-Version: 1.0\nGenerator: articulated\nRoot-Is-Purelib: false\nTag: {tag}\n".encode(),
    }
    path = Path(os.fsdecode(folder), f"{name}-{version}-{tag}.whl")
    path.parent.mkdir(parents=True, exist_ok=True)
    record, out = [], io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for member, content in members.items():
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            record.append(f"{member},sha256={digest},{len(content)}")
            _add(archive, member, content)
        _add(archive, f"{info}/RECORD", "\n".join([*record, f"{info}/RECORD,,", ""]).encode())
    path.write_bytes(out.getvalue())
    return path


def _add(archive, member, content):
    # The same bytes whenever it is made.
    entry = zipfile.ZipInfo(member, (1980, 1, 1, 0, 0, 0))
    entry.external_attr = (0o755 if member.endswith(".so") else 0o644) << 16
    entry.compress_type = zipfile.ZIP_DEFLATED
    archive.writestr(entry, content)
