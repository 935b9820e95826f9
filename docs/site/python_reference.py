"""The reference of the Python package as one page: signatures from its stubs (.pyi), texts from
their docstrings or those of the modules.

Only the sources are read: nothing is imported, so the package need not be built.
"""

import ast
import html
import inspect
import re
from pathlib import Path

from pages import anchor, code_block

STUBS = ["__init__.pyi", "jax.pyi", "torch.pyi"]
TITLES = {"__init__.pyi": "articulated", "jax.pyi": "articulated.jax", "torch.pyi": "articulated.torch"}
PLACE = Path("python/reference.html")


def build(pages):
    """The HTML of the page."""
    package = pages.repository / "python" / "articulated"
    texts = docstrings(package)
    used, parts, contents = {}, [], []
    for stub in STUBS:
        if (package / stub).exists():
            module(ast.parse((package / stub).read_text(encoding="utf-8")), stub, texts, used, parts, contents)
    head = '<h1>Python package</h1><p><a href="README.html">How to install and use it.</a> Shapes are those of one state; '
    head += "a batch of states has one more dimension in front. Units are SI units and radians.</p>"
    return pages.page(PLACE, "Python package", head + f'<ul class="contents">{"".join(contents)}</ul>' + "\n".join(parts))


def docstrings(package):
    """The docstrings of all modules: of a module under its stem, of a function or class under its
    name, of a method under both names.
    """
    found = {}
    for path in sorted(package.glob("*.py")):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        found[path.stem] = ast.get_docstring(tree)
        for node in tree.body:
            if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
                found.setdefault(node.name, ast.get_docstring(node))
            for inner in node.body if isinstance(node, ast.ClassDef) else []:
                if isinstance(inner, ast.FunctionDef):
                    found.setdefault(f"{node.name}.{inner.name}", ast.get_docstring(inner))
    return found


def module(tree, stub, texts, used, parts, contents):
    """Adds the parts of a module, and their entries in the list of contents."""
    title = TITLES[stub]
    mark = anchor(title, used)
    parts.append(f'<h2 id="{mark}"><code>{title}</code></h2>' + text_of(texts.get(Path(stub).stem) or ast.get_docstring(tree)))
    names = []
    bases = {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}
    for node in tree.body:
        if not isinstance(node, (ast.ClassDef, ast.FunctionDef)) or node.name.startswith("_"):
            continue
        own = anchor(node.name, used)
        names.append(f'<a href="#{own}"><code>{node.name}</code></a>')
        parts.append(f'<h3 id="{own}"><code>{node.name}</code></h3>')
        if isinstance(node, ast.FunctionDef):
            parts.append(signature(node) + text_of(ast.get_docstring(node) or texts.get(node.name)))
            continue
        parts.append(text_of(ast.get_docstring(node) or texts.get(node.name)))
        fields = [inner for inner in node.body if isinstance(inner, ast.AnnAssign)]
        if fields:
            parts.append(code_block("\n".join(ast.unparse(inner) for inner in fields) + "\n", "python"))
        for inner in [*methods(node), *(inherited for base in node.bases for inherited in methods(bases.get(getattr(base, "id", None))))]:
            parts.append(f'<h4 id="{anchor(f"{node.name}.{inner.name}", used)}"></h4>' + signature(inner))
            parts.append(text_of(ast.get_docstring(inner) or texts.get(f"{node.name}.{inner.name}") or texts.get(inner.name)))
    # The other modules have the functions of a robot once more.
    inside = f": {', '.join(names)}" if stub == STUBS[0] else f": {len(names)} functions"
    contents.append(f'<li><a href="#{mark}"><code>{title}</code></a>{inside}</li>')


def methods(node):
    """The public methods of a class, and its operators."""
    inside = node.body if node else []
    return [inner for inner in inside if isinstance(inner, ast.FunctionDef) and (not inner.name.startswith("_") or inner.name in ("__call__", "__getitem__"))]


def signature(node):
    """The line of a function; a long one has a line for each argument."""
    if any(getattr(one, "id", "") == "property" for one in node.decorator_list):
        return code_block(f"{node.name}: {ast.unparse(node.returns) if node.returns else ''}\n", "python")
    result = f" -> {ast.unparse(node.returns)}" if node.returns else ""
    arguments = re.sub(r"^self(, )?", "", ast.unparse(node.args))
    line = f"{node.name}({arguments}){result}"
    if len(line) > 100:
        line = f"{node.name}(\n    " + ",\n    ".join(parts_of(arguments)) + f",\n){result}"
    return code_block(line + "\n", "python")


def parts_of(arguments):
    """The arguments, divided at the commas outside of brackets."""
    depth, found = 0, [""]
    for letter in arguments:
        depth += (letter in "[(") - (letter in "])")
        if letter == "," and depth == 0:
            found.append("")
        else:
            found[-1] += letter
    return [part.strip() for part in found]


def text_of(docstring):
    """A docstring: paragraphs, and examples as code."""
    if not docstring:
        return ""
    out = []
    for block in re.split(r"\n\s*\n", inspect.cleandoc(docstring)):
        if block.lstrip().startswith(">>>"):
            out.append(code_block(block + "\n", "pycon"))
        elif re.match(r"\w+:\n ", block):
            title, _, rest = block.partition("\n")
            # An item begins at the indentation of the first; the lines of an item are indented
            # further.
            items = re.split(r"\n(?=\S)", inspect.cleandoc(rest))
            out.append(f"<p>{title}</p><ul>" + "".join(f"<li>{inline(item)}</li>" for item in items) + "</ul>")
        else:
            out.append(f"<p>{inline(block, names=False)}</p>")
    return "".join(out)


def inline(text, names=True):
    """A text with its parts in backquotes as code; with `names` also the name before a colon at its
    start.
    """
    text = re.sub(r"^([*\w]+):(?=\s)", r"`\1`:", text) if names else text
    return re.sub(r"``?([^`]+)``?", r"<code>\1</code>", html.escape(text, quote=False))
