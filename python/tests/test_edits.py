"""Robots with joints held, loads, and other robots on them; external wrenches in other axes."""

import pickle
import warnings

import articulated
import numpy as np
import pytest

ROBOT = articulated.bundled("panda_like")
GRIPPER = """<robot name="gripper"><link name="palm"><inertial><mass value="0.5"/><inertia ixx="1e-3" ixy="0" ixz="0" iyy="1e-3" iyz="0" izz="1e-3"/>
</inertial></link><link name="finger"><inertial><origin xyz="0 0 0.02"/><mass value="0.1"/><inertia ixx="1e-4" ixy="0" ixz="0" iyy="1e-4" iyz="0" izz="1e-4"/>
</inertial></link><joint name="grip" type="prismatic"><parent link="palm"/><child link="finger"/><axis xyz="0 1 0"/>
<limit lower="0" upper="0.04" effort="10" velocity="1"/></joint></robot>"""


def test_a_locked_joint_leaves_the_coordinates():
    name = ROBOT.joints[3].name
    held = ROBOT.lock(name, -0.4)
    assert held.nq == held.nv == 6 and name not in [joint.name for joint in held.joints] and held.frames == ROBOT.frames
    rest = [k for k in range(7) if k != 3]
    rng = np.random.default_rng(0)
    q, v, a = ROBOT.random_configuration(rng), rng.normal(size=7), rng.normal(size=7)
    q[3], v[3], a[3] = -0.4, 0, 0
    near = dict(rtol=0, atol=1e-12)
    np.testing.assert_allclose(held.inverse_dynamics(q[rest], v[rest], a[rest]), ROBOT.inverse_dynamics(q, v, a)[rest], **near)
    np.testing.assert_allclose(held.placements(q[rest]), ROBOT.placements(q), **near)
    both = ROBOT.lock({ROBOT.joints[0].name: 0.1, ROBOT.joints[6].name: np.array([0.2])})
    assert both.nv == 5 and ROBOT.lock(ROBOT.joints[0].name, 0.1).lock(ROBOT.joints[6].name, [0.2]).nv == 5


def test_a_load_adds_its_weight():
    q = ROBOT.random_configuration(1)
    loaded = ROBOT.payload("link_7", 2.0, (0.0, 0.1, 0.2))
    assert loaded.moving_mass == pytest.approx(ROBOT.moving_mass + 2)
    frame = ROBOT.placements_matrices(q)[ROBOT.frames.index("link_7")]
    jacobian = ROBOT.jacobians_world(q)[ROBOT.frames.index("link_7")]
    place, force = frame[:3, :3] @ [0.0, 0.1, 0.2] + frame[:3, 3], np.array([0, 0, -2 * 9.81])
    wrench = np.concatenate([np.cross(place, force), force])
    np.testing.assert_allclose(loaded.gravity_torque(q), ROBOT.gravity_torque(q) - jacobian.T @ wrench, rtol=0, atol=1e-10)
    point = ROBOT.payload("link_7", 2.0)
    body = ROBOT.payload("link_7", 2.0, inertia=np.diag([0.1, 0.2, 0.25]))
    six = ROBOT.payload("link_7", 2.0, inertia=[0.1, 0, 0, 0.2, 0, 0.25])
    np.testing.assert_array_equal(body.mass_matrix(q), six.mass_matrix(q))
    assert np.linalg.eigvalsh(body.mass_matrix(q) - point.mass_matrix(q)).min() > -1e-12


def test_a_gripper_is_appended(tmp_path):
    gripper = articulated.loads(GRIPPER, name="gripper.urdf")
    both = ROBOT.append(gripper, "link_7", "left_", (0, 0, 0.1), (0, 0, 0.5))
    assert both.nv == 8 and both.joints[-1].name == "left_grip" and {"left_palm", "left_finger"} <= set(both.frames)
    path = tmp_path / "gripper.urdf"
    path.write_text(GRIPPER)
    q = both.random_configuration(0)
    np.testing.assert_array_equal(ROBOT.append(path, at="link_7", prefix="left_", position=(0, 0, 0.1), rpy=(0, 0, 0.5)).placements(q), both.placements(q))
    # Edits are made in one order, whatever the order of calls: append, load, lock.
    held = both.lock("left_grip", 0.02).payload("left_palm", 0.1)
    other = both.payload("left_palm", 0.1).lock("left_grip", 0.02)
    np.testing.assert_array_equal(held.mass_matrix(q[:7]), other.mass_matrix(q[:7]))
    with pytest.raises(ValueError, match="other: found a robot with edits"):
        ROBOT.append(held, "link_7")


