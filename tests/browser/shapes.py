"""A robot whose links have shapes of every kind: meshes in each format, primitives, materials, and meshes that are missing."""

import math
import struct

# A box: its corners, and its faces counterclockwise from outside.
HALF = (0.05, 0.05, 0.15)
FACES = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
POINTS = [tuple((half if k >> axis & 1 else -half) for axis, half in enumerate(HALF)) for k in range(8)]
TRIANGLES = [t for a, b, c, d in FACES for t in ((a, b, c), (a, c, d))]

JOINT = """  <joint name="{child}_joint" type="revolute">
    <origin xyz="0 0 0.3"/><parent link="{parent}"/><child link="{child}"/><axis xyz="0 1 0"/>
    <limit lower="-3" upper="3" effort="10" velocity="10"/>
  </joint>
"""
LINK = """  <link name="{name}">
    <inertial><origin xyz="0 0 0.15"/><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.002" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><origin xyz="0 0 0.15"/><geometry>{shape}</geometry>{material}</visual>
    <collision><origin xyz="0 0 0.15"/><geometry><capsule radius="0.09" length="0.2"/></geometry></collision>
  </link>
"""
RED = '<material name="red paint"><color rgba="0.9 0.1 0.1 1"/></material>'
STEEL = '<material name="steel"/>'
MESHES = [
    ("binary", '<mesh filename="meshes/box.stl"/>', RED),
    ("ascii", '<mesh filename="package://shapes/meshes/ascii.stl"/>', STEEL),
    ("obj", '<mesh filename="meshes/box.obj" scale="1 1 1"/>', RED),
    ("dae", '<mesh filename="package://elsewhere/box.dae"/>', STEEL),
    ("ball", '<sphere radius="0.1"/>', RED),
    ("rod", '<cylinder radius="0.05" length="0.3"/>', ""),
    ("lost", '<mesh filename="package://nowhere/lost.stl"/>', ""),
]

SCENE = """urdf = "shapes.urdf"
[initial.q]
binary_joint = 0.6
obj_joint = 0.5
[simulation]
end = 0.5
output = 0.01
"""

DAE = """<?xml version="1.0"?>
<COLLADA xmlns="{schema}" version="1.4.1"><asset><unit meter="0.001"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="box"><mesh>
<source id="p"><float_array id="pa" count="{count}">{points}</float_array><technique_common>
<accessor source="#pa" count="8" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor>
</technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="12"><input semantic="VERTEX" source="#v" offset="0"/><p>{triangles}</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#box"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
"""


def write(folder):
    """The robot, its meshes and a scene in a folder; the path of the scene."""
    (folder / "meshes").mkdir(parents=True, exist_ok=True)
    (folder / "other").mkdir(exist_ok=True)
    corners = [[POINTS[k] for k in triangle] for triangle in TRIANGLES]
    records = [struct.pack("<12fH", 0, 0, 0, *(x for point in triangle for x in point), 0) for triangle in corners]
    (folder / "meshes" / "box.stl").write_bytes(bytes(80) + struct.pack("<I", len(records)) + b"".join(records))
    facet = "facet normal 0 0 0\nouter loop\n{}endloop\nendfacet\n"
    facets = [facet.format("".join("vertex {} {} {}\n".format(*point) for point in triangle)) for triangle in corners]
    (folder / "meshes" / "ascii.stl").write_text("solid box\n" + "".join(facets) + "endsolid box\n")
    lines = ["v {} {} {}".format(*point) for point in POINTS] + ["f {} {} {}".format(*(k + 1 for k in t)) for t in TRIANGLES]
    (folder / "meshes" / "box.obj").write_text("\n".join(lines) + "\n")
    points = " ".join(str(1000 * x) for point in POINTS for x in point)
    triangles = " ".join(str(k) for triangle in TRIANGLES for k in triangle)
    schema = "http://www.collada.org/2005/11/COLLADASchema"
    (folder / "other" / "box.dae").write_text(DAE.format(schema=schema, count=24, points=points, triangles=triangles))
    parts, parent = ['<robot name="shapes">\n  <material name="steel"><color rgba="0.5 0.55 0.65 1"/></material>\n  <link name="base"/>\n'], "base"
    for name, shape, material in MESHES:
        parts += [LINK.format(name=name, shape=shape, material=material), JOINT.format(parent=parent, child=name)]
        parent = name
    (folder / "shapes.urdf").write_text("".join(parts) + "</robot>\n")
    (folder / "shapes.toml").write_text(SCENE)
    return folder / "shapes.toml"


def write_ring(folder, fine):
    """A pendulum that is a ring, a torus of 0.5 m and a tube of 0.06 m: of 240 000 triangles, or of 9600. The path of its scene."""
    folder.mkdir(parents=True, exist_ok=True)
    long, short = (1000, 120) if fine else (160, 30)
    corner = lambda i, k: i % long * short + k % short + 1
    lines = []
    for i in range(long):
        a = 2 * math.pi * i / long
        for k in range(short):
            b = 2 * math.pi * k / short
            r = 0.5 + 0.06 * math.cos(b)
            lines.append(f"v {r * math.cos(a):.6f} {0.06 * math.sin(b):.6f} {r * math.sin(a):.6f}")
    for i in range(long):
        for k in range(short):
            p, q, r, s = corner(i, k), corner(i + 1, k), corner(i + 1, k + 1), corner(i, k + 1)
            lines += [f"f {p} {r} {q}", f"f {p} {s} {r}"]
    (folder / "ring.obj").write_text("\n".join(lines) + "\n")
    body = '<inertial><mass value="1"/><inertia ixx="0.1" iyy="0.2" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>'
    look = f'<visual><geometry><mesh filename="ring.obj"/></geometry>{RED}</visual>'
    joint = '<joint name="axle" type="continuous"><parent link="base"/><child link="ring"/><axis xyz="0 1 0"/></joint>'
    (folder / "ring.urdf").write_text(f'<robot name="ring"><link name="base"/><link name="ring">{body}{look}</link>{joint}</robot>')
    (folder / "ring.toml").write_text('urdf = "ring.urdf"\n[initial.v]\naxle = 1.0\n[simulation]\nend = 0.5\noutput = 0.01\n')
    return folder / "ring.toml"
