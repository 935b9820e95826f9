#!/usr/bin/env python3
"""Builds the site: a folder of pages that a browser reads without a network.

    python3 docs/site/build.py                   all robots: downloads 1.5 GB the first time
    python3 docs/site/build.py --robots 10       ten robots of small packages, as the checks do
    python3 docs/site/build.py --robots 0        no gallery
    python3 docs/site/build.py --only panda      robots whose package or path has this word
    python3 docs/site/build.py --reference       also the reference of the crates, from target/doc or by `cargo doc`
    python3 docs/site/build.py -o FOLDER         into this folder [default: target/site]

The start page is README.md. The other pages are docs/*.md, all Markdown pages and sources that they
link to, the Python package, and the gallery of robots: files of pinned Python packages, with what
`articulated check` and `generate` say about them, the verdicts of docs/site/data, the times of
docs/site/times.json, and a picture (picture.py). Where there is Node.js, docs/book/build.py writes the
book.

The command comes from ARTICULATED_COMMAND, or cargo builds it. Python packages go into
target/site-python. Facts about robots are kept below target/site-cache, by the content of the file
and of the command. The folder is emptied first; a folder with other files than those of a site is
an error.

Exit status: 0; 1 where a link of the site has no target, a package is missing or a program fails; 2
for a wrong command line.
"""

import argparse
import concurrent.futures
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parent.parent
sys.path[:0] = [str(HERE), str(REPOSITORY / "tests")]
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", REPOSITORY / "target"))
CACHE = TARGET / "site-cache"
MARK = ".articulated-site"  # a file of a folder that this program made
STARTED = time.monotonic()


def say(text):
    print(f"{time.monotonic() - STARTED:6.1f} s  {text}", flush=True)


class Wrong(Exception):
    """A mistake of the user, or of the machine, in words."""


def enter():
    """Runs this script again with the packages of requirements.txt."""
    if os.environ.get("ARTICULATED_SITE") == "1":
        return
    from virtual_environment import python_of

    say("Python packages")
    try:
        python = python_of(TARGET / "site-python", HERE / "requirements.txt")
    except (subprocess.CalledProcessError, OSError) as error:
        raise Wrong(f"{HERE / 'requirements.txt'}: its packages cannot be installed ({error}); expected Python with venv and pip, and a package index") from None
    done = subprocess.run([str(python), *sys.argv], env={**os.environ, "ARTICULATED_SITE": "1"})
    sys.exit(done.returncode)


def command():
    """The path of the command."""
    from programs import build_command

    say("the command")
    try:
        path = build_command()
    except (subprocess.CalledProcessError, OSError) as error:
        raise Wrong(f"the command cannot be built ({error}); expected cargo, or the path of a built command in ARTICULATED_COMMAND") from None
    if not path.is_file():
        raise Wrong(f"{path}: found no command; expected the path of `articulated` in ARTICULATED_COMMAND")
    return path.resolve()


def emptied(site):
    """Makes the folder empty, if it is one of this program."""
    if site.exists() and (not site.is_dir() or any(site.iterdir()) and not (site / MARK).exists()):
        raise Wrong(f"{site}: found something that is no site of this program, expected an empty folder, a site, or none")
    if site.exists():
        shutil.rmtree(site)
    site.mkdir(parents=True)
    (site / MARK).touch()


def book(site):
    """The book by its own program, or a page that says how to get it."""
    program = REPOSITORY / "docs" / "book" / "build.py"
    if not (shutil.which("node") and shutil.which("npm") and sys.version_info >= (3, 11)):
        say("the book is left out: it needs Node.js with npm (Debian: nodejs, npm) and Python 3.11")
        return False
    say("the book")
    if subprocess.run([sys.executable, str(program), "-o", str(site / "book")]).returncode:
        raise Wrong(f"{program}: failed, its messages are above")
    if not (site / "book" / "index.html").exists():
        raise Wrong(f"{program}: found no {site / 'book' / 'index.html'} after it ran, expected the first page of the book there")
    return True


def reference(site):
    """The reference of the crates."""
    documented = TARGET / "doc"
    if not (documented / "articulated_core" / "index.html").exists():
        say("cargo doc")
        words = ["cargo", "doc", "--quiet", "--workspace", "--exclude", "articulated-python", "--no-deps"]
        try:
            subprocess.run(words, cwd=REPOSITORY, check=True)
        except (subprocess.CalledProcessError, OSError) as error:
            raise Wrong(f"the reference of the crates cannot be made ({error}); without --reference the site has none") from None
    say("the reference of the crates")
    shutil.copytree(documented, site / "rust", ignore=shutil.ignore_patterns(".lock", ".rustdoc*"))
    crates = sorted(path.parent.name for path in documented.glob("articulated*/index.html"))
    links = "".join(f'<li><a href="{name}/index.html">{name}</a></li>' for name in crates)
    return f"<h1>Crates</h1><p>The reference of the crates, as `cargo doc` writes it:</p><ul>{links}</ul>".replace("`cargo doc`", "<code>cargo doc</code>")


