//! The helpers that bodies and other helpers call by name.

use std::collections::HashSet;

use crate::language::rust::several;
use crate::language::rust::statements::function;
use crate::lir::{Body, Expr, Operand, Rows, Stmt, Store, Turns, Ty};

/// Names of functions that are called.
#[derive(Clone, Debug, Default)]
pub(crate) struct Requirements(HashSet<String>);

impl Requirements {
    /// Whether a function of this name is called.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.0.contains(name)
    }

    /// Adds all words of the text of a helper.
    pub(crate) fn add_helper(&mut self, text: &str) {
        let words = text.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|word| !word.is_empty());
        self.0.extend(words.map(str::to_owned));
    }

    /// Adds the functions that the statements of a body of vectors call.
    pub(crate) fn add_body(&mut self, body: &Body) {
        if !matches!(body.ty, Ty::Vector(_) | Ty::States) {
            return;
        }
        // Values passed between pieces are initialised with zeros.
        self.add(["k"]);
        for statement in body.statements() {
            match statement {
                Stmt::Region(region) => match region.turns {
                    Turns::Until { .. } => self.add(["positive", "select", "sub", "any"]),
                    Turns::Where(_) => self.add(["select", "any"]),
                    Turns::Each { .. } => {}
                },
                Stmt::Let(_, Expr::Op(op, _)) => self.add([function(*op)]),
                Stmt::Let(_, Expr::LaneInput { .. }) => self.add(["lanes"]),
                Stmt::Let(_, Expr::Broadcast(_)) => self.add(["lane"]),
                Stmt::SinCos { angles, .. } => self.add([several::name(angles.len())]),
                Stmt::Thirds { .. } => self.add(["every_third"]),
                Stmt::SumLanes(_, operands) => self.add([if operands.len() == 2 { "reduce_add_of_two" } else { "reduce_add_of_four" }]),
                Stmt::Store(Store::One(..)) => self.add(["put_one", "lane"]),
                Stmt::Store(Store::Two(..)) => self.add(["put_two", "store", "lanes", "lane"]),
                Stmt::Store(Store::Whole(..)) => self.add(["put"]),
                Stmt::Store(Store::Rows(rows, _)) => self.add([match rows {
                    Rows::InTurn(_) => "put_in_turn",
                    Rows::Fours(_) => "put_fours",
                    Rows::Twos(_) => "put_twos",
                }]),
                Stmt::Result(..) => self.add(["lane"]),
                _ => {}
            }
            let mut has_lanes = false;
            statement.operands(|operand| has_lanes |= matches!(operand, Operand::Lanes(_)));
            if has_lanes {
                self.add(["lanes"]);
            }
        }
    }

    fn add<const N: usize>(&mut self, names: [&str; N]) {
        self.0.extend(names.into_iter().filter(|name| !name.is_empty()).map(str::to_owned));
    }
}
