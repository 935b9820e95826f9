"""Generates C with CasADi for some robots and builds a peer of it."""

import hashlib
import json
import subprocess
from importlib import metadata
from pathlib import Path

HERE = Path(__file__).resolve().parent
MODELS = HERE.parent.parent / "models" / "urdf"
# robot, floating base, whether its derivatives are generated too (those of a humanoid are 290 000 operations)
ROBOTS = [("ur5_like", False, True), ("panda_like", False, True), ("quadruped", True, True), ("humanoid", True, False)]
FLAGS = ["-O3", "-march=native", "-DNDEBUG"]


def fnv(data):
    value = 0xCBF29CE484222325
    for byte in data:
        value = (value ^ byte) * 0x100000001B3 & (1 << 64) - 1
    return value


def generate(folder):
    """A C file for each robot, and the table of them."""
    import casadi
    from casadi_code import Robot

    declarations, table = [], []
    for name, floating, derivatives in ROBOTS:
        robot, file = Robot(MODELS / f"{name}.urdf", floating), casadi.CodeGenerator(f"{name}_casadi.c")
        entries = []
        for function, (arguments, outputs) in robot.functions().items():
            if function.endswith("derivatives") and not derivatives:
                continue
            code = casadi.Function(f"{name}_{function}", arguments, [casadi.densify(x) for x in outputs], {"cse": True})
            file.add(code)
            declarations.append(f'extern "C" int {name}_{function}(const double **, double **, long long *, double *, int);')
            entries.append(f'{{"{function}", {{{name}_{function}, {code.sz_w()}}}}}')
        file.generate(f"{folder}/")
        joints = ", ".join(f'{{"{joint}", {iq}, {iv}, {nq}, {nv}}}' for joint, iq, iv, nq, nv in robot.joints)
        hash = fnv((MODELS / f"{name}.urdf").read_bytes())
        numbers = f"{hash:#x}u, {str(floating).lower()}, {robot.nq}, {robot.nv}"
        table.append(f"    {{{numbers}, {{{joints}}}, {{{', '.join(entries)}}}}},")
    lines = [*declarations, "", "namespace", "{", "const std::vector<Robot> & robots()", "{",
             "  static const std::vector<Robot> all = {", *table, "  };", "  return all;", "}", "}", ""]
    (folder / "casadi_robots.inc").write_text("\n".join(lines))


def plan(compilers, out):
    """`compilers`: (command of C++, version, short name). The C code is compiled as C."""
    c_of = lambda command: command.replace("clang++", "clang").replace("g++", "gcc")
    return [{
        "name": f"casadi_{short}_O3_native", "path": str(out / f"libcasadi_{short}_O3_native.so"), "compiler": command, "c_compiler": c_of(command),
        "version": version, "flags": " ".join(FLAGS), "casadi": metadata.version("casadi"),
    } for command, version, short in compilers]


def build(peer, out, machine):
    library, made_of = Path(peer["path"]), hashlib.sha256()
    sources = [HERE / name for name in ("casadi_peer.cpp", "casadi_code.py", "casadi_build.py")]
    sources += [HERE.parent / "oracles" / "engines" / "tree.py", *(MODELS / f"{name}.urdf" for name, *_ in ROBOTS)]
    for part in (*[source.read_text() for source in sources], json.dumps(peer), machine):
        made_of.update(part.encode())
    stamp = library.with_suffix(".stamp")
    if library.exists() and stamp.exists() and stamp.read_text() == made_of.hexdigest():
        print(f"{peer['name']}: up to date")
        return
    print(f"{peer['name']}: generating and compiling, some minutes", flush=True)
    folder = out / f"{peer['name']}_code"
    folder.mkdir(exist_ok=True)
    generate(folder)
    objects = []
    for name, *_ in ROBOTS:
        objects.append(folder / f"{name}.o")
        source = folder / f"{name}_casadi.c"
        subprocess.check_call([peer["c_compiler"], "-w", "-fPIC", "-fvisibility=hidden", *FLAGS, "-c", source, "-o", objects[-1]])
    title = f"CasADi {peer['casadi']}, {peer['compiler']} {peer['version']}, {peer['flags']}"
    exports = out / "exports.map"
    exports.write_text("{ global: peer_*; local: *; };\n")
    subprocess.check_call([
        peer["compiler"], "-std=c++17", "-shared", "-fPIC", "-fvisibility=hidden", *FLAGS, f'-DPEER_NAME="{title}"', f"-I{folder}",
        HERE / "casadi_peer.cpp", *objects, "-o", library, f"-Wl,--version-script={exports}",
    ])
    stamp.write_text(made_of.hexdigest())
