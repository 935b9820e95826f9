"""Trees of links and joints as plain numbers: read from a URDF, or drawn at random with joints of every kind."""

import math
import xml.etree.ElementTree as xml
from dataclasses import asdict, dataclass, field

import numpy

FLOATING_BASE = "__floating_base__"
SIZES = {  # coordinates, degrees of freedom
    "fixed": (0, 0), "revolute": (1, 1), "continuous": (1, 1), "prismatic": (1, 1), "helical": (1, 1),
    "universal": (2, 2), "planar": (3, 3), "spherical": (4, 3), "floating": (7, 6),
}


@dataclass
class Link:
    name: str
    mass: float = 0.0
    xyz: list = field(default_factory=lambda: [0.0] * 3)
    rpy: list = field(default_factory=lambda: [0.0] * 3)
    inertia: list = field(default_factory=lambda: [0.0] * 6)  # xx xy xz yy yz zz about the com, in axes turned by rpy


@dataclass
class Joint:
    name: str
    kind: str
    parent: str
    child: str
    xyz: list
    rpy: list
    axis: list = field(default_factory=lambda: [1.0, 0.0, 0.0])
    second_axis: list = field(default_factory=lambda: [0.0] * 3)  # of a universal joint
    pitch: float = 0.0  # of a helical joint, m per revolution
    mimic: list = None  # [leader, multiplier, offset]
    lower: float = math.nan
    upper: float = math.nan

    @property
    def velocity(self):
        return 2.0


@dataclass
class Tree:
    name: str
    links: list
    joints: list

    @property
    def root(self):
        (root,) = {link.name for link in self.links} - {joint.child for joint in self.joints}
        return root

    def visits(self):
        """Joints depth first, in the order of the file among the children of a link."""
        def below(link):
            for joint in self.joints:
                if joint.parent == link:
                    yield joint
                    yield from below(joint.child)

        return list(below(self.root))

    def link(self, name):
        return next(link for link in self.links if link.name == name)

    def followed(self, joint):
        """(leader, multiplier, offset) through any chain of followers; a leader follows itself."""
        multiplier, offset = 1.0, 0.0
        while joint.mimic:
            name, m, o = joint.mimic
            multiplier, offset = multiplier * m, multiplier * o + offset
            joint = next(other for other in self.joints if other.name == name)
        return joint, multiplier, offset

    def description(self):
        """For JSON; indices instead of names, as in the Rust crates."""
        names = [link.name for link in self.links]
        joints = []
        for joint in self.joints:
            entry = {key: value for key, value in asdict(joint).items() if key not in ("lower", "upper")}
            entry["parent"], entry["child"] = names.index(joint.parent), names.index(joint.child)
            if joint.mimic:
                index = [other.name for other in self.joints].index(joint.mimic[0])
                entry["mimic"] = {"joint": index, "multiplier": joint.mimic[1], "offset": joint.mimic[2]}
            joints.append(entry)
        return {"links": [asdict(link) for link in self.links], "joints": joints}


def stages(joint):
    """A joint as a chain of those with a subspace that is constant in the child's axes: (kind, axis)."""
    if joint.kind == "universal":
        return [("revolute", joint.axis), ("revolute", joint.second_axis)]
    if joint.kind == "planar":
        x, y = plane(joint.axis)
        return [("prismatic", x), ("prismatic", y), ("revolute", joint.axis)]
    kind = "revolute" if joint.kind == "continuous" else joint.kind
    return [] if kind == "fixed" else [(kind, joint.axis)]


def plane(axis):
    """Axes of the two translations of a planar joint: y z for x, z x for y, x y for z; else x = e x axis, e the direction
    farthest from the axis."""
    z = unit(axis)
    if max(z) == 1.0:
        k = int(numpy.argmax(z))
        return numpy.eye(3)[(k + 1) % 3], numpy.eye(3)[(k + 2) % 3]
    x = unit(numpy.cross(numpy.eye(3)[numpy.argmin(abs(z))], z))
    return x, numpy.cross(z, x)


def unit(vector):
    vector = numpy.asarray(vector, float)
    return vector / numpy.linalg.norm(vector)


def rotation(rpy):
    """Rz(yaw) Ry(pitch) Rx(roll)."""
    (cr, cp, cy), (sr, sp, sy) = numpy.cos(rpy), numpy.sin(rpy)
    return numpy.array([
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ])


def read(path):
    """The tree of a URDF: links, joints, inertias, limits, mimic."""
    robot = xml.parse(path).getroot()
    floats = lambda text, default: [float(word) for word in text.split()] if text else list(default)

    def origin(element):
        found = element.find("origin")
        get = (lambda key: None) if found is None else found.get
        return floats(get("xyz"), [0] * 3), floats(get("rpy"), [0] * 3)

    def link(element):
        inertial = element.find("inertial")
        if inertial is None:
            return Link(element.get("name"))
        tensor = inertial.find("inertia")
        moments = [float(tensor.get(key, 0)) for key in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")]
        return Link(element.get("name"), float(inertial.find("mass").get("value")), *origin(inertial), moments)

    def joint(element):
        axis, limit, mimic = element.find("axis"), element.find("limit"), element.find("mimic")
        bound = lambda key: float(limit.get(key, "nan")) if limit is not None else math.nan
        follow = mimic is not None and [mimic.get("joint"), *[float(mimic.get(k, d)) for k, d in (("multiplier", 1), ("offset", 0))]]
        return Joint(
            element.get("name"), element.get("type"), element.find("parent").get("link"), element.find("child").get("link"),
            *origin(element), floats(axis.get("xyz") if axis is not None else None, [1, 0, 0]), mimic=follow or None,
            lower=bound("lower"), upper=bound("upper"),
        )

    return Tree(robot.get("name"), [link(e) for e in robot.findall("link")], [joint(e) for e in robot.findall("joint")])


def drawn(name, random, kinds, fork=3):
    """A tree with a joint of each of `kinds`, in this order: link k hangs on a link among the `fork` before it. A kind `mimic` is a
    revolute joint that follows the last joint with one coordinate."""
    number = random.between
    vector = lambda size: [number(-size, size) for _ in range(3)]

    def body(name):
        # Moments of a solid: those of three perpendicular bars.
        bars = [number(0.01, 0.1) for _ in range(3)]
        moments = [round(bars[1] + bars[2], 6), 0.0, 0.0, round(bars[0] + bars[2], 6), 0.0, round(bars[0] + bars[1], 6)]
        return Link(name, number(0.5, 3.0), vector(0.2), vector(3.0), moments)

    links, joints, leader = [body("base")], [], None
    for k, kind in enumerate(kinds):
        parent = links[max(0, len(links) - 1 - int(number(0, fork)))]
        joint = Joint(f"{kind}_{k}", "revolute" if kind == "mimic" else kind, parent.name, f"link_{k}", vector(0.4), vector(3.0))
        joint.axis = vector(1.0) if k % 3 else [float(x) for x in numpy.eye(3)[k % 2 + 1]]
        joint.second_axis = vector(1.0) if kind == "universal" else joint.second_axis
        joint.pitch = number(0.05, 0.4) if kind == "helical" else 0.0
        joint.mimic = [leader, number(-2, 2), number(-1, 1)] if kind == "mimic" else None
        leader = joint.name if SIZES[joint.kind] == (1, 1) and not joint.mimic else leader
        links.append(body(joint.child))
        joints.append(joint)
    return Tree(name, links, joints)
