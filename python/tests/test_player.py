"""A page that shows a robot as a program moves it: its server, without a browser."""

import http.client
import json
import socket
import threading
import webbrowser
from urllib.parse import urlsplit

import articulated
import numpy as np
import pytest

# Two links in the plane x-y, 0.5 m and 0.3 m long, and a frame at the end. No link has a mass.
PLANAR = """<robot name="planar"><link name="base"/><link name="upper"/><link name="lower"/><link name="tip"/>
<joint name="a" type="continuous"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/></joint>
<joint name="b" type="continuous"><parent link="upper"/><child link="lower"/><origin xyz="0.5 0 0"/><axis xyz="0 0 1"/></joint>
<joint name="c" type="fixed"><parent link="lower"/><child link="tip"/><origin xyz="0.3 0 0"/></joint></robot>"""


def tip(q):
    """The placement of the frame at the end, in closed form."""
    a, b = q[0], q[0] + q[1]
    c, s = np.cos(b), np.sin(b)
    return [c, -s, 0, s, c, 0, 0, 0, 1, 0.5 * np.cos(a) + 0.3 * c, 0.5 * np.sin(a) + 0.3 * s, 0]


@pytest.fixture(scope="module")
def robot():
    return articulated.loads(PLANAR)


@pytest.fixture
def player(robot):
    with articulated.Player(robot) as player:
        yield player


def address(player):
    parts = urlsplit(player.url)
    return parts.hostname, parts.port, parts.query.removeprefix("token=")


def request(player, method, path, body=None, headers=()):
    host, port, _ = address(player)
    connection = http.client.HTTPConnection(host, port, timeout=10)
    try:
        connection.request(method, path, body, dict(headers))
        answer = connection.getresponse()
        return answer.status, answer.read().decode(), answer.headers
    finally:
        connection.close()


class Listener:
    """What a page does: it reads events."""

    def __init__(self, player):
        host, port, token = address(player)
        self.connection = http.client.HTTPConnection(host, port, timeout=10)
        self.connection.request("GET", f"/events?token={token}")
        self.answer = self.connection.getresponse()
        assert self.answer.status == 200 and self.answer.headers["Content-Type"] == "text/event-stream"

    def event(self):
        lines = []
        while True:
            line = self.answer.readline().decode().rstrip("\n")
            if not line and lines:
                return lines
            lines += [line] if line else []

    def message(self):
        (line,) = self.event()
        return json.loads(line.removeprefix("data: "))


def test_only_this_machine_and_only_with_the_token(player):
    host, port, token = address(player)
    assert host == "127.0.0.1" and len(token) >= 32
    assert player._server.socket.getsockname() == ("127.0.0.1", port)
    # Another address of this machine, as a neighbour sees it.
    with pytest.raises(OSError):
        socket.create_connection(("127.0.0.2", port), timeout=5).close()
    before = player._message
    for wrong in ["", "?token=", f"?token={token[:-1]}", f"?token={token}x", "?token=%ff", f"?TOKEN={token}"]:
        for method, path in [("GET", "/"), ("GET", "/events"), ("GET", "/other"), ("POST", "/show")]:
            status, text, _ = request(player, method, path + wrong, '{"q": [1, 1]}' if method == "POST" else None)
            assert status == 403 and "expected that of Player.url" in text, (method, path, wrong)
            assert "planar" not in text
    for wrong in ["Bearer", f"Bearer {token}x", f"Basic {token}"]:
        assert request(player, "POST", "/show", '{"q": [1, 1]}', {"Authorization": wrong})[0] == 403
    assert player._message == before and player.pages == 0


def test_the_page(player):
    _, _, token = address(player)
    status, text, headers = request(player, "GET", f"/?token={token}")
    assert status == 200 and "<title>planar</title>" in text and token not in text
    assert headers["Referrer-Policy"] == "no-referrer" and "connect-src 'self'" in headers["Content-Security-Policy"]
    assert request(player, "GET", f"/other?token={token}")[0] == 404 and request(player, "POST", f"/?token={token}", "{}")[0] == 404


