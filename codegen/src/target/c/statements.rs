//! Statements as C.

use std::fmt::Write;

use crate::graph::Op;
use crate::lir::function::Argument;
use crate::lir::{Angle, Body, Expr, Number, Operand, Stmt, Store, Temp, Ty};

/// The types of C for numbers that are computed with and numbers that callers have.
#[derive(Clone, Copy)]
pub(super) struct Reals {
    pub(super) computed: &'static str,
    pub(super) outside: &'static str,
}

/// Prints the statements of a body.
pub(super) struct Printer<'a> {
    pub(super) body: &'a Body,
    pub(super) arguments: &'a [Argument],
    pub(super) reals: Reals,
    /// What the names of mathematical functions begin with where they are the module's own.
    pub(super) own_math: Option<&'a str>,
    /// Where each number of the result is.
    pub(super) places: &'a dyn Fn(usize) -> String,
}

impl Printer<'_> {
    pub(super) fn statements(&self, out: &mut String, statements: &[Stmt]) {
        statements.iter().for_each(|statement| self.statement(out, statement));
    }

    fn statement(&self, out: &mut String, statement: &Stmt) {
        let real = self.reals.computed;
        let _ = match statement {
            Stmt::Let(dst, expression) => {
                let ty = if statement.compares() { "int" } else { real };
                writeln!(out, "    const {ty} {} = {};", name(*dst), self.expression(expression))
            }
            Stmt::SinCos { angles, .. } => {
                angles.iter().for_each(|angle| self.sines(out, angle));
                Ok(())
            }
            Stmt::Keep(slot, temp) => writeln!(out, "    m[{slot}] = {};", name(*temp)),
            Stmt::Recall(temp, slot) => writeln!(out, "    const {real} {} = m[{slot}];", name(*temp)),
            Stmt::Store(Store::Fill(at, count, x)) => {
                (*at..at + count).for_each(|at| {
                    let _ = writeln!(out, "    {} = {};", (self.places)(at), self.literal(*x));
                });
                Ok(())
            }
            Stmt::Store(Store::One(at, number)) | Stmt::Result(at, number) => self.store(out, *at, number),
            Stmt::Store(Store::Two(at, numbers)) => {
                let _ = self.store(out, *at, &numbers[0]);
                self.store(out, at + 1, &numbers[1])
            }
            // The capabilities of C have neither vectors nor spill slots.
            Stmt::Thirds { .. }
            | Stmt::SumLanes(..)
            | Stmt::Spill(..)
            | Stmt::Load(..)
            | Stmt::Store(Store::Whole(..) | Store::Rows(..)) => unreachable!("C has numbers alone: {statement:?}"),
        };
    }

    fn store(&self, out: &mut String, at: usize, number: &Number) -> std::fmt::Result {
        let value = self.operand(&number.of);
        let cast = if self.reals.computed == self.reals.outside { "" } else { "(float)" };
        writeln!(out, "    {} = {cast}{value};", (self.places)(at))
    }

    fn sines(&self, out: &mut String, angle: &Angle) {
        let (real, of) = (self.reals.computed, self.operand(&angle.angle));
        if let (Some(_), Some(sin), Some(cos)) = (self.own_math, angle.sin, angle.cos) {
            let (cos, both) = (name(cos), format!("{of}, &{}", name(cos)));
            let _ = writeln!(out, "    {real} {cos};\n    const {real} {} = {};", name(sin), self.call("sin_cos", &both));
            return;
        }
        for (dst, function) in [(angle.sin, "sin"), (angle.cos, "cos")] {
            if let Some(dst) = dst {
                let _ = writeln!(out, "    const {real} {} = {};", name(dst), self.call(function, &of));
            }
        }
    }

    /// A call of the mathematical library.
    fn call(&self, function: &str, operands: &str) -> String {
        let prefix = self.own_math.map_or(String::new(), |prefix| format!("{prefix}_"));
        format!("{prefix}{function}{}({operands})", if self.body.ty == Ty::F32 { "f" } else { "" })
    }

    fn expression(&self, expression: &Expr) -> String {
        match expression {
            Expr::Input { argument, index } => {
                let argument = &self.arguments[*argument as usize];
                format!("{}[{index}]", argument.name)
            }
            Expr::Op(op, operands) => self.operation(*op, operands),
            Expr::LaneInput { .. } | Expr::Broadcast(_) => unreachable!("C has numbers alone: {expression:?}"),
        }
    }

    fn operation(&self, op: Op, operands: &[Operand; 3]) -> String {
        let [a, b, c] = operands.map(|o| self.operand(&o));
        match op {
            Op::Add => format!("{a} + {b}"),
            Op::Sub => format!("{a} - {b}"),
            Op::Mul => format!("{a} * {b}"),
            Op::Div => format!("{a} / {b}"),
            Op::Neg => format!("-{a}"),
            Op::Sqrt => self.call("sqrt", &a),
            Op::Sin => self.call("sin", &a),
            Op::Cos => self.call("cos", &a),
            Op::Atan2 => self.call("atan2", &format!("{a}, {b}")),
            Op::Positive => format!("{a} > 0"),
            Op::Select => format!("{a} ? {b} : {c}"),
            // Compilers contract these where the processor has the instruction, and are allowed to.
            Op::MulAdd => format!("{a} * {b} + {c}"),
            Op::MulSub => format!("{a} * {b} - {c}"),
            Op::NegMulAdd => format!("{c} - {a} * {b}"),
            Op::NegMulSub => format!("-({a} * {b}) - {c}"),
            Op::Constant | Op::Input | Op::LaneConstant | Op::LaneInput | Op::Broadcast | Op::ReduceAdd => a,
        }
    }

    fn operand(&self, operand: &Operand) -> String {
        match operand {
            Operand::Temp(temp) => name(*temp),
            Operand::Constant(x) => self.literal(*x),
            Operand::Lanes(_) | Operand::Slot(_) => unreachable!("C has numbers alone: {operand:?}"),
        }
    }

    fn literal(&self, x: f64) -> String {
        let text = if self.body.ty == Ty::F32 { format!("{:?}f", x as f32) } else { format!("{x:?}") };
        let infinity = infinity(self.own_math);
        match x {
            _ if x.is_nan() => format!("({infinity} - {infinity})"),
            f64::INFINITY => infinity,
            f64::NEG_INFINITY => format!("(-{infinity})"),
            _ if x < 0.0 => format!("({text})"),
            _ => text,
        }
    }
}

