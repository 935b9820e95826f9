"""Every function of the table: shapes, batches, threads."""

import copy
import pickle
import threading

import articulated
import numpy as np
import pytest

FUNCTIONS = articulated.functions()
ROBOTS = {"fixed": ("panda_like", None), "floating": ("quadruped", None), "mimic": ("gripper_arm", None), "ball": ("spinning_top", None)}


@pytest.fixture(scope="module", params=ROBOTS)
def robot(request):
    name, frames = ROBOTS[request.param]
    return articulated.bundled(name, frames=frames)


def size(robot, dimension):
    sizes = {"nq": robot.nq, "nv": robot.nv, "frames": len(robot.frames), "links": len(robot.links)}
    return sizes.get(dimension, dimension)


def draw(robot, function, rng, count):
    """Arguments of ``count`` states."""
    out = []
    for name, dims, _ in function.takes:
        if name in ("q", "target"):
            out.append(robot.random_configuration(rng, count))
        else:
            shape = (count, *(size(robot, dim) for dim in dims))
            out.append(rng.random(shape) if name == "uniform" else rng.normal(size=shape))
    return out


def method(robot, function, arguments, **options):
    if function.name == "random_configuration":
        return robot.random_configuration(uniform=arguments[0], **options)
    return getattr(robot, function.name)(*arguments, **options)


def defined(robot, function):
    """The robot with such frames that the function is defined, or None."""
    if function.name != "operational_space_inertia":
        return robot
    free = [name for name in robot.frames if np.linalg.matrix_rank(robot.with_frames([name]).jacobians_body(robot.random_configuration(3))[0]) == 6]
    return robot.with_frames(free) if free else None


@pytest.mark.parametrize("function", FUNCTIONS, ids=lambda f: f.name)
def test_shapes_batches_and_threads(robot, function):
    robot = defined(robot, function)
    if robot is None:
        with pytest.raises(articulated.RobotError, match="fewer than six degrees of freedom"):
            articulated.bundled("gripper_arm").operational_space_inertia([0.0] * articulated.bundled("gripper_arm").nq)
        return
    arguments = draw(robot, function, np.random.default_rng(7), 65)
    shape = tuple(size(robot, dim) for dim in function.gives)
    many = method(robot, function, arguments)
    assert many.shape == (65, *shape) and many.dtype == np.float64 and many.flags.c_contiguous
    assert np.isfinite(many).all()
    for state in (0, 1, 64):
        one = method(robot, function, [argument[state] for argument in arguments])
        assert isinstance(one, float) if shape == () else one.shape == shape
        np.testing.assert_array_equal(one, many[state])
    for threads in (None, 0, 1, 2, 3):
        np.testing.assert_array_equal(method(robot, function, arguments, threads=threads), many)
    # By name, and with one argument for all states.
    np.testing.assert_array_equal(robot.call(function.name, *arguments), many)
    if len(arguments) > 1:
        mixed = [arguments[0], *(argument[5] for argument in arguments[1:])]
        same = [arguments[0], *(np.repeat(argument[5:6], 65, axis=0) for argument in arguments[1:])]
        np.testing.assert_array_equal(method(robot, function, mixed, threads=2), method(robot, function, same))
    none = method(robot, function, [argument[:0] for argument in arguments], threads=2)
    assert none.shape == (0, *shape)


@pytest.mark.parametrize("function", FUNCTIONS, ids=lambda f: f.name)
def test_methods_have_signature_and_documentation(function):
    import inspect

    parameters = list(inspect.signature(getattr(articulated.Robot, function.name)).parameters)
    if function.name != "random_configuration":
        assert parameters == ["self", *(name for name, _, _ in function.takes), "threads", "out"]
    documentation = getattr(articulated.Robot, function.name).__doc__
    assert all(f"{name}: (" in documentation for name, _, _ in function.takes) and "Returns:" in documentation


def test_names_of_arguments(robot):
    q, v = robot.random_configuration(0), np.ones(robot.nv)
    np.testing.assert_array_equal(robot.bias_forces(v=v, q=q), robot.bias_forces(q, v))


