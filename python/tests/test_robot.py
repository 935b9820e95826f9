"""Reading robots, and what they say about themselves."""

import os
import pickle
import warnings

import articulated
import numpy as np
import pytest

PENDULUM = """<robot name="pendulum"><link name="base"/><link name="bob"><inertial><origin xyz="0 0 -0.5"/><mass value="2"/>
<inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial></link>
<joint name="swing" type="revolute"><parent link="base"/><child link="bob"/><axis xyz="0 1 0"/>
<limit lower="-1" upper="2" effort="3" velocity="4"/></joint></robot>"""


def test_a_pendulum():
    robot = articulated.loads(PENDULUM)
    assert (robot.name, robot.base, robot.nq, robot.nv) == ("pendulum", "fixed", 1, 1)
    assert robot.joints == (articulated.Joint("swing", "revolute", slice(0, 1), slice(0, 1)),)
    assert (robot.frames, robot.links) == (("base", "bob"), ("bob",))
    limits = robot.lower, robot.upper, robot.effort_limit, robot.velocity_limit
    assert [limit.tolist() for limit in limits] == [[-1], [2], [3], [4]]
    assert robot.gravity.tolist() == [0, 0, -9.81] and robot.moving_mass == 2
    assert repr(robot) == "<articulated.Robot 'pendulum': fixed base, nq=1, nv=1, 2 frames>"
    assert robot.gravity_torque([0.5])[0] == pytest.approx(2 * 9.81 * 0.5 * np.sin(0.5), abs=1e-14)
    assert robot.with_gravity((0, 0, 0)).gravity_torque([0.5]).tolist() == [0]
    assert robot.potential_energy([0.0]) == pytest.approx(-9.81)


def test_a_file(tmp_path):
    path = tmp_path / "pendulum.urdf"
    path.write_text(PENDULUM)
    for name in (path, str(path), os.fsencode(path)):
        assert articulated.load(name, gravity=[0, 0, -1.62]).gravity_torque([0.5])[0] == pytest.approx(1.62 * np.sin(0.5))
    assert articulated.load(path, base="floating").nv == 7


def test_a_floating_robot():
    robot = articulated.bundled("quadruped")
    assert robot.base == "floating" and robot.nq == robot.nv + 1 == 19
    assert robot.joints[0].kind == "floating" and robot.joints[0].q == slice(0, 7) and robot.joints[0].v == slice(0, 6)
    assert robot.neutral.tolist() == [0] * 6 + [1] + [0] * 12
    assert robot.links[0] == robot.frames[0] and len(robot.links) == 13
    assert np.isinf(robot.lower[:7]).all() and np.isfinite(robot.lower[7:]).all()
    assert articulated.bundled("quadruped", base="fixed").nq == 12


def test_all_bundled_robots():
    assert len(articulated.bundled_names()) == 13
    for name, summary in articulated.bundled_names().items():
        robot = articulated.bundled(name)
        assert summary and robot.gravity_torque(robot.neutral).shape == (robot.nv,)


def test_configurations_at_random():
    robot = articulated.bundled("panda_like")
    many = robot.random_configuration(np.random.default_rng(0), 1000)
    assert (many >= robot.lower).all() and (many <= robot.upper).all()
    np.testing.assert_array_equal(robot.random_configuration(5), robot.random_configuration(5))
    assert not np.array_equal(robot.random_configuration(), robot.random_configuration())
    np.testing.assert_array_equal(robot.random_configuration(uniform=np.zeros(7)), robot.lower)
    for bad, error in ((dict(rng="seed"), TypeError), (dict(size=-1), ValueError), (dict(size=1.5), TypeError),
                       (dict(rng=1, uniform=np.zeros(7)), TypeError), (dict(uniform=np.zeros(6)), ValueError)):
        with pytest.raises(error):
            robot.random_configuration(**bad)


def test_frames_are_chosen():
    robot = articulated.bundled("panda_like")
    two = articulated.bundled("panda_like", frames=["link_7", "link_1"])
    q = robot.random_configuration(1)
    np.testing.assert_array_equal(two.placements(q), robot.placements(q)[[robot.frames.index("link_7"), robot.frames.index("link_1")]])
    assert robot.with_frames([]).placements(np.tile(q, (3, 1))).shape == (3, 0, 12)
    matrices = robot.placements_matrices(np.tile(q, (3, 1)))
    assert matrices.shape == (3, len(robot.frames), 4, 4)
    np.testing.assert_allclose(np.linalg.det(matrices), 1)


def test_warnings_of_the_reader():
    text = PENDULUM.replace('ixx="0.1"', 'ixx="9"')
    with pytest.warns(articulated.RobotWarning) as caught:
        articulated.loads(text, name="odd.urdf")
    assert caught[0].filename == __file__ and "odd.urdf:" in str(caught[0].message)
    finding = caught[0].message.diagnostic
    assert finding["severity"] == "warning" and finding["file"] == "odd.urdf" and finding["line"] == 1
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(articulated.RobotWarning):
            articulated.loads(text)
        articulated.loads(PENDULUM)


