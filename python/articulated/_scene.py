"""Scenes: a robot, what acts on it, and its motion."""

import json
import os
import tempfile
import warnings
import webbrowser
from pathlib import Path

import numpy as np

from . import _native
from ._errors import RobotWarning, as_numbers


def _warn(lines):
    for line in lines:
        warnings.warn(RobotWarning(line), stacklevel=3)


def _number(name, value):
    if value is None:
        return None
    number = as_numbers(name, value)
    if number.shape != ():
        raise ValueError(f"{name}: found shape {number.shape}, expected a number or None")
    return float(number)


def _path(path):
    try:
        return Path(os.fsdecode(path))
    except TypeError:
        raise TypeError(f"path: found {type(path).__name__}, expected the name of a file or a folder") from None


class Scene:
    """A scene: a bundled one by its name, or the path of a TOML file.

    >>> scene = Scene("pendulum")
    >>> motion = scene.run(end=0.5)
    >>> float(motion.time[-1]), motion.q.shape[1]
    (0.5, 1)

    Raises:
        RobotError: There is no such scene, or it has mistakes; ``diagnostics`` lists all at once.
    """

    def __init__(self, scene):
        self._scene, lines = _native.Scene.open(_path(scene))
        _warn(lines)

    @property
    def name(self):
        """The scene's name, without folder and ending."""
        return self._scene.name

    def __repr__(self):
        return f"<articulated.Scene {self.name!r}>"

    def run(self, *, end=None, integrator=None, step=None, rtol=None, atol=None, every=None):
        """Simulates the scene.

        Args:
            end: The last time, s.
            integrator: Its name, such as "dopri5" or "rk4".
            step: Fixed steps of this length, s.
            rtol: Relative tolerance of a step.
            atol: Absolute tolerance of a step, rad, m, and those a second.
            every: Seconds between two records.
            None stands for what the scene says.

        Returns:
            Motion.

        Raises:
            RobotError: The settings or the start do not fit.

        Warns:
            RobotWarning: The motion ends with an error, or its balance of energy is not kept; or
                something at its start looks wrong.
        """
        if integrator is not None and not isinstance(integrator, str):
            raise TypeError(f"integrator: found {type(integrator).__name__}, expected a name or None")
        numbers = [_number(name, value) for name, value in (("step", step), ("rtol", rtol), ("atol", atol), ("every", every))]
        recorded, lines = self._scene.run(_number("end", end), integrator, *numbers)
        _warn(lines)
        return Motion(recorded)

    def show(self, **changes):
        """Simulates the scene and opens the page that plays it. Arguments: see ``run``; the result: see ``Motion.show``."""
        return self.run(**changes).show()

    def write(self, path, **changes):
        """Simulates the scene and writes the motion. Arguments: see ``Motion.write`` and ``run``."""
        return self.run(**changes).write(path)


class Motion:
    """A recorded motion. ``Scene.run`` makes one.

    ``columns`` has every column of the command's recording.csv by its title: t, q.JOINT, v.JOINT,
    tau.JOINT, kinetic_energy, potential_energy, work, dissipated, from_events, imbalance, and
    momentum.angular.x to momentum.linear.z. ``units`` has their units. ``motion[title]`` is a column.
    """

    def __init__(self, recorded):
        self._recorded = recorded
        rows = recorded.columns()
        self.columns = {title: numbers for title, _, numbers in rows}
        self.units = {title: unit for title, unit, _ in rows}
        self.summary = json.loads(recorded.summary())
        numbers, (nq, nv) = [numbers for _, _, numbers in rows], recorded.sizes()
        self.time = numbers[0]
        self.q, self.v, self.tau = (
            np.stack(part, axis=1) if part else np.zeros((len(self.time), 0))
            for part in (numbers[1 : 1 + nq], numbers[1 + nq : 1 + nq + nv], numbers[1 + nq + nv : 1 + nq + 2 * nv])
        )

    def __getitem__(self, title):
        try:
            return self.columns[title]
        except (KeyError, TypeError):
            near = _native.nearest(str(title), list(self.columns))
            raise KeyError(f"found {title!r}, expected a title of columns" + (f"; did you mean {near!r}?" if near else "")) from None

    def __len__(self):
        return len(self.time)

    def __repr__(self):
        return f"<articulated.Motion {self.summary['scene']!r}: {len(self)} records to t = {self.summary['end_s']} s, {self.status}>"

    @property
    def status(self):
        """ "ok"; "out_of_tolerance": the balance of energy is not kept; "error": it ended with an error."""
        return self.summary["status"]

    @property
    def events(self):
        """Events in the order of their times: dicts with time, what, kind, on and begins."""
        return self.summary["events"]

    def to_arrow(self):
        """The columns as a ``pyarrow.Table``; units are in the metadata of its fields."""
        try:
            import pyarrow
        except ImportError:
            raise ImportError("to_arrow: found no pyarrow, expected it to be installed: pip install pyarrow") from None
        fields = [pyarrow.field(title, pyarrow.float64(), nullable=False, metadata={"unit": unit} if unit else None) for title, unit in self.units.items()]
        return pyarrow.Table.from_arrays([pyarrow.array(numbers) for numbers in self.columns.values()], schema=pyarrow.schema(fields))

    def write(self, path, packages=()):
        """Writes the motion: recording.csv, summary.json, pictures and the page that plays it into a
        folder, which is made; or the page alone, if the path ends with .html.

        Args:
            path: The folder, or the page.
            packages: Folders of ROS packages, or NAME=FOLDER, for meshes named package://NAME/…

        Returns:
            The names of the files; the path of the page.

        Raises:
            RobotError: They cannot be written.
        """
        if isinstance(packages, (str, bytes, os.PathLike)):
            packages = [packages]
        files, lines = self._recorded.write(_path(path), [_path(one) for one in packages])
        _warn(lines)
        return files

    def show(self, packages=()):
        """Writes the page that plays the motion to a temporary file, and opens it in a browser.

        Returns:
            The path of the page, which stays.
        """
        number, name = tempfile.mkstemp(prefix=f"{self.summary['scene']}-", suffix=".html")
        os.close(number)
        path = Path(name)
        try:
            self.write(path, packages)
        except BaseException:
            path.unlink()
            raise
        if not webbrowser.open(path.as_uri()):
            warnings.warn(RobotWarning(f"show: found no browser, expected one to open {path}"), stacklevel=2)
        return path


def bundled_scene_names():
    """Names of the scenes that come with the package, each with a line about it."""
    return dict(_native.bundled_scenes())
