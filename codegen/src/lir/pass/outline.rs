//! A long function as several short ones, one after the other: compilers take time that grows
//! faster than a function's length, and spill more.
//!
//! A value that one piece computes and a later one needs is a field of a struct. A field is reused
//! once its value is no longer needed. Inputs are read where they are needed, and results are
//! written where they are computed.

use std::collections::HashMap;

use crate::lir::lower::is_light;
use crate::lir::{Stmt, Temp};

/// The statements in pieces of `length` that compute, and the number of values kept between them.
/// Inputs and comparisons move to their first use in each piece.
pub(crate) fn outline(statements: Vec<Stmt>, length: usize) -> (Vec<Vec<Stmt>>, usize) {
    let mut light: HashMap<Temp, Stmt> = HashMap::new();
    let mut rest = Vec::with_capacity(statements.len());
    for statement in statements {
        if is_light(&statement) {
            statement.defines(|temp| _ = light.insert(temp, statement.clone()));
        } else {
            rest.push(statement);
        }
    }
    let plan = Plan::of(pieces(rest, length), &light);
    let mut writer = Writer { plan: &plan, light: &light, named: HashMap::new() };
    let written = (0..plan.pieces.len()).map(|c| writer.piece(c)).collect();
    (written, plan.slots)
}

/// The statements in pieces with `length` that define values; at least one piece.
fn pieces(statements: Vec<Stmt>, length: usize) -> Vec<Vec<Stmt>> {
    let (mut pieces, mut defining) = (vec![Vec::new()], 0);
    for statement in statements {
        if matches!(statement, Stmt::Let(..) | Stmt::SinCos { .. } | Stmt::Region(_)) {
            if defining >= length {
                pieces.push(Vec::new());
                defining = 0;
            }
            // A region stays in one piece.
            statement.walk(&mut |_| defining += 1);
        }
        if let Some(piece) = pieces.last_mut() {
            piece.push(statement);
        }
    }
    pieces
}

/// The pieces, and the slots of the values between them.
struct Plan {
    pieces: Vec<Vec<Stmt>>,
    /// The slot of each value that a later piece needs.
    slot: HashMap<Temp, usize>,
    slots: usize,
}

impl Plan {
    fn of(pieces: Vec<Vec<Stmt>>, light: &HashMap<Temp, Stmt>) -> Self {
        let mut last: HashMap<Temp, usize> = HashMap::new();
        for (c, piece) in pieces.iter().enumerate() {
            piece.iter().for_each(|statement| heavy_needs(statement, light, &mut |temp| _ = last.insert(temp, c)));
        }
        let (mut slot, mut places) = (HashMap::new(), Slots::default());
        let mut ends: Vec<Vec<usize>> = vec![Vec::new(); pieces.len()];
        for (c, piece) in pieces.iter().enumerate() {
            for statement in piece {
                statement.defines(|temp| {
                    if let Some(&end) = last.get(&temp).filter(|end| **end > c) {
                        let place = places.take(c);
                        slot.insert(temp, place);
                        ends[end].push(place);
                    }
                });
            }
            places.free.append(&mut ends[c]);
        }
        Self { pieces, slot, slots: places.written.len().max(1) }
    }
}

/// The values that must be kept for a statement: for light ones, those that they are made of.
fn heavy_needs(statement: &Stmt, light: &HashMap<Temp, Stmt>, see: &mut impl FnMut(Temp)) {
    let mut open = Vec::new();
    statement.operands(|operand| open.extend(operand.temp()));
    while let Some(temp) = open.pop() {
        match light.get(&temp) {
            Some(made) => made.operands(|operand| open.extend(operand.temp())),
            None => see(temp),
        }
    }
}

/// Allocator of slots.
#[derive(Default)]
struct Slots {
    free: Vec<usize>,
    /// The piece that wrote each last.
    written: Vec<usize>,
}

const NOWHERE: usize = usize::MAX;

impl Slots {
    /// A slot for piece `c` to write to, and not next to another: a compiler would look for vectors
    /// to build from neighbours.
    fn take(&mut self, c: usize) -> usize {
        let beside = |slot: usize| [slot.wrapping_sub(1), slot + 1].into_iter().any(|k| self.written.get(k) == Some(&c));
        let found = self.free.iter().rposition(|&slot| !beside(slot));
        let slot = match found {
            Some(at) => self.free.remove(at),
            None => self.new_slot(c),
        };
        self.written[slot] = c;
        slot
    }

    fn new_slot(&mut self, c: usize) -> usize {
        if self.written.last() == Some(&c) {
            self.free.push(self.written.len());
            self.written.push(NOWHERE);
        }
        self.written.push(NOWHERE);
        self.written.len() - 1
    }
}

/// The writer of the pieces.
struct Writer<'a> {
    plan: &'a Plan,
    light: &'a HashMap<Temp, Stmt>,
    /// The piece in which each value was defined last.
    named: HashMap<Temp, usize>,
}

impl Writer<'_> {
    fn piece(&mut self, c: usize) -> Vec<Stmt> {
        let mut out = Vec::with_capacity(self.plan.pieces[c].len());
        for statement in &self.plan.pieces[c] {
            statement.operands(|operand| operand.temp().into_iter().for_each(|temp| self.define(&mut out, temp, c)));
            out.push(statement.clone());
            statement.defines(|temp| {
                self.named.insert(temp, c);
                out.extend(self.plan.slot.get(&temp).map(|slot| Stmt::Keep(*slot, temp)));
            });
        }
        out
    }

    /// Defines a value that an earlier piece made, or that can be made again.
    fn define(&mut self, out: &mut Vec<Stmt>, temp: Temp, c: usize) {
        if self.named.insert(temp, c) == Some(c) {
            return;
        }
        match self.light.get(&temp) {
            Some(made) => {
                made.operands(|operand| operand.temp().into_iter().for_each(|temp| self.define(out, temp, c)));
                out.push(made.clone());
            }
            None => out.extend(self.plan.slot.get(&temp).map(|slot| Stmt::Recall(temp, *slot))),
        }
    }
}

#[cfg(test)]
mod tests;
