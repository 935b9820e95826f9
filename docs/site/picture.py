#!/usr/bin/env python3
"""Draws a robot at the start of its motion as one SVG file.

    python3 docs/site/picture.py ROBOT -o FILE.svg    for example tests/robots/arm.urdf -o arm.svg

`articulated simulate ROBOT -o page.html` computes the start: the keyframe `home` of an MJCF, the
initial state of the file, or else the neutral configuration. Its page contains the place of each
body, m, the shapes of all links, and the lines between the joints. A simple shape (at most FEW
triangles) is drawn by the faces that the viewer sees. Of another shape the convex hull of its
projection is drawn. A link without a shape is drawn as the box of even density that has its mass
and its inertia, unless this box is large beside the robot. The farthest shape is drawn first. Of a
robot that `simulate` refuses, the lines between the joints in the neutral configuration are drawn,
from `articulated eval`.

The projection is parallel. The viewer is in front of a robot that looks along x, and to its right.
The picture has no background. Its lines can be read on a light and on a dark page. The command is
that of ARTICULATED_COMMAND, or `articulated` on the path. NumPy comes from target/site-python, as
for build.py.
"""

import argparse
import base64
import json
import math
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    import numpy as np
except ImportError:
    np = None  # `main` runs this program again, where it is

AZIMUTH, ELEVATION = math.radians(-62), math.radians(22)
WIDTH, HEIGHT, EDGE = 320, 240, 10
FEW = 24
HUES = [208, 28, 150, 0, 270, 50, 190, 320]
# Bodies that do not move are drawn within this part of the robot's size beside it.
NEAR = 0.6
# Boxes of inertia are drawn up to this part of the robot's size, and up to the second where nothing
# else is drawn.
LARGE, LARGEST = 0.7, 1.3
# A line from what does not move to a body is drawn up to this part of the size of the bodies.
LONG = 0.6
MOST_SOLIDS = 1500
SECONDS = 60
# The end of the motion, s: one step is taken.
END = "1e-9"
STYLE = ".a{stroke:#26303a}.j{fill:#26303a}@media(prefers-color-scheme:dark){.a{stroke:#dfe6ec}.j{fill:#dfe6ec}}"


class NoPicture(Exception):
    """The reason why a robot is not drawn."""


def still(command, robot, options=()):
    """The SVG text of a robot's file, read with options of `check`. Raises NoPicture."""
    try:
        return drawing(*of_motion(command, robot, options))
    except NoPicture as reason:
        # A robot that forward dynamics does not move has places all the same; `simulate` does not
        # take all options.
        first = reason
    try:
        return drawing(*of_places(command, robot, options), width=3)
    except NoPicture as reason:
        raise NoPicture(f"{first}; {reason}") from None


def run(words):
    """What the command prints; raises NoPicture with its error."""
    try:
        done = subprocess.run([str(word) for word in words], capture_output=True, text=True, timeout=SECONDS)
    except subprocess.TimeoutExpired:
        raise NoPicture(f"`{words[1]}` takes more than {SECONDS} s") from None
    if done.returncode in (1, 2):
        lines = [line for line in done.stderr.splitlines() if line.startswith("error")] or [f"exit status {done.returncode}"]
        raise NoPicture(lines[0].removeprefix("error: "))
    return done.stdout


def of_motion(command, robot, options):
    """What `drawing` takes, from the page of a motion: with shapes, at the start."""
    with tempfile.TemporaryDirectory() as folder:
        page = Path(folder) / "page.html"
        # --smooth: the start needs no forces of constraints.
        try:
            run([command, "simulate", robot, "--smooth", *options, "--end", END, "-o", page])
        except NoPicture:
            # A motion that goes wrong has a start.
            if not page.exists():
                raise
        text = page.read_text(encoding="utf-8")
    found = re.search(r'<script id="motion"[^>]*>(.*?)</script>', text, re.DOTALL)
    if not found:
        raise NoPicture("the page of its motion has no data")
    motion = json.loads(found.group(1))
    poses = placements(motion)
    lines = [[poses[x[end]][0] @ x[at] + poses[x[end]][1] for end, at in (("from", "start"), ("to", "end"))] for x in motion["sticks"]]
    joints = [poses[x["body"]][0] @ x["place"] + poses[x["body"]][1] for x in motion["joints"]]
    solids = shapes(motion, poses)
    moving = [points for body, points, *_ in solids if body]
    if moving:
        most = LONG * size(moving)
        lines = [line for x, line in zip(motion["sticks"], lines) if x["from"] or np.linalg.norm(line[1] - line[0]) <= most]
    solids += boxes(motion, poses, size([*moving, *lines, *joints]), not moving)
    return np.array(motion["up"]), solids, lines, joints


