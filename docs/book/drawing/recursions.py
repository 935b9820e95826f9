"""Figures of the recursions: two sweeps, one body, a composite and an articulated body, a hinge, a pattern."""

from math import atan2, cos, hypot, pi, radians, sin

from .page import (
    ACCELERATION, AXIS, BODY, BODY_EDGE, BOLD, GREY, INK, LINE, MOTION, NORMAL, PALE, Page, SMALL, THIN, TINTS,
    TITLE, WRENCH, between, towards,
)

# A small robot in the plane. For each body: its parent, its joint in axes of the parent, its angle against the
# parent in degrees, and its rods in its own axes. Lengths in units of the trunk, x to the right, y up.
ROBOT = {
    1: (0, (0.0, 0.0), -4, [[(0, 0), (0, 1)], [(-0.45, 1), (0.45, 1)]]),
    2: (1, (-0.45, 1.0), 44, [[(0, 0), (0, 0.72)]]),
    3: (2, (0.0, 0.72), -62, [[(0, 0), (0, 0.62)]]),
    4: (1, (0.45, 1.0), -78, [[(0, 0), (0, 0.72)]]),
    5: (4, (0.0, 0.72), 98, [[(0, 0), (0, 0.62)]]),
}


class Robot:
    """The robot on a page: the pose of each body, where `turned` adds angles in degrees to joints."""

    def __init__(self, at, size, turned=()):
        self.at, self.size, self.poses = at, size, {0: (0.0, 0.0, 0.0)}
        more = dict(turned)
        for body, (parent, joint, degrees, _) in ROBOT.items():
            x, y = self.inside(parent, joint)
            self.poses[body] = (x, y, self.poses[parent][2] + radians(degrees + more.get(body, 0)))

    def inside(self, body, point):
        x, y, turn = self.poses[body]
        return (x + cos(turn) * point[0] - sin(turn) * point[1], y + sin(turn) * point[0] + cos(turn) * point[1])

    def on_page(self, body, point=(0, 0)):
        x, y = self.inside(body, point)
        return (self.at[0] + self.size * x, self.at[1] - self.size * y)

    def rods(self, body):
        return [[self.on_page(body, p) for p in rod] for rod in ROBOT[body][3]]

    def tip(self, body):
        return self.rods(body)[0][1]

    def draw(self, page, fills=None, radius=10):
        x, y = self.at
        page.ground((x - 46, y + 14), (x + 46, y + 14))
        page.polygon([(x - 16, y + 14), (x - 9, y), (x + 9, y), (x + 16, y + 14)], BODY, BODY_EDGE)
        for body in sorted(ROBOT, reverse=True):
            page.rods(self.rods(body), radius, (fills or {}).get(body, BODY))
        for body in ROBOT:
            page.joint(self.on_page(body))


def flows(robot):
    """The ways of the sweeps inside the bodies, from the joint of each body to the joints of its children, or its tip."""
    ways = {}
    for body, (_, _, _, rods) in ROBOT.items():
        foot, top = robot.rods(body)[0]
        children = [robot.on_page(c) for c, row in ROBOT.items() if row[0] == body]
        ways[body] = [rounded(foot, top, end) for end in children] or [[foot, towards(top, foot, 4)]]
    return ways


def rounded(a, corner, b, cut=26):
    """A way from a to b with a round corner, straight where b is the corner."""
    if hypot(b[0] - corner[0], b[1] - corner[1]) < cut:
        return [a, b]
    p, q = towards(corner, a, cut), towards(corner, b, cut)
    arc = [between(between(p, corner, k / 8), between(corner, q, k / 8), k / 8) for k in range(9)]
    return [a, *arc, b]


def trimmed(way, gap=9):
    return [towards(way[0], way[1], gap), *way[1:-1], towards(way[-1], way[-2], gap)]


