//! Statements as Rust.

use std::fmt::{self, Display, Formatter, Write};

use crate::graph::Op;
use crate::language::rust::literal::{bare, literal, operand, single};
use crate::language::rust::several;
use crate::lir::function::Argument;
use crate::lir::{Angle, Body, Expr, Number, Operand, Rows, Slot, Stmt, Store, Temp, Ty};
use crate::{Arithmetic, Precision, TrigAccuracy};

/// As zero is written.
pub(crate) const ZERO: &str = "0.0";

/// From this many names on they are declared before the statements.
///
/// A compiler that tracks names for debuggers nests the code after a `let` inside it, and some
/// thousands of levels overflow its stack. Their type is declared with them: the time to infer it
/// grows as the square of their number.
const HOISTED_FROM: usize = 1000;

/// Number of names that one `let` declares.
const DECLARED_TOGETHER: usize = 100;

/// How many angles `trig::four` takes.
const FOUR: usize = 4;

/// Largest number of slots in one struct: a compiler looks at them one by one.
pub(crate) const FIELDS: usize = 1024;

/// Place of a number: its array and its index there, or a variable.
pub(crate) struct Place {
    pub(crate) array: String,
    pub(crate) index: Option<usize>,
}

impl Display for Place {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { array, index } = self;
        match index {
            Some(index) => write!(f, "{array}[{index}]"),
            None => f.write_str(array),
        }
    }
}

/// Prints the statements of a body.
pub(crate) struct Printer<'a> {
    pub(crate) body: &'a Body,
    pub(crate) arguments: &'a [Argument],
    pub(crate) level: Precision,
    /// Where each number of the result is.
    pub(crate) places: &'a dyn Fn(usize) -> Place,
    /// Whether the memory may be uninitialised.
    pub(crate) is_raw: bool,
}

