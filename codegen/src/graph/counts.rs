//! Numbers of operations.

use super::{OPS, Op};

/// How often each operation occurs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Counts([u64; OPS.len()]);

impl Counts {
    /// Adds `n` of an operation.
    pub fn add(&mut self, op: Op, n: u64) {
        self.0[op as usize] += n;
    }

    /// How often `op` occurs.
    pub fn of(&self, op: Op) -> u64 {
        self.0[op as usize]
    }

    /// Each operation with how often it occurs.
    pub(super) fn each(&self) -> impl Iterator<Item = (Op, u64)> + '_ {
        OPS.iter().map(|row| (row.op, self.of(row.op)))
    }

    /// Multiplications, those inside a multiply-add included.
    pub fn multiplications(&self) -> u64 {
        self.of(Op::Mul) + self.fused()
    }

    /// Additions and subtractions, those inside a multiply-add included.
    pub fn additions(&self) -> u64 {
        self.of(Op::Add) + self.of(Op::Sub) + self.fused()
    }

    /// Multiply-adds of all signs.
    pub fn fused(&self) -> u64 {
        [Op::MulAdd, Op::MulSub, Op::NegMulAdd, Op::NegMulSub].iter().map(|&op| self.of(op)).sum()
    }

    /// Sines and cosines.
    pub fn trigonometric(&self) -> u64 {
        self.of(Op::Sin) + self.of(Op::Cos)
    }

    /// Arctangents.
    pub fn arctangents(&self) -> u64 {
        self.of(Op::Atan2)
    }

    /// Floating-point instructions without sines, cosines and arctangents: additions,
    /// multiplications, multiply-adds (one each), divisions, roots, signs, comparisons and
    /// selections.
    pub fn instructions(&self) -> u64 {
        let all = self.0.iter().enumerate().filter(|(k, _)| OPS[*k].cost > 0);
        all.map(|(_, n)| n).sum::<u64>() - self.trigonometric() - self.arctangents()
    }

    /// Additions, multiplications and divisions: what papers count.
    pub fn operations(&self) -> u64 {
        self.additions() + self.multiplications() + self.of(Op::Div) + self.of(Op::Sqrt)
    }
}