def sweeps():
    """RNEA's two sweeps on a robot with two arms."""
    page = Page(740, 430, "Two sweeps over a tree: twists and accelerations outward, wrenches inward")
    twists = {1: (16, 26, "start"), 2: (-18, 14, "end"), 3: (18, 4, "start"), 4: (6, 34, "middle"), 5: (-18, 4, "end")}
    wrenches = {1: (26, 0, "start"), 2: (-16, 22, "end"), 3: (22, 5, "start"), 4: (0, -22, "middle"), 5: (0, 34, "middle")}
    for panel, colour in enumerate((MOTION, WRENCH)):
        x = 160 + 365 * panel
        robot = Robot((x, 322), 122)
        robot.draw(page, radius=11)
        title = "2. inward: wrenches, torques" if panel else "1. outward: twists, accelerations"
        page.text((x + 22, 34), title, "middle", TITLE, colour, bold=True)
        for ways in flows(robot).values():
            for way in ways:
                page.arrow(trimmed(way[::-1] if panel else way), colour, BOLD)
        for body, (dx, dy, anchor) in (wrenches if panel else twists).items():
            px, py = robot.on_page(body) if panel else between(*robot.rods(body)[0], 0.5)
            page.symbol((px + dx, py + dy), f"F_{body}, τ_{body}" if panel else f"V_{body}, V̇_{body}", anchor, colour=colour)
        formula = "F_λ ← F_λ + Ad(T_{iλ})^T F_i        τ_i = S_i^T F_i" if panel else "V_i = Ad(T_{iλ}) V_λ + S_i q̇_i"
        page.symbol((x + 22, 402), formula, "middle", 16)
    page.arrow([(222, 350), (222, 300)], ACCELERATION, BOLD)
    page.symbol((234, 322), "V̇_0 = (0; −g)", "start", 15, ACCELERATION)
    page.symbol((234, 346), "V_0 = 0", "start", 15, MOTION)
    page.line([(370, 20), (370, 410)], PALE, THIN)
    return page


def rnea_body():
    """One body of RNEA: what comes from the parent, what goes to the children, and what the world does."""
    page = Page(740, 400, "One body of the recursion: motion from the parent, wrenches of joint, children and world")
    foot, elbow, joint, first, second, mass = (80, 278), (120, 156), (258, 188), (505, 98), (470, 248), (400, 170)
    page.ground((34, 292), (134, 292))
    page.polygon([(foot[0] - 16, 292), (foot[0] - 9, 278), (foot[0] + 9, 278), (foot[0] + 16, 292)], BODY, BODY_EDGE)
    # Parent and children are pale: the figure is about the body between them.
    pale, children = "#f6f8fa", ((first, (602, 32)), (second, (592, 274)))
    page.rods([[foot, elbow, joint]], 11, pale, PALE)
    page.joint(foot, colour=GREY)
    for a, b in children:
        page.rods([[a, b]], 11, pale, PALE)
    upper = [(242, 206), (252, 170), (320, 132), (420, 110), (500, 80), (523, 100)]
    lower = [(470, 160), (489, 244), (466, 267), (400, 232), (310, 224)]
    page.blob(upper + lower)
    for p in (joint, first, second):
        page.joint(p)
    page.disc(mass, 7, "#ffffff", INK)
    for k in (0, 2):
        arc = [(mass[0] + 7 * cos(pi / 2 * (k + j / 6)), mass[1] - 7 * sin(pi / 2 * (k + j / 6))) for j in range(7)]
        page.polygon([mass, *arc], INK)
    page.symbol((mass[0] + 13, mass[1] + 6), "G_i", "start", rim=False)
    page.text((360, 210), "body i", "middle", rim=False, colour=GREY)
    page.text((82, 216), "parent λ", "end", colour=GREY)
    page.text((620, 40), "child k", "start", colour=GREY)
    page.text((610, 280), "child k", "start", colour=GREY)
    # Motion comes from the parent, and the joint adds to it.
    page.arrow(trimmed([elbow, joint], 12), MOTION, BOLD)
    page.symbol((168, 142), "V_λ, V̇_λ", "middle", colour=MOTION)
    page.turn(joint, 18, radians(-70), radians(140), AXIS, 1.8)
    page.symbol((250, 153), "S_i q̇_i", "middle", colour=AXIS)
    page.arrow([(284, 182), (348, 169)], MOTION, BOLD)
    page.symbol((318, 162), "V_i, V̇_i", "middle", colour=MOTION, rim=False)
    # Wrenches.
    page.arrow([(188, 250), towards(joint, (188, 250), 10)], WRENCH, 3.2)
    page.symbol((180, 266), "F_i", "end", 18, WRENCH)
    for a, b in children:
        page.arrow([towards(a, b, 10), towards(a, b, 92)], WRENCH, BOLD)
    page.symbol((574, 88), "F_k", "start", colour=WRENCH)
    page.symbol((540, 302), "F_k", "middle", colour=WRENCH)
    page.arrow([(352, 40), (372, 118)], WRENCH, BOLD)
    page.symbol((350, 32), "w_i of the world", "middle", colour=WRENCH)
    # Gravity.
    page.arrow([(52, 348), (52, 306)], ACCELERATION, BOLD)
    page.symbol((64, 334), "V̇_0 = (0; −g): the ground accelerates upward", "start", 15, ACCELERATION)
    page.symbol((370, 380), 'F_i + w_i − "Σ" Ad(T_{ki})^T F_k = G_i V̇_i − ad(V_i)^T G_i V_i', "middle", 17)
    return page


