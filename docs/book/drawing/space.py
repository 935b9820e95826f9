"""Geometry in space, by lists of numbers: rotations, a camera, and the tree of a URDF file."""

import xml.etree.ElementTree as ET
from math import cos, radians, sin, sqrt

X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
ZERO = (0.0, 0.0, 0.0)


def add(*vectors):
    return tuple(map(sum, zip(*vectors)))


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def scale(k, a):
    return tuple(k * x for x in a)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def norm(a):
    return sqrt(dot(a, a))


def unit(a):
    return scale(1 / norm(a), a)


def apply(rotation, a):
    """R a, of a matrix by rows."""
    return tuple(dot(row, a) for row in rotation)


def product(a, b):
    """The product of two matrices by rows."""
    return [[dot(row, column) for column in zip(*b)] for row in a]


def rotation(axis, angle):
    """R = 1 + sin q [s]x + (1 - cos q) [s]x^2 about a unit axis s (Rodrigues), by its columns' images."""
    columns = []
    for e in (X, Y, Z):
        first = cross(axis, e)
        columns.append(add(e, scale(sin(angle), first), scale(1 - cos(angle), cross(axis, first))))
    return [list(row) for row in zip(*columns)]


class Camera:
    """A parallel projection, seen from an azimuth (from x to y) and an elevation in degrees.

    `size` is pixels for each metre; `at` is where the origin is on the page.
    """

    def __init__(self, azimuth, elevation, size, at):
        a, e = radians(azimuth), radians(elevation)
        self.right = (-sin(a), cos(a), 0.0)
        self.up = (-sin(e) * cos(a), -sin(e) * sin(a), cos(e))
        self.back = (cos(e) * cos(a), cos(e) * sin(a), sin(e))
        self.size, self.at = size, at

    def __call__(self, p):
        return (self.at[0] + self.size * dot(p, self.right), self.at[1] - self.size * dot(p, self.up))

    def depth(self, p):
        """Grows towards the viewer."""
        return dot(p, self.back)


def triad(page, camera, origin, turned, length, colour, names=("x", "y", "z"), gap=9):
    """The axes of a frame: its origin, its rotation, and the length of the axes in metres."""
    foot = camera(origin)
    axes = [(tuple(row[k] for row in turned), name) for k, name in enumerate(names)]
    for axis, name in sorted(axes, key=lambda pair: camera.depth(pair[0])):
        tip = camera(add(origin, scale(length, axis)))
        page.arrow([foot, tip], colour, 1.8, head=8)
        far = ((tip[0] - foot[0]) ** 2 + (tip[1] - foot[1]) ** 2) ** 0.5
        k = 1 + gap / far
        page.symbol((foot[0] + (tip[0] - foot[0]) * k, foot[1] + (tip[1] - foot[1]) * k + 4), name, size=13, colour=colour)
    page.disc(foot, 3, colour, None)


class Tree:
    """The joints of a URDF file in its order, which has parents before children in our files."""

    def __init__(self, path):
        root = ET.parse(path).getroot()
        self.joints, self.links = root.findall("joint"), root.findall("link")
        children = {self.child(j) for j in self.joints}
        self.root = next(link.get("name") for link in self.links if link.get("name") not in children)
        self.moving = [j for j in self.joints if j.get("type") != "fixed"]

    @staticmethod
    def child(joint):
        return joint.find("child").get("link")

    @staticmethod
    def parent(joint):
        return joint.find("parent").get("link")

    def poses(self, q):
        """The pose (R, p) of each link in the root, and (name, axis, point) of each moving joint there.

        All joints of the file are revolute or fixed, and no `origin` turns: others are refused.
        """
        links, axes, values = {self.root: ([X, Y, Z], ZERO)}, [], iter(q)
        for joint in self.joints:
            turned, p = links[self.parent(joint)]
            origin = joint.find("origin")
            shift = tuple(map(float, origin.get("xyz").split()))
            p = add(p, apply(turned, shift))
            kind = joint.get("type")
            if kind not in ("revolute", "fixed") or any(map(float, origin.get("rpy").split())):
                raise ValueError(f"joint {joint.get('name')}: expected a revolute or fixed joint without rpy")
            if kind == "revolute":
                axis = tuple(map(float, joint.find("axis").get("xyz").split()))
                axes.append((joint.get("name"), apply(turned, axis), p))
                turned = product(turned, rotation(axis, next(values)))
            links[self.child(joint)] = (turned, p)
        return links, axes

    def carriers(self):
        """For each moving joint the numbers of the moving joints on its path to the root, itself last."""
        above, out = {self.root: []}, []
        for joint in self.joints:
            path = above[self.parent(joint)]
            if joint.get("type") != "fixed":
                path = [*path, len(out)]
                out.append(path)
            above[self.child(joint)] = path
        return out
