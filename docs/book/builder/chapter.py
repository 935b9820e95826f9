"""One chapter: from Markdown to HTML, and what has to be made for it on the way."""

import posixpath
import re
import unicodedata
from dataclasses import dataclass, field
from html import escape
from pathlib import Path
from urllib.parse import unquote

from markdown_it import MarkdownIt

from . import code
from .summary import Chapter

COMMENT = re.compile(r"<!--\s*(?:(\w+):\s*)?(.*?)\s*-->\s*$", re.DOTALL)
# Kinds of comments: those of CAPTIONS name the source of the code block that follows, those of
# WIDGETS ask for something that is made for the page.
CAPTIONS, WIDGETS = ("quote", "generated"), ("player", "sliders")
# A letter, which may have marks, with an index, a power, or both: what `code` has stays as it is.
LETTER = r"(?<!\w)([^\W\d_][\u0300-\u036f]*)"
INDEX = re.compile(LETTER + r"(?:_([0-9A-Za-zα-ω]+))?(?:\^([A-Za-z]))?(?![0-9A-Za-zα-ω_^])")
IMAGES = (".svg", ".png", ".jpg", ".jpeg", ".gif", ".webp")


@dataclass
class Text:
    """A chapter, parsed."""

    chapter: Chapter
    tokens: list
    # Words of the headings by their anchors; those of the second level are in the sidebar.
    anchors: dict = field(default_factory=dict)
    sections: list = field(default_factory=list)
    # These are made for the page, each with its line: a formula has its LaTeX, a widget has its
    # kind and its name.
    formulas: list = field(default_factory=list)
    widgets: list = field(default_factory=list)
    images: set = field(default_factory=set)
    # Links into chapters: line, page and anchor.
    links: list = field(default_factory=list)


