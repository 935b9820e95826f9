"""A peer's library: built when something that it is made of has changed, with what that cost kept beside it."""

import hashlib
import json
import os
import subprocess
import time
from pathlib import Path


def is_current(peer, parts):
    """Whether the library was built of these texts; else what its stamp will be."""
    library, made_of = Path(peer["path"]), hashlib.sha256()
    for part in parts:
        made_of.update(part.encode())
    stamp = library.with_suffix(".stamp")
    return library.exists() and stamp.exists() and stamp.read_text() == made_of.hexdigest(), made_of.hexdigest()


def build(peer, parts, make, engine):
    """Has `make(file)` build the library and say what it cost, unless that is known and nothing has changed. The entry of the manifest."""
    library, (current, stamp) = Path(peer["path"]), is_current(peer, parts)
    kept, fresh = library.with_suffix(".cost.json"), library.with_suffix(".new")
    if current and kept.exists():
        print(f"{peer['name']}: up to date")
    else:
        print(f"{peer['name']}: building", flush=True)
        cost = make(fresh)
        os.replace(fresh, library)  # whoever has the old one open keeps it
        kept.write_text(json.dumps(cost))
        library.with_suffix(".stamp").write_text(stamp)
    cost = json.loads(kept.read_text()) if kept.exists() else {}
    return {**peer, "engine": engine, "text_bytes": text_bytes(library), **cost}


def run(*words, **options):
    """Wall-clock seconds that a command took."""
    start = time.perf_counter()
    subprocess.check_call([str(word) for word in words], **options)
    return time.perf_counter() - start


def text_bytes(file):
    """Machine code in an object file or a library."""
    listed = subprocess.run(["size", "-A", file], capture_output=True, text=True, check=True).stdout
    rows = [line.split() for line in listed.splitlines() if line.startswith(".text")]
    return sum(int(row[1]) for row in rows)


def exports(folder):
    """A linker's script: only peer_* is visible, so that peers in one process never share a symbol."""
    script = folder / "exports.map"
    script.write_text("{ global: peer_*; local: *; };\n")
    return f"-Wl,--version-script={script}"
