#!/usr/bin/env python3
"""Opens the site of docs/site in a headless Chromium: all of its parts, on a screen and a phone.

    python3 tests/browser/site.py                 # builds the site with ten robots, and checks it
    python3 tests/browser/site.py --site FOLDER   # checks this site
    python3 tests/browser/site.py --keep FOLDER   # and keeps the screenshots there
    python3 tests/browser/site.py --install       # first install Debian's Chromium, as root, where none is found

It opens the start page, pages of documentation, the gallery of robots and the reference of Python.
The search finds robots, the filters work, pictures are drawn, no page is wider than a phone, dark
pages are dark, the console has neither errors nor warnings, and no request leaves the machine.
Prints "not run: ..." and ends with status 0 where there is no Chromium.
"""

import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import pages

ROBOTS = 10
PHONE = (390, 844)
STARTED = time.monotonic()


def build(folder):
    """The site with a few robots."""
    program = pages.REPOSITORY / "docs" / "site" / "build.py"
    done = subprocess.run([sys.executable, str(program), "--robots", str(ROBOTS), "-o", str(folder)], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return folder


def go(browser, page, mark=""):
    """Opens a page of the site anew, with a search in its address."""
    browser.open(page)
    if mark:
        browser("Page.navigate", url="about:blank")
        browser("Page.navigate", url=page.resolve().as_uri() + mark)
        browser.until("document.readyState === 'complete' && location.protocol === 'file:'")


def resize(browser, width, height):
    browser("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)


def type_words(browser, text):
    """Writes into the search field, as a user does."""
    browser.value("(f => { f.focus(); f.select(); })(document.getElementById('words'))")
    if text:
        browser("Input.insertText", text=text)
    else:
        browser.value("(f => { f.value = ''; f.dispatchEvent(new Event('input', { bubbles: true })); })(document.getElementById('words'))")


def choose(browser, field, value):
    change = "(f => { f.value = %s; f.dispatchEvent(new Event('input', { bubbles: true })); return f.value; })(document.getElementById('%s'))"
    assert browser.value(change % (json.dumps(value), field)) == value, f"{field} has no choice {value}"


def cards(browser):
    """Name and kind of the verdict of each card, in their order."""
    found = browser.value("JSON.stringify([...document.querySelectorAll('.card')].map(c => [c.querySelector('h2').textContent, c.querySelector('strong').textContent]))")
    return [tuple(card) for card in json.loads(found)]


def pictures(browser):
    """How many pictures the page has, after all are loaded; a picture that cannot be drawn is an
    error.
    """
    browser.value("document.querySelectorAll('img').forEach(i => { i.loading = 'eager'; })")
    browser.until("[...document.images].every(i => i.complete)")
    bad = browser.value("[...document.images].filter(i => !i.naturalWidth).map(i => i.src).join(' ')")
    assert not bad, f"not drawn: {bad}"
    return browser.value("document.images.length")


def colored(image):
    """How many pixels have a colour."""
    return sum(n for n, pixel in image.getcolors(1 << 24) if max(pixel) - min(pixel) > 30)


def check_start(browser, site):
    go(browser, site / "index.html")
    assert browser.value("document.querySelector('h1').textContent") == "articulated"
    assert pictures(browser) >= 2
    links = json.loads(browser.value("JSON.stringify([...document.querySelectorAll('header nav a')].map(a => a.textContent))"))
    assert {"Documentation", "Book", "Robots", "Python"} <= set(links), links
    # Markdown is read as such: no link is left as text.
    assert "](" not in browser.value("document.querySelector('main').innerText.replace(/[^]*?(?=Limits)/, '')")
    finish(browser, "start page")


def check_documentation(browser, site):
    go(browser, site / "docs" / "index.html")
    assert browser.value("document.querySelectorAll('main li a').length") >= 30
    go(browser, site / "docs" / "mjcf.html")
    assert browser.value("document.querySelector('nav.side [aria-current]').textContent") == "MJCF"
    assert browser.value("document.querySelectorAll('.table table').length") == browser.value("document.querySelectorAll('table').length") > 2
    color = "getComputedStyle(document.querySelector('.code .k, .code .nt, .code .c1')).color !== getComputedStyle(document.body).color"
    assert browser.value(color), "code has no colours"
    go(browser, site / "docs" / "command.html", "#states")
    assert browser.value("scrollY") > 300, "the link to a heading does not go there"
    finish(browser, "documentation")


def check_gallery(browser, site, keep):
    """Search, filters, order and address."""
    everything = json.loads((site / "gallery" / "robots.json").read_text(encoding="utf-8"))["robots"]
    moving = [one for one in everything if one["nv"] != 0]
    go(browser, site / "gallery" / "index.html")
    assert len(cards(browser)) == min(48, len(moving)), (len(cards(browser)), len(moving))
    assert browser.value("document.getElementById('count').textContent").startswith(f"{len(moving)} of {len(everything)} files")
    assert pictures(browser) == sum(one["picture"] for one in moving[:48])
    assert colored(browser.screenshot()) > 5000, "pictures have no colours"
    keep("gallery")
    type_words(browser, "upkie camera")
    browser.until("document.querySelectorAll('.card').length === 1")
    assert cards(browser) == [("upkie_camera", "equal")], cards(browser)
    type_words(browser, "no such robot")
    browser.until("document.querySelectorAll('.card').length === 0")
    assert "articulated check FILE" in browser.value("document.getElementById('count').textContent")
    type_words(browser, "")
    for name in sorted({one["format"] for one in everything}):
        choose(browser, "format", name)
        expected = sorted(one["name"] for one in moving if one["format"] == name)
        found = [card for card, _ in cards(browser)]
        assert len(found) == min(48, len(expected)) and set(found) <= set(expected), (name, found, expected)
    choose(browser, "format", "")
    for kind in sorted({one["kind"] for one in everything}):
        choose(browser, "kind", kind)
        assert {one for _, one in cards(browser)} <= {kind}, kind
    choose(browser, "kind", "")
    choose(browser, "order", "nv")
    numbers = json.loads(browser.value("JSON.stringify([...document.querySelectorAll('.card .numbers b:first-child')].map(b => b.textContent))"))
    sizes = [-1 if text == "–" else int(text) for text in numbers[::4]]
    assert sizes == sorted(sizes, reverse=True) and sizes[0] == max(one["nv"] or 0 for one in everything), sizes
    browser.click("still")
    assert browser.value("document.getElementById('count').textContent").startswith(f"{len(everything)} of")
    go(browser, site / "gallery" / "index.html", "#words=gymnasium&format=MJCF&order=operations")
    found = cards(browser)
    assert found and browser.value("document.getElementById('words').value") == "gymnasium", found
    assert {name for name, _ in found} <= {one["name"] for one in everything if one["format"] == "MJCF"}
    finish(browser, "gallery")


def has_arrived(browser):
    """Whether a page of a robot is loaded; in between there is no page."""
    try:
        return browser.value("!!document.querySelector('table.facts') && document.readyState === 'complete'")
    except RuntimeError:
        return False


def check_robot(browser, site, keep):
    """A click on a card opens the page of the robot."""
    import devtools

    go(browser, site / "gallery" / "index.html", "#words=half_cheetah")
    assert cards(browser)[0] == ("half_cheetah", "equal"), "a file whose name is the word does not come first"
    browser.value("document.querySelector('.card h2 a').id = 'first'")
    browser.click("first")
    devtools.wait(lambda: has_arrived(browser), devtools.ANSWERED, "the page of the robot")
    text = browser.value("document.querySelector('main').innerText")
    for part in ["half_cheetah", "gymnasium", "9, 9", "multiplications", "MuJoCo", "licence of the package", "articulated check half_cheetah.xml"]:
        assert part in text, (part, text)
    assert pictures(browser) == 1 and colored(browser.screenshot()) > 3000
    keep("robot")
    finish(browser, "page of a robot")


def check_sizes(browser, site, keep):
    """No page is wider than a phone; dark pages are dark."""
    robot = next(one["page"] for one in json.loads((site / "gallery" / "robots.json").read_text(encoding="utf-8"))["robots"] if one["picture"])
    for name in ["index", "docs/index", "docs/command", "docs/mjcf", "docs/functions", "gallery/index", f"gallery/{robot}", "gallery/all", "python/reference"]:
        resize(browser, *PHONE)
        go(browser, site / f"{name}.html")
        width = browser.value("document.documentElement.scrollWidth")
        assert width <= PHONE[0], f"{name}: {width} px wide on a screen of {PHONE[0]} px"
        keep("phone_" + name.replace("/", "_").replace(robot, "robot"))
        resize(browser, *pages.SIZE)
        browser("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark"}])
        corner = browser.screenshot().getpixel((pages.SIZE[0] - 5, pages.SIZE[1] - 5))
        assert max(corner) < 70, f"{name}: {corner} in a dark page"
        keep("dark_" + name.replace("/", "_").replace(robot, "robot"))
        browser("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "light"}])
        finish(browser, f"{name} on a phone and dark")


def finish(browser, name):
    """No complaint of the browser."""
    assert browser.complaints() == [], f"{name}: {browser.complaints()}"
    print(f"{name}: ok, {time.monotonic() - STARTED:.0f} s", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--install", action="store_true", help="install Debian's Chromium where none is found and this is its administrator")
    parser.add_argument("--site", type=Path, metavar="FOLDER", help="a site that is built; it has the robots of gymnasium and upkie-description")
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="keep screenshots there")
    options = parser.parse_args()
    pages.ensure_packages()
    import devtools

    if options.install and not devtools.find():
        pages.install()
    path = devtools.find()
    if not path:
        print("not run: the site in a browser, which needs Chromium (Debian: chromium)")
        return
    if options.site and not (options.site / "gallery" / "robots.json").is_file():
        sys.exit(f"error: {options.site}: found no gallery/robots.json, expected the folder of a site that docs/site/build.py wrote with robots")
    with tempfile.TemporaryDirectory() as temporary, pages.opened(path, webgl=False) as browser:
        site = options.site or build(Path(temporary) / "site")
        if options.keep:
            options.keep.mkdir(parents=True, exist_ok=True)
        keep = lambda name: browser.screenshot().save(options.keep / f"{name}.png") if options.keep else None
        check_start(browser, site)
        keep("start")
        check_documentation(browser, site)
        keep("documentation")
        check_gallery(browser, site, keep)
        check_robot(browser, site, keep)
        check_sizes(browser, site, keep)


if __name__ == "__main__":
    main()