class Reader:
    """Parses chapters. `pages` has the page of each chapter's file."""

    def __init__(self, pages, root, repository, problems):
        self.pages, self.root, self.repository, self.problems = pages, root, repository, problems
        self.markdown = MarkdownIt("commonmark", {"html": True}).enable(["table", "strikethrough"])
        rules = {name.removeprefix("_render_"): getattr(Reader, name) for name in dir(Reader) if name.startswith("_render_")}
        for name, rule in rules.items():
            self.markdown.add_render_rule(name, rule)

    def read(self, chapter):
        """A chapter's text, with addresses of pages in place of those of files."""
        text = Text(chapter, self.markdown.parse(chapter.file.read_text(encoding="utf-8")))
        caption = None
        for k, token in enumerate(text.tokens):
            line = token.map[0] + 1 if token.map else 0
            over, caption = caption, None
            if over and token.type != "fence":
                self._without_block(chapter, over)
            if token.type == "html_block":
                caption = self._comment(text, token, line)
            elif token.type == "heading_open":
                self._heading(text, token, text.tokens[k + 1])
            elif token.type == "inline":
                for child in token.children:
                    self._inline(text, child, line)
            elif token.type == "fence":
                self._fence(text, token, line, over)
        if caption:
            self._without_block(chapter, caption)
        return text

    def _without_block(self, chapter, caption):
        kind, what, line = caption
        self.problems.add(chapter.file, line, f"found no code block after the comment `{kind}: {what}`")

    def html(self, text, made):
        """The chapter as HTML; `made` has the HTML of each formula and widget by its line."""
        return self.markdown.renderer.render(text.tokens, self.markdown.options, {"made": made})

    def _comment(self, text, token, line):
        """Reads a comment: the kind, the text and the line of a caption, else None.

        A widget is noted in `text`. HTML that is no comment stays as it is.
        """
        comment = COMMENT.match(token.content)
        if not comment:
            return None
        kind, what = comment[1], comment[2]
        token.content = ""
        if kind in WIDGETS:
            text.widgets.append((line, kind, what))
            token.meta["made"] = line
        elif kind in CAPTIONS:
            return kind, what, line
        elif kind:
            self.problems.add(text.chapter.file, line, f"found the comment `{kind}: …`, expected one of {code_list(CAPTIONS + WIDGETS)}")
        return None

    def _heading(self, text, token, inline):
        """A heading gets the anchor that GitHub gives it."""
        title = "".join(child.content for child in inline.children if child.type in ("text", "code_inline"))
        base = "".join(c for c in title.lower().strip().replace(" ", "-") if c.isalnum() or c in "-_" or unicodedata.combining(c))
        anchor, count = base, 0
        while anchor in text.anchors:
            count += 1
            anchor = f"{base}-{count}"
        text.anchors[anchor] = title
        token.attrSet("id", anchor)
        if token.tag == "h2":
            text.sections.append(anchor)

    def _inline(self, text, child, line):
        if child.type == "link_open":
            child.attrSet("href", self._address(text, child.attrGet("href"), line))
        elif child.type == "image":
            child.attrSet("src", self._image(text, child.attrGet("src"), line))

    def _address(self, text, address, line):
        """The address of a link: of a page for a chapter, of the repository for another file."""
        if re.match(r"[a-z][a-z0-9+.-]*:", address):
            return address
        path, _, anchor = address.partition("#")
        own = text.chapter
        if not path:
            text.links.append((line, own.page, unquote(anchor)))
            return address
        file = (own.file.parent / unquote(path)).resolve()
        if file in self.pages:
            page = self.pages[file]
            text.links.append((line, page, unquote(anchor)))
            return posixpath.relpath(page, posixpath.dirname(own.page) or ".") + (f"#{anchor}" if anchor else "")
        if not file.exists():
            self.problems.add(own.file, line, f"link to {address}: there is no such file")
        elif not file.is_relative_to(self.root):
            self.problems.add(own.file, line, f"link to {address}: the file is outside the repository")
        elif file.suffix == ".md" and file.parent == own.file.parent:
            self.problems.add(own.file, line, f"link to {address}: the chapter is not in SUMMARY.md")
        else:
            return self.in_repository(file, anchor)
        return address

    def in_repository(self, file, anchor=""):
        """The address of a file of the repository, beyond this machine."""
        kind = "tree" if file.is_dir() else "blob"
        return f"{self.repository}/{kind}/HEAD/{file.relative_to(self.root).as_posix()}" + (f"#{anchor}" if anchor else "")

    def _image(self, text, address, line):
        file = (text.chapter.file.parent / unquote(address)).resolve()
        folder = next(iter(self.pages)).parent
        if not file.is_file() or not file.is_relative_to(folder) or file.suffix.lower() not in IMAGES:
            self.problems.add(text.chapter.file, line, f"picture {address}: expected a file in {folder.name} that ends with {code_list(IMAGES)}")
            return address
        text.images.add(file)
        return address

    def _fence(self, text, token, line, caption):
        language = re.split(r"[\s,{]", token.info.strip(), maxsplit=1)[0]
        if language == "math":
            text.formulas.append((line, token.content))
            token.meta["made"] = line
            return
        lexer = code.lexer(language)
        if lexer is None:
            self.problems.add(text.chapter.file, line, f"found a code block in {language!r}, a language that Pygments does not know; `text` is without colours")
            return
        content = code.without_hidden_lines(token.content) if language == "rust" else token.content
        content = code.without_common_indentation(content) if caption else content
        token.meta["html"] = figure(self._caption(text, caption), code.html(content, lexer))

    def _caption(self, text, caption):
        """The words over a quotation: where it is from."""
        if not caption:
            return ""
        kind, what, line = caption
        if kind == "generated":
            robot, _, function = what.partition(" ")
            return f"generated code: <code>{escape(function)}</code> of <code>{escape(robot)}</code>"
        file = (self.root / what).resolve()
        if not file.is_file() or not file.is_relative_to(self.root):
            self.problems.add(text.chapter.file, line, f"quotation of {what}: there is no such file in the repository")
            return ""
        return f'<a href="{escape(self.in_repository(file))}"><code>{escape(what)}</code></a>'

    # Rules of the renderer.

    def _render_fence(self, tokens, k, options, env):
        meta = tokens[k].meta
        return env["made"][meta["made"]] if "made" in meta else meta.get("html", "")

    def _render_html_block(self, tokens, k, options, env):
        meta = tokens[k].meta
        return env["made"][meta["made"]] if "made" in meta else tokens[k].content

    def _render_text(self, tokens, k, options, env):
        return INDEX.sub(_lowered, escape(tokens[k].content, quote=False))

    def _render_heading_close(self, tokens, k, options, env):
        anchor = escape(str(tokens[k - 2].attrGet("id")))
        return f' <a class="anchor" href="#{anchor}" aria-label="Link to this section">#</a></{tokens[k].tag}>\n'

    def _render_table_open(self, tokens, k, options, env):
        return '<div class="table"><table>\n'

    def _render_table_close(self, tokens, k, options, env):
        return "</table></div>\n"


def _lowered(found):
    """A symbol of one letter with its index, and a further power of one letter: D_k, I_1^a."""
    symbol, index, power = found.groups()
    return f"{symbol}{f'<sub>{index}</sub>' if index else ''}{f'<sup>{power}</sup>' if power else ''}"


def figure(caption, block):
    return f'<figure class="code">{f"<figcaption>{caption}</figcaption>" if caption else ""}{block}</figure>\n'


def code_list(names):
    return ", ".join(f"`{name}`" for name in names)


def check_links(texts, problems):
    """Each anchor that a link names is that of a heading."""
    anchors = {text.chapter.page: text.anchors for text in texts}
    for text in texts:
        for line, page, anchor in text.links:
            if anchor and anchor not in anchors[page]:
                problems.add(text.chapter.file, line, f"link to #{anchor}: {page} has no such heading")


def pages_of(chapters):
    """The page of each chapter's file."""
    return {Path(chapter.file).resolve(): chapter.page for chapter in chapters}
