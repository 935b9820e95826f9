"""A robot in viser. Made by tests/stubs.py."""

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
