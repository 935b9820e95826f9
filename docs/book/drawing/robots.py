"""Figures of the bundled robots: the quadruped's mass matrix, the golfer's club head, the pendulum."""

import re
from math import cos, radians, sin
from pathlib import Path

from .page import (
    ACCELERATION, AXIS, BODY, BODY_EDGE, BOLD, GREY, INK, LINE, MOTION, NORMAL, Page, SMALL, THIN, TINTS,
    TITLE, WRENCH, between,
)
from .space import Camera, Tree, Y, Z, ZERO, add, apply, cross, dot, norm, product, rotation, scale, sub

BOOK = Path(__file__).resolve().parent.parent / "src"
ROBOTS = Path(__file__).resolve().parents[3] / "models" / "urdf"


def sparsity():
    """Which entries of the quadruped's mass matrix are zero because their joints are in different legs."""
    page = Page(760, 400, "The quadruped's tree and the pattern of its mass matrix: legs do not meet")
    tree = Tree(ROBOTS / "quadruped.urdf")
    legs = ["front_left", "front_right", "hind_left", "hind_right"]
    paint = dict(zip(legs, (MOTION, ACCELERATION, WRENCH, AXIS)))
    names = [joint.get("name") for joint in tree.moving]
    leg = [next(l for l in legs if name.startswith(l)) for name in names]
    # Six rates of the base carry all joints; a joint carries those on whose path to the root it is.
    paths = [{*range(k + 1)} for k in range(6)]
    paths += [{*range(6), *(6 + j for j in path)} for path in tree.carriers()]
    n = len(paths)
    full = [[i in paths[j] or j in paths[i] or max(i, j) < 6 for j in range(n)] for i in range(n)]
    zeros = sum(row.count(False) for row in full)
    assert (n, zeros) == (18, 108), (n, zeros)
    # The tree from above: x of the robot is up, y to the left.
    middle, size = (165, 185), 150
    box = [(x, y) for x, y in ((0.5, 0.17), (0.5, -0.17), (-0.5, -0.17), (-0.5, 0.17))]
    page.polygon([(middle[0] - size * 1.5 * y, middle[1] - size * 0.8 * x) for x, y in box], BODY, BODY_EDGE)
    page.text(middle, "base", "middle", rim=False)
    page.text((middle[0], middle[1] + 17), "1–6", "middle", SMALL, GREY, rim=False)
    for k, name in enumerate(legs):
        front, side = (1 if "front" in name else -1), (-1 if "left" in name else 1)
        numbers = [7 + j for j, l in enumerate(leg) if l == name]
        at = (middle[0] + side * 38, middle[1] - front * 60)
        for step, rate in enumerate(numbers):
            to = (middle[0] + side * (62 + 32 * step), middle[1] - front * (88 + 20 * step))
            page.line([at, to], paint[name], BOLD)
            at = to
        for step, rate in enumerate(numbers):
            to = (middle[0] + side * (62 + 32 * step), middle[1] - front * (88 + 20 * step))
            page.disc(to, 12, TINTS[paint[name]], paint[name])
            page.text((to[0], to[1] + 4), str(rate), "middle", SMALL, INK, rim=False)
        page.text((at[0], at[1] - 22 if front > 0 else at[1] + 30), name.replace("_", " "), "middle", SMALL, paint[name])
    # The pattern.
    cell, left, top = 17, 400, 52
    for i in range(n):
        for j in range(n):
            if full[i][j]:
                deep = max(i, j)
                colour = BODY_EDGE if deep < 6 else paint[leg[deep - 6]]
                x, y = left + cell * j, top + cell * i
                square = [(x, y), (x + cell, y), (x + cell, y + cell), (x, y + cell)]
                page.polygon(square, colour, "#ffffff", THIN, opacity=None if min(i, j) >= 6 or deep < 6 else 0.45)
    side = n * cell
    page.polygon([(left, top), (left + side, top), (left + side, top + side), (left, top + side)], "none", INK, LINE)
    for k in (0, 6, 9, 12, 15):
        page.text((left + cell * (k + 0.5), top - 7), str(k + 1), "middle", SMALL, GREY)
        page.text((left - 7, top + cell * (k + 0.5) + 4), str(k + 1), "end", SMALL, GREY)
    page.text((left + side / 2, top + side + 24), f"white: {zeros} of {n * n} entries, of joints in different legs", "middle", NORMAL, INK)
    return page


