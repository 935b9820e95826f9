"""A robot of a URDF file, and its bodies at one configuration: λ, Ad, S, G.

Every joint is a list of screws in axes of the body that it carries: none of a fixed joint, one of a
revolute, continuous or prismatic joint, six of a floating base.
"""

from dataclasses import dataclass, field
from xml.etree import ElementTree

import numpy as np

from matrices import adjoint, exponential, inertia, inverse, pose, skew

WORLD = -1  # λ(i) of a body that the world carries: the last row of an array of n + 1 rows


@dataclass
class Link:
    """A link of the file, and the joint that carries it. Arrays are in axes of the link."""

    name: str
    parent: int  # λ(i), or WORLD
    mount: np.ndarray  # X_i, (4, 4): pose of the joint in the parent at q = 0
    screws: np.ndarray  # S_i, (6, n_i)
    in_q: slice  # the place of the joint's coordinates in q
    in_v: slice  # the place of the joint's rates in q̇, q̈ and τ
    mass: float = 0.0  # kg
    centre: np.ndarray = field(default_factory=lambda: np.zeros(3))  # centre of mass, m
    moments: np.ndarray = field(default_factory=lambda: np.zeros((3, 3)))  # about the centre, kg·m²


@dataclass
class Robot:
    """The links of a file, parents first, and gravity in m/s², in axes of the world."""

    links: list
    gravity: np.ndarray
    nq: int
    nv: int


@dataclass
class Body:
    """A body at one configuration. Vectors of six are in axes of the body, about its origin."""

    parent: int  # λ(i), or WORLD
    adjoint: np.ndarray  # Ad(T_iλ), (6, 6)
    screws: np.ndarray  # S_i, (6, n_i)
    inertia: np.ndarray  # G_i, (6, 6)
    at: slice  # the place of the joint's rates in q̇, q̈ and τ


@dataclass
class Tree:
    """All that `rnea`, `crba` and `aba` read: the bodies, parents first, and gravity (3,)."""

    bodies: list
    gravity: np.ndarray
    nv: int


def relative_pose(link, q):
    """T_λi = X_i exp([S_i] q_i), (4, 4). q may be complex."""
    q = q[link.in_q]
    if len(q) == 0:
        return link.mount
    if len(q) == 1:
        return link.mount @ exponential(link.screws[:, 0], q[0])
    # A floating base: a position and a unit quaternion (x, y, z, w).
    W = skew(q[3:6])
    return pose(np.eye(3) + 2 * q[6] * W + 2 * W @ W, q[:3])


def placements(robot, q):
    """T_0i = T_0λ T_λi of all links, (n, 4, 4)."""
    T = []
    for link in robot.links:
        relative = relative_pose(link, q)
        T.append(relative if link.parent == WORLD else T[link.parent] @ relative)
    return np.array(T)


def tree_at(robot, q):
    """The bodies of a robot at q (nq,).

    Raises ValueError if q has another shape.
    """
    q = vector("q", q, robot.nq)
    bodies = [
        Body(
            parent=link.parent,
            adjoint=adjoint(inverse(relative_pose(link, q))),
            screws=link.screws,
            inertia=inertia(link.mass, link.centre, link.moments),
            at=link.in_v,
        )
        for link in robot.links
    ]
    return Tree(bodies, robot.gravity, robot.nv)


def vector(name, value, size):
    """An array of this many numbers. Raises ValueError that names the argument."""
    array = np.asarray(value, dtype=float)
    if array.shape != (size,):
        raise ValueError(f"{name}: found shape {array.shape}, expected ({size},)")
    return array


