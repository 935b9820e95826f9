"""A headless Chromium, driven over its DevTools protocol."""

import base64
import io
import json
import shutil
import subprocess
import time
from pathlib import Path

import websocket
from PIL import Image

NAMES = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome"]
STARTED = 30  # s, at most, until the browser listens
ANSWERED = 30  # s, at most, for one command


def find():
    """The path of a Chromium, or None."""
    return next((path for path in map(shutil.which, NAMES) if path), None)


class Browser:
    """One window of a browser with a profile of its own. Events are kept in `events`."""

    def __init__(self, path, profile, size, *, webgl=True):
        width, height = size
        drawing = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"] if webgl else ["--disable-gpu", "--disable-3d-apis"]
        flags = ["--headless=new", "--no-sandbox", "--no-first-run", "--disable-dev-shm-usage", "--hide-scrollbars", *drawing]
        flags += ["--disable-background-networking", "--disable-component-update", "--remote-debugging-port=0", "--remote-allow-origins=*"]
        words = [path, *flags, f"--user-data-dir={profile}", f"--window-size={width},{height}", "about:blank"]
        self.process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.events, self.count = [], 0
        port = wait(lambda: self._port(Path(profile) / "DevToolsActivePort"), STARTED, "the browser to listen")
        address = "ws://127.0.0.1:{}{}".format(*port)
        self.socket = websocket.create_connection(address, timeout=ANSWERED, max_size=None, suppress_origin=True)
        self.session = None
        target = self("Target.createTarget", url="about:blank")["targetId"]
        self.session = self("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ["Page", "Runtime", "Log", "Network"]:
            self(f"{domain}.enable")
        self("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)

    def _port(self, file):
        if self.process.poll() is not None:
            raise RuntimeError(f"the browser ended with status {self.process.returncode}")
        lines = file.read_text().splitlines() if file.exists() else []
        return lines[:2] if len(lines) >= 2 else None

    def __call__(self, method, **parameters):
        """The result of a command."""
        self.count += 1
        message = {"id": self.count, "method": method, "params": parameters}
        self.socket.send(json.dumps(message | ({"sessionId": self.session} if self.session else {})))
        number = self.count
        while True:
            answer = json.loads(self.socket.recv())
            if answer.get("id") == number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                return answer["result"]
            self.events.append(answer)

    def value(self, expression):
        """The value of an expression in the page."""
        result = self("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(f"{expression}: {result['exceptionDetails']['exception'].get('description')}")
        return result["result"].get("value")

    def open(self, file):
        """Loads a file, after the events of the page before are forgotten."""
        self.visit(Path(file).resolve().as_uri())

    def visit(self, url):
        """Loads the page of an address, in the same way."""
        self.events.clear()
        self("Page.navigate", url=url)
        wait(lambda: self.value("document.readyState") == "complete", ANSWERED, "the page to load")

    def until(self, expression, seconds=ANSWERED):
        """Waits until an expression is true, and returns its value."""
        return wait(lambda: self.value(expression), seconds, expression)

    def click(self, name):
        """A click on the middle of an element."""
        middle = "(r => [r.x + r.width / 2, r.y + r.height / 2])(document.getElementById({}).getBoundingClientRect())"
        x, y = self.value(middle.format(json.dumps(name)))
        for kind in ["mousePressed", "mouseReleased"]:
            self("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def screenshot(self):
        """The window as an image."""
        return Image.open(io.BytesIO(base64.b64decode(self("Page.captureScreenshot", format="png")["data"]))).convert("RGB")

    def complaints(self, own=()):
        """Errors, warnings and exceptions of the page, and requests; those whose address begins with one of `own` are left out."""
        found = []
        for event in self.events:
            method, what = event.get("method"), event.get("params", {})
            if method == "Runtime.exceptionThrown":
                found.append(f"exception: {what['exceptionDetails'].get('exception', {}).get('description', what)}")
            elif method == "Runtime.consoleAPICalled" and what["type"] in ("error", "warning", "assert"):
                found.append(f"console: {what['args']}")
            elif method == "Log.entryAdded" and what["entry"]["level"] in ("error", "warning"):
                found.append(f"log: {what['entry']['text']}")
            elif method == "Network.requestWillBeSent" and what["request"]["url"].split(":")[0] not in ("file", "data", "blob", "about") and not what["request"]["url"].startswith(tuple(own)):
                found.append(f"request: {what['request']['url']}")
        return found

    def close(self):
        """Ends the browser."""
        try:
            self.session = None
            self("Browser.close")
        except (OSError, websocket.WebSocketException):
            self.process.terminate()
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()


def wait(found, seconds, what):
    """What `found` returns, once that is true."""
    end = time.monotonic() + seconds
    while True:
        value = found()
        if value:
            return value
        if time.monotonic() > end:
            raise RuntimeError(f"waited {seconds} s for {what}")
        time.sleep(0.05)