impl Printer<'_> {
    /// A piece of the body, except for the numbers of the result that are put together at the end.
    pub(crate) fn statements(&self, out: &mut String, statements: &[Stmt]) {
        let hoisted = self.hoisted(statements);
        for names in hoisted.chunks(DECLARED_TOGETHER) {
            let list: Vec<String> = names.iter().map(|temp| name(*temp)).collect();
            let _ = writeln!(out, "    let [{}]: [{}; {}];", list.join(", "), ty(self.body.ty).0, list.len());
        }
        for statement in statements {
            // The type of masks is not that of values, and neither do sums over lanes go with them.
            let is_hoisted = !hoisted.is_empty() && !statement.compares() && !matches!(statement, Stmt::SumLanes(..));
            self.statement(out, statement, if is_hoisted { "" } else { "let " });
        }
    }

    /// The names that are declared before the statements.
    fn hoisted(&self, statements: &[Stmt]) -> Vec<Temp> {
        let mut all = Vec::new();
        for statement in statements.iter().filter(|s| !s.compares() && !matches!(s, Stmt::SumLanes(..))) {
            statement.defines(|temp| all.push(temp));
        }
        if all.len() < HOISTED_FROM { Vec::new() } else { all }
    }

    fn statement(&self, out: &mut String, statement: &Stmt, define: &str) {
        let _ = match statement {
            Stmt::Let(dst, expression) => writeln!(out, "    {define}{} = {};", name(*dst), self.expression(expression)),
            Stmt::SinCos { angles, alone } => {
                self.sines(out, angles, *alone, define);
                Ok(())
            }
            Stmt::Thirds { dst, argument, first } => {
                let names = dst.map(name).join(", ");
                let numbers: Vec<String> = (*first..first + 12).map(|k| self.element(*argument, k)).collect();
                writeln!(out, "    {define}[{names}] = every_third(&[{}]);", numbers.join(", "))
            }
            Stmt::SumLanes(dst, operands) => {
                let mut list: Vec<String> = operands.iter().map(|o| self.operand(o)).collect();
                let function = if list.len() == 2 { "reduce_add_of_two" } else { "reduce_add_of_four" };
                if list.len() == 3 {
                    list.push(list[2].clone());
                }
                writeln!(out, "    let {} = {function}({});", name(*dst), list.join(", "))
            }
            Stmt::Keep(slot, temp) => writeln!(out, "    {} = {};", kept(*slot), name(*temp)),
            Stmt::Recall(temp, slot) => writeln!(out, "    {define}{} = {};", name(*temp), kept(*slot)),
            Stmt::Spill(slot, temp) => writeln!(out, "    spill(&raw mut {}, {});", self.slot(*slot), name(*temp)),
            Stmt::Load(temp, slot) => writeln!(out, "    {define}{} = {};", name(*temp), self.slot(*slot)),
            Stmt::Store(store) => {
                let _ = write!(out, "    ");
                self.store(out, store);
                writeln!(out, ";")
            }
            Stmt::Result(..) => Ok(()),
            Stmt::Region(region) => {
                self.region(out, region, define);
                Ok(())
            }
        };
    }

    fn expression(&self, expression: &Expr) -> String {
        match (expression, self.body.ty) {
            (Expr::Input { argument, index }, Ty::States) => format!("at(&{}[{index}], part)", self.arguments[*argument as usize].name),
            (Expr::Input { argument, index }, Ty::Vector(_)) => format!("k({})", self.element(*argument, *index)),
            (Expr::Input { argument, index }, Ty::Pair) => format!("({}, 0.0)", self.element(*argument, *index)),
            (Expr::Input { argument, index }, _) => bare(&self.input(*argument, *index)).to_owned(),
            (Expr::LaneInput { argument, indices }, _) => {
                let numbers = self.body.lanes.input(*indices).iter().map(|&i| self.element(*argument, i));
                format!("lanes([{}])", numbers.collect::<Vec<_>>().join(", "))
            }
            (Expr::Broadcast(number), _) => format!("k({})", self.number(number)),
            (Expr::Op(op, operands), Ty::F64 | Ty::F32) => self.arithmetic(*op, operands),
            (Expr::Op(op, operands), ty) => {
                let list: Vec<String> = operands[..op.row().arity].iter().map(|o| self.operand(o)).collect();
                let generic = if ty == Ty::Pair { "::<FUSED>" } else { "" };
                format!("{}{generic}({})", function(*op), list.join(", "))
            }
        }
    }

    /// Operators on numbers.
    fn arithmetic(&self, op: Op, operands: &[Operand; 3]) -> String {
        let [a, b, c] = operands.map(|o| self.operand(&o));
        let real = ty(self.body.ty).0;
        match op {
            Op::Add => format!("{a} + {b}"),
            Op::Sub => format!("{a} - {b}"),
            Op::Mul => format!("{a} * {b}"),
            Op::Div => format!("{a} / {b}"),
            Op::Neg => format!("-{a}"),
            Op::Sqrt => format!("{a}.sqrt()"),
            Op::Sin => format!("{a}.sin()"),
            Op::Cos => format!("{a}.cos()"),
            Op::Atan2 => format!("{real}::atan2({a}, {b})"),
            Op::Positive => format!("{a} > 0.0"),
            Op::Select => format!("if {a} {{ {} }} else {{ {} }}", bare(&b), bare(&c)),
            Op::MulAdd => format!("F::fma({a}, {b}, {c})"),
            Op::MulSub => format!("F::fma({a}, {b}, -{c})"),
            Op::NegMulAdd => format!("F::fma(-{a}, {b}, {c})"),
            Op::NegMulSub => format!("F::fma(-{a}, {b}, -{c})"),
            Op::Constant
            | Op::Input
            | Op::LaneConstant
            | Op::LaneInput
            | Op::Broadcast
            | Op::ReduceAdd
            | Op::List
            | Op::Region
            | Op::RegionValue => a,
        }
    }

    /// Sines and cosines.
    fn sines(&self, out: &mut String, angles: &[Angle], alone: bool, define: &str) {
        let angle = |a: &Angle| self.operand(&a.angle);
        let pair = |a: &Angle| format!("({}, {})", optional(a.sin), optional(a.cos));
        let list = |of: &dyn Fn(&Angle) -> String, pad: Option<&str>| {
            let mut list: Vec<String> = angles.iter().map(of).collect();
            pad.into_iter().for_each(|pad| list.resize(FOUR, pad.into()));
            list.join(", ")
        };
        let sin = |a: &Angle| optional(a.sin);
        let cos = |a: &Angle| optional(a.cos);
        let _ = match (self.body.ty, angles) {
            (Ty::Pair, _) => {
                self.sines_of_pairs(out, angles, define);
                Ok(())
            }
            (Ty::Vector(_) | Ty::States, [one]) => writeln!(out, "    {define}{} = sin_cos({});", pair(one), angle(one)),
            (Ty::Vector(_) | Ty::States, _) => {
                let function = several::name(angles.len());
                writeln!(out, "    {define}[[{}], [{}]] = {function}({});", list(&sin, None), list(&cos, None), list(&angle, None))
            }
            (_, [one]) if alone => writeln!(out, "    {define}{} = f64::sin_cos({});", pair(one), angle(one)),
            _ => {
                let (sines, cosines, angles) = (list(&sin, Some("_")), list(&cos, Some("_")), list(&angle, Some(ZERO)));
                writeln!(out, "    {define}[[{sines}], [{cosines}]] = trig::four::<F>({angles});")
            }
        };
    }

    fn sines_of_pairs(&self, out: &mut String, angles: &[Angle], define: &str) {
        let pair = |a: &Angle| format!("({}, {})", optional(a.sin), optional(a.cos));
        match self.level.sines {
            TrigAccuracy::DoubleDouble => angles.iter().for_each(|a| {
                let _ = writeln!(out, "    {define}{} = sin_cos::<FUSED>({});", pair(a), self.operand(&a.angle));
            }),
            TrigAccuracy::CorrectlyRounded => angles.iter().for_each(|a| {
                let angle = self.operand(&a.angle);
                let value = format!("{{ let (s, c) = sin_cos_correct::<FUSED>({angle}.0); turned::<FUSED>({angle}, s, c) }}");
                let _ = writeln!(out, "    {define}{} = {value};", pair(a));
            }),
            // Those of the doubles, turned by the rest.
            _ => {
                let number = |a: &Angle| a.angle.temp().map_or(0, |temp| temp.id);
                let padded = |of: &dyn Fn(&Angle) -> String, pad: &str| {
                    let mut list: Vec<String> = angles.iter().map(of).collect();
                    list.resize(FOUR, pad.into());
                    list.join(", ")
                };
                let (sines, cosines) = (padded(&|a| format!("s{}", number(a)), "_"), padded(&|a| format!("c{}", number(a)), "_"));
                let list = padded(&|a| format!("{}.0", self.operand(&a.angle)), ZERO);
                let _ = writeln!(out, "    let [[{sines}], [{cosines}]] = trig::four::<MultiplyAdd<FUSED>>({list});");
                for a in angles {
                    let (angle, k) = (self.operand(&a.angle), number(a));
                    let _ = writeln!(out, "    {define}{} = turned::<FUSED>({angle}, s{k}, c{k});", pair(a));
                }
            }
        }
    }

    fn store(&self, out: &mut String, store: &Store) {
        let place = self.places;
        let value = |number: &Number| {
            let value = self.number(number);
            bare(&value).to_owned()
        };
        if self.body.ty == Ty::States
            && let Store::One(at, number) = store
        {
            let _ = write!(out, "put(&mut {}, part, {})", place(*at), self.number(number));
            return;
        }
        if self.is_raw {
            return self.raw_store(out, store);
        }
        let _ = match store {
            Store::One(at, number) if self.body.barrier => write!(out, "{}.set({})", barrier_place(*at), value(number)),
            Store::One(at, number) => write!(out, "{} = {}", place(*at), value(number)),
            Store::Two(at, numbers) => {
                let Place { array, index } = place(*at);
                let numbers = numbers.map(|n| value(&n)).join(", ");
                write!(out, "store(lanes([{numbers}]), &mut {array}.as_chunks_mut::<2>().0[{}])", index.unwrap_or(0) / 2)
            }
            Store::Fill(at, count, x) => {
                let Place { array, index } = place(*at);
                let first = index.unwrap_or(0);
                write!(out, "{array}[{first}..{}].fill({})", first + count, literal(*x))
            }
            // These are for raw memory alone.
            Store::Whole(..) | Store::Rows(..) => Ok(()),
        };
    }

    /// A store into an array of numbers that need not be there yet.
    fn raw_store(&self, out: &mut String, store: &Store) {
        let room = |at: usize| {
            let Place { array, index } = (self.places)(at);
            (array, index.unwrap_or(0))
        };
        let _ = match store {
            Store::One(at, number) => {
                let (to, at) = room(*at);
                write!(out, "put_one({}, {to}, {at})", self.bare_number(number))
            }
            Store::Two(at, numbers) => {
                let (to, at) = room(*at);
                write!(out, "put_two([{}], {to}, {at})", numbers.map(|n| self.bare_number(&n)).join(", "))
            }
            Store::Fill(at, count, x) => {
                let (to, at) = room(*at);
                write!(out, "{to}[{at}..{}].fill(::core::mem::MaybeUninit::new({}))", at + count, literal(*x))
            }
            Store::Whole(at, operand) => {
                let (to, at) = room(*at);
                write!(out, "put({}, {to}, {at})", self.operand(operand))
            }
            Store::Rows(rows, columns) => {
                let list = columns.iter().map(|c| self.operand(c)).collect::<Vec<_>>().join(", ");
                let (to, starts) = (room(rows.starts()[0]).0, rows.starts().map(|at| room(at).1));
                match rows {
                    Rows::InTurn(_) => write!(out, "put_in_turn({list}, {to}, {})", starts[0]),
                    Rows::Fours(_) => write!(out, "put_fours({list}, {to}, {starts:?})"),
                    Rows::Twos(_) => write!(out, "put_twos({list}, {to}, {starts:?})"),
                }
            }
        };
    }

    fn bare_number(&self, number: &Number) -> String {
        if let Operand::Constant(x) = number.of { literal(x) } else { self.number(number) }
    }

    /// A number of the result.
    pub(crate) fn number(&self, number: &Number) -> String {
        match (self.body.ty, number.of) {
            (Ty::States, of) => self.operand(&of),
            (Ty::Vector(_) | Ty::Pair, Operand::Constant(x)) => operand(x),
            (Ty::Vector(_), of) => format!("lane::<{}>({})", number.lane, self.operand(&of)),
            (Ty::Pair, of) => format!("number::<FUSED>({})", self.operand(&of)),
            (Ty::F64 | Ty::F32, of) => match (self.level.arithmetic, of) {
                (Arithmetic::SingleByDouble, Operand::Constant(x)) => single(x),
                (Arithmetic::SingleByDouble, _) => format!("{} as f32", self.operand(&of)),
                _ => self.operand(&of),
            },
        }
    }

    /// A name, a literal or a slot.
    pub(super) fn operand(&self, of: &Operand) -> String {
        match (*of, self.body.ty) {
            (Operand::Temp(temp), _) => name(temp),
            (Operand::Slot(slot), _) => self.slot(slot),
            (Operand::Constant(x), Ty::F64) => operand(x),
            (Operand::Constant(x), Ty::F32) => single(x),
            (Operand::Constant(x), Ty::Pair) => format!("({}, 0.0)", literal(x)),
            (Operand::Constant(x), Ty::Vector(_) | Ty::States) => format!("k({})", literal(x)),
            (Operand::Lanes(number), _) => {
                let numbers = &self.body.lanes.constant(number)[..self.body.lanes.width];
                format!("lanes([{}])", numbers.iter().map(|x| literal(*x)).collect::<Vec<_>>().join(", "))
            }
        }
    }

    fn slot(&self, slot: Slot) -> String {
        let per_shelf = self.body.slots.map_or(1, |slots| slots.per_shelf);
        match slot {
            Slot { is_far: true, number } => format!("(*far).m{number}"),
            Slot { is_far: false, number } => format!("(*s{}).m{}", number / per_shelf, number % per_shelf),
        }
    }

    /// An element of an argument, by its index row by row.
    fn element(&self, argument: u32, index: u32) -> String {
        element(&self.arguments[argument as usize], index as usize)
    }

    /// An element of an argument as one of the numbers that are computed with.
    fn input(&self, argument: u32, index: u32) -> String {
        let (number, is_parameters) = (self.element(argument, index), self.arguments[argument as usize].is_parameters());
        match (self.level.arithmetic, is_parameters) {
            (Arithmetic::SingleByDouble, false) => format!("{number} as f64"),
            (Arithmetic::Single, true) => format!("{number} as f32"),
            _ => number,
        }
    }
}

