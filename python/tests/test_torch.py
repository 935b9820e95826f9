"""Derivatives for PyTorch. Skipped where it is not installed."""

import articulated
import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="PyTorch (pip install torch) is not installed: no derivatives for it to test")
import articulated.torch  # noqa: E402
from articulated import _gradients  # noqa: E402

# Fixed; floating; a ball joint; joints that follow others.
ROBOTS = ["double_pendulum", "panda_like", "quadruped", "spinning_top", "gripper_arm"]

# Functions with all kinds of arguments and results; of the others the derivatives are made alike.
NAMES = [
    *("inverse_dynamics", "inverse_dynamics_with_wrenches", "forward_dynamics", "forward_dynamics_with_wrenches", "bias_forces"),
    *("gravity_torque", "static_torque", "placements", "center_of_mass", "potential_energy", "integrate", "difference"),
    *("kinetic_energy", "mass_matrix", "solve_mass_matrix", "twists_world", "centroidal_momentum", "joint_wrenches"),
]


def draw(robot, name, rng, count):
    out = []
    for argument, shape in _gradients.sizes(robot, name)[0]:
        if argument in ("q", "target"):
            q = robot.random_configuration(rng, count)
            # Quaternions of any length.
            out.append(q * rng.uniform(0.7, 1.4) if robot.nq != robot.nv else q)
        else:
            out.append(rng.normal(size=(count, *shape)))
    return [torch.tensor(array, requires_grad=True) for array in out]


@pytest.mark.parametrize("robot", ROBOTS)
@pytest.mark.parametrize("name", NAMES)
def test_gradients_are_those_of_differences(robot, name):
    robot = articulated.bundled(robot)
    robot = robot.with_frames(robot.frames[-2:])
    arguments = draw(robot, name, np.random.default_rng(5), 2)
    function = getattr(articulated.torch, name)
    # Forces of a machine with small inertias are large numbers: differences of their scale.
    scale = 1 / max(1.0, float(function(robot, *arguments).detach().abs().max()))
    assert torch.autograd.gradcheck(lambda *x: scale * function(robot, *x), arguments, eps=1e-6, atol=2e-6, rtol=1e-4)


@pytest.mark.parametrize("reference", ["body", "world", "world_aligned"])
def test_wrenches_in_all_axes(reference):
    robot = articulated.bundled("quadruped", wrenches_in=reference)
    robot = robot.with_frames(robot.frames[-2:])
    for name in ("inverse_dynamics_with_wrenches", "forward_dynamics_with_wrenches", "static_torque"):
        arguments = draw(robot, name, np.random.default_rng(6), 2)
        function = getattr(articulated.torch, name)
        scale = 1 / max(1.0, float(function(robot, *arguments).detach().abs().max()))
        assert torch.autograd.gradcheck(lambda *x: scale * function(robot, *x), arguments, eps=1e-6, atol=2e-6, rtol=1e-4)


def test_batches_broadcast():
    robot = articulated.bundled("panda_like")
    q = torch.tensor(robot.random_configuration(0, 6).reshape(2, 3, 7), requires_grad=True)
    v = torch.zeros(7, dtype=torch.float64, requires_grad=True)
    tau = articulated.torch.bias_forces(robot, q, v, threads=2)
    assert tau.shape == (2, 3, 7)
    np.testing.assert_array_equal(tau.detach().numpy().reshape(6, 7), robot.bias_forces(q.detach().numpy().reshape(6, 7), np.zeros(7)))
    tau.sum().backward()
    assert q.grad.shape == q.shape and v.grad.shape == (7,)
    assert articulated.torch.potential_energy(robot, q[0, 0]).shape == ()


def test_values_at_unit_quaternions_are_the_robot_s():
    robot = articulated.bundled("quadruped")
    q = robot.random_configuration(1)
    np.testing.assert_allclose(articulated.torch.gravity_torque(robot, torch.tensor(q)).numpy(), robot.gravity_torque(q), rtol=0, atol=1e-11)