def pendulum():
    """The forces on the ball of `simple_pendulum` at the state of the first solution, and its acceleration."""
    page = Page(740, 430, "The forces on the ball of the pendulum, and what they do")
    m, l, inertia, g = 1.0, 1.0, 0.001, 9.81
    q, rate, acceleration = 0.5, 2.0, 3.0
    tau = (m * l * l + inertia) * acceleration + m * g * l * sin(q)
    assert f"{tau:.2f}" == "7.71"
    # Unit vectors on the page, y down: from the ball to the pivot, and along growing q.
    inward, across = (-sin(q), -cos(q)), (cos(q), -sin(q))
    pull, push = m * (g * cos(q) + l * rate**2), (tau - inertia * acceleration) / l
    total = [pull * a + push * b + m * g * c for a, b, c in zip(inward, across, (0, 1))]
    along = [m * l * rate**2 * a + m * l * acceleration * b for a, b in zip(inward, across)]
    assert max(abs(a - b) for a, b in zip(total, along)) < 1e-12, "forces are mass times acceleration"
    size, unit, top = 190, 9.0, 92
    for panel, x in enumerate((150, 520)):
        pivot, ball = (x, top), (x - size * inward[0] * l, top - size * inward[1] * l)

        def force(direction, newtons, colour, start=(0.0, 0.0), width=BOLD, dash=None):
            foot = (ball[0] + unit * start[0], ball[1] + unit * start[1])
            tip = (foot[0] + unit * newtons * direction[0], foot[1] + unit * newtons * direction[1])
            page.arrow([foot, tip], colour, width, dash=dash)
            return tip

        page.text((x + 40, 34), ("forces on the ball", "mass times acceleration")[panel], "middle", TITLE, INK, bold=True)
        page.ground((x + 40, top - 12), (x - 40, top - 12))
        page.line([pivot, (x, top + size)], GREY, THIN, "5 4")
        page.capsule(pivot, ball, 5.5)
        page.joint(pivot)
        page.disc(ball, 14, BODY, BODY_EDGE)
        page.turn(pivot, 84, radians(-90), radians(-90) + q - 0.07, INK, LINE)
        page.symbol((x + 84 * 0.95 * sin(q / 2) - 2, top + 84 * cos(q / 2) + 22), "q")
        if panel == 0:
            page.turn(pivot, 21, radians(-165), radians(20), WRENCH, 3)
            page.symbol((x + 34, top + 12), "τ", "start", 18, WRENCH)
            # The weight and its parts along the rod and across it.
            for direction, newtons in ((inward, -m * g * cos(q)), (across, -m * g * sin(q))):
                page.arrow([ball, tuple(b + unit * newtons * c for b, c in zip(ball, direction))], WRENCH, THIN, 7, "4 3")
            tip = force((0, 1), m * g, WRENCH)
            page.symbol((tip[0] - 2, tip[1] + 18), "m g", "middle", colour=WRENCH)
            page.symbol((tip[0] + 46, tip[1] - 14), "m g cos q", "start", 13, WRENCH)
            page.symbol((tip[0] - 42, tip[1] - 58), "m g sin q", "end", 13, WRENCH)
            tip = force(inward, pull, WRENCH)
            page.symbol((tip[0] + 34, tip[1] + 30), "m g cos q + m l q̇^2", "start", 15, WRENCH)
            tip = force(across, push, WRENCH)
            page.symbol((tip[0] + 6, tip[1] + 18), "m g sin q + m l q̈", "start", 15, WRENCH)
        else:
            tip = force(inward, m * l * rate**2, ACCELERATION)
            page.symbol((tip[0] - 12, tip[1] + 10), "m l q̇^2", "end", 15, ACCELERATION)
            tip = force(across, m * l * acceleration, ACCELERATION)
            page.symbol((tip[0] + 6, tip[1] + 8), "m l q̈", "start", 15, ACCELERATION)
            page.text((x + 40, top + 232), "to the same scale, at", "middle", SMALL, GREY)
            page.text((x + 40, top + 249), "q = 0.5 rad, q̇ = 2 rad/s, q̈ = 3 rad/s²", "middle", SMALL, GREY)
    # x of the robot to the left, z up, and so y towards the reader.
    foot = (52, 330)
    page.arrow([foot, (20, 330)], INK, 1.8, 8)
    page.arrow([foot, (52, 296)], INK, 1.8, 8)
    page.out_of_page(foot, INK)
    for name, at in (("x", (18, 346)), ("z", (62, 304)), ("y", (64, 344))):
        page.symbol(at, name, size=13)
    page.symbol((370, 408), f'τ = (m l^2 + I) q̈ + m g l sin q = 1.001 · 3 + 9.81 sin 0.5 = {tau:.2f} "N·m"', "middle", 16)
    return page