/// The macro for infinity: of `math.h`, or the module's own.
pub(super) fn infinity(own_math: Option<&str>) -> String {
    own_math.map_or_else(|| "INFINITY".to_owned(), |prefix| format!("{}_INFINITY", prefix.to_ascii_uppercase()))
}

fn name(temp: Temp) -> String {
    format!("x{}", temp.id)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::Lanes;
    use crate::lir::Array;

    #[test]
    fn operations_are_those_of_c() {
        let value = |id: usize| Operand::Temp(Temp::of(id));
        let zero = Operand::Constant(0.0);
        let [x, y, third] = [value(0), value(1), Operand::Constant(-0.1)];
        let of = |ty, op, operands| {
            let body = Body {
                ty,
                lanes: Lanes::default(),
                results: vec![Array { start: 0, lengths: Vec::new() }],
                pieces: Vec::new(),
                kept: 0,
                slots: None,
                barrier: false,
                is_partial: true,
            };
            let places = |_: usize| "*out".to_owned();
            let reals = Reals { computed: "double", outside: "double" };
            Printer { body: &body, arguments: &[], reals, own_math: None, places: &places }.operation(op, &operands)
        };
        assert_eq!(of(Ty::F64, Op::NegMulAdd, [x, y, third]), "(-0.1) - x0 * x1");
        assert_eq!(of(Ty::F64, Op::NegMulSub, [x, y, third]), "-(x0 * x1) - (-0.1)");
        assert_eq!(of(Ty::F64, Op::Select, [x, y, third]), "x0 ? x1 : (-0.1)");
        assert_eq!(of(Ty::F32, Op::Atan2, [x, third, zero]), "atan2f(x0, (-0.1f))");
        assert_eq!(of(Ty::F64, Op::Positive, [x, zero, zero]), "x0 > 0");
    }
}
