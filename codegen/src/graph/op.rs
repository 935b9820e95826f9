//! The operations of the graph: one row each.

/// An operation. `MulAdd` and its kin round once where the processor has the instruction, twice where it has not.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[repr(u8)]
pub enum Op {
    /// A number.
    Constant,
    /// An element of an argument.
    Input,
    /// a + b
    Add,
    /// a − b
    Sub,
    /// a · b
    Mul,
    /// a / b
    Div,
    /// −a
    Neg,
    /// √a
    Sqrt,
    /// sin a
    Sin,
    /// cos a
    Cos,
    /// the angle of the point (b, a)
    Atan2,
    /// a > 0, as 1 or 0
    Positive,
    /// b where a is 1, c where a is 0
    Select,
    /// a · b + c
    MulAdd,
    /// a · b − c
    MulSub,
    /// c − a · b
    NegMulAdd,
    /// −(a · b) − c
    NegMulSub,
    /// Numbers, one a lane
    LaneConstant,
    /// Elements of an argument, one a lane
    LaneInput,
    /// lane number b of a, in every lane
    Spread,
    /// the sum of a's lanes, in every lane
    Across,
}

/// What the generator knows of an operation.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// The operation; its place in [`OPS`] is its number.
    pub op: Op,
    /// Its column in tables of counts.
    pub name: &'static str,
    /// How many operands.
    pub arity: usize,
    /// Whether a and b may be exchanged.
    pub commutes: bool,
    /// Its value.
    pub value: fn(f64, f64, f64) -> f64,
    /// What it costs, in floating-point instructions.
    pub cost: u32,
    /// After how many cycles its value is known, on a current processor.
    pub latency: u32,
    /// How it is written in Rust, with {a}, {b}, {c} for the operands.
    pub rust: &'static str,
    /// The function that does it in all lanes of a vector, see [`articulated_core::lanes`].
    pub lanes: &'static str,
}

#[allow(clippy::too_many_arguments)]
// Why: a row of a table.
const fn row(
    op: Op,
    name: &'static str,
    arity: usize,
    value: fn(f64, f64, f64) -> f64,
    cost: u32,
    latency: u32,
    rust: &'static str,
    lanes: &'static str,
) -> Row {
    Row { op, name, arity, commutes: false, value, cost, latency, rust, lanes }
}

const fn commuting(row: Row) -> Row {
    Row { commutes: true, ..row }
}

/// All operations, in the order of [`Op`].
pub const OPS: [Row; 21] = [
    row(Op::Constant, "constants", 0, |_, _, _| f64::NAN, 0, 0, "", ""),
    row(Op::Input, "inputs", 0, |_, _, _| f64::NAN, 0, 0, "", ""),
    commuting(row(Op::Add, "add", 2, |a, b, _| a + b, 1, 4, "{a} + {b}", "add")),
    row(Op::Sub, "sub", 2, |a, b, _| a - b, 1, 4, "{a} - {b}", "sub"),
    commuting(row(Op::Mul, "mul", 2, |a, b, _| a * b, 1, 4, "{a} * {b}", "mul")),
    row(Op::Div, "div", 2, |a, b, _| a / b, 4, 13, "{a} / {b}", "div"),
    row(Op::Neg, "neg", 1, |a, _, _| -a, 1, 1, "-{a}", "neg"),
    row(Op::Sqrt, "sqrt", 1, |a, _, _| a.sqrt(), 4, 18, "{a}.sqrt()", "sqrt"),
    row(Op::Sin, "sin", 1, |a, _, _| a.sin(), 10, 60, "{a}.sin()", ""),
    row(Op::Cos, "cos", 1, |a, _, _| a.cos(), 10, 60, "{a}.cos()", ""),
    row(Op::Atan2, "atan2", 2, |a, b, _| a.atan2(b), 20, 80, "f64::atan2({a}, {b})", "atan2"),
    row(Op::Positive, "compare", 1, |a, _, _| if a > 0.0 { 1.0 } else { 0.0 }, 1, 3, "{a} > 0.0", "positive"),
    row(Op::Select, "select", 3, |a, b, c| if a == 1.0 { b } else { c }, 1, 2, "if {a} { {b} } else { {c} }", "select"),
    commuting(row(Op::MulAdd, "fma", 3, |a, b, c| a * b + c, 1, 4, "F::fma({a}, {b}, {c})", "fmadd")),
    commuting(row(Op::MulSub, "fma", 3, |a, b, c| a * b - c, 1, 4, "F::fma({a}, {b}, -{c})", "fmsub")),
    commuting(row(Op::NegMulAdd, "fma", 3, |a, b, c| c - a * b, 1, 4, "F::fma(-{a}, {b}, {c})", "fnmadd")),
    commuting(row(Op::NegMulSub, "fma", 3, |a, b, c| -(a * b) - c, 1, 4, "F::fma(-{a}, {b}, -{c})", "fnmsub")),
    row(Op::LaneConstant, "lane constants", 0, |_, _, _| f64::NAN, 0, 0, "", ""),
    row(Op::LaneInput, "lane inputs", 0, |_, _, _| f64::NAN, 0, 0, "", ""),
    row(Op::Spread, "spread", 2, |a, _, _| a, 1, 3, "", "spread"),
    row(Op::Across, "across", 1, |a, _, _| a, 4, 14, "", "across"),
];

impl Op {
    /// The operation's row.
    pub fn row(self) -> &'static Row {
        &OPS[self as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::OPS;

    #[test]
    fn rows_stand_in_the_order_of_the_operations() {
        for (k, row) in OPS.iter().enumerate() {
            assert_eq!(row.op as usize, k);
        }
    }
}