def test_other_numbers_and_layouts():
    robot = articulated.bundled("panda_like")
    q = robot.random_configuration(1, 6)
    expected = robot.gravity_torque(q)
    buffer = bytearray(q.nbytes + 1)
    unaligned = np.frombuffer(buffer, dtype=np.float64, count=q.size, offset=1).reshape(q.shape)
    unaligned[:] = q
    frozen = q.copy()
    frozen.flags.writeable = False
    same = [np.asfortranarray(q), np.repeat(q, 2, axis=1)[:, ::2], q[::-1][::-1], q.tolist(), q.astype(">f8"), unaligned, frozen,
            np.ma.masked_array(q), [list(row) for row in q], q.astype(np.longdouble)]
    for other in same:
        np.testing.assert_array_equal(robot.gravity_torque(other), expected)
    whole = np.arange(7)
    for dtype in (np.int8, np.uint16, np.int64, np.float16):
        np.testing.assert_array_equal(robot.gravity_torque(whole.astype(dtype)), robot.gravity_torque(whole.astype(float)))
    np.testing.assert_array_equal(q, robot.random_configuration(1, 6))


@pytest.mark.parametrize("name", ["panda_like", "quadruped"])
def test_float32_in_is_float32_out(name):
    robot = articulated.bundled(name)
    for function in FUNCTIONS:
        if function.name == "random_configuration" and robot.nq != robot.nv:
            continue
        arguments = draw(robot, function, np.random.default_rng(7), 5)
        if not arguments or function.name == "operational_space_inertia":
            continue
        single = [argument.astype(np.float32) for argument in arguments]
        expected = method(robot, function, [argument.astype(np.float64) for argument in single])
        found = method(robot, function, single)
        assert found.dtype == np.float32 and found.shape == expected.shape
        scale = np.abs(expected).max()
        assert not scale or np.abs(found - expected).max() <= 2e-3 * scale, function.name
        one = method(robot, function, [argument[2] for argument in single])
        np.testing.assert_array_equal(one, found[2])
        assert one.dtype == np.float32
        # Beside one of float64 all are.
        mixed = method(robot, function, [single[0].astype(np.float64), *single[1:]])
        assert mixed.dtype == np.float64
        np.testing.assert_array_equal(mixed, expected)
    # Computed in float32, not rounded to it.
    tau = robot.gravity_torque(robot.random_configuration(0, 40).astype(np.float32))
    assert (tau != robot.gravity_torque(robot.random_configuration(0, 40).astype(np.float32).astype(float)).astype(np.float32)).any()


def test_a_result_goes_to_an_array_of_the_caller():
    robot = articulated.bundled("panda_like")
    q = robot.random_configuration(3, 6)
    expected = robot.inverse_dynamics(q, q, q)
    out = np.full((6, 7), np.nan)
    assert robot.inverse_dynamics(q, q, q, threads=2, out=out) is out
    np.testing.assert_array_equal(out, expected)
    one = np.empty(7)
    assert robot.inverse_dynamics(q[1], q[1], a=q[1], out=one) is one
    np.testing.assert_array_equal(one, expected[1])
    # A part of a larger array; one number; float32.
    whole = np.zeros((2, 6, 7))
    robot.inverse_dynamics(q, q, q, out=whole[1])
    np.testing.assert_array_equal(whole, [np.zeros((6, 7)), expected])
    energy = np.empty(())
    assert robot.potential_energy(q[0], out=energy) is energy and energy == robot.potential_energy(q[0])
    single = np.empty((6, 7), np.float32)
    assert robot.gravity_torque(q.astype(np.float32), out=single) is single
    frozen = np.empty(7)
    frozen.flags.writeable = False
    for wrong, error, message in (
        (np.empty((7, 6)), ValueError, r"out: found shape \(7, 6\), expected a writable array of float64, of shape \(6, 7\) in C order"),
        (np.empty((7, 6)).T, ValueError, "out: found an array in another order"),
        (np.empty((6, 7), np.float32), TypeError, "out: found an array of float32, expected"),
        ([[0.0] * 7] * 6, TypeError, "out: found <class 'list'>, expected"),
        (q, ValueError, "out: found"),
    ):
        with pytest.raises(error, match=message):
            robot.inverse_dynamics(q, q, q, out=wrong)
    with pytest.raises(ValueError, match="out: found"):
        robot.gravity_torque(q[0], out=frozen)
    # An argument stays as it was.
    np.testing.assert_array_equal(q, robot.random_configuration(3, 6))