def composite():
    """The composite body of joint 2 of the robot, and the entries of the mass matrix on its path to the root."""
    page = Page(760, 410, "Joint 2 alone accelerates: what lies beyond is one rigid body, and its wrench passes to the root")
    at, size = (185, 352), 142
    moved, robot = Robot(at, size, {2: -13}), Robot(at, size)
    page.rods([rod for body in (2, 3) for rod in moved.rods(body)], 11, "#fafcfd", PALE)
    tint, other = TINTS[MOTION], "#f6f8fa"
    robot.draw(page, {2: tint, 3: tint, 4: other, 5: other}, radius=11)
    for body in (1, 3, 4, 5):
        page.disc(robot.on_page(body), 6.5, INK, None)
    page.arrow(trimmed(flows(robot)[1][0][::-1], 10), WRENCH, 3)
    x, y = robot.on_page(2)
    page.joint((x, y), 6.5, colour=ACCELERATION)
    page.turn((x, y), 24, radians(140), radians(20), ACCELERATION)
    page.symbol((x + 27, y - 18), "q̈_2 = 1", "start", colour=ACCELERATION)
    page.symbol((x - 6, y + 32), "F", "middle", 18, WRENCH)
    rows = [
        (66, tint, BODY_EDGE, "I_2 = G_2 + Ad(T_{32})^T G_3 Ad(T_{32})", "bodies 2 and 3 move as one body"),
        (122, WRENCH, None, "F = I_2 S_2", "the wrench that joint 2 has to give"),
        (178, None, None, "M_{22} = S_2^T F", "what motor 2 gives of it"),
        (234, None, None, "M_{12} = S_1^T Ad(T_{21})^T F", "what motor 1 holds, on the way to the root"),
        (290, other, BODY_EDGE, "M_{42} = M_{52} = 0", "the wrench passes no joint of the other arm"),
    ]
    for y, fill, edge, formula, words in rows:
        if fill and edge:
            page.capsule((442, y - 5), (458, y - 5), 7, fill, edge)
        elif fill:
            page.arrow([(434, y - 5), (466, y - 5)], fill, 3)
        page.symbol((480, y), formula, "start", 15)
        page.text((480, y + 19), words, size=SMALL, colour=GREY)
    page.disc((450, 346), 6.5, INK, None)
    page.text((480, 350), "a joint whose rate is held at zero", size=SMALL, colour=GREY)
    for body, (dx, dy) in {1: (30, -44), 2: (-48, -22), 3: (-4, -48), 4: (46, 24), 5: (16, -44)}.items():
        x, y = robot.on_page(body)
        page.text((x + dx, y + dy), str(body), "middle", NORMAL, GREY, bold=True)
    return page


def solve(matrix, right):
    """The solution of a small linear system, by elimination with the largest pivot."""
    rows = [[*row, b] for row, b in zip(matrix, right)]
    n = len(rows)
    for k in range(n):
        best = max(range(k, n), key=lambda i: abs(rows[i][k]))
        rows[k], rows[best] = rows[best], rows[k]
        for i in range(n):
            if i != k:
                factor = rows[i][k] / rows[k][k]
                rows[i] = [a - factor * b for a, b in zip(rows[i], rows[k])]
    return [row[n] / row[k] for k, row in enumerate(rows)]


class Hanging:
    """A cart of 1 kg on a rail that carries two rods of 1 kg and 1 m; angles from straight down, SI units.

    Lagrange's equations M(q) q̈ + h(q, q̇) = (F, 0, 0) of q = (x, a, b), with g = 9.81 m/s².
    """

    MASSES, G = (1.0, 1.0, 1.0), 9.81

    def __init__(self, a, b, rate_a, rate_b):
        m0, m1, m2 = self.MASSES
        # For each angle: coefficient of its cosine in the row of x, and its own inertia.
        share = ((m1 / 2 + m2) * cos(a), m2 / 2 * cos(b))
        own, common = ((m1 / 3 + m2), m2 / 3), m2 / 2
        self.matrix = [
            [m0 + m1 + m2, *share],
            [share[0], own[0], common * cos(a - b)],
            [share[1], common * cos(a - b), own[1]],
        ]
        self.bias = [
            -(m1 / 2 + m2) * sin(a) * rate_a**2 - m2 / 2 * sin(b) * rate_b**2,
            common * sin(a - b) * rate_b**2 + self.G * (m1 / 2 + m2) * sin(a),
            -common * sin(a - b) * rate_a**2 + self.G * m2 / 2 * sin(b),
        ]

    def force(self, acceleration):
        """What moves the cart at an acceleration while both joints are free, in N."""
        below = [[self.matrix[i][j] for j in (1, 2)] for i in (1, 2)]
        angles = solve(below, [-self.bias[i] - self.matrix[i][0] * acceleration for i in (1, 2)])
        return self.matrix[0][0] * acceleration + self.bias[0] + sum(self.matrix[0][k + 1] * angles[k] for k in (0, 1))