GROUPS = [("pelvis", 3, GREY), ("thorax", 3, MOTION), ("shoulder", 5, ACCELERATION), ("elbow, forearm", 2, AXIS), ("wrist", 2, WRENCH)]


def chapter():
    """The state of the chapter on the golfer, and its table: name, rate, and part along the head's direction."""
    text = (BOOK / "golfer.md").read_text(encoding="utf-8")

    def found(pattern, what):
        match = re.search(pattern, text, re.MULTILINE)
        if not match:
            raise ValueError(f"golfer.md: expected {what}, found none")
        return match[1]

    q, v = ([float(x) for x in found(rf"let {name} = \[(.*?)\];", f"a line `let {name} = [...];`").split(",")] for name in "qv")
    rows = re.findall(r"^(\w+) +(-?\d+\.\d+) rad/s +(-?\d+\.\d+) m/s$", text, re.MULTILINE)
    return q, v, rows, found(r"^club head +(\d+\.\d+) m/s", "the speed of the club head in the table")


def shapes(tree, links):
    """The drawn shapes of a URDF: (ends and radius of a cylinder) or (corners of a box), in the root's axes."""
    for link in tree.links:
        turned, p = links[link.get("name")]
        for visual in link.findall("visual"):
            origin = visual.find("origin")
            centre, angles = (tuple(map(float, origin.get(key).split())) for key in ("xyz", "rpy"))
            if angles[0] or angles[2]:
                raise ValueError(f"link {link.get('name')}: expected a shape that is turned about y alone")
            body, tilt = add(p, apply(turned, centre)), product(turned, rotation(Y, angles[1]))
            kind = visual.find("geometry")[0]
            if kind.tag == "cylinder":
                half = scale(float(kind.get("length")) / 2, apply(tilt, Z))
                yield link.get("name"), [sub(body, half), add(body, half)], float(kind.get("radius"))
            else:
                sides = [float(s) / 2 for s in kind.get("size").split()]
                corners = [(i * sides[0], j * sides[1], k * sides[2]) for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)]
                yield link.get("name"), [add(body, apply(tilt, c)) for c in corners], None


def turns_back(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) <= (b[1] - a[1]) * (c[0] - a[0])


def hull(where):
    """The convex hull of points on the page."""
    where, out = sorted(where), []
    for order in (where, where[::-1]):
        part = []
        for p in order:
            while len(part) > 1 and turns_back(*part[-2:], p):
                part.pop()
            part.append(p)
        out += part[:-1]
    return out