def test_float32_in_is_float32_out():
    robot = articulated.bundled("panda_like")
    q = torch.tensor(robot.random_configuration(1, 3), dtype=torch.float32, requires_grad=True)
    tau = articulated.torch.gravity_torque(robot, q)
    assert tau.dtype == torch.float32
    tau.sum().backward()
    wide = q.detach().double().requires_grad_()
    articulated.torch.gravity_torque(robot, wide).sum().backward()
    assert q.grad.dtype == torch.float32
    np.testing.assert_allclose(q.grad.numpy(), wide.grad.numpy(), rtol=1e-5, atol=1e-4)
    assert articulated.torch.bias_forces(robot, q, wide).dtype == torch.float64


@pytest.mark.parametrize("robot", ROBOTS)
@pytest.mark.parametrize("name", ["inverse_dynamics", "forward_dynamics", "potential_energy", "placements", "integrate", "mass_matrix"])
def test_second_derivatives_are_those_of_differences(robot, name):
    robot = articulated.bundled(robot)
    robot = robot.with_frames(robot.frames[-1:])
    arguments = draw(robot, name, np.random.default_rng(7), 1)
    function = getattr(articulated.torch, name)
    scale = 1 / max(1.0, float(function(robot, *arguments).detach().abs().max()))
    assert torch.autograd.gradgradcheck(lambda *x: scale * function(robot, *x), arguments, eps=1e-6, atol=5e-6, rtol=1e-4)


def test_the_hessian_of_potential_energy_is_the_derivative_of_gravity_torque():
    robot = articulated.bundled("panda_like")
    q = torch.tensor(robot.random_configuration(1), requires_grad=True)
    found = torch.autograd.functional.hessian(lambda q: articulated.torch.potential_energy(robot, q), q)
    expected = robot.static_torque_derivative(q.detach().numpy(), np.zeros((len(robot.frames), 6)))
    np.testing.assert_allclose(found.numpy(), expected, rtol=0, atol=1e-10)
    (first,) = torch.autograd.grad(articulated.torch.potential_energy(robot, q), q, create_graph=True)
    np.testing.assert_allclose(first.detach().numpy(), robot.gravity_torque(q.detach().numpy()), rtol=1e-12, atol=1e-10)


def test_a_third_derivative_is_an_error_and_not_zero():
    robot = articulated.bundled("panda_like")
    q = torch.tensor(robot.random_configuration(1), requires_grad=True)
    (first,) = torch.autograd.grad(articulated.torch.potential_energy(robot, q), q, create_graph=True)
    (second,) = torch.autograd.grad(first.sum(), q, create_graph=True)
    with pytest.raises(NotImplementedError, match="potential_energy: found a third derivative, expected first and second ones"):
        torch.autograd.grad(second.sum(), q)


def test_bad_calls():
    robot = articulated.bundled("panda_like")
    q = torch.zeros(7, dtype=torch.float64)
    for call, error, message in (
        (lambda: articulated.torch.gravity_torque(robot, q.half()), TypeError, "q: found torch.float16 on cpu"),
        (lambda: articulated.torch.gravity_torque(robot, q[:6]), ValueError, "q: found shape \\(6,\\), expected \\(7,\\)"),
        (lambda: articulated.torch.gravity_torque(robot), TypeError, "gravity_torque: found 0 arguments after the robot, expected 1: q"),
        (lambda: articulated.torch.gravity_torque(robot, q, q=q), TypeError, "gravity_torque: found 'q' by name"),
        (lambda: articulated.torch.gravity_torque(robot, p=q), TypeError, "gravity_torque: found 'p' by name"),
        (lambda: articulated.torch.gravity_torque("panda", q), TypeError, "robot: found str"),
        (lambda: articulated.torch.gravity_torque(robot, "q"), TypeError, "q: found str"),
        (lambda: articulated.torch.gravity_torque(robot, q * float("nan")), ValueError, "q: found nan"),
        (lambda: articulated.torch.bias_forces(robot, q.expand(2, 7), q.expand(3, 7)), ValueError, "do not fit"),
        (lambda: articulated.torch.random_configuration, AttributeError, "found 'random_configuration', which has no derivative here"),
        (lambda: articulated.torch.nothing, AttributeError, "no attribute 'nothing'"),
    ):
        with pytest.raises(error, match=message):
            call()
