"""Markdown pages of the repository as HTML, and what all pages share: head, navigation, source
files that pages link to.
"""

import html
import os
import re
import subprocess
from pathlib import Path

from markdown_it import MarkdownIt
from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import TextLexer, get_lexer_by_name, get_lexer_for_filename
from pygments.util import ClassNotFound

NAME = "articulated"
# The groups of the navigation of the documentation. Pages that are in none come last, under "More".
GROUPS = [
    ("Use", ["macro", "command", "library", "embedded", "conventions", "coming-from", "recipes", "compile-times", "limits"]),
    ("Functions", ["functions", "derivatives", "your-own-function", "steps", "contact", "batches"]),
    ("Robot files", ["urdf", "xacro", "mjcf", "sdf", "mjcf-files", "contact-files"]),
    ("Motion", ["simulate-start", "scenes", "effects", "simulate", "simulation"]),
    ("Numbers", ["speed", "accuracy", "scaling", "stress", "measured"]),
    ("Inside", ["design", "algorithms"]),
]
PICTURES = {".svg", ".png", ".jpg", ".jpeg", ".gif"}
LARGEST = 400_000  # bytes of a source file that is shown as a page
BOOK = Path("docs/book/src")
# The navigation is closed on a small screen, where it has a line to open it.
FOLD = """<script>
{ const small = matchMedia("(max-width: 800px)"), fold = () => { document.querySelector("nav.side details").open = !small.matches; };
  small.addEventListener("change", fold); fold(); }
</script>"""
OUTSIDE = re.compile(r"[a-z][a-z0-9+.-]*:|//", re.IGNORECASE)


class DeadLink(Exception):
    """A link of a page to a file that the repository does not have."""


