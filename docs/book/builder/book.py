"""The whole book: reads all chapters, makes what they ask for, and writes the pages."""

import posixpath
import re
import shutil
import tomllib
from html import escape
from pathlib import Path

from . import chapter, formulas, players, sliders, summary
from .problems import Problems, Stop
from .summary import Chapter, Part

PAGE = Path(__file__).resolve().parent / "page"
REPOSITORY = Path(__file__).resolve().parent.parent.parent.parent


def build(source, output, command, tools, say):
    """Builds the chapters of the folder `source` into the folder `output`.

    `command` builds `articulated` and returns its path; with None all that needs it is left out.
    KaTeX is installed into `tools`. `say` prints one line of progress. Mistakes in the chapters
    raise a `Stop` that lists all of them.
    """
    if not (source / "SUMMARY.md").is_file():
        raise Stop(f"{source}: found no SUMMARY.md, expected the folder of the chapters")
    if output.exists() and not output.is_dir():
        raise Stop(f"{output}: found a file, expected a folder for the pages")
    root = source.parents[2] if len(source.parents) > 2 else source
    problems = Problems(root)
    katex = formulas.katex(tools / "npm", say)

    entries = summary.read(source, problems)
    chapters = [entry for entry in entries if isinstance(entry, Chapter)]
    reader = chapter.Reader(chapter.pages_of(chapters), root, address(), problems)
    texts = [reader.read(one) for one in chapters]
    chapter.check_links(texts, problems)
    blocks = [(text.chapter.file, line, tex) for text in texts for line, tex in text.formulas]
    made = dict(zip(((file, line) for file, line, _ in blocks), map(math, formulas.typeset(katex, blocks, problems))))
    widgets = [(text.chapter, line, kind, name) for text in texts for line, kind, name in text.widgets]
    for one, line, kind, name in widgets:
        (players if kind == "player" else sliders).check(REPOSITORY, one.file, line, name, problems)
    problems.end()
    say(f"{len(texts)} chapters, {len(blocks)} formulas")

    output.mkdir(parents=True, exist_ok=True)
    made |= {(one.file, line): html for (one, line, _, _), html in zip(widgets, widget_html(widgets, output, command, say))}
    title = next(iter(texts[0].anchors.values()), texts[0].chapter.title)
    for k, text in enumerate(texts):
        own = text.chapter
        html = reader.html(text, {line: html for (file, line), html in made.items() if file == own.file})
        page = output / own.page
        page.parent.mkdir(parents=True, exist_ok=True)
        page.write_text(filled(own, html, title, sidebar(entries, text), neighbours(chapters, k)), encoding="utf-8")
        for image in text.images:
            copy = output / image.relative_to(source)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(image, copy)
    for file in ["book.css", "sliders.js"]:
        shutil.copy(PAGE / file, output)
    formulas.copy_style(katex, output)
    say(f"{len(texts)} pages: {output / 'index.html'}")


def address():
    """The address of the repository, from the manifest of the workspace."""
    return tomllib.loads((REPOSITORY / "Cargo.toml").read_text(encoding="utf-8"))["workspace"]["package"]["repository"]


def widget_html(widgets, output, command, say):
    """The HTML of each widget. A scene that several chapters show is simulated once."""
    if not widgets:
        return
    if command is None:
        say("motions and sliders are left out, as --without-players says")
        program = None
    else:
        program = command()
        if not Path(program).is_file():
            raise Stop(f"{program}: there is no such file; ARTICULATED_COMMAND is the path of the command `articulated`, --without-players goes without it")
    folder, done, compilers = output / "players", {}, None
    if any(kind == "sliders" for _, _, kind, _ in widgets) and program:
        compilers = sliders.compilers()
        if compilers[2]:
            say(f"sliders are left out: found no {compilers[2]} (Debian: clang and lld, by --install)")
    for one, _, kind, name in widgets:
        if program is None or kind == "sliders" and compilers[2]:
            yield players.hint(REPOSITORY, name) if kind == "player" else sliders.hint(name)
        elif kind == "player":
            if name not in done:
                folder.mkdir(exist_ok=True)
                players.write(program, name, folder, say)
                done[name] = True
            yield players.html(REPOSITORY, name, relative(f"players/{name}.html", one.page))
        else:
            yield sliders.html(sliders.data(program, compilers, REPOSITORY, name, say))


def math(html):
    """The block of a formula."""
    return f'<div class="math">{html}</div>\n'


def relative(address, page):
    """An address of the output, as seen from a page."""
    return posixpath.relpath(address, posixpath.dirname(page) or ".")


def sidebar(entries, text):
    """The table of contents, with the sections of the chapter that is shown."""
    own, rows = text.chapter, []
    for entry in entries:
        if isinstance(entry, Part):
            rows.append(f'<li class="part">{escape(entry.title)}</li>')
            continue
        here = entry == own
        sections = "".join(f'<li><a href="#{escape(anchor)}">{escape(text.anchors[anchor])}</a></li>' for anchor in text.sections) if here else ""
        current = ' aria-current="page"' if here else ""
        indent = f' style="--depth:{entry.depth}"' if entry.depth else ""
        rows.append(f'<li{indent}><a href="{escape(relative(entry.page, own.page))}"{current}>{plain(entry.title)}</a>{f"<ol>{sections}</ol>" if sections else ""}</li>')
    return f"<ol>{''.join(rows)}</ol>"


def plain(title):
    """A title of SUMMARY.md, with its code in a font of code."""
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", escape(title))


def neighbours(chapters, k):
    """Links to the chapter before and to the next one."""
    own = chapters[k].page
    before = f'<a rel="prev" href="{escape(relative(chapters[k - 1].page, own))}">← {plain(chapters[k - 1].title)}</a>' if k else "<span></span>"
    after = f'<a rel="next" href="{escape(relative(chapters[k + 1].page, own))}">{plain(chapters[k + 1].title)} →</a>' if k + 1 < len(chapters) else ""
    return before + after


def filled(own, html, title, sidebar, neighbours):
    """The page of a chapter."""
    up = "../" * own.page.count("/")
    sheets = ["book.css"] + (["katex.css"] if 'class="katex' in html else [])
    parts = {
        "title": escape(title if own.page == "index.html" else f"{own.title} – {title}"),
        "book": escape(title),
        "head": "".join(f'<link rel="stylesheet" href="{up}{sheet}">\n' for sheet in sheets),
        "home": f"{up}index.html",
        "sidebar": sidebar,
        "chapter": html,
        "neighbours": neighbours,
        "foot": f'<script src="{up}sliders.js"></script>\n' if 'class="sliders"' in html else "",
    }
    return re.sub(r"\{\{(\w+)\}\}", lambda place: parts[place[1]], (PAGE / "page.html").read_text(encoding="utf-8"))
