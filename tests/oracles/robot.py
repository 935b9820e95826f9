"""Reads a robot from its URDF: only what energies need. Shares nothing with the Rust reader.

Numbers of the file are taken as the nearest double. What is derived from them (the nine entries of a rotation, a
normalised axis) is irrational and therefore kept to 60 digits.
"""

import hashlib
import math
import xml.etree.ElementTree as xml
from dataclasses import dataclass, field
from decimal import Decimal
from pathlib import Path

import digits

FLOATING_BASE = "__floating_base__"
ONE_DOF = ("revolute", "continuous", "prismatic")


@dataclass
class Link:
    name: str
    mass: float = 0.0
    com: list = field(default_factory=lambda: [0.0, 0.0, 0.0])
    inertia: list = field(default_factory=lambda: [[Decimal(0)] * 3 for _ in range(3)])  # about the com, in link axes


@dataclass
class Joint:
    name: str
    kind: str
    parent: str
    child: str
    xyz: list
    rotation: list  # child frame at q = 0 seen from the parent link
    axis: list
    lower: float
    upper: float
    velocity: float
    mimic: tuple = None  # (leader, multiplier, offset)


@dataclass
class Robot:
    name: str
    sha256: str
    root: str
    links: dict
    visits: list  # all joints, depth first, children in the order of the file
    coordinates: list  # the joints that have a coordinate of their own, in that order
    follows: dict  # joint name -> (index of coordinate, multiplier, offset), coordinates themselves included

    def moving_links(self, floating):
        """Links that can move in the world frame. With a free base that is every link."""
        moving = {self.root} if floating else set()
        for joint in self.visits:
            if joint.parent in moving or joint.kind != "fixed":
                moving.add(joint.child)
        return moving

    def link_order(self):
        return [self.root] + [joint.child for joint in self.visits]


def numbers(text, default):
    return [float(word) for word in text.split()] if text else list(default)


def pose(element):
    """xyz and the rotation Rz(yaw) Ry(pitch) Rx(roll) of an <origin>, the identity where it is missing."""
    origin = element.find("origin") if element is not None else None
    get = (lambda key: None) if origin is None else origin.get
    return numbers(get("xyz"), [0, 0, 0]), rotation_of_rpy(*numbers(get("rpy"), [0, 0, 0]))


def rotation_of_rpy(roll, pitch, yaw):
    (sr, cr), (sp, cp), (sy, cy) = (digits.sin_cos(Decimal(angle)) for angle in (roll, pitch, yaw))
    with digits.precise():
        return [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]


def read_link(element):
    link = Link(element.get("name"))
    inertial = element.find("inertial")
    if inertial is None:
        return link
    mass, tensor = inertial.find("mass"), inertial.find("inertia")
    link.mass = float(mass.get("value")) if mass is not None else 0.0
    link.com, turn = pose(inertial)
    if tensor is not None:
        xx, xy, xz, yy, yz, zz = (Decimal(float(tensor.get(key, 0))) for key in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"))
        local = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
        with digits.precise():
            # I_link = R I R^T
            link.inertia = [
                [sum(turn[i][k] * local[k][l] * turn[j][l] for k in range(3) for l in range(3)) for j in range(3)]
                for i in range(3)
            ]
    return link


def read_joint(element):
    name, kind = element.get("name"), element.get("type")
    if kind not in ONE_DOF + ("fixed",):
        raise ValueError(f"joint {name}: the oracle knows no joints of type {kind}")
    xyz, rotation = pose(element)
    axis, limit, mimic = element.find("axis"), element.find("limit"), element.find("mimic")
    with digits.precise():
        axis = [Decimal(x) for x in numbers(axis.get("xyz") if axis is not None else None, [1, 0, 0])]
        length = sum(x * x for x in axis).sqrt()
        axis = [x / length for x in axis] if kind != "fixed" else axis
    bound = lambda key: float(limit.get(key, "nan")) if limit is not None else math.nan
    return Joint(
        name, kind, element.find("parent").get("link"), element.find("child").get("link"), xyz, rotation, axis,
        bound("lower"), bound("upper"), bound("velocity"),
        None if mimic is None
        else (mimic.get("joint"), Decimal(float(mimic.get("multiplier", 1))), Decimal(float(mimic.get("offset", 0)))),
    )


def read(path, use_mimic=True):
    """The robot of a URDF file. `use_mimic=False` makes followers free joints."""
    content = Path(path).read_bytes()
    tree = xml.fromstring(content)
    links = {link.name: link for link in map(read_link, tree.findall("link"))}
    joints = [read_joint(element) for element in tree.findall("joint")]
    (root,) = set(links) - {joint.child for joint in joints}

    visits = []

    def visit(link):
        for joint in joints:
            if joint.parent == link:
                visits.append(joint)
                visit(joint.child)

    visit(root)
    if not use_mimic:
        for joint in joints:
            joint.mimic = None
    coordinates = [joint for joint in visits if joint.kind != "fixed" and joint.mimic is None]
    follows = {joint.name: (index, Decimal(1), Decimal(0)) for index, joint in enumerate(coordinates)}
    by_name = {joint.name: joint for joint in joints}

    def resolve(name, seen=()):
        """q_name = multiplier * q_index + offset, through any chain of followers."""
        if name in seen:
            raise ValueError(f"joint {name} follows itself")
        if name not in follows:
            leader, multiplier, offset = by_name[name].mimic
            index, inner, shift = resolve(leader, seen + (name,))
            with digits.precise():
                follows[name] = (index, multiplier * inner, multiplier * shift + offset)
        return follows[name]

    for joint in visits:
        if joint.kind != "fixed":
            resolve(joint.name)
    return Robot(tree.get("name"), hashlib.sha256(content).hexdigest(), root, links, visits, coordinates, follows)
