"""Eight mistakes of printed programs, and the law of mechanics that finds each.

    python docs/book/python/mended.py

The program is `arm.py`. Each mistake puts wrong lines in the place of its right ones, and the laws
of `laws.py` judge the result. The exit status is 1 if a mistake is not found, or if the right
program breaks a law.
"""

import argparse
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

import laws
from arm import arm_of
from bodies import read

HERE = Path(__file__).resolve().parent
SOURCE = HERE / "arm.py"
ROBOT = HERE.parents[2] / "models" / "urdf" / "ur5_like.urdf"
HOLDS, BROKEN = 1e-9, 1e-2  # a law holds below the first number, and is broken above the second one


class Mistake(NamedTuple):
    """Right lines of `arm.py`, and wrong ones that often take their place.

    Both are blocks of lines with a blank line between them; the k-th block replaces the k-th.
    """

    name: str
    law: Callable  # one that finds it
    right: str
    wrong: str


MISTAKES = [
    Mistake(
        "a tuple unpacked in the wrong order",
        laws.slope,
        right="""
    V, dV = outward(S, X, v, a, gravity)
""",
        wrong="""
    dV, V = outward(S, X, v, a, gravity)
""",
    ),
    Mistake(
        "space screws used as body screws",
        laws.energy,
        right="""
        S[i] = adjoint(inverse(home)) @ arm.space[i]
""",
        wrong="""
        S[i] = arm.space[i]
""",
    ),
    Mistake(
        "cumulative transforms",
        laws.slope,
        right="""
        X[i] = adjoint(inverse(T))
""",
        wrong="""
        X[i] = adjoint(inverse(pose))
""",
    ),
    Mistake(
        "ad of the joint's rate in the bias",
        laws.power,
        right="""
        dV[i] = X[i] @ dV[i - 1] + S[i] * a[i] + ad(V[i]) @ S[i] * v[i]
""",
        wrong="""
        dV[i] = X[i] @ dV[i - 1] + S[i] * a[i] + ad(S[i] * v[i]) @ S[i] * v[i]
""",
    ),
    Mistake(
        "the transform of the wrong body",
        laws.symmetry,
        right="""
        F[i] = X[i + 1].T @ F[i + 1] + G @ dV[i] - ad(V[i]).T @ G @ V[i]
""",
        wrong="""
        F[i] = X[i].T @ F[i + 1] + G @ dV[i] - ad(V[i]).T @ G @ V[i]
""",
    ),
    Mistake(
        "torques in the order of the sweep",
        laws.slope,
        right="""
    F, tau = np.zeros((n + 1, 6)), np.zeros(n)

        tau[i] = S[i] @ F[i]
""",
        wrong="""
    F, tau = np.zeros((n + 1, 6)), []

        tau.append(S[i] @ F[i])
""",
    ),
    Mistake(
        "the tip's wrench in axes of the world",
        laws.virtual_work,
        right="""
    F[n] = -np.append(R.T @ tip[:3], R.T @ tip[3:])
""",
        wrong="""
    F[n] = -tip
""",
    ),
    Mistake(
        "masses that are read and not used",
        laws.momentum_balance,
        right="""
        G = inertia(arm.mass[i], arm.centre[i], arm.moments[i])
""",
        wrong="""
        G = np.eye(6)
""",
    ),
]


def program_with(mistake=None):
    """`inverse_dynamics` of `arm.py`, with the wrong lines of a mistake, or as it is.

    Raises ValueError if the file does not contain each of the right blocks exactly once.
    """
    source = SOURCE.read_text(encoding="utf-8")
    if mistake is not None:
        for right, wrong in zip(mistake.right.split("\n\n"), mistake.wrong.split("\n\n"), strict=True):
            right, wrong = right.strip(), wrong.strip()
            if source.count(right) != 1:
                raise ValueError(f"{SOURCE.name}: found these lines {source.count(right)} times, expected them once:\n{right}")
            source = source.replace(right, wrong)
    names = {"__name__": SOURCE.stem}
    exec(compile(source, SOURCE.name, "exec"), names)
    return names["inverse_dynamics"]


def states(n):
    """Five random states of n joints, the same ones at each call: rad, rad/s, rad/s² and N."""
    rng = np.random.default_rng(7)
    draw = lambda bound, size: rng.uniform(-bound, bound, size)
    return [laws.State(draw(3, n), draw(4, n), draw(4, n), draw(20, 3)) for _ in range(5)]


def violations(mistake=None):
    """The size of the violation of each law, (laws, states)."""
    robot = read(ROBOT)
    program = laws.Program(program_with(mistake), arm_of(robot), robot)
    return np.array([[law(program, state) for state in states(robot.nv)] for law in laws.LAWS])


def table(right, wrong):
    """Each mistake, its law, the largest violation of the right lines and the smallest of the wrong."""
    lines = [f"{'mistake':<40} {'law':<17} {'right':>6} {'wrong':>6}"]
    for number, (mistake, sizes) in enumerate(zip(MISTAKES, wrong), 1):
        row = laws.LAWS.index(mistake.law)
        lines.append(f"{number} {mistake.name:<38} {_name(mistake.law):<17} {right[row].max():>6.0e} {sizes[row].min():>6.0e}")
    return "\n".join(lines)


def marks(right, wrong):
    """Each law against each mistake: x where the law is broken in some state, . where it holds in all."""
    lines = [" " * 17 + "  right  " + "  ".join(str(number) for number in range(1, len(wrong) + 1))]
    for row, law in enumerate(laws.LAWS):
        each = ["x" if sizes[row].max() > BROKEN else "." if sizes[row].max() < HOLDS else "?" for sizes in (right, *wrong)]
        lines.append(f"{_name(law):<17}      " + "  ".join(each))
    return "\n".join(lines)


def _name(law):
    return law.__name__.replace("_", " ")


def main(arguments=None):
    """Prints both tables. Returns the exit status."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.parse_args(arguments)
    if not ROBOT.exists():
        parser.error(f"found no {ROBOT}, expected this file in a checkout of the repository")
    right, wrong = violations(), [violations(mistake) for mistake in MISTAKES]
    print(table(right, wrong), marks(right, wrong), sep="\n\n")
    # NaN is neither below nor above a number: the law counts as broken, the mistake as not found.
    broken = [_name(law) for law, sizes in zip(laws.LAWS, right) if not sizes.max() < HOLDS]
    missed = [mistake.name for mistake, sizes in zip(MISTAKES, wrong) if not sizes[laws.LAWS.index(mistake.law)].min() > BROKEN]
    for name in broken:
        print(f"the right program breaks a law: {name}", file=sys.stderr)
    for name in missed:
        print(f"its law does not find a mistake: {name}", file=sys.stderr)
    return 1 if broken or missed else 0


if __name__ == "__main__":
    sys.exit(main())
