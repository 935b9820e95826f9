//! Statements as C.

use std::fmt::Write;

use super::requirements::takes_vectors;
use crate::graph::Op;
use crate::lir::function::Argument;
use crate::lir::{Angle, Expr, Number, Operand, Stmt, Store, Temp};

/// How numbers are written in C.
#[derive(Clone)]
pub(super) struct Numbers<'a> {
    /// The type of numbers that are computed with.
    pub(super) computed: String,
    /// The type of numbers that callers have.
    pub(super) outside: &'static str,
    /// Whether literals are of type `float`.
    pub(super) is_single: bool,
    /// Prefix of all names.
    pub(super) prefix: &'a str,
    /// The same, where mathematical functions are the module's own.
    pub(super) own_math: Option<&'a str>,
    /// For values that are vectors, with a number of each of several states.
    pub(super) lanes: Option<Lanes>,
}

/// Vectors with a number of each of several states.
#[derive(Clone)]
pub(super) struct Lanes {
    /// Prefix of the names of their types and functions.
    pub(super) prefix: String,
    /// How far apart two numbers of a state are.
    pub(super) stride: usize,
}

/// Prints the statements of a body.
pub(super) struct Printer<'a> {
    pub(super) arguments: &'a [Argument],
    pub(super) numbers: &'a Numbers<'a>,
    /// Where each number of the result is: the array, and the index there.
    pub(super) places: &'a dyn Fn(usize) -> (String, usize),
}

