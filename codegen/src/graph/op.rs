//! The operations of the graph: one row each.

/// An operation. `MulAdd` and its variants round once where the processor has the instruction,
/// twice where it has not.
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
    Broadcast,
    /// the sum of a's lanes, in every lane
    ReduceAdd,
    /// the values of the list a, then b
    List,
    /// the region with a number of the graph on the values of the list a
    Region,
    /// the value with a number that comes out of the region a
    RegionValue,
}

/// Properties of an operation.
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
    /// Cost, in floating-point instructions.
    pub cost: u32,
    /// After how many cycles its value is known, on a current processor.
    pub latency: u32,
}

/// An operation's row. By default it is a number or an input, which costs nothing.
const fn row(op: Op, name: &'static str) -> Row {
    Row { op, name, arity: 0, commutes: false, cost: 0, latency: 0 }
}

impl Row {
    const fn of_operands(self, arity: usize) -> Self {
        Self { arity, ..self }
    }

    const fn commuting(self) -> Self {
        Self { commutes: true, ..self }
    }

    const fn takes(self, cost: u32, latency: u32) -> Self {
        Self { cost, latency, ..self }
    }
}

/// All operations, in the order of [`Op`].
pub const OPS: [Row; 24] = [
    row(Op::Constant, "constants"),
    row(Op::Input, "inputs"),
    row(Op::Add, "add").of_operands(2).commuting().takes(1, 4),
    row(Op::Sub, "sub").of_operands(2).takes(1, 4),
    row(Op::Mul, "mul").of_operands(2).commuting().takes(1, 4),
    row(Op::Div, "div").of_operands(2).takes(4, 13),
    row(Op::Neg, "neg").of_operands(1).takes(1, 1),
    row(Op::Sqrt, "sqrt").of_operands(1).takes(4, 18),
    row(Op::Sin, "sin").of_operands(1).takes(10, 60),
    row(Op::Cos, "cos").of_operands(1).takes(10, 60),
    row(Op::Atan2, "atan2").of_operands(2).takes(20, 80),
    row(Op::Positive, "compare").of_operands(1).takes(1, 3),
    row(Op::Select, "select").of_operands(3).takes(1, 2),
    row(Op::MulAdd, "fma").of_operands(3).commuting().takes(1, 4),
    row(Op::MulSub, "fma").of_operands(3).commuting().takes(1, 4),
    row(Op::NegMulAdd, "fma").of_operands(3).commuting().takes(1, 4),
    row(Op::NegMulSub, "fma").of_operands(3).commuting().takes(1, 4),
    row(Op::LaneConstant, "lane constants"),
    row(Op::LaneInput, "lane inputs"),
    row(Op::Broadcast, "broadcast").of_operands(2).takes(1, 3),
    row(Op::ReduceAdd, "reduce_add").of_operands(1).takes(4, 14),
    row(Op::List, "lists").of_operands(2),
    row(Op::Region, "regions").of_operands(1),
    row(Op::RegionValue, "values of regions").of_operands(1),
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
