"""The table of contents of the book, from SUMMARY.md as mdBook reads it."""

import re
from dataclasses import dataclass
from pathlib import Path

HEADING = re.compile(r"#+\s+(.+?)\s*$")
ENTRY = re.compile(r"(\s*)(?:[-*+]\s+)?\[(.+)\]\(([^()\s]*)\)\s*$")
RULE = re.compile(r"\s*(-{3,}|\*{3,}|_{3,})\s*$")


@dataclass(frozen=True)
class Part:
    """A heading between chapters."""

    title: str


@dataclass(frozen=True)
class Chapter:
    """A chapter, its file and its page. `depth` counts the entries that contain it."""

    title: str
    file: Path
    page: str
    depth: int


def read(folder, problems):
    """Parts and chapters in their order. The page of the first chapter is index.html."""
    summary = folder / "SUMMARY.md"
    entries, pages, indents = [], {}, [0]
    for number, line in enumerate(summary.read_text(encoding="utf-8").splitlines(), 1):
        if not line.strip() or RULE.match(line):
            continue
        if heading := HEADING.match(line):
            # The first heading is the title of the list itself.
            if entries or heading[1] != "Summary":
                entries.append(Part(heading[1]))
            continue
        entry = ENTRY.match(line)
        if not entry:
            problems.add(summary, number, f"found {line.strip()!r}, expected `# Part`, `- [Title](file.md)` or `[Title](file.md)`")
            continue
        indent, title, target = len(entry[1].expandtabs(4)), entry[2], entry[3].removeprefix("./")
        while len(indents) > 1 and indent < indents[-1]:
            indents.pop()
        if indent > indents[-1]:
            indents.append(indent)
        file = folder / target
        if not target.endswith(".md") or not file.is_file():
            problems.add(summary, number, f"found the target {target!r}, expected the Markdown file of a chapter in {folder.name}")
        elif target in pages:
            problems.add(summary, number, f"{target} is listed already, in line {pages[target]}")
        else:
            page = "index.html" if not pages else target.removesuffix(".md") + ".html"
            pages[target] = number
            entries.append(Chapter(title, file, page, len(indents) - 1))
    if not pages:
        problems.add(summary, 1, "found no chapter, expected `- [Title](file.md)`")
    return entries