def of_places(command, robot, options):
    """What `drawing` takes, from the places of links in the neutral configuration: lines between
    joints, without shapes.
    """
    report = json.loads(run([command, "check", robot, *options, "--format", "json"]))
    q = [0.0] * report["totals"]["coordinates"]
    for joint in report["joints"]:
        # The last number of a quaternion is w; 4 numbers are a rotation, 7 a position and a
        # rotation.
        if joint["q"] and joint["q"][1] in (4, 7):
            q[sum(joint["q"]) - 1] = 1.0
    with tempfile.TemporaryDirectory() as folder:
        states = Path(folder) / "states.json"
        states.write_text(json.dumps({"states": [{"q": q}]}))
        answer = json.loads(run([command, "eval", robot, *options, "--function", "placements", "--states", states, "--generic", "--format", "json"]))
    places = {name: np.array(numbers[9:]) for name, numbers in answer["functions"][0]["states"][0]["generic"].items()}
    lines = [[places[x["parent"]], places[x["child"]]] for x in report["joints"] if x["parent"] in places and x["child"] in places]
    joints = [places[x["child"]] for x in report["joints"] if x["kind"] != "fixed" and x["child"] in places]
    return -np.array(report["gravity"]) if any(report["gravity"]) else np.array([0, 0, 1.0]), [], lines, joints


def drawing(up, solids, lines, joints, width=1.6):
    """The SVG text.

    `solids`: as `shapes` returns them; `lines`: pairs of points; `joints`: points, m in the world.
    """
    camera = axes_of_camera(up)
    moving = [points for body, points, *_ in solids if body]
    everything = np.concatenate([np.zeros((0, 3)), *moving, *(np.array(x) for x in lines), np.array(joints).reshape(-1, 3)])
    if not everything.size:
        raise NoPicture("nothing moves")
    low, high = everything.min(axis=0), everything.max(axis=0)
    reach = NEAR * np.linalg.norm(high - low)
    solids = [x for x in solids if x[0] or (x[1].min(axis=0) >= low - reach).all() and (x[1].max(axis=0) <= high + reach).all()]
    if len(solids) > MOST_SOLIDS:
        raise NoPicture(f"{len(solids)} shapes, expected at most {MOST_SOLIDS}")
    flat = np.concatenate([points for _, points, *_ in solids] + [everything]) @ camera[:2].T
    low, high = flat.min(axis=0), flat.max(axis=0)
    scale = min((WIDTH - 2 * EDGE) / max(high[0] - low[0], 1e-9), (HEIGHT - 2 * EDGE) / max(high[1] - low[1], 1e-9))
    middle = (low + high) / 2

    def place(points):
        there = (np.atleast_2d(points) @ camera[:2].T - middle) * scale
        return np.column_stack([WIDTH / 2 + there[:, 0], HEIGHT / 2 - there[:, 1]])

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}">', f"<style>{STYLE}</style>"]
    solids.sort(key=lambda x: float((x[1] @ camera[2]).mean()))
    for _, points, triangles, color, alpha in solids:
        out += faces(points, triangles, color, alpha, camera, place)
    for a, b in lines:
        path = outline(place([a, b]), closed=False)
        out.append(f'<path class="a" d="{path}" fill="none" stroke-width="{width}" stroke-linecap="round" stroke-opacity=".55"/>')
    for x, y in (place(joint)[0] for joint in joints):
        out.append(f'<circle class="j" cx="{x:.1f}" cy="{y:.1f}" r="{1 + width / 1.6:.1f}" fill-opacity=".75"/>')
    return "\n".join([*out, "</svg>", ""])


