#!/usr/bin/env python3
"""Times of functions of many states: C and Rust that `articulated` generates, and C that CasADi generates, on one core and on all.

    python3 tests/peers/states.py [ROBOT…]          # by default the four bundled robots; prints a table in Markdown

Each engine is compiled for this machine: C by the first of gcc, clang and cc with -O3 -march=native, Rust by rustc with -C opt-level=3 and
-C target-cpu=native. States are arrays one after the other (*states*), or in blocks of 8 with each of their numbers side by side (*blocks*).
CasADi's code is called in a loop, state by state, within C. Threads of Python call each engine on its part of the states, without the
interpreter's lock. Engines take turns; the median of the rounds counts. Results are compared with those of Rust, but for CasADi on a floating
base, which has coordinates in another order (build.py --check compares those).

Needs `cargo build --release`, rustc, a C compiler, and the wheels `casadi` and `numpy` (`python3 tests/peers/build.py` installs them in .venv).
"""

import argparse
import ctypes
import os
import platform
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from environment import HERE

REPOSITORY = HERE.parent.parent
FUNCTIONS = ("inverse_dynamics", "forward_dynamics")
ROBOTS = {"ur5_like": False, "panda_like": False, "quadruped": True, "humanoid": True}
LANES = 8
# Seconds of a round of one engine.
ROUND, ROUNDS = 0.2, 9

RUST = """
#[unsafe(no_mangle)]
pub unsafe extern "C" fn {name}_states(count: usize, q: *const [f64; NQ], v: *const [f64; NV], a: *const [f64; NV], out: *mut [f64; NV]) {{
    let of = |p: *const [f64; NV]| unsafe {{ std::slice::from_raw_parts(p, count) }};
    let (q, out) = unsafe {{ (std::slice::from_raw_parts(q, count), std::slice::from_raw_parts_mut(out, count)) }};
    batch_f64::{name}(q, of(v), of(a), out).unwrap();
}}
#[unsafe(no_mangle)]
pub unsafe extern "C" fn {name}_blocks(count: usize, q: *const [batch_f64::Lanes; NQ], v: *const [batch_f64::Lanes; NV],
    a: *const [batch_f64::Lanes; NV], out: *mut [batch_f64::Lanes; NV]) {{
    let of = |p: *const [batch_f64::Lanes; NV]| unsafe {{ std::slice::from_raw_parts(p, count) }};
    let (q, out) = unsafe {{ (std::slice::from_raw_parts(q, count), std::slice::from_raw_parts_mut(out, count)) }};
    batch_f64::{name}_blocks(q, of(v), of(a), out).unwrap();
}}
"""

CASADI = """
void {name}_states(size_t count, const double *q, const double *v, const double *a, double *out) {{
    casadi_real w[{work} + 1]; casadi_int iw[{iwork} + 1];
    const casadi_real *arg[{args}]; casadi_real *res[{results}];
    for (size_t k = 0; k < count; ++k) {{
        arg[0] = q + {nq} * k; arg[1] = v + {nv} * k; arg[2] = a + {nv} * k; res[0] = out + {nv} * k;
        {function}(arg, res, iw, w, 0);
    }}
}}
"""


def run(words, **more):
    done = subprocess.run(words, capture_output=True, text=True, **more)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, words))}\n{done.stderr}")
    return done.stdout


def compiler():
    return next((found for found in map(shutil.which, ("gcc", "clang", "cc")) if found), None) or sys.exit("no C compiler: gcc, clang or cc")


def library(path):
    return ctypes.CDLL(str(path))


def ours_in_c(robot, folder, command):
    run([command, "generate", robot, "--language", "c", "--batch", "f64", "--functions", ",".join(FUNCTIONS), "-o", folder / "c"])
    out = folder / "c.so"
    run([compiler(), "-std=gnu99", "-O3", "-march=native", "-ffp-contract=fast", "-fno-math-errno", "-shared", "-fPIC", "-o", out, *(folder / "c").glob("*.c"), "-lm"])
    code = library(out)
    return {(f, layout): getattr(code, f"{robot}_{f}_{name}_f64") for f in FUNCTIONS for layout, name in (("states", "batch"), ("blocks", "blocks"))}


