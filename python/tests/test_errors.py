"""Every kind of bad call is one clear error, and none ends the process."""

import warnings
from decimal import Decimal

import articulated
import numpy as np
import pytest

ROBOT = articulated.bundled("panda_like")
Q = ROBOT.random_configuration(0)


@pytest.mark.parametrize("q, error, message", [
    (np.zeros(6), ValueError, "q: found shape (6,), expected (7,) for one state or (N, 7) for N states"),
    (np.zeros((7, 2)), ValueError, "q: found shape (7, 2), expected (7,)"),
    (np.zeros((2, 3, 6)), ValueError, "q: found shape (2, 3, 6)"),
    (0.5, ValueError, "q: found shape (), expected (7,)"),
    ([], ValueError, "q: found shape (0,)"),
    ([[0.0] * 7, [0.0] * 6], ValueError, "q: found no rectangular array"),
    (np.zeros(7, complex), TypeError, "q: found dtype complex128, expected real numbers"),
    (np.zeros(7, bool), TypeError, "q: found dtype bool"),
    (np.array([None] * 7), TypeError, "q: found objects (ndarray), expected real numbers"),
    (None, TypeError, "q: found objects (NoneType), expected real numbers"),
    (object(), TypeError, "q: found objects (object)"),
    ([Decimal(1)] * 7, TypeError, "q: found objects (list)"),
    ("0" * 7, TypeError, "q: found dtype <U7"),
    ([b"a"] * 7, TypeError, "q: found dtype |S1"),
    (np.zeros(7, "datetime64[s]"), TypeError, "q: found dtype datetime64[s]"),
    (np.zeros(7, [("x", float)]), TypeError, "q: found dtype"),
    (np.ma.masked_array(np.zeros(7), [True] + [False] * 6), TypeError, "masked"),
    ({"q": 1}, TypeError, "q: found objects (dict)"),
])
def test_bad_arguments(q, error, message):
    for threads in (None, 2):
        with pytest.raises(error) as found:
            ROBOT.gravity_torque(q, threads=threads)
        assert message in str(found.value)


@pytest.mark.parametrize("bad, shown", [(np.nan, "nan"), (np.inf, "inf"), (-np.inf, "-inf")])
def test_numbers_that_are_not_finite(bad, shown):
    for at in range(7):
        q = Q.copy()
        q[at] = bad
        with pytest.raises(ValueError) as error:
            ROBOT.gravity_torque(q)
        assert str(error.value) == f"q: found {shown} at [{at}], expected finite numbers"
    v = np.zeros((40, 7))
    v[33, 2] = bad
    for threads in (None, 2):
        with pytest.raises(ValueError) as error:
            ROBOT.bias_forces(Q, v, threads=threads)
        assert str(error.value) == f"v: found {shown} at [33, 2], expected finite numbers"
    with pytest.raises(ValueError, match="target: found .* at \\[0, 3\\]"):
        ROBOT.difference(Q, [[0.0] * 3 + [bad] + [0.0] * 3])


def test_numbers_of_states():
    with pytest.raises(ValueError) as error:
        ROBOT.inverse_dynamics(np.zeros((4, 7)), np.zeros(7), np.zeros((5, 7)))
    assert str(error.value) == "a: found 5 states, expected 4 as in q, or one state for all of them"
    with pytest.raises(ValueError, match="v: found 3 states, expected 4 as in q"):
        ROBOT.bias_forces(np.zeros((4, 7)), np.zeros((3, 7)))


def test_wrenches():
    frames = len(ROBOT.frames)
    with pytest.raises(ValueError) as error:
        ROBOT.static_torque(Q, np.zeros(6 * frames))
    assert str(error.value) == f"wrenches: found shape ({6 * frames},), expected ({frames}, 6) for one state or (N, {frames}, 6) for N states"


def test_numbers_of_arguments():
    with pytest.raises(TypeError, match="missing 1 required positional argument: 'a'"):
        ROBOT.inverse_dynamics(Q, Q)
    with pytest.raises(TypeError, match="takes 4 positional arguments but 5"):
        ROBOT.inverse_dynamics(Q, Q, Q, Q)
    with pytest.raises(TypeError, match="unexpected keyword argument 'w'"):
        ROBOT.inverse_dynamics(Q, Q, w=Q)
    with pytest.raises(TypeError, match="inverse_dynamics: found 1 arguments, expected 3: q, v, a"):
        ROBOT.call("inverse_dynamics", Q)
    with pytest.raises(ValueError, match="did you mean 'mass_matrix'"):
        ROBOT.call("mas_matrix", Q)
    for bad in (3, None, ["mass_matrix"]):
        with pytest.raises(ValueError, match="name: found"):
            ROBOT.call(bad, Q)


