"""Evaluates a CasADi function with 60 decimal digits, so that rounding is known instead of guessed.

The graph of an SX function is a list of scalar instructions. CasADi runs it in double precision; here the same list is
walked with `decimal`. Two evaluations of one graph, one of them exact for every practical purpose: their difference
is the rounding error of the other.
"""

from decimal import Context, Decimal, localcontext

import casadi

DIGITS = 60
GUARD = 15


def precise(extra=0):
    """A context of DIGITS digits."""
    return localcontext(Context(prec=DIGITS + extra))


def sin_cos(x):
    """(sin x, cos x) of a Decimal by their Taylor series; meant for |x| up to some tens."""
    with precise(GUARD + max(0, x.adjusted()) * 15):
        square, terms = x * x, [Decimal(0), Decimal(0)]
        power, n, smallest = Decimal(1), 0, Decimal(10) ** -(DIGITS + GUARD)
        while n < 4 or abs(power) > smallest:
            # cos: 1, -x^2/2!, x^4/4!, ...; sin: x times 1, -x^2/3!, ...
            terms[1] += power
            terms[0] += power * x / (n + 1)
            power *= -square / ((n + 1) * (n + 2))
            n += 2
    with precise():
        return +terms[0], +terms[1]


UNARY = {
    casadi.OP_ASSIGN: lambda a: a,
    casadi.OP_NEG: lambda a: -a,
    casadi.OP_SQ: lambda a: a * a,
    casadi.OP_TWICE: lambda a: a + a,
    casadi.OP_INV: lambda a: 1 / a,
    casadi.OP_SQRT: lambda a: a.sqrt(),
}
BINARY = {
    casadi.OP_ADD: lambda a, b: a + b,
    casadi.OP_SUB: lambda a, b: a - b,
    casadi.OP_MUL: lambda a, b: a * b,
    casadi.OP_DIV: lambda a, b: a / b,
}


class Program:
    """The instructions of an SX function, ready to be run on Decimals."""

    def __init__(self, function):
        self.shapes = [function.sparsity_out(i) for i in range(function.n_out())]
        self.registers = function.sz_w()
        self.steps = []
        for k in range(function.n_instructions()):
            code, into, of = function.instruction_id(k), function.instruction_output(k), function.instruction_input(k)
            if code == casadi.OP_CONST:
                self.steps.append(("const", into[0], Decimal(function.instruction_constant(k)), None))
            elif code == casadi.OP_INPUT:
                self.steps.append(("input", into[0], of[0], of[1]))
            elif code == casadi.OP_OUTPUT:
                self.steps.append(("output", of[0], into[0], into[1]))
            elif code in (casadi.OP_SIN, casadi.OP_COS):
                self.steps.append(("turn", into[0], of[0], int(code == casadi.OP_COS)))
            elif code in UNARY:
                self.steps.append((UNARY[code], into[0], of[0], None))
            else:
                self.steps.append((BINARY[code], into[0], of[0], of[1]))

    def __call__(self, *inputs):
        """One flat list of Decimals per input (dense, by columns); the same for the outputs."""
        work, turns = [None] * self.registers, {}
        results = [[Decimal(0)] * shape.nnz() for shape in self.shapes]
        with precise():
            for step, x, y, z in self.steps:
                if step == "const":
                    work[x] = y
                elif step == "input":
                    work[x] = inputs[y][z]
                elif step == "output":
                    results[y][z] = work[x]
                elif step == "turn":
                    angle = work[y]
                    if angle not in turns:
                        turns[angle] = sin_cos(angle)
                    work[x] = turns[angle][z]
                elif z is None:
                    work[x] = step(work[y])
                else:
                    work[x] = step(work[y], work[z])
        return [spread(shape, values) for shape, values in zip(self.shapes, results)]


def spread(shape, values):
    """Nonzeros of a sparse matrix to a full one, by columns."""
    full = [Decimal(0)] * shape.numel()
    for (place, value) in zip(shape.find(), values):
        full[place] = value
    return full