def ours_in_rust(robot, folder, command):
    source = folder / "rust.rs"
    text = run([command, "generate", robot, "--batch", "f64", "--functions", ",".join(FUNCTIONS)])
    source.write_text(text + "".join(RUST.format(name=f) for f in FUNCTIONS), encoding="utf-8")
    out = folder / "rust.so"
    run(["rustc", "--edition", "2024", "--crate-type", "cdylib", "-C", "opt-level=3", "-C", "target-cpu=native", "-A", "warnings", "-o", out, source])
    code = library(out)
    return {(f, layout): getattr(code, f"{f}_{layout}") for f in FUNCTIONS for layout in ("states", "blocks")}


def casadi_in_c(robot, folder):
    import casadi
    from casadi_code import Robot

    read, all_of_it = Robot(REPOSITORY / "models" / "urdf" / f"{robot}.urdf", ROBOTS[robot]), {}
    for name, (arguments, outputs) in read.functions().items():
        if name not in FUNCTIONS:
            continue
        code = casadi.Function(f"{robot}_{name}", arguments, outputs(), {"cse": True})
        generator = casadi.CodeGenerator(f"{name}.c", {"with_header": False})
        generator.add(code)
        generator.generate(f"{folder}/")
        source = folder / f"{name}.c"
        loop = CASADI.format(name=name, work=code.sz_w(), iwork=code.sz_iw(), args=code.sz_arg() + 1, results=code.sz_res() + 1, nq=read.nq, nv=read.nv, function=code.name())
        source.write_text("#include <stddef.h>\n" + source.read_text(encoding="utf-8") + loop, encoding="utf-8")
        out = folder / f"casadi_{name}.so"
        run([compiler(), "-O3", "-march=native", "-ffast-math", "-shared", "-fPIC", "-o", out, source, "-lm"])
        all_of_it[name, "states"] = getattr(library(out), f"{name}_states")
    return all_of_it


def states_of(numpy, robot, count, nq, nv):
    random = numpy.random.default_rng(1)
    q = random.uniform(-1, 1, (count, nq))
    if ROBOTS[robot]:
        q[:, 3:7] /= numpy.linalg.norm(q[:, 3:7], axis=1, keepdims=True)
    return q, random.uniform(-1, 1, (count, nv)), random.uniform(-1, 1, (count, nv))


