"""A robot in rerun, a viewer of recordings: ``pip install "articulated[rerun]"``.

>>> import articulated.rerun, rerun
>>> rerun.init("arm", spawn=True)                                          # doctest: +SKIP
>>> viewer = articulated.rerun.Viewer(articulated.bundled("panda_like"))   # doctest: +SKIP
>>> rerun.set_time("time", duration=0.1)                                   # doctest: +SKIP
>>> viewer.show(q)                                                         # doctest: +SKIP
"""

import numpy as np

from ._drawing import chosen, configuration, drawing, robot_of

try:
    import rerun
except ImportError as error:
    raise ImportError(f'articulated.rerun: found no rerun ({error}), expected it to be installed: pip install "articulated[rerun]"') from None


class Viewer:
    """A robot in a recording of rerun: its shapes are logged once, and placements by ``show``, at the time that ``rerun.set_time`` sets.

    Args:
        robot: The robot; a compiled one too.
        path: The robot's path in the recording, such as "world/arm".
        frames: Names of the frames whose axes are drawn.
        packages: Folders of ROS packages, or NAME=FOLDER, for meshes named package://NAME/…
        recording: A ``rerun.RecordingStream``; None for the active one.

    Raises:
        RobotError: The robot has no such frame, or a package is not there.

    Warns:
        RobotWarning: A mesh cannot be drawn as it is.
    """

    def __init__(self, robot, path="robot", *, frames=(), packages=(), recording=None):
        self._robot, self._recording = robot_of(robot), recording
        drawn, frames = drawing(self._robot, packages), chosen("frames", self._robot, frames)
        names = tuple(dict.fromkeys((*drawn.bodies, *frames)))
        self._framed = self._robot.with_frames(names)
        root = [part for part in path.split("/") if part]
        # Paths as lists: names of links may have any characters.
        self._paths = [[*root, name] for name in names]
        for number, shape in enumerate(drawn.shapes):
            place = root if shape.body < 0 else [*root, drawn.bodies[shape.body]]
            color = [round(255 * part) for part in shape.color]
            mesh = rerun.Mesh3D(vertex_positions=shape.points, triangle_indices=shape.triangles, albedo_factor=color)
            self._log([*place, f"{shape.link}_shape_{number}"], mesh, static=True)
        for name in frames:
            axes = rerun.Arrows3D(vectors=0.12 * drawn.size * np.eye(3), colors=[[198, 40, 40], [46, 125, 50], [21, 101, 192]])
            self._log([*root, name, "axes"], axes, static=True)

    def show(self, q):
        """Logs the placements of the robot at ``q``, (nq,), rad|m|unit quaternion."""
        for path, placement in zip(self._paths, self._framed.placements_matrices(configuration(self._robot, q))):
            self._log(path, rerun.Transform3D(translation=placement[:3, 3], mat3x3=placement[:3, :3]))

    def _log(self, path, what, static=False):
        rerun.log(path, what, static=static, recording=self._recording)
