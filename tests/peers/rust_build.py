"""Builds crates of Rust behind the C interface of a peer: the workspace in rust/, which the repository's own does not know."""

import json
import os
import re
import shutil
import subprocess
import time

import library
from environment import HERE, machine

CRATES = {"dynibo": {}, "featherstone": {"element": "f32"}}
FOLDER = HERE / "rust"


def version(crate):
    """The one that is locked."""
    return re.search(rf'name = "{crate}"\nversion = "([^"]+)"', (FOLDER / "Cargo.lock").read_text()).group(1)


def plan(out, cpu="native"):
    if not shutil.which("cargo"):
        print("cargo is not on the PATH: crates of Rust are left out")
        return []
    rustc = subprocess.run(["rustc", "--version"], capture_output=True, text=True, check=True).stdout.split()[1]
    return [{
        "name": f"{crate}_rustc_O3_{cpu}", "path": str(out / f"lib{crate}_rustc_O3_{cpu}.so"), "compiler": "rustc", "version": rustc,
        "flags": f"-O3 -C target-cpu={cpu}, fat lto", crate: version(crate), **more,
    } for crate, more in CRATES.items()]


def build(peer, out):
    (crate,) = [crate for crate in CRATES if crate in peer]
    sources = [*(FOLDER / "interface").rglob("*.rs"), *(FOLDER / crate).rglob("*.rs"), FOLDER / "Cargo.toml", FOLDER / "Cargo.lock"]
    parts = [*(file.read_text() for file in sources), json.dumps(peer), machine()]
    return library.build(peer, parts, lambda file: make(crate, peer, out, file), f"{crate} {peer[crate]}")


def make(crate, peer, out, file):
    target = out / "rust"
    environment = {**os.environ, "RUSTFLAGS": re.search(r"-C target-cpu=[^,]+", peer["flags"]).group(), "CARGO_TARGET_DIR": str(target)}
    start = time.perf_counter()
    subprocess.check_call(["cargo", "build", "--quiet", "--release", "--locked", "-p", f"peer-{crate}"], cwd=FOLDER, env=environment)
    took = time.perf_counter() - start
    shutil.copyfile(target / "release" / f"libpeer_{crate}.so", file)
    return {"compilation_seconds": took}
