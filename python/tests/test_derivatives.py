"""Derivatives by name."""

import articulated
import numpy as np
import pytest


def test_products_agree_from_both_sides():
    rng = np.random.default_rng(0)
    for name in ("panda_like", "quadruped", "gripper_arm"):
        robot = articulated.bundled(name)
        q, (v, a, dq, dv, da, weights) = robot.random_configuration(rng), rng.normal(size=(6, robot.nv))
        pull, push = robot.derivative("vjp(inverse_dynamics)"), robot.derivative("jvp(inverse_dynamics)")
        found = pull(q, v, a, weights)
        assert found._fields == ("grad_q", "grad_v", "grad_a")
        along = push(q, v, a, dq, dv, da)
        np.testing.assert_allclose(weights @ along, found.grad_q @ dq + found.grad_v @ dv + found.grad_a @ da, rtol=1e-10)
        derivatives = robot.inverse_dynamics_derivatives(q, v, a)
        expected = derivatives[0] @ dq + derivatives[1] @ dv + derivatives[2] @ da
        np.testing.assert_allclose(along, expected, rtol=0, atol=1e-11 * np.abs(expected).max())
        rows = robot.derivative("jacobian(inverse_dynamics)")(q, v, a)
        np.testing.assert_allclose(np.stack(rows), derivatives, rtol=0, atol=1e-11 * np.abs(derivatives).max())


def test_batches_broadcast_and_threads_change_nothing():
    robot, rng = articulated.bundled("panda_like"), np.random.default_rng(1)
    q, v = robot.random_configuration(rng, 600), rng.normal(size=7)
    slope = robot.derivative("gradient(kinetic_energy, v)")
    found = slope(q.reshape(20, 30, 7), v)
    assert found.shape == (20, 30, 7)
    np.testing.assert_allclose(found.reshape(600, 7), robot.mass_matrix(q) @ v, rtol=1e-11, atol=1e-12)
    np.testing.assert_array_equal(found, slope(q.reshape(20, 30, 7), v, threads=0))
    assert slope(q[:0], v).shape == (0, 7)


def test_second_derivatives():
    robot, rng = articulated.bundled("quadruped"), np.random.default_rng(2)
    q, dq = robot.random_configuration(rng), rng.normal(size=robot.nv)
    hessian = robot.derivative("hessian(potential_energy)")(q, 1.0)
    np.testing.assert_allclose(hessian, hessian.T, rtol=0, atol=1e-12)
    np.testing.assert_allclose(robot.derivative("hvp(potential_energy)")(q, 1.0, dq), hessian @ dq, rtol=0, atol=1e-10)


@pytest.mark.parametrize("batch", [True, False])
def test_compiled_derivatives_are_those_of_the_trace(batch):
    rng = np.random.default_rng(3)
    for name, states in (("panda_like", 1), ("quadruped", 600)):
        robot = articulated.bundled(name)
        q, (v, a, weights) = robot.random_configuration(rng, states), rng.normal(size=(3, states, robot.nv))
        pull = robot.derivative("vjp(inverse_dynamics)")
        compiled = pull.compile(batch=batch)
        assert compiled.takes == pull.takes and compiled.request == pull.request
        for found, expected in zip(compiled(q, v, a, weights), pull(q, v, a, weights)):
            np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12 * np.abs(expected).max())
        for found, expected in zip(compiled(q, v, a, weights, threads=0), compiled(q, v, a, weights)):
            np.testing.assert_array_equal(found, expected)
        assert [part.shape for part in compiled(q[:0], v[:0], a[:0], weights[:0])] == [(0, robot.nv)] * 3


def test_bad_requests_and_calls():
    robot = articulated.bundled("panda_like")
    q = np.zeros(7)
    slope = robot.derivative("gradient(potential_energy)")
    assert "gradient(potential_energy)" in repr(slope) and slope.takes == (("q", (7,), "rad|m|unit quaternion"),)
    for call, error, message in (
        (lambda: robot.derivative("vjp(inverse_dynamic)"), ValueError, "did you mean `inverse_dynamics`"),
        (lambda: robot.derivative("inverse_dynamics"), ValueError, "expected a derivative"),
        (lambda: robot.derivative("vjp(inverse_dynamics, x)"), ValueError, "expected some of q v a"),
        (lambda: robot.derivative(3), TypeError, "found int"),
        (lambda: robot.compile(["mass_matrix"], derivatives=["vjq"]), ValueError, "derivatives: found 'vjq', expected some of vjp, jvp, hvp"),
        (lambda: robot.compile(["mass_matrix"], derivatives="vjp"), TypeError, "expected a list of names"),
        (lambda: slope.compile(flags="-O3"), TypeError, "flags: found '-O3'"),
        (lambda: slope(), TypeError, "found 0 arguments, expected 1: q"),
        (lambda: slope(q[:6]), ValueError, "q: found shape"),
        (lambda: slope("q"), TypeError, "q: found dtype <U1"),
        (lambda: slope(q * float("nan")), ValueError, "q: found nan"),
    ):
        with pytest.raises(error, match=message):
            call()
