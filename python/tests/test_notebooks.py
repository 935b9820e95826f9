"""The notebooks of docs/notebooks: their files, what they compute, and the program that runs them."""

import json
import os
import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

PLACE = Path(__file__).resolve().parents[2] / "docs" / "notebooks"
PROGRAM = PLACE / "run.py"
NOTEBOOKS = ["first_steps.ipynb", "identification.ipynb", "gradients_and_rollouts.ipynb"]

sys.path.insert(0, str(PLACE))
import run as program

sys.path.remove(str(PLACE))


@pytest.fixture(scope="module")
def cache(tmp_path_factory):
    """Compiled robots, for all notebooks of this module."""
    return tmp_path_factory.mktemp("cache")


def execute(cache, *words, **environment):
    """Runs the program in a process of its own, which ends after two minutes."""
    environment = {**os.environ, "ARTICULATED_CACHE": str(cache), **environment}
    return subprocess.run([sys.executable, PROGRAM, *map(str, words)], env=environment, capture_output=True, text=True, timeout=150)


def write(path, *sources):
    cells = [{"cell_type": "code", "execution_count": 3, "id": f"c{k}", "metadata": {}, "outputs": [], "source": text} for k, text in enumerate(sources)]
    path.write_text(json.dumps({"cells": cells, "metadata": {}, "nbformat": 4, "nbformat_minor": 5}), encoding="utf-8")
    return path


def test_all_notebooks_are_tested():
    assert sorted(NOTEBOOKS) == sorted(path.name for path in PLACE.glob("*.ipynb"))


@pytest.mark.parametrize("name", NOTEBOOKS)
def test_files_are_short_and_have_no_outputs(name):
    notebook = program.read(PLACE / name)
    assert program.stripped(notebook) == (PLACE / name).read_text(encoding="utf-8"), "python docs/notebooks/run.py --strip writes the expected file"
    assert len(notebook["cells"]) < 25
    for source in program.code_cells(notebook):
        assert len(source.splitlines()) < 20 and max(map(len, source.splitlines())) <= 150
    ids = [cell["id"] for cell in notebook["cells"]]
    assert len(set(ids)) == len(ids) and all(re.fullmatch(r"[a-zA-Z0-9_-]{1,64}", one) for one in ids)


@pytest.mark.parametrize("name", NOTEBOOKS)
def test_links_are_files(name):
    text = "\n".join("".join(cell["source"]) for cell in program.read(PLACE / name)["cells"] if cell["cell_type"] == "markdown")
    links = re.findall(r"\]\(([^)#]+)(?:#([^)]+))?\)", text)
    assert links
    for file, anchor in links:
        assert (PLACE / file).exists(), file
        titles = re.findall(r"^#+ (.*)$", (PLACE / file).read_text(encoding="utf-8"), re.MULTILINE)
        assert not anchor or anchor in {re.sub(r"[^\w -]", "", title.lower()).replace(" ", "-") for title in titles}, anchor


@pytest.mark.parametrize("name", NOTEBOOKS)
def test_notebooks_run(name, cache):
    done = execute(cache, PLACE / name)
    assert done.returncode == 0, done.stdout + done.stderr
    assert f"{name}: ran in" in done.stdout


@pytest.mark.parametrize("name", NOTEBOOKS)
def test_notebooks_run_without_what_is_optional(name, cache):
    done = execute(cache, PLACE / name, "--without", "matplotlib", "--without", "jax", CC="no-such-compiler")
    assert done.returncode == 0, done.stdout + done.stderr
    assert ("JAX is not installed" in done.stdout) == (name == "gradients_and_rollouts.ipynb")
    assert ("found no C compiler" in done.stdout) == (name != "identification.ipynb")
    assert "time / s" in done.stdout


@pytest.mark.parametrize("name", NOTEBOOKS)
def test_notebooks_run_in_jupyter(name, cache, monkeypatch):
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    monkeypatch.setenv("ARTICULATED_CACHE", str(cache))
    notebook = nbformat.read(PLACE / name, as_version=4)
    nbformat.validate(notebook)
    nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3", resources={"metadata": {"path": str(PLACE)}}).execute()
    pictures = [output for cell in notebook.cells for output in cell.get("outputs", []) if "image/png" in output.get("data", {})]
    assert len(pictures) == (1 if find_spec("matplotlib") else 0)


WRONG = [
    ("first_steps.ipynb", "+ h**2 / 2 * a), v + h * a)", "+ h**2 / 2 * a), v - h * a)"),
    ("first_steps.ipynb", "- 2 * OMEGA * v", "- 2.1 * OMEGA * v"),
    ("first_steps.ipynb", "loaded.gravity_torque(rest) - arm", "arm"),
    ("identification.ipynb", "+ DAMPING * v", "- DAMPING * v"),
    ("identification.ipynb", "x * x + z * z", "x * x - z * z"),
    ("identification.ipynb", "by_file + rows(q, v, a) @ found", "by_file - rows(q, v, a) @ found"),
    ("gradients_and_rollouts.ipynb", "weights @ panda.inverse_dynamics(q, v + step, a)", "weights @ panda.inverse_dynamics(q, v - step, a)"),
    ("gradients_and_rollouts.ipynb", "100 * speed\\n", "-100 * speed\\n"),
    ("gradients_and_rollouts.ipynb", "prepend=hanging[None]", "prepend=ends.q[:1]"),
]


