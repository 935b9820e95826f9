"""The drawing of a robot beside its sliders: visual shapes of its URDF as lines and discs."""

import math
import xml.etree.ElementTree as ElementTree

# The directions to the right and up in the picture. The eye is on the positive y axis, so a positive
# turn about y is counterclockwise.
VIEW = [[-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]


def drawing(file, links):
    """The shapes, the two axes of the picture, and the longest reach in m.

    Each shape is in the frame of a link, which is given by its index in `links`.
    """
    robot = ElementTree.parse(file).getroot()
    bodies, reach = [], {links[0]: 0.0}
    joints = list(robot.findall("joint"))
    # Parents may come after their children in the file.
    while any(joint.find("child").get("link") not in reach for joint in joints):
        for joint in joints:
            parent, child = joint.find("parent").get("link"), joint.find("child").get("link")
            if parent in reach:
                travel = joint.find("limit").get("upper", "0") if joint.get("type") == "prismatic" else "0"
                reach[child] = reach[parent] + math.hypot(*numbers(joint.find("origin"), "xyz")) + abs(float(travel))
    for link in robot.findall("link"):
        name = link.get("name")
        for visual in link.findall("visual"):
            shape = outline(visual)
            if shape:
                bodies.append({"frame": links.index(name), **shape})
    ends = [reach[links[body["frame"]]] + math.hypot(*point) + body["radius"] for body in bodies for point in body["points"]]
    return {"bodies": bodies, "view": VIEW, "reach": max(ends, default=1.0)}


def outline(visual):
    """The ends of a line and its radius for a cylinder or a box, one point for a sphere, in m.

    Other shapes are not drawn and give None.
    """
    place, turn = numbers(visual.find("origin"), "xyz"), rotation(numbers(visual.find("origin"), "rpy"))
    shape = visual.find("geometry")[0]
    if shape.tag == "sphere":
        return {"points": [place], "radius": float(shape.get("radius"))}
    if shape.tag == "cylinder":
        half, radius = [0.0, 0.0, float(shape.get("length")) / 2], float(shape.get("radius"))
    elif shape.tag == "box":
        sides = numbers(shape, "size")
        long = max(range(3), key=lambda k: sides[k])
        half = [sides[k] / 2 if k == long else 0.0 for k in range(3)]
        radius = sorted(sides)[1] / 2
    else:
        return None
    arm = [sum(turn[i][k] * half[k] for k in range(3)) for i in range(3)]
    return {"points": [[p + sign * a for p, a in zip(place, arm)] for sign in (-1, 1)], "radius": radius}


def numbers(tag, name):
    """Three numbers of an attribute; zeros where it is missing."""
    return [float(x) for x in (tag.get(name, "0 0 0") if tag is not None else "0 0 0").split()]


def rotation(angles):
    """The rotation of roll, pitch and yaw, row by row."""
    (a, b, c), (d, e, f) = map(math.cos, angles), map(math.sin, angles)
    return [[c * b, c * e * d - f * a, c * e * a + f * d], [f * b, f * e * d + c * a, f * e * a - c * d], [-e, b * d, b * a]]