def articulated():
    """A hand on a body whose joints beyond are free, and the force that it feels."""
    page = Page(760, 400, "Hold a body whose joints beyond are free: the force is linear in the acceleration")
    a, b = radians(38), radians(-25)
    scene, size, pivot = Hanging(a, b, 0.0, 0.0), 100, (215, 118)
    chain = [pivot]
    for turn in (a, b):
        x, y = chain[-1]
        chain.append((x + size * sin(turn), y + size * cos(turn)))
    # A hand: an arm, a palm and two fingers about the body.
    x, y = pivot
    fingers = [[(140, y + 37 * side), (200, y + 37 * side)] for side in (-1, 1)]
    page.rods([[(38, y), (140, y)], [(140, y - 37), (140, y + 37)], *fingers], 8, "#fbf3ec", GREY)
    page.text((40, y - 22), "hand", colour=GREY)
    page.polygon([(x - 64, y - 28), (x + 34, y - 28), (x + 34, y + 28), (x - 64, y + 28)], BODY, BODY_EDGE)
    page.text((x - 36, y + 4), "body i", "middle", rim=False, colour=GREY)
    for turn, p, q in zip((a, b), chain, chain[1:]):
        swing = [(p[0] + 0.62 * size * sin(turn + t), p[1] + 0.62 * size * cos(turn + t)) for t in (k * 0.05 for k in range(-9, 10))]
        page.arrow(swing, PALE, LINE, 8, both=True)
        page.capsule(p, q, 9)
    for p in chain[:-1]:
        page.joint(p)
    page.text((chain[1][0] - 16, chain[1][1] + 5), "free to turn", "end", SMALL, GREY)
    page.arrow([(x + 46, y - 14), (x + 116, y - 14)], WRENCH, 3)
    page.symbol((x + 124, y - 9), "F_i", "start", 18, WRENCH)
    page.arrow([(x + 46, y + 14), (x + 96, y + 14)], ACCELERATION)
    page.symbol((x + 104, y + 19), "V̇_i", "start", colour=ACCELERATION)
    page.symbol((220, 372), "F_i = I_i V̇_i + p_i", "middle", 19)
    # Force against acceleration.
    left, top, wide, high, most, force = 440, 66, 270, 270, 6.0, 20.0

    def at(x, y):
        return (left + wide * (x + most) / (2 * most), top + high * (force - y) / (2 * force))

    page.arrow([at(-most, 0), at(most * 1.06, 0)], GREY, THIN, 7)
    page.arrow([at(0, -force), at(0, force * 1.06)], GREY, THIN, 7)
    for k in (-4, 4):
        page.line([at(k, -0.5), at(k, 0.5)], GREY, THIN)
        page.text((at(k, 0)[0], at(k, 0)[1] + 16), f"{k}".replace("-", "−"), "middle", SMALL, GREY)
    for k in (-10, 10):
        page.line([at(-0.12, k), at(0.12, k)], GREY, THIN)
        page.text((at(0, k)[0] - 7, at(0, k)[1] + 4), f"{k}".replace("-", "−"), "end", SMALL, GREY)
    bias, slope, all_one = scene.force(0), scene.force(1) - scene.force(0), scene.matrix[0][0]
    assert abs(scene.force(-3) - (bias - 3 * slope)) < 1e-12, "it is linear"
    page.line([at(-most, -most * all_one), at(most, most * all_one)], GREY, BOLD, "6 4")
    page.line([at(-most, bias - most * slope), at(most, bias + most * slope)], WRENCH, 3)
    page.disc(at(0, bias), 4.5, WRENCH, None)
    x, y = at(0.4, bias - 1.9)
    page.symbol((x, y), f'p_i = {bias:.2f} "N"'.replace("-", "−"), "start", 15, WRENCH)
    x, y = at(most, bias - 6.5)
    page.text((x, y), "joints free:", "end", SMALL, WRENCH)
    page.symbol((x, y + 20), f"I_i = {slope:.2f} kg", "end", 15, WRENCH)
    x, y = at(3.8, 16.2)
    page.text((x, y), "joints held:", "end", SMALL, GREY)
    page.text((x, y + 16), f"{all_one:.2f} kg", "end", SMALL, GREY)
    page.text((left + wide + 12, at(0, 0)[1] - 8), "m/s²", "end", SMALL, GREY)
    page.text((at(0, force)[0] - 8, top - 4), "N", "end", SMALL, GREY)
    page.text((left + wide / 2, 378), "force along the arrow against its acceleration", "middle", SMALL, GREY)
    return page


