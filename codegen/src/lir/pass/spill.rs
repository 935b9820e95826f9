//! Spill slots for x86-64 without AVX-512, which has sixteen registers.
//!
//! In a long function, half of a compiler's instructions only move values out of registers and
//! back. They take nine and ten bytes each, since they address places far from the end of the
//! stack: more than such a processor keeps decoded. Here values are spilled to shelves that an
//! instruction addresses by one byte: two of 128 bytes around each pointer, since that byte has a
//! sign. Values with long waits are not worth those bytes, and share one struct.
//!
//! A target hides from its compiler where the pointers lead, so that a value is read where [`Plan`]
//! requires.

use std::collections::{HashMap, VecDeque};

use super::registers::{Plan, Step, Uses};
use crate::lir::{Angle, Expr, Operand, Slot, Slots, Stmt, Temp, Ty};

/// From this many nodes on, some 12 kB. Shorter code stays decoded in any case, if nothing else
/// runs on the core, and compilers know the latency of instructions better.
pub(crate) const FROM: usize = 1000;

/// Smallest number of slot reads per hundred statements, for plain numbers and for lanes: with
/// fewer, compilers do as well.
const READS: [usize; 2] = [26, 18];

/// A value that is needed once in this many steps, or less often, is not put on a shelf.
const RARELY: usize = 500;

/// Bytes of a shelf: as far as one byte reaches on either side of a pointer.
const SHELF: usize = 128;

/// Lanes of AVX2, for which spill slots of many states are planned. As many bytes of either type.
const AVX2_LANES: usize = 4;

/// Number of values of a type on a shelf.
fn per_shelf(ty: Ty) -> usize {
    let bytes = match ty {
        Ty::F32 => 4,
        Ty::F64 => 8,
        Ty::Pair => 16,
        Ty::Vector(lanes) => 8 * lanes,
        Ty::States => 8 * AVX2_LANES,
    };
    SHELF / bytes
}

/// The same statements with values of this type spilled and loaded.
pub(crate) fn spill(statements: Vec<Stmt>, ty: Ty) -> (Vec<Stmt>, Slots) {
    let steps: Vec<Step> = statements.iter().map(|statement| step(statement, ty)).collect();
    let uses = Uses::of(&steps);
    let plan = Plan::of(&steps, &uses);
    let mut writer =
        Writer { uses: &uses, plan: &plan, slot: HashMap::new(), near: Places::default(), far: Places::default(), loads: HashMap::new() };
    let mut out = Vec::with_capacity(statements.len());
    for (at, (statement, step)) in statements.into_iter().zip(&steps).enumerate() {
        writer.write(&mut out, at, statement, step);
    }
    (out, Slots { near: writer.near.all, per_shelf: per_shelf(ty), far: writer.far.all })
}

/// Whether spilled statements read slots often enough.
pub(crate) fn pays(statements: &[Stmt], in_lanes: bool) -> bool {
    let (mut reads, mut others) = (0, 0);
    for statement in statements {
        match statement {
            Stmt::Load(..) => (reads, others) = (reads + 1, others + 1),
            // The result is one statement, however many numbers it has.
            Stmt::Spill(..) | Stmt::Result(..) => {}
            _ => {
                others += 1;
                statement.operands(|operand| reads += usize::from(matches!(operand, Operand::Slot(_))));
            }
        }
    }
    100 * reads >= READS[usize::from(in_lanes)] * others
}