impl Printer<'_> {
    pub(super) fn statements(&self, out: &mut String, statements: &[Stmt]) {
        statements.iter().for_each(|statement| self.statement(out, statement));
    }

    fn statement(&self, out: &mut String, statement: &Stmt) {
        let real = &self.numbers.computed;
        let _ = match statement {
            Stmt::Let(dst, expression) => {
                let ty = if statement.compares() { &self.mask() } else { real };
                writeln!(out, "    const {ty} {} = {};", name(*dst), self.expression(expression))
            }
            Stmt::SinCos { angles, alone: false } if self.takes_four() && angles.len() > 2 => {
                self.sines_of_four(out, angles);
                Ok(())
            }
            Stmt::SinCos { angles, .. } => {
                angles.iter().for_each(|angle| self.sines(out, angle));
                Ok(())
            }
            Stmt::Keep(slot, temp) => writeln!(out, "    m[{slot}] = {};", name(*temp)),
            Stmt::Recall(temp, slot) => writeln!(out, "    const {real} {} = m[{slot}];", name(*temp)),
            Stmt::Store(Store::Fill(at, count, x)) => {
                (*at..at + count).for_each(|at| {
                    let _ = self.store(out, at, &Number { of: Operand::Constant(*x), lane: 0 });
                });
                Ok(())
            }
            Stmt::Store(Store::One(at, number)) | Stmt::Result(at, number) => self.store(out, *at, number),
            Stmt::Store(Store::Two(at, numbers)) => {
                let _ = self.store(out, *at, &numbers[0]);
                self.store(out, at + 1, &numbers[1])
            }
            Stmt::Region(region) => {
                self.region(out, region);
                Ok(())
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
        let (array, index) = (self.places)(at);
        if let Some(Lanes { prefix, stride }) = &self.numbers.lanes {
            return writeln!(out, "    {prefix}_store({array} + {}, {});", index * stride, self.vector(&number.of));
        }
        let value = self.operand(&number.of);
        let cast = if self.numbers.computed == self.numbers.outside { "" } else { "(float)" };
        writeln!(out, "    {array}[{index}] = {cast}{value};")
    }

    /// The type of comparisons.
    pub(super) fn mask(&self) -> String {
        self.numbers.lanes.as_ref().map_or("int".into(), |lanes| format!("{}_m", lanes.prefix))
    }

    /// An operand that has to be a vector where values are vectors.
    pub(super) fn vector(&self, operand: &Operand) -> String {
        let text = self.operand(operand);
        match &self.numbers.lanes {
            Some(lanes) if operand.temp().is_none() => format!("{}_k({text})", lanes.prefix),
            _ => text,
        }
    }

    /// Whether sines of several angles of one state are computed together.
    fn takes_four(&self) -> bool {
        self.numbers.lanes.is_none() && self.numbers.computed == "double"
    }

    /// Three or four angles in one vector.
    fn sines_of_four(&self, out: &mut String, angles: &[Angle]) {
        for angles in angles.chunks(4) {
            let last = angles.len() - 1;
            let four: Vec<String> = (0..4).map(|k| self.operand(&angles[k.min(last)].angle)).collect();
            let first = angles.iter().find_map(|a| a.sin.or(a.cos)).map(name).unwrap_or_default();
            let prefix = self.numbers.prefix;
            let _ = writeln!(out, "    double {first}_sines[4], {first}_cosines[4];");
            let (list, n) = (four.join(", "), angles.len());
            let _ = writeln!(out, "    {prefix}_sin_cos_of_four({list}, {n}, {first}_sines, {first}_cosines);");
            for (k, angle) in angles.iter().enumerate() {
                for (dst, array) in [(angle.sin, "sines"), (angle.cos, "cosines")] {
                    if let Some(dst) = dst {
                        let _ = writeln!(out, "    const double {} = {first}_{array}[{k}];", name(dst));
                    }
                }
            }
        }
    }

    fn sines(&self, out: &mut String, angle: &Angle) {
        let (real, of) = (&self.numbers.computed, self.vector(&angle.angle));
        let has_both = self.numbers.own_math.is_some() && angle.sin.is_some() && angle.cos.is_some();
        if has_both || self.numbers.lanes.is_some() {
            let name_of = |temp: Option<Temp>, other: Option<Temp>, what| {
                temp.map_or_else(|| format!("{}_{what}", other.map(name).unwrap_or_default()), name)
            };
            let (sin, cos) = (name_of(angle.sin, angle.cos, "sin"), name_of(angle.cos, angle.sin, "cos"));
            let call = self.call("sin_cos", &format!("{of}, &{cos}"));
            let _ = match angle.sin {
                Some(_) => writeln!(out, "    {real} {cos};\n    const {real} {sin} = {call};"),
                None => writeln!(out, "    {real} {cos};\n    (void){call};"),
            };
            return;
        }
        for (dst, function) in [(angle.sin, "sin"), (angle.cos, "cos")] {
            if let Some(dst) = dst {
                let _ = writeln!(out, "    const {real} {} = {};", name(dst), self.call(function, &of));
            }
        }
    }

    /// A call of the mathematical library.
    pub(super) fn call(&self, function: &str, operands: &str) -> String {
        if let Some(lanes) = &self.numbers.lanes {
            return format!("{}_{function}({operands})", lanes.prefix);
        }
        let prefix = self.numbers.own_math.map_or(String::new(), |prefix| format!("{prefix}_"));
        format!("{prefix}{function}{}({operands})", if self.numbers.is_single { "f" } else { "" })
    }

    fn expression(&self, expression: &Expr) -> String {
        match expression {
            Expr::Input { argument, index } => {
                let name = self.arguments[*argument as usize].name;
                match &self.numbers.lanes {
                    Some(Lanes { prefix, stride }) => format!("{prefix}_load({name} + {})", *index as usize * stride),
                    None => format!("{name}[{index}]"),
                }
            }
            Expr::Op(op, operands) => self.operation(*op, operands),
            Expr::LaneInput { .. } | Expr::Broadcast(_) => unreachable!("C has numbers alone: {expression:?}"),
        }
    }

    fn operation(&self, op: Op, operands: &[Operand; 3]) -> String {
        let [mut a, mut b, mut c] = operands.map(|o| self.operand(&o));
        let arity = op.row().arity;
        if self.numbers.lanes.is_some() && (takes_vectors(op) || operands[..arity.min(2)].iter().all(|o| o.temp().is_none())) {
            let first = usize::from(op == Op::Select);
            for (k, text) in [&mut a, &mut b, &mut c].into_iter().enumerate().take(arity).skip(first) {
                *text = self.vector(&operands[k]);
            }
        }
        match op {
            Op::Sqrt => self.call("sqrt", &a),
            Op::Sin => self.call("sin", &a),
            Op::Cos => self.call("cos", &a),
            Op::Atan2 => self.call("atan2", &format!("{a}, {b}")),
            Op::Positive => format!("{a} > {}", self.vector(&Operand::Constant(0.0))),
            Op::Select if self.numbers.lanes.is_some() => self.call("select", &format!("{a}, {b}, {c}")),
            Op::Select => format!("{a} ? {b} : {c}"),
            _ => operator(op, &a, &b, &c).unwrap_or(a),
        }
    }

    pub(super) fn operand(&self, operand: &Operand) -> String {
        match operand {
            Operand::Temp(temp) => name(*temp),
            Operand::Constant(x) => self.literal(*x),
            Operand::Lanes(_) | Operand::Slot(_) => unreachable!("C has numbers alone: {operand:?}"),
        }
    }

    fn literal(&self, x: f64) -> String {
        let text = if self.numbers.is_single { format!("{:?}f", x as f32) } else { format!("{x:?}") };
        let infinity = infinity(self.numbers.own_math);
        match x {
            _ if x.is_nan() => format!("({infinity} - {infinity})"),
            f64::INFINITY => infinity,
            f64::NEG_INFINITY => format!("(-{infinity})"),
            _ if x < 0.0 => format!("({text})"),
            _ => text,
        }
    }
}

/// Operations that C has operators for, of numbers and of vectors.
pub(super) fn operator(op: Op, a: &str, b: &str, c: &str) -> Option<String> {
    Some(match op {
        Op::Add => format!("{a} + {b}"),
        Op::Sub => format!("{a} - {b}"),
        Op::Mul => format!("{a} * {b}"),
        Op::Div => format!("{a} / {b}"),
        Op::Neg => format!("-{a}"),
        // Compilers contract these where the processor has the instruction, and are allowed to.
        Op::MulAdd => format!("{a} * {b} + {c}"),
        Op::MulSub => format!("{a} * {b} - {c}"),
        Op::NegMulAdd => format!("{c} - {a} * {b}"),
        Op::NegMulSub => format!("-({a} * {b}) - {c}"),
        _ => return None,
    })
}

/// The macro for infinity: of `math.h`, or the module's own.
pub(super) fn infinity(own_math: Option<&str>) -> String {
    own_math.map_or_else(|| "INFINITY".to_owned(), |prefix| format!("{}_INFINITY", prefix.to_ascii_uppercase()))
}

pub(super) fn name(temp: Temp) -> String {
    format!("x{}", temp.id)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn operations_are_those_of_c() {
        let value = |id: usize| Operand::Temp(Temp::of(id));
        let zero = Operand::Constant(0.0);
        let [x, y, third] = [value(0), value(1), Operand::Constant(-0.1)];
        let of = |is_single, op, operands| {
            let places = |_: usize| ("out".to_owned(), 0);
            let numbers = Numbers { computed: "double".into(), outside: "double", is_single, prefix: "arm", own_math: None, lanes: None };
            Printer { arguments: &[], numbers: &numbers, places: &places }.operation(op, &operands)
        };
        assert_eq!(of(false, Op::NegMulAdd, [x, y, third]), "(-0.1) - x0 * x1");
        assert_eq!(of(false, Op::NegMulSub, [x, y, third]), "-(x0 * x1) - (-0.1)");
        assert_eq!(of(false, Op::Select, [x, y, third]), "x0 ? x1 : (-0.1)");
        assert_eq!(of(true, Op::Atan2, [x, third, zero]), "atan2f(x0, (-0.1f))");
        assert_eq!(of(false, Op::Positive, [x, zero, zero]), "x0 > 0.0");
    }

    /// Operators take a vector and a number, functions take vectors alone.
    #[test]
    fn operations_of_many_states_are_those_of_vectors() {
        let [x, y, half] = [Operand::Temp(Temp::of(0)), Operand::Temp(Temp::of(1)), Operand::Constant(0.5)];
        let of = |op, operands| {
            let places = |at: usize| ("out".to_owned(), at);
            let lanes = Some(Lanes { prefix: "arm_f32".into(), stride: 16 });
            let numbers =
                Numbers { computed: "arm_f32_v".into(), outside: "float", is_single: true, prefix: "arm", own_math: Some("arm"), lanes };
            Printer { arguments: &[], numbers: &numbers, places: &places }.operation(op, &operands)
        };
        assert_eq!(of(Op::MulAdd, [x, half, half]), "x0 * 0.5f + 0.5f");
        assert_eq!(of(Op::Select, [x, y, half]), "arm_f32_select(x0, x1, arm_f32_k(0.5f))");
        assert_eq!(of(Op::Sqrt, [half, x, x]), "arm_f32_sqrt(arm_f32_k(0.5f))");
        assert_eq!(of(Op::Positive, [x, y, y]), "x0 > arm_f32_k(0.0f)");
    }
}