def write(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


class Pages:
    """The pages of one site.

    `parts` are the links of the head: pairs of a title and a path in the site.
    """

    def __init__(self, repository, site, parts):
        self.repository, self.site, self.parts = repository, site, parts
        listed = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard"], cwd=repository, capture_output=True, text=True, check=True)
        self.files = {Path(line) for line in listed.stdout.splitlines() if (repository / line).is_file()}
        self.folders = {folder for file in self.files for folder in file.parents}
        self.queue, self.done = [], set()
        self.reader = MarkdownIt("commonmark", {"html": True}).enable(["table", "strikethrough"])
        self.titles = {}

    def build(self):
        """README, the pages of docs, and all files that they link to."""
        for path in sorted((self.repository / "docs").glob("*.md")):
            self.titles[path.stem] = short_title(path.read_text(encoding="utf-8"), path.stem)
        self.want(Path("README.md"))
        for stem in self.titles:
            self.want(Path("docs") / f"{stem}.md")
        while self.queue:
            self.make(self.queue.pop())
        write(self.site / "docs" / "index.html", self.page("docs/index.html", "Documentation", self.contents()))
        return len(self.done)

    def want(self, path):
        """The place in the site of a file or folder of the repository; it is made if it is not
        there.
        """
        if path == Path("README.md"):
            place = Path("index.html")
        elif path.parent == BOOK and path.suffix == ".md":
            chapter = Path("book") / ("index.html" if path.stem == "SUMMARY" else f"{path.stem}.html")
            return chapter if (self.site / chapter).exists() else Path("book/index.html")
        elif path.suffix == ".md":
            place = path.with_suffix(".html")
        elif path in self.folders:
            place = Path("files") / path / "index.html"
        elif path.suffix.lower() in PICTURES:
            place = path
        else:
            place = Path("files") / f"{path}.html"
        if path not in self.done:
            self.done.add(path)
            self.queue.append((path, place))
        return place

    def make(self, wanted):
        path, place = wanted
        source, out = self.repository / path, self.site / place
        if path in self.folders:
            inside = sorted(file for file in self.files if path in file.parents)
            rows = "".join(f"<li><code>{html.escape(str(file.relative_to(path)))}</code></li>" for file in inside)
            write(out, self.page(place, f"{path}", f"<h1><code>{html.escape(str(path))}</code></h1><p>Files of this folder of the repository:</p><ul>{rows}</ul>"))
        elif path.suffix == ".md":
            title, body = self.markdown(source.read_text(encoding="utf-8"), path, place)
            write(out, self.page(place, title, body, self.navigation(place) if path.parent == Path("docs") else ""))
        elif path.suffix.lower() in PICTURES:
            out.parent.mkdir(parents=True, exist_ok=True)
            out.write_bytes(source.read_bytes())
        else:
            write(out, self.page(place, path.name, f"<h1><code>{html.escape(str(path))}</code></h1>" + self.source(source)))

    def source(self, path):
        """A source file with colours."""
        data = path.read_bytes()
        try:
            text = data.decode("utf-8")
        except UnicodeDecodeError:
            return f"<p>A file of {len(data)} bytes that is no text.</p>"
        if len(text) > LARGEST:
            return f"<p>A text of {len(data)} bytes, which this page does not show.</p>"
        try:
            lexer = get_lexer_for_filename(path.name)
        except ClassNotFound:
            lexer = TextLexer()
        return highlight(text, lexer, HtmlFormatter(cssclass="code"))

    def markdown(self, text, path, place):
        """The title and the HTML of a Markdown text: `path` is its file in the repository, `place`
        that of its page.
        """
        tokens = self.reader.parse(without_comments(text))
        used, title = {}, path.stem
        for k, token in enumerate(tokens):
            if token.type == "heading_open":
                words = plain(tokens[k + 1])
                title = words if token.tag == "h1" and title == path.stem else title
                token.attrSet("id", anchor(words, used))
            if token.type == "inline":
                for child in token.children:
                    self.relink(child, path, place)
        body = self.reader.renderer.render(self.code(tokens), self.reader.options, {})
        return title, framed(body)

    def code(self, tokens):
        """The tokens, with coloured code in place of code blocks."""
        for token in tokens:
            if token.type in ("fence", "code_block"):
                token.type, token.content = "html_block", code_block(token.content, token.info)
        return tokens

    def relink(self, token, path, place):
        key = {"link_open": "href", "image": "src"}.get(token.type)
        if not key:
            return
        target = token.attrGet(key)
        if not target or target.startswith("#") or OUTSIDE.match(target):
            return
        name, mark, fragment = target.partition("#")
        wanted = Path(os.path.normpath(path.parent / name))
        if wanted not in self.files and wanted not in self.folders:
            raise DeadLink(f"{path}: link {target}: found no file {wanted} in the repository, expected the path of a file from the folder of {path}")
        token.attrSet(key, relative(self.want(wanted), place) + mark + fragment)

    def contents(self):
        """The list of all pages of docs, in their groups."""
        out = ["<h1>Documentation</h1>"]
        for group, stems in self.groups():
            out.append(f"<h2>{group}</h2><ul>")
            for stem in stems:
                text = (self.repository / "docs" / f"{stem}.md").read_text(encoding="utf-8")
                out.append(f'<li><a href="{stem}.html">{self.inline(text.partition(chr(10))[0].removeprefix("# "))}</a></li>')
            out.append("</ul>")
        return "\n".join(out)

    def inline(self, text):
        return self.reader.renderInline(text)

    def groups(self):
        known = {stem for _, stems in GROUPS for stem in stems}
        more = [stem for stem in self.titles if stem not in known]
        found = [(group, [stem for stem in stems if stem in self.titles]) for group, stems in [*GROUPS, ("More", more)]]
        return [(group, stems) for group, stems in found if stems]

    def navigation(self, place):
        """The links beside a page of docs."""
        out = []
        for group, stems in self.groups():
            links = "".join(f'<li><a href="{stem}.html"{here(place == Path("docs") / f"{stem}.html")}>{self.inline(self.titles[stem])}</a></li>' for stem in stems)
            out.append(f"<p>{group}</p><ul>{links}</ul>")
        return '<nav class="side"><details open><summary>Pages</summary>' + "".join(out) + "</details></nav>"

    def page(self, place, title, body, side="", head=""):
        """The HTML of a page at a place of the site."""
        place = Path(place)
        top = {"docs": "docs/index.html", "gallery": "gallery/index.html", "python": "", "reference": ""}.get(place.parts[0], str(place))
        links = "".join(f'<a href="{relative(Path(to), place)}"{here(to in (top, str(place)))}>{name}</a>' for name, to in self.parts)
        title = html.escape(title.replace("`", ""))
        title = NAME if title == NAME else f"{title} · {NAME}"
        return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title>
<link rel="icon" href="data:,">
<link rel="stylesheet" href="{relative(Path("style.css"), place)}">
{head}</head>
<body>
<header><a class="name" href="{relative(Path("index.html"), place)}">{NAME}</a><nav>{links}</nav></header>
<div class="{"two" if side else "one"}">
{side}<main>
{body}
</main>
</div>
{FOLD if side else ""}
</body>
</html>
"""


def here(is_here):
    return ' aria-current="page"' if is_here else ""


def relative(target, place):
    """The link from a page to a place of the site."""
    return os.path.relpath(target, Path(place).parent).replace(os.sep, "/")


def short_title(text, stem):
    """The heading of a page, without the question after a colon."""
    title = text.partition("\n")[0].removeprefix("# ").partition(": ")[0].strip()
    return title or stem


def without_comments(text):
    """The text without HTML comments outside of code blocks: a line that begins with one would be
    no Markdown.
    """
    parts = re.split(r"(^```.*?^```[ ]*$)", text, flags=re.DOTALL | re.MULTILINE)
    return "".join(part if k % 2 else re.sub(r"<!--.*?-->", "", part, flags=re.DOTALL) for k, part in enumerate(parts))


def plain(token):
    """The words of an inline token."""
    return "".join(child.content for child in token.children or [] if child.type in ("text", "code_inline"))


def anchor(words, used):
    """The id of a heading, as GitHub makes it; equal headings get numbers."""
    name = re.sub(r"[^\w\- ]", "", words.lower()).replace(" ", "-")
    count = used[name] = used.get(name, -1) + 1
    return f"{name}-{count}" if count else name


def framed(body):
    """The body with each table in a frame of its own, inside which it scrolls."""
    return body.replace("<table>", '<div class="table" tabindex="0"><table>').replace("</table>", "</table></div>")


def code_block(text, info):
    """Code with colours. Lines of Rust that its documentation hides (`# use …`) are left out."""
    language = re.split(r"[\s,{]", info.strip())[0].lower()
    if language == "rust":
        text = "".join(line for line in text.splitlines(keepends=True) if line.rstrip() != "#" and not line.startswith("# "))
    try:
        lexer = get_lexer_by_name({"sh": "bash", "": "text"}.get(language, language))
    except ClassNotFound:
        lexer = TextLexer()
    return highlight(text, lexer, HtmlFormatter(cssclass="code"))


def code_colors():
    """The style sheet of coloured code, for light and dark pages."""
    light, dark = (HtmlFormatter(style=style, cssclass="code").get_style_defs(".code") for style in ("friendly", "github-dark"))
    return f"{light}\n@media (prefers-color-scheme: dark) {{\n{dark}\n}}\n.code, .code pre {{ background: none; }}\n"