def golfer():
    """The golfer at the state of the chapter, and what each joint adds to the velocity of the club head."""
    page = Page(740, 540, "The golfer, and the velocities that each joint adds at the club head, one after the other")
    tree = Tree(ROBOTS / "golfer.urdf")
    q, v, rows, printed = chapter()
    links, axes = tree.poses(q)
    head = links["club_head"][1]
    parts = [cross(scale(rate, axis), sub(head, p)) for (_, axis, p), rate in zip(axes, v)]
    total = add(*parts)
    speed = norm(total)
    along = [dot(part, total) / speed for part in parts]
    # What the chapter prints is what is drawn.
    drawn = [(name, f"{rate:.2f}", f"{part:.2f}") for (name, _, _), rate, part in zip(axes, v, along)]
    if [(a, float(b), float(c)) for a, b, c in drawn] != [(a, float(b), float(c)) for a, b, c in rows] or f"{speed:.2f}" != printed:
        raise ValueError(f"golfer.md: expected the rows {drawn} and {speed:.2f} m/s, found {rows} and {printed}")
    camera, pixels = Camera(-15, 18, 190, (140, 362)), 13.4
    for k in range(-2, 8):
        page.line([camera((-0.25, k * 0.25, 0)), camera((1.25, k * 0.25, 0))], "#e3e8ec", THIN)
    for k in range(-1, 6):
        page.line([camera((k * 0.25, -0.5, 0)), camera((k * 0.25, 1.75, 0))], "#e3e8ec", THIN)
    bodies = sorted(shapes(tree, links), key=lambda shape: camera.depth(scale(1 / len(shape[1]), add(*shape[1]))))
    for name, where, radius in bodies:
        fill = TINTS[MOTION] if name.startswith("lead") or name.startswith("club") else BODY
        if radius is None:
            page.polygon(hull([camera(p) for p in where]), BODY_EDGE, INK, THIN)
        else:
            page.capsule(camera(where[0]), camera(where[1]), max(camera.size * radius, 1.2), fill, BODY_EDGE, THIN)
    start = camera(head)

    def shifted(a):
        x, y = camera(scale(pixels / camera.size, a))
        return (start[0] + x - camera.at[0], start[1] + y - camera.at[1])

    page.arrow([start, shifted(total)], INK, 3.4)
    x, y = shifted(total)
    page.symbol((x + 8, y + 6), f'{speed:.2f} "m/s"', "start", 17)
    named = {
        "pelvis_rotation": (12, -11, "middle"), "thorax_rotation": (0, -8, "middle"), "lead_shoulder_abduction": (-4, -24, "start"),
        "lead_pronation": (28, -2, "start"), "lead_wrist_deviation": (14, 10, "start"), "lead_wrist_flexion": (12, -4, "start"),
    }
    at, k, row = ZERO, 0, 86
    page.text((330, 44), "what the joints add along the direction of the head", bold=True)
    page.text((330, 61), "their parts across it add up to zero", size=SMALL, colour=GREY)
    for name, count, colour in GROUPS:
        for (joint, _, _), part in zip(axes[k : k + count], parts[k : k + count]):
            to = add(at, part)
            if joint in named:
                dx, dy, anchor = named[joint]
                x, y = between(shifted(at), shifted(to), 0.5)
                page.text((x + dx, y + dy), joint.removeprefix("lead_").replace("_", " "), anchor, SMALL, colour)
            if norm(part) > 1.5:
                page.arrow([shifted(at), shifted(to)], colour, 2.2, 8)
            else:
                page.line([shifted(at), shifted(to)], colour, 2.2)
            at = to
        share = sum(along[k : k + count])
        page.text((450, row + 11), f"{name} ({count})", "end")
        page.polygon([(460, row), (460 + 17 * share, row), (460 + 17 * share, row + 14), (460, row + 14)], colour)
        page.text((468 + 17 * share, row + 11), f"{share:.1f} m/s")
        k, row = k + count, row + 24
    assert norm(sub(at, total)) < 1e-9 and f"{sum(along):.2f}" == printed
    page.text((450, row + 13), "number of joints in brackets; sum:", "end", SMALL, GREY)
    page.text((460, row + 13), f"{speed:.2f} m/s", bold=True)
    return page