/// Operands and results of a statement, for the plan of registers.
fn step(statement: &Stmt, ty: Ty) -> Step {
    let mut defined = Vec::new();
    // Masks and sums over lanes stay in registers.
    if !statement.compares() && !matches!(statement, Stmt::SumLanes(..)) {
        statement.defines(|temp| defined.push(temp.index()));
    }
    // Sines of numbers go four at a time: with fewer angles, the others are constants.
    let are_fewer = |angles: &[Angle]| matches!(ty, Ty::F64 | Ty::F32) && angles.len() < 4;
    let mut has_constant = matches!(statement, Stmt::SinCos { angles, .. } if are_fewer(angles));
    let mut all = Vec::new();
    statement.operands(|operand| match operand {
        Operand::Temp(temp) => all.push(temp.index()),
        _ => has_constant = true,
    });
    let mut used = all.clone();
    used.sort_unstable();
    used.dedup();
    // A constant is in memory already. A value that is used twice, or is the only operand, must be
    // loaded.
    let is_computed = matches!(statement, Stmt::Let(_, Expr::Op(..)) | Stmt::SinCos { .. } | Stmt::SumLanes(..));
    let once = |k: &usize| all.iter().filter(|other| *other == k).count() == 1;
    let foldable = if !is_computed || all.len() < 2 || has_constant { Vec::new() } else { all.iter().copied().filter(once).collect() };
    Step { defined, used, foldable }
}

/// Allocator of slots, which are freed again.
#[derive(Default)]
struct Places {
    free: VecDeque<usize>,
    all: usize,
}

impl Places {
    fn take(&mut self) -> usize {
        self.free.pop_front().unwrap_or_else(|| {
            self.all += 1;
            self.all - 1
        })
    }
}

/// The writer of the statements.
struct Writer<'a> {
    uses: &'a Uses,
    plan: &'a Plan,
    slot: HashMap<usize, Slot>,
    near: Places,
    far: Places,
    /// How many times each value was loaded.
    loads: HashMap<usize, u32>,
}

