"""Generates C with CasADi for some robots, one file a function, and builds peers of it: of the textbook's recursions, and of Pinocchio's templates."""

import json
import threading
from importlib import metadata

import casadi_templates
import casadi_textbook
import library
import robots
from environment import FAST, HERE, NATIVE, c_compiler, machine

GENERATORS = (casadi_textbook, casadi_templates)
GENERATING = threading.Lock()
MOST = 60_000  # operations of a function: the compilers' time grows with more than their number


def fnv(data):
    """FNV-1a of 64 bits."""
    value = 0xCBF29CE484222325
    for byte in data:
        value = (value ^ byte) * 0x100000001B3 & (1 << 64) - 1
    return value


TABLES = ("inverse_dynamics", "mass_matrix", "forward_dynamics", "inverse_dynamics_derivatives")  # of real robots no others are made
# Results that stay inside until they are requested, in CasADi's form: without the zeros, and the
# upper triangle of symmetric matrices.
KEPT = ("mass_matrix", "mass_matrix_inverse", "inverse_dynamics_derivatives", "forward_dynamics_derivatives", "center_of_mass_jacobian",
        "centroidal_momentum_matrix")
TURNED = ("center_of_mass_jacobian", "centroidal_momentum_matrix")  # its columns are rows
IN_LANES = ("inverse_dynamics", "forward_dynamics")
LANES = 8  # casadi_lanes.hpp's
# name -> what engines are called by it, and the files that are read before CasADi's code
SINE, VECTORS = "sine", "lanes"
VARIANTS = {"": ("", []), SINE: (", inlined sine", ["casadi_sine.h"]), VECTORS: (f", {LANES} states in vectors", ["casadi_lanes.hpp"])}


def robots_of(generator):
    """Those that the generator is run for."""
    return [robot for robot in robots.ALL.values() if not robot.file or generator.takes(robot)]


def sources(generator):
    files = [HERE / name for name in ("casadi_peer.cpp", "casadi_build.py", "library.py", "robots.py")]
    return [file.read_text() for file in [*files, *generator.sources(), *(robot.urdf for robot in robots_of(generator))]]


def generate(generator, out):
    """Once, however many builds ask for it at a time."""
    with GENERATING:
        return generated(generator, out)


def generated(generator, out):
    """A C file for each function, and what each took; kept until a source changes."""
    folder = out / generator.FOLDER
    folder.mkdir(exist_ok=True)
    shared = {"name": generator.FOLDER, "path": str(folder / "robots.json"), "engine": generator.engine()}
    current, stamp = library.is_current(shared, [*sources(generator), json.dumps(shared)])
    if not current:
        generator.prepare(out)
        print(f"{generator.FOLDER}: generating", flush=True)
        made = [generate_robot(generator, folder, robot) for robot in robots_of(generator)]
        (folder / "robots.json").write_text(json.dumps(made))
        (folder / "robots.stamp").write_text(stamp)
    return folder, json.loads((folder / "robots.json").read_text())


def generate_robot(generator, folder, robot):
    made = generator.generate(folder, robot, TABLES if robot.file else (), MOST)
    return {"robot": robot.name, "floating": robot.floating, "hash": f"{fnv(robot.urdf.read_bytes()):#x}", **made}


def write_table(folder, made):
    """casadi_peer.cpp's table of robots."""
    declarations, table = [], []
    for robot in made:
        name, entries = robot["robot"], []
        for function, what in robot["functions"].items():
            declarations.append(f'extern "C" void {name}_{function}_entry(void);')
            outputs = ", ".join(written(function, robot["nv"], what["outputs"])) if function in KEPT else ""
            entries.append(f'{{"{function}", {{reinterpret_cast<const void *>({name}_{function}_entry), {what["work"]}, {{{outputs}}}}}}}')
        joints = ", ".join(f'{{"{joint}", {iq}, {iv}, {nq}, {nv}}}' for joint, iq, iv, nq, nv in robot["joints"])
        numbers = f"{robot['hash']}u, {str(robot['floating']).lower()}, {robot['nq']}, {robot['nv']}"
        table.append(f"    {{{numbers}, {{{joints}}}, {{{', '.join(entries)}}}}},")
    lines = [*declarations, "", "namespace", "{", "const std::vector<Robot> & robots()", "{",
             "  static const std::vector<Robot> all = {", *table, "  };", "  return all;", "}", "}", ""]
    (folder / "casadi_robots.inc").write_text("\n".join(lines))


def written(function, nv, outputs):
    """The outputs of a function as casadi_peer.cpp has them. `outputs`: rows, columns, and those of each number."""
    base = 0
    for k, (rows, columns, at) in enumerate(outputs):
        places = [j * rows + i if function in TURNED else i * columns + j for i, j in at]
        symmetric = function not in TURNED and k == len(outputs) - 1
        assert not symmetric or (rows == columns == nv and all(i <= j for i, j in at)), function
        yield f"{{{base}, {str(symmetric).lower()}, {{{', '.join(map(str, places))}}}}}"
        base += rows * columns


