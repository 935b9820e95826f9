"""Rollouts: closed forms, steps by hand, and gradients by differences."""

import numpy as np
import pytest

import articulated

PENDULUM = """<robot name="cart"><link name="base"/><link name="cart"><inertial><mass value="2"/>
<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
<joint name="rail" type="prismatic"><parent link="base"/><child link="cart"/><axis xyz="1 0 0"/>
<limit lower="-9" upper="9" effort="9" velocity="9"/></joint></robot>"""


def test_a_pushed_cart():
    cart = articulated.loads(PENDULUM)
    ends = cart.rollout([0.5], [1.0], np.full((100, 1), 4.0), 0.01, method="rk4")
    t = 0.01 * np.arange(1, 101)[:, None]
    assert np.allclose(ends.q, 0.5 + t + t**2, atol=1e-12) and np.allclose(ends.v, 1 + 2 * t, atol=1e-12)
    few = cart.rollout([0.5], [1.0], np.full((100, 1), 4.0), 0.01, method="rk4", every=30)
    assert few.q.shape == (3, 1) and np.array_equal(few.q, ends.q[29::30])


@pytest.fixture(scope="module", params=["panda_like", "quadruped"])
def robot(request):
    return articulated.bundled(request.param)


def start(robot, count, steps):
    random = np.random.default_rng(5)
    q = robot.random_configuration(1, count)
    return q, random.uniform(-1, 1, (count, robot.nv)), random.uniform(-1, 1, (count, steps, robot.nv))


def test_steps_in_threads_are_steps_by_hand(robot):
    q, v, tau = start(robot, 6, 5)
    one = robot.rollout(q, v, tau, 1e-3)
    assert all(np.array_equal(a, b) for a, b in zip(one, robot.rollout(q, v, tau, 1e-3, threads=0)))
    assert all(np.array_equal(a[2], b) for a, b in zip(one, robot.rollout(q[2], v[2], tau[2], 1e-3)))
    # A first step by hand, of joints that are plain numbers.
    plain = slice(robot.nv - 3, robot.nv)
    a = robot.forward_dynamics(q, v, tau[:, 0])
    expected = v[:, plain] + 1e-3 * a[:, plain]
    assert np.allclose(one.v[:, 0, plain], expected, atol=1e-13)
    assert np.allclose(one.q[:, 0, -3:], q[:, -3:] + 1e-3 * expected, atol=1e-13)
    # The same torques for all, and the same state for all torques.
    assert robot.rollout(q, v, tau[0], 1e-3).q.shape == (6, 5, robot.nq)
    assert robot.rollout(q[0], v[0], tau, 1e-3).v.shape == (6, 5, robot.nv)


@pytest.mark.parametrize("method", ["semi_implicit_euler", "implicit_damping", "rk4"])
def test_gradients_are_differences(robot, method):
    q, v, tau = start(robot, 2, 4)
    random = np.random.default_rng(6)
    weights = random.uniform(-1, 1, (2, 4, robot.nv))
    places = random.uniform(-1, 1, (2, 4, robot.nv))
    ends = robot.rollout(q, v, tau, 1e-2, method=method)

    def cost(q, v, tau):
        found = robot.rollout(q, v, tau, 1e-2, method=method)
        return (weights * found.v).sum() + (places * robot.difference(ends.q, found.q)).sum()

    gradient = robot.rollout_gradient(q, v, tau, 1e-2, weights_q=places, weights_v=weights, method=method)
    step = 1e-6
    along = [random.uniform(-1, 1, x.shape) for x in gradient]

    def moved(by):
        return robot.integrate(q, by * along[0]), v + by * along[1], tau + by * along[2]

    expected = (cost(*moved(step)) - cost(*moved(-step))) / (2 * step)
    found = sum((one * other).sum() for one, other in zip(gradient, along))
    assert abs(found - expected) < 1e-6 * max(1, abs(expected)), (found, expected)


