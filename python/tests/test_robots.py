"""Robots of packages that are installed."""

import os
import sys
from pathlib import Path

import articulated
import numpy as np
import pytest
from articulated import _found

ARM = """<robot name="arm"><link name="base"/><link name="tip">
<inertial><mass value="2"/><origin xyz="0.5 0 0"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<visual><geometry><mesh filename="package://example-robot-data/robots/arm_description/meshes/tip.stl"/></geometry></visual></link>
<joint name="j" type="continuous"><parent link="base"/><child link="tip"/><axis xyz="0 1 0"/></joint></robot>"""
PART = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:macro name="m"/></robot>'
CART = '<mujoco model="cart"><worldbody><body><joint type="slide" axis="1 0 0"/><geom size="0.1"/></body></worldbody></mujoco>'
STAGE = '<?xml version="1.0"?><!-- <body/> --><mujoco><include file="cart.xml"/><worldbody><geom type="plane" size="1 1 1"/></worldbody></mujoco>'
CASE = '<sdf version="1.7"><model name="case"><link name="a"/></model></sdf>'
INCLUDER = """<robot name="two" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:include filename="$(find other)/part.xacro"/>
<link name="a"/><link name="b"/><joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint></robot>"""
MANIFEST = "<package><name>{}</name></package>"


def written(folder, files):
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    return folder


@pytest.fixture
def empty(tmp_path, monkeypatch):
    """No package with robots, and a home without caches."""
    for name in ["ROBOT_DESCRIPTIONS_CACHE", "MENAGERIE_ROOT", "MENAGERIE_CACHE_DIR", "XDG_CACHE_HOME", "AMENT_PREFIX_PATH"]:
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(_found, "_sites", lambda: [tmp_path / "site-packages"])
    monkeypatch.setattr(sys, "prefix", str(tmp_path / "prefix"))
    monkeypatch.setattr(Path, "home", lambda: tmp_path / "home")
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    return tmp_path


@pytest.fixture
def places(empty, monkeypatch):
    """A made-up robot in each place."""
    data = {"package.xml": MANIFEST.format("example_robot_descriptions"), "robots/arm_description/urdf/arm.urdf": ARM,
            "robots/arm_description/meshes/looks_like.urdf": ARM, "robots/cases/case.sdf": CASE, "robots/arm_description/urdf/part.xacro": PART}
    written(empty / "site-packages/cmeel.prefix/share/example-robot-data", data)
    written(empty / "cache", {"mujoco_menagerie/some_cart/cart.xml": CART, "mujoco_menagerie/some_cart/scene.xml": STAGE, ".git/old.urdf": ARM})
    written(empty / "ros/share", {"two/package.xml": MANIFEST.format("two"), "two/urdf/two.urdf.xacro": INCLUDER,
                                  "other/package.xml": MANIFEST.format("other"), "other/part.xacro": PART})
    monkeypatch.setenv("ROBOT_DESCRIPTIONS_CACHE", str(empty / "cache"))
    monkeypatch.setenv("AMENT_PREFIX_PATH", os.pathsep.join([str(empty / "ros"), str(empty / "no_such")]))
    return empty


def test_every_robot_is_found_once_and_parts_are_not(places, monkeypatch):
    found = articulated.robots()
    assert [(one.name, one.format, one.package) for one in found] == [
        ("arm", "urdf", "example-robot-data"), ("case", "sdf", "example-robot-data"), ("cart", "mjcf", "robot_descriptions"), ("two", "xacro", "ROS")]
    # The clone of robot_descriptions, named once more.
    monkeypatch.setenv("MENAGERIE_ROOT", str(places / "cache" / "mujoco_menagerie"))
    assert articulated.robots() == found and repr(found[0]).startswith("<articulated.FoundRobot 'arm', urdf of example-robot-data: ")


def test_a_pattern_is_of_the_name_or_of_the_path(places):
    names = lambda pattern: [one.name for one in articulated.robots(pattern)]
    assert names("ARM") == ["arm"] and names("some_cart") == ["cart"] and names("?a??") == ["cart", "case"][::-1]
    with pytest.raises(articulated.RobotError, match="some_"):
        names("some_*")
    with pytest.raises(TypeError, match="pattern: found int"):
        articulated.robots(3)


def test_robots_are_loaded_with_their_packages(places):
    (arm,) = articulated.robots("arm")
    robot = arm.load(gravity=(0, 0, -10))
    # m g r of a pendulum that lies.
    np.testing.assert_allclose(robot.gravity_torque([0.0]), [-2 * 10 * 0.5], rtol=1e-14)
    share = places / "site-packages/cmeel.prefix/share/example-robot-data"
    assert arm.packages == {"example-robot-data": share, "example_robot_descriptions": share}
    assert dict(robot._source.packages)["example-robot-data"] == str(share)
    assert articulated.robots("cart")[0].load().nq == 1
    # $(find other) is in a package beside that of the file.
    assert articulated.robots("two")[0].load().nv == 1
    assert arm.load("floating", packages={"mine": places}).nv == 7
    with pytest.raises(TypeError, match="packages: found list"):
        arm.load(packages=[places])


def test_nothing_is_found(empty, places):
    with pytest.raises(articulated.RobotError) as error:
        articulated.robots("crat")
    text = str(error.value)
    assert "found no robot of 'crat'" in text and "did you mean 'cart'?" in text
    assert f"robot_descriptions: {places / 'cache'}\n" in text and f"{places / 'no_such' / 'share'} (not there)" in text


def test_no_package_is_installed(empty):
    for pattern, found in [(None, "found no robot, "), ("arm", "found no robot of 'arm', ")]:
        with pytest.raises(articulated.RobotError) as error:
            articulated.robots(pattern)
        text = str(error.value)
        assert text.startswith(found) and "pip install example-robot-data" in text and text.count("(not there)") == 3
        assert str(empty / "home" / ".cache" / "robot_descriptions") in text


def installed():
    try:
        return [one for one in articulated.robots() if one.package == "example-robot-data"]
    except articulated.RobotError:
        return []


@pytest.mark.filterwarnings("ignore::articulated.RobotWarning")
@pytest.mark.skipif(not installed(), reason="example-robot-data (pip install example-robot-data) is not installed: no robots of packages")
def test_robots_of_example_robot_data():
    found = installed()
    assert len(found) > 30 and {"panda", "solo12", "hyq_no_sensors", "go2"} <= {one.name for one in found}
    (panda,) = [one for one in found if one.name == "panda"]
    robot = panda.load()
    # One finger follows the other.
    assert (robot.nq, robot.joints[0].name) == (8, "panda_joint1")
    # The table of Denavit-Hartenberg parameters in Franka's manual: 0.333 m to joint 1, 0.316 m and 0.384 m to the elbow and the wrist, 0.088 m and 0.107 m to the flange.
    placement = robot.with_frames(["panda_link8"]).placements(robot.neutral)[0]
    np.testing.assert_allclose(placement[9:], [0.088, 0.0, 0.333 + 0.316 + 0.384 - 0.107], atol=1e-12)
