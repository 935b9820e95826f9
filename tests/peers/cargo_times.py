#!/usr/bin/env python3
"""How long `cargo build --release` of a user's crate takes: a library with the macro and four functions of a robot, once the crates that it needs are
compiled, and those from nothing.

    python3 tests/peers/cargo_times.py                 all robots of the tables
    python3 tests/peers/cargo_times.py ur5 quadruped   these

Twice: as Cargo does by default, which compiles macros without optimisation, and with `[profile.release.build-override] opt-level = 3`.
"""

import os
import shutil
import subprocess
import sys
import time

import robots
from environment import REPOSITORY

PLACE = REPOSITORY / "target" / "peers" / "cargo"
WAYS = {"default": "", "optimised macro": "\n[profile.release.build-override]\nopt-level = 3\n"}
TIMES = 3  # of which the least counts
FUNCTIONS = ["inverse_dynamics", "mass_matrix", "forward_dynamics", "inverse_dynamics_derivatives"]


def crate(name, way, source):
    folder = PLACE / name
    (folder / "src").mkdir(parents=True, exist_ok=True)
    (folder / "Cargo.toml").write_text(
        f'[package]\nname = "{name.replace("_", "-")}-user"\nversion = "0.1.0"\nedition = "2024"\n\n[workspace]\n\n[dependencies]\n'
        f'articulated = {{ path = "{REPOSITORY / "runtime"}" }}\n{WAYS[way]}')
    # the versions that the repository is tested with
    shutil.copyfile(REPOSITORY / "Cargo.lock", folder / "Cargo.lock")
    (folder / "src" / "lib.rs").write_text(source)
    return folder


def build(folder, way):
    """Wall-clock seconds."""
    target = PLACE / f"target {way}"
    # flags of the environment are not those of a user
    environment = {key: value for key, value in os.environ.items() if not key.startswith(("CARGO_", "RUSTFLAGS"))}
    environment |= {"CARGO_TARGET_DIR": str(target), "PATH": os.environ["PATH"]}
    start = time.perf_counter()
    subprocess.check_call(["cargo", "build", "--quiet", "--release"], cwd=folder, env=environment)
    return time.perf_counter() - start


def measured(names, functions=FUNCTIONS):
    """Seconds: of all that a crate needs, from nothing, and of the crate of each robot."""
    out = {}
    for way in WAYS:
        shutil.rmtree(PLACE / f"target {way}", ignore_errors=True)
        print(f"cargo, {way} …", file=sys.stderr, flush=True)
        out[way] = {"from nothing": round(build(crate("nothing", way, ""), way), 2), "crates": {}}
        for name in names:
            robot = robots.ALL[name]
            base = "\n        base = floating," if robot.floating else ""
            source = (f'articulated::robot! {{\n    pub mod robot {{\n        urdf = "robot.urdf",{base}\n        functions = [{", ".join(functions)}],\n    }}\n}}\n')
            folder = crate(name, way, source)
            shutil.copyfile(robot.urdf, folder / "robot.urdf")
            times = []
            for turn in range(TIMES):
                (folder / "src" / "lib.rs").write_text(f"{source}// {turn} of {way}\n")
                times.append(build(folder, way))
            out[way]["crates"][name] = round(min(times), 3)
    return out


def main():
    names = sys.argv[1:] or list(robots.ALL)
    unknown = [name for name in names if name not in robots.ALL]
    if unknown:
        raise SystemExit(f"no such robots: {', '.join(unknown)}; expected some of {', '.join(robots.ALL)}")
    for way, times in measured(names).items():
        print(f"{way}: all that is needed, from nothing, {times['from nothing']:.1f} s")
        for name, seconds in times["crates"].items():
            print(f"  {robots.ALL[name].title}: {seconds:.2f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
