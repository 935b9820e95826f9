"""The gallery of robots: a page with a search, a page for each file, and a list of all files."""

import hashlib
import html
import json
import re
from pathlib import Path

import verdicts

from pages import relative, write

# The kinds of verdicts in the filter, with their meaning.
KINDS = {
    "equal": "all numbers are those of the other program",
    "in part": "equal, but a part of the file is left out, or a base is not compared",
    "differs": "a number differs",
    "refused": "the file is an error here, and the other program reads it",
    "not compared": "the other program does not read the file, or there is nothing to compare",
}
OTHERS = {"shipped": "Pinocchio", "mjcf": "MuJoCo", "sdf": "Drake"}
SHOWN = {"inverse_dynamics": "inverse dynamics", "forward_dynamics": "forward dynamics"}


def kind(verdict):
    """The kind of a recorded verdict."""
    if verdict == "equal":
        return "equal"
    starts = [("equal", "in part"), ("differs", "differs"), ("refused by", "not compared"), ("refused", "refused")]
    return next((found for start, found in starts if verdict.startswith(start)), "not compared")


def name_of(robot):
    """The name of the file, or of the folder around a file with a common name."""
    path = Path(robot.file)
    common = {"model", "robot", "scene", "urdf", "description"}
    return f"{path.parent.name}/{path.stem}" if path.stem.lower() in common and path.parent.name else path.stem


def slug(robot):
    """The name of the page of a file: letters, digits and lines, and a mark that no other file has.
    """
    words = re.sub(r"[^a-z0-9]+", "-", f"{robot.package.partition('==')[0]}-{name_of(robot)}".lower()).strip("-")
    return f"{words}-{hashlib.sha256(f'{robot.format} {robot.package} {robot.file}'.encode()).hexdigest()[:6]}"


