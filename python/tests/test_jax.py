"""Derivatives for JAX. Skipped where it is not installed."""

import articulated
import numpy as np
import pytest

jax = pytest.importorskip("jax", reason="JAX (pip install jax) is not installed: no derivatives for it to test")
jax.config.update("jax_enable_x64", True)
import articulated.jax  # noqa: E402
from articulated import _gradients  # noqa: E402

ROBOTS = ["double_pendulum", "panda_like", "quadruped", "spinning_top", "gripper_arm"]

# Functions with all kinds of arguments and results; of the others the derivatives are made alike.
NAMES = [
    *("inverse_dynamics", "inverse_dynamics_with_wrenches", "forward_dynamics", "forward_dynamics_with_wrenches", "bias_forces"),
    *("gravity_torque", "static_torque", "placements", "center_of_mass", "potential_energy", "integrate", "difference"),
    *("kinetic_energy", "mass_matrix", "solve_mass_matrix", "twists_world", "centroidal_momentum", "joint_wrenches"),
]


def draw(robot, name, rng):
    out = []
    for argument, shape in _gradients.sizes(robot, name)[0]:
        if argument in ("q", "target"):
            q = robot.random_configuration(rng)
            # Quaternions of any length.
            out.append(q * rng.uniform(0.7, 1.4) if robot.nq != robot.nv else q)
        else:
            out.append(rng.normal(size=shape))
    return out


def differences(function, arguments, k):
    """∂(function)/∂(argument k) by central differences, and their error."""
    out = []
    for h in (1e-5, 2e-5):
        columns = []
        for index in np.ndindex(arguments[k].shape):
            step = np.zeros(arguments[k].shape)
            step[index] = h
            values = [np.asarray(function(*arguments[:k], arguments[k] + sign * step, *arguments[k + 1 :])) for sign in (1, -1)]
            columns.append((values[0] - values[1]) / (2 * h))
        out.append(np.stack(columns, axis=-1).reshape(columns[0].shape + arguments[k].shape))
    better = (4 * out[0] - out[1]) / 3
    return better


@pytest.mark.parametrize("robot", ROBOTS)
@pytest.mark.parametrize("name", NAMES)
def test_jacobians_are_those_of_differences(robot, name):
    robot = articulated.bundled(robot)
    robot = robot.with_frames(robot.frames[-2:])
    arguments = draw(robot, name, np.random.default_rng(5))
    function = lambda *x: getattr(articulated.jax, name)(robot, *x)  # noqa: E731
    value = lambda *x: _gradients.value(robot, name, None, x)  # noqa: E731
    np.testing.assert_array_equal(function(*arguments), value(*arguments))
    found = jax.jacrev(function, argnums=tuple(range(len(arguments))))(*arguments)
    for k, jacobian in enumerate(found):
        expected = differences(value, arguments, k)
        assert jacobian.shape == expected.shape
        np.testing.assert_allclose(jacobian, expected, rtol=0, atol=1e-7 * max(1.0, np.abs(expected).max()))


@pytest.mark.parametrize("robot", ROBOTS)
@pytest.mark.parametrize("name", ["forward_dynamics", "placements", "integrate"])
def test_forward_mode_is_reverse_mode(robot, name):
    robot = articulated.bundled(robot)
    robot = robot.with_frames(robot.frames[-2:])
    arguments = draw(robot, name, np.random.default_rng(6))
    function = lambda *x: getattr(articulated.jax, name)(robot, *x)  # noqa: E731
    every = tuple(range(len(arguments)))
    for forward, reverse in zip(jax.jacfwd(function, every)(*arguments), jax.jacrev(function, every)(*arguments)):
        np.testing.assert_allclose(forward, reverse, rtol=0, atol=1e-9 * max(1.0, np.abs(reverse).max()))
    directions = [np.ones_like(x) for x in arguments]
    _, along = jax.jvp(function, arguments, directions)
    steps = sum(jax.jacrev(function, every)(*arguments)[k].reshape(*along.shape, -1).sum(axis=-1) for k in every)
    np.testing.assert_allclose(along, steps, rtol=0, atol=1e-9 * max(1.0, np.abs(along).max()))


def test_forward_mode_nests_in_batches():
    robot, rng = articulated.bundled("panda_like"), np.random.default_rng(3)
    q, v = robot.random_configuration(rng, 5), rng.normal(size=(5, 7))
    function = lambda q, v: articulated.jax.bias_forces(robot, q, v)  # noqa: E731
    forward = jax.vmap(jax.jacfwd(function, argnums=1))(q, v)
    reverse = jax.vmap(jax.jacrev(function, argnums=1))(q, v)
    np.testing.assert_allclose(forward, reverse, rtol=0, atol=1e-10)
    seven = jax.vmap(jax.jacfwd(function), in_axes=(None, 0))(q[0], rng.normal(size=(7, 7)))
    assert seven.shape == (7, 7, 7)


