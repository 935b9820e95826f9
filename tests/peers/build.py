#!/usr/bin/env python3
"""Builds Pinocchio, and C code by CasADi, behind the C interface of a peer, with each compiler and each set of flags.

    python3 tests/peers/build.py                     build what is missing or out of date, write target/peers/peers.json
    python3 tests/peers/build.py --install-clang     the same, after apt-get install of the newest clang (Debian, as root)
    python3 tests/peers/build.py --check [FILE...]   compare every function of every peer with tests/fixtures, and with *.ref.json files
    python3 tests/peers/build.py --bench FILE[:floating]...   nanoseconds per call for the robots of these URDFs

Makes a virtual environment with Pinocchio's wheel, Eigen's headers and CasADi in <repository>/.venv where they are missing.
"""

import argparse
import ctypes
import hashlib
import json
import os
import platform
import re
import shutil
import subprocess
import sys
from importlib import metadata
from pathlib import Path

import against_fixtures
import casadi_build

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parent.parent
OUT = REPOSITORY / "target" / "peers"
MANIFEST = OUT / "peers.json"
PACKAGES = ["pin", "cmeel-eigen", "casadi", "numpy"]  # the wheel brings Pinocchio's and Boost's headers, but not Eigen's

NATIVE = ["-O3", "-march=native", "-DNDEBUG"]
FAST = [*NATIVE, "-ffast-math"]  # with the newest clang only: g++ gains nothing by it
CLANGS = [f"clang++-{n}" for n in range(30, 14, -1)]
# what Pinocchio's own CMake target asks for, without its PINOCCHIO_ENABLE_TEMPLATE_INSTANTIATION
DEFINITIONS = [
    "-DBOOST_MPL_LIMIT_LIST_SIZE=30", "-DBOOST_MPL_LIMIT_VECTOR_SIZE=30", "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS",
    "-DBOOST_FUSION_INVOKE_MAX_ARITY=12",
]
TOLERANCE = 1e-12
REFUSED = 3  # bench_peer's status where the peer does not read the robot
LOOSE = 1e-11  # Pinocchio's inverse of the golfer's mass matrix is off by 1e-12 of its largest entry


def missing_packages():
    def absent(package):
        try:
            metadata.version(package)
        except metadata.PackageNotFoundError:
            return True

    return [package for package in PACKAGES if absent(package)]


def ensure_packages():
    """Runs this script again inside <repository>/.venv, made on the way, unless all packages are at hand."""
    missing = missing_packages()
    if not missing:
        return
    environment = REPOSITORY / ".venv"
    python = environment / "bin" / "python"
    if Path(sys.prefix) == environment:
        subprocess.check_call([python, "-m", "pip", "install", "--quiet", *missing])
    elif not python.exists():
        subprocess.check_call([sys.executable, "-m", "venv", environment])
    os.execv(python, [str(python), *sys.argv])


def install_clang():
    subprocess.check_call(["apt-get", "update", "-qq"])
    listed = subprocess.run(["apt-cache", "search", "--names-only", "^clang-[0-9]+$"], capture_output=True, text=True, check=True).stdout
    newest = max((int(n) for n in re.findall(r"^clang-(\d+)", listed, re.MULTILINE)), default=None)
    subprocess.check_call(["apt-get", "install", "-y", "-qq", f"clang-{newest}" if newest else "clang"])


def headers():
    """The folder of the wheel's headers; Eigen's are in eigen3 below it."""
    (config,) = [file for file in metadata.files("libpinocchio") if str(file).endswith("include/pinocchio/config.hpp")]
    return Path(config.locate()).resolve().parent.parent


def compiler_version(compiler):
    text = subprocess.run([compiler, "--version"], capture_output=True, text=True, check=True).stdout
    return re.search(r"\d+\.\d+\.\d+", text).group()


def machine():
    """-march=native means this."""
    try:
        text = Path("/proc/cpuinfo").read_text()
        return "".join(re.findall(r"^(?:model name|flags).*", text, re.MULTILINE)[:2])
    except OSError:
        return platform.processor()


def compilers():
    """(command, version, short name): g++, the system's clang++, the newest clang++."""
    newest = [command for command in CLANGS if shutil.which(command)][:1]
    for command in ["g++", "clang++", *newest]:
        if not shutil.which(command):
            print(f"{command} is not on the PATH: left out")
            continue
        version = compiler_version(command)
        yield command, version, ("gcc" if command == "g++" else "clang") + version.split(".")[0]


