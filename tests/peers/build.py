#!/usr/bin/env python3
"""Builds other libraries of robot dynamics behind the C interface of a peer: Pinocchio, C code by CasADi, MuJoCo, and crates of Rust.

    python3 tests/peers/build.py --all               install what is missing (as root: compilers of Debian too), build, check against fixtures
    python3 tests/peers/build.py                     build what is missing or out of date, write target/peers/peers.json
    python3 tests/peers/build.py --install-clang     the same, after apt-get install of the newest clang (Debian, as root)
    python3 tests/peers/build.py --only WORD...      the same, of the peers whose names contain one of these words
    python3 tests/peers/build.py --jobs 2            two builds at a time; their times of compilation are those of a busy machine
    python3 tests/peers/build.py --again             build what is up to date too, for its times: on an idle machine
    python3 tests/peers/build.py --check [FILE...]   compare every function of every peer with tests/fixtures, and with *.ref.json files
    python3 tests/peers/build.py --bench FILE[:floating]...   nanoseconds per call for the robots of these URDFs
    python3 tests/peers/build.py --callgrind FILE[:floating]...   instructions per call, ours too, of builds without AVX-512

Makes a virtual environment with the wheels of pin, cmeel-eigen, casadi and mujoco in <repository>/.venv where they are missing.
"""

import argparse
import concurrent.futures
import json
import os
import subprocess
import sys
from pathlib import Path

import casadi_build
import mujoco_build
import environment
import peer as peers_module
import pinocchio_build
import rust_build
from environment import HERE, REPOSITORY

OUT = REPOSITORY / "target" / "peers"
MANIFEST = OUT / "peers.json"
REFUSED = 3  # bench_peer's status where the peer does not read the robot


def build(words, again, jobs):
    """Every peer, or those whose names contain one of the words, so many at a time; what else was built before stays in the manifest."""
    wanted = lambda peer: not words or any(word in peer["name"] for word in words)
    found = list(environment.compilers())
    if not found:
        raise SystemExit("neither g++ nor clang++ is on the PATH")
    plans = [(module, peer) for module in (pinocchio_build, casadi_build, mujoco_build) for peer in module.plan(found, OUT)]
    plans += [(rust_build, peer) for peer in rust_build.plan(OUT)]
    if again:
        code = (OUT / generator.FOLDER / "robots.stamp" for generator in casadi_build.GENERATORS)
        for stamp in (*code, *(Path(peer["path"]).with_suffix(".stamp") for _, peer in plans if wanted(peer))):
            stamp.unlink(missing_ok=True)
    before = {entry["name"]: entry for entry in json.loads(MANIFEST.read_text())} if MANIFEST.exists() else {}
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        built = [pool.submit(module.build, peer, OUT) if wanted(peer) else before.get(peer["name"]) for module, peer in plans]
        peers = [entry.result() if isinstance(entry, concurrent.futures.Future) else entry for entry in built if entry]
    MANIFEST.with_suffix(".new").write_text(json.dumps(peers, indent=2) + "\n")
    os.replace(MANIFEST.with_suffix(".new"), MANIFEST)
    return peers


def bench(peers, robots):
    program = OUT / "bench_peer"
    subprocess.check_call(["g++", "-O2", HERE / "bench_peer.cpp", "-o", program, "-ldl"])
    for robot in robots:
        urdf, _, base = robot.partition(":")
        print(f"{Path(urdf).stem}, {base or 'fixed'} base")
        for peer in (p for p in peers if not p.get("lanes")):
            status = subprocess.run([program, peer["path"], urdf, base or "fixed"], stderr=subprocess.DEVNULL).returncode
            if status not in (0, REFUSED):
                raise SystemExit(f"{peer['name']}: the benchmark failed")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--all", action="store_true", help="install compilers too where this is root, build all, and check")
    parser.add_argument("--install-clang", action="store_true", help="apt-get install the newest clang first")
    parser.add_argument("--only", nargs="+", metavar="WORD", help="peers whose names contain one of these")
    parser.add_argument("--again", action="store_true", help="build what is up to date too")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="so many builds at a time, each of up to 6 GB: not for times of compilation")
    parser.add_argument("--check", nargs="*", metavar="FILE", help="*.ref.json files besides tests/fixtures; mimic joints must be free in them")
    parser.add_argument("--bench", nargs="+", metavar="URDF[:floating]")
    parser.add_argument("--callgrind", nargs="+", metavar="URDF[:floating]")
    arguments = parser.parse_args()
    debian = arguments.all and os.geteuid() == 0
    if debian or arguments.install_clang:
        clang = environment.newest_clang()
        environment.install(*(["g++", "clang", "valgrind"] if debian else []), clang)
    environment.ensure_packages()
    OUT.mkdir(parents=True, exist_ok=True)
    if arguments.callgrind:
        import callgrind

        callgrind.table(arguments.callgrind, OUT)
        return 0
    peers = build(arguments.only, arguments.again, max(1, arguments.jobs))
    if (arguments.all or arguments.check is not None) and not peers_module.check(peers, arguments.check or []):
        return 1
    if arguments.bench:
        bench(peers, arguments.bench)
    return 0


if __name__ == "__main__":
    sys.exit(main())
