"""Robots in packages that are installed."""

import fnmatch
import os
import re
import site
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from . import _native
from ._errors import RobotError
from ._robot import load

# Folders that contain no robots, and how deep folders are searched.
_PASSED_OVER = {"meshes", "mesh", "assets", "textures", "node_modules", "__pycache__"}
_DEEPEST = 8
_ENDINGS = (".urdf", ".xacro", ".xml", ".mjcf", ".sdf")
_FORMATS = {"robot": "urdf", "mujoco": "mjcf", "sdf": "sdf"}
# Bytes of a file that is looked at, at most.
_MOST_BYTES = 16 << 20


class Place(NamedTuple):
    """A folder that may contain robots, and the package that it is of."""

    package: str
    folder: Path


class FoundRobot(NamedTuple):
    """A robot's file in a package that is installed.

    ``format``: "urdf", "xacro", "mjcf" or "sdf". ``package``: what brought the file. ``packages``:
    folders of the ROS packages that contain it, by name, for ``$(find NAME)`` and ``package://NAME/…``.
    """

    name: str
    file: Path
    format: str
    package: str
    packages: Mapping[str, Path]

    def __repr__(self):
        return f"<articulated.FoundRobot {self.name!r}, {self.format} of {self.package}: {self.file}>"

    def load(self, base="fixed", gravity=None, frames=None, wrenches_in="body", *, packages=None, **options):
        """The robot of the file. Arguments are those of ``articulated.load``; ``packages`` come before those of the file."""
        if packages is not None and not hasattr(packages, "items"):
            raise TypeError(f"packages: found {type(packages).__name__}, expected a dict")
        return load(self.file, base, gravity, frames, wrenches_in, packages={**self.packages, **(packages or {})}, **options)


def robots(pattern=None):
    """Robots of packages that are installed: example-robot-data, robot_descriptions, mujoco_menagerie, and ROS.

    >>> articulated.robots("panda")                             # doctest: +SKIP
    >>> robot = articulated.robots("panda")[0].load()           # doctest: +SKIP

    Nothing is downloaded: robots of robot_descriptions and mujoco-menagerie are those in the caches of
    these packages. Scenes without a body of their own, and xacro files without a name, are left out.

    Args:
        pattern: A part of the name or of the path of the file, such as "panda" or "franka", in small
            or capital letters; with ``*``, ``?`` or ``[…]`` the whole name. None for all.

    Returns:
        FoundRobot, … in the order of packages and names.

    Raises:
        RobotError: There is none. The message names the folders that were searched.
    """
    if pattern is not None and not isinstance(pattern, str):
        raise TypeError(f"pattern: found {type(pattern).__name__}, expected a part of a name, or None")
    places, all_found, known = _places(), [], set()
    for place in places:
        for found in sorted(_in(place), key=lambda found: (found.name.lower(), str(found.file))):
            # One package may lie in the folder of another.
            real = os.path.realpath(found.file)
            if real not in known:
                known.add(real)
                all_found.append((found, str(found.file.relative_to(place.folder))))
    fitting = [found for found, path in all_found if pattern is None or _fits(pattern, found.name, path)]
    if not fitting:
        raise RobotError(_nothing(pattern, places, sorted({found.name for found, _ in all_found})))
    return fitting


def _fits(pattern, name, path):
    pattern = pattern.lower()
    if any(sign in pattern for sign in "*?["):
        return fnmatch.fnmatchcase(name.lower(), pattern)
    return pattern in name.lower() or pattern in path.lower()


def _nothing(pattern, places, names):
    searched = "".join(f"\n  {place.package}: {place.folder}{'' if place.folder.is_dir() else ' (not there)'}" for place in places)
    if names:
        near = _native.nearest(pattern, names)
        hint = f"did you mean {near!r}?" if near else f"articulated.robots() lists {len(names)} names"
        return f"pattern: found no robot of {pattern!r} in the packages that are installed; {hint}\nsearched:{searched}"
    wanted = "" if pattern is None else f" of {pattern!r}"
    return f"found no robot{wanted}, expected a package with robots: pip install example-robot-data\nsearched:{searched}"