def test_edits_are_kept():
    robot = ROBOT.lock(ROBOT.joints[0].name, 0.3).payload("link_7", 1.0).with_gravity((0, 1, -5)).with_frames(["link_7"]).with_wrenches_in("world")
    q = robot.random_configuration(0)
    for other in (pickle.loads(pickle.dumps(robot)), robot.with_gravity((0, 0, 0)).with_gravity((0, 1, -5))):
        assert (other.nv, other.frames, other.wrenches_in, other.gravity.tolist()) == (6, ("link_7",), "world", [0, 1, -5])
        np.testing.assert_array_equal(other.gravity_torque(q), robot.gravity_torque(q))
    assert robot.lock(robot.joints[0].name).nv == 5 and robot.lock(robot.joints[0].name).frames == ("link_7",)


def test_wrenches_in_other_axes():
    q = ROBOT.random_configuration(2)
    wrenches = np.random.default_rng(0).normal(size=(len(ROBOT.frames), 6))
    for reference in ("body", "world", "world_aligned"):
        robot = ROBOT.with_wrenches_in(reference)
        assert robot.wrenches_in == reference and articulated.bundled("panda_like", wrenches_in=reference).wrenches_in == reference
        jacobians = robot.call(f"jacobians_{reference}", q)
        expected = robot.gravity_torque(q) - np.einsum("fij,fi->j", jacobians, wrenches)
        np.testing.assert_allclose(robot.static_torque(q, wrenches), expected, rtol=0, atol=1e-10)


@pytest.mark.parametrize("edit, error, message", [
    (lambda r: r.lock("no_such"), articulated.RobotError, "no_such"),
    (lambda r: r.lock("joint_1", [0, 0]), articulated.RobotError, "joint_1"),
    (lambda r: r.lock("joint_1", np.nan), ValueError, "at: found [nan], expected finite numbers"),
    (lambda r: r.lock(3), TypeError, "joint: found int, expected a name"),
    (lambda r: r.lock("joint_1", "x"), TypeError, "at: found dtype <U1"),
    (lambda r: r.payload("no_such", 1.0), articulated.RobotError, "no_such"),
    (lambda r: r.payload("link_7", -1.0), articulated.RobotError, ""),
    (lambda r: r.payload("link_7", np.inf), ValueError, "mass: found inf, expected a finite number"),
    (lambda r: r.payload("link_7", 1.0, (0, 0)), ValueError, "center_of_mass: found shape (2,)"),
    (lambda r: r.payload("link_7", 1.0, inertia=np.zeros((2, 2))), ValueError, "inertia: found shape (2, 2)"),
    (lambda r: r.payload("link_7", 1.0, inertia=np.arange(9.0).reshape(3, 3)), ValueError, "inertia: found a matrix that is not symmetric"),
    (lambda r: r.append("no_such.urdf", "link_7"), articulated.RobotError, "no_such.urdf"),
    (lambda r: r.append(3, "link_7"), TypeError, "other: found int, expected the name of a file"),
    (lambda r: r.append(articulated.loads(GRIPPER), "no_such"), articulated.RobotError, "no_such"),
    (lambda r: r.append(articulated.loads(GRIPPER), "link_7", position=(0, 0)), ValueError, "position: found shape (2,)"),
    (lambda r: r.append(r, "link_7"), articulated.RobotError, ""),
    (lambda r: r.with_wrenches_in("wordl"), ValueError, "wrenches_in: found 'wordl', expected \"body\", \"world\" or \"world_aligned\""),
])
def test_bad_edits(edit, error, message):
    with pytest.raises(error) as found:
        edit(ROBOT)
    assert message in str(found.value)


