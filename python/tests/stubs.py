#!/usr/bin/env python3
"""Writes the types of the package, articulated/*.pyi, from the table of functions.

    python tests/stubs.py [--check]

Needs the package to be installed. `--check` writes nothing, and fails if the file is not up to date.
"""

import sys
from pathlib import Path

import articulated
from articulated import _gradients

FOLDER = Path(__file__).resolve().parent.parent / "articulated"

HEAD = '''"""Types of the package. Made by tests/stubs.py from the table of functions."""

from os import PathLike
from pathlib import Path
from typing import Any, Iterable, Literal, Mapping, NamedTuple, Optional, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

# float32 if all arguments are, else float64.
_Array = NDArray[Any]
_Base = Literal["fixed", "floating"]
_Reference = Literal["body", "world", "world_aligned"]

__version__: str

class RobotError(ValueError):
    diagnostics: list[dict[str, Any]]
    def __init__(self, message: str = ..., diagnostics: Iterable[dict[str, Any]] = ...) -> None: ...

class RobotWarning(UserWarning):
    diagnostic: Optional[dict[str, Any]]
    def __init__(self, message: str = ..., diagnostic: Optional[dict[str, Any]] = ...) -> None: ...

class Actuator(NamedTuple):
    name: str
    lower: float
    upper: float
    has_activation: bool

class Joint(NamedTuple):
    name: str
    kind: str
    q: slice
    v: slice

class Function(NamedTuple):
    name: str
    summary: str
    takes: tuple[tuple[str, tuple[Union[int, str], ...], str], ...]
    gives: tuple[Union[int, str], ...]
    unit: str
    group: str
    source: str

class Scene:
    def __init__(self, scene: Union[str, bytes, PathLike[str], PathLike[bytes]]) -> None: ...
    @property
    def name(self) -> str: ...
    def run(
        self,
        *,
        end: Optional[float] = None,
        integrator: Optional[str] = None,
        step: Optional[float] = None,
        rtol: Optional[float] = None,
        atol: Optional[float] = None,
        every: Optional[float] = None,
    ) -> Motion: ...
    def show(self, **changes: Any) -> Path: ...
    def write(self, path: Union[str, PathLike[str]], **changes: Any) -> list[str]: ...

class Motion:
    columns: dict[str, NDArray[np.float64]]
    units: dict[str, str]
    summary: dict[str, Any]
    time: NDArray[np.float64]
    q: NDArray[np.float64]
    v: NDArray[np.float64]
    tau: NDArray[np.float64]
    @property
    def status(self) -> str: ...
    @property
    def events(self) -> list[dict[str, Any]]: ...
    def __getitem__(self, title: str) -> NDArray[np.float64]: ...
    def __len__(self) -> int: ...
    def to_arrow(self) -> Any: ...
    def write(self, path: Union[str, PathLike[str]], packages: Iterable[Union[str, PathLike[str]]] = ...) -> list[str]: ...
    def show(self, packages: Iterable[Union[str, PathLike[str]]] = ...) -> Path: ...

class FoundRobot(NamedTuple):
    name: str
    file: Path
    format: Literal["urdf", "xacro", "mjcf", "sdf"]
    package: str
    packages: Mapping[str, Path]
    def load(
        self,
        base: _Base = "fixed",
        gravity: Optional[ArrayLike] = ...,
        frames: Optional[Iterable[str]] = None,
        wrenches_in: _Reference = "body",
        *,
        packages: Optional[Mapping[str, Union[str, PathLike[str]]]] = None,
        **options: Any,
    ) -> Robot: ...

class Player:
    def __init__(
        self,
        robot: Union[Robot, CompiledRobot],
        q: Optional[ArrayLike] = None,
        *,
        title: Optional[str] = None,
        packages: Iterable[Union[str, PathLike[str]]] = ...,
    ) -> None: ...
    @property
    def url(self) -> str: ...
    @property
    def pages(self) -> int: ...
    @property
    def frames(self) -> tuple[str, ...]: ...
    @frames.setter
    def frames(self, names: Iterable[str]) -> None: ...
    @property
    def trace(self) -> tuple[str, ...]: ...
    @trace.setter
    def trace(self, names: Iterable[str]) -> None: ...
    def show(
        self,
        q: ArrayLike,
        *,
        frames: Optional[Iterable[str]] = None,
        trace: Optional[Iterable[str]] = None,
        lines: Optional[Iterable[ArrayLike]] = None,
    ) -> None: ...
    def open(self) -> str: ...
    def wait(self, timeout: Optional[float] = None) -> None: ...
    def close(self) -> None: ...
    def __enter__(self) -> Player: ...
    def __exit__(self, *error: object) -> None: ...

def robots(pattern: Optional[str] = None) -> list[FoundRobot]: ...
def functions() -> tuple[Function, ...]: ...
def bundled_scene_names() -> dict[str, str]: ...
def bundled_names() -> dict[str, str]: ...
def load(
    path: Union[str, bytes, PathLike[str], PathLike[bytes]],
    base: _Base = "fixed",
    gravity: Optional[ArrayLike] = ...,
    frames: Optional[Iterable[str]] = None,
    wrenches_in: _Reference = "body",
    *,
    args: Optional[Mapping[str, Union[str, bool, int, float]]] = None,
    packages: Optional[Mapping[str, Union[str, PathLike[str]]]] = None,
    coupling: Optional[Literal["file"]] = None,
    effects: Optional[Literal["file"]] = None,
    allow_unphysical_inertia: bool = False,
    first_of_duplicates: bool = False,
    leave_out: Iterable[Literal["flex", "composite", "plugin", "constraint", "solver", "contact"]] = ...,
    allow_unknown_version: bool = False,
    snap_angles: Optional[float] = None,
    given_contacts: Iterable[Sequence[Union[str, int]]] = ...,
) -> Robot: ...
def loads(
    text: Union[str, bytes, bytearray, memoryview],
    name: str = "robot.urdf",
    base: _Base = "fixed",
    gravity: Optional[ArrayLike] = ...,
    frames: Optional[Iterable[str]] = None,
    wrenches_in: _Reference = "body",
    *,
    args: Optional[Mapping[str, Union[str, bool, int, float]]] = None,
    coupling: Optional[Literal["file"]] = None,
    effects: Optional[Literal["file"]] = None,
    allow_unphysical_inertia: bool = False,
    first_of_duplicates: bool = False,
    leave_out: Iterable[Literal["flex", "composite", "plugin", "constraint", "solver", "contact"]] = ...,
    allow_unknown_version: bool = False,
    snap_angles: Optional[float] = None,
    given_contacts: Iterable[Sequence[Union[str, int]]] = ...,
) -> Robot: ...
def bundled(
    name: str,
    base: Optional[_Base] = None,
    gravity: Optional[ArrayLike] = ...,
    frames: Optional[Iterable[str]] = None,
    wrenches_in: _Reference = "body",
) -> Robot: ...

@@FUNCTIONS@@
class Robot(_Functions):
    @property
    def name(self) -> str: ...
    @property
    def base(self) -> _Base: ...
    @property
    def nq(self) -> int: ...
    @property
    def nv(self) -> int: ...
    @property
    def joints(self) -> tuple[Joint, ...]: ...
    @property
    def actuators(self) -> tuple[Actuator, ...]: ...
    @property
    def frames(self) -> tuple[str, ...]: ...
    @property
    def links(self) -> tuple[str, ...]: ...
    @property
    def lower(self) -> NDArray[np.float64]: ...
    @property
    def upper(self) -> NDArray[np.float64]: ...
    @property
    def velocity_limit(self) -> NDArray[np.float64]: ...
    @property
    def effort_limit(self) -> NDArray[np.float64]: ...
    @property
    def gravity(self) -> NDArray[np.float64]: ...
    @property
    def moving_mass(self) -> float: ...
    @property
    def neutral(self) -> NDArray[np.float64]: ...
    @property
    def wrenches_in(self) -> _Reference: ...
    @property
    def unused(self) -> tuple[str, ...]: ...
    def with_gravity(self, gravity: ArrayLike) -> Robot: ...
    def with_frames(self, frames: Iterable[str]) -> Robot: ...
    def with_wrenches_in(self, reference: _Reference) -> Robot: ...
    def lock(self, joint: Union[str, Mapping[str, ArrayLike]], at: ArrayLike = 0.0) -> Robot: ...
    def couple(
        self,
        joint: str,
        leaders: Union[str, Mapping[str, float]],
        offset: float = 0.0,
        *,
        polynomial: Optional[ArrayLike] = None,
        reference: float = 0.0,
    ) -> Robot: ...
    def payload(
        self, link: str, mass: float, center_of_mass: ArrayLike = ..., inertia: Optional[ArrayLike] = None
    ) -> Robot: ...
    def append(
        self,
        other: Union[Robot, str, bytes, PathLike[str], PathLike[bytes]],
        at: str,
        prefix: str = "",
        position: ArrayLike = ...,
        rpy: ArrayLike = ...,
    ) -> Robot: ...
    def call(self, name: str, *arguments: ArrayLike, threads: Optional[int] = None, out: Optional[_Array] = None) -> Any: ...
    def compile(
        self, functions: Iterable[str], *, flags: Iterable[str] = ..., batch: bool = False, derivatives: Iterable[str] = ...
    ) -> CompiledRobot: ...
    def derivative(self, request: str) -> Derivative: ...
    def rollout(
        self,
        q: ArrayLike,
        v: ArrayLike,
        tau: ArrayLike,
        h: float,
        *,
        method: str = "semi_implicit_euler",
        every: int = 1,
        threads: Optional[int] = None,
    ) -> Rollout: ...
    def rollout_gradient(
        self,
        q: ArrayLike,
        v: ArrayLike,
        tau: ArrayLike,
        h: float,
        *,
        weights_q: Optional[ArrayLike] = None,
        weights_v: Optional[ArrayLike] = None,
        method: str = "semi_implicit_euler",
        threads: Optional[int] = None,
    ) -> RolloutGradient: ...
    def actuated_rollout(
        self,
        q: ArrayLike,
        v: ArrayLike,
        ctrl: ArrayLike,
        h: float,
        *,
        act: Optional[ArrayLike] = None,
        method: str = "implicit_velocity",
        every: int = 1,
        threads: Optional[int] = None,
    ) -> ActuatedRollout: ...
    def constrained_rollout(
        self,
        q: ArrayLike,
        v: ArrayLike,
        ctrl: ArrayLike,
        h: float,
        *,
        act: Optional[ArrayLike] = None,
        method: str = "implicit_damping",
        every: int = 1,
        threads: Optional[int] = None,
    ) -> ActuatedRollout: ...
    def actuated_rollout_gradient(
        self,
        q: ArrayLike,
        v: ArrayLike,
        ctrl: ArrayLike,
        h: float,
        *,
        act: Optional[ArrayLike] = None,
        weights_q: Optional[ArrayLike] = None,
        weights_v: Optional[ArrayLike] = None,
        weights_act: Optional[ArrayLike] = None,
        method: str = "implicit_velocity",
        threads: Optional[int] = None,
    ) -> ActuatedRolloutGradient: ...
    def contact_forces(
        self, q: ArrayLike, v: ArrayLike, ctrl: Optional[ArrayLike] = None, *, act: Optional[ArrayLike] = None
    ) -> ContactForces: ...
    def constrained_step(
        self,
        q: ArrayLike,
        v: ArrayLike,
        ctrl: Optional[ArrayLike],
        h: float,
        *,
        act: Optional[ArrayLike] = None,
        contacts: Optional[ArrayLike] = None,
        warm: Optional[ArrayLike] = None,
        method: str = "implicit_damping",
    ) -> ConstrainedStep: ...
    @property
    def given_contacts(self) -> list[tuple[str, str]]: ...
    @property
    def contact_shapes(self) -> list[tuple[str, str]]: ...
    def constrained_rollout_gradient(
        self,
        q: ArrayLike,
        v: ArrayLike,
        ctrl: ArrayLike,
        h: float,
        *,
        act: Optional[ArrayLike] = None,
        weights_q: Optional[ArrayLike] = None,
        weights_v: Optional[ArrayLike] = None,
        weights_act: Optional[ArrayLike] = None,
        method: str = "implicit_damping",
        threads: Optional[int] = None,
    ) -> ActuatedRolloutGradient: ...
    def mujoco_state(self, q: ArrayLike, v: ArrayLike) -> MujocoState: ...
    def state_of_mujoco(self, qpos: ArrayLike, qvel: ArrayLike) -> State: ...
    def wheel(
        self,
        folder: Union[str, PathLike[str]],
        functions: Iterable[str] = ...,
        *,
        name: Optional[str] = None,
        version: str = "0.1.0",
        flags: Iterable[str] = ...,
        batch: bool = False,
    ) -> Path: ...
    def placements_matrices(self, q: ArrayLike, *, threads: Optional[int] = None) -> NDArray[np.float64]: ...
    def random_configuration(
        self,
        rng: Union[np.random.Generator, int, Sequence[int], None] = None,
        size: Union[int, Sequence[int], None] = None,
        *,
        uniform: Optional[ArrayLike] = None,
        threads: Optional[int] = None,
    ) -> NDArray[np.float64]: ...
'''