def _places():
    """All places, those that are not there too, each once."""
    home, get = Path.home(), os.environ.get
    shares = [Path(folder) / "cmeel.prefix" / "share" for folder in _sites()] + [Path(sys.prefix) / "share"]
    found = [Place("example-robot-data", share / "example-robot-data") for share in shares]
    found.append(Place("robot_descriptions", Path(get("ROBOT_DESCRIPTIONS_CACHE") or home / ".cache" / "robot_descriptions").expanduser()))
    if get("MENAGERIE_ROOT"):
        found.append(Place("mujoco_menagerie", Path(get("MENAGERIE_ROOT"))))
    found.append(Place("mujoco_menagerie", Path(get("MENAGERIE_CACHE_DIR") or _cache(home) / "mujoco_menagerie")))
    for prefix in filter(None, get("AMENT_PREFIX_PATH", "").split(os.pathsep)):
        found.append(Place("ROS", Path(prefix) / "share"))
    # Of a package that is in none of its folders, one is named.
    missing = [place for place in found if place.package == "example-robot-data" and not place.folder.is_dir()]
    kept = [place for place in found if place not in missing]
    if len(missing) == len(shares):
        kept.insert(0, missing[0])
    return list(dict.fromkeys(kept))


def _sites():
    """Folders of installed packages."""
    own = [folder for folder in sys.path if Path(folder).name in ("site-packages", "dist-packages")]
    return list(dict.fromkeys([*own, *(site.getsitepackages() if hasattr(site, "getsitepackages") else [])]))


def _cache(home):
    """The folder of caches of the user."""
    if sys.platform == "darwin":
        return home / "Library" / "Caches"
    return Path(os.environ.get("XDG_CACHE_HOME") or home / ".cache")


def _in(place):
    """Robots in a place."""
    root, packages = str(place.folder), {}
    for folder, below, files in os.walk(root):
        depth = len(Path(folder).relative_to(root).parts)
        below[:] = [] if depth >= _DEEPEST else [one for one in below if one.lower() not in _PASSED_OVER and not one.startswith(".")]
        packages[folder] = {**packages.get(os.path.dirname(folder), {}), **_declared(folder, files)}
        for name in files:
            if name.lower().endswith(_ENDINGS):
                path = Path(folder, name)
                form = _format(path)
                if form:
                    yield FoundRobot(_stem(name), path, form, place.package, packages[folder])


def _declared(folder, files):
    """The ROS package of a folder, by the name of its folder and by that of its package.xml."""
    if "package.xml" not in files:
        return {}
    declared = re.search(r"<name>\s*([^<\s]+)\s*</name>", _text(Path(folder, "package.xml")))
    names = [os.path.basename(folder), *(declared.groups() if declared else ())]
    return {name: Path(folder) for name in names}


def _stem(name):
    """The name of a file without its endings."""
    for ending in (".xacro", *_ENDINGS):
        if name.lower().endswith(ending):
            name = name[: -len(ending)]
    return name


def _text(path):
    try:
        with open(path, "rb") as file:
            return file.read(_MOST_BYTES).decode("utf-8", "replace")
    except OSError:
        return ""


def _format(path):
    """The format of a robot's file; None of another file, of a part of a robot, and of a scene without a body."""
    text = re.sub(r"<!--.*?-->|<[?!][^>]*>", "", _text(path), flags=re.DOTALL)
    root = re.search(r"<([A-Za-z_][\w.-]*)([^>]*)>", text)
    form = _FORMATS.get(root.group(1)) if root else None
    if form == "urdf" and not re.search(r"\sname\s*=", root.group(2)):
        return None
    if form == "mjcf" and not re.search(r"<body\b", text):
        return None
    if form == "sdf" and not re.search(r"<model\b", text):
        return None
    return "xacro" if form == "urdf" and path.name.lower().endswith(".xacro") else form
