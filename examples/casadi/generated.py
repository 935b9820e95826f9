"""What the examples share: a robot's functions as a library for CasADi, and a call of IPOPT."""

import os
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

try:
    import casadi
except ImportError:
    sys.exit("CasADi was not found: python3 -m pip install -r examples/casadi/requirements.txt")


def library(folder, robot, functions, *options):
    """The path of a shared library of generated C in `folder`, with first and second derivatives of
    each function.

    `robot`: a bundled robot's name or a robot's file. `functions`: names and requests, as the
    option --functions takes them. Runs the command `articulated`, or the one that the environment
    variable ARTICULATED_COMMAND names, and the C compiler `cc`.
    """
    command = os.environ.get("ARTICULATED_COMMAND", "articulated")
    for tool, remedy in [(command, "cargo install --path cli, or set ARTICULATED_COMMAND to its path"), ("cc", "install a C compiler")]:
        if not shutil.which(tool):
            sys.exit(f"the command {tool} was not found: {remedy}")
    words = ["generate", robot, "--language", "c", "--abi", "casadi", "--derivatives", "2", "--functions", ",".join(functions)]
    if subprocess.run([command, *words, *options, "--prefix", "robot", "-o", str(folder)]).returncode:
        sys.exit(f"the command {command} failed, as it says above")
    shared = Path(folder, "robot.so").resolve()
    subprocess.run(["cc", "-O2", "-shared", "-fPIC", str(Path(folder, "robot.c")), "-o", str(shared), "-lm"], check=True)
    return str(shared)


@dataclass
class Solution:
    """What IPOPT found. `x`: the variables, a vector; `seconds`: of all iterations together."""

    status: str
    iterations: int
    objective: float
    seconds: float
    x: casadi.DM

    def row(self):
        return f"{self.iterations:10d}{1e3 * self.seconds:10.1f}{self.objective:14.8f}  {self.status}"


HEADING = f"{'iterations':>10}{'ms':>10}{'objective':>14}  IPOPT"


class Problem:
    """Variables with bounds and a start, constraints with bounds, and a cost, for IPOPT."""

    def __init__(self):
        self.x, self.start, self.lower_x, self.upper_x = [], [], [], []
        self.g, self.lower_g, self.upper_g = [], [], []
        self.cost = 0

    def variable(self, name, rows, columns=1, *, start, lower=-casadi.inf, upper=casadi.inf):
        """A matrix of variables. `start`, `lower`, `upper`: a number, a column for every column, or
        a matrix.
        """
        symbol = casadi.MX.sym(name, rows, columns)
        self.x.append(casadi.vec(symbol))
        for kept, value in [(self.start, start), (self.lower_x, lower), (self.upper_x, upper)]:
            kept.append(filled(value, rows, columns))
        return symbol

    def constrain(self, expression, lower=0, upper=0):
        """Lower and upper bounds of each number of an expression; zero by default."""
        self.g.append(casadi.vec(expression))
        for kept, value in [(self.lower_g, lower), (self.upper_g, upper)]:
            kept.append(filled(value, *expression.shape))

    def solve(self, exact=True):
        """The solution, with exact Hessians or with IPOPT's approximation of them by gradients
        (limited-memory BFGS).
        """
        options = {"print_level": 0, "sb": "yes", "tol": 1e-8, "max_iter": 1000, "hessian_approximation": "exact" if exact else "limited-memory"}
        problem = {"x": casadi.vertcat(*self.x), "f": self.cost, "g": casadi.vertcat(*self.g)}
        solver = casadi.nlpsol("solver", "ipopt", problem, {"ipopt": options, "print_time": False})
        bounds = {"lbx": self.lower_x, "ubx": self.upper_x, "lbg": self.lower_g, "ubg": self.upper_g}
        began = time.perf_counter()
        found = solver(x0=casadi.vertcat(*self.start), **{name: casadi.vertcat(*parts) for name, parts in bounds.items()})
        seconds, statistics = time.perf_counter() - began, solver.stats()
        return Solution(statistics["return_status"], statistics["iter_count"], float(found["f"]), seconds, found["x"])


def filled(value, rows, columns):
    """A number, a column or a matrix as a vector of `rows * columns` numbers, column by column."""
    value = casadi.DM(value)
    if value.numel() == 1:
        value = casadi.repmat(value, rows, columns)
    elif value.shape == (rows, 1):
        value = casadi.repmat(value, 1, columns)
    assert value.shape == (rows, columns), f"found {value.shape[0]}x{value.shape[1]} numbers, expected {rows}x{columns}"
    return casadi.vec(value)
