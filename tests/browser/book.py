#!/usr/bin/env python3
"""Builds the book, and checks each of its pages in a headless Chromium.

    python3 tests/browser/book.py                 # all checks
    python3 tests/browser/book.py --keep FOLDER   # and keep the book and a screenshot of each page there
    python3 tests/browser/book.py --install       # first install Debian's Chromium, clang and lld, as root, where they are missing

Checks formulas, code, pictures, links, players and sliders. Prints "not run: ..." for what needs
a program that is missing, and ends with status 0. ARTICULATED_COMMAND names the command
`articulated`; without it Cargo builds the command.
"""

import argparse
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from urllib.parse import unquote

from pages import SHOWN, SIZE, differing, drawn, ensure_packages, install, opened

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parent.parent
sys.path.insert(0, str(HERE.parent))
from programs import build_command, evaluated  # noqa: E402

BUILD = REPOSITORY / "docs" / "book" / "build.py"
SOURCE = REPOSITORY / "docs" / "book" / "src"
STARTED = time.monotonic()
PHONE = (390, 800)
SHOWN_DIGITS = 5.1e-4  # half of the last decimal place that the sliders show

# A chapter with a mistake in each of these lines, and what the build says about it.
WRONG = {
    3: ("[lost](nowhere.md)", "there is no such file"),
    5: ("[lost](a.md#nowhere)", "has no such heading"),
    7: ("![lost](nowhere.svg)", "picture nowhere.svg"),
    9: ("<!-- player: nothing -->", "no such scene"),
    11: ("<!-- sliders: nothing -->", "no such robot"),
    13: ("<!-- quote: nowhere.rs -->", "no code block"),
    15: ("<!-- quotation: here -->", "expected one of `quote`"),
    17: ("```math\na =\n\\notlatex b\n```", None),
    19: (None, "Undefined control sequence: \\notlatex"),
    22: ("```notalanguage\n```", "Pygments"),
    25: ("```math\na_{b\n```", None),
    26: (None, "formula: Expected '}'"),
}
# The contrast of text against what is behind it, by the formula of WCAG 2.
CONTRAST = """(() => {
  const parts = color => color.match(/[\\d.]+/g).map(Number), light = c => { const x = c / 255; return x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4; };
  const luminance = ([r, g, b]) => 0.2126 * light(r) + 0.7152 * light(g) + 0.0722 * light(b);
  const behind = e => { for (; e; e = e.parentElement) { const c = parts(getComputedStyle(e).backgroundColor); if (c.length < 4 || c[3] > 0) return c; } return [255, 255, 255]; };
  return [...document.querySelectorAll('p, li, td, th, h1, a:not(.anchor), figcaption, pre code, pre i, .katex, output, label')].map(e => {
    const [a, b] = [parts(getComputedStyle(e).color), behind(e)].map(luminance).sort((x, y) => y - x);
    return [(a + 0.05) / (b + 0.05), e.className + ' ' + e.textContent.slice(0, 30)];
  }).sort((x, y) => x[0] - y[0])[0];
})()"""


def build(folder, *words, status=0, **environment):
    """Builds the book into a folder; what it printed."""
    done = subprocess.run([sys.executable, BUILD, "-o", folder, *words], capture_output=True, text=True, env=os.environ | environment)
    assert done.returncode == status and "Traceback" not in done.stderr, (done.returncode, done.stdout, done.stderr)
    return done.stdout + done.stderr


def refusals(folder):
    """Mistakes of an author are reported together, each with its file and line."""
    source = folder / "docs" / "book" / "src"
    source.mkdir(parents=True)
    (source / "SUMMARY.md").write_text("# Summary\n\n- [A](a.md)\n- [B](b.md)\n")
    lines = ["# Title"]
    for number, (text, _) in WRONG.items():
        lines += [""] * (number - 1 - len(lines)) if text else []
        lines += text.split("\n") if text else []
    (source / "a.md").write_text("\n".join(lines) + "\n")
    told = build(folder / "out", "--source", source, "--without-players", status=1)
    for number, (_, words) in WRONG.items():
        assert words is None or re.search(rf"^docs/book/src/a\.md:{number}: .*{re.escape(words)}", told, re.M), f"line {number}: {words}\n{told}"
    assert re.search(r"^docs/book/src/SUMMARY\.md:4: .*'b\.md'", told, re.M), told
    assert "nodejs" in build(folder / "out", "--without-players", status=1, PATH=str(folder)), "without Node.js"
    assert "there is no such file" in build(folder / "out", status=1, ARTICULATED_COMMAND=str(folder / "nothing"))
    build(folder / "plain", "--without-players")
    pages = {page.name: page.read_text() for page in (folder / "plain").glob("*.html")}
    assert all("<iframe" not in page and 'class="sliders"' not in page for page in pages.values())
    assert "articulated simulate pendulum" in pages["pendulum.html"]
    print(f"refusals: ok, {time.monotonic() - STARTED:.0f} s", flush=True)