def plan(found):
    """One entry for each library of Pinocchio, as it will stand in the manifest."""
    peers = []
    for command, version, short in found:
        fast = [("_fastmath", FAST)] if command == found[-1][0] and command != "g++" else []
        for suffix, flags in [("", NATIVE), *fast]:
            name = f"pinocchio_{short}_O3_native{suffix}"
            peers.append({
                "name": name, "path": str(OUT / f"lib{name}.so"), "compiler": command, "version": version,
                "flags": " ".join(flags), "pinocchio": metadata.version("libpinocchio"),
                "eigen": metadata.version("cmeel-eigen"),
            })
    return peers


def build(peer):
    """Compiles and links one library unless nothing that it is made of has changed."""
    source, library = HERE / "pinocchio_peer.cpp", Path(peer["path"])
    stamp, made_of = library.with_suffix(".stamp"), hashlib.sha256()
    sources = [file.read_text() for file in sorted(HERE.glob("pinocchio_*"))]
    for part in (*sources, json.dumps(peer), machine(), *DEFINITIONS):
        made_of.update(part.encode())
    if library.exists() and stamp.exists() and stamp.read_text() == made_of.hexdigest():
        print(f"{peer['name']}: up to date")
        return
    print(f"{peer['name']}: compiling, some minutes", flush=True)
    include, compiler, object_file = headers(), peer["compiler"], library.with_suffix(".o")
    title = f"Pinocchio {peer['pinocchio']}, {compiler} {peer['version']}, {peer['flags']}"
    subprocess.check_call([
        compiler, "-std=c++17", "-w", "-fPIC", "-fvisibility=hidden", *DEFINITIONS, f'-DPEER_NAME="{title}"',
        "-isystem", include, "-isystem", include / "eigen3", *peer["flags"].split(), "-c", source, "-o", object_file,
    ])
    # Linked without the flags: -ffast-math would add start-up code that switches off denormals for the whole process.
    # Only peer_* is visible, so that peers in one process never share a template's instance.
    exports = OUT / "exports.map"
    exports.write_text("{ global: peer_*; local: *; };\n")
    subprocess.check_call(
        [compiler, "-shared", object_file, "-o", library, f"-Wl,--version-script={exports}", "-Wl,--no-undefined"])
    object_file.unlink()
    stamp.write_text(made_of.hexdigest())


class Peer:
    """A peer library with one robot open."""

    def __init__(self, path, urdf, floating, gravity):
        self.library = ctypes.CDLL(path)
        self.library.peer_open.restype = ctypes.c_void_p
        self.library.peer_open.argtypes = [ctypes.c_char_p, ctypes.c_int, *[ctypes.c_double] * 3]
        self.library.peer_joint_name.restype = ctypes.c_char_p
        self.library.peer_name.restype = ctypes.c_char_p
        self.handle = ctypes.c_void_p(self.library.peer_open(str(urdf).encode(), int(floating), *gravity))
        if not self.handle:
            raise ValueError(f"{urdf} was refused")
        self.nq, self.nv = self.number("nq"), self.number("nv")

    def number(self, what, *index):
        return getattr(self.library, f"peer_{what}")(self.handle, *index)

    def joints(self):
        """(name, iq, iv, nq, nv) of every joint."""
        return [
            (self.library.peer_joint_name(self.handle, i).decode(),
             *[self.number(f"joint_{what}", i) for what in ("iq", "iv", "nq", "nv")])
            for i in range(self.number("joint_count"))
        ]

    def call(self, function, size, *vectors):
        arrays = [(ctypes.c_double * len(vector))(*vector) for vector in vectors]
        out = (ctypes.c_double * size)()
        getattr(self.library, f"peer_{function}")(self.handle, *arrays, out)
        return list(out)

    def has(self, function):
        told = getattr(self.library, "peer_has", None)
        return hasattr(self.library, f"peer_{function}") and (told is None or bool(told(self.handle, function.encode())))

    def frames(self):
        if not hasattr(self.library, "peer_frame_name"):
            return []
        self.library.peer_frame_name.restype = ctypes.c_char_p
        return [self.library.peer_frame_name(self.handle, i).decode() for i in range(self.number("frame_count"))]

    def choose(self, frames):
        """Has functions of frames give these links only."""
        if not hasattr(self.library, "peer_choose_frames"):
            return False
        names = (ctypes.c_char_p * len(frames))(*[name.encode() for name in frames])
        return bool(self.library.peer_choose_frames(self.handle, len(frames), names))

    def kept(self, function, size, *vectors):
        """A result that the peer keeps until it is asked for it."""
        arrays = [(ctypes.c_double * len(vector))(*vector) for vector in vectors]
        out = (ctypes.c_double * size)()
        getattr(self.library, f"peer_{function}")(self.handle, *arrays)
        if not self.library.peer_read(self.handle, function.encode(), out):
            raise ValueError(f"{function} is not told")
        return list(out)

    def close(self):
        self.library.peer_close(self.handle)