def axes_of_camera(up):
    """Rows: to the right, up in the picture, and to the eye."""
    up = up / np.linalg.norm(up)
    first = np.array([1.0, 0, 0]) if abs(up[0]) < 0.9 else np.array([0, 1.0, 0])
    side = first - (first @ up) * up
    side /= np.linalg.norm(side)
    ahead = np.cross(up, side)
    back = math.cos(ELEVATION) * (math.cos(AZIMUTH) * side + math.sin(AZIMUTH) * ahead) + math.sin(ELEVATION) * up
    right = np.cross(up, back)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(back, right), back])


def placements(motion):
    """Rotation and position of each body in the first frame; body 0 does not move."""
    stored = base64.b64decode(motion["placements"])[: 14 * motion["moving"]]
    rows = np.frombuffer(stored, dtype="<u2").reshape(-1, 7)
    found = [(np.eye(3), np.zeros(3))]
    for row in rows:
        position = np.array(motion["low"]) + np.array(motion["quantum"]) * row[:3]
        found.append((rotation(row[3:].astype("<i2") / 32767), position))
    return found


def rotation(quaternion):
    """The rotation matrix of a quaternion (x, y, z, w) of any length."""
    x, y, z, w = quaternion / max(np.linalg.norm(quaternion), 1e-300)
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ])


# A box with half edges of 1.
CORNERS = [[k & 1 or -1, (k >> 1) & 1 or -1, (k >> 2) & 1 or -1] for k in range(8)]
SIDES = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
BOX = [triangle for a, b, c, d in SIDES for triangle in ([a, b, c], [a, c, d])]


def shapes(motion, poses):
    """Body, points in the world, triangles, colour and opacity of what is drawn.

    Visual shapes, or collision shapes of links that have no visual ones.
    """
    geometries = [(np.frombuffer(base64.b64decode(p), "<f4").reshape(-1, 3).astype(float), np.frombuffer(base64.b64decode(t), "<u4").reshape(-1, 3))
                  for p, t in motion["geometries"]]
    seen = {(x["body"], x["name"]) for x in motion["solids"] if x["kind"] == "visual"}
    return [placed(x, *geometries[x["geometry"]], x["axes"], poses) for x in motion["solids"]
            if (x["kind"] == "visual" or (x["body"], x["name"]) not in seen) and len(geometries[x["geometry"]][0])]


def boxes(motion, poses, extent, are_alone):
    """As `shapes`: the boxes of links that have no shapes, unless they are large beside the robot's
    extent.
    """
    touched = {(x["body"], x["name"]) for x in motion["solids"]}
    untouched = [x for x in motion["boxes"] if (x["body"], x["name"]) not in touched]
    chosen = [x for x in untouched if 2 * np.linalg.norm(x["half"]) < LARGE * extent]
    if not chosen and are_alone:
        chosen = [x for x in untouched if 2 * np.linalg.norm(x["half"]) < LARGEST * extent or not extent]
    return [placed(x, np.array(CORNERS) * np.array(x["half"]), np.array(BOX), x["axes"], poses) for x in chosen]


def placed(x, points, triangles, axes, poses):
    """Body, points in the world, triangles, colour and opacity of a shape or a box of the page."""
    turn, position = poses[x["body"]]
    there = (points @ np.array(axes) + np.array(x["center"])) @ turn.T + position
    color = x.get("color")
    return (x["body"], there, triangles, [255 * part for part in color[:3]], color[3]) if color else (x["body"], there, triangles, of_hue(HUES[x["limb"] % len(HUES)]), 1.0)


def size(parts):
    """The diagonal of the box around points, m; 0 without points."""
    points = np.concatenate([np.zeros((0, 3)), *(np.reshape(part, (-1, 3)) for part in parts)])
    return float(np.linalg.norm(points.max(axis=0) - points.min(axis=0))) if len(points) else 0.0