def blocks(text):
    """Fenced blocks of a chapter: the words after the fence, and the lines."""
    return [(found[1], found[2].splitlines()) for found in re.finditer(r"^```(\S*)[^\n]*\n(.*?)^```$", text, re.M | re.S)]


def visible(language, lines):
    """The lines of a block that a reader sees, without indentation."""
    bare = [line.strip() for line in lines]
    if language.startswith("rust"):
        bare = [line for line in bare if line != "#" and not line.startswith("# ")]
    return [line for line in bare if line]


def check_text(browser, text, name):
    """Formulas, code and pictures of a page are those of its source."""
    found = blocks(text)
    formulas = sum(language == "math" for language, _ in found)
    typeset = browser.value("[...document.querySelectorAll('.math .katex-html')].filter(e => e.getBoundingClientRect().width > 10).length")
    assert typeset == formulas, f"{name}: {typeset} formulas, {formulas} in the source"
    assert browser.value("document.querySelectorAll('.katex-error').length") == 0
    failed = browser.value("document.fonts.ready.then(() => [...document.fonts].filter(f => f.status === 'error').length)")
    assert failed == 0 and (not formulas or browser.value("document.fonts.check('16px KaTeX_Math')")), f"{name}: fonts of formulas"
    shown = browser.value("[...document.querySelectorAll('pre')].map(e => e.textContent.split('\\n').map(line => line.trim()).filter(line => line))")
    expected = [visible(language, lines) for language, lines in found if language != "math"]
    assert shown == expected, next((a, b) for a, b in zip(shown + [None], expected + [None]) if a != b)
    broken = browser.value("[...document.images].filter(i => !i.complete || !i.naturalWidth).map(i => i.src)")
    pictures = browser.value("document.images.length")
    assert broken == [] and pictures == len(re.findall(r"^!\[", text, re.M)), (name, broken, pictures)