def method(function):
    given = "".join(f"{name}: ArrayLike, " for name, _, _ in function.takes)
    # Of one state a single number is a float, of several an array.
    result = "_Array" if function.gives else "Any"
    shape = ", ".join(str(one) for one in function.gives) or "one number"
    return (
        f"    def {function.name}(self, {given}*, threads: Optional[int] = None, out: Optional[_Array] = None) -> {result}:\n"
        f'        """{function.summary}. [{shape}] {function.unit}."""\n'
    )


# A compiled robot has the functions that the call of `compile` lists.
COMPILED = """
class Derivative:
    request: str
    takes: tuple[tuple[str, tuple[int, ...], str], ...]
    gives: tuple[tuple[str, tuple[int, ...], str], ...]

    def __call__(self, *arguments: ArrayLike, threads: Optional[int] = None) -> Any: ...
    def compile(self, *, flags: Iterable[str] = ..., batch: bool = True) -> Derivative: ...

class State(NamedTuple):
    q: NDArray[np.float64]
    v: NDArray[np.float64]

class MujocoState(NamedTuple):
    qpos: NDArray[np.float64]
    qvel: NDArray[np.float64]

class Rollout(NamedTuple):
    q: NDArray[np.float64]
    v: NDArray[np.float64]

class RolloutGradient(NamedTuple):
    q: NDArray[np.float64]
    v: NDArray[np.float64]
    tau: NDArray[np.float64]

class ActuatedRollout(NamedTuple):
    q: NDArray[np.float64]
    v: NDArray[np.float64]
    act: NDArray[np.float64]

class ActuatedRolloutGradient(NamedTuple):
    q: NDArray[np.float64]
    v: NDArray[np.float64]
    act: NDArray[np.float64]
    ctrl: NDArray[np.float64]

class ConstrainedStep(NamedTuple):
    q: NDArray[np.float64]
    v: NDArray[np.float64]
    act: NDArray[np.float64]
    warm: NDArray[np.float64]

class ContactForces(NamedTuple):
    acts: NDArray[np.bool_]
    point: NDArray[np.float64]
    normal: NDArray[np.float64]
    force: NDArray[np.float64]
    moment: NDArray[np.float64]
    relative_error: NDArray[np.float64]
    search_steps: NDArray[np.int64]

class CompiledRobot(_Functions):
    robot: Robot
    functions: tuple[str, ...]
    path: PathLike[str]
"""


