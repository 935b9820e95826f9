"""Generates C with CasADi for some robots, one file a function, and builds peers of it."""

import json
import time
from importlib import metadata

import library
from environment import FAST, HERE, NATIVE, REPOSITORY, c_compiler, machine

MODELS = REPOSITORY / "models" / "urdf"
# robot, floating base, whether its derivatives are generated too (those of a humanoid are 290 000 operations)
ROBOTS = [("ur5_like", False, True), ("panda_like", False, True), ("quadruped", True, True), ("humanoid", True, False)]


def fnv(data):
    """FNV-1a of 64 bits."""
    value = 0xCBF29CE484222325
    for byte in data:
        value = (value ^ byte) * 0x100000001B3 & (1 << 64) - 1
    return value


def sources():
    files = [HERE / name for name in ("casadi_peer.cpp", "casadi_code.py", "casadi_build.py", "library.py")]
    files += [HERE.parent / "oracles" / "engines" / "tree.py", *(MODELS / f"{name}.urdf" for name, *_ in ROBOTS)]
    return [file.read_text() for file in files]


def generate(folder):
    """A C file for each function, the table of robots for casadi_peer.cpp, and what each took; kept until a source changes."""
    shared = {"name": "casadi_code", "path": str(folder / "robots.json"), "casadi": metadata.version("casadi")}
    current, stamp = library.is_current(shared, [*sources(), json.dumps(shared)])
    if not current:
        print("casadi_code: generating", flush=True)
        made = [generate_robot(folder, *robot) for robot in ROBOTS]
        write_table(folder, made)
        (folder / "robots.json").write_text(json.dumps(made))
        (folder / "robots.stamp").write_text(stamp)
    return json.loads((folder / "robots.json").read_text())


def generate_robot(folder, name, floating, derivatives):
    import casadi
    from casadi_code import Robot

    start = time.perf_counter()
    robot, functions = Robot(MODELS / f"{name}.urdf", floating), {}
    for function, (arguments, outputs) in robot.functions().items():
        if function.endswith("derivatives") and not derivatives:
            continue
        symbol = f"{name}_{function}"
        code = casadi.Function(symbol, arguments, [casadi.densify(x) for x in outputs()], {"cse": True})
        file = casadi.CodeGenerator(f"{symbol}_code.c")
        file.add(code)
        file.generate(f"{folder}/")
        # The first function pays for reading the robot, and each for what it is the first to need.
        now = time.perf_counter()
        functions[function] = {"work": code.sz_w(), "operations": operations(code), "generation_seconds": now - start}
        start = now
    hash = f"{fnv((MODELS / f'{name}.urdf').read_bytes()):#x}"
    return {"robot": name, "floating": floating, "hash": hash, "nq": robot.nq, "nv": robot.nv, "joints": robot.joints, "functions": functions}


def operations(code):
    """How many there are, without reading arguments, writing results and constants."""
    import casadi

    plain = {casadi.OP_INPUT, casadi.OP_OUTPUT, casadi.OP_CONST}
    return sum(code.instruction_id(k) not in plain for k in range(code.n_instructions()))


def write_table(folder, robots):
    declarations, table = [], []
    for robot in robots:
        name, entries = robot["robot"], []
        for function, what in robot["functions"].items():
            declarations.append(f'extern "C" int {name}_{function}(const double **, double **, long long *, double *, int);')
            entries.append(f'{{"{function}", {{{name}_{function}, {what["work"]}}}}}')
        joints = ", ".join(f'{{"{joint}", {iq}, {iv}, {nq}, {nv}}}' for joint, iq, iv, nq, nv in robot["joints"])
        numbers = f"{robot['hash']}u, {str(robot['floating']).lower()}, {robot['nq']}, {robot['nv']}"
        table.append(f"    {{{numbers}, {{{joints}}}, {{{', '.join(entries)}}}}},")
    lines = [*declarations, "", "namespace", "{", "const std::vector<Robot> & robots()", "{",
             "  static const std::vector<Robot> all = {", *table, "  };", "  return all;", "}", "}", ""]
    (folder / "casadi_robots.inc").write_text("\n".join(lines))


def plan(found, out):
    """`found`: (command of C++, version, short name). The C code is compiled as C."""
    return [entry(command, version, f"{short}_O3_native{suffix}", flags, out)
            for command, version, short in found for suffix, flags in [("", NATIVE), ("_fastmath", FAST)]]


def entry(command, version, suffix, flags, out):
    name = f"casadi_{suffix}"
    return {
        "name": name, "path": str(out / f"lib{name}.so"), "compiler": command, "c_compiler": c_compiler(command), "version": version,
        "flags": " ".join(flags), "casadi": metadata.version("casadi"),
    }


def build(peer, out):
    parts = [*sources(), json.dumps(peer), machine()]
    return library.build(peer, parts, lambda file: make(peer, out, file), f"CasADi {peer['casadi']}")


def make(peer, out, file):
    """The library, and of each function the seconds and the bytes of machine code."""
    code, objects = out / "casadi_code", out / f"{peer['name']}_objects"
    for folder in (code, objects):
        folder.mkdir(exist_ok=True)
    robots = generate(code)
    compiled = []
    for robot in robots:
        for function, what in robot["functions"].items():
            symbol = f"{robot['robot']}_{function}"
            compiled.append(objects / f"{symbol}.o")
            what["compilation_seconds"] = library.run(
                peer["c_compiler"], "-w", "-fPIC", "-fvisibility=hidden", *peer["flags"].split(), "-c", code / f"{symbol}_code.c", "-o", compiled[-1])
            what["code_bytes"] = library.text_bytes(compiled[-1])
            del what["work"]
    title = f"CasADi {peer['casadi']}, {peer['compiler']} {peer['version']}, {peer['flags']}"
    # Linked without -ffast-math, which would switch off denormals in the whole process.
    library.run(
        peer["compiler"], "-std=c++17", "-shared", "-fPIC", "-fvisibility=hidden", "-O3", "-DNDEBUG", f'-DPEER_NAME="{title}"', f"-I{code}",
        HERE / "casadi_peer.cpp", *compiled, "-o", file, library.exports(out))
    keys = ("robot", "floating", "hash", "functions")
    return {"robots": [{key: robot[key] for key in keys} for robot in robots]}