def test_what_is_wrong_is_told(robot):
    q, v, tau = start(robot, 2, 3)
    for arguments, options, text in [
        ((q, v, tau, 1e-3), {"method": "rk5"}, "method: found \"rk5\", expected one of semi_implicit_euler"),
        ((q, v, tau, 0.0), {}, "h: found 0.0, expected a positive"),
        ((q, v, tau, 1e-3), {"every": 0}, "every: found 0"),
        ((q[:, 1:], v, tau, 1e-3), {}, "q: found shape"),
        ((q, v, tau[..., 1:], 1e-3), {}, "tau: found shape"),
        ((q, v, np.zeros((3, 3, robot.nv)), 1e-3), {}, "dimensions of a batch that do not fit"),
        ((q, v * np.nan, tau, 1e-3), {}, "v: found nan"),
    ]:
        with pytest.raises(ValueError, match=text.replace("[", r"\[")):
            robot.rollout(*arguments, **options)
    with pytest.raises(ValueError, match="weights_q: found shape"):
        robot.rollout_gradient(q, v, tau, 1e-3, weights_q=np.zeros(2))


SERVO = b"""<mujoco model="cart"><option timestep="0.004"/><worldbody><body name="cart">
<joint name="x" type="slide" axis="1 0 0"/><inertial pos="0 0 0" mass="2" diaginertia="1 1 1"/>
<body name="bob"><joint name="turn" type="hinge" axis="0 1 0"/><inertial pos="0 0 -0.4" mass="0.5" diaginertia="0.02 0.02 0.01"/></body>
</body></worldbody><actuator><position name="servo" joint="x" kp="40" kv="3" timeconst="0.1" ctrlrange="-1 1"/>
<motor name="spin" joint="turn"/></actuator></mujoco>"""


def test_controls_of_a_file():
    robot = articulated.loads(SERVO)
    assert [(one.name, one.upper, one.has_activation) for one in robot.actuators] == [("servo", 1.0, True), ("spin", np.inf, False)]
    random = np.random.default_rng(3)
    q, v, act = (random.uniform(-1, 1, (5, n)) for n in (2, 2, 1))
    ctrl = random.uniform(-0.9, 0.9, (5, 40, 2))
    ends = robot.actuated_rollout(q, v, ctrl, 0.004, act=act, threads=0)
    assert ends.q.shape == (5, 40, 2) and ends.act.shape == (5, 40, 1)
    # The exact filter with a held control, by hand.
    w = act
    for k in range(40):
        w = ctrl[:, k, :1] + (w - ctrl[:, k, :1]) * np.exp(-0.004 / 0.1)
        assert np.allclose(ends.act[:, k], w, atol=1e-14)
    # A first step: (M + h D) Δv = h (τ − h(q, v)), D = kv of the servo.
    tau = np.stack([40 * (act[:, 0] - q[:, 0]) - 3 * v[:, 0], ctrl[:, 0, 1]], axis=-1)
    matrix = robot.mass_matrix(q) + 0.004 * np.diag([3.0, 0.0])
    a = np.linalg.solve(matrix, (tau - robot.bias_forces(q, v))[..., None])[..., 0]
    assert np.allclose(ends.v[:, 0], v + 0.004 * a, atol=1e-13)
    assert np.array_equal(robot.actuated_rollout(q[1], v[1], ctrl[1], 0.004, act=act[1]).v, ends.v[1])
    # Gradients by differences.
    weights = [random.uniform(-1, 1, (5, 40, n)) for n in (2, 2, 1)]
    labels = {"weights_q": weights[0], "weights_v": weights[1], "weights_act": weights[2]}
    gradient = robot.actuated_rollout_gradient(q, v, ctrl, 0.004, act=act, **labels)
    along = [random.uniform(-1, 1, x.shape) for x in gradient]

    def cost(by):
        found = robot.actuated_rollout(
            q + by * along[0], v + by * along[1], ctrl + by * along[3], 0.004, act=act + by * along[2]
        )
        return sum((one * other).sum() for one, other in zip(found, weights))

    expected = (cost(1e-6) - cost(-1e-6)) / 2e-6
    found = sum((one * other).sum() for one, other in zip(gradient, along))
    assert abs(found - expected) < 1e-6 * max(1, abs(expected)), (found, expected)