def test_a_batch_may_have_several_dimensions_which_broadcast():
    robot = articulated.bundled("quadruped")
    robot = robot.with_frames(robot.frames[-2:])
    q, v = robot.random_configuration(0, (2, 3)), np.random.default_rng(1).normal(size=(3, robot.nv))
    assert q.shape == (2, 3, robot.nq)
    tau = robot.bias_forces(q, v, threads=2)
    flat = robot.bias_forces(q.reshape(6, -1), np.tile(v, (2, 1)))
    np.testing.assert_array_equal(tau, flat.reshape(2, 3, robot.nv))
    np.testing.assert_array_equal(robot.bias_forces(q[:, :1], v)[1, 2], robot.bias_forces(q[1, 0], v[2]))
    assert robot.placements(q).shape == (2, 3, 2, 12) and robot.potential_energy(q).shape == (2, 3)
    assert robot.placements_matrices(q).shape == (2, 3, 2, 4, 4)
    assert robot.bias_forces(q[:, :0], v[0]).shape == (2, 0, robot.nv)
    with pytest.raises(ValueError, match=r"v: found dimensions \(4,\) of a batch, expected those of q, \(2, 3\), or some that broadcast"):
        robot.bias_forces(q, np.zeros((4, robot.nv)))


def test_a_misspelt_function_has_a_nearest_name():
    robot = articulated.bundled("panda_like")
    with pytest.raises(AttributeError, match="'Robot' object has no attribute 'mass_matrx'; did you mean 'mass_matrix'?"):
        robot.mass_matrx
    with pytest.raises(AttributeError, match="has no attribute '__nothing__'$"):
        robot.__nothing__
    assert not hasattr(robot, "quite_another")


def test_an_argument_may_be_given_twice_and_results_are_new():
    robot = articulated.bundled("panda_like")
    q = robot.random_configuration(2)
    first = robot.inverse_dynamics(q, q, q)
    second = robot.inverse_dynamics(q, q.copy(), q.copy())
    np.testing.assert_array_equal(first, second)
    assert first is not second and first.flags.owndata and first.flags.writeable


def test_the_largest_and_the_smallest_numbers_go_through():
    robot = articulated.bundled("quadruped")
    for number in (1e308, 5e-324):
        for function in FUNCTIONS:
            if function.name != "operational_space_inertia":
                arguments = [np.full(argument.shape, number) for argument in draw(robot, function, np.random.default_rng(0), 2)]
                assert method(robot, function, arguments).shape[0] == 2


def test_calls_as_methods_of_a_class():
    robot = articulated.bundled("panda_like")
    q, v = robot.random_configuration(0), np.ones(7)
    expected = robot.inverse_dynamics(q, v, v)
    unbound = articulated.Robot.inverse_dynamics
    for found in (unbound(robot, q, v, v), unbound(robot, q=q, v=v, a=v), robot.inverse_dynamics(q, a=v, v=v, threads=2)):
        np.testing.assert_array_equal(found, expected)
    with pytest.raises(TypeError):
        unbound("robot", q, v, v)
    with pytest.raises(TypeError):
        unbound()
    assert "inverse_dynamics" in repr(unbound)


def test_threads_of_python_share_a_robot():
    robot = articulated.bundled("quadruped")
    q = robot.random_configuration(3, 200)
    expected, found = robot.mass_matrix(q), {}

    def work(index):
        for _ in range(20):
            found[index] = robot.mass_matrix(q, threads=2 if index % 2 else None)

    workers = [threading.Thread(target=work, args=(index,)) for index in range(8)]
    [worker.start() for worker in workers]
    [worker.join() for worker in workers]
    assert len(found) == 8
    for value in found.values():
        np.testing.assert_array_equal(value, expected)


FORK = """
import os, articulated, numpy as np
robot = articulated.bundled("panda_like")
q = robot.random_configuration(4, 500)
expected = robot.gravity_torque(q, threads=2)
child = os.fork()
if child == 0:
    os._exit(0 if np.array_equal(robot.gravity_torque(q, threads=2), expected) else 1)
assert os.waitpid(child, 0)[1] == 0
"""


@pytest.mark.skipif(not hasattr(__import__("os"), "fork"), reason="no fork on this system")
def test_a_forked_process_has_threads_of_its_own():
    import subprocess
    import sys

    # In a process of its own: other libraries of this one have threads that do not survive a fork.
    subprocess.run([sys.executable, "-W", "ignore::DeprecationWarning", "-c", FORK], check=True, timeout=120)


def test_copies():
    robot = articulated.bundled("panda_like", frames=["link_7"], gravity=(1, 2, 3))
    for other in (copy.copy(robot), copy.deepcopy(robot), pickle.loads(pickle.dumps(robot))):
        assert repr(other) == repr(robot) and other.frames == ("link_7",)
        q = robot.random_configuration(5)
        np.testing.assert_array_equal(other.gravity_torque(q), robot.gravity_torque(q))
