"""Types of the package. Made by tests/stubs.py from the table of functions."""

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

class _Functions:
    def placements(self, q: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """placements of all frames in the world frame. [frames, 12] rotation row by row, then position in m, in the world frame."""
    def twists_body(self, q: ArrayLike, v: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """twists of all frames, in their own axes about their own origins. [frames, 6] [ω; v], rad/s and m/s."""
    def twists_world(self, q: ArrayLike, v: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """twists of all frames, in world axes about the world frame's origin. [frames, 6] [ω; v], rad/s and m/s."""
    def twists_world_aligned(self, q: ArrayLike, v: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """twists of all frames, in world axes about their own origins. [frames, 6] [ω; ṗ], rad/s and m/s."""
    def accelerations_body(self, q: ArrayLike, v: ArrayLike, a: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """time derivatives of twists_body: spatial accelerations in body axes, gravity not added. [frames, 6] rad/s² and m/s²."""
    def accelerations_world(self, q: ArrayLike, v: ArrayLike, a: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """time derivatives of twists_world: spatial accelerations in world axes, gravity not added. [frames, 6] rad/s² and m/s²."""
    def accelerations_world_aligned(self, q: ArrayLike, v: ArrayLike, a: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """time derivatives of twists_world_aligned: the true accelerations of the origins, gravity not added. [frames, 6] [ω̇; p̈], rad/s² and m/s²."""
    def jacobians_body(self, q: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """Jacobians of all frames: twists_body = J v. [frames, 6, nv] rows [ω; v]."""
    def jacobians_world(self, q: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """Jacobians of all frames: twists_world = J v. [frames, 6, nv] rows [ω; v]."""
    def jacobians_world_aligned(self, q: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """Jacobians of all frames: twists_world_aligned = J v. [frames, 6, nv] rows [ω; ṗ]."""
    def jacobian_rates_body(self, q: ArrayLike, v: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """dJ/dt of jacobians_body. [frames, 6, nv] 1/s and m/s."""
    def jacobian_rates_world(self, q: ArrayLike, v: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """dJ/dt of jacobians_world. [frames, 6, nv] 1/s and m/s."""
    def jacobian_rates_world_aligned(self, q: ArrayLike, v: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """dJ/dt of jacobians_world_aligned. [frames, 6, nv] 1/s and m/s."""
    def bias_accelerations_body(self, q: ArrayLike, v: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """dJ/dt·v of jacobians_body: accelerations at a = 0. [frames, 6] rad/s² and m/s²."""
    def bias_accelerations_world(self, q: ArrayLike, v: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """dJ/dt·v of jacobians_world: accelerations at a = 0. [frames, 6] rad/s² and m/s²."""
    def bias_accelerations_world_aligned(self, q: ArrayLike, v: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """dJ/dt·v of jacobians_world_aligned: accelerations at a = 0. [frames, 6] [ω̇; p̈], rad/s² and m/s²."""
    def placement_derivatives(self, q: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """∂(placements)/∂q in the tangent space. [frames, 12, nv] of rotation row by row, then position; 1 and m a unit step."""
    def inverse_dynamics(self, q: ArrayLike, v: ArrayLike, a: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """τ = M(q)·a + h(q, v), gravity included. [nv] N·m|N."""
    def inverse_dynamics_with_wrenches(self, q: ArrayLike, v: ArrayLike, a: ArrayLike, wrenches: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """τ = M(q)·a + h(q, v) − Σ Jᵀw, with external wrenches w on the frames. [nv] N·m|N."""
    def joint_wrenches(self, q: ArrayLike, v: ArrayLike, a: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """the wrench that each joint passes to its child link. [links, 6] [m; f], N·m and N, in axes of the link about its origin."""
    def bias_forces(self, q: ArrayLike, v: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """h(q, v) = τ at a = 0: Coriolis, centrifugal and gravity forces. [nv] N·m|N."""
    def gravity_torque(self, q: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """g(q) = τ at v = a = 0: what holds the robot still. [nv] N·m|N."""
    def static_torque(self, q: ArrayLike, wrenches: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """g(q) − Σ Jᵀw: what holds the robot still under external wrenches w on the frames. [nv] N·m|N."""
    def mass_matrix(self, q: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """M(q). [nv, nv] kg·m²|kg·m|kg, symmetric."""
    def coriolis_matrix(self, q: ArrayLike, v: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """C(q, v) of the links alone, with C v + g = h without effects, and Ṁ − 2C skew: that of the Christoffel symbols. [nv, nv] N·m·s|N·s|N·s/m."""
    def forward_dynamics(self, q: ArrayLike, v: ArrayLike, tau: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """a = M(q)⁻¹·(τ − h(q, v)). [nv] rad/s²|m/s²."""
    def forward_dynamics_with_wrenches(self, q: ArrayLike, v: ArrayLike, tau: ArrayLike, wrenches: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """a = M(q)⁻¹·(τ + Σ Jᵀw − h(q, v)), with external wrenches w on the frames. [nv] rad/s²|m/s²."""
    def mass_matrix_inverse(self, q: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """M(q)⁻¹. [nv, nv] 1/(kg·m²)|…, symmetric."""
    def solve_mass_matrix(self, q: ArrayLike, tau: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """M(q)⁻¹·τ, without M⁻¹. [nv] rad/s²|m/s²."""
    def kinetic_energy(self, q: ArrayLike, v: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> Any:
        """T = ½ Σ Vᵀ G V = ½ vᵀ M v of the moving links. [one number] J."""
    def potential_energy(self, q: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> Any:
        """U = −Σ m gᵀc of the moving links. [one number] J, zero at the world frame's origin."""
    def center_of_mass(self, q: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """centre of mass of the moving links. [3] m, world axes."""
    def center_of_mass_velocity(self, q: ArrayLike, v: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """velocity of the centre of mass of the moving links. [3] m/s, world axes."""
    def center_of_mass_acceleration(self, q: ArrayLike, v: ArrayLike, a: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """acceleration of the centre of mass of the moving links, gravity not added. [3] m/s², world axes."""
    def center_of_mass_jacobian(self, q: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """J with center_of_mass_velocity = J v. [3, nv] m|1, world axes."""
    def centroidal_momentum(self, q: ArrayLike, v: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """momentum of the moving links about their centre of mass. [6] [k; l], N·m·s and N·s, world axes."""
    def centroidal_momentum_matrix(self, q: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """A with centroidal_momentum = A v. [6, nv] world axes."""
    def centroidal_momentum_rate(self, q: ArrayLike, v: ArrayLike, a: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """d/dt of centroidal_momentum = A a + Ȧ v. [6] [k̇; l̇], N·m and N, world axes."""
    def inverse_dynamics_derivatives(self, q: ArrayLike, v: ArrayLike, a: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """first derivatives of inverse_dynamics; q in the tangent space. [3, nv, nv] ∂τ/∂q, ∂τ/∂v, ∂τ/∂a = M; rows τ."""
    def inverse_dynamics_derivatives_with_wrenches(self, q: ArrayLike, v: ArrayLike, a: ArrayLike, wrenches: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """first derivatives of inverse_dynamics_with_wrenches; q in the tangent space, wrenches constant in their reference. [3, nv, nv] ∂τ/∂q, ∂τ/∂v, ∂τ/∂a = M; rows τ."""
    def forward_dynamics_derivatives(self, q: ArrayLike, v: ArrayLike, tau: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """first derivatives of forward_dynamics; q in the tangent space. [3, nv, nv] ∂a/∂q, ∂a/∂v, ∂a/∂τ = M⁻¹; rows a."""
    def forward_dynamics_derivatives_with_wrenches(self, q: ArrayLike, v: ArrayLike, tau: ArrayLike, wrenches: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """first derivatives of forward_dynamics_with_wrenches; q in the tangent space, wrenches constant in their reference. [3, nv, nv] ∂a/∂q, ∂a/∂v, ∂a/∂τ = M⁻¹; rows a."""
    def static_torque_derivative(self, q: ArrayLike, wrenches: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """∂(static_torque)/∂q in the tangent space, wrenches constant in their reference. [nv, nv] N·m|N per unit step, rows τ."""
    def torque_regressor(self, q: ArrayLike, v: ArrayLike, a: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """Y with inverse_dynamics = Y π without effects, π the inertial parameters of the moving links in their axes. [nv, links, 10] per m, m c, I_xx I_xy I_xz I_yy I_yz I_zz about the link's origin."""
    def joint_regressor(self, v: ArrayLike, a: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """torques of each degree of freedom per unit of its damping, dry friction and armature: v, v/√(v² + s²), a; s is the speed of friction, or 1e-5. [nv, 3] per N·m·s/rad|N·s/m, N·m|N, kg·m²|kg."""
    def kinetic_energy_regressor(self, q: ArrayLike, v: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """y with kinetic_energy = yᵀπ without effects. [links, 10] per m, m c, I_xx I_xy I_xz I_yy I_yz I_zz about the link's origin."""
    def potential_energy_regressor(self, q: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """y with potential_energy = yᵀπ without effects. [links, 10] per m, m c, I_xx I_xy I_xz I_yy I_yz I_zz about the link's origin."""
    def operational_space_inertia(self, q: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """Λ = (J M⁻¹ Jᵀ)⁻¹ of each frame by itself, J that of jacobians_world_aligned. [frames, 6, 6] kg·m²|kg·m|kg, symmetric."""
    def operational_space_inertia_inverse(self, q: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """Λ⁻¹ = J M⁻¹ Jᵀ of each frame by itself, J that of jacobians_world_aligned. [frames, 6, 6] 1/(kg·m²)|…, symmetric."""
    def effect_forces(self, q: ArrayLike, v: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """generalised forces of all effects but gravity, inertia and motors; zero without a scene. [nv] N·m|N."""
    def dissipation(self, q: ArrayLike, v: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> Any:
        """power of the effects that are not conservative: d(T + U)/dt = vᵀτ + this. [one number] W."""
    def motor_torques(self, v: ArrayLike, tau: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """the torques that motors deliver when commanded tau; forward dynamics applies this itself. [nv] N·m|N."""
    def integrate(self, q: ArrayLike, step: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """q ⊕ step: along the step for a unit of time, on the manifold. [nq] rad|m|unit quaternion."""
    def difference(self, q: ArrayLike, target: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """target ⊖ q: the step with q ⊕ step = target. [nv] rad|m."""
    def integrate_derivatives(self, step: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """∂(q ⊕ step)/∂q, ∂(q ⊕ step)/∂step, the same for every q; q in the tangent space. [2, nv, nv] 1|m, rows: the step where it ends."""
    def difference_derivatives(self, q: ArrayLike, target: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """∂(target ⊖ q)/∂q, ∂(target ⊖ q)/∂target; both in the tangent space. [2, nv, nv] 1|m, rows the difference."""

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
    def random_configuration(self, uniform: ArrayLike, *, threads: Optional[int] = None, out: Optional[_Array] = None) -> _Array:
        """a configuration at random within limits, ±π rad and ±1 m where there are none, rotations uniform. [nq] rad|m|unit quaternion."""
