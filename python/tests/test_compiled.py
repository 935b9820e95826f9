"""Functions of one robot, generated as C and compiled by the system's compiler."""

import os
import shutil

import articulated
import numpy as np
import pytest
from test_functions import FUNCTIONS, draw, size

CHOSEN = ["inverse_dynamics", "mass_matrix", "forward_dynamics", "placements", "kinetic_energy", "integrate", "static_torque"]
needs_compiler = pytest.mark.skipif(shutil.which(os.environ.get("CC", "cc").split()[0]) is None, reason="no C compiler on this system")


@pytest.fixture(autouse=True)
def own_cache(tmp_path_factory, monkeypatch):
    monkeypatch.setenv("ARTICULATED_CACHE", str(tmp_path_factory.getbasetemp() / "cache"))


@needs_compiler
@pytest.mark.parametrize("name", ["panda_like", "quadruped"])
def test_compiled_functions_are_the_library_s(name):
    robot = articulated.bundled(name, gravity=(0.5, -1, -9))
    compiled = robot.compile(CHOSEN)
    assert compiled.functions == tuple(CHOSEN) and name in repr(compiled)
    for function in (f for f in FUNCTIONS if f.name in CHOSEN):
        arguments = draw(robot, function, np.random.default_rng(3), 37)
        expected, method = getattr(robot, function.name)(*arguments), getattr(compiled, function.name)
        near = 1e-10 * max(1.0, np.abs(expected).max())
        found = method(*arguments)
        assert found.shape == (37, *(size(robot, dim) for dim in function.gives))
        np.testing.assert_allclose(found, expected, rtol=0, atol=near)
        for threads in (0, 2, 5, 64):
            np.testing.assert_array_equal(method(*arguments, threads=threads), found)
        one = method(*(argument[3] for argument in arguments))
        assert isinstance(one, float) if function.gives == () else one.shape == found.shape[1:]
        np.testing.assert_allclose(one, found[3], rtol=0, atol=near)
        if len(arguments) > 1:
            mixed = [arguments[0], *(argument[5] for argument in arguments[1:])]
            np.testing.assert_array_equal(method(*mixed)[5], found[5])
        assert method(*(argument[:0] for argument in arguments), threads=2).shape == (0, *found.shape[1:])
    with pytest.raises(ValueError, match="q: found shape"):
        compiled.mass_matrix(np.zeros(3))
    with pytest.raises(TypeError, match="missing 1 required"):
        compiled.mass_matrix()
    with pytest.raises(ValueError, match="threads: found -1"):
        compiled.mass_matrix(robot.neutral, threads=-1)
    assert "q: (nq,)" in compiled.mass_matrix.__doc__


@needs_compiler
def test_an_object_of_the_cache_that_is_not_whole_is_compiled_again():
    robot = articulated.bundled("simple_pendulum")
    expected = robot.gravity_torque([0.3])
    path = robot.compile(["gravity_torque"]).path
    for damage in (lambda: path.write_bytes(path.read_bytes()[:200]), lambda: path.write_bytes(b""), lambda: path.with_suffix(".sha256").unlink()):
        # In a new file: this process has the old one open.
        whole = path.read_bytes()
        path.unlink()
        path.write_bytes(whole)
        damage()
        assert robot.compile(["gravity_torque"]).path == path
        np.testing.assert_allclose(robot.compile(["gravity_torque"]).gravity_torque([0.3]), expected, rtol=1e-14)


@needs_compiler
@pytest.mark.skipif(os.name != "posix", reason="modes of folders are those of POSIX")
def test_a_folder_that_others_may_write_to_is_refused(tmp_path, monkeypatch):
    monkeypatch.setenv("ARTICULATED_CACHE", str(tmp_path / "cache"))
    (tmp_path / "cache").mkdir()
    (tmp_path / "cache").chmod(0o777)
    with pytest.raises(RuntimeError, match="mode 777, expected one of this user that others cannot write to: chmod go-w"):
        articulated.bundled("simple_pendulum").compile(["gravity_torque"])
    assert not list((tmp_path / "cache").iterdir())


def test_the_key_has_the_processor_where_code_is_for_it_alone():
    from articulated import _compiled

    assert _compiled.processor(("-O3",)) is None and _compiled.processor(("-march=native",))


