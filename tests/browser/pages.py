#!/usr/bin/env python3
"""Opens pages that `articulated simulate` writes in a headless Chromium: they play, seek and turn, and fetch nothing.

    python3 tests/browser/pages.py                 # all checks
    python3 tests/browser/pages.py --keep FOLDER   # and keep the pages and the screenshots there
    python3 tests/browser/pages.py --install       # first install Debian's Chromium, as root, where none is found

Prints "not run: ..." and ends with status 0 where there is no Chromium. Packages of Python are installed into
<repository>/target/browser/venv.
"""

import argparse
import contextlib
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import live
import shapes

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from programs import build_command  # noqa: E402

REPOSITORY = HERE.parent.parent
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", REPOSITORY / "target"))
PLACE = TARGET / "browser"
SIZE = (1280, 800)
# All bundled scenes, and the ends of those that take long.
SCENES = [("arm", 0.5), ("golf_swing", None), ("humanoid_float", 0.2), ("quadruped_drop", 0.3), ("pendulum", None), ("double_pendulum", 1), ("cart_pole", 1),
          ("chain", 0.2), ("spinning_top", 0.5), ("t_handle", 1), ("underwater_arm", 0.5)]
STARTED = time.monotonic()
FIRST = b"\x1aE\xdf\xa3"  # of a WebM file


def ensure_packages():
    """Runs this script again inside a virtual environment of its own, made on the way."""
    environment = PLACE / "venv"
    python = environment / "bin" / "python"
    if Path(sys.prefix) == environment:
        return
    wanted = (HERE / "requirements.txt").read_text()
    stamp = environment / "installed.txt"
    if not stamp.exists() or stamp.read_text() != wanted:
        subprocess.check_call([sys.executable, "-m", "venv", environment])
        subprocess.check_call([python, "-m", "pip", "install", "--quiet", "-r", HERE / "requirements.txt"])
        stamp.write_text(wanted)
    os.execv(python, [str(python), *sys.argv])


def install():
    """Debian's Chromium, where this is Debian and its administrator."""
    if not shutil.which("apt-get") or os.geteuid() != 0:
        return
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "env": os.environ | {"DEBIAN_FRONTEND": "noninteractive"}}
    words = ["apt-get", "-o", "DPkg::Lock::Timeout=600", "install", "-y", "--no-install-recommends", "chromium"]
    if subprocess.run(words, **quiet).returncode != 0:
        subprocess.run(["apt-get", "-o", "DPkg::Lock::Timeout=600", "update"], **quiet)
        subprocess.run(words, **quiet)


def command():
    """The path of the command, built."""
    return build_command()