def of_hue(angle, part=0.4, light=0.64):
    """Red, green and blue of a hue in degrees, from 0 to 255."""
    most = part * min(light, 1 - light)
    turns = [(n + angle / 30) % 12 for n in (0, 8, 4)]
    return [255 * (light - most * max(-1, min(k - 3, 9 - k, 1))) for k in turns]


# The direction to the light, in axes of the camera.
LIGHT = [-0.35, 0.75, 0.56]


def faces(points, triangles, color, alpha, camera, place):
    """The paths of a shape."""
    if len(triangles) > FEW:
        return [path(outline(hull(place(points))), color, 0.92, alpha)]
    corners = points[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normals, axis=1)
    normals = normals / np.maximum(length, 1e-300)[:, None]
    planes = {}
    for corner, normal, size in zip(corners, normals, length):
        if size > 0 and normal @ camera[2] > 1e-3:
            planes.setdefault((*np.round(normal, 3), round(float(normal @ corner[0]), 6)), []).append((corner, normal))
    found = []
    for members in planes.values():
        shade = 0.72 + 0.34 * max(0.0, float(camera @ members[0][1] @ np.array(LIGHT)))
        found.append(path(outline(hull(place(np.concatenate([corner for corner, _ in members])))), color, shade, alpha))
    return found or [path(outline(hull(place(points))), color, 0.92, alpha)]


def path(line, color, shade, alpha):
    """An outline that is filled."""
    fill, edge = (" ".join(f"{min(255, max(0, part * by)):.0f}" for part in color).replace(" ", ",") for by in (shade, shade * 0.62))
    opacity = "" if alpha >= 1 else f' fill-opacity="{max(alpha, 0.15):.2f}"'
    return f'<path d="{line}" fill="rgb({fill})"{opacity} stroke="rgb({edge})" stroke-width=".7" stroke-linejoin="round"/>'


def outline(points, closed=True):
    """The data of a path through points, with a tenth of a pixel; equal neighbours are one."""
    texts = [f"{x:.1f} {y:.1f}" for x, y in points]
    texts = [text for k, text in enumerate(texts) if k == 0 or text != texts[k - 1]]
    return "M" + "L".join(texts) + ("Z" if closed else "")


def hull(points):
    """The corners of the convex hull of points in the plane, counter-clockwise.

    A monotone chain (Andrew, Information Processing Letters 9, 1979).
    """
    points = np.unique(np.round(points, 1), axis=0)
    if len(points) < 3:
        return points
    halves = []
    for ordered in (points.tolist(), points[::-1].tolist()):
        chain = []
        for p in ordered:
            while len(chain) > 1 and turn(chain[-2], chain[-1], p) <= 0:
                chain.pop()
            chain.append(p)
        halves += chain[:-1]
    return np.array(halves)


def turn(a, b, c):
    """Twice the area of the triangle, positive where it is counter-clockwise."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def run_again():
    """Runs this program by the Python of build.py."""
    here = Path(__file__).resolve().parent
    repository = here.parent.parent
    sys.path.insert(0, str(repository / "tests"))
    from virtual_environment import python_of

    place = Path(os.environ.get("CARGO_TARGET_DIR", repository / "target")) / "site-python"
    try:
        python = python_of(place, here / "requirements.txt")
    except (subprocess.CalledProcessError, OSError) as error:
        sys.exit(f"error: {here / 'requirements.txt'}: its packages cannot be installed ({error}); expected NumPy, or a package index to get it from")
    sys.exit(subprocess.run([str(python), *sys.argv]).returncode)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("robot", help="a robot's file: URDF, MJCF or SDF")
    parser.add_argument("-o", "--output", type=Path, required=True, help="the SVG file")
    arguments = parser.parse_args()
    if np is None:
        run_again()
    command = os.environ.get("ARTICULATED_COMMAND") or "articulated"
    try:
        arguments.output.write_text(still(command, arguments.robot), encoding="utf-8")
    except (NoPicture, OSError) as error:
        sys.exit(f"error: {arguments.robot}: {error}")


if __name__ == "__main__":
    main()