impl Writer<'_> {
    fn write(&mut self, out: &mut Vec<Stmt>, at: usize, mut statement: Stmt, step: &Step) {
        for &k in &self.plan.loads[at] {
            *self.loads.entry(k).or_default() += 1;
            out.push(Stmt::Load(self.temp(k), self.slot[&k]));
        }
        let folded = self.plan.folded[at];
        statement.map_operands(|operand| {
            if let Operand::Temp(temp) = operand {
                let k = temp.index();
                *operand = if folded == Some(k) { Operand::Slot(self.slot[&k]) } else { Operand::Temp(self.temp(k)) };
            }
        });
        out.push(statement);
        for k in step.used.iter().filter(|k| self.uses.is_over(**k, at)) {
            match self.slot.get(k) {
                Some(Slot { is_far: true, number }) => self.far.free.push_back(*number),
                Some(Slot { is_far: false, number }) => self.near.free.push_back(*number),
                None => {}
            }
        }
        for &k in step.defined.iter().filter(|k| self.plan.spilled[**k]) {
            let is_far = self.uses.rarity(k, at) >= RARELY;
            let number = if is_far { self.far.take() } else { self.near.take() };
            let slot = Slot { is_far, number };
            self.slot.insert(k, slot);
            out.push(Stmt::Spill(slot, Temp::of(k)));
        }
    }

    /// The value as it was loaded last.
    fn temp(&self, k: usize) -> Temp {
        Temp { id: k as u32, load: self.loads.get(&k).copied().unwrap_or(0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::{Lanes, Op};
    use crate::lir::interpret::interpret;
    use crate::lir::{Array, Body, Number, Store, verify};

    fn value(id: usize) -> Operand {
        Operand::Temp(Temp::of(id))
    }

    /// `n` inputs, and multiply-adds of the first with each of the others from the last one on, so
    /// that all are needed until the end.
    fn long(n: usize) -> Vec<Stmt> {
        let inputs = (0..n).map(|k| Stmt::Let(Temp::of(k), Expr::Input { argument: 0, index: k as u32 }));
        let sums = (1..n).map(|k| {
            let operands = [value(0), value(n - k), value(if k == 1 { 0 } else { n + k - 2 })];
            Stmt::Let(Temp::of(n + k - 1), Expr::Op(Op::NegMulAdd, operands))
        });
        inputs.chain(sums).collect()
    }

    fn with_result(mut statements: Vec<Stmt>, id: usize) -> Vec<Stmt> {
        statements.push(Stmt::Result(0, Number { of: value(id), lane: 0 }));
        statements
    }

    fn body(statements: Vec<Stmt>, slots: Option<Slots>) -> Body {
        let results = vec![Array { start: 0, lengths: vec![1] }];
        Body { ty: Ty::F64, lanes: Lanes::default(), results, pieces: vec![statements], kept: 0, slots, barrier: false, is_partial: false }
    }

    #[test]
    fn what_fits_into_registers_stays_as_it_is() {
        let statements = long(14);
        let (found, slots) = spill(statements.clone(), Ty::F64);
        assert_eq!((&found, slots.near, slots.far), (&statements, 0, 0));
        assert!(!pays(&found, false));
    }

    #[test]
    fn what_is_needed_last_waits_and_is_read_where_it_is_needed() {
        let (statements, _) = spill(long(16), Ty::F64);
        // x0 is needed at once, x15 is first, and x1 last.
        let slot = |number| Slot { is_far: false, number };
        let spills: Vec<&Stmt> = statements.iter().filter(|s| matches!(s, Stmt::Spill(..))).collect();
        assert_eq!(spills, [&Stmt::Spill(slot(0), Temp::of(1)), &Stmt::Spill(slot(1), Temp::of(2))]);
        let last = |id: usize, read| Stmt::Let(Temp::of(id), Expr::Op(Op::NegMulAdd, [value(0), Operand::Slot(slot(read)), value(id - 1)]));
        assert_eq!(statements[statements.len() - 2..], [last(29, 1), last(30, 0)]);
    }

    #[test]
    fn what_is_there_twice_or_alone_or_beside_a_constant_is_loaded() {
        let zero = Operand::Constant(0.0);
        for operands in [[value(1), value(1), zero], [value(1), Operand::Constant(0.5), zero]] {
            let mut statements = long(16);
            *statements.last_mut().unwrap() = Stmt::Let(Temp::of(30), Expr::Op(Op::Mul, operands));
            let (found, _) = spill(statements, Ty::F64);
            let loaded = Temp { id: 1, load: 1 };
            assert_eq!(found[found.len() - 2], Stmt::Load(loaded, Slot { is_far: false, number: 0 }));
            assert!(matches!(found.last(), Some(Stmt::Let(_, Expr::Op(Op::Mul, [a, ..]))) if *a == Operand::Temp(loaded)));
        }
    }

    #[test]
    fn comparisons_never_wait() {
        let zero = Operand::Constant(0.0);
        let mut statements = vec![Stmt::Let(Temp::of(500), Expr::Input { argument: 0, index: 0 })];
        statements.push(Stmt::Let(Temp::of(501), Expr::Op(Op::Positive, [value(500), zero, zero])));
        statements.extend(long(40));
        statements.push(Stmt::Let(Temp::of(502), Expr::Op(Op::Select, [value(501), value(1), value(2)])));
        let (found, slots) = spill(with_result(statements, 502), Ty::F64);
        assert!(!found.iter().any(|s| matches!(s, Stmt::Spill(_, temp) if temp.id == 501)) && slots.near > 0);
        assert_eq!(verify(&body(found, Some(slots))), Ok(()));
    }

    #[test]
    fn spilled_statements_compute_the_same() {
        for n in [15, 40, 700] {
            let statements = with_result(long(n), 2 * n - 2);
            let (spilled, slots) = spill(statements.clone(), Ty::Vector(4));
            let [whole, spilled] = [body(statements, None), body(spilled, Some(slots))];
            assert_eq!((verify(&whole), verify(&spilled)), (Ok(()), Ok(())));
            let input = |_: usize, k: usize| 0.5 + k as f64 / 7.0;
            assert_eq!(interpret(&whole, input), interpret(&spilled, input));
            assert_eq!(slots.far > 0, n == 700, "{slots:?}");
        }
    }

    #[test]
    fn results_are_loaded_where_they_wait() {
        let mut statements = long(24);
        statements.push(Stmt::Store(Store::One(0, Number { of: value(7), lane: 0 })));
        let (spilled, slots) = spill(statements, Ty::F64);
        assert!(matches!(spilled.last(), Some(Stmt::Store(Store::One(0, Number { of: Operand::Temp(Temp { id: 7, load: 1 }), .. })))));
        assert_eq!(verify(&body(spilled, Some(slots))), Ok(()));
    }
}
