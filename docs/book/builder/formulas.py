"""Typesets formulas by KaTeX when the book is built. A reader needs no script and no network."""

import json
import re
import shutil
import subprocess
from pathlib import Path

from .problems import Stop

HERE = Path(__file__).resolve().parent
LOCK = HERE.parent / "package-lock.json"
TIME = 120  # s, at most, for all formulas


def katex(tools, say):
    """The folder of KaTeX, which npm installs into the folder `tools` as package-lock.json says."""
    missing = [name for name in ("node", "npm") if not shutil.which(name)]
    if missing:
        raise Stop(f"found no {' and no '.join(missing)} on the PATH: KaTeX typesets the formulas of the book by Node.js; "
                   "install Node.js 18 or later with npm (Debian: apt-get install nodejs npm)")
    stamp, wanted = tools / "installed.json", LOCK.read_text(encoding="utf-8")
    if not stamp.exists() or stamp.read_text(encoding="utf-8") != wanted:
        say(f"installing KaTeX by npm into {tools}")
        tools.mkdir(parents=True, exist_ok=True)
        for file in [LOCK, LOCK.with_name("package.json")]:
            shutil.copy(file, tools)
        done = subprocess.run([shutil.which("npm"), "ci", "--ignore-scripts", "--no-audit", "--no-fund"], cwd=tools, capture_output=True, text=True)
        if done.returncode:
            raise Stop(f"`npm ci` in {tools} failed:\n{done.stderr.strip()}")
        stamp.write_text(wanted, encoding="utf-8")
    return tools / "node_modules" / "katex"


def typeset(katex, blocks, problems):
    """The HTML of each block (file, line of its fence, LaTeX), in order.

    A block with a mistake is added to `problems`, and has None.
    """
    done = subprocess.run([shutil.which("node"), HERE / "formulas.js", katex], input=json.dumps([tex for _, _, tex in blocks]),
                          capture_output=True, text=True, encoding="utf-8", timeout=TIME)
    if done.returncode:
        raise Stop(f"KaTeX failed:\n{done.stderr.strip()}")
    found = json.loads(done.stdout)
    for (file, line, tex), answer in zip(blocks, found, strict=True):
        if "error" in answer:
            before = min(answer["at"], len(tex.rstrip("\n")))
            problems.add(file, line + 1 + tex.count("\n", 0, before), f"formula: {answer['error']}")
    return [answer.get("html") for answer in found]


def copy_style(katex, folder):
    """Writes KaTeX's style sheet, and the fonts that it names, into a folder."""
    style = (katex / "dist" / "katex.min.css").read_text(encoding="utf-8")
    # Every browser of the last ten years reads WOFF2.
    style = re.sub(r',url\([^)]*\.(?:woff|ttf)\) format\("(?:woff|truetype)"\)', "", style)
    (folder / "fonts").mkdir(exist_ok=True)
    for name in sorted(set(re.findall(r"url\(fonts/([^)]+)\)", style))):
        shutil.copy(katex / "dist" / "fonts" / name, folder / "fonts" / name)
    (folder / "katex.css").write_text(style, encoding="utf-8")
