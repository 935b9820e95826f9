"""Motions in the pages: the page that `articulated simulate` writes, in a frame."""

import subprocess
import time
import tomllib
from html import escape

from .problems import Stop, listed

TIME = 300  # s, at most, for one scene


def check(root, file, line, scene, problems):
    """Whether a scene is bundled; a problem if not."""
    scenes = {path.stem for path in (root / "models" / "scenes").glob("*.toml")}
    if scene in scenes:
        return True
    problems.add(file, line, f"player of {scene!r}: no such scene, expected one of {listed(scenes)}")
    return False


def write(command, scene, folder, say):
    """Writes the page of a scene into a folder, which the frames name."""
    start = time.monotonic()
    done = subprocess.run([command, "simulate", scene, "-o", folder / f"{scene}.html"], capture_output=True, text=True, encoding="utf-8", timeout=TIME)
    if done.returncode:
        raise Stop(f"`{command} simulate {scene}` ended with status {done.returncode}:\n{done.stderr.strip()}")
    say(f"player {scene}: {(folder / f'{scene}.html').stat().st_size / 1000:.0f} kB, {time.monotonic() - start:.1f} s")


def summary(root, scene):
    """The scene's own words about itself."""
    return tomllib.loads((root / "models" / "scenes" / f"{scene}.toml").read_text(encoding="utf-8"))["summary"]


def html(root, scene, address):
    """The frame, for a page from which the player has this address."""
    words, address = sentence(root, scene), escape(address)
    return (f'<figure class="player"><iframe src="{address}" loading="lazy" title="{words}"></iframe>\n'
            f'<figcaption>{words} Drag to turn the view. <a href="{address}">The player by itself</a></figcaption></figure>\n')


def hint(root, scene):
    """What a book without players says in their place."""
    return f'<p class="hint">{sentence(root, scene)} <code>articulated simulate {scene} -o {scene}.html</code> writes a page that plays it.</p>\n'


def sentence(root, scene):
    """The summary of a scene as a sentence, in HTML."""
    words = summary(root, scene)
    return escape(f"{words[0].upper()}{words[1:]}.")