def hinge():
    """A door that is pushed at its hinge: about the hinge, along the door, and across it."""
    page = Page(760, 410, "A hinge hides inertia: a door that is moved at its hinge in three ways")
    # A uniform door of 1 kg and 1 m in the plane, about its hinge: (turn; along; across).
    inertia = [[1 / 3, 0, 1 / 2], [0, 1, 0], [1 / 2, 0, 1]]
    screw = [1, 0, 0]
    u = [sum(row[k] * screw[k] for k in range(3)) for row in inertia]
    d = sum(a * b for a, b in zip(screw, u))
    left = [[inertia[i][j] - u[i] * u[j] / d for j in range(3)] for i in range(3)]
    long, thick, middle = 150, 7, 120
    # The point of the door that stays when the hinge is moved across: there the acceleration a + α r is zero.
    still = inertia[0][0] / inertia[0][2]
    assert abs(still - 2 / 3) < 1e-12
    cases = [
        ("turn the frame", (0, 0), radians(28), 0.0, "felt: no moment"),
        ("move the frame along", (34, 0), 0.0, 0.0, f"felt: {left[1][1]:g} kg"),
        ("move the frame across", (0, -34), 0.0, -atan2(34, still * long), f"felt: {left[2][2]:g} kg"),
    ]
    for k, (title, shift, frame_turn, door_turn, felt) in enumerate(cases):
        x = 74 + 248 * k
        page.text((x + 58, 36), title, "middle", 13, INK, bold=True)
        hinge_to = (x + shift[0], middle + shift[1])
        door(page, hinge_to, frame_turn, door_turn, long, thick, "#fafcfd", "#fdfaf7", PALE)
        door(page, (x, middle), 0.0, 0.0, long, thick, BODY, "#fbf3ec", BODY_EDGE)
        if k == 0:
            page.turn((x, middle), 44, radians(170), radians(170 + 42), ACCELERATION)
        elif k == 1:
            page.arrow([(x - 24, middle + 42), (x + 34, middle + 42)], ACCELERATION)
        else:
            page.arrow([(x - 40, middle + 22), (x - 40, middle - 36)], ACCELERATION)
            page.disc((x + still * long, middle), 4, INK, None)
            page.text((x + still * long, middle + 30), "stays here", "middle", SMALL, GREY)
        page.text((x + 58, middle + 88), felt, "middle", TITLE, WRENCH, bold=True)
    fractions = {0: "0", 1 / 3: "1/3", 1 / 2: "1/2", 1: "1", 1 / 4: "1/4"}

    def entries(matrix):
        return [[next(name for value, name in fractions.items() if abs(x - value) < 1e-12) for x in row] for row in matrix]

    top = 268
    page.symbol((60, top + 52), "I =", "end", 17)
    page.matrix((72, top), entries(inertia), (46, 30))
    page.arrow([(232, top + 46), (300, top + 46)], GREY, LINE)
    page.text((266, top + 34), "hinge", "middle", SMALL, GREY)
    page.symbol((470, top + 52), "I − U D^{−1} U^T =", "end", 17)
    page.matrix((482, top), entries(left), (46, 30), colours={(1, 1): WRENCH, (2, 2): WRENCH})
    for row, name in enumerate(("turn about the hinge", "along", "across")):
        page.text((632, top + 20 + 30 * row), name, size=SMALL, colour=GREY)
    page.text((380, 392), "a uniform door of 1 kg and 1 m, seen from above; all about its hinge", "middle", SMALL, GREY)
    return page


def door(page, hinge, frame_turn, door_turn, long, thick, fill, frame, edge):
    """A door from above, its hinge, and the piece of the frame that holds it, each turned."""
    def placed(x, y):
        return (hinge[0] + x * cos(frame_turn) - y * sin(frame_turn), hinge[1] - x * sin(frame_turn) - y * cos(frame_turn))

    page.rods([[placed(-16, -22), placed(-16, 22)], [placed(-16, 0), placed(0, 0)]], 5, frame, edge)
    page.capsule(hinge, (hinge[0] + long * cos(door_turn), hinge[1] - long * sin(door_turn)), thick, fill, edge)
    page.joint(hinge, colour=INK if edge != PALE else PALE)
