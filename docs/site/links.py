"""Checks that every link of a site to the site itself has a target: a file, and an element with the
id of its fragment.
"""

import re
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

OUTSIDE = re.compile(r"[a-z][a-z0-9+.-]*:|//", re.IGNORECASE)


class Page(HTMLParser):
    """The ids and the links of a page, the latter with their lines."""

    def __init__(self):
        super().__init__()
        self.ids, self.links = set(), []

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("id", "name") and value:
                self.ids.add(value)
            elif name in ("href", "src") and value and not OUTSIDE.match(value):
                self.links.append((value, self.getpos()[0]))


def dead(site, skipped=()):
    """The number of links, and a sentence for each that has no target.

    `skipped`: folders whose pages are not read. Links to their files are checked.
    """
    pages, wrong, count = {}, [], 0

    def read(path):
        if path not in pages:
            pages[path] = Page()
            pages[path].feed(path.read_text(encoding="utf-8", errors="replace"))
        return pages[path]

    for path in sorted(site.rglob("*.html")):
        if path.relative_to(site).parts[0] in skipped:
            continue
        for link, line in list(read(path).links):
            count += 1
            name, _, fragment = link.partition("#")
            target = (path.parent / unquote(name.partition("?")[0])).resolve() if name else path
            where = f"{path.relative_to(site)}:{line}: link {link}: "
            if target.is_dir():
                target = target / "index.html"
            if site.resolve() not in target.parents:
                wrong.append(where + "leads out of the site")
            elif not target.exists():
                wrong.append(where + f"found no file {target.relative_to(site.resolve())}")
            elif fragment and is_page(target, site, skipped) and unquote(fragment) not in read(target).ids | {"top"}:
                wrong.append(where + f"found no heading or element with the id {fragment} in {target.relative_to(site.resolve())}")
    return count, wrong


def is_page(path, site, skipped):
    return path.suffix == ".html" and Path(path.relative_to(site.resolve())).parts[0] not in skipped
