"""Highlights code blocks. Each line is an element, so a long line wraps with its indentation."""

from html import escape

from pygments.lexers import get_lexer_by_name
from pygments.lexers.special import TextLexer
from pygments.token import Comment, Keyword, Literal, Name
from pygments.util import ClassNotFound

# The class of a kind of token is that of the narrowest kind here that contains it. All other tokens
# have the colour of the text.
CLASSES = {
    Comment: "c",
    Comment.Preproc: "p",
    Keyword: "k",
    Keyword.Type: "t",
    Literal.Number: "n",
    Literal.String: "s",
    Name.Class: "t",
    Name.Decorator: "p",
    Name.Function: "f",
    Name.Function.Magic: "f",
}


def lexer(language):
    """What splits a language into tokens, or None if the language is unknown."""
    try:
        return TextLexer(stripnl=False) if language in ("", "text", "txt") else get_lexer_by_name(language, stripnl=False)
    except ClassNotFound:
        return None


def without_hidden_lines(text):
    """Rust as rustdoc shows it: lines that begin with `# ` are compiled and not shown."""
    shown = []
    for line in text.splitlines():
        bare = line.strip()
        if bare == "#" or bare.startswith("# "):
            continue
        shown.append(line.replace("##", "#", 1) if bare.startswith("##") else line)
    return "\n".join(shown).rstrip() + "\n"


def without_common_indentation(text):
    """A quotation without the indentation that all of its lines have.

    A line `…` stands for lines that are left out, and may have no indentation.
    """
    lines = text.splitlines()
    indents = [len(line) - len(line.lstrip(" ")) for line in lines if line.strip() not in ("", "…")]
    common = min(indents, default=0)
    return "".join((line if line.strip() == "…" else line[common:]) + "\n" for line in lines)


def html(text, lexer):
    """The block as HTML."""
    lines, line = [], []
    for kind, value in lexer.get_tokens(text):
        mark = next((CLASSES[k] for k in reversed(kind.split()) if k in CLASSES), None)
        for k, part in enumerate(value.split("\n")):
            if k:
                lines.append(line)
                line = []
            if part:
                line.append((mark, part))
    lines += [line] if line else []
    return f'<pre><code>{"".join(map(row, lines))}</code></pre>\n'


def row(line):
    """One line: a block of its own, with the columns of its indentation as `--in`."""
    text = "".join(part for _, part in line)
    indent = len(text) - len(text.lstrip(" "))
    inner = "".join(f'<i class="{mark}">{escape(part, quote=False)}</i>' if mark else escape(part, quote=False) for mark, part in line)
    return f'<span{f" style=--in:{indent}" if indent else ""}>{inner}\n</span>'