@pytest.mark.parametrize("threads, error", [(-1, ValueError), (1025, ValueError), (10**30, ValueError), (1.0, TypeError), ("all", TypeError), (True, TypeError), ([], TypeError)])
def test_bad_threads(threads, error):
    with pytest.raises(error, match="threads: found .*, expected None or 1 for one thread"):
        ROBOT.gravity_torque(Q, threads=threads)


def test_numpy_integers_are_threads():
    np.testing.assert_array_equal(ROBOT.gravity_torque(Q, threads=np.int64(2)), ROBOT.gravity_torque(Q))


def test_functions_that_are_not_defined():
    with pytest.raises(articulated.RobotError) as error:
        ROBOT.operational_space_inertia(Q)
    assert error.value.diagnostics[0]["code"] == "bound_frames" and "frames=" in str(error.value)
    assert ROBOT.with_frames(["link_7"]).operational_space_inertia(Q).shape == (1, 6, 6)
    massless = articulated.loads('<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="continuous">'
                                 '<parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint></robot>')
    for name, code in (("forward_dynamics", "singular_mass_matrix"), ("center_of_mass", "no_mass")):
        arguments = [[0.0]] * len(next(f for f in articulated.functions() if f.name == name).takes)
        with pytest.raises(articulated.RobotError) as error:
            massless.call(name, *arguments)
        assert error.value.diagnostics[0]["code"] == code
    still = articulated.loads('<robot name="r"><link name="a"/></robot>')
    assert (still.nq, still.gravity_torque([]).shape, still.mass_matrix(np.zeros((3, 0))).shape) == (0, (0,), (3, 0, 0))


class Hostile:
    """An array's interface that fails."""

    def __array__(self, *_args, **_options):
        raise RuntimeError("no array here")


def test_conversions_that_fail():
    with pytest.raises(TypeError, match="q: found Hostile \\(no array here\\)"):
        ROBOT.gravity_torque(Hostile())


def test_more_than_memory_holds():
    q = np.broadcast_to(np.zeros(7), (10**15, 7))
    with pytest.raises(MemoryError):
        ROBOT.gravity_torque(q)
    with pytest.raises(MemoryError):
        ROBOT.with_frames([]).random_configuration(0, 10**15)
    # Memory for the arguments, but not for the results.
    empty = articulated.loads('<robot name="r"><link name="a"/></robot>', frames=["a"] * 1000)
    with pytest.raises((MemoryError, ValueError)):
        empty.placements(np.zeros((10**15, 0)))


def test_no_call_ends_the_process():
    rng = np.random.default_rng(1)
    dtypes = ["f8", "f4", "f2", "i4", "u1", "?", "c16", "O", "U3", "S2", ">f8", "M8[s]", "g"]
    robots = [articulated.bundled(name) for name in ("panda_like", "quadruped", "spinning_top")]
    outcomes = {}
    for _ in range(4000):
        robot = robots[rng.integers(len(robots))]
        function = articulated.functions()[rng.integers(len(articulated.functions()))]
        arguments = []
        sizes = [0, 1, 2, 3, 6, robot.nq, robot.nv, len(robot.frames)]
        count = int(rng.integers(0, 4))
        for _, dims, _ in function.takes[: None if rng.random() < 0.9 else -1]:
            if rng.random() < 0.6:
                named = {"nq": robot.nq, "nv": robot.nv, "frames": len(robot.frames), "links": len(robot.links)}
                shape = tuple(named.get(dim, dim) for dim in dims)
                shape = shape if rng.random() < 0.5 else (count, *shape)
            else:
                shape = tuple(int(rng.choice(sizes)) for _ in range(rng.integers(0, 4)))
            dtype = dtypes[0 if rng.random() < 0.5 else rng.integers(len(dtypes))]
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                array = np.zeros(shape, dtype) if dtype[-1] in "OUS]" else (rng.normal(size=shape) * 10.0 ** rng.integers(-3, 3)).astype(dtype)
            if array.ndim > 1 and rng.random() < 0.3:
                array = np.asfortranarray(array) if rng.random() < 0.5 else array[::-1]
            arguments.append(array)
        threads = [None, 0, 1, 2, 5, -1][rng.integers(6)]
        try:
            robot.call(function.name, *arguments, threads=threads)
            outcome = "ok"
        except (ValueError, TypeError) as error:
            outcome = type(error).__name__
            assert str(error)
        outcomes[outcome] = outcomes.get(outcome, 0) + 1
    assert outcomes["ok"] > 400 and outcomes["ValueError"] > 400 and outcomes["TypeError"] > 400