def test_all_mistakes_of_a_file_at_once():
    text = PENDULUM.replace('value="2"', 'value="two"').replace('child link="bob"', 'child link="bub"')
    with pytest.raises(articulated.RobotError) as error:
        articulated.loads(text, name="wrong.urdf")
    findings = error.value.diagnostics
    assert len(findings) >= 2
    keys = {"severity", "code", "file", "line", "column", "subject", "field", "found", "expected", "hint", "message"}
    assert all(set(finding) == keys and finding["file"] == "wrong.urdf" for finding in findings)
    assert any('did you mean "bob"?' in finding["message"] for finding in findings)
    assert all(finding["message"] in str(error.value) for finding in findings if finding["severity"] == "error")


@pytest.mark.parametrize("text", ["", "<robot", "not XML", "<robot/>", "\0", "\ud800", b"\xff\xfe", b"<robot name='a'/>" * 3, "<a>" * 100_000])
def test_no_robots(text):
    with pytest.raises(articulated.RobotError) as error:
        articulated.loads(text)
    assert error.value.diagnostics and isinstance(error.value, ValueError)


def test_cut_files():
    rng = np.random.default_rng(0)
    for _ in range(300):
        text = bytearray(PENDULUM.encode())
        for at in rng.integers(0, len(text), rng.integers(1, 6)):
            text[at] = rng.integers(0, 256)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", articulated.RobotWarning)
            try:
                articulated.loads(bytes(text[: rng.integers(1, len(text) + 200)]))
            except articulated.RobotError as error:
                assert error.diagnostics


def test_no_file(tmp_path):
    (tmp_path / "panda.urdf").write_text(PENDULUM)
    with pytest.raises(articulated.RobotError, match="panda.urdf") as error:
        articulated.load(tmp_path / "pando.urdf")
    assert error.value.diagnostics[0]["code"] == "file"
    with pytest.raises(articulated.RobotError):
        articulated.load(tmp_path)


@pytest.mark.parametrize("options, error, message", [
    (dict(base="fix"), ValueError, "base: found 'fix', expected \"fixed\" or \"floating\""),
    (dict(base=1), ValueError, "base: found 1"),
    (dict(base=[]), ValueError, "base: found"),
    (dict(gravity=(0, 0)), ValueError, "gravity: found shape (2,), expected three finite numbers"),
    (dict(gravity=(0, 0, np.nan)), ValueError, "gravity: found [0.0, 0.0, nan]"),
    (dict(gravity="down"), TypeError, "gravity: found"),
    (dict(frames="bob"), TypeError, "frames: found 'bob', expected a list of names"),
    (dict(frames=["bab"]), articulated.RobotError, "did you mean \"bob\"?"),
    (dict(frames=["one", "two"]), articulated.RobotError, "two"),
    (dict(frames=[1]), TypeError, "frames: found int in the list"),
    (dict(frames=3), TypeError, "frames: found int, expected a list of names"),
    (dict(name=3), TypeError, "name: found int"),
])
def test_bad_options(options, error, message):
    with pytest.raises(error) as found:
        articulated.loads(PENDULUM, **options)
    assert message in str(found.value)


def test_a_file_that_includes_another(tmp_path):
    """An MJCF file, whose included files belong to the robot of a file, and to no robot of a text."""
    (tmp_path / "bar.xml").write_text('<mujoco><default><default class="bar"><geom type="capsule" size="0.05" fromto="0 0 0 0 0 0.5"/></default></default></mujoco>')
    text = """<mujoco model="swing"><include file="bar.xml"/><worldbody><body name="bar"><joint name="hinge" axis="0 1 0"/><geom class="bar" mass="2"/>
    </body></worldbody></mujoco>"""
    path = tmp_path / "swing.xml"
    path.write_text(text)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", articulated.RobotWarning)
        robot = articulated.load(path)
        assert robot.nv == 1 and robot.gravity_torque([0.5])[0] == pytest.approx(-2 * 9.81 * 0.25 * np.sin(0.5))
        pendulum = articulated.loads(PENDULUM)
        for both in (pendulum.append(path, "bob", "a_"), pendulum.append(robot, "bob", "a_")):
            assert both.nv == 2 and both.lock("swing", 0.1).nv == 1
        with pytest.raises(articulated.RobotError, match="includes another file"):
            articulated.loads(text, name="swing.xml")