def test_what_is_wrong_with_controls_is_told(robot):
    with pytest.raises(ValueError, match="has no actuators"):
        robot.actuated_rollout(robot.neutral, np.zeros(robot.nv), np.zeros((3, 1)), 1e-3)
    cart = articulated.loads(SERVO)
    for ctrl, options, text in [
        (np.zeros((3, 1)), {}, "ctrl: found shape"),
        (np.zeros((3, 2)), {"act": np.zeros(3)}, "act: found shape"),
        (np.zeros((3, 2)), {"method": "rk5"}, "method: found \"rk5\", expected one of semi_implicit_euler"),
    ]:
        with pytest.raises(ValueError, match=text):
            cart.actuated_rollout([0, 0], [0, 0], ctrl, 1e-3, **options)


DAMPED = """<mujoco><worldbody><body><joint name="x" type="slide" axis="1 0 0" damping="3" armature="0.5"/>
<geom size="0.1" mass="1.5"/></body></worldbody><actuator><motor name="push" joint="x"/></actuator></mujoco>"""


def test_forces_of_the_file_act_or_are_a_warning():
    with pytest.warns(articulated.RobotWarning, match="armature, damping in the file"):
        free = articulated.loads(DAMPED, "cart.xml").actuated_rollout([0.0], [1.0], [[0.0]], 0.01)
    assert free.v[0, 0] == 1.0
    cart = articulated.loads(DAMPED, "cart.xml", effects="file")
    # (m + I + h d) a = −d v
    expected = 1 - 0.01 * 3 / (2.0 + 0.01 * 3)
    assert abs(cart.actuated_rollout([0.0], [1.0], [[0.0]], 0.01).v[0, 0] - expected) < 1e-15
    assert abs(cart.mass_matrix([0.0])[0, 0] - 2.0) < 1e-15
    with pytest.raises(ValueError, match="effects: found 'all', expected \"file\" or None"):
        articulated.loads(DAMPED, "cart.xml", effects="all")


def test_states_of_mujoco():
    robot = articulated.loads(
        """<mujoco><worldbody><body><freejoint/><geom size="0.1"/><body pos="0.3 0 0"><joint type="ball"/><geom size="0.1"/>
        <body pos="0.3 0 0"><joint axis="0 1 0"/><geom size="0.1"/></body></body></body></worldbody></mujoco>""",
        "m.xml",
    )
    q, v = robot.random_configuration(3, 4), np.random.default_rng(1).uniform(-1, 1, (2, 4, robot.nv))
    qpos, qvel = robot.mujoco_state(q, v)
    assert qpos.shape == (2, 4, robot.nq) and qvel.shape == (2, 4, robot.nv)
    assert np.array_equal(qpos[1][:, [0, 1, 2, 4, 5, 6, 3, 8, 9, 10, 7, 11]], q)
    x, y, z, w = q[0, 3:7]
    turn = np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])
    assert np.allclose(qvel[1, 0, :3], turn @ v[1, 0, 3:6], atol=1e-14) and np.array_equal(qvel[..., 3:6], v[..., :3])
    back = robot.state_of_mujoco(qpos, qvel)
    assert np.array_equal(back.q[0], q) and np.allclose(back.v, v, atol=1e-15)
    with pytest.raises(ValueError, match=r"qvel: found shape \(3,\), expected \(10,\)"):
        robot.state_of_mujoco(qpos, [0.0] * 3)


BALL = b"""<mujoco model="ball"><option timestep="0.005"/><worldbody>
<geom name="floor" type="plane" size="1 1 1" condim="1" solimp="0.9 0.9 0.001"/>
<body name="ball" pos="0 0 0.3"><freejoint/><geom type="sphere" size="0.1" mass="2" condim="1" solimp="0.9 0.9 0.001"/></body>
</worldbody></mujoco>"""