def plan(found, out):
    """`found`: (command of C++, version, short name). Code of one state is compiled as C."""
    builds = [("", "", NATIVE), ("_fastmath", "", FAST), ("_fastmath_sine", SINE, FAST)]
    one = [entry(generator, command, version, f"{short}_O3_native{suffix}", flags, out, variant)
           for generator in GENERATORS for command, version, short in found for suffix, variant, flags in builds]
    return one + [entry(casadi_templates, command, version, f"{short}_O3_native_fastmath_lanes", FAST, out, VECTORS) for command, version, short in found]


def entry(generator, command, version, suffix, flags, out, variant=""):
    name = f"{generator.NAME}_{suffix}"
    return {
        "name": name, "path": str(out / f"lib{name}.so"), "compiler": command, "c_compiler": c_compiler(command), "version": version,
        "flags": " ".join(flags), "casadi": metadata.version("casadi"), "generator": generator.NAME, "variant": variant,
        **({"lanes": LANES} if variant == VECTORS else {}),
    }


def engine(generator, peer):
    return generator.engine() + VARIANTS[peer["variant"]][0]


def build(peer, out):
    (generator,) = [g for g in GENERATORS if g.NAME == peer["generator"]]
    read_first = [(HERE / name).read_text() for name in VARIANTS[peer["variant"]][1]]
    parts = [*sources(generator), *read_first, json.dumps(peer), machine()]
    return library.build(peer, parts, lambda file: make(generator, peer, out, file), engine(generator, peer))


def wrapped(peer, code, symbol, function, takes):
    """The text of an entry: CasADi's code, and a function of the interface that it is inlined into."""
    numbers = "lanes::Real" if peer["variant"] == VECTORS else "double"
    first = "".join(f'#include "{HERE / name}"\n' for name in VARIANTS[peer["variant"]][1])
    kept = function in KEPT
    names = [f"x{k}" for k in range(takes)]
    parameters = "".join(f", const double *{x}" for x in names) + ("" if kept else ", double *out")
    known = "".join(f"  if (!{x}) __builtin_unreachable();\n" for x in ["r0", "r1", "r2"])
    arguments = ", ".join(f"(const {numbers} *){x}" for x in names)
    results = "".join(f"  {numbers} *r{k} = ({numbers} *){f'head->results[{k}]' if kept else 'out'};\n" for k in range(3))
    # All of CasADi's functions, so that the compiler inlines each: g++ does not inline squares.
    kinds = [("int", (f"{symbol}_code_f0", symbol), f"const {numbers} **, {numbers} **, long long *, {numbers} *, int"),
             (numbers, (f"{symbol}_code_sq", f"{symbol}_code_fabs"), numbers)]
    inlined = "".join(f"static inline __attribute__((always_inline)) {gives} {name}({parts});\n" for gives, each, parts in kinds for name in each)
    return f"""#define CASADI_SYMBOL_EXPORT static
{first}#ifdef __cplusplus
extern "C" {{
#endif
{inlined}#ifdef __cplusplus
}}
#endif
#include "{code / f'{symbol}_code.c'}"
struct head {{ double *results[3]; double *work; }};
#ifdef __cplusplus
extern "C"
#endif
__attribute__((nonnull)) void {symbol}_entry(struct head *head{parameters})
{{
{results}{known}  const {numbers} *arguments[] = {{{arguments}}};
  {numbers} *results[] = {{r0, r1, r2}};
  {symbol}(arguments, results, 0, ({numbers} *)head->work, 0);
}}
"""


def make(generator, peer, out, file):
    """The library, and of each function the seconds and the bytes of machine code."""
    objects = out / f"{peer['name']}_objects"
    objects.mkdir(exist_ok=True)
    code, made = generate(generator, out)
    in_lanes = peer["variant"] == VECTORS
    compiler = [peer["compiler"], "-std=c++17"] if in_lanes else [peer["c_compiler"]]
    compiled = []
    for robot in made:
        robot["functions"] = {f: what for f, what in robot["functions"].items() if not in_lanes or f in IN_LANES}
        for function, what in robot["functions"].items():
            symbol = f"{robot['robot']}_{function}"
            source = objects / f"{symbol}.{'cpp' if in_lanes else 'c'}"
            source.write_text(wrapped(peer, code, symbol, function, what["takes"]))
            compiled.append(objects / f"{symbol}.o")
            what["compilation_seconds"] = library.run(
                *compiler, "-w", "-fPIC", "-fvisibility=hidden", *peer["flags"].split(), "-c", source, "-o", compiled[-1])
            what["code_bytes"] = library.text_bytes(compiled[-1])
    write_table(objects, made)
    title = f"{engine(generator, peer)}, {peer['compiler']} {peer['version']}, {peer['flags']}"
    # Linked without -ffast-math, which would switch off denormals in the whole process.
    library.run(
        peer["compiler"], "-std=c++17", "-w", "-shared", "-fPIC", "-fvisibility=hidden", "-O1", "-DNDEBUG", f'-DPEER_NAME="{title}"', f"-I{objects}",
        HERE / "casadi_peer.cpp", *compiled, "-o", file, library.exports(out))
    cost = ("operations", "generation_seconds", "compilation_seconds", "code_bytes")
    return {"robots": [{**{key: robot[key] for key in ("robot", "floating", "hash")},
                        "functions": {f: {key: what[key] for key in cost} for f, what in robot["functions"].items()}} for robot in made]}