def in_blocks(numpy, x):
    """Number k of state 8 b + i is number i of [b][k], in cache lines."""
    blocks = x.reshape(-1, LANES, x.shape[1]).transpose(0, 2, 1)
    room = numpy.empty(blocks.size + LANES)
    start = -(room.ctypes.data // 8) % LANES
    out = room[start : start + blocks.size].reshape(blocks.shape)
    out[:] = blocks
    return out


class Task:
    """One function of one engine on one layout, on parts of the states."""

    def __init__(self, numpy, function, arguments, threads):
        self.function, self.arguments = function, arguments
        count, own = len(arguments[0]), numpy.empty(arguments[1].size + LANES)
        start = -(own.ctypes.data // 8) % LANES
        self.out = own[start : start + arguments[1].size].reshape(arguments[1].shape)
        edges = [count * k // threads for k in range(threads + 1)]
        self.parts = []
        for a, b in zip(edges, edges[1:]):
            pointers = [ctypes.c_void_p(x[a:b].ctypes.data) for x in (*arguments, self.out)]
            self.parts.append((ctypes.c_size_t(b - a), *pointers))

    def once(self, pool):
        if pool:
            list(pool.map(lambda part: self.function(*part), self.parts))
        else:
            self.function(*self.parts[0])

    def seconds(self, pool, repeats):
        start = time.perf_counter()
        for _ in range(repeats):
            self.once(pool)
        return (time.perf_counter() - start) / repeats


def measure(numpy, robot, engines, count, nq, nv, threads):
    """ns per state of each function, engine and layout."""
    plain = states_of(numpy, robot, count, nq, nv)
    layouts = {"states": plain, "blocks": [in_blocks(numpy, x) for x in plain]}
    pool = ThreadPoolExecutor(threads) if threads > 1 else None
    found = {}
    for function in FUNCTIONS:
        tasks = {(engine, layout): Task(numpy, code, layouts[layout], threads) for engine, table in engines.items() for (f, layout), code in table.items() if f == function}
        right = None
        repeats, times = {}, {key: [] for key in tasks}
        for key, task in tasks.items():
            task.once(pool)
            repeats[key] = max(1, int(ROUND / len(tasks) / max(task.seconds(pool, 1), 1e-7)))
            result = task.out if key[1] == "states" else task.out.transpose(0, 2, 1).reshape(-1, nv)
            right = result.copy() if right is None else right
            worst = float(numpy.abs(result - right).max() / numpy.abs(right).max())
            # CasADi's code of a floating base has another order of coordinates: build.py --check compares it.
            if not worst < 1e-9 and not (ROBOTS[robot] and key[0] == "CasADi"):
                sys.exit(f"{robot}: {function}: {key} differs by {worst}")
        for _ in range(ROUNDS):
            for key, task in tasks.items():
                times[key].append(task.seconds(pool, repeats[key]))
        found[function] = {key: 1e9 * statistics.median(all_of_it) / count for key, all_of_it in times.items()}
    return found


def processor():
    names = [line.split(":", 1)[1].strip() for line in Path("/proc/cpuinfo").read_text().splitlines() if line.startswith("model name")] if Path("/proc/cpuinfo").exists() else []
    return names[0] if names else platform.processor()


def main():
    import numpy

    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("robots", nargs="*", default=list(ROBOTS), help="bundled robots")
    arguments.add_argument("--states", type=int, nargs="+", default=[1000, 1_000_000], help="multiples of 8")
    given = arguments.parse_args()
    if min(given.states) < LANES:
        arguments.error(f"--states: found {min(given.states)}, expected at least {LANES}")
    command, cores = REPOSITORY / "target" / "release" / "articulated", os.cpu_count() or 1
    columns = [("Rust", "blocks"), ("C", "blocks"), ("Rust", "states"), ("C", "states"), ("CasADi", "states")]
    titles = [f"{engine}, {layout}" if engine != "CasADi" else engine for engine, layout in columns]
    print(f"{processor()}, {cores} cores; {run([compiler(), '--version']).splitlines()[0]}; {run(['rustc', '--version']).strip()}\n")
    print(f"| ns per state | states | threads | {' | '.join(titles)} | CasADi / C, states | C / Rust, blocks |\n|---|--:|--:|{'--:|' * (len(titles) + 2)}")
    for robot in given.robots:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "casadi").mkdir()
            engines = {"Rust": ours_in_rust(robot, folder, command), "C": ours_in_c(robot, folder, command), "CasADi": casadi_in_c(robot, folder / "casadi")}
            shape = run([command, "generate", robot, "--functions", "inverse_dynamics"])
            nq, nv = (int(shape.split(f"pub const {size}: usize = ", 1)[1].split(";", 1)[0]) for size in ("NQ", "NV"))
            rows = {}
            for count in given.states:
                # Fewer states take less time than it takes to wake threads.
                for threads in sorted({1, cores if count >= 100_000 else 1}):
                    rows[count, threads] = measure(numpy, robot, engines, count // LANES * LANES, nq, nv, threads)
            for function in FUNCTIONS:
                for (count, threads), found in rows.items():
                    own = found[function]
                    over = own["CasADi", "states"] / own["C", "states"], own["C", "blocks"] / own["Rust", "blocks"]
                    print(f"| `{robot}`: `{function}` | {count} | {threads} | {' | '.join(f'{own[c]:.3g}' for c in columns)} | {over[0]:.1f} | {over[1]:.2f} |", flush=True)


if __name__ == "__main__":
    main()