def test_hessians_are_those_of_differences():
    for name in ("panda_like", "spinning_top"):
        robot = articulated.bundled(name)
        energy = lambda q, v: articulated.jax.kinetic_energy(robot, q, v) + articulated.jax.potential_energy(robot, q)  # noqa: E731
        q, v = draw(robot, "kinetic_energy", np.random.default_rng(2))
        found = jax.hessian(energy, argnums=(0, 1))(q, v)
        gradient = lambda k: lambda *x: jax.grad(energy, argnums=k)(*x)  # noqa: E731
        for k in range(2):
            for i in range(2):
                expected = differences(gradient(k), [q, v], i)
                np.testing.assert_allclose(found[k][i], expected, rtol=0, atol=1e-7 * max(1.0, np.abs(expected).max()))


def test_other_second_derivatives_are_errors_and_not_zero():
    robot = articulated.bundled("panda_like")
    energy = lambda q: articulated.jax.potential_energy(robot, q)  # noqa: E731
    for twice in (jax.jacrev(jax.jacrev(energy)), jax.jacfwd(jax.jacfwd(energy))):
        with pytest.raises((NotImplementedError, ValueError)):
            twice(robot.neutral)


def test_batches_and_transformations():
    robot = articulated.bundled("panda_like")
    rng = np.random.default_rng(0)
    q, v, tau = robot.random_configuration(rng, 6), rng.normal(size=(6, 7)), rng.normal(size=(6, 7))
    expected = robot.forward_dynamics(q, v, tau)
    function = lambda q, v, tau: articulated.jax.forward_dynamics(robot, q, v, tau, threads=2)  # noqa: E731
    for found in (function(q, v, tau), jax.vmap(function)(q, v, tau), jax.jit(jax.vmap(function))(q, v, tau)):
        np.testing.assert_array_equal(found, expected)
    np.testing.assert_array_equal(articulated.jax.forward_dynamics(robot, q, tau=tau, v=v), expected)
    one = jax.vmap(function, in_axes=(0, None, None))(q, v[0], tau[0])
    np.testing.assert_array_equal(one, robot.forward_dynamics(q, v[0], tau[0]))
    gradient = jax.jit(jax.grad(lambda *x: function(*x).sum(), argnums=(0, 1, 2)))(q, v[0], tau[0])
    assert [part.shape for part in gradient] == [(6, 7), (7,), (7,)]
    derivatives = robot.forward_dynamics_derivatives(q, v[0], tau[0])
    np.testing.assert_allclose(gradient[0], derivatives[:, 0].sum(axis=1), rtol=1e-12, atol=1e-9)
    np.testing.assert_allclose(gradient[1], derivatives[:, 1].sum(axis=(0, 1)), rtol=1e-12, atol=1e-9)
    nested = jax.vmap(jax.vmap(function))(q.reshape(2, 3, 7), v.reshape(2, 3, 7), tau.reshape(2, 3, 7))
    np.testing.assert_array_equal(nested.reshape(6, 7), expected)


def test_compiled_functions_and_single_precision():
    import os
    import shutil

    robot = articulated.bundled("panda_like")
    q = robot.random_configuration(1)
    if shutil.which(os.environ.get("CC", "cc").split()[0]):
        compiled = robot.compile(["gravity_torque", "inverse_dynamics_derivatives"])
        run = lambda of: jax.jacrev(lambda q: articulated.jax.gravity_torque(of, q))(q)  # noqa: E731
        np.testing.assert_allclose(run(compiled), run(robot), rtol=0, atol=1e-10)
        compiled = robot.compile(["gravity_torque"], batch=True, derivatives=["vjp", "jvp"])
        assert set(compiled._derivatives) == {("vjp", "gravity_torque"), ("jvp", "gravity_torque")}
        np.testing.assert_allclose(run(compiled), run(robot), rtol=0, atol=1e-10)
    with jax.enable_x64(False) if hasattr(jax, "enable_x64") else jax.experimental.disable_x64():
        tau = articulated.jax.gravity_torque(robot, q)
        assert tau.dtype == np.float32
        np.testing.assert_allclose(tau, robot.gravity_torque(q.astype(np.float32)), rtol=1e-6, atol=1e-5)


def test_bad_calls():
    robot = articulated.bundled("panda_like")
    q = np.zeros(7)
    for call, error, message in (
        (lambda: articulated.jax.gravity_torque(robot, q[:6]), ValueError, "q: found shape \\(6,\\), expected \\(7,\\)"),
        (lambda: articulated.jax.gravity_torque(robot), TypeError, "gravity_torque: found 0 arguments after the robot, expected 1: q"),
        (lambda: articulated.jax.gravity_torque(robot, q, q=q), TypeError, "gravity_torque: found 'q' by name"),
        (lambda: articulated.jax.gravity_torque(robot, p=q), TypeError, "gravity_torque: found 'p' by name"),
        (lambda: articulated.jax.gravity_torque("panda", q), TypeError, "robot: found str"),
        (lambda: articulated.jax.gravity_torque(robot, q * 1j), TypeError, "q: found dtype complex128"),
        (lambda: articulated.jax.bias_forces(robot, np.zeros((2, 7)), np.zeros((3, 7))), ValueError, "do not fit"),
        (lambda: articulated.jax.random_configuration, AttributeError, "found 'random_configuration', which has no derivative here"),
    ):
        with pytest.raises(error, match=message):
            call()
