"""Builds Pinocchio's headers, behind the C interface of a peer."""

import json
from importlib import metadata
from pathlib import Path

import library
from environment import FAST, HERE, NATIVE, machine

# definitions of Pinocchio's own CMake target, without its PINOCCHIO_ENABLE_TEMPLATE_INSTANTIATION
DEFINITIONS = [
    "-DBOOST_MPL_LIMIT_LIST_SIZE=30", "-DBOOST_MPL_LIMIT_VECTOR_SIZE=30", "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS",
    "-DBOOST_FUSION_INVOKE_MAX_ARITY=12",
]


def headers():
    """The folder of the wheel's headers; Eigen's are in eigen3 below it."""
    (config,) = [file for file in metadata.files("libpinocchio") if str(file).endswith("include/pinocchio/config.hpp")]
    return Path(config.locate()).resolve().parent.parent


def plan(found, out):
    """One entry for each library. `found`: compilers of C++ (command, version, short name)."""
    return [entry(command, version, f"{short}_O3_native{suffix}", flags, out)
            for command, version, short in found for suffix, flags in [("", NATIVE), ("_fastmath", FAST)]]


def entry(command, version, suffix, flags, out):
    name = f"pinocchio_{suffix}"
    return {
        "name": name, "path": str(out / f"lib{name}.so"), "compiler": command, "version": version, "flags": " ".join(flags),
        "pinocchio": metadata.version("libpinocchio"), "eigen": metadata.version("cmeel-eigen"),
    }


def build(peer, out):
    sources = [file.read_text() for file in sorted(HERE.glob("pinocchio_*pp"))]
    parts = [*sources, json.dumps(peer), machine(), *DEFINITIONS]
    return library.build(peer, parts, lambda file: make(peer, out, file), f"Pinocchio {peer['pinocchio']}")


def make(peer, out, file):
    """Some minutes; g++ wants 6 GB of memory."""
    include, compiler, object_file = headers(), peer["compiler"], file.with_suffix(".o")
    title = f"Pinocchio {peer['pinocchio']}, {compiler} {peer['version']}, {peer['flags']}"
    took = library.run(
        compiler, "-std=c++17", "-w", "-fPIC", "-fvisibility=hidden", *DEFINITIONS, f'-DPEER_NAME="{title}"',
        "-isystem", include, "-isystem", include / "eigen3", *peer["flags"].split(), "-c", HERE / "pinocchio_peer.cpp", "-o", object_file,
    )
    # Linked without the flags: -ffast-math would add start-up code that switches off denormals for the whole process.
    took += library.run(compiler, "-shared", object_file, "-o", file, library.exports(out), "-Wl,--no-undefined")
    object_file.unlink()
    return {"compilation_seconds": took}
