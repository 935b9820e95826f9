"""Puts MuJoCo's library, as it is in its wheel, behind the C interface of a peer."""

import importlib.util
import json
from importlib import metadata
from pathlib import Path

import library
from environment import HERE, NATIVE, machine


def wheel():
    """(headers, library)."""
    folder = Path(importlib.util.find_spec("mujoco").origin).parent
    (shared,) = folder.glob("libmujoco.so*")
    return folder / "include", shared


def plan(found, out, flags=NATIVE):
    """The wheel is compiled; one compiler does for what is around it."""
    command, version, _ = found[0]
    return [{
        "name": "mujoco_wheel", "path": str(out / "libmujoco_wheel.so"), "flags": "as its makers compiled the wheel",
        "mujoco": metadata.version("mujoco"), "around": f"{command} {version} {' '.join(flags)}",
    }]


def build(peer, out):
    parts = [(HERE / "mujoco_peer.cpp").read_text(), json.dumps(peer), str(wheel()[1]), machine()]
    return library.build(peer, parts, lambda file: make(peer, out, file), f"MuJoCo {peer['mujoco']}")


def make(peer, out, file):
    (include, shared), (compiler, _, *flags) = wheel(), peer["around"].split()
    library.run(
        compiler, "-std=c++17", *flags, "-shared", "-fPIC", "-fvisibility=hidden", f'-DPEER_NAME="MuJoCo {peer["mujoco"]}, as in its wheel"',
        "-isystem", include, HERE / "mujoco_peer.cpp", shared, f"-Wl,-rpath,{shared.parent}", "-o", file, library.exports(out), "-Wl,--no-undefined",
    )
    return {"text_bytes": library.text_bytes(wheel()[1])}
