"""Wheels of one robot, installed without articulated."""

import json
import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import articulated
import numpy as np
import pytest
from articulated.__main__ import wheel

pytestmark = pytest.mark.skipif(shutil.which(os.environ.get("CC", "cc").split()[0]) is None, reason="no C compiler on this system")

# Runs where neither articulated nor a compiler is to be found.
CLIENT = """
import sys

class Absent:
    def find_spec(self, name, *_):
        if name.split(".")[0] == "articulated":
            raise ImportError("not here")

sys.meta_path.insert(0, Absent())
sys.path.insert(0, sys.argv[1])
import os
os.environ["PATH"] = ""
import numpy as np
import quadruped as robot

data = np.load(sys.argv[2])
q, v, a = data["q"], data["v"], data["a"]
out = {
    "tau": robot.inverse_dynamics(q, v, a),
    "tau_threads": robot.inverse_dynamics(q, v=v[3], a=a[3], threads=3),
    "one": robot.inverse_dynamics(q[0], v[0], a[0]),
    "mass": robot.mass_matrix(q.tolist(), threads=0),
    "energy": robot.kinetic_energy(q, v),
    "none": robot.mass_matrix(q[:0]),
    "lower": robot.LOWER,
}
assert isinstance(robot.kinetic_energy(q[0], v[0]), float)
assert (robot.NQ, robot.NV, robot.BASE, robot.JOINTS[0][:2]) == (19, 18, "floating", ("__floating_base__", "floating"))
for bad, message in (
    ((q[0, :5],), "q: found shape (5,), expected (19,) for one state or (N, 19) for N states"),
    ((q * 1j,), "q: found dtype complex128, expected real numbers, such as float64"),
    ((q * np.nan,), "q: found nan at [0, 0], expected finite numbers"),
):
    try:
        robot.mass_matrix(*bad)
    except (ValueError, TypeError) as error:
        assert str(error) == message, error
    else:
        raise AssertionError(message)
try:
    robot.inverse_dynamics(q, v[:2], a)
except ValueError as error:
    assert str(error) == "v: found 2 states, expected 12 as in q, or one state for all of them", error
assert "articulated" not in sys.modules
np.savez(sys.argv[3], **out)
"""


@pytest.fixture(scope="module")
def robot():
    return articulated.bundled("quadruped", gravity=(0.1, 0, -9))


@pytest.fixture(scope="module")
def made(robot, tmp_path_factory):
    return robot.wheel(tmp_path_factory.mktemp("dist"), ["inverse_dynamics", "mass_matrix", "kinetic_energy"], version="1.2")


def test_a_wheel_works_without_articulated(robot, made, tmp_path):
    install = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-index", "--disable-pip-version-check"]
    subprocess.run([*install, "--target", str(tmp_path / "site"), str(made)], check=True)
    assert sorted(path.name for path in (tmp_path / "site" / "quadruped").iterdir() if path.suffix != ".pyc" and path.is_file()) == [
        "__init__.py", "__init__.pyi", "_robot.so", "py.typed"]
    rng = np.random.default_rng(0)
    q, v, a = robot.random_configuration(rng, 12), *rng.normal(size=(2, 12, robot.nv))
    np.savez(tmp_path / "in.npz", q=q, v=v, a=a)
    (tmp_path / "client.py").write_text(CLIENT)
    words = ["client.py", "site", "in.npz", "out.npz"]
    subprocess.run([sys.executable, *words], cwd=tmp_path, check=True)
    out, near = np.load(tmp_path / "out.npz"), dict(rtol=1e-10, atol=1e-10)
    np.testing.assert_allclose(out["tau"], robot.inverse_dynamics(q, v, a), **near)
    np.testing.assert_allclose(out["tau_threads"], robot.inverse_dynamics(q, v[3], a[3]), **near)
    np.testing.assert_allclose(out["one"], out["tau"][0], **near)
    np.testing.assert_allclose(out["mass"], robot.mass_matrix(q), **near)
    np.testing.assert_allclose(out["energy"], robot.kinetic_energy(q, v), **near)
    assert out["none"].shape == (0, 18, 18)
    np.testing.assert_array_equal(out["lower"], robot.lower)


def test_what_a_wheel_has(robot, made):
    assert made.name.startswith("quadruped-1.2-py3-none-") and made.suffix == ".whl"
    with zipfile.ZipFile(made) as archive:
        assert archive.testzip() is None
        metadata = archive.read("quadruped-1.2.dist-info/METADATA").decode()
        types = archive.read("quadruped/__init__.pyi").decode()
    assert "Name: quadruped\nVersion: 1.2\n" in metadata and "Requires-Dist: numpy" in metadata
    compile(types, "__init__.pyi", "exec")
    assert "def inverse_dynamics(q: ArrayLike, v: ArrayLike, a: ArrayLike, *, threads: Optional[int] = None)" in types
    again = robot.wheel(made.parent / "again", ["inverse_dynamics", "mass_matrix", "kinetic_energy"], version="1.2")
    assert again.read_bytes() == made.read_bytes()