@needs_compiler
def test_compiled_functions_take_float32_and_out():
    robot = articulated.bundled("panda_like")
    compiled = robot.compile(["gravity_torque", "potential_energy"])
    q = robot.random_configuration(1, 4).astype(np.float32)
    tau = compiled.gravity_torque(q)
    assert tau.dtype == np.float32 and compiled.potential_energy(q[0]).dtype == np.float32
    np.testing.assert_array_equal(tau, compiled.gravity_torque(q.astype(float)).astype(np.float32))
    out = np.empty_like(tau)
    assert compiled.gravity_torque(q, out=out) is out
    np.testing.assert_array_equal(out, tau)
    with pytest.raises(ValueError, match=r"out: found float64 of shape \(4, 7\), expected a writable array of float32"):
        compiled.gravity_torque(q, out=np.empty((4, 7)))
    with pytest.raises(AttributeError, match="no attribute 'gravity_torqe'; did you mean 'gravity_torque'"):
        compiled.gravity_torqe
    with pytest.raises(AttributeError, match="no attribute 'mass_matrix'"):
        compiled.mass_matrix


@needs_compiler
def test_compiled_robots_are_kept(monkeypatch):
    robot = articulated.bundled("simple_pendulum")
    first = robot.compile(["gravity_torque"])
    changed = first.path.stat().st_mtime_ns
    assert robot.compile(["gravity_torque"]).path == first.path and first.path.stat().st_mtime_ns == changed
    assert robot.with_gravity((0, 0, -1)).compile(["gravity_torque"]).path != first.path
    assert robot.compile(["gravity_torque"], flags=["-O1"]).path != first.path


@needs_compiler
def test_what_a_compiler_refuses():
    with pytest.raises(RuntimeError, match="compile: the C compiler refused"):
        articulated.bundled("simple_pendulum").compile(["gravity_torque"], flags=["-no-such-option"])


def test_no_compiler_and_bad_names(monkeypatch):
    robot = articulated.bundled("panda_like")
    for bad, error, message in (("mass_matrix", TypeError, "functions: found 'mass_matrix', expected a list"),
                                (["mas_matrix"], ValueError, "did you mean 'mass_matrix'"), ([], ValueError, "functions: found none"),
                                ([1], TypeError, "functions: found int"), (None, TypeError, "functions: found NoneType")):
        with pytest.raises(error) as found:
            robot.compile(bad)
        assert message in str(found.value)
    monkeypatch.setenv("CC", "no-such-compiler")
    with pytest.raises(RuntimeError, match="compile: found no C compiler 'no-such-compiler', expected one on the path"):
        robot.compile(["mass_matrix"])


@needs_compiler
def test_functions_that_the_robot_does_not_have():
    with pytest.raises(articulated.RobotError) as error:
        articulated.bundled("panda_like").compile(["operational_space_inertia"])
    assert error.value.diagnostics[0]["code"] == "bound_frames"


@needs_compiler
@pytest.mark.parametrize("batch", [False, True])
def test_functions_of_many_states(batch):
    """With and without code for many states at once: the library's values, which threads and neighbours do not change."""
    robot = articulated.bundled("panda_like")
    names = ["inverse_dynamics", "forward_dynamics", "mass_matrix", "kinetic_energy", "integrate"]
    compiled, rng = robot.compile(names, batch=batch), np.random.default_rng(4)
    for function in (f for f in FUNCTIONS if f.name in names):
        arguments = draw(robot, function, rng, 203)
        method, expected = getattr(compiled, function.name), getattr(robot, function.name)(*arguments)
        near = 1e-10 * max(1.0, np.abs(expected).max())
        found = method(*arguments)
        np.testing.assert_allclose(found, expected, rtol=0, atol=near)
        for first, end in ((0, 1), (3, 4), (5, 70), (64, 203)):
            np.testing.assert_array_equal(method(*(argument[first:end] for argument in arguments), threads=2), found[first:end])
        for kept in range(len(arguments)):
            mixed = [argument if k == kept else argument[7] for k, argument in enumerate(arguments)]
            same = [argument if k == kept else np.repeat(argument[7:8], 203, axis=0) for k, argument in enumerate(arguments)]
            np.testing.assert_array_equal(method(*mixed), method(*same))


@needs_compiler
def test_code_for_many_states_is_there_if_it_is_asked_for():
    from articulated import _compiled

    robot = articulated.bundled("panda_like")
    rows = [function for function in FUNCTIONS if function.name == "inverse_dynamics"]
    alone, batch = ("".join(text for _, text in _compiled.sources(robot, rows, is_batch)) for is_batch in (False, True))
    assert "inverse_dynamics_batch_f64(states" in batch and "batch_f64" not in alone