def against(library, path):
    """The largest error of inverse and forward dynamics and the mass matrix, relative to the file's scales."""
    reference = json.loads(path.read_text())
    worst = [0.0, 0.0, 0.0]
    for state in reference["states"]:
        if state["wrenches"]:
            continue
        floating = reference["base"] == "floating"
        peer = Peer(library, path.parent / reference["urdf"], floating, state["gravity"])
        known = {joint["joint"]: joint for joint in reference["joints"]}
        iq, iv = [0] * peer.nq, [0] * peer.nv  # where the peer's numbers stand in the file
        for name, q0, v0, nq, nv in peer.joints():
            iq[q0 : q0 + nq] = range(known[name]["q_index"], known[name]["q_index"] + nq)
            iv[v0 : v0 + nv] = range(known[name]["v_index"], known[name]["v_index"] + nv)
        q, v, a, tau = [state["q"][k] for k in iq], *[[state[key][k] for k in iv] for key in ("v", "a", "tau")]
        got = peer.call("inverse_dynamics", peer.nv, q, v, a)
        for k, x in zip(iv, got):
            worst[0] = max(worst[0], abs(x - state["inverse_dynamics"][k]) / state["torque_scale"][k])
        if state["forward_dynamics"]:
            for k, x in zip(iv, peer.call("forward_dynamics", peer.nv, q, v, tau)):
                worst[1] = max(worst[1], abs(x - state["forward_dynamics"][k]) / state["forward_dynamics_scale"][k])
        mass = state["mass_matrix"]
        rows = mass if isinstance(mass[0], list) else [mass[k * peer.nv : (k + 1) * peer.nv] for k in range(peer.nv)]
        got = peer.call("mass_matrix", peer.nv * peer.nv, q)
        for i, r in enumerate(iv):
            for j, c in enumerate(iv):
                size = (rows[r][r] * rows[c][c]) ** 0.5
                worst[2] = max(worst[2], abs(got[i * peer.nv + j] - rows[r][c]) / size)
        peer.close()
    return worst


def check(peers, files):
    agreed = True
    for peer in peers:
        worst = against_fixtures.errors(lambda urdf, floating, gravity: Peer(peer["path"], urdf, floating, gravity))
        bad = {name: error for name, error in worst.items() if not error <= LOOSE}
        agreed = agreed and not bad
        print(f"{peer['name']}: {len(worst)} functions against fixtures, largest error {max(worst.values()):.1e}", bad or "")
    for name in files:
        for peer in (peer for peer in peers if "pinocchio" in peer):
            worst = against(peer["path"], Path(name))
            agreed = agreed and max(worst[0], worst[2]) <= TOLERANCE and worst[1] <= 10 * TOLERANCE
            print(f"{Path(name).name} {peer['name']}: inverse dynamics {worst[0]:.1e}, "
                  f"forward dynamics {worst[1]:.1e}, mass matrix {worst[2]:.1e}")
    return agreed


def bench(peers, robots):
    program = OUT / "bench_peer"
    subprocess.check_call(["g++", "-O2", HERE / "bench_peer.cpp", "-o", program, "-ldl"])
    for robot in robots:
        urdf, _, base = robot.partition(":")
        print(f"{Path(urdf).stem}, {base or 'fixed'} base")
        for peer in peers:
            status = subprocess.run([program, peer["path"], urdf, base or "fixed"], stderr=subprocess.DEVNULL).returncode
            if status not in (0, REFUSED):
                raise SystemExit(f"{peer['name']}: the benchmark failed")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--install-clang", action="store_true", help="apt-get install the newest clang first")
    parser.add_argument("--check", nargs="*", metavar="FILE", help="*.ref.json files besides tests/fixtures; mimic joints must be free in them")
    parser.add_argument("--bench", nargs="+", metavar="URDF[:floating]")
    arguments = parser.parse_args()
    if arguments.install_clang:
        install_clang()
    ensure_packages()
    OUT.mkdir(parents=True, exist_ok=True)
    found = list(compilers())
    peers = plan(found)
    for peer in peers:
        build(peer)
    generated = casadi_build.plan(found, OUT)
    for peer in generated:
        casadi_build.build(peer, OUT, machine())
    peers += generated
    MANIFEST.write_text(json.dumps(peers, indent=2) + "\n")
    if arguments.check is not None and not check(peers, arguments.check):
        return 1
    if arguments.bench:
        bench(peers, arguments.bench)
    return 0


if __name__ == "__main__":
    sys.exit(main())
