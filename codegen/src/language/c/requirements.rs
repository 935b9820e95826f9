//! The helpers that the functions of a module call, by the statements of their bodies.

use std::collections::{BTreeMap, BTreeSet};

use articulated_core::lanes::Real;

use crate::graph::Op;
use crate::lir::function::Function;
use crate::lir::{Angle, Body, Expr, Number, Operand, Stmt, Store, Turns, Ty};

/// Helpers of one module.
#[derive(Clone, Debug, Default)]
pub(super) struct Requirements {
    /// Mathematical functions, with their suffix for `float`.
    pub(super) math: BTreeSet<String>,
    /// Functions of vectors with a number of each of several states: `k`, `select`, `sqrt`, `atan2`
    /// and `sin_cos`, for each type of numbers that has such vectors.
    pub(super) states: BTreeMap<&'static str, BTreeSet<&'static str>>,
    /// Widths of vectors of limbs.
    pub(super) limbs: BTreeSet<usize>,
    /// Sines of a vector of four angles.
    pub(super) sines_of_limbs: bool,
    /// Sines of four angles that are no vector.
    pub(super) sines_of_four: bool,
}

impl Requirements {
    /// What the functions call. `own_math`: mathematical functions are the module's own.
    pub(super) fn of(functions: &[Function], is_single: bool, batch: &[Real], own_math: bool) -> Self {
        let mut all = Self::default();
        for function in functions {
            for body in [Some(&function.body), function.scalar.as_ref().map(|(body, _)| body)].into_iter().flatten() {
                match body.ty {
                    Ty::Vector(width) => all.add_limbs(body, width),
                    _ => all.add_numbers(body, is_single, own_math),
                }
            }
            let has_results = function.results.iter().any(|array| array.numbers() > 0);
            for (states, real) in
                function.states.iter().filter(|_| has_results).flat_map(|states| batch.iter().map(move |real| (states, *real)))
            {
                all.add_states(&states.body, real);
            }
        }
        if all.sines_of_limbs || all.sines_of_four {
            all.limbs.insert(super::limbs::FOUR);
            all.add_math(["sin", "cos"], false);
        }
        all
    }

    fn add_math<const N: usize>(&mut self, names: [&str; N], is_single: bool) {
        let suffix = if is_single { "f" } else { "" };
        self.math.extend(names.map(|name| format!("{name}{suffix}")));
    }

    /// A body of plain numbers.
    fn add_numbers(&mut self, body: &Body, is_single: bool, own_math: bool) {
        for statement in body.statements() {
            match statement {
                Stmt::Let(_, Expr::Op(op, _)) => function(*op).into_iter().for_each(|name| self.add_math([name], is_single)),
                Stmt::SinCos { angles, alone: false } if !is_single && angles.len() > 2 => self.sines_of_four = true,
                Stmt::SinCos { angles, .. } => angles.iter().for_each(|angle| match angle {
                    Angle { sin: Some(_), cos: Some(_), .. } if own_math => self.add_math(["sin_cos"], is_single),
                    Angle { sin, cos, .. } => {
                        sin.iter().for_each(|_| self.add_math(["sin"], is_single));
                        cos.iter().for_each(|_| self.add_math(["cos"], is_single));
                    }
                }),
                _ => {}
            }
        }
    }

    /// A body of vectors with a lane for each limb.
    fn add_limbs(&mut self, body: &Body, width: usize) {
        self.limbs.insert(width);
        for statement in body.statements() {
            match statement {
                Stmt::Let(_, Expr::Op(op, _)) => function(*op).into_iter().for_each(|name| self.add_math([name], false)),
                Stmt::SinCos { .. } => self.sines_of_limbs = true,
                _ => {}
            }
        }
    }

    /// A body of vectors with a lane for each state.
    fn add_states(&mut self, body: &Body, real: Real) {
        let own = self.states.entry(real.name()).or_default();
        let is_constant = |operand: &Operand| operand.temp().is_none();
        for statement in body.statements() {
            match statement {
                Stmt::Let(_, Expr::Op(op, operands)) => {
                    let first = usize::from(*op == Op::Select);
                    let arity = op.row().arity;
                    let takes_vectors = takes_vectors(*op) || operands[..arity.min(2)].iter().all(is_constant);
                    if *op == Op::Positive || takes_vectors && operands[first.min(arity)..arity].iter().any(is_constant) {
                        own.insert("k");
                    }
                    own.extend(function(*op));
                    own.extend((*op == Op::Select).then_some("select"));
                }
                Stmt::SinCos { angles, .. } => {
                    own.insert("sin_cos");
                    own.extend(angles.iter().any(|angle| is_constant(&angle.angle)).then_some("k"));
                }
                Stmt::Store(Store::One(_, Number { of, .. })) | Stmt::Result(_, Number { of, .. }) => {
                    own.extend(is_constant(of).then_some("k"));
                }
                Stmt::Store(Store::Two(_, numbers)) => own.extend(numbers.iter().any(|n| is_constant(&n.of)).then_some("k")),
                Stmt::Store(Store::Fill(..)) => _ = own.insert("k"),
                Stmt::Region(region) => {
                    let constants = region.given().chain(region.ends()).any(is_constant);
                    let (by_masks, until) = (!matches!(region.turns, Turns::Each { .. }), matches!(region.turns, Turns::Until { .. }));
                    own.extend((constants || until).then_some("k"));
                    own.extend(by_masks.then_some("select"));
                    own.extend(by_masks.then_some("any"));
                }
                _ => {}
            }
        }
        let math: Vec<&str> = [("sqrt", &["sqrt"][..]), ("atan2", &["atan2"]), ("sin_cos", &["sin", "cos"])]
            .into_iter()
            .filter(|(name, _)| own.contains(name))
            .flat_map(|(_, math)| math.iter().copied())
            .collect();
        math.into_iter().for_each(|name| self.add_math([name], real == Real::F32));
    }
}

/// The mathematical function that computes an operation, if it has no operator.
pub(super) fn function(op: Op) -> Option<&'static str> {
    match op {
        Op::Sqrt => Some("sqrt"),
        Op::Sin => Some("sin"),
        Op::Cos => Some("cos"),
        Op::Atan2 => Some("atan2"),
        _ => None,
    }
}

/// Whether an operation of many states takes vectors alone: a function does; an operator takes a
/// number beside a vector.
pub(super) fn takes_vectors(op: Op) -> bool {
    matches!(op, Op::Sqrt | Op::Sin | Op::Cos | Op::Atan2 | Op::Select | Op::Positive)
}
