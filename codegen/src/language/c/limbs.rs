//! Functions whose values are vectors, with a lane for each of several isomorphic limbs: by the
//! vector extensions of GCC and Clang, for those that have `__builtin_shufflevector`.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::statements::operator;
use crate::graph::Op;
use crate::lir::function::Argument;
use crate::lir::{Angle, Body, Expr, Number, Operand, Rows, Stmt, Store, Temp};

/// Lanes of the vectors in which sines are computed.
pub(super) const FOUR: usize = 4;

/// Prints the statements of a body of vectors.
pub(super) struct Printer<'a> {
    pub(super) body: &'a Body,
    pub(super) arguments: &'a [Argument],
    /// Prefix of all names.
    pub(super) prefix: &'a str,
    /// Prefix of the names of mathematical functions.
    pub(super) math: &'a str,
    /// The macro for infinity.
    pub(super) infinity: &'a str,
    /// Where each number of the result is: the array, and the index there.
    pub(super) places: &'a dyn Fn(usize) -> (String, usize),
}

impl Printer<'_> {
    fn width(&self) -> usize {
        self.body.lanes.width
    }

    /// The name of a type: `v` vectors, `m` masks, `u` vectors at any address.
    fn ty(&self, letter: &str) -> String {
        format!("{}_x{}_{letter}", self.prefix, self.width())
    }

    /// A piece of the body, behind the constants that it has as vectors.
    pub(super) fn statements(&self, out: &mut String, statements: &[Stmt]) {
        let v = self.ty("v");
        for (name, numbers) in self.constants(statements) {
            let _ =
                writeln!(out, "    const {v} {name} = {{{}}};", numbers.iter().map(|x| self.literal(*x)).collect::<Vec<_>>().join(", "));
        }
        statements.iter().for_each(|statement| self.statement(out, statement));
    }

    /// Constants that differ from lane to lane, and those that are operands of functions, by their
    /// names.
    fn constants(&self, statements: &[Stmt]) -> BTreeMap<String, Vec<f64>> {
        let mut all = BTreeMap::new();
        for statement in statements {
            let takes_vectors = match statement {
                Stmt::Let(_, Expr::Op(op, operands)) => takes_vectors(*op, operands),
                Stmt::Store(Store::One(..) | Store::Two(..)) | Stmt::Result(..) => false,
                _ => true,
            };
            statement.operands(|operand| match operand {
                Operand::Lanes(k) => _ = all.insert(self.operand(operand), self.body.lanes.constant(*k)[..self.width()].to_vec()),
                Operand::Constant(x) if takes_vectors => _ = all.insert(self.vector(operand), vec![*x; self.width()]),
                _ => {}
            });
        }
        all
    }

    fn statement(&self, out: &mut String, statement: &Stmt) {
        let v = self.ty("v");
        let _ = match statement {
            Stmt::Let(dst, Expr::Op(Op::ReduceAdd, [x, ..])) => {
                let (x, sum) = (self.vector(x), name(*dst));
                if self.width() == 2 {
                    writeln!(out, "    const {v} {sum} = {x} + {};", shuffle(&x, &x, &[1, 0]))
                } else {
                    let _ = writeln!(out, "    const {v} {sum}_2 = {x} + {};", shuffle(&x, &x, &[1, 0, 3, 2]));
                    let half = format!("{sum}_2");
                    writeln!(out, "    const {v} {sum} = {half} + {};", shuffle(&half, &half, &[2, 3, 0, 1]))
                }
            }
            Stmt::Let(dst, expression) => {
                let ty = if statement.compares() { self.ty("m") } else { v };
                writeln!(out, "    const {ty} {} = {};", name(*dst), self.expression(expression))
            }
            Stmt::SinCos { angles, .. } => {
                angles.chunks(FOUR / self.width()).for_each(|angles| self.sines(out, angles));
                Ok(())
            }
            Stmt::Thirds { dst, argument, first } => {
                for (k, dst) in dst.iter().enumerate() {
                    let list: Vec<String> = (0..4).map(|lane| self.element(*argument, *first + k as u32 + 3 * lane)).collect();
                    let _ = writeln!(out, "    const {v} {} = {{{}}};", name(*dst), list.join(", "));
                }
                Ok(())
            }
            Stmt::SumLanes(dst, operands) => {
                self.sums(out, *dst, operands);
                Ok(())
            }
            Stmt::Keep(slot, temp) => writeln!(out, "    m[{slot}] = {};", name(*temp)),
            Stmt::Recall(temp, slot) => writeln!(out, "    const {v} {} = m[{slot}];", name(*temp)),
            Stmt::Store(store) => {
                self.store(out, store);
                Ok(())
            }
            Stmt::Result(at, number) => {
                self.put(out, *at, &self.number(number));
                Ok(())
            }
            Stmt::Spill(..) | Stmt::Load(..) | Stmt::Region(_) => {
                unreachable!("C has no spill slots, and limbs no regions: {statement:?}")
            }
        };
    }

    /// Sums over the lanes of two to four vectors, each in a lane of its own.
    fn sums(&self, out: &mut String, dst: Temp, operands: &[Operand]) {
        let (v, sum) = (self.ty("v"), name(dst));
        let of = |k: usize| self.vector(&operands[k.min(operands.len() - 1)]);
        let [a, b, c, d] = [of(0), of(1), of(2), of(3)];
        if self.width() == 2 {
            let _ = writeln!(out, "    const {v} {sum} = {} + {};", shuffle(&a, &b, &[0, 2]), shuffle(&a, &b, &[1, 3]));
            return;
        }
        let pairs = |a: &str, b: &str| format!("{} + {}", shuffle(a, b, &[0, 4, 2, 6]), shuffle(a, b, &[1, 5, 3, 7]));
        let (first, second) = (format!("{sum}_a"), if operands.len() == 2 { format!("{sum}_a") } else { format!("{sum}_b") });
        let _ = writeln!(out, "    const {v} {first} = {};", pairs(&a, &b));
        if operands.len() > 2 {
            let _ = writeln!(out, "    const {v} {second} = {};", pairs(&c, &d));
        }
        let (low, high) = (shuffle(&first, &second, &[0, 1, 4, 5]), shuffle(&first, &second, &[2, 3, 6, 7]));
        let _ = writeln!(out, "    const {v} {sum} = {low} + {high};");
    }

    /// Sines and cosines of one vector of four angles, or of two of two.
    fn sines(&self, out: &mut String, angles: &[Angle]) {
        let (p, v) = (self.prefix, self.ty("v"));
        let first = angles.iter().find_map(|a| a.sin.or(a.cos)).map(name).unwrap_or_default();
        let (given, sin, cos) = (format!("{first}_angles"), format!("{first}_sines"), format!("{first}_cosines"));
        let of = |k: usize| self.vector(&angles[k.min(angles.len() - 1)].angle);
        let four = if self.width() == FOUR { of(0) } else { shuffle(&of(0), &of(1), &[0, 1, 2, 3]) };
        let _ = writeln!(out, "    const {p}_x4_v {given} = {four};\n    {p}_x4_v {sin}, {cos};");
        let _ = writeln!(out, "    {p}_x4_sin_cos(&{given}, &{sin}, &{cos});");
        for (k, angle) in angles.iter().enumerate() {
            for (dst, from) in [(angle.sin, &sin), (angle.cos, &cos)] {
                let value = if self.width() == FOUR { from.clone() } else { shuffle(from, from, &[2 * k, 2 * k + 1]) };
                if let Some(dst) = dst {
                    let _ = writeln!(out, "    const {v} {} = {value};", name(dst));
                }
            }
        }
    }

    fn store(&self, out: &mut String, store: &Store) {
        match store {
            Store::One(at, number) => self.put(out, *at, &self.number(number)),
            Store::Two(at, numbers) => (0..2).for_each(|k| self.put(out, at + k, &self.number(&numbers[k]))),
            Store::Fill(at, count, x) => (*at..at + count).for_each(|at| self.put(out, at, &self.literal(*x))),
            Store::Whole(at, operand) => self.put_four(out, *at, &self.vector(operand)),
            Store::Rows(rows, columns) => {
                let columns: Vec<String> = columns.iter().map(|c| self.vector(c)).collect();
                self.rows(out, *rows, &columns);
            }
        }
    }

    /// Number k of a lane is of column k.
    fn rows(&self, out: &mut String, rows: Rows, columns: &[String]) {
        match (rows, columns) {
            (Rows::Fours(at), [a, b, c, d]) => {
                let low = [shuffle(a, b, &[0, 4, 2, 6]), shuffle(c, d, &[0, 4, 2, 6])];
                let high = [shuffle(a, b, &[1, 5, 3, 7]), shuffle(c, d, &[1, 5, 3, 7])];
                for (lane, at) in at.into_iter().enumerate() {
                    let [x, y] = if lane % 2 == 0 { &low } else { &high };
                    self.put_four(out, at, &shuffle(x, y, if lane < 2 { &[0, 1, 4, 5] } else { &[2, 3, 6, 7] }));
                }
            }
            (Rows::InTurn(at), [a, b, c]) => {
                let (start, end) = (shuffle(a, b, &[0, 4, 1, 5]), shuffle(a, b, &[2, 6, 3, 7]));
                self.put_four(out, at, &shuffle(&start, c, &[0, 1, 4, 2]));
                self.put_four(out, at + 4, &shuffle(&shuffle(&start, c, &[3, 5, 3, 5]), &end, &[0, 1, 4, 5]));
                self.put_four(out, at + 8, &shuffle(&end, c, &[6, 2, 3, 7]));
            }
            _ => {
                for (lane, at) in rows.starts().into_iter().enumerate() {
                    (0..columns.len()).for_each(|k| self.put(out, at + k, &format!("{}[{lane}]", columns[k])));
                }
            }
        }
    }

    fn put(&self, out: &mut String, at: usize, number: &str) {
        let (array, index) = (self.places)(at);
        let _ = writeln!(out, "    {array}[{index}] = {number};");
    }

    /// All lanes side by side.
    fn put_four(&self, out: &mut String, at: usize, vector: &str) {
        let ((array, index), u) = ((self.places)(at), self.ty("u"));
        let _ = writeln!(out, "    *({u} *)(void *)({array} + {index}) = ({u}){vector};");
    }

    fn expression(&self, expression: &Expr) -> String {
        match expression {
            Expr::Input { argument, index } => format!("{{{}}}", vec![self.element(*argument, *index); self.width()].join(", ")),
            Expr::LaneInput { argument, indices } => {
                let list: Vec<String> = self.body.lanes.input(*indices).iter().map(|index| self.element(*argument, *index)).collect();
                format!("{{{}}}", list.join(", "))
            }
            Expr::Broadcast(number) => {
                let x = self.vector(&number.of);
                shuffle(&x, &x, &vec![number.lane; self.width()])
            }
            Expr::Op(op, operands) => self.operation(*op, operands),
        }
    }

    fn operation(&self, op: Op, operands: &[Operand; 3]) -> String {
        let text = |o: &Operand| if takes_vectors(op, operands) { self.vector(o) } else { self.operand(o) };
        let [a, b, c] = operands.each_ref().map(text);
        let each = |function: &str, operands: &[&str]| {
            let one = |lane| {
                let list: Vec<String> = operands.iter().map(|x| format!("{x}[{lane}]")).collect();
                format!("{}{function}({})", self.math, list.join(", "))
            };
            format!("{{{}}}", (0..self.width()).map(one).collect::<Vec<_>>().join(", "))
        };
        match op {
            Op::Sqrt => each("sqrt", &[&a]),
            Op::Sin => each("sin", &[&a]),
            Op::Cos => each("cos", &[&a]),
            Op::Atan2 => each("atan2", &[&a, &b]),
            Op::Positive => format!("{a} > 0.0"),
            Op::Select => format!("({})(({a} & ({m}){b}) | (~{a} & ({m}){c}))", self.ty("v"), m = self.ty("m")),
            _ => operator(op, &a, &b, &c).unwrap_or(a),
        }
    }

    fn element(&self, argument: u32, index: u32) -> String {
        format!("{}[{index}]", self.arguments[argument as usize].name)
    }

    /// A number of the result.
    fn number(&self, number: &Number) -> String {
        match number.of {
            Operand::Constant(x) => self.literal(x),
            of => format!("{}[{}]", self.vector(&of), number.lane),
        }
    }

    /// An operand beside a vector: a constant is a number.
    fn operand(&self, operand: &Operand) -> String {
        match operand {
            Operand::Temp(temp) => name(*temp),
            Operand::Constant(x) => self.literal(*x),
            Operand::Lanes(k) => format!("lanes_{k}"),
            Operand::Slot(_) => unreachable!("C has no spill slots: {operand:?}"),
        }
    }

    fn literal(&self, x: f64) -> String {
        let infinity = self.infinity;
        match x {
            _ if x.is_nan() => format!("({infinity} - {infinity})"),
            f64::INFINITY => infinity.into(),
            f64::NEG_INFINITY => format!("(-{infinity})"),
            _ if x < 0.0 => format!("({x:?})"),
            _ => format!("{x:?}"),
        }
    }

    /// An operand as a vector.
    fn vector(&self, operand: &Operand) -> String {
        match operand {
            Operand::Constant(x) => format!("all_{:x}", x.to_bits()),
            _ => self.operand(operand),
        }
    }
}

/// Whether an operation cannot take a number in the place of a vector.
fn takes_vectors(op: Op, operands: &[Operand; 3]) -> bool {
    let is_function = matches!(op, Op::Sqrt | Op::Sin | Op::Cos | Op::Atan2 | Op::Select | Op::Positive | Op::ReduceAdd | Op::Neg);
    let is_constant = |o: &Operand| matches!(o, Operand::Constant(_));
    is_function || operands[..op.row().arity.min(2)].iter().all(is_constant)
}

fn shuffle(a: &str, b: &str, lanes: &[usize]) -> String {
    let lanes: Vec<String> = lanes.iter().map(usize::to_string).collect();
    format!("__builtin_shufflevector({a}, {b}, {})", lanes.join(", "))
}

fn name(temp: Temp) -> String {
    format!("x{}", temp.id)
}