def test_a_ball_comes_to_rest_on_its_floor():
    robot = articulated.loads(BALL)
    q = np.array([0.0, 0, 0.3, 0, 0, 0, 1])
    ends = robot.constrained_rollout(q, np.zeros(6), np.zeros((600, 0)), 0.005, every=100)
    assert ends.q.shape == (6, 7) and ends.act.shape == (6, 0)
    # At rest (1 − d) g = k d² p, with k = 1/(d² 0.02²)
    assert abs(ends.q[-1, 2] - (0.1 - 0.1 * 9.81 * 0.02**2)) < 1e-9
    with pytest.raises(ValueError, match='method: found "rk4", expected one of semi_implicit_euler, '):
        robot.constrained_rollout(q, np.zeros(6), np.zeros((1, 0)), 0.005, method="rk4")
    with pytest.raises(articulated.RobotError, match="constrained_rollout: found no limit"):
        articulated.loads(BALL.replace(b"condim", b"contype='0' conaffinity='0' condim")).constrained_rollout(q, np.zeros(6), np.zeros((1, 0)), 0.005)
    egg = BALL.replace(b'type="plane" size="1 1 1"', b'type="ellipsoid" size="0.1 0.1 0.2"')
    with pytest.raises(articulated.RobotError, match="leave_out"):
        articulated.loads(egg).constrained_rollout(q, np.zeros(6), np.zeros((1, 0)), 0.005)


def test_given_contacts_are_those_that_are_computed():
    names = BALL.replace(b'type="sphere"', b'name="round" type="sphere"')
    computed, robot = articulated.loads(names), articulated.loads(names, given_contacts=[("floor", "round", 2)])
    assert robot.given_contacts == [("floor", "round")] * 2 and computed.given_contacts == [] and robot.contact_shapes == []
    q, v = np.array([0.1, 0.2, 0.099, 0, 0, 0, 1]), np.array([0, 0, 0, 0.1, 0, -0.2])
    contacts, warm = np.zeros((2, 8)), None
    for _ in range(5):
        low = q[2] - 0.1
        contacts[0] = [low < 0, low, q[0], q[1], low / 2, 0, 0, 1]
        own = robot.constrained_step(q, v, None, 0.005, contacts=contacts, warm=warm)
        expected = computed.constrained_step(q, v, None, 0.005, warm=warm)
        for one, other in zip(own, expected):
            np.testing.assert_allclose(one, other, rtol=0, atol=1e-12)
        q, v, _, warm = own
    ends = computed.constrained_rollout(np.array([0.1, 0.2, 0.099, 0, 0, 0, 1]), np.array([0, 0, 0, 0.1, 0, -0.2]), np.zeros((5, 0)), 0.005)
    np.testing.assert_allclose(q, ends.q[-1], rtol=0, atol=1e-12)
    named = computed.constrained_step(q, v, None, 0.005, method="constrained_step_implicit_damping")
    np.testing.assert_array_equal(named.q, computed.constrained_step(q, v, None, 0.005).q)
    # Without contacts it falls; many states have a row each.
    free = robot.constrained_step(np.tile(q, (2, 3, 1)), v, None, 0.005)
    assert free.q.shape == (2, 3, 7) and free.warm.shape == (2, 3, 6) and abs(free.v[0, 0, 5] - (v[5] - 9.81 * 0.005)) < 1e-12
    with pytest.raises(ValueError, match="given_contacts: found 2 contacts"):
        robot.constrained_rollout(q, v, np.zeros((1, 0)), 0.005)
    with pytest.raises(ValueError, match="contacts: found contacts, expected a robot"):
        computed.constrained_step(q, v, None, 0.005, contacts=contacts)
    with pytest.raises(ValueError, match="contacts: found shape"):
        robot.constrained_step(q, v, None, 0.005, contacts=contacts[:1, :7])
    with pytest.raises(ValueError, match='method: found "rk4_mujoco", expected one of semi_implicit_euler, '):
        robot.constrained_step(q, v, None, 0.005, method="rk4_mujoco")
    with pytest.raises(TypeError, match="given_contacts: found"):
        articulated.loads(names, given_contacts=["floor"])
    with pytest.raises(articulated.RobotError, match="no pair of the geoms"):
        articulated.loads(names, given_contacts=[("floor", "cube")])


