"""Generates C with CasADi for some robots, one file a function, and builds peers of it: of the textbook's recursions, and of Pinocchio's templates."""

import json
from importlib import metadata

import casadi_templates
import casadi_textbook
import library
from environment import FAST, HERE, NATIVE, REPOSITORY, c_compiler, machine

MODELS = REPOSITORY / "models" / "urdf"
# robot, floating base
ROBOTS = [("ur5_like", False), ("panda_like", False), ("quadruped", True), ("humanoid", True)]
GENERATORS = (casadi_textbook, casadi_templates)
MOST = 60_000  # operations of a function: the compilers' time grows with more than their number


def fnv(data):
    """FNV-1a of 64 bits."""
    value = 0xCBF29CE484222325
    for byte in data:
        value = (value ^ byte) * 0x100000001B3 & (1 << 64) - 1
    return value


def sources(generator):
    files = [HERE / name for name in ("casadi_peer.cpp", "casadi_build.py", "library.py")]
    return [file.read_text() for file in [*files, *generator.sources(), *(MODELS / f"{name}.urdf" for name, _ in ROBOTS)]]


def generate(generator, out):
    """A C file for each function, the table of robots for casadi_peer.cpp, and what each took; kept until a source changes."""
    folder = out / generator.FOLDER
    folder.mkdir(exist_ok=True)
    shared = {"name": generator.FOLDER, "path": str(folder / "robots.json"), "engine": generator.engine()}
    current, stamp = library.is_current(shared, [*sources(generator), json.dumps(shared)])
    if not current:
        generator.prepare(out)
        print(f"{generator.FOLDER}: generating", flush=True)
        made = [generate_robot(generator, folder, *robot) for robot in ROBOTS]
        write_table(folder, made)
        (folder / "robots.json").write_text(json.dumps(made))
        (folder / "robots.stamp").write_text(stamp)
    return folder, json.loads((folder / "robots.json").read_text())


def generate_robot(generator, folder, name, floating):
    urdf = MODELS / f"{name}.urdf"
    made = generator.generate(folder, name, floating, urdf, MOST)
    return {"robot": name, "floating": floating, "hash": f"{fnv(urdf.read_bytes()):#x}", **made}


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
    return [entry(generator, command, version, f"{short}_O3_native{suffix}", flags, out)
            for generator in GENERATORS for command, version, short in found for suffix, flags in [("", NATIVE), ("_fastmath", FAST)]]


def entry(generator, command, version, suffix, flags, out):
    name = f"{generator.NAME}_{suffix}"
    return {
        "name": name, "path": str(out / f"lib{name}.so"), "compiler": command, "c_compiler": c_compiler(command), "version": version,
        "flags": " ".join(flags), "casadi": metadata.version("casadi"), "generator": generator.NAME,
    }


def build(peer, out):
    (generator,) = [g for g in GENERATORS if g.NAME == peer["generator"]]
    parts = [*sources(generator), json.dumps(peer), machine()]
    return library.build(peer, parts, lambda file: make(generator, peer, out, file), generator.engine())


def make(generator, peer, out, file):
    """The library, and of each function the seconds and the bytes of machine code."""
    objects = out / f"{peer['name']}_objects"
    objects.mkdir(exist_ok=True)
    code, robots = generate(generator, out)
    compiled = []
    for robot in robots:
        for function, what in robot["functions"].items():
            symbol = f"{robot['robot']}_{function}"
            compiled.append(objects / f"{symbol}.o")
            what["compilation_seconds"] = library.run(
                peer["c_compiler"], "-w", "-fPIC", "-fvisibility=hidden", *peer["flags"].split(), "-c", code / f"{symbol}_code.c", "-o", compiled[-1])
            what["code_bytes"] = library.text_bytes(compiled[-1])
            del what["work"]
    title = f"{generator.engine()}, {peer['compiler']} {peer['version']}, {peer['flags']}"
    # Linked without -ffast-math, which would switch off denormals in the whole process.
    library.run(
        peer["compiler"], "-std=c++17", "-shared", "-fPIC", "-fvisibility=hidden", "-O3", "-DNDEBUG", f'-DPEER_NAME="{title}"', f"-I{code}",
        HERE / "casadi_peer.cpp", *compiled, "-o", file, library.exports(out))
    keys = ("robot", "floating", "hash", "functions")
    return {"robots": [{key: robot[key] for key in keys} for robot in robots]}