def test_a_file_of_xacro_with_arguments_and_packages(tmp_path):
    (tmp_path / "store").mkdir()
    (tmp_path / "store" / "mass.xacro").write_text('<robot><xacro:property name="mass" value="$(arg mass)"/></robot>')
    text = """<robot name="arm"><xacro:arg name="side" default="right"/><xacro:arg name="mass" default="1"/>
    <xacro:arg name="long" default="false"/><xacro:include filename="$(find parts)/mass.xacro"/><link name="base"/>
    <link name="$(arg side)"><inertial><origin xyz="0 0 ${-1.0 if '$(arg long)' == 'true' else -0.5}"/><mass value="${mass}"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
    <joint name="swing" type="continuous"><parent link="base"/><child link="$(arg side)"/><axis xyz="0 1 0"/></joint></robot>"""
    path = tmp_path / "arm.xacro"
    path.write_text(text)
    packages = {"parts": tmp_path / "store"}
    robot = articulated.load(path, args={"side": "left", "mass": 2.5, "long": True}, packages=packages)
    assert robot.links == ("left",) and robot.moving_mass == 2.5
    assert robot.gravity_torque([0.5])[0] == pytest.approx(2.5 * 9.81 * np.sin(0.5))
    default = articulated.load(path, packages=packages)
    assert (default.links, default.moving_mass) == (("right",), 1)
    # Edits and copies keep both.
    assert robot.payload("left", 1).moving_mass == 3.5 and pickle.loads(pickle.dumps(robot)).links == ("left",)
    assert articulated.loads(PENDULUM).append(default, "bob", "a_").lock("a_swing").nv == 1
    with pytest.raises(ValueError, match="found a robot with args, expected one without"):
        robot.append(robot, "bob", "a_")
    with pytest.raises(articulated.RobotError, match="parts"):
        articulated.load(path)
    with pytest.warns(articulated.RobotWarning, match="sdie.*did you mean"):
        articulated.load(path, args={"sdie": "left"}, packages=packages)
    for options, message in (
        ({"args": ["left"]}, "args: found list, expected a dict"),
        ({"args": {"side": None}}, "args['side']: found NoneType, expected a str, a number or a bool"),
        ({"args": {1: "left"}}, "args: found int, expected a name"),
        ({"packages": {"parts": 1}}, "packages['parts']: found int"),
    ):
        with pytest.raises(TypeError) as found:
            articulated.load(path, **options)
        assert message in str(found.value)
    plain = articulated.loads('<robot name="r"><xacro:arg name="side" default="right"/><link name="$(arg side)"/></robot>', args={"side": "left"})
    assert plain.frames == ("left",)


def test_the_class_makes_no_robots():
    for arguments in ((), ("panda_like",)):
        with pytest.raises(TypeError, match="expected one of articulated.load, loads and bundled"):
            articulated.Robot(*arguments)


def test_bad_names():
    for bad in (3, None, b"panda_like", ["a"], "pando_like"):
        with pytest.raises(ValueError, match="name: found"):
            articulated.bundled(bad)
    with pytest.raises(ValueError, match="did you mean 'panda_like'"):
        articulated.bundled("pando_like")
    for bad in (3, None, object()):
        with pytest.raises(TypeError):
            articulated.load(bad)
        with pytest.raises(TypeError):
            articulated.loads(bad)


def test_examples_of_the_documentation(tmp_path, monkeypatch):
    import doctest
    import http.client
    import importlib.util
    import os
    import shutil
    import webbrowser
    from pathlib import Path

    from test_edits import GRIPPER

    assert doctest.testmod(articulated).failed == 0
    text = (Path(__file__).resolve().parent.parent / "README.md").read_text(encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    pages = []

    def visit(url):
        # The page of a player listens to it.
        if url.startswith("http"):
            pages.append(http.client.HTTPConnection(url.split("/")[2]))
            pages[-1].request("GET", "/events?" + url.split("?")[1])
        return True

    monkeypatch.setattr(webbrowser, "open", visit)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    monkeypatch.setenv("ARTICULATED_CACHE", str(tmp_path / "cache"))
    (tmp_path / "gripper.urdf").write_text(GRIPPER)
    scope, run = {}, 0
    needs = {"to_arrow": "pyarrow", "articulated.torch": "torch", "articulated.jax": "jax", "articulated.viser": "viser", "articulated.rerun": "rerun"}
    for block in text.split("```python\n")[1:]:
        code = block.split("```")[0]
        is_there = all(importlib.util.find_spec(module) for word, module in needs.items() if word in code)
        # Robots of a package that is not needed here: see test_robots.py.
        is_there = is_there and "articulated.robots(" not in code
        if is_there and (".compile(" not in code or shutil.which(os.environ.get("CC", "cc").split()[0])):
            exec(code, scope)
            run += 1
    assert run >= 2 and scope["taus"].shape == (4096, 7) and scope["mass"].shape == (7, 7)
    assert (scope["arm"].nv, scope["arm"].frames) == (7, ("hand_palm",))
    assert len(pages) == 2