def test_warnings_of_edits_are_new_ones():
    odd = GRIPPER.replace('ixx="1e-4"', 'ixx="9"')
    with pytest.warns(articulated.RobotWarning):
        gripper = articulated.loads(odd)
    with pytest.warns(articulated.RobotWarning) as caught:
        ROBOT.append(gripper, "link_7")
    assert caught[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        gripper.lock("grip", 0.01)


def test_a_joint_follows_others():
    urdf = """<robot name="wrist"><link name="base"/>
      <link name="a"/><joint name="m1" type="continuous"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/></joint>
      <link name="b"/><joint name="m2" type="continuous"><parent link="base"/><child link="b"/><axis xyz="0 0 1"/></joint>
      <link name="hand"><inertial><mass value="2"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="3"/></inertial></link>
      <joint name="pitch" type="continuous"><parent link="base"/><child link="hand"/><axis xyz="0 0 1"/></joint></robot>"""
    robot = articulated.loads(urdf)
    coupled = robot.couple("pitch", {"m1": 0.5, "m2": -0.25}, offset=0.1)
    assert (robot.nv, coupled.nv) == (3, 2)
    np.testing.assert_allclose(coupled.mass_matrix([0.3, 0.4]), 3 * np.outer([0.5, -0.25], [0.5, -0.25]), rtol=0, atol=1e-15)
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(coupled)).mass_matrix([0.3, 0.4]), coupled.mass_matrix([0.3, 0.4]))
    # 3 f′², with f′ = 0.5 + 0.4 (q − 0.1) + 0.6 (q − 0.1)²
    bent = robot.couple("pitch", "m1", polynomial=[0.3, 0.5, 0.2, 0.2], reference=0.1)
    slope = 0.5 + 0.4 * 0.3 + 0.6 * 0.3**2
    np.testing.assert_allclose(bent.mass_matrix([0.4, 0.0]), [[3 * slope**2, 0], [0, 0]], rtol=0, atol=1e-14)
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(bent)).mass_matrix([0.3, 0.4]), bent.mass_matrix([0.3, 0.4]))
    with pytest.raises(ValueError, match="found 6 coefficients"):
        robot.couple("pitch", "m1", polynomial=[0.0] * 6)
    with pytest.raises(ValueError, match=r"expected polynomial\[0\]"):
        robot.couple("pitch", "m1", offset=0.1, polynomial=[0.0, 1.0])
    with pytest.raises(TypeError, match="leaders: found dict, expected the name of one joint"):
        robot.couple("pitch", {"m1": 1.0}, polynomial=[0.0, 1.0])
    with pytest.raises(articulated.RobotError, match="did you mean"):
        robot.couple("pitch", {"m3": 1})
    with pytest.raises(TypeError, match="leaders: found list, expected a dict"):
        robot.couple("pitch", ["m1"])
    with pytest.raises(ValueError, match=r"leaders\['m1'\]: found nan, expected a finite number"):
        robot.couple("pitch", {"m1": float("nan")})
    with pytest.raises(ValueError, match="found a robot with edits"):
        robot.append(coupled, "hand", "other_")


def test_options_of_the_reader():
    link = '<link name="{}"><inertial><mass value="1"/>{}<inertia ixx="{}" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>'
    joint = '<joint name="j" type="continuous"><parent link="base"/><child link="tip"/><axis xyz="0 0 1"/><origin rpy="0 1.5707 0"/></joint>'

    def robot_of(second, ixx):
        return f'<robot name="r"><link name="base"/>{link.format("tip", second, ixx)}{joint}</robot>'

    plain, unphysical, twice = robot_of("", 1), robot_of("", -1), robot_of("<mass value='2'/>", 1)
    newer = plain.replace("<robot ", '<robot version="1.7" ')
    allowed = ((unphysical, "allow_unphysical_inertia"), (twice, "first_of_duplicates"), (newer, "allow_unknown_version"))
    for text, option in allowed:
        with pytest.raises(articulated.RobotError, match=f"key `{option}`"):
            articulated.loads(text)
        with pytest.warns(articulated.RobotWarning):
            robot = articulated.loads(text, **{option: True})
        assert robot.mass_matrix([0.2]).tolist() == [[1.0]]
        with pytest.raises(TypeError, match=f"{option}: found int, expected True or False"):
            articulated.loads(text, **{option: 1})
    cloth = "<mujoco><worldbody><body><joint/><geom size='.1'/></body><flexcomp name='cloth' type='grid'/></worldbody></mujoco>"
    with pytest.raises(articulated.RobotError, match="found a flexible body .*cloth.*key `leave_out`"):
        articulated.loads(cloth, name="cloth.xml")
    with pytest.warns(articulated.RobotWarning, match="found a flexible body"):
        assert articulated.loads(cloth, name="cloth.xml", leave_out=["flex"]).nv == 1
    with pytest.raises(ValueError, match='leave_out: found "flexible", expected flex, composite, plugin, constraint, solver or contact'):
        articulated.loads(cloth, name="cloth.xml", leave_out=["flexible"])
    with pytest.warns(articulated.RobotWarning, match="1.5707"):
        articulated.loads(plain, snap_angles=1e-3)
    with pytest.raises(articulated.RobotError, match="snap_angles: found 0.7"):
        articulated.loads(plain, snap_angles=0.7)
    with pytest.raises(articulated.RobotError, match="coupling: found \"file\", and the robot's file has no equations that joints can follow"):
        articulated.loads(plain, coupling="file")
    with pytest.raises(ValueError, match='coupling: found {}, expected "file" or None'):
        articulated.loads(twice, coupling={})