SLIDER = b"""<mujoco><option cone="elliptic"/><worldbody><geom type="plane" size="1 1 1"/>
  <body pos="0 0 0.1"><joint name="x" type="slide" axis="1 0 0"/><joint name="z" type="slide" axis="0 0 1"/><joint name="turn" axis="0 1 0" armature="0.01"/>
    <geom size="0.1" mass="1" friction="0.5"/></body></worldbody>
  <actuator><motor joint="x"/><motor joint="z"/></actuator></mujoco>"""


def test_gradients_through_contacts_are_those_of_differences():
    robot, random, h = articulated.loads(SLIDER, effects="file"), np.random.default_rng(4), 0.002
    q, v, ctrl = np.array([0.2, -7e-4, 0.0]), np.array([0.3, -0.1, 0.0]), np.column_stack([random.uniform(5, 9, 12), random.uniform(-3, 0, 12)])
    by_q, by_v = random.normal(size=(2, 12, 3))

    def value(q, v, ctrl):
        ends = robot.constrained_rollout(q, v, ctrl, h)
        return (by_q * ends.q).sum() + (by_v * ends.v).sum()

    for method in ("implicit_damping", "rk4_mujoco"):
        gradient = robot.constrained_rollout_gradient(q, v, ctrl, h, weights_q=by_q, weights_v=by_v, method=method)
        if method == "rk4_mujoco":
            assert np.isfinite(gradient.v).all() and np.abs(gradient.ctrl).max() > 0
            continue
        for own, given in ((gradient.q, 0), (gradient.v, 1), (gradient.ctrl, 2)):
            start = [q, v, ctrl]
            for place in np.ndindex(start[given].shape):
                ends = []
                for by in (1e-6, -1e-6):
                    moved = [one.copy() for one in start]
                    moved[given][place] += by
                    ends.append(value(*moved))
                assert abs((ends[0] - ends[1]) / 2e-6 - own[place]) < 1e-5 * max(1.0, np.abs(own).max()), (given, place)


def test_bundled_robots_stand():
    robot = articulated.bundled("landing_quadruped")
    assert robot.nv == 18 and len(robot.actuators) == 12
    # It rests on its feet: their forces carry it.
    q = np.concatenate([[0, 0, 0.2917], [0, 0, 0, 1], [0, 0.8, -1.6] * 4])
    stance = np.array([0, 0.8, -1.6] * 4)
    with pytest.warns(articulated.RobotWarning, match="effects"):
        ends = robot.constrained_rollout(q, np.zeros(18), np.tile(stance, (1500, 1)), 0.002, every=1500)
    found = robot.contact_forces(ends.q[-1], ends.v[-1], stance)
    assert found.acts.sum() == 4 and found.force.shape == (len(robot.contact_shapes), 3) and found.relative_error < 1e-12
    assert abs(found.force.sum(axis=0)[2] / (15.2 * 9.81) - 1) < 1e-2 and (found.force[~found.acts] == 0).all()
    assert all("floor" in robot.contact_shapes[k] for k in np.flatnonzero(found.acts))
    many = robot.contact_forces(np.tile(ends.q[-1], (2, 3, 1)), np.zeros(18), stance)
    assert many.acts.shape == (2, 3, len(robot.contact_shapes)) and many.search_steps.shape == (2, 3)
    with pytest.raises(ValueError, match="q: found shape"):
        robot.contact_forces(q[:-1], np.zeros(18))
    scene = articulated.Scene("quadruped_lands")
    summary = scene.run(end=1.0).summary
    assert summary["constraints"]["most_contacts"] == 4 and summary["constraints"]["largest_relative_error"] < 1e-10
    with pytest.raises(articulated.RobotError, match="simulation.law"):
        scene.run(integrator="dopri5")