/// The indices of value `k` in an array of these lengths.
pub(crate) fn index(mut k: usize, lengths: &[usize]) -> String {
    lengths.iter().rev().fold(String::new(), |inner, n| {
        let own = format!("[{}]{inner}", k % n);
        k /= n;
        own
    })
}

/// An element of an argument, by its index row by row.
pub(crate) fn element(argument: &Argument, k: usize) -> String {
    match argument.lengths.as_slice() {
        [] if !argument.is_parameters() => format!("(*{})", argument.name),
        [] | [_] => format!("{}[{k}]", argument.name),
        lengths => format!("{}{}", argument.name, index(k, lengths)),
    }
}

/// The type of a value, and a value of it.
pub(crate) fn ty(ty: Ty) -> (&'static str, &'static str) {
    match ty {
        Ty::F64 => ("f64", ZERO),
        Ty::F32 => ("f32", ZERO),
        Ty::Pair => ("V", "(0.0, 0.0)"),
        Ty::Vector(_) | Ty::States => ("V", "k(0.0)"),
    }
}

/// The name of a value.
pub(super) fn name(temp: Temp) -> String {
    if temp.load == 0 { format!("x{}", temp.id) } else { format!("x{}r{}", temp.id, temp.load) }
}

fn optional(temp: Option<Temp>) -> String {
    temp.map_or_else(|| "_".to_owned(), name)
}

