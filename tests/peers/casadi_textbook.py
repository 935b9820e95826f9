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


def takes(robot):
    """Of real robots arms only: of longer ones the templates' code is the faster one."""
    return not robot.floating


def generate(folder, robot, wanted, most):
    """A C file for each function, or for those that are wanted. The robot, and what each function took. Derivatives of a humanoid are 290 000 operations, which takes minutes to see."""
    import casadi
    from casadi_code import Robot

    start = time.perf_counter()
    read, functions = Robot(robot.urdf, robot.floating), {}
    for function, (arguments, outputs) in read.functions().items():
        if (function.endswith("derivatives") and read.nv > 30) or (wanted and function not in wanted):
            continue
        symbol = f"{robot.name}_{function}"
        code = casadi.Function(symbol, arguments, outputs(), {"cse": True})
        if operations(code) > most:
            continue
        file = casadi.CodeGenerator(f"{symbol}_code.c")
        file.add(code)
        file.generate(f"{folder}/")
        # The first function includes reading the robot, and each function the parts that it is the
        # first to need.
        now = time.perf_counter()
        functions[function] = {"work": code.sz_w(), "takes": len(arguments), "outputs": [pattern(code.sparsity_out(k)) for k in range(code.n_out())],
                               "operations": operations(code), "generation_seconds": now - start}
        start = now
    return {"nq": read.nq, "nv": read.nv, "joints": read.joints, "functions": functions}


def pattern(sparsity):
    """Rows, columns, and those of each number that is there."""
    return [*sparsity.shape, list(zip(*sparsity.get_triplet()))]


def operations(code):
    """How many there are, without reading arguments, writing results and constants."""
    import casadi

    plain = {casadi.OP_INPUT, casadi.OP_OUTPUT, casadi.OP_CONST}
    return sum(code.instruction_id(k) not in plain for k in range(code.n_instructions()))
