"""Mistakes in the sources of the book: all are collected, and reported together."""


class Problems:
    """Mistakes of the author, each with its file and line."""

    def __init__(self, root):
        self.root, self.found = root, []

    def add(self, file, line, words):
        """One mistake in line `line` (from 1) of a file."""
        name = file.relative_to(self.root) if file.is_relative_to(self.root) else file
        self.found.append((str(name), line, words))

    def end(self):
        """Ends the program with status 1 if there are mistakes."""
        if self.found:
            rows = [f"{file}:{line}: {words}" for file, line, words in sorted(self.found)]
            raise Stop("\n".join(rows))


class Stop(Exception):
    """The reason why the build cannot go on, for the user."""


def listed(names):
    """Names in one sentence: "a, b, c"; of none "none"."""
    return ", ".join(sorted(names)) or "none"
