"""Robots in viser and in rerun."""

import importlib
import socket
import sys

import articulated
import numpy as np
import pytest
from articulated import _drawing

# A box of 0.2 m × 0.1 m × 0.1 m, moved and turned on its link; a link with a mass and no shape; and a box that does not move.
LOOKS = """<robot name="looks"><link name="base"><visual><origin xyz="0 0 -1"/><geometry><box size="1 1 0.5"/></geometry></visual></link>
<link name="arm"><visual><origin xyz="0.1 0 0" rpy="0 0 0.5"/><geometry><box size="0.2 0.1 0.1"/></geometry>
<material name="red"><color rgba="1 0 0 0.5"/></material></visual></link>
<link name="load"><inertial><mass value="3"/><inertia ixx="0.02" iyy="0.04" izz="0.04" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="a" type="continuous"><parent link="base"/><child link="arm"/><origin xyz="0 0 0.5"/><axis xyz="0 0 1"/></joint>
<joint name="b" type="prismatic"><parent link="arm"/><child link="load"/><axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>"""


@pytest.fixture(scope="module")
def robot():
    return articulated.loads(LOOKS)


def test_shapes_are_those_of_the_file(robot):
    drawn = _drawing.drawing(robot)
    assert drawn.bodies == ("arm", "load")
    shapes = {shape.link: shape for shape in drawn.shapes}
    spans = {link: (shape.points.min(axis=0), shape.points.max(axis=0)) for link, shape in shapes.items()}
    np.testing.assert_allclose(spans["base"], [[-0.5, -0.5, -1.25], [0.5, 0.5, -0.75]], atol=1e-6)
    c, s = np.cos(0.5), np.sin(0.5)
    corners = [[0.1 + c * x - s * y, s * x + c * y, z] for x in [-0.1, 0.1] for y in [-0.05, 0.05] for z in [-0.05, 0.05]]
    np.testing.assert_allclose(sorted(shapes["arm"].points.round(6).tolist()), sorted(np.round(corners, 6).tolist()), atol=2e-6)
    # A box of even density of the edges a, b, b has m(b² + b²)/12 and m(a² + b²)/12.
    b = np.sqrt(0.02 * 12 / 3 / 2)
    a = np.sqrt(0.04 * 12 / 3 - b**2)
    np.testing.assert_allclose(spans["load"], [[-a / 2, -b / 2, -b / 2], [a / 2, b / 2, b / 2]], atol=1e-9)
    assert [shapes[link].body for link in ["base", "arm", "load"]] == [-1, 0, 1]
    assert shapes["arm"].color == (1, 0, 0, 0.5) and shapes["base"].color[3] == 1
    for shape in drawn.shapes:
        volume = np.linalg.det(shape.points[shape.triangles]).sum() / 6
        edges = {"base": 1 * 1 * 0.5, "arm": 0.2 * 0.1 * 0.1, "load": a * b * b}
        assert volume == pytest.approx(edges[shape.link], rel=1e-6), "triangles are counterclockwise seen from outside"


def poses(q):
    """Positions and (w, x, y, z) of the links arm and load, in closed form."""
    turn = [np.cos(q[0] / 2), 0, 0, np.sin(q[0] / 2)]
    return {"arm": ([0, 0, 0.5], turn), "load": ([q[1] * np.cos(q[0]), q[1] * np.sin(q[0]), 0.5], turn)}


def test_viser(robot):
    viser = pytest.importorskip("viser", reason="viser (pip install viser) is not installed: no robots in it")
    import articulated.viser

    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    server = viser.ViserServer(host="127.0.0.1", port=port, verbose=False)
    try:
        made = {}

        def kept(add):
            def adding(name, *given, **named):
                made[name] = add(name, *given, **named)
                return made[name]

            return adding

        for name in ["add_frame", "add_mesh_simple"]:
            setattr(server.scene, name, kept(getattr(server.scene, name)))
        viewer = articulated.viser.Viewer(robot, server, name="mine", frames=["load"])
        assert viewer.server is server
        handles = {name: made[f"/mine/{name}"] for name in ["arm", "load"]}
        assert [handles[name].show_axes for name in ["arm", "load"]] == [False, True]
        for q in [[0.0, 0.3], [0.7, -0.2]]:
            viewer.show(q)
            for name, (position, turn) in poses(q).items():
                np.testing.assert_allclose(handles[name].position, position, atol=1e-12)
                np.testing.assert_allclose(handles[name].wxyz * np.sign(handles[name].wxyz[0]), turn, atol=1e-12)
        assert sorted(name.rsplit("/", 1)[0] for name in made if "shape" in name) == ["/mine", "/mine/arm", "/mine/load"]
        with pytest.raises(ValueError, match=r"q: found shape \(1,\)"):
            viewer.show([0.0])
        with pytest.raises(articulated.RobotError, match='did you mean "load"'):
            articulated.viser.Viewer(robot, server, frames=["laod"])
    finally:
        server.stop()


def test_rerun(robot, tmp_path):
    rerun = pytest.importorskip("rerun", reason="rerun (pip install rerun-sdk) is not installed: no robots in it")
    import articulated.rerun

    logged = {}
    recording = rerun.RecordingStream("articulated_test")
    before = rerun.log

    def log(path, what, **named):
        assert named["recording"] is recording
        logged.setdefault("/".join(path), []).append((what, named["static"]))
        before(path, what, **named)

    rerun.log = log
    try:
        recording.save(str(tmp_path / "robot.rrd"))
        viewer = articulated.rerun.Viewer(robot, "world/mine", frames=["load"], recording=recording)
        for q in [[0.0, 0.3], [0.7, -0.2]]:
            viewer.show(q)
            for name, (position, turn) in poses(q).items():
                transform, static = logged[f"world/mine/{name}"][-1]
                assert not static
                np.testing.assert_allclose(np.array(transform.translation.as_arrow_array().to_pylist()).ravel(), position, atol=1e-7)
                columns = np.array(transform.mat3x3.as_arrow_array().to_pylist()).reshape(3, 3)
                c, s = np.cos(q[0]), np.sin(q[0])
                np.testing.assert_allclose(columns.T, [[c, -s, 0], [s, c, 0], [0, 0, 1]], atol=1e-7)
        recording.flush()
    finally:
        rerun.log = before
    assert sorted(path for path in logged if "shape" in path or "axes" in path) == [
        "world/mine/arm/arm_shape_1", "world/mine/base_shape_0", "world/mine/load/axes", "world/mine/load/load_shape_2"]
    assert all(static for path, rows in logged.items() for _, static in rows if "shape" in path or "axes" in path)
    data = (tmp_path / "robot.rrd").read_bytes()
    assert data.startswith(b"RRF2") and len(data) > 1000
    with pytest.raises(ValueError, match=r"q: found shape \(1,\)"):
        viewer.show([0.0])


@pytest.mark.parametrize("name", ["viser", "rerun"])
def test_a_viewer_that_is_not_installed(name, monkeypatch):
    monkeypatch.setitem(sys.modules, name, None)
    monkeypatch.delitem(sys.modules, f"articulated.{name}", raising=False)
    with pytest.raises(ImportError, match=rf'articulated.{name}: found no {name} .*pip install "articulated\[{name}\]"'):
        importlib.import_module(f"articulated.{name}")
