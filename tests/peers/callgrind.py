"""Instructions per call of each peer and of our own code, counted by valgrind's callgrind: no matter how busy the machine is.

Valgrind knows AVX2 and FMA but not AVX-512, so everything is built for x86-64-v3 here; MuJoCo's library is as in its wheel. Now and then it does not know
another instruction that a compiler chose (3.19: vmovq between registers in one of its two encodings, as in dynibo's forward dynamics).
"""

import os
import re
import shlex
import shutil
import subprocess
from pathlib import Path

import casadi_build
import environment
import mujoco_build
import pinocchio_build
import rust_build
from environment import HERE, REPOSITORY

CPU = "x86-64-v3"
FLAGS = ["-O3", f"-march={CPU}", "-DNDEBUG"]
STATES = 64  # bench_peer's
FUNCTIONS = ("inverse_dynamics", "mass_matrix", "forward_dynamics", "inverse_dynamics_derivatives", "forward_dynamics_derivatives")
ARGUMENTS = {"mass_matrix": ("q",), "inverse_dynamics": ("q", "v", "a"), "inverse_dynamics_derivatives": ("q", "v", "a")}
KEPT = ("inverse_dynamics_derivatives", "forward_dynamics_derivatives")

HEAD = """
#[allow(dead_code)]
#[path = "robot.rs"]
mod robot;

use std::ffi::{c_char as C, c_int as I, c_void as H};
static mut KEPT: [f64; 1 << 16] = [0.0; 1 << 16];
unsafe fn read<'a, T>(x: *const f64) -> &'a T { unsafe { &*x.cast() } }
unsafe fn write<T>(out: *mut f64, result: T) { unsafe { out.cast::<T>().write_unaligned(result) } }
#[unsafe(no_mangle)] pub extern "C" fn peer_name() -> *const C { c"ours".as_ptr() }
#[unsafe(no_mangle)] pub extern "C" fn peer_open(_: *const C, _: I, _: f64, _: f64, _: f64) -> *mut H { 8 as *mut H }
#[unsafe(no_mangle)] pub extern "C" fn peer_close(_: *mut H) {}
#[unsafe(no_mangle)] pub extern "C" fn peer_nq(_: *mut H) -> I { robot::NQ as I }
#[unsafe(no_mangle)] pub extern "C" fn peer_nv(_: *mut H) -> I { robot::NV as I }
"""


def wrapper(function):
    """Our function behind the interface of a peer."""
    arguments = ARGUMENTS.get(function, ("q", "v", "tau"))
    takes = ", ".join(f"{x}: *const f64" for x in arguments)
    kept = function in KEPT
    # Unread results would not be computed.
    out = "std::hint::black_box(&raw mut KEPT).cast()" if kept else "out"
    given = ", ".join(f"read({x})" for x in arguments)
    return (f'#[unsafe(no_mangle)] pub unsafe extern "C" fn peer_{function}(_: *mut H, {takes}{"" if kept else ", out: *mut f64"}) {{ '
            f"unsafe {{ write({out}, robot::{function}({given})) }} }}\n")


def ours(urdf, base, out):
    """(name, library) of our code for one robot: for x86-64-v3 and for any x86-64. ARTICULATED names the command if it is not to be built."""
    folder = out / f"ours_{Path(urdf).stem}_{base}"
    folder.mkdir(parents=True, exist_ok=True)
    command = shlex.split(os.environ.get("ARTICULATED", "cargo run --quiet --release -p articulated-cli --"))
    generate = [*command, "generate", Path(urdf).resolve(), f"--{base}", "--functions", ",".join(FUNCTIONS), "-o", folder / "robot.rs"]
    subprocess.check_call(generate, cwd=REPOSITORY, stderr=subprocess.DEVNULL)
    (folder / "peer.rs").write_text(HEAD + "".join(map(wrapper, FUNCTIONS)))
    for name, flags in (("ours", ["-C", f"target-cpu={CPU}"]), ("ours, any x86-64", [])):
        library = folder / f"lib{'v3' if flags else 'any'}.so"
        subprocess.check_call(["rustc", "--edition", "2024", "--crate-type", "cdylib", "--crate-name", "peer", "-C", "opt-level=3", "-C",
                               "codegen-units=1", *flags, "-o", library, folder / "peer.rs"])
        yield name, library


def theirs(out):
    """(name, library) of each peer: one build of Pinocchio, by clang++ if it is there, which is the faster one."""
    found = list(environment.compilers())
    clang = next((c for c in found if c[0] == "clang++"), found[0])
    entries = [(pinocchio_build, pinocchio_build.entry(clang[0], clang[1], f"{clang[2]}_v3", FLAGS, out))]
    entries += [(casadi_build, casadi_build.entry(generator, *c[:2], f"{c[2]}_v3", FLAGS, out)) for generator in casadi_build.GENERATORS for c in found]
    entries += [(mujoco_build, mujoco_build.plan(found, out, FLAGS)[0])]
    entries += [(rust_build, peer) for peer in rust_build.plan(out, CPU)]
    return [(module.build(peer, out)["name"], peer["path"]) for module, peer in entries]


def count(program, library, urdf, base, folder):
    """Instructions per call of each function, with some ten of the loop around it: "–" where the peer does not have it, "?" where valgrind fails."""
    for old in folder.glob("count.out*"):
        old.unlink()
    words = ["valgrind", "--tool=callgrind", "--instr-atstart=no", f"--callgrind-out-file={folder / 'count.out'}", program, library, urdf, base]
    ended = subprocess.run([str(word) for word in (*words, *FUNCTIONS)], capture_output=True, text=True)
    counts = {}
    for dump in folder.glob("count.out.*"):
        text = dump.read_text()
        name, total = re.search(r"^desc: Trigger: Client Request: (\w+)", text, re.MULTILINE), re.search(r"^(?:summary|totals): (\d+)", text, re.MULTILINE)
        if name and total:
            counts[name.group(1)] = str(round(int(total.group(1)) / STATES))
    return [counts.get(function, "?" if ended.returncode else "–") for function in FUNCTIONS]


def table(robots, out):
    if not shutil.which("valgrind"):
        raise SystemExit("valgrind is not on the PATH: apt-get install valgrind (Debian's has the headers that bench_peer needs to count)")
    folder = out / "callgrind"
    folder.mkdir(parents=True, exist_ok=True)
    program = folder / "bench_peer"
    subprocess.check_call(["g++", "-O2", HERE / "bench_peer.cpp", "-o", program, "-ldl"])
    peers = theirs(folder)
    for robot in robots:
        urdf, _, base = robot.partition(":")
        base = base or "fixed"
        print(f"\n{Path(urdf).stem}, {base} base: instructions per call, all built for {CPU}")
        print(f"{'':34}" + "".join(f"{function.replace('dynamics', 'dyn.').replace('derivatives', 'der.'):>24}" for function in FUNCTIONS))
        for name, library in [*ours(urdf, base, folder), *peers]:
            counts = count(program, library, urdf, base, folder)
            print(f"{name:34}" + "".join(f"{n:>24}" for n in counts), flush=True)
