#!/usr/bin/env python3
"""Runs the code of notebooks without Jupyter.

    python docs/notebooks/run.py                         runs the notebooks of this folder
    python docs/notebooks/run.py first_steps.ipynb       runs one notebook
    python docs/notebooks/run.py --without matplotlib    runs them as if a package is missing
    python docs/notebooks/run.py --strip                 removes stored outputs, and runs nothing

Each notebook runs in a process of its own, in its own folder, as in Jupyter. Its code cells run in
order, and share their names. The value of the last expression of a cell is printed. An error ends
the notebook. The exit status is 1 where a notebook fails. The standard library is enough for this
program; the notebooks import what they need.
"""

import argparse
import ast
import json
import linecache
import os
import subprocess
import sys
import time
import traceback
from pathlib import Path

PLACE = Path(__file__).resolve().parent
# Editors write their versions here. Notebooks keep only this.
METADATA = {
    "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
    "language_info": {"name": "python"},
}


def read(path):
    """The notebook of a file.

    Raises:
        ValueError: The file is missing, or is not a notebook of format 4.
    """
    try:
        notebook = json.loads(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise ValueError(f"{path}: {error.strerror}, expected a notebook") from None
    except ValueError as error:
        raise ValueError(f"{path}: found no JSON ({error}), expected a notebook") from None
    found = notebook.get("nbformat") if isinstance(notebook, dict) else None
    if found != 4:
        raise ValueError(f"{path}: found nbformat {found!r}, expected a notebook of format 4")
    cells = notebook.get("cells")
    if not isinstance(cells, list) or not all(isinstance(cell, dict) and {"cell_type", "source"} <= cell.keys() for cell in cells):
        raise ValueError(f"{path}: found no list of cells with cell_type and source, expected a notebook of format 4")
    return notebook


def code_cells(notebook):
    """The texts of the code cells, in order."""
    return ["".join(cell["source"]) for cell in notebook["cells"] if cell["cell_type"] == "code"]


def run_cell(source, name, names):
    """Runs a cell. Prints the value of its last expression, unless it is None or a semicolon follows."""
    # Tracebacks take the lines of the cell from here.
    linecache.cache[name] = (len(source), None, source.splitlines(keepends=True), name)
    body = ast.parse(source, name).body
    last = body.pop() if body and isinstance(body[-1], ast.Expr) and not source.rstrip().endswith(";") else None
    exec(compile(ast.Module(body, []), name, "exec"), names)
    if last is not None:
        value = eval(compile(ast.Expression(last.value), name, "eval"), names)
        if value is not None:
            print(repr(value))


def run_here(path, without=()):
    """Runs a notebook in this process. Returns the exit status."""
    cells = code_cells(read(path))
    os.environ["MPLBACKEND"] = "agg"  # figures are drawn, and no window opens
    # `import` of a module that is None here raises ModuleNotFoundError.
    sys.modules.update(dict.fromkeys(without))
    os.chdir(Path(path).resolve().parent)
    names = {"__name__": "__main__", "display": lambda *values: print(*map(repr, values), sep="\n")}
    for number, source in enumerate(cells, 1):
        name = f"{Path(path).name}, code cell {number}"
        try:
            run_cell(source, name, names)
        # `sys.exit()` in a cell is an error too: the cells after it do not run.
        except (Exception, SystemExit) as error:
            sys.stdout.flush()
            traceback.print_exception(type(error), error, _from(name, error.__traceback__))
            print(f"{path}: code cell {number} of {len(cells)} fails", file=sys.stderr)
            return 1
    return 0


def _from(name, trace):
    """The traceback from the first line of this cell: without those of this program."""
    while trace and trace.tb_frame.f_code.co_filename != name:
        trace = trace.tb_next
    return trace


def run(path, without, timeout):
    """Runs a notebook in a process of its own. Returns whether it succeeds."""
    start = time.perf_counter()
    words = [sys.executable, __file__, "--here", str(path), *(f"--without={module}" for module in without)]
    try:
        succeeds = subprocess.run(words, timeout=timeout).returncode == 0
    except subprocess.TimeoutExpired:
        print(f"{path}: not finished after {timeout:g} s; --timeout sets another limit", file=sys.stderr)
        return False
    print(f"{path}: {'ran' if succeeds else 'failed'} in {time.perf_counter() - start:.1f} s", flush=True)
    return succeeds


def stripped(notebook):
    """The text of the file of a notebook without outputs, counts and metadata, as Jupyter writes it."""
    cells = [{**cell, "metadata": {}} for cell in notebook["cells"]]
    for cell in cells:
        if cell["cell_type"] == "code":
            cell.update(execution_count=None, outputs=[])
    whole = {**notebook, "cells": cells, "metadata": METADATA}
    return json.dumps(whole, indent=1, ensure_ascii=False, sort_keys=True) + "\n"


def main(arguments=None):
    """Runs the notebooks. Returns the exit status."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("notebooks", nargs="*", help="paths of notebooks; those of this folder if none is given")
    parser.add_argument("--timeout", type=float, default=120.0, help="seconds for each notebook (default: 120)")
    parser.add_argument("--without", action="append", default=[], metavar="MODULE", help="a module that notebooks do not find")
    parser.add_argument("--strip", action="store_true", help="remove stored outputs; run nothing")
    parser.add_argument("--here", action="store_true", help=argparse.SUPPRESS)
    given = parser.parse_args(arguments)
    if not given.timeout > 0:
        parser.error(f"--timeout: found {given.timeout:g}, expected a positive number of seconds")
    paths = given.notebooks or sorted(PLACE.glob("*.ipynb"))
    if given.here:
        return run_here(paths[0], given.without)
    try:
        notebooks = {path: read(path) for path in paths}
    except ValueError as error:
        print(error, file=sys.stderr)
        return 1
    if given.strip:
        for path, notebook in notebooks.items():
            Path(path).write_text(stripped(notebook), encoding="utf-8")
        return 0
    return 0 if all([run(path, given.without, given.timeout) for path in paths]) else 1


if __name__ == "__main__":
    sys.exit(main())