/// The field of a value passed between pieces.
pub(crate) fn kept(slot: usize) -> String {
    format!("m.k{}.m{}", slot / FIELDS, slot % FIELDS)
}

/// The place of a number of a result that is stored through two pointers in turn.
fn barrier_place(at: usize) -> String {
    format!("{}[{at}]", ["even", "odd"][at % 2])
}

/// The function that does an operation on all lanes, or on sums of two numbers.
pub(crate) fn function(op: Op) -> &'static str {
    match op {
        Op::Add => "add",
        Op::Sub => "sub",
        Op::Mul => "mul",
        Op::Div => "div",
        Op::Neg => "neg",
        Op::Sqrt => "sqrt",
        Op::Atan2 => "atan2",
        Op::Positive => "positive",
        Op::Select => "select",
        Op::MulAdd => "fmadd",
        Op::MulSub => "fmsub",
        Op::NegMulAdd => "fnmadd",
        Op::NegMulSub => "fnmsub",
        Op::ReduceAdd => "reduce_add",
        Op::Constant | Op::Input | Op::LaneConstant | Op::LaneInput | Op::Broadcast | Op::Sin | Op::Cos => "",
        Op::List | Op::Region | Op::RegionValue => "",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::Lanes;
    use crate::lir::Array;

    fn value(id: usize) -> Operand {
        Operand::Temp(Temp::of(id))
    }

    /// Statements of this type, whose results are `out[k]`.
    fn text(ty: Ty, lanes: Lanes, statements: &[Stmt]) -> String {
        let results = vec![Array { start: 0, lengths: vec![4] }];
        let body = Body { ty, lanes, results, pieces: Vec::new(), kept: 0, slots: None, barrier: false, is_partial: true };
        let shape = articulated_core::algorithm::Shape { nq: 4, nv: 4, frames: 0, links: 0, ..Default::default() };
        let arguments = [Argument::new("q", &[articulated_core::algorithm::Dim::Nq], shape)];
        let places = |at: usize| Place { array: "out".into(), index: Some(at) };
        let mut out = String::new();
        Printer { body: &body, arguments: &arguments, level: Precision::default(), places: &places, is_raw: false }
            .statements(&mut out, statements);
        out
    }

    #[test]
    fn each_type_has_its_words() {
        let input = Stmt::Let(Temp::of(1), Expr::Input { argument: 0, index: 2 });
        let fused = Stmt::Let(Temp::of(2), Expr::Op(Op::NegMulAdd, [Operand::Constant(-0.5), value(1), value(1)]));
        let of = |ty| text(ty, Lanes::default(), &[input.clone(), fused.clone()]);
        assert_eq!(of(Ty::F64), "    let x1 = q[2];\n    let x2 = F::fma(-(-0.5), x1, x1);\n");
        assert_eq!(of(Ty::Pair), "    let x1 = (q[2], 0.0);\n    let x2 = fnmadd::<FUSED>((-0.5, 0.0), x1, x1);\n");
        assert_eq!(of(Ty::Vector(2)), "    let x1 = k(q[2]);\n    let x2 = fnmadd(k(-0.5), x1, x1);\n");
        assert_eq!(of(Ty::States), "    let x1 = at(&q[2], part);\n    let x2 = fnmadd(k(-0.5), x1, x1);\n");
    }

    #[test]
    fn each_lane_has_its_number() {
        let mut lanes = Lanes::new(2);
        let constant = lanes.add_constant([-0.5, 0.5, -0.5, 0.5]);
        let indices = lanes.add_input(&[7, 4]);
        let statements = [
            Stmt::Let(Temp::of(1), Expr::LaneInput { argument: 0, indices }),
            Stmt::Let(Temp::of(2), Expr::Broadcast(Number { of: value(1), lane: 1 })),
            Stmt::Let(Temp::of(3), Expr::Op(Op::Mul, [value(1), Operand::Lanes(constant), value(1)])),
            Stmt::Store(Store::One(3, Number { of: value(3), lane: 0 })),
        ];
        let expected = "    let x1 = lanes([q[7], q[4]]);\n    let x2 = k(lane::<1>(x1));\n    let x3 = mul(x1, lanes([-0.5, 0.5]));\n    out[3] = lane::<0>(x3);\n";
        assert_eq!(text(Ty::Vector(2), lanes, &statements), expected);
    }

    #[test]
    fn many_names_are_declared_first_and_few_are_not() {
        let input = |k: usize| Stmt::Let(Temp::of(k), Expr::Input { argument: 0, index: k as u32 });
        let mut statements: Vec<Stmt> = (0..1097).map(input).collect();
        let zero = Operand::Constant(0.0);
        statements.push(Stmt::Let(Temp::of(2000), Expr::Op(Op::Positive, [value(1), zero, zero])));
        statements.push(Stmt::Let(Temp::of(2001), Expr::Op(Op::Select, [value(2000), value(2), zero])));
        let many = text(Ty::F64, Lanes::default(), &statements);
        assert!(many.starts_with("    let [x0, x1, x2, "));
        assert!(many.contains("x99]: [f64; 100];\n") && many.contains("\n    x5 = q[5];\n"));
        assert!(many.ends_with("    let x2000 = x1 > 0.0;\n    x2001 = if x2000 { x2 } else { 0.0 };\n"));
        assert_eq!(many.lines().filter(|l| l.starts_with("    let ")).count(), 1098_usize.div_ceil(DECLARED_TOGETHER) + 1);
        assert!(text(Ty::F64, Lanes::default(), &statements[..999]).starts_with("    let x0 = q[0];\n"));
    }
}
