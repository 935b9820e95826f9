"""A robot in rerun. Made by tests/stubs.py."""

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