def write(articulated, scene, page, *words):
    """The page of a scene's motion, and what the command warns of."""
    done = subprocess.run([articulated, "simulate", scene, "-o", page, *words], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stderr


def drawn(image):
    """How many pixels of the middle of the picture are dark or coloured, as the robot is, and neither background nor grid nor panels."""
    area = image.crop((SIZE[0] // 5, SIZE[1] // 12, 4 * SIZE[0] // 5, 4 * SIZE[1] // 5))
    return sum(n for n, pixel in area.getcolors(1 << 24) if max(pixel) - min(pixel) > 30 or max(pixel) < 110)


def differing(a, b):
    """How many pixels of two pictures differ."""
    from PIL import ImageChops

    changed = [band.point(lambda value: 255 if value else 0) for band in ImageChops.difference(a, b).split()]
    return ImageChops.lighter(ImageChops.lighter(changed[0], changed[1]), changed[2]).histogram()[255]


def time_of(browser):
    return float(browser.value("document.getElementById('scrub').value"))


def seek(browser, part):
    """Puts the slider at a part of its way, as a user does; the motion halts there."""
    put = "(s => { s.value = +s.min + %s * (s.max - s.min); s.dispatchEvent(new Event('input')); return +s.value; })"
    there = browser.value((put + "(document.getElementById('scrub'))") % part)
    browser.value(SHOWN)
    assert abs(time_of(browser) - there) < 1e-9, (time_of(browser), there)


def plays(browser, keep):
    """It plays from the start on, halts, and shows another picture at another time."""
    before = time_of(browser)
    browser.until(f"+document.getElementById('scrub').value !== {before}")
    browser.click("play")
    halted = browser.until("document.getElementById('play').textContent === 'Play'")
    assert halted
    at = time_of(browser)
    time.sleep(0.1)
    assert time_of(browser) == at, "it does not halt"
    seek(browser, 0.0)
    first = browser.screenshot()
    keep("start", first)
    seek(browser, 0.7)
    later = browser.screenshot()
    keep("later", later)
    for image in [first, later]:
        assert drawn(image) > 1000, f"{drawn(image)} pixels are drawn"
    assert differing(first, later) > 500, "the picture does not change"
    return first


# Resolves when the page has been drawn once more; and the part of the window without panels.
SHOWN = "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))"
MIDDLE = (SIZE[0] // 3, SIZE[1] // 12, 4 * SIZE[0] // 5, 3 * SIZE[1] // 4)


def turns(browser):
    """A drag turns the view, and the button returns to the whole view."""
    before = browser.screenshot()
    for kind, x in [("mousePressed", 600), ("mouseMoved", 720), ("mouseReleased", 720)]:
        browser("Input.dispatchMouseEvent", type=kind, x=x, y=150, button="left", buttons=1, clickCount=1)
    time.sleep(0.2)
    assert differing(before, browser.screenshot()) > 500, "a drag changes nothing"
    browser.click("home")
    browser("Input.dispatchMouseEvent", type="mouseMoved", x=5, y=795)
    time.sleep(0.2)
    assert differing(before, browser.screenshot()) < 50_000, "the whole view is another one than at first"


def follows(browser):
    """The toggle keeps the robot in place as time passes."""
    browser.click("follow")
    assert browser.value("document.getElementById('follow').checked")
    seek(browser, 0.2)
    browser.click("follow")


def toggles(browser, name):
    """A toggle changes the picture, and changes it back."""
    before = browser.screenshot()
    for changed in [True, False]:
        browser.click(name)
        browser.value(SHOWN)
        differs = differing(before.crop(MIDDLE), browser.screenshot().crop(MIDDLE)) > 100
        assert differs == changed, f"{name}: {differs}"


def saves(browser, folder):
    """The buttons save a picture, and a video of the motion."""
    import devtools
    from PIL import Image

    folder.mkdir(exist_ok=True)
    browser("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(folder))
    name = browser.value("document.title")
    picture, video = folder / f"{name}.png", folder / f"{name}.webm"
    for old in [picture, video]:
        old.unlink(missing_ok=True)
    browser.click("png")
    found = devtools.wait(lambda: picture.exists() and picture.stat().st_size, 10, "the picture")
    image = Image.open(picture).convert("RGB")
    assert found and image.size[0] == SIZE[0] and drawn(image) > 2000, image.size
    # Two seconds, or somewhat less.
    length = browser.value("(s => s.max - s.min)(document.getElementById('scrub'))")
    browser.value(f"(s => {{ s.selectedIndex = [...s.options].findIndex(o => +o.value >= {length / 2}); }})(document.getElementById('speed'))")
    browser.click("video")
    devtools.wait(lambda: video.exists() and video.stat().st_size, 30, "the video")
    data = video.read_bytes()
    assert data.startswith(FIRST) and len(data) > 5000, len(data)
    assert browser.value("document.getElementById('video').textContent") == "Save video"


@contextlib.contextmanager
def opened(path, *, webgl=True):
    """A browser with a profile of its own."""
    import devtools

    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        browser = devtools.Browser(path, profile, SIZE, webgl=webgl)
        try:
            yield browser
        finally:
            browser.close()


def finish(browser, name, own=()):
    """No complaint of the browser."""
    assert browser.complaints(own) == [], f"{name}: {browser.complaints(own)}"
    print(f"{name}: ok, {time.monotonic() - STARTED:.0f} s", flush=True)


def check(browser, articulated, folder):
    """Every check on every page."""
    saved = folder / "saved"
    for scene, end in SCENES:
        page = folder / f"{scene}.html"
        # The chain records its ends alone.
        write(articulated, scene, page, *(["--end", str(end)] if end else []), *(["--every", "0.01"] if scene == "chain" else []))
        assert "http" not in page.read_text()
        browser.open(page)
        plays(browser, lambda name, image: image.save(folder / f"{scene}_{name}.png"))
        if scene in ["arm", "quadruped_drop"]:
            turns(browser)
            follows(browser)
        if scene == "golf_swing":
            toggles(browser, "names")
            toggles(browser, "boxes")
            assert "ball" in browser.value("document.getElementById('legend').textContent")
            saves(browser, saved)
        finish(browser, scene)


def check_shapes(browser, articulated, folder):
    """A robot with meshes of each kind, primitives, materials, and a mesh that is missing."""
    scene = shapes.write(folder / "shapes")
    page = folder / "shapes.html"
    told = write(articulated, scene, page)
    for part in ["elsewhere/box.dae", 'link "dae"', 'link "lost"', "--package", "shapes.urdf"]:
        assert part in told, told
    told = write(articulated, scene, page, "--package", f"elsewhere={folder / 'shapes' / 'other'}")
    assert "elsewhere" not in told and "nowhere/lost.stl" in told and 'link "lost"' in told, told
    browser.open(page)
    plays(browser, lambda name, image: image.save(folder / f"shapes_{name}.png"))
    for name in ["looks", "collision", "boxes"]:
        toggles(browser, name)
    legend = browser.value("document.getElementById('legend').textContent")
    assert "steel" in legend and "red paint" in legend, legend
    near = lambda pixel, color: all(abs(a - b) < 60 for a, b in zip(pixel, color))
    image = browser.screenshot().crop(MIDDLE)
    red = sum(n for n, pixel in image.getcolors(1 << 24) if near(pixel, (230, 25, 25)))
    assert red > 200, f"{red} pixels have the colour of the material"
    finish(browser, "shapes")


def check_silhouettes(browser, articulated, folder):
    """A mesh of very many triangles is drawn with fewer, and covers the pixels that a mesh of few triangles of the same surface covers."""
    seen = []
    for name, fine in [("fine", True), ("coarse", False)]:
        scene = shapes.write_ring(folder / name, fine)
        told = write(articulated, scene, folder / f"{name}.html")
        assert ("expected at most 200000: drawn with" in told) == fine, told
        browser.open(folder / f"{name}.html")
        browser.click("play")
        seek(browser, 0.0)
        image = browser.screenshot().crop(MIDDLE)
        image.save(folder / f"{name}.png")
        seen.append(image.convert("RGB"))
    covered = [[max(pixel) - min(pixel) > 30 for pixel in image.get_flattened_data()] for image in seen]
    counts = [sum(mask) for mask in covered]
    apart = sum(a != b for a, b in zip(*covered))
    assert min(counts) > 5000 and apart < 0.01 * counts[1], f"{apart} of {counts} pixels differ"
    finish(browser, "silhouettes")


def check_live(browser, folder):
    """A page that a program feeds shows each configuration, axes and paths; it has no clock."""
    python = live.python(TARGET)
    if not python:
        print("not run: the live player, which needs a Python with the package (python/check.sh, or ARTICULATED_PYTHON)")
        return
    note = "document.getElementById('note').textContent"
    with live.served(python) as (url, show):
        # Its file alone, without a server, has the picture of the first configuration.
        (folder / "live.html").write_bytes(live.get(url))
        browser.open(folder / "live.html")
        browser.value(SHOWN)
        alone = browser.screenshot().crop(MIDDLE)
        assert browser.complaints() == [] and "live" not in browser.value(note), browser.complaints()
        browser.visit(url)
        browser.until(f"{note}.endsWith('; live')")
        browser.value(SHOWN)
        differs = differing(alone, browser.screenshot().crop(MIDDLE))
        assert drawn_in(alone, (244, 246, 248)) < 0.9 * alone.width * alone.height and differs < 100, differs
        assert not browser.value("['play', 'scrub', 'strip', 'numbers', 'video'].some(name => document.getElementById(name).offsetParent)")
        seen = []

        def look(name, act, place=MIDDLE):
            act()
            time.sleep(0.2)
            browser.value(SHOWN)
            image = browser.screenshot().crop(place)
            image.save(folder / f"live_{name}.png")
            seen.append(image)

        bent = [0.5, 0.6, 0.0, -1.5, 0.0, 1.8, 0.0]
        # The view grows until it has all of this; then it stays.
        swing = [[x, *bent[1:]] for x in [0.5, 0.2, -0.1, -0.4]]
        for q in [*swing, [0.0] * 7]:
            show(q)
            time.sleep(0.1)
        look("start", lambda: None)
        look("same", lambda: show([0.0] * 7))
        look("bent", lambda: show(bent))
        look("axes", lambda: show(bent, frames=["link_7"]))
        look("paths", lambda: [show(q, trace=["link_7"], frames=[]) for q in swing])
        look("back", lambda: show([0.0] * 7, trace=[]))
        look("posted", lambda: live.post(url, {"q": bent}))
        look("fan", lambda: show([0.0] * 7, lines=[[[0, 0, 0], [0.5, 0.1 * k, 0.2]] for k in range(-5, 6)]))
        look("without", lambda: show([0.0] * 7, lines=[]))
        changes = [differing(a, b) for a, b in zip(seen, seen[1:])]
        assert changes[0] == 0 and min(changes[1:]) > 100, changes
        # A configuration has the same picture from the program and from a POST.
        assert differing(seen[0], seen[5]) == 0 and differing(seen[2], seen[6]) == 0
        assert differing(seen[0], seen[7]) > 100 and differing(seen[0], seen[8]) == 0
        assert drawn_in(seen[4], (123, 63, 160)) > 50 and drawn_in(seen[3], (123, 63, 160)) == 0
        assert all(drawn_in(seen[3], color) > 5 and drawn_in(seen[2], color) == 0 for color in [(198, 40, 40), (46, 125, 50)])
        turns(browser)
    browser.until(f"{note}.endsWith('; no connection')")
    finish(browser, "live", own=[url.partition("?")[0]])


def drawn_in(image, color):
    """How many pixels have exactly this colour."""
    return sum(n for n, pixel in image.getcolors(1 << 24) if pixel == color)


def check_without_webgl(path, folder):
    """The same pictures where the browser has no WebGL."""
    with opened(path, webgl=False) as browser:
        assert browser.value("document.createElement('canvas').getContext('webgl2')") is None
        for name in ["shapes", "arm"]:
            browser.open(folder / f"{name}.html")
            plays(browser, lambda part, image: image.save(folder / f"{name}_{part}_plain.png"))
            # The browser itself complains about missing WebGL.
            assert [c for c in browser.complaints() if "WebGL" not in c] == [], browser.complaints()
            print(f"{name} without WebGL: ok, {time.monotonic() - STARTED:.0f} s", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--install", action="store_true", help="install Debian's Chromium where none is found and this is its administrator")
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="keep pages and screenshots there")
    parser.add_argument("--command", type=Path, metavar="PATH", help="the command, if it is not to be built")
    options = parser.parse_args()
    ensure_packages()
    import devtools

    if options.install and not devtools.find():
        install()
    path = devtools.find()
    if not path:
        print("not run: pages in a browser, which needs Chromium (Debian: chromium)")
        return
    articulated = options.command or command()
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.keep or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        with opened(path) as browser:
            check(browser, articulated, folder)
            check_shapes(browser, articulated, folder)
            check_silhouettes(browser, articulated, folder)
            check_live(browser, folder)
        check_without_webgl(path, folder)


if __name__ == "__main__":
    main()
