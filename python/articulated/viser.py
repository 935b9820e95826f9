"""A robot in viser, a viewer in the browser: ``pip install "articulated[viser]"``.

>>> import articulated.viser
>>> viewer = articulated.viser.Viewer(articulated.bundled("panda_like"))   # doctest: +SKIP
>>> viewer.show(q)                                                         # doctest: +SKIP
"""

from ._drawing import chosen, configuration, drawing, robot_of

try:
    import viser
    from viser.transforms import SO3
except ImportError as error:
    raise ImportError(f'articulated.viser: found no viser ({error}), expected it to be installed: pip install "articulated[viser]"') from None


class Viewer:
    """A robot in the scene of a viser server.

    Args:
        robot: The robot; a compiled one too.
        server: A ``viser.ViserServer``; None for a new one on 127.0.0.1. It is in ``server``.
        name: The robot's name in the scene.
        frames: Names of the frames whose axes are drawn.
        packages: Folders of ROS packages, or NAME=FOLDER, for meshes named package://NAME/…

    Raises:
        RobotError: The robot has no such frame, or a package is not there.

    Warns:
        RobotWarning: A mesh cannot be drawn as it is.
    """

    def __init__(self, robot, server=None, *, name="robot", frames=(), packages=()):
        self._robot = robot_of(robot)
        drawn, frames = drawing(self._robot, packages), chosen("frames", self._robot, frames)
        self.server = viser.ViserServer(host="127.0.0.1") if server is None else server
        scene = self.server.scene
        names = tuple(dict.fromkeys((*drawn.bodies, *frames)))
        self._framed = self._robot.with_frames(names)
        # A body's frame has its shapes; a frame that is drawn has axes.
        size = {"axes_length": 0.12 * drawn.size, "axes_radius": 0.004 * drawn.size}
        # A slash in the name of a link would be a path of the scene.
        paths = {one: f"/{name}/{one.replace('/', '_')}" for one in names}
        scene.add_frame(f"/{name}", show_axes=False)
        self._handles = [scene.add_frame(path, show_axes=one in frames, **size) for one, path in paths.items()]
        for number, shape in enumerate(drawn.shapes):
            place = f"/{name}" if shape.body < 0 else paths[drawn.bodies[shape.body]]
            color, alpha = tuple(round(255 * part) for part in shape.color[:3]), shape.color[3]
            scene.add_mesh_simple(f"{place}/shape_{number}", shape.points, shape.triangles, color=color, opacity=alpha if alpha < 1 else None, flat_shading=True)
        self.show(self._robot.neutral)

    def show(self, q):
        """Draws the robot at ``q``, (nq,), rad|m|unit quaternion."""
        placements = self._framed.placements_matrices(configuration(self._robot, q))
        rotations = SO3.from_matrix(placements[:, :3, :3]).wxyz
        with self.server.atomic():
            for handle, placement, rotation in zip(self._handles, placements, rotations):
                handle.position, handle.wxyz = placement[:3, 3], rotation
