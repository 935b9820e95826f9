"""What is drawn of a robot: its page, and the shapes of its links."""

import base64
import colorsys
import json
import os
import warnings
from typing import NamedTuple

import numpy as np

from ._compiled import CompiledRobot
from ._errors import RobotWarning, as_names, as_numbers
from ._robot import Robot, _name, _path

# Hues of limbs, degrees, as on the page.
_HUES = (208, 28, 150, 0, 270, 50, 190, 320)
# Corners of a cube from -1 to 1, and its triangles, counterclockwise seen from outside.
_CORNERS = np.array([[1.0 if k >> axis & 1 else -1.0 for axis in range(3)] for k in range(8)])
_FACES = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
_CUBE = np.array([triangle for a, b, c, d in _FACES for triangle in ((a, b, c), (a, c, d))])


class Shape(NamedTuple):
    """A mesh that moves with a body: points (n, 3) in its frame, m; triangles (m, 3) of indices; red, green, blue, alpha (4,) from 0 to 1.

    ``body`` is an index in ``Drawing.bodies``, or -1 for what does not move.
    """

    link: str
    body: int
    points: np.ndarray
    triangles: np.ndarray
    color: tuple


class Drawing(NamedTuple):
    """Frames of the bodies that move, by the name of a link each; shapes in them; the size of the robot, m."""

    bodies: tuple
    shapes: tuple
    size: float


def robot_of(robot):
    """The robot with all its frames; that of a compiled one."""
    robot = robot.robot if isinstance(robot, CompiledRobot) else robot
    if not isinstance(robot, Robot):
        raise TypeError(f"robot: found {type(robot).__name__}, expected one of articulated.load, loads and bundled")
    return robot if robot._source.frames is None else Robot._made(robot._source._replace(frames=None))


def configuration(robot, q):
    """One configuration, (nq,)."""
    q = as_numbers("q", q)
    if q.shape != (robot.nq,):
        raise ValueError(f"q: found shape {q.shape}, expected ({robot.nq},), one configuration")
    if not np.isfinite(q).all():
        raise ValueError(f"q: found {q[~np.isfinite(q)][0]} at {np.flatnonzero(~np.isfinite(q))[:1].tolist()}, expected finite numbers")
    return q


def chosen(what, robot, names):
    """Names of frames of the robot, each once."""
    names = tuple(dict.fromkeys(as_names(what, names)))
    robot.with_frames(names)
    return names


def polylines(lines):
    """Lines in the world frame, each (n, 3), m: of an array (k, n, 3) or of a list of arrays."""
    try:
        given = list(lines)
    except TypeError:
        raise TypeError(f"lines: found {type(lines).__name__}, expected a list of arrays (n, 3)") from None
    lines = [as_numbers("lines", line) for line in given]
    for k, line in enumerate(lines):
        if line.ndim != 2 or line.shape[1] != 3:
            raise ValueError(f"lines: found shape {line.shape} at [{k}], expected (n, 3), points in m")
        if not np.isfinite(line).all():
            raise ValueError(f"lines: found numbers that are not finite at [{k}], expected finite ones")
    return lines


def page(robot, q=None, title=None, packages=(), level=3):
    """The page of a robot at ``q`` as text. A warning, ``level`` calls up, says which meshes are not drawn as they are."""
    if isinstance(packages, (str, bytes, os.PathLike)):
        packages = [packages]
    q = robot.neutral if q is None else configuration(robot, q)
    title = robot.name if title is None else _name("title", title)
    html, lines = robot._page(q.tolist(), title, [_path("packages", one) for one in packages])
    for line in lines:
        warnings.warn(RobotWarning(line), stacklevel=level)
    return html


def contents(html):
    """The data of a page."""
    return json.loads(html.split('type="application/json">', 1)[1].split("</script>", 1)[0])


def drawing(robot, packages=()):
    """The visual shapes of a robot, and the inertia boxes of links without one."""
    data = contents(page(robot, packages=packages, level=5))
    meshes = [(_numbers(points, "<f4").astype(float), _numbers(triangles, "<u4")) for points, triangles in data["geometries"]]
    shapes = [_shape(solid, *meshes[solid["geometry"]], solid["color"]) for solid in data["solids"] if solid["kind"] == "visual"]
    shapes += [_shape(box, _CORNERS * box["half"], _CUBE, None) for box in data["boxes"] if box["alone"]]
    return Drawing(tuple(data["bodies"]), tuple(shapes), data["size"])


def _numbers(text, dtype):
    return np.frombuffer(base64.b64decode(text), dtype=dtype).reshape(-1, 3)


def _shape(row, points, triangles, color):
    if color is None:
        color = (*colorsys.hls_to_rgb(_HUES[row["limb"] % len(_HUES)] / 360, 0.66, 0.3), 1.0)
    # Row k of `axes` is the direction of the shape's axis k.
    return Shape(row["name"], row["body"] - 1, points @ np.array(row["axes"]) + row["center"], triangles, tuple(color))