def test_configurations_reach_all_pages(player, robot):
    player.show([0.1, 0.2], frames=["tip"])
    listeners = [Listener(player), Listener(player)]
    player.wait(10)
    for q in [[0.1, 0.2], [1.0, -0.5], [-2.0, 3.0]]:
        player.show(q)
        for listener in listeners:
            message = listener.message()
            # The newest of those that came meanwhile.
            while not np.allclose(message["frames"]["tip"], tip(q), atol=1e-12):
                message = listener.message()
            assert len(message["placements"]) == 2 and message["trace"] == {}
            np.testing.assert_allclose(message["placements"][1][:9], tip(q)[:9], atol=1e-12)
            np.testing.assert_allclose(message["placements"][1][9:], [0.5 * np.cos(q[0]), 0.5 * np.sin(q[0]), 0], atol=1e-12)
    assert player.pages == 2


def test_frames_and_paths(player):
    path = [[0.1 * k, 0.2 * k] for k in range(5)]
    for q in path:
        player.show(q, trace=["tip", "upper"])
    player.show(path[-1])
    listener = Listener(player)
    message = listener.message()
    # A point that is there already is not repeated.
    np.testing.assert_allclose(np.reshape(message["trace"]["tip"], (-1, 3)), [tip(q)[9:] for q in path], atol=1e-12)
    assert message["trace"]["upper"] == [0.0, 0.0, 0.0] and message["frames"] == {}
    assert (player.frames, player.trace) == ((), ("tip", "upper"))
    player.frames = ["base", "tip", "base"]
    assert list(json.loads(player._message)["frames"]) == ["base", "tip"]
    player.trace = ["tip"]
    assert json.loads(player._message)["trace"] == {"tip": pytest.approx(tip(path[-1])[9:])}
    player.trace = []
    assert json.loads(player._message)["trace"] == {}


def test_lines_stay_until_others_are_given(player):
    fan = np.arange(24.0).reshape(2, 4, 3)
    player.show([0.1, 0.2], lines=fan)
    player.show([0.2, 0.2])
    assert json.loads(player._message)["lines"] == [list(map(float, range(12))), list(map(float, range(12, 24)))]
    player.show([0.2, 0.2], lines=[[[0, 0, 1], [1, 0, 1]], np.zeros((0, 3))])
    assert json.loads(player._message)["lines"] == [[0, 0, 1, 1, 0, 1], []]
    for lines, error, message in (
        (3, TypeError, "lines: found int, expected a list"),
        ([[1.0, 2.0, 3.0]], ValueError, r"lines: found shape \(3,\) at \[0\]"),
        ([np.full((2, 3), np.nan)], ValueError, "not finite at \\[0\\]"),
        (["ab"], TypeError, "lines: found dtype"),
    ):
        with pytest.raises(error, match=message):
            player.show([0.1, 0.2], lines=lines)
    player.show([0.2, 0.2], lines=[])
    assert json.loads(player._message)["lines"] == []


def test_a_path_has_an_end(player):
    for k in range(2100):
        player.show([0.001 * k, 0.0], trace=["tip"])
    points = np.reshape(json.loads(player._message)["trace"]["tip"], (-1, 3))
    assert len(points) == 2000
    np.testing.assert_allclose(points[0], tip([0.1, 0.0])[9:], atol=1e-12)


def test_frames_of_a_robot_with_a_few(robot):
    with articulated.Player(robot.with_frames(["tip"])) as player:
        player.show([0.3, 0.4], frames=["base", "tip"])
        message = json.loads(player._message)
        assert len(message["placements"]) == 2
        np.testing.assert_allclose(message["frames"]["tip"], tip([0.3, 0.4]), atol=1e-12)


@pytest.mark.parametrize("q, error, message", [
    ([0.1], ValueError, "q: found shape (1,), expected (2,), one configuration"),
    ([[0.1, 0.2]], ValueError, "q: found shape (1, 2), expected (2,)"),
    ([0.1, np.nan], ValueError, "q: found nan at [1], expected finite numbers"),
    ([0.1, "far"], TypeError, "q: found dtype"),
    (None, TypeError, "q: found "),
])
def test_bad_configurations(player, robot, q, error, message):
    with pytest.raises(error) as found:
        player.show(q)
    assert message in str(found.value)
    if q is not None:
        with pytest.raises(error, match="q: found"):
            articulated.Player(robot, q)


def test_what_fails_changes_nothing():
    robot = articulated.bundled("quadruped")
    with articulated.Player(robot) as player:
        player.show(robot.neutral, trace=[robot.frames[0]])
        before = player._message
        with pytest.raises(ValueError, match="expected numbers of a size that has finite placements"):
            player.show(np.full(robot.nq, 1e308), frames=[robot.frames[1]], trace=[])
        assert (player._message, player.frames, player.trace) == (before, (), (robot.frames[0],))