def package(rows):
    """The types of the package. Robots and compiled robots share their functions; random_configuration has two signatures."""
    shared = "class _Functions:\n" + "".join(method(f) for f in rows if f.name != "random_configuration") + "\n"
    own = "".join(method(f) for f in rows if f.name == "random_configuration")
    return HEAD.replace("@@FUNCTIONS@@\n", shared) + COMPILED + own


def derivatives(library, array, imported):
    """The types of articulated.torch or articulated.jax."""
    lines = [
        f'"""Functions of a robot with exact derivatives for {library}. Made by tests/stubs.py from the table of functions."""\n',
        f"from typing import Any, Optional, Union\n\n{imported}\n\nfrom . import CompiledRobot, Robot\n",
    ]
    for name, rule in _gradients.RULES.items():
        given = "".join(f"{argument}: {array}, " for argument, _, _ in rule.takes)
        result = "Any" if library == "JAX" else array
        lines.append(f"def {name}(robot: Union[Robot, CompiledRobot], {given}*, threads: Optional[int] = None) -> {result}: ...")
    return "\n".join(lines) + "\n"


# Types of articulated.viser and articulated.rerun.
VISER = '''"""A robot in viser. Made by tests/stubs.py."""

from os import PathLike
from typing import Any, Iterable, Optional, Union

from numpy.typing import ArrayLike

from . import CompiledRobot, Robot

class Viewer:
    # A viser.ViserServer.
    server: Any
    def __init__(
        self,
        robot: Union[Robot, CompiledRobot],
        server: Optional[Any] = None,
        *,
        name: str = "robot",
        frames: Iterable[str] = ...,
        packages: Iterable[Union[str, PathLike[str]]] = ...,
    ) -> None: ...
    def show(self, q: ArrayLike) -> None: ...
'''
RERUN = '''"""A robot in rerun. Made by tests/stubs.py."""

from os import PathLike
from typing import Any, Iterable, Optional, Union

from numpy.typing import ArrayLike

from . import CompiledRobot, Robot

class Viewer:
    def __init__(
        self,
        robot: Union[Robot, CompiledRobot],
        path: str = "robot",
        *,
        frames: Iterable[str] = ...,
        packages: Iterable[Union[str, PathLike[str]]] = ...,
        recording: Optional[Any] = None,
    ) -> None: ...
    def show(self, q: ArrayLike) -> None: ...
'''


def main():
    rows = articulated.functions()
    texts = {
        "__init__.pyi": package(rows),
        "torch.pyi": derivatives("PyTorch", "Tensor", "from torch import Tensor"),
        "jax.pyi": derivatives("JAX", "ArrayLike", "from numpy.typing import ArrayLike"),
        "viser.pyi": VISER,
        "rerun.pyi": RERUN,
    }
    for name, text in texts.items():
        if "--check" not in sys.argv[1:]:
            (FOLDER / name).write_text(text, encoding="utf-8")
        elif (FOLDER / name).read_text(encoding="utf-8") != text:
            sys.exit(f"{name} is not up to date: run python tests/stubs.py")


if __name__ == "__main__":
    main()