def check_room(browser, name):
    """Code fits its frame, the page fits windows of 1280 and 390 px, and text has contrast."""
    wide = browser.value("[...document.querySelectorAll('pre')].filter(e => e.scrollWidth > e.clientWidth).map(e => e.textContent.slice(0, 80))")
    assert wide == [], f"{name}: code is wider than its frame: {wide}"
    for scheme in ["light", "dark"]:
        browser("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
        contrast, where = browser.value(CONTRAST)
        assert contrast >= 4.5, f"{name}, {scheme}: a contrast of {contrast:.2f}: {where}"
    browser("Emulation.setEmulatedMedia", features=[])
    for width, height in [SIZE, PHONE]:
        browser("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 600)
        wide = browser.value(f"[...document.querySelectorAll('article *')].filter(e => e.getBoundingClientRect().right > {width} && !e.closest('.math, pre, .table')).map(e => e.outerHTML.slice(0, 90))")
        assert browser.value("document.documentElement.scrollWidth") <= width, f"{name} is wider than a window of {width} px: {wide[:4]}"
        listed = "getComputedStyle(document.querySelector('.contents')).display"
        if width < 600:
            assert browser.value(listed) == "none"
            browser.value("document.querySelector('header label').click()")
        assert browser.value(listed) == "block", f"{name}: no contents at {width} px"
    browser("Emulation.setDeviceMetricsOverride", width=SIZE[0], height=SIZE[1], deviceScaleFactor=1, mobile=False)


def check_links(folder, addresses, name):
    """Links into the book have a page and an anchor; all others are addresses of the network."""
    for address in addresses:
        if re.match(r"https?:", address):
            continue
        file, _, anchor = address.partition("#")
        page = folder / (file or name)
        assert page.is_file(), f"{name}: link to {address}"
        assert not anchor or f'id="{unquote(anchor)}"' in page.read_text(), f"{name}: link to {address}"


def player(browser, keep, name):
    """The player of a page moves. The wheel scrolls the page, and after a click not any more."""
    browser.value("document.querySelector('.player').scrollIntoView()")
    main = browser.value("location.href")
    context = context_of_frame(browser, main)
    inside = lambda expression: browser("Runtime.evaluate", expression=expression, contextId=context, returnByValue=True)["result"].get("value")
    at = inside("+document.getElementById('scrub').value")
    left, top, right, bottom = browser.value("(r => [r.left, r.top, r.right, r.bottom].map(Math.round))(document.querySelector('iframe').getBoundingClientRect())")
    browser.value(SHOWN)
    first = browser.screenshot()
    time.sleep(0.7)
    later = browser.screenshot()
    keep(f"{name}_player", later)
    assert inside("+document.getElementById('scrub').value") != at, f"{name}: the player stands still"
    middle = (left, top, right, top + (bottom - top) // 2)
    assert differing(first.crop(middle), later.crop(middle)) > 300 and drawn(later) > 500, f"{name}: the player draws nothing that moves"
    x, y = (left + right) // 2, top + (bottom - top) // 4
    scroll = lambda: (browser("Input.dispatchMouseEvent", type="mouseWheel", x=x, y=y, deltaX=0, deltaY=60), time.sleep(0.4), browser.value("scrollY"))[-1]
    before = browser.value("scrollY")
    assert scroll() > before, f"{name}: the wheel does not scroll the page over the player"
    before = browser.value("scrollY")
    for kind in ["mousePressed", "mouseReleased"]:
        browser("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)
    assert scroll() == before, f"{name}: the wheel scrolls the page after a click on the player"


def closed_form(robot, q, v, a):
    """Torques and energies by the formulas in the robots' files."""
    if robot == "simple_pendulum":
        return [1.001 * a[0] + 9.81 * math.sin(q[0]), 0.5005 * v[0] ** 2, -9.81 * math.cos(q[0])]
    b, a1, a2, g = 0.175, 0.8334333333333, 0.0817166666667, 9.81
    m11, m12 = a1 + a2 + 2 * b * math.cos(q[1]), a2 + b * math.cos(q[1])
    tip = g * b * math.sin(q[0] + q[1])
    return [
        m11 * a[0] + m12 * a[1] - b * math.sin(q[1]) * (2 * v[0] * v[1] + v[1] ** 2) + g * math.sin(q[0]) + tip,
        m12 * a[0] + a2 * a[1] + b * math.sin(q[1]) * v[0] ** 2 + tip,
        0.5 * (m11 * v[0] ** 2 + 2 * m12 * v[0] * v[1] + a2 * v[1] ** 2),
        -g * math.cos(q[0]) - g * b * math.cos(q[0] + q[1]),
    ]


def sliders(browser, robot, name):
    """Torques and energies at slider positions are those of closed forms and of the library."""
    browser.until("document.querySelector('.board output') !== null")
    joints = json.loads(browser.value("document.querySelector('.sliders script').textContent"))["joints"]
    n = len(joints)
    number = lambda text: float(text.split()[0].replace("\u2212", "-"))
    results = lambda: [number(text) for text in browser.value("[...document.querySelectorAll('.results output')].map(o => o.textContent)")]
    for state in range(4):
        q, v, a = ([scale * math.sin(1.7 * state + 2.3 * k + shift) for k in range(n)] for scale, shift in [(3.0, 0.3), (4.5, 1.1), (9.0, 2.0)])
        for values, kind in zip((q, v, a), "qva"):
            for value, joint in zip(values, joints):
                browser.value(f"(s => {{ s.value = {value!r}; s.dispatchEvent(new Event('input')); }})(document.querySelector('[name=\"{kind}.{joint['name']}\"]'))")
        found, expected = results(), closed_form(robot, q, v, a)
        library = evaluated(REPOSITORY / "models" / "urdf" / f"{robot}.urdf", ["inverse_dynamics", "kinetic_energy", "potential_energy"], [(q, v, a)], "generic")
        for answer in [expected, library]:
            answer = [*answer, answer[-2] + answer[-1]]
            assert len(found) == len(answer) and all(abs(x - y) < SHOWN_DIGITS for x, y in zip(found, answer)), f"{name}: {found}, expected {answer}"
        lines = browser.value("[...document.querySelectorAll('.board line')].map(l => ['x1', 'y1', 'x2', 'y2'].map(x => +l.getAttribute(x)))")
        # Each rod hangs along −z of its link, and its second end is that at +z.
        for (x1, y1, x2, y2), angle in zip(lines, [sum(q[: k + 1]) for k in range(n)], strict=True):
            assert abs(math.remainder(math.atan2(x1 - x2, y1 - y2) - angle, math.tau)) < 1e-3, f"{name}: the drawing at {q}"
    # By the mouse, while its button is down.
    browser.value("document.querySelector('.board').scrollIntoView()")
    x, y, width = browser.value("(r => [r.left, r.top + r.height / 2, r.width])(document.querySelector('.board input').getBoundingClientRect())")
    browser("Input.dispatchMouseEvent", type="mousePressed", x=x + width / 2, y=y, button="left", clickCount=1)
    before = results()
    browser("Input.dispatchMouseEvent", type="mouseMoved", x=x + 0.7 * width, y=y, button="left", buttons=1)
    browser.value(SHOWN)
    assert results() != before, f"{name}: nothing changes while a slider is dragged"
    browser("Input.dispatchMouseEvent", type="mouseReleased", x=x + 0.7 * width, y=y, button="left", clickCount=1)


def check(browser, folder, keep, has_sliders):
    """Every check on every page."""
    chapters = re.findall(r"\]\((\S+)\.md\)", (SOURCE / "SUMMARY.md").read_text())
    pages = {chapter: "index.html" if k == 0 else f"{chapter}.html" for k, chapter in enumerate(chapters)}
    assert {page.name for page in folder.glob("*.html")} == set(pages.values())
    counts = dict.fromkeys(["formulas", "players", "sliders"], 0)
    for chapter, page in pages.items():
        text = (SOURCE / f"{chapter}.md").read_text()
        asked = {kind: re.findall(rf"^<!-- {kind}: (\S+) -->$", text, re.M) for kind in ["player", "sliders"]}
        asked["sliders"] = asked["sliders"] if has_sliders else []
        browser.open(folder / page)
        check_text(browser, text, page)
        check_links(folder, browser.value("[...document.querySelectorAll('a[href]')].map(a => a.getAttribute('href'))"), page)
        assert browser.value("document.querySelectorAll('iframe').length") == len(asked["player"])
        assert browser.value("document.querySelectorAll('.sliders').length") == len(asked["sliders"])
        for _ in asked["player"]:
            player(browser, keep, page.removesuffix(".html"))
        for robot in asked["sliders"]:
            sliders(browser, robot, page)
        check_room(browser, page)
        browser.value("scrollTo(0, 0)")
        keep(page.removesuffix(".html"), browser.screenshot())
        said = [event["params"] for event in browser.events if event["method"] in ("Runtime.consoleAPICalled", "Network.loadingFailed", "Log.entryAdded")]
        assert browser.complaints() == [] and said == [], f"{page}: {browser.complaints()} {said}"
        counts["formulas"] += sum(language == "math" for language, _ in blocks(text))
        counts["players"] += len(asked["player"])
        counts["sliders"] += len(asked["sliders"])
    told = ", ".join(f"{number} {what}" for what, number in counts.items())
    print(f"{len(pages)} pages: ok, {told}, {time.monotonic() - STARTED:.0f} s", flush=True)


def context_of_frame(browser, main):
    """DevTools' number of the script of the player in the page at `main`, once it has loaded."""
    import devtools

    def found():
        # Answers of the browser bring events along.
        browser.value("1")
        made = [event["params"]["context"] for event in browser.events if event.get("method") == "Runtime.executionContextCreated"]
        inner = [context for context in made if context["auxData"].get("type") == "default" and "/players/" in frame_address(browser, context)]
        return inner[-1]["id"] if inner and ready(browser, inner[-1]["id"]) else None

    return devtools.wait(found, 30, f"the player of {main}")


def frame_address(browser, context):
    answer = browser("Runtime.evaluate", expression="location.href", contextId=context["id"], returnByValue=True)
    return answer["result"].get("value") or ""


def ready(browser, context):
    answer = browser("Runtime.evaluate", expression="document.readyState === 'complete' && +document.getElementById('scrub').max > 0", contextId=context, returnByValue=True)
    return answer["result"].get("value")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--install", action="store_true", help="install Debian's packages of what is missing, where this is its administrator")
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="keep the book and the screenshots there")
    options = parser.parse_args()
    ensure_packages()
    import devtools

    if options.install and not devtools.find():
        install()
    path = devtools.find()
    needs = {"Chromium (Debian: chromium)": path, "Node.js (Debian: nodejs, npm)": shutil.which("npm"), "Python 3.11": sys.version_info >= (3, 11)}
    missing = [name for name, there in needs.items() if not there]
    if missing:
        print(f"not run: the book in a browser, which needs {' and '.join(missing)}")
        return
    os.environ["ARTICULATED_COMMAND"] = str(build_command())
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.keep or Path(temporary) / "book"
        told = build(folder, *(["--install"] if options.install else []))
        has_sliders = "sliders are left out" not in told
        print(f"built, {time.monotonic() - STARTED:.0f} s: {told.splitlines()[-1].split('  ')[-1].split(':')[0]}", flush=True)
        if not has_sliders:
            print("not run: sliders, which need clang and wasm-ld (Debian: clang, lld)")
        refusals(Path(temporary) / "wrong")
        keep = (lambda name, image: image.save(folder / f"{name}.png")) if options.keep else (lambda name, image: None)
        with opened(path) as browser:
            check(browser, folder, keep, has_sliders)


if __name__ == "__main__":
    main()
