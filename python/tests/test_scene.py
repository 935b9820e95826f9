"""Scenes and their motions."""

import csv
import webbrowser
from pathlib import Path

import articulated
import numpy as np
import pytest


@pytest.fixture(scope="module")
def motion():
    return articulated.Scene("double_pendulum").run(end=0.5)


def test_a_motion_has_columns(motion):
    assert motion.status == "ok" and len(motion) == len(motion.time) > 2 and motion.time[-1] == 0.5
    assert motion.q.shape == motion.v.shape == motion.tau.shape == (len(motion), 2)
    titles = list(motion.columns)
    assert titles[0] == "t" and titles[1].startswith("q.") and motion.units["t"] == "s" and motion.units["work"] == "J"
    np.testing.assert_array_equal(motion.q[:, 0], motion[titles[1]])
    energy = motion["kinetic_energy"] + motion["potential_energy"]
    np.testing.assert_allclose(energy, energy[0], rtol=1e-6)
    assert motion.summary["scene"] == "double_pendulum" and isinstance(motion.events, list)
    assert repr(motion) == f"<articulated.Motion 'double_pendulum': {len(motion)} records to t = 0.5 s, ok>"
    with pytest.raises(KeyError, match="did you mean 'work'"):
        motion["wurk"]


def test_the_motion_is_that_of_the_robot(motion):
    robot = articulated.bundled("double_pendulum")
    acceleration = np.gradient(motion.v, motion.time, axis=0)
    expected = robot.forward_dynamics(motion.q, motion.v, motion.tau)
    inner = slice(2, -2)
    assert np.abs(acceleration - expected)[inner].max() < 0.05 * np.abs(expected).max()


def test_every_bundled_scene_opens():
    names = articulated.bundled_scene_names()
    assert "golf_swing" in names and all(names.values())
    for name in names:
        assert articulated.Scene(name).name == name


def test_the_golf_swing():
    motion = articulated.Scene("golf_swing").run()
    assert motion.q.shape[0] == len(motion) and motion.summary["ball_reached"] is True and motion.summary["ball_speed_m_per_s"] > 10
    assert any(event["kind"] == "ball" for event in motion.events)


def test_settings_of_a_run():
    scene = articulated.Scene("pendulum")
    fixed = scene.run(end=0.1, integrator="rk4", step=0.01, every=0.05)
    np.testing.assert_allclose(fixed.time, [0, 0.05, 0.1])
    assert fixed.summary["integrator"]["name"] == "rk4"
    near = scene.run(end=0.1, integrator="dopri5", rtol=1e-10, atol=1e-10, every=0.05)
    np.testing.assert_allclose(fixed.q, near.q, atol=1e-7)


def test_files(motion, tmp_path):
    files = motion.write(tmp_path / "all")
    assert {"recording.csv", "summary.json", "motion.html"} <= set(files)
    with open(tmp_path / "all" / "recording.csv", newline="", encoding="utf-8") as lines:
        rows = list(csv.reader(lines))
    assert rows[0] == list(motion.columns)
    np.testing.assert_array_equal(np.array(rows[1:], dtype=float), np.stack(list(motion.columns.values()), axis=1))
    page = tmp_path / "page.html"
    assert motion.write(page) == [str(page)] and "<html" in page.read_text(encoding="utf-8")[:200].lower()


def test_a_page_is_opened(motion, monkeypatch, tmp_path):
    opened = []
    monkeypatch.setattr(webbrowser, "open", lambda url: opened.append(url) or True)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    path = motion.show()
    assert opened == [path.as_uri()] and path.stat().st_size > 10_000 and path.parent == tmp_path
    assert articulated.Scene("pendulum").show(end=0.1).is_file()
    monkeypatch.setattr(webbrowser, "open", lambda url: False)
    with pytest.warns(articulated.RobotWarning, match="show: found no browser"):
        motion.show()


def test_arrow(motion):
    pyarrow = pytest.importorskip("pyarrow", reason="pyarrow (pip install pyarrow) is not installed: no tables of Arrow")
    table = motion.to_arrow()
    assert isinstance(table, pyarrow.Table) and table.column_names == list(motion.columns) and table.num_rows == len(motion)
    np.testing.assert_array_equal(table["work"].to_numpy(), motion["work"])
    assert table.schema.field("work").metadata == {b"unit": b"J"}


def test_arrow_that_is_not_installed(motion, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "pyarrow", None)
    with pytest.raises(ImportError, match="to_arrow: found no pyarrow, expected it to be installed: pip install pyarrow"):
        motion.to_arrow()


def test_a_scene_of_a_file(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text('robot = "simple_pendulum"\n[initial]\nq = { swing = 0.3 }\n[simulation]\nend = 0.2\n')
    motion = articulated.Scene(path).run()
    assert motion.q[0, 0] == 0.3 and motion.time[-1] == 0.2
    path.write_text('robot = "simple_pendulum"\n[initial]\nq = { swnig = 0.3 }\n[simulation]\nend = "late"\n')
    with pytest.raises(articulated.RobotError) as error:
        articulated.Scene(path)
    assert error.value.diagnostics and all(finding["file"] == str(path) for finding in error.value.diagnostics)
    assert set(error.value.diagnostics[0]) >= {"severity", "code", "line", "found", "expected", "message"}


@pytest.mark.parametrize("changes, error, message", [
    (dict(end=-1.0), articulated.RobotError, "end: found"),
    (dict(end=np.nan), articulated.RobotError, "end: found NaN, expected a finite number of seconds"),
    (dict(end="late"), TypeError, "end: found dtype"),
    (dict(end=[1.0, 2.0]), ValueError, "end: found shape (2,), expected a number or None"),
    (dict(every=0.0), articulated.RobotError, "every: found 0"),
    (dict(integrator="rk5"), articulated.RobotError, "integrator: found \"rk5\""),
    (dict(integrator=4), TypeError, "integrator: found int"),
    (dict(step=0.1, rtol=0.1), articulated.RobotError, "rtol: found rtol beside step"),
])
def test_bad_settings(changes, error, message):
    with pytest.raises(error) as found:
        articulated.Scene("pendulum").run(**changes)
    assert message in str(found.value) and "--" not in str(found.value)


def test_bad_scenes(tmp_path, motion):
    with pytest.raises(articulated.RobotError, match='did you mean "golf_swing"'):
        articulated.Scene("golf_swnig")
    with pytest.raises(TypeError, match="path: found int"):
        articulated.Scene(3)
    (tmp_path / "file").write_text("")
    with pytest.raises(articulated.RobotError, match="path .*: found a file, expected a folder"):
        motion.write(tmp_path / "file")
    with pytest.raises(articulated.RobotError, match="packages: found no folder"):
        motion.write(tmp_path / "page.html", packages=[Path("no/such")])


def test_a_motion_can_be_interrupted():
    import signal
    import threading

    scene = articulated.Scene("pendulum")
    # A shell starts its background jobs with this signal ignored.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        threading.Timer(0.3, lambda: signal.raise_signal(signal.SIGINT)).start()
        with pytest.raises(KeyboardInterrupt):
            scene.run(end=1e9, step=1e-4, integrator="rk4", every=1e6)
    finally:
        signal.signal(signal.SIGINT, before)