class Gallery:
    """`rows`: robots with their facts; `times`: docs/site/times.json; `licences`:
    docs/site/data/packages.json.
    """

    def __init__(self, pages, rows, recorded_files, times, licences):
        self.pages, self.rows, self.recorded, self.licences = pages, rows, recorded_files, licences
        self.times, self.timed_on = times.get("times", {}), times.get("processor")
        self.site = pages.site / "gallery"
        self.found = {corpus: verdicts.read(corpus) for corpus in verdicts.CORPORA}

    def build(self):
        entries = []
        for robot, facts in self.rows:
            entry = self.entry(robot, facts)
            entries.append(entry)
            if "picture" in facts:
                write(self.site / "pictures" / f"{entry['page']}.svg", facts["picture"])
            write(self.site / f"{entry['page']}.html", self.robot(robot, facts, entry))
        entries.sort(key=lambda one: (not one["nv"], one["name"].lower(), one["package"], one["file"]))
        write(self.site / "robots.json", json.dumps({"robots": entries}, ensure_ascii=False, indent=0) + "\n")
        write(self.site / "index.html", self.search(entries))
        write(self.site / "all.html", self.all(entries))

    def entry(self, robot, facts):
        """What the search has of a file."""
        one = self.verdict(robot)
        steps = self.found["contact"].get(robot.package, {}).get("files", {}).get(robot.file, {}) if robot.corpus == "mjcf" else {}
        timed = self.times.get(robot.package, {}).get(robot.file, {})
        operations = {name: counts[0] + counts[1] for name, counts in facts.get("operations", {}).items()}
        return {
            "name": name_of(robot), "package": robot.package, "file": robot.file, "format": robot.format, "robot": facts.get("robot", ""),
            "nv": facts.get("nv"), "links": facts.get("links"), "operations": [operations.get(name) for name in SHOWN],
            "ns": [timed.get(name) for name in SHOWN], "kind": kind(one["verdict"]), "verdict": self.words(robot, one),
            "steps": self.steps(steps), "warnings": len(facts["warnings"]), "picture": "picture" in facts, "page": slug(robot),
        }

    def verdict(self, robot):
        return self.found[robot.corpus][robot.package]["files"][robot.file]

    def words(self, robot, one):
        """The verdict as a sentence of the gallery."""
        text, other = one["verdict"], OTHERS[robot.corpus]
        if text == "equal":
            return f"equal to {other}"
        if text == "no moving mass":
            return "no joint of the file moves a mass"
        return text + (f"; `{one['option']}` reads it" if one.get("option") else "")

    @staticmethod
    def steps(found):
        """The verdict about steps with constraints, or an empty text."""
        if not found:
            return ""
        return found["verdict"].removesuffix(" without") + (f"; left out on both sides: {found['without']}" if found["without"] else "")

    def search(self, entries):
        """The page with the search."""
        compact = json.dumps(entries, ensure_ascii=False, separators=(",", ":")).replace("</", "<\\/")
        formats = "".join(f'<option>{name}</option>' for name in sorted({one["format"] for one in entries}))
        kinds = "".join(f'<option value="{name}">{name}: {meaning}</option>' for name, meaning in KINDS.items() if any(one["kind"] == name for one in entries))
        missing = self.recorded - len(entries)
        part = f" This build shows {len(entries)} of {self.recorded} recorded files." if missing else ""
        body = f"""<h1>Robots: is mine there?</h1>
<p>Robot files of Python packages, as this project reads them, compared with Pinocchio (URDF), MuJoCo (MJCF) and Drake (SDF).{part}
Yours is not there? <code>articulated check FILE</code> says whether it is read, and what is not used.</p>
<form id="search" role="search">
<input id="words" type="search" placeholder="name, package or path" aria-label="name, package or path" autocomplete="off">
<select id="format" aria-label="format"><option value="">all formats</option>{formats}</select>
<select id="kind" aria-label="verdict"><option value="">all verdicts</option>{kinds}</select>
<select id="order" aria-label="order"><option value="name">by name</option><option value="nv">by freedoms</option><option value="operations">by operations</option></select>
<label><input id="still" type="checkbox"> also files without freedoms</label>
</form>
<p id="count" aria-live="polite"></p>
<div id="robots" class="cards"></div>
<p><button id="more" hidden>Show more</button></p>
<noscript><p>The search needs JavaScript. <a href="all.html">All files in one list.</a></p></noscript>
<p class="small"><a href="all.html">All files in one list.</a> The same for programs: <a href="robots.json">robots.json</a>.
Operations are multiplications and additions of the generated code of inverse and of forward dynamics. Times are those of one
call{html.escape(f", the median on one core of {self.timed_on}" if self.timed_on else "")}. “–” means: not measured, or not defined. Pictures are drawn by this project, at the start of the motion.</p>
<script type="application/json" id="data">{compact}</script>
<script src="../gallery.js"></script>"""
        return self.pages.page("gallery/index.html", "Robots", body)

    def all(self, entries):
        """All files in one list, without a script."""
        out = ["<h1>All files</h1>", '<p><a href="index.html">The search, with pictures.</a></p>']
        for package in sorted({one["package"] for one in entries}):
            out += [f"<h2>{html.escape(package)}</h2>", '<div class="table" tabindex="0"><table><thead><tr><th>file</th><th>format</th><th>freedoms</th><th>verdict</th></tr></thead><tbody>']
            for one in sorted((one for one in entries if one["package"] == package), key=lambda one: one["file"]):
                out.append(f'<tr><td><a href="{one["page"]}.html">{html.escape(one["file"])}</a></td><td>{one["format"]}</td><td class="number">{dash(one["nv"])}</td>'
                           f'<td>{code(one["verdict"])}</td></tr>')
            out.append("</tbody></table></div>")
        return self.pages.page("gallery/all.html", "All robot files", "\n".join(out))

    def robot(self, robot, facts, entry):
        """The page of a file."""
        place = Path("gallery") / f"{entry['page']}.html"
        licence = self.licences[robot.package]
        options = " ".join(facts["options"])
        out = [f'<p><a href="index.html">Robots</a></p><h1>{html.escape(entry["name"])}</h1>']
        if entry["picture"]:
            out.append(f'<img class="large" src="pictures/{entry["page"]}.svg" alt="{html.escape(entry["name"])} at the start of its motion" width="640" height="480">')
        home = f' (<a href="{html.escape(licence["home"])}">home</a>)' if licence["home"] else ""
        stated = html.escape(licence["licence"]) if licence["licence"] else "none stated in its metadata"
        rows = [("package", f"{html.escape(robot.package)}{home}"), ("file", f"<code>{html.escape(robot.file)}</code>"), ("format", robot.format),
                ("licence of the package", f"{stated}; a robot in it may have another one. The picture is this project's own.")]
        if facts["usable"]:
            rows += [("robot", html.escape(facts["robot"])), ("freedoms (nv), coordinates (nq)", f"{facts['nv']}, {facts['nq']}"), ("links, joints", f"{facts['links']}, {facts['joints']}"),
                     ("mass", f"{facts['mass']:.4g} kg")]
        for k, (name, words) in enumerate(SHOWN.items()):
            counts = facts.get("operations", {}).get(name)
            if counts:
                ns = f"; {entry['ns'][k]:.0f} ns" if entry["ns"][k] else ""
                rows.append((words, f"{counts[0]} multiplications and {counts[1]} additions in {counts[2]} instructions, {counts[3]} sines and cosines{ns}"))
        if facts.get("no_operations"):
            rows.append(("not generated", code("; ".join(facts["no_operations"]))))
        rest = entry["verdict"].removeprefix(entry["kind"]) if entry["verdict"].startswith(entry["kind"]) else f": {entry['verdict']}"
        rows.append((f"beside {OTHERS[robot.corpus]}", f'<strong class="{entry["kind"].replace(" ", "-")}">{entry["kind"]}</strong>{code(rest)}'))
        if entry["steps"]:
            rows.append((f'<a href="{relative(Path("docs/contact.html"), place)}">steps with constraints</a>', code(entry["steps"])))
        if options:
            rows.append(("read with", f"<code>{html.escape(options)}</code>"))
        if facts.get("no_picture"):
            rows.append(("no picture", code(facts["no_picture"])))
        out.append('<div class="table" tabindex="0"><table class="facts"><tbody>' + "".join(f"<tr><th>{name}</th><td>{value}</td></tr>" for name, value in rows) + "</tbody></table></div>")
        for title, messages in (("Errors", facts["errors"] if not facts["usable"] else []), ("Warnings", facts["warnings"])):
            if messages:
                out.append(f"<h2>{title}</h2><ul>" + "".join(f"<li>{code(with_line(message))}</li>" for message in messages) + "</ul>")
        if facts.get("unused"):
            out.append("<h2>In the file, and not used by rigid-body dynamics</h2><ul>")
            out += [f"<li>{code(text)}{f' ({count} times)' if count > 1 else ''}</li>" for text, count in facts["unused"]]
            out.append("</ul>")
        file = Path(robot.file).name
        lines = [f"articulated check {file} {options}".strip(), f"articulated compare {file} {options}".strip()]
        out.append(f'<h2>The same by the command</h2><pre class="code">{html.escape(chr(10).join(lines))}</pre>')
        return self.pages.page(place, entry["name"], "\n".join(out))


def dash(value):
    return "–" if value is None else value


def with_line(message):
    """A message that begins with the number of a line, as one that says so."""
    return re.sub(r"^(\d+)(?::\d+)?: ", r"line \1: ", message)


def code(text):
    """A text with its parts in backquotes as code."""
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", html.escape(text, quote=False))