def facts(articulated, wanted):
    """Robots with their facts, in the order of `wanted`."""
    import corpora
    from facts import Facts

    folders, paths = {}, []
    for robot in wanted:
        if (robot.corpus, robot.package) not in folders:
            say(f"package {robot.package} ({robot.format})")
        paths.append(corpora.path_of(robot, folders))
    known, found, kept = Facts(articulated, CACHE), [], 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for robot, (one, is_kept) in zip(wanted, pool.map(known.of, wanted, paths)):
            found.append((robot, one))
            kept += is_kept
            if len(found) % 25 == 0 or len(found) == len(wanted):
                say(f"{len(found)} of {len(wanted)} robots, {kept} from the cache")
    return found


def gallery(pages, articulated, arguments):
    """The gallery of the chosen robots."""
    import corpora
    from gallery import Gallery
    from times import recorded

    wanted = corpora.robots(arguments.robots, arguments.only or "")
    if not wanted:
        raise Wrong(f"--only {arguments.only}: found no package or file with this word in docs/site/data, expected a part of a name such as panda or gymnasium")
    licences = corpora.licences()
    rows = facts(articulated, wanted)
    Gallery(pages, rows, len(corpora.robots()), recorded(), licences).build()


def build(arguments):
    import links
    import python_reference
    from pages import DeadLink, Pages, code_colors, write

    articulated = command() if arguments.robots != 0 else None
    site = arguments.output.resolve()
    emptied(site)
    has_book = book(site)
    has_robots = arguments.robots != 0
    parts = [("Documentation", "docs/index.html"), ("Book", "book/index.html")]
    parts += [("Robots", "gallery/index.html")] if has_robots else []
    parts += [("Python", "python/reference.html")] + ([("Rust", "rust/index.html")] if arguments.reference else [])
    pages = Pages(REPOSITORY, site, parts)
    if not has_book:
        text = "<h1>The book</h1><p>This site is built without the book. Its text is in <code>docs/book/src</code>; <code>python3 docs/book/build.py</code> writes its pages.</p>"
        write(site / "book" / "index.html", pages.page("book/index.html", "The book", text))
    say("pages")
    try:
        count = pages.build()
    except DeadLink as error:
        raise Wrong(str(error)) from None
    say(f"{count} pages and files")
    write(site / python_reference.PLACE, python_reference.build(pages))
    if arguments.reference:
        write(site / "rust" / "index.html", pages.page("rust/index.html", "Crates", reference(site)))
    if has_robots:
        gallery(pages, articulated, arguments)
    write(site / "style.css", (HERE / "style.css").read_text(encoding="utf-8") + code_colors())
    write(site / "gallery.js", (HERE / "gallery.js").read_text(encoding="utf-8"))
    count, wrong = links.dead(site, skipped=("rust",))
    for sentence in wrong:
        print(f"error: dead link: {sentence}", file=sys.stderr)
    say(f"{count} links" + (f", {len(wrong)} without a target" if wrong else " have targets"))
    size = sum(path.stat().st_size for path in site.rglob("*") if path.is_file())
    say(f"{site / 'index.html'} ({size / 1e6:.1f} MB)")
    return 1 if wrong else 0


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", type=Path, default=TARGET / "site", metavar="FOLDER", help="the folder of the site")
    chosen = parser.add_mutually_exclusive_group()
    chosen.add_argument("--robots", type=int, metavar="N", help="only so many robots, those of small packages first")
    chosen.add_argument("--only", metavar="WORD", help="only robots whose package or path has this word")
    parser.add_argument("--reference", action="store_true", help="also the reference of the crates")
    arguments = parser.parse_args()
    if arguments.robots is not None and arguments.robots < 0:
        parser.error(f"--robots: found {arguments.robots}, expected 0 or more")
    return arguments


def main():
    arguments = parse()
    try:
        enter()
        import corpora

        try:
            return build(arguments)
        except corpora.Unavailable as error:
            raise Wrong(str(error)) from None
    except Wrong as error:
        print(f"error: {error}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