def read(path, base="fixed", gravity=(0.0, 0.0, -9.81)):
    """The robot of a URDF file, its joints depth-first in the order of the file.

    base: "fixed", or "floating" for a root link with six rates, those of its twist in its own axes.
    Raises OSError if there is no such file, and ValueError if it is no tree of links with fixed,
    revolute, continuous and prismatic joints.
    """
    if base not in ("fixed", "floating"):
        raise ValueError(f"base: found {base!r}, expected 'fixed' or 'floating'")
    gravity = vector("gravity", gravity, 3)
    try:
        file = ElementTree.parse(path).getroot()
    except ElementTree.ParseError as error:
        raise ValueError(f"{path}: found XML with a mistake ({error}), expected a URDF") from None
    elements = {one.get("name"): one for one in file.findall("link")}
    if len(elements) != len(file.findall("link")):
        raise ValueError(f"{path}: found two links of one name, expected a name for each")
    joints = {name: [] for name in elements}  # those that a link carries
    roots = dict.fromkeys(elements)
    for joint in file.findall("joint"):
        ends = [(joint.find(end) if joint.find(end) is not None else {}).get("link") for end in ("parent", "child")]
        for end, name in zip(("parent", "child"), ends):
            if name not in elements:
                raise ValueError(f"{path}: joint {joint.get('name')}: found the {end} {name}, expected a link of the file")
        joints[ends[0]].append((joint, ends[1]))
        roots.pop(ends[1], None)
    if len(roots) != 1:
        raise ValueError(f"{path}: found {len(roots)} links without a parent, expected one")

    links, nq, nv = [], 0, 0
    waiting = [(WORLD, None, *roots)]
    while waiting:
        parent, joint, name = waiting.pop()
        screws = np.eye(6)[:, : 6 * (base == "floating")] if joint is None else _screws(path, joint)
        n = screws.shape[1]
        at_q, at_v = slice(nq, nq + n + (n == 6)), slice(nv, nv + n)
        mount = np.eye(4) if joint is None else _origin(f"{path}: joint {joint.get('name')}", joint)
        links.append(Link(name, parent, mount, screws, at_q, at_v, *_mass(path, elements[name])))
        nq, nv = at_q.stop, at_v.stop
        waiting += [(len(links) - 1, *child) for child in reversed(joints[name])]
    if sorted(link.name for link in links) != sorted(elements):
        raise ValueError(f"{path}: found joints that make a loop, expected a tree")
    return Robot(links, gravity, nq, nv)


def _screws(path, joint):
    """S_i, (6, n_i), of a joint of the file."""
    kind, where = joint.get("type"), f"{path}: joint {joint.get('name')}"
    if joint.find("mimic") is not None:
        raise ValueError(f"{where}: found <mimic>, expected a joint with coordinates of its own")
    if kind == "fixed":
        return np.zeros((6, 0))
    if kind not in ("revolute", "continuous", "prismatic"):
        raise ValueError(f"{where}: found type {kind!r}, expected fixed, revolute, continuous or prismatic")
    axis = _numbers(where, joint.find("axis"), "xyz", "1 0 0")
    if not axis.any():
        raise ValueError(f"{where}: found the axis 0 0 0, expected a direction")
    # S = (ŝ; 0) revolute, S = (0; ŝ) prismatic
    screw = np.zeros((6, 1))
    screw[3 * (kind == "prismatic") :][:3, 0] = axis / np.linalg.norm(axis)
    return screw


def _origin(where, element):
    """The pose of the <origin> of an element, (4, 4): about the fixed axes x, y, z by rpy."""
    origin = element.find("origin")
    R = np.eye(3)
    for axis, angle in zip(np.eye(3), _numbers(where, origin, "rpy", "0 0 0")):
        R = exponential(np.append(axis, np.zeros(3)), angle)[:3, :3] @ R
    return pose(R, _numbers(where, origin, "xyz", "0 0 0"))


def _mass(path, link):
    """Mass, centre of mass (3,) and moments (3, 3) about it, in axes of the link."""
    inertial, where = link.find("inertial"), f"{path}: link {link.get('name')}"
    if inertial is None:
        return 0.0, np.zeros(3), np.zeros((3, 3))
    (mass,) = _numbers(where, inertial.find("mass"), "value", "")
    moments = inertial.find("inertia")
    xx, xy, xz, yy, yz, zz = (_numbers(where, moments, "i" + one, "")[0] for one in ("xx", "xy", "xz", "yy", "yz", "zz"))
    T = _origin(where, inertial)
    R = T[:3, :3]
    return mass, T[:3, 3], R @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ R.T


def _numbers(where, element, attribute, default):
    """The numbers of an attribute: one, or three where the default has three."""
    text = default if element is None else element.get(attribute, default)
    expected = 3 if default else 1
    try:
        numbers = np.array([float(word) for word in text.split()])
    except ValueError:
        numbers = np.array([])
    if len(numbers) != expected or not np.isfinite(numbers).all():
        raise ValueError(f"{where}: found {attribute}={text!r}, expected {expected} finite number{'s'[: expected - 1]}")
    return numbers