def test_the_command(tmp_path, capsys, monkeypatch):
    assert wheel(["simple_pendulum", "-o", str(tmp_path), "--functions", "gravity_torque", "--batch", "--name", "swing", "--gravity=0,0,-1"]) == 0
    path = Path(capsys.readouterr().out.strip())
    assert path.parent == tmp_path and path.name.startswith("swing-0.1.0-") and path.is_file()
    assert wheel([str(tmp_path / "none.urdf")]) == 1 and "none.urdf" in capsys.readouterr().err
    assert wheel(["simple_pendulum", "-o", str(tmp_path), "--functions", "gravity_torqe"]) == 1
    assert "did you mean 'gravity_torque'" in capsys.readouterr().err
    monkeypatch.setenv("CC", "no-such-compiler")
    assert wheel(["simple_pendulum", "-o", str(tmp_path)]) == 3 and "found no C compiler 'no-such-compiler'" in capsys.readouterr().err


def test_the_command_of_rust_comes_with_the_package():
    done = subprocess.run([sys.executable, "-m", "articulated", "check", "simple_pendulum"], capture_output=True, text=True)
    assert done.returncode == 0 and "swing" in done.stdout
    wrong = subprocess.run([sys.executable, "-m", "articulated", "check", "no_such_robot"], capture_output=True, text=True)
    assert wrong.returncode == 1 and "no_such_robot" in wrong.stderr


@pytest.mark.parametrize("words, name", [
    (["compare", "panda_like", "--repetitions", "31", "-o", "out"], "`compare`"),
    (["accuracy", "--advise", "--error=1e-9"], "`accuracy`"),
    (["scaling"], "`scaling`"),
    (["stress", "panda_like", "--levels", "f64"], "`stress`"),
    (["simulate", "--all"], "--all: "),
    (["simulate", "pendulum", "--generated"], "--generated: "),
    (["simulate", "pendulum", "--against", "peers.json"], "--against: "),
    (["effects", "pendulum", "--time"], "--time: "),
    (["eval", "simple_pendulum", "--function", "mass_matrix", "--states", "states.json", "--generated"], "--generated: "),
])
def test_what_measures_or_compiles_is_in_the_command_of_cargo(tmp_path, words, name):
    (tmp_path / "states.json").write_text('{"states": [{"q": [0.1]}]}')
    command = [sys.executable, "-m", "articulated", *words, "--format", "json"]
    done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path)
    report = json.loads(done.stdout)
    message = report["errors"][0]["message"]
    assert done.returncode == report["exit_status"] == 2 and report["status"] == "error"
    assert name in message and "`cargo install --path cli`" in message and f"error: {message}" in done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["states.json"]


def test_eval_of_the_package_is_generic(tmp_path):
    (tmp_path / "states.json").write_text('{"states": [{"q": [0.1]}]}')
    command = [sys.executable, "-m", "articulated", "eval", "simple_pendulum", "--function", "mass_matrix", "--states", tmp_path / "states.json"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0 and "generic results only" in done.stderr
    assert not subprocess.run([*command, "--generic"], capture_output=True, text=True).stderr


@pytest.mark.parametrize("options, error, message", [
    (dict(name="3d"), ValueError, "name: found '3d', expected a Python name"),
    (dict(name="numpy"), ValueError, "name: found 'numpy', the name of another package"),
    (dict(name="json"), ValueError, "name: found 'json', the name of another package"),
    (dict(version="new"), ValueError, "version: found 'new'"),
    (dict(functions="mass_matrix"), TypeError, "functions: found 'mass_matrix', expected a list"),
    (dict(flags="-O3"), TypeError, "flags: found '-O3', expected a list"),
    (dict(folder=3), TypeError, "folder: found int, expected the name of a file"),
])
def test_bad_options(robot, tmp_path, options, error, message):
    with pytest.raises(error) as found:
        robot.wheel(**{"folder": tmp_path, "functions": ["gravity_torque"], **options})
    assert message in str(found.value)


def test_names_are_no_code(tmp_path):
    text = """<robot name='a&quot;&quot;&quot;&#10;raise SystemExit(1)&#10;&quot;&quot;&quot;\\'><link name="b"/><link name="c&quot;\\"><inertial><mass value="1"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link><joint name="j&#10;'" type="continuous"><parent link="b"/>
    <child link="c&quot;\\"/><axis xyz="0 0 1"/></joint></robot>"""
    with pytest.warns(articulated.RobotWarning):
        robot = articulated.loads(text)
    with zipfile.ZipFile(robot.wheel(tmp_path, ["mass_matrix"], name="odd")) as archive:
        metadata = archive.read("odd-0.1.0.dist-info/METADATA").decode()
        archive.extractall(tmp_path / "site")
    assert len(metadata.splitlines()) == 6
    check = "import odd; print(odd.mass_matrix([0.0]).tolist(), repr(odd.NAME), repr(odd.JOINTS[0][0]))"
    done = subprocess.run([sys.executable, "-c", check], cwd=tmp_path / "site", capture_output=True, text=True, check=True)
    assert done.stdout.strip() == f"[[1.0]] {robot.name!r} {robot.joints[0].name!r}"


def test_robots_have_names_of_modules():
    from articulated._wheel import module_name

    assert [module_name(name) for name in ("UR5-like arm", "3d", "class", "", "é")] == ["ur5_like_arm", "robot_3d", "robot_class", "robot", "robot"]