@pytest.mark.parametrize("name, right, wrong", WRONG, ids=range(len(WRONG)))
def test_wrong_notebooks_fail(name, right, wrong, cache, tmp_path):
    """The laws in the notebooks find mistakes."""
    text = (PLACE / name).read_text(encoding="utf-8")
    assert text.count(right) == 1
    robot = PLACE.parents[1] / "tests" / "robots" / "arm.urdf"
    text = text.replace(right, wrong).replace("../../tests/robots/arm.urdf", robot.as_posix())
    (tmp_path / name).write_text(text, encoding="utf-8")
    done = execute(cache, tmp_path / name, "--without", "matplotlib", "--without", "jax")
    assert done.returncode == 1 and "AssertionError" in done.stderr and "code cell" in done.stderr, done.stdout + done.stderr


def test_cells_share_names_and_print_as_in_jupyter(cache, tmp_path):
    path = write(tmp_path / "a.ipynb", "x = 2\nx + 1", "None", "x;", ["y = 'a'\n", "display(y, x)"], "from pathlib import Path\nPath().resolve().name")
    done = execute(cache, path)
    assert done.returncode == 0 and done.stderr == ""
    assert done.stdout.splitlines()[:-1] == ["3", "'a'", "2", repr(tmp_path.name)]


FAILS = [
    ("x = 1\nassert x == 2", ["line 2, in <module>", "assert x == 2", "AssertionError"]),
    ("import sys\nsys.exit()", ["SystemExit"]),
    ("x = = 2", ["x = = 2", "SyntaxError"]),
    ("%matplotlib inline", ["SyntaxError"]),
    ("import jax", ["ModuleNotFoundError"]),
]


@pytest.mark.parametrize("source, words", FAILS)
def test_a_cell_with_an_error_fails(source, words, cache, tmp_path):
    path = write(tmp_path / "a.ipynb", "print('first')", source, "print('third')")
    done = execute(cache, path, "--without", "jax")
    assert done.returncode == 1 and f"{path}: failed" in done.stdout and f"{path}: code cell 2 of 3 fails" in done.stderr
    assert "first" in done.stdout and "third" not in done.stdout and "run.py" not in done.stderr
    for word in words:
        assert word in done.stderr


def test_a_notebook_that_does_not_end_fails_and_others_still_run(cache, tmp_path):
    slow, good = write(tmp_path / "slow.ipynb", "while True: pass"), write(tmp_path / "good.ipynb", "1")
    done = execute(cache, slow, good, "--timeout", "1")
    assert done.returncode == 1 and f"{slow}: not finished after 1 s" in done.stderr and f"{good}: ran" in done.stdout


BAD = [
    (None, "No such file or directory, expected a notebook"),
    ("{", "found no JSON"),
    ("[]", "found nbformat None, expected a notebook of format 4"),
    ('{"nbformat": 3}', "found nbformat 3, expected a notebook of format 4"),
    ('{"nbformat": 4, "cells": [{}]}', "found no list of cells with cell_type and source"),
]


@pytest.mark.parametrize("text, message", BAD)
@pytest.mark.parametrize("words", [[], ["--strip"]])
def test_a_file_that_is_no_notebook_is_refused(text, message, words, tmp_path, capsys):
    path = tmp_path / "a.ipynb"
    if text is not None:
        path.write_text(text, encoding="utf-8")
    assert program.main([str(path), *words]) == 1
    assert f"{path}: {message}" in capsys.readouterr().err


def test_strip_removes_what_editors_store(tmp_path):
    path = write(tmp_path / "a.ipynb", "1 + 1")
    notebook = program.read(path)
    notebook["cells"][0] |= {"outputs": [{"output_type": "stream", "name": "stdout", "text": "2"}], "metadata": {"scrolled": True}}
    notebook["metadata"] = {"language_info": {"name": "python", "version": "3.12.1"}}
    path.write_text(json.dumps(notebook), encoding="utf-8")
    assert program.main([str(path), "--strip"]) == 0
    found = program.read(path)
    assert found["cells"] == [{"cell_type": "code", "execution_count": None, "id": "c0", "metadata": {}, "outputs": [], "source": "1 + 1"}]
    assert found["metadata"] == program.METADATA


def test_a_time_limit_that_is_not_positive_is_refused(capsys):
    with pytest.raises(SystemExit):
        program.main(["--timeout", "0"])
    assert "--timeout: found 0, expected a positive number of seconds" in capsys.readouterr().err
