"""C code by CasADi of Pinocchio's algorithms: its templates on casadi::SX, in the program casadi_pinocchio.cpp."""

import importlib.util
import json
import subprocess
from importlib import metadata
from pathlib import Path

import environment
import library
import pinocchio_build
from environment import HERE

NAME, FOLDER = "casadi_pinocchio", "casadi_pinocchio_code"
FLAGS = ["-std=c++17", "-w", "-O1", "-DNDEBUG"]  # what takes the time is in CasADi's own library


def engine():
    return f"Pinocchio {metadata.version('libpinocchio')} by CasADi {metadata.version('casadi')}"


def sources():
    return [HERE / "casadi_pinocchio.cpp", HERE / "pinocchio_model.hpp", HERE / "casadi_templates.py"]


def program(out):
    """What its entry in a manifest would be, if it were a library."""
    found = list(environment.compilers())
    command, version, _ = next((c for c in found if c[0] == "clang++"), found[0])
    return {
        "name": NAME, "path": str(out / NAME), "compiler": command, "version": version, "flags": " ".join(FLAGS),
        "casadi": metadata.version("casadi"), "pinocchio": metadata.version("libpinocchio"), "eigen": metadata.version("cmeel-eigen"),
    }


def prepare(out):
    """Builds the program, once for all robots: some minutes."""
    entry = program(out)
    return library.build(entry, [*(file.read_text() for file in sources()[:2]), json.dumps(entry)], lambda file: make(entry, file), engine())


def make(entry, file):
    include, casadi = pinocchio_build.headers(), Path(importlib.util.find_spec("casadi").origin).parent
    took = library.run(
        entry["compiler"], *FLAGS, *pinocchio_build.DEFINITIONS, "-isystem", include, "-isystem", include / "eigen3", "-isystem", casadi / "include",
        HERE / "casadi_pinocchio.cpp", casadi / "libcasadi.so", f"-Wl,-rpath,{casadi}", "-o", file)
    return {"compilation_seconds": took}


def takes(robot):
    """All of them."""
    return True


def generate(folder, robot, wanted, most):
    """A C file for each function, or for those that are wanted. The robot, and what each function took."""
    words = [folder.parent / NAME, folder, robot.name, robot.urdf, robot.base, most, *wanted]
    return json.loads(subprocess.run([str(word) for word in words], capture_output=True, text=True, check=True).stdout)
