"""C code by CasADi of the textbook's recursions in casadi_code.py."""

import time
from importlib import metadata

from environment import HERE

NAME, FOLDER = "casadi", "casadi_code"


def engine():
    return f"CasADi {metadata.version('casadi')}"


def sources():
    return [HERE / "casadi_code.py", HERE / "casadi_textbook.py", HERE.parent / "oracles" / "engines" / "tree.py"]


def prepare(out):
    """Nothing has to be built."""


def generate(folder, name, floating, urdf, most):
    """A C file for each function. The robot, and what each function took. Derivatives of a humanoid are 290 000 operations, which takes minutes to see."""
    import casadi
    from casadi_code import Robot

    start = time.perf_counter()
    robot, functions = Robot(urdf, floating), {}
    for function, (arguments, outputs) in robot.functions().items():
        if function.endswith("derivatives") and robot.nv > 30:
            continue
        symbol = f"{name}_{function}"
        code = casadi.Function(symbol, arguments, [casadi.densify(x) for x in outputs()], {"cse": True})
        if operations(code) > most:
            continue
        file = casadi.CodeGenerator(f"{symbol}_code.c")
        file.add(code)
        file.generate(f"{folder}/")
        # The first function pays for reading the robot, and each for what it is the first to need.
        now = time.perf_counter()
        functions[function] = {"work": code.sz_w(), "operations": operations(code), "generation_seconds": now - start}
        start = now
    return {"nq": robot.nq, "nv": robot.nv, "joints": robot.joints, "functions": functions}


def operations(code):
    """How many there are, without reading arguments, writing results and constants."""
    import casadi

    plain = {casadi.OP_INPUT, casadi.OP_OUTPUT, casadi.OP_CONST}
    return sum(code.instruction_id(k) not in plain for k in range(code.n_instructions()))
