"""Figures of motion: frames, a screw, a twist at two frames, a step of a quaternion, a wrist."""

from math import cos, pi, radians, sin

from .page import (
    ACCELERATION, AXIS, BODY, BODY_EDGE, BOLD, GREY, INK, LINE, MOTION, NORMAL, PALE, Page, SMALL, THIN, TINTS,
    WRENCH, between, bow, towards,
)
from .space import Camera, X, Y, Z, ZERO, add, apply, cross, dot, norm, rotation, scale, sub, triad, unit


def frames():
    """T_ab, T_bc and T_ac of three frames."""
    page = Page(640, 320, "Frames a, b and c, and the poses T_ab, T_bc and T_ac between them")
    camera = Camera(-75, 22, 116, (85, 215))
    a = ([X, Y, Z], ZERO)
    # b and c are turned about the line of sight, so that their axes are seen apart from the arrows.
    b = (rotation(camera.back, radians(52)), (1.85, 0.6, 0.45))
    c = (rotation(camera.back, radians(-32)), (3.9, 0.9, 0.1))
    for turned, p in (a, b, c):
        triad(page, camera, p, turned, 0.55, INK)
    at = [camera(p) for _, p in (a, b, c)]
    ways = [(0, 1, 18, "T_{ab}", MOTION), (1, 2, 30, "T_{bc}", MOTION), (0, 2, -62, "T_{ac}", AXIS)]
    for i, j, height, name, colour in ways:
        curve = bow(at[i], at[j], height, 14)
        page.arrow(curve, colour)
        x, y = curve[len(curve) // 2]
        page.symbol((x, y + (22 if height < 0 else -10)), name, colour=colour)
    for name, (x, y) in zip("abc", at):
        page.text((x - 4, y + 21), f"{{{name}}}", "middle", NORMAL, INK, bold=True)
    inner = [("T_a", None), ("_b", WRENCH), (" T", None), ("_b", WRENCH), ("_c", None)]
    page.symbol((475, 60), [*inner, (" = T_{ac}", None)], size=22)
    page.text((475, 84), "inner letters cancel", "middle", SMALL, WRENCH)
    return page


def screw():
    """A helical joint at unit rate: the point of the body that is at the origin moves along a helix."""
    page = Page(700, 430, "A screw: its axis, its pitch, and the velocity of the body's point at the origin")
    camera = Camera(-90, 27, 100, (225, 350))
    s, p, h = Z, (0.7, 1.1, 0.0), 0.31
    at = camera

    def helix(angle):
        """Where the body's point that was at the origin is after a turn about the axis through p."""
        return add(p, apply(rotation(s, angle), scale(-1, p)), scale(h * angle, s))

    page.line([at(add(p, scale(-0.75, s))), at(add(p, scale(2.75, s)))], AXIS, BOLD, "9 3 2 3")
    page.arrow([at(add(p, scale(2.5, s))), at(add(p, scale(2.95, s)))], AXIS)
    x, y = at(add(p, scale(2.9, s)))
    page.symbol((x + 14, y + 8), "ŝ", colour=AXIS)
    # The helix, dashed where it is behind the axis.
    count = 180
    path = [helix(k / count * 2.25 * pi) for k in range(count + 1)]
    behind = [camera.depth(q) < camera.depth(add(p, scale(dot(q, s), s))) for q in path]
    k = 0
    while k < count:
        end = k
        while end < count and behind[end] == behind[k]:
            end += 1
        page.line([at(q) for q in path[k : end + 1]], GREY, LINE, "3 4" if behind[k] else None)
        k = end
    # One turn: how far the point has moved along the axis.
    low, high = helix(0), helix(2 * pi)
    for q in (low, high):
        page.line([at(add(q, (-0.1, 0, 0))), at(add(q, (-1.0, 0, 0)))], GREY, THIN)
    page.arrow([at(add(low, (-0.9, 0, 0))), at(add(high, (-0.9, 0, 0)))], INK, LINE, 8, both=True)
    x, y = at(add(low, scale(pi * h, s), (-0.9, 0, 0)))
    page.text((x - 12, y - 4), "one turn:", "end")
    page.symbol((x - 12, y + 15), "2 π h", "end")
    # The parts of the velocity at the origin, and the vector to the axis.
    turning, sliding = cross(p, s), scale(h, s)
    assert norm(sub(cross(s, scale(-1, p)), turning)) < 1e-12, "s x (0 - p) = -s x p"
    first = (helix(1e-6)[0] / 1e-6, helix(1e-6)[1] / 1e-6, helix(1e-6)[2] / 1e-6)
    assert norm(sub(first, add(turning, sliding))) < 1e-5, "the linear part is the tangent of the helix"
    page.arrow([at(ZERO), at(p)], INK, LINE)
    x, y = between(at(ZERO), at(p), 0.6)
    page.symbol((x - 5, y - 8), "p")
    for a, b in ((turning, add(turning, sliding)), (sliding, add(turning, sliding))):
        page.line([at(a), at(b)], PALE, LINE, "3 3")
    page.arrow([at(ZERO), at(turning)], MOTION, 1.8)
    page.arrow([at(ZERO), at(sliding)], MOTION, 1.8)
    page.arrow([at(ZERO), at(add(turning, sliding))], MOTION, 3)
    x, y = at(turning)
    page.symbol((x + 2, y + 22), "−ŝ × p", colour=MOTION)
    x, y = at(sliding)
    page.symbol((x - 9, y - 5), "h ŝ", "end", colour=MOTION)
    x, y = at(add(turning, sliding))
    page.symbol((x + 9, y - 4), "v", "start", 18, MOTION)
    page.disc(at(ZERO), 4, INK, None)
    page.disc(at(p), 4, AXIS, None)
    page.disc(at(high), 4, GREY, None)
    x, y = at(ZERO)
    page.text((x - 10, y + 18), "origin of the frame", "end")
    page.symbol((480, 200), "S = (ŝ;  −ŝ × p + h ŝ)", "start", 19)
    page.text((480, 226), "p: any point of the axis", colour=GREY)
    page.text((480, 244), "h: advance for each radian", colour=GREY)
    page.text((480, 262), "rate of the joint: 1", colour=GREY)
    return page


def twist():
    """A body that turns about a point C: one angular velocity, and two velocities at two origins."""
    page = Page(700, 400, "One motion, two frames: the linear part of the twist is that of the body's point at the origin")
    centre, rate = (120, 322), 0.46
    outline = [(215, 245), (265, 165), (345, 130), (410, 165), (405, 230), (340, 262), (280, 300), (225, 305)]

    def turned(p, angle):
        x, y = p[0] - centre[0], p[1] - centre[1]
        return (centre[0] + x * cos(angle) + y * sin(angle), centre[1] - x * sin(angle) + y * cos(angle))

    page.blob([turned(p, radians(13)) for p in outline], "#ffffff", PALE, LINE, "4 4")
    page.blob(outline)
    a, b = (262, 250), (480, 205)
    page.line([(416, 207), b], BODY_EDGE, 5)
    page.line([(416, 207), b], BODY, 3)
    for name, p, tilt, label in (("a", a, -12, (-2, 20)), ("b", b, -35, (-14, 22))):
        page.line([centre, p], GREY, THIN, "5 4")
        # ω × r: a quarter turn of the arm, times the rate.
        arm = (p[0] - centre[0], p[1] - centre[1])
        end = (p[0] + rate * arm[1], p[1] - rate * arm[0])
        assert abs((end[0] - p[0]) * arm[0] + (end[1] - p[1]) * arm[1]) < 1e-9
        page.right_angle(p, centre, end, 10)
        page.arrow([p, end], MOTION, 3)
        page.symbol((end[0] - 14, end[1] + 2), f"v_{name}", "end", colour=MOTION)
        for k in (0, 1):
            t = radians(tilt + 90 * k)
            page.arrow([p, (p[0] + 34 * cos(t), p[1] - 34 * sin(t))], INK, 1.8, 8)
        page.disc(p, 3, INK, None)
        page.text((p[0] + label[0], p[1] + label[1]), f"{{{name}}}", "middle", bold=True)
    page.turn(centre, 30, radians(-20), radians(110), AXIS)
    page.disc(centre, 4, AXIS, None)
    page.symbol((centre[0] - 18, centre[1] - 28), "ω", "end", 18, AXIS)
    page.text((centre[0], centre[1] + 42), "the body turns", "middle", colour=GREY)
    page.text((centre[0], centre[1] + 57), "about this point", "middle", colour=GREY)
    page.symbol((540, 150), "V_a = (ω; v_a)", "start", 18)
    page.symbol((540, 182), "V_b = (ω; v_b)", "start", 18)
    page.symbol((540, 226), "V_a = Ad(T_{ab}) V_b", "start", 18)
    return page


def quaternion():
    """Steps at a constant rate on the unit sphere: Euler's steps leave it, ⊕ goes along it."""
    page = Page(700, 410, "Steps of a quaternion: Euler's leave the unit sphere, those of ⊕ stay on it")
    at, step, count = Camera(-90, 18, 140, (215, 245)), 0.5, 4
    page.disc(at(ZERO), at.size, "#f4f7fa", BODY_EDGE, LINE)
    grid = [[(cos(t) * cos(e), sin(t) * cos(e), sin(e)) for t in turns()] for e in (-0.7, 0.0, 0.7)]
    grid += [[(cos(e) * cos(t), sin(e) * cos(t), sin(t)) for t in turns()] for e in (0.35, 0.35 + pi / 3, 0.35 + 2 * pi / 3)]
    for path in grid:
        for a, b in zip(path, path[1:]):
            if at.depth(a) + at.depth(b) > 0:
                page.line([at(a), at(b)], "#d5dce3", THIN)
    # The great circle along which a constant rate moves the quaternion; its middle faces the viewer and up.
    middle, begin = unit(add(scale(0.95, at.up), scale(0.32, at.back))), -1.1

    def on_sphere(angle):
        return add(scale(cos(angle), middle), scale(sin(angle), at.right))

    exact = [on_sphere(begin + k * step) for k in range(count + 1)]
    page.line([at(on_sphere(begin + k / 60 * count * step)) for k in range(61)], ACCELERATION, BOLD)
    euler, pole = exact[:1], cross(middle, at.right)
    for _ in range(count):
        # The derivative is perpendicular to the quaternion: a quarter turn of it in the plane of the circle.
        euler.append(add(euler[-1], scale(step, cross(pole, euler[-1]))))
    assert abs(norm(euler[-1]) - (1 + step**2) ** (count / 2)) < 1e-12
    for k, (a, b) in enumerate(zip(euler, euler[1:])):
        page.arrow([at(a), at(b)], WRENCH, BOLD)
        x, y = at(b)
        page.text((x, y - 9) if k else (x - 42, y - 18), f"{norm(b):.2f}", "middle", SMALL, WRENCH)
    for point in exact[1:]:
        page.disc(at(point), 4, ACCELERATION, None)
    page.disc(at(exact[0]), 5, INK, None)
    x, y = at(exact[0])
    page.symbol((x - 12, y + 6), "x", "end", 18)
    x, y = at(euler[1])
    page.symbol((x - 10, y + 2), "x + h ẋ", "end", colour=WRENCH)
    x, y = at(exact[1])
    page.symbol((x + 8, y + 19), "x ⊕ h ω", "start", colour=ACCELERATION)
    x, y = at(ZERO)
    page.text((x, y + 92), "unit quaternions", "middle", NORMAL, GREY)
    page.line([(445, 184), (475, 184)], WRENCH, BOLD)
    page.text((485, 188), "Euler: along the tangent;")
    page.text((485, 204), "the numbers are norms")
    page.line([(445, 234), (475, 234)], ACCELERATION, BOLD)
    page.text((485, 238), "⊕: along the sphere;")
    page.text((485, 254), "the norm is 1")
    page.symbol((445, 300), "|x + h ẋ|^2 = |x|^2 (1 + h^2 |ω|^2 / 4)", "start", 14)
    page.text((445, 324), f"here h|ω|/2 = {step:.2f} rad", size=SMALL, colour=GREY)
    return page


def turns(count=96):
    return [2 * pi * k / count for k in range(count + 1)]


def wrist():
    """The angular velocities of a wrist at unit rates: an ellipsoid, flat where two axes coincide."""
    page = Page(700, 370, "A wrist with three axes: its angular velocities are an ellipsoid, which flattens")
    for column, degrees in enumerate((70, 25, 0)):
        at = Camera(-72, 24, 66, (115 + 225 * column, 175))
        q = radians(degrees)
        # Axes about z, then y, then z: the third one is turned by the second joint.
        third = (sin(q), 0.0, cos(q))
        jacobian = [list(row) for row in zip(Z, Y, third)]
        volume = abs(dot(Z, cross(Y, third)))
        assert abs(volume - sin(q)) < 1e-12
        page.polygon(outline(at, jacobian), TINTS[MOTION], MOTION, BOLD)
        # The images of circles of the unit sphere of rates.
        circles = [[(cos(t) * cos(e), sin(t) * cos(e), sin(e)) for t in turns()] for e in (-0.6, 0.0, 0.6)]
        circles += [[(cos(e) * cos(t), sin(e) * cos(t), sin(t)) for t in turns()] for e in (0, pi / 3, 2 * pi / 3)]
        for path in circles:
            page.line([at(apply(jacobian, rates)) for rates in path], MOTION, 0.7, opacity=0.6)
        if not degrees:
            page.arrow([at(ZERO), at(scale(1.2, X))], WRENCH, 1.8, dash="4 3")
            x, y = at(scale(1.2, X))
            page.text((x - 38, y + 24), "no rates turn it", "start", SMALL, WRENCH)
            page.text((x - 38, y + 38), "about this axis", "start", SMALL, WRENCH)
        names = [("ŝ_1", Z, 1.9), ("ŝ_2", Y, 2.5), ("ŝ_3", third, 1.9)] if degrees else [("ŝ_1 = ŝ_3", Z, 1.9), ("ŝ_2", Y, 2.5)]
        for name, axis, far in names:
            tip = at(scale(far, axis))
            page.arrow([at(ZERO), tip], AXIS, 1.8)
            x, y = towards(tip, at(ZERO), -14)
            page.symbol((x, y + 5), name, colour=AXIS)
        page.disc(at(ZERO), 3, AXIS, None)
        page.symbol((at.at[0], 324), f"q_2 = {degrees}°", "middle", 18)
        page.text((at.at[0], 346), f"volume: {volume:.2f} of a ball's" if degrees else "flat: volume 0", "middle", SMALL, GREY)
    return page


def outline(at, matrix):
    """The outline, on the page, of the image of the unit sphere under a matrix: an ellipse."""
    rows = [apply(list(zip(*matrix)), at.right), apply(list(zip(*matrix)), at.up)]
    # Of a linear map 3 -> 2 by rows r and u: the support in direction (cos t, sin t) is |cos t r + sin t u|.
    where = []
    for t in turns(120):
        far = add(scale(cos(t), rows[0]), scale(sin(t), rows[1]))
        x = (dot(rows[0], far) / norm(far), dot(rows[1], far) / norm(far))
        where.append((at.at[0] + at.size * x[0], at.at[1] - at.size * x[1]))
    return where
