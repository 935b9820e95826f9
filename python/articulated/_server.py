"""The server of a player: its page, its events, and the messages that move the robot."""

import hmac
import json
import socketserver
import sys
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from urllib.parse import parse_qs, urlsplit

from . import _native

# Bytes of a message, at most.
_MOST_BYTES = 1 << 20
_KEYS = ("q", "frames", "trace", "lines")
_EXAMPLE = 'an object such as {"q": [0.1, 0.2]}'
# The page has its script and its style in itself, and asks this server alone.
_POLICY = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; connect-src 'self'; img-src data: blob:; media-src blob:"


class Server(ThreadingHTTPServer):
    """A server on 127.0.0.1 at a port that is free."""

    daemon_threads = True

    def __init__(self, player):
        self.player = player
        super().__init__(("127.0.0.1", 0), _Handler)

    def server_bind(self):
        # That of HTTPServer looks up the host's name, which may take seconds.
        socketserver.TCPServer.server_bind(self)
        self.server_name, self.server_port = self.server_address

    def handle_error(self, request, client_address):
        # A page may be closed in the middle of a message.
        if not isinstance(sys.exc_info()[1], OSError):
            super().handle_error(request, client_address)


class _Handler(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    disable_nagle_algorithm = True

    def do_GET(self):
        path = urlsplit(self.path).path
        if not self._is_allowed():
            self._forbid()
        elif path == "/":
            self._answer(200, self.server.player._page, "text/html; charset=utf-8")
        elif path == "/events":
            self._events()
        else:
            self._refuse(404, f"found no {path}, expected / or /events, or a POST to /show")

    def do_POST(self):
        path, length = urlsplit(self.path).path, self.headers.get("Content-Length", "")
        is_length = length.isascii() and length.isdigit() and len(length) < 20
        # Read in any case: a client that still sends hears no answer.
        body = self.rfile.read(int(length)) if is_length and int(length) <= _MOST_BYTES else None
        if not self._is_allowed():
            self._forbid()
        elif not is_length:
            self._refuse(411, f"Content-Length: found {length!r}, expected the number of bytes")
        elif body is None:
            self._refuse(413, f"Content-Length: found {length}, expected at most {_MOST_BYTES}")
        elif path != "/show":
            self._refuse(404, f"found no {path}, expected /show")
        else:
            self._show(body)

    def _is_allowed(self):
        """Whether the request has the token."""
        kind, _, given = self.headers.get("Authorization", "").partition(" ")
        if kind.lower() != "bearer":
            given = parse_qs(urlsplit(self.path).query).get("token", [""])[0]
        return hmac.compare_digest(given.encode("utf-8", "replace"), self.server.player._token.encode())

    def _forbid(self):
        self._refuse(403, "found no token or a wrong one, expected that of Player.url, as ?token=… or Authorization: Bearer …")

    def _show(self, body):
        player = self.server.player
        try:
            given = _message(body)
            player.show(given["q"], frames=given.get("frames"), trace=given.get("trace"), lines=given.get("lines"))
        except (TypeError, ValueError) as error:
            return self._refuse(400, str(error), keep=True)
        except RuntimeError as error:
            return self._refuse(410, str(error))
        self._answer(200, json.dumps({"pages": player.pages}).encode(), "application/json")

    def _events(self):
        player = self.server.player
        self.close_connection = True
        self._head(200, "text/event-stream", {"Connection": "close"})
        player._connected(1)
        try:
            for message in player._messages():
                self.wfile.write(f"data: {message}\n\n".encode() if message else b":\n\n")
            self.wfile.write(b"event: end\ndata:\n\n")
        except OSError:
            # The page is closed.
            pass
        finally:
            player._connected(-1)

    def _refuse(self, status, message, keep=False):
        # What was sent with a request that is not read would be taken for the next one.
        self.close_connection = not keep
        self._answer(status, json.dumps({"error": message}, ensure_ascii=False).encode(), "application/json", {} if keep else {"Connection": "close"})

    def _answer(self, status, body, kind, more=()):
        self._head(status, kind, {"Content-Length": str(len(body)), **dict(more)})
        self.wfile.write(body)

    def _head(self, status, kind, more):
        self.send_response(status)
        fixed = {"Content-Type": kind, "Cache-Control": "no-store", "Content-Security-Policy": _POLICY}
        for name, value in {**fixed, "Referrer-Policy": "no-referrer", "X-Content-Type-Options": "nosniff", **more}.items():
            self.send_header(name, value)
        self.end_headers()

    def log_message(self, *_):
        """Nothing is printed."""


def _message(body):
    """The object of a POST. Errors: what is wrong with it."""
    try:
        given = json.loads(body)
    except (ValueError, RecursionError) as error:
        raise ValueError(f"message: found no JSON ({error}), expected {_EXAMPLE}") from None
    if not isinstance(given, dict):
        raise ValueError(f"message: found {type(given).__name__}, expected {_EXAMPLE}")
    for key in given:
        if key not in _KEYS:
            near = _native.nearest(key, list(_KEYS))
            raise ValueError(f"message: found {key!r}, expected q, frames, trace and lines" + (f"; did you mean {near!r}?" if near else ""))
    if "q" not in given:
        raise ValueError("message: found no q, expected the numbers of a configuration")
    return given