def test_bad_names(player, robot):
    with pytest.raises(articulated.RobotError, match='did you mean "tip"'):
        player.show([0.0, 0.0], frames=["tpi"])
    with pytest.raises(articulated.RobotError, match='found "tpi"'):
        player.trace = ["tpi"]
    with pytest.raises(TypeError, match="frames: found 'tip', expected a list of names"):
        player.show([0.0, 0.0], frames="tip")
    with pytest.raises(TypeError, match="robot: found str"):
        articulated.Player("planar")
    with pytest.raises(articulated.RobotError, match="packages: found no folder"):
        articulated.Player(robot, packages=["no/such"])
    with pytest.raises(TypeError, match="packages: found int"):
        articulated.Player(robot, packages=[3])
    with pytest.raises(TypeError, match="title: found int, expected a name"):
        articulated.Player(robot, title=3)
    assert (player.frames, player.trace) == ((), ())


def test_another_program_moves_the_robot(player):
    host, port, token = address(player)
    connection = http.client.HTTPConnection(host, port, timeout=10)
    bearer = {"Authorization": f"Bearer {token}"}

    def post(body):
        connection.request("POST", "/show", body, bearer)
        answer = connection.getresponse()
        return answer.status, json.loads(answer.read())

    assert post('{"q": [0.5, -0.25], "frames": ["tip"], "trace": ["tip"]}\n') == (200, {"pages": 0})
    np.testing.assert_allclose(json.loads(player._message)["frames"]["tip"], tip([0.5, -0.25]), atol=1e-12)
    for body, found in [
        ('{"q": [0.5]}', "q: found shape (1,), expected (2,)"), ('{"q": [0.5, NaN]}', "q: found nan"), ('{"q": [0.5, "x"]}', "q: found dtype"),
        ('{"p": [0.5]}', "message: found 'p'"), ('{"frames": ["tip"]}', "message: found no q"), ("[0.5, 0.5]", "message: found list"), ("{", "message: found no JSON"),
        ("[" * 100000, "message: found no JSON"), (b"\xff", "message: found no JSON"), ('{"q": [0, 0], "frames": "tip"}', "frames: found 'tip'"),
    ]:
        status, answer = post(body)
        assert status == 400 and found in answer["error"], (body[:20], answer)
    # The same connection goes on.
    assert post('{"q": [0, 0]}')[0] == 200 and player.frames == ("tip",)
    connection.close()
    query = f"/show?token={token}"
    assert request(player, "POST", query, '{"q": [0.25, 0]}')[0] == 200
    assert request(player, "POST", query, "x" * (1 << 20))[0] == 400
    assert request(player, "POST", query, headers={"Content-Length": str(1 << 30)})[0] == 413
    assert request(player, "POST", query, headers={"Content-Length": "-1"})[0] == 411


def test_a_page_that_waits_and_one_that_leaves(player, monkeypatch):
    monkeypatch.setattr("articulated._player._SILENCE", 0.05)
    with pytest.raises(TimeoutError, match="wait: found no page after 0.05 s"):
        player.wait(0.05)
    listener = Listener(player)
    player.wait(10)
    assert player.pages == 1
    listener.answer.close()
    listener.connection.close()
    with player._changed:
        assert player._changed.wait_for(lambda: player.pages == 0, 10)


def test_close(robot):
    player = articulated.Player(robot, title="mine")
    assert "port" in repr(player) and address(player)[2] not in repr(player)
    listener = Listener(player)
    listener.message()
    host, port, token = address(player)
    player.close()
    player.close()
    assert listener.event() == ["event: end", "data:"] and listener.answer.readline() == b""
    with pytest.raises(OSError):
        socket.create_connection((host, port), timeout=5).close()
    for call in [lambda: player.show([0.0, 0.0]), lambda: player.wait(1)]:
        with pytest.raises(RuntimeError, match="found a closed player, expected an open one"):
            call()
    assert repr(player) == "<articulated.Player of 'planar': closed>"


def test_several_threads_show(player):
    threads = [threading.Thread(target=lambda: [player.show([0.01 * k, 0.0], trace=["tip"]) for k in range(50)]) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert player._number == 201


def test_open(player, monkeypatch):
    opened = []
    monkeypatch.setattr(webbrowser, "open", lambda url: opened.append(url) or True)
    assert player.open() == player.url and opened == [player.url]
    monkeypatch.setattr(webbrowser, "open", lambda url: False)
    with pytest.warns(articulated.RobotWarning, match="open: found no browser"):
        player.open()
