"""A page that shows a robot as a program moves it."""

import json
import secrets
import threading
import warnings
import webbrowser

import numpy as np

from ._drawing import chosen, configuration, contents, page, polylines, robot_of
from ._errors import RobotWarning

# The newest points of a path that are kept.
_MOST_POINTS = 2000
# Seconds after which a page that hears nothing gets an empty line.
_SILENCE = 10.0


class Player:
    """A page in a browser that shows a robot at each configuration that ``show`` gets.

    >>> with articulated.Player(robot) as player:                # doctest: +SKIP
    ...     player.open()
    ...     for q in motion:
    ...         player.show(q, trace=["hand"])

    A server on 127.0.0.1 sends the page, and then placements. Its address has a token; requests
    without it are refused. A program in any language moves the robot by a POST of
    ``{"q": [...]}`` to ``/show``.

    Args:
        robot: The robot, with its edits; a compiled one too.
        q: (nq,), rad|m|unit quaternion: the configuration at first. None for ``robot.neutral``.
        title: The title of the page. None for the robot's name.
        packages: Folders of ROS packages, or NAME=FOLDER, for meshes named package://NAME/…, besides
            those of ``load``.

    Raises:
        RobotError: A package is not there.

    Warns:
        RobotWarning: A mesh cannot be drawn as it is.
    """

    def __init__(self, robot, q=None, *, title=None, packages=()):
        self._robot = robot_of(robot)
        q = self._robot.neutral if q is None else configuration(self._robot, q)
        self._page = page(self._robot, q, title, packages).encode()
        self._bodies = tuple(contents(self._page.decode())["bodies"])
        # Guards what is shown; tells pages of a new message, and waiters of a new page.
        self._changed = threading.Condition(threading.RLock())
        self._number, self._pages, self._is_closed, self._paths = 0, 0, False, {}
        self._sent = self._framed = None
        with self._changed:
            self._draw(q, (), (), [])
        self._token = secrets.token_urlsafe(24)
        # Imported here, as it takes as long as a tenth of the package.
        from ._server import Server

        self._server = Server(self)
        threading.Thread(target=self._server.serve_forever, kwargs={"poll_interval": 0.1}, name="articulated.Player", daemon=True).start()

    @property
    def url(self):
        """The address of the page, with its token. Who has it sees the robot, and may move it."""
        return f"http://127.0.0.1:{self._server.server_address[1]}/?token={self._token}"

    @property
    def pages(self):
        """The number of pages that are connected."""
        return self._pages

    @property
    def frames(self):
        """Names of the frames whose axes are drawn: x red, y green, z blue."""
        return self._frames

    @frames.setter
    def frames(self, names):
        self.show(self._q, frames=names)

    @property
    def trace(self):
        """Names of the frames whose paths are drawn. Setting them begins the paths anew."""
        return self._trace

    @trace.setter
    def trace(self, names):
        with self._changed:
            names = chosen("trace", self._robot, names)
            self._trace, self._paths = (), {}
            self.show(self._q, trace=names)

    def show(self, q, *, frames=None, trace=None, lines=None):
        """Draws the robot at ``q`` on all pages that are connected, and returns at once.

        A page that is slower than the calls draws the newest configuration. Several threads may call.

        Args:
            q: (nq,), rad|m|unit quaternion.
            frames: Names of the frames whose axes are drawn; None for those of the last call.
            trace: Names of the frames whose paths are drawn, from the call that first names them on;
                the newest 2000 points. None for those of the last call.
            lines: Lines in the world frame, (k, n, 3) or a list of arrays (n, 3), m, such as the paths of a
                hand in k rollouts. None for those of the last call, [] for none.

        Raises:
            RobotError: The robot has no such frame.
            TypeError, ValueError: q is not a configuration.
            RuntimeError: The player is closed.
        """
        with self._changed:
            if self._is_closed:
                raise RuntimeError("show: found a closed player, expected an open one")
            q = configuration(self._robot, q)
            frames = self._frames if frames is None else chosen("frames", self._robot, frames)
            trace = self._trace if trace is None else chosen("trace", self._robot, trace)
            lines = self._lines if lines is None else [np.ravel(line).tolist() for line in polylines(lines)]
            self._draw(q, frames, trace, lines)

    def open(self):
        """Opens the page in a browser, and returns its address."""
        if not webbrowser.open(self.url):
            warnings.warn(RobotWarning(f"open: found no browser, expected one to open {self.url}"), stacklevel=2)
        return self.url

    def wait(self, timeout=None):
        """Waits until a page is connected.

        Args:
            timeout: s; None for any time.

        Raises:
            TimeoutError: There is none after this time.
        """
        with self._changed:
            if not self._changed.wait_for(lambda: self._pages > 0 or self._is_closed, timeout):
                raise TimeoutError(f"wait: found no page after {timeout} s, expected one that is opened at {self.url}")
            if self._is_closed:
                raise RuntimeError("wait: found a closed player, expected an open one")

    def close(self):
        """Ends the server. Pages stay, and show the last configuration."""
        with self._changed:
            if self._is_closed:
                return
            self._is_closed = True
            self._changed.notify_all()
        self._server.shutdown()
        self._server.server_close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def __repr__(self):
        state = "closed" if self._is_closed else f"port {self._server.server_address[1]}, pages: {self._pages}"
        return f"<articulated.Player of {self._robot.name!r}: {state}>"

    def _draw(self, q, frames, trace, lines):
        """Makes the message of this configuration. Where it fails, all stays as it was."""
        sent = tuple(dict.fromkeys((*self._bodies, *frames, *trace)))
        framed = self._framed if sent == self._sent else self._robot.with_frames(sent)
        found = framed.placements(q)
        if not np.isfinite(found).all():
            raise ValueError(f"q: found {q.tolist()}, expected numbers of a size that has finite placements")
        self._q, self._frames, self._trace, self._sent, self._framed = q.copy(), frames, trace, sent, framed
        self._lines = lines
        placements = dict(zip(sent, found.tolist()))
        self._paths = {name: self._paths.get(name, []) for name in trace}
        for name, path in self._paths.items():
            point = placements[name][9:]
            if path[-1:] != [point]:
                path.append(point)
                del path[:-_MOST_POINTS]
        self._message = json.dumps({
            "placements": [placements[name] for name in self._bodies],
            "frames": {name: placements[name] for name in frames},
            "trace": {name: np.ravel(path).tolist() for name, path in self._paths.items()},
            "lines": lines,
        })
        self._number += 1
        self._changed.notify_all()

    def _messages(self):
        """The newest message whenever there is one, an empty text after silence; it ends when the player is closed."""
        seen = 0
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._number != seen or self._is_closed, _SILENCE)
                if self._is_closed:
                    return
                message = self._message if self._number != seen else ""
                seen = self._number
            yield message

    def _connected(self, change):
        with self._changed:
            self._pages += change
            self._changed.notify_all()
