//! Invariants of a body.

use std::collections::{HashMap, HashSet};

use super::{Body, Expr, Operand, Region, Stmt, Table, TableColumn, Temp, Turns};
use crate::graph::Op;

/// Checks that every operand is defined before its use and once, that comparisons return masks and
/// selections take them, that slots are written before they are read, and that every number of the
/// result is written once.
///
/// # Errors
/// The first statement that breaks a rule, and the rule.
pub fn verify(body: &Body) -> Result<(), String> {
    let mut known = Known::default();
    let mut written: HashSet<usize> = HashSet::new();
    for (piece, statements) in body.pieces.iter().enumerate() {
        // A piece is a function of its own: it sees kept values only.
        (known.values, known.masks, known.slots) = Default::default();
        for (at, statement) in statements.iter().enumerate() {
            let wrong = |what: String| format!("piece {piece}, statement {at} ({statement:?}): {what}");
            known.take(statement).map_err(wrong)?;
            for place in statement.writes() {
                if !written.insert(place) {
                    return Err(wrong(format!("number {place} of the result is stored twice")));
                }
            }
        }
    }
    let numbers: usize = body.results.iter().map(super::Array::numbers).sum();
    match (0..numbers).find(|place| !written.contains(place)) {
        Some(place) if !body.is_partial => Err(format!("number {place} of the result is not stored")),
        _ if written.iter().any(|place| *place >= numbers) => Err(format!("a number beyond the {numbers} of the result is stored")),
        _ => Ok(()),
    }
}

/// The definitions up to a statement.
#[derive(Default)]
struct Known {
    values: HashSet<Temp>,
    masks: HashSet<Temp>,
    /// Columns of tables, each with its length.
    columns: HashMap<Temp, usize>,
    /// Regions whose results are read where they are: their turns, and the results of each.
    results: HashMap<u32, [usize; 2]>,
    slots: HashSet<super::Slot>,
    kept: HashSet<usize>,
}

impl Known {
    fn take(&mut self, statement: &Stmt) -> Result<(), String> {
        if let Stmt::Region(region) = statement {
            self.region(region)?;
        } else if let Stmt::Let(_, Expr::Op(Op::Select, [mask, a, b])) = statement {
            if !self.is_mask(mask) {
                return Err("its first operand is no mask".to_owned());
            }
            [a, b].into_iter().try_for_each(|operand| self.value(operand))?;
        } else {
            let mut found = Ok(());
            statement.operands(|operand| found = found.clone().and_then(|()| self.value(operand)));
            found?;
        }
        match statement {
            Stmt::Recall(_, slot) if !self.kept.contains(slot) => return Err("nothing was kept there".to_owned()),
            Stmt::Load(_, slot) if !self.slots.contains(slot) => return Err("nothing was spilled there".to_owned()),
            Stmt::Keep(slot, _) => _ = self.kept.insert(*slot),
            Stmt::Spill(slot, _) => _ = self.slots.insert(*slot),
            _ => {}
        }
        let mut defined = Vec::new();
        statement.defines(|temp| defined.push(temp));
        for temp in defined {
            let values = if statement.compares() { &mut self.masks } else { &mut self.values };
            if !values.insert(temp) {
                return Err(format!("{temp:?} is defined twice"));
            }
        }
        Ok(())
    }

    /// A region: its body sees its own values alone, and stores nothing.
    fn region(&mut self, region: &Region) -> Result<(), String> {
        let is_where = matches!(region.turns, Turns::Where(_));
        let given: Vec<&Operand> = region.given().collect();
        given[..given.len() - usize::from(is_where)].iter().try_for_each(|operand| self.value(operand))?;
        let mut known = Self { columns: self.columns.clone(), results: self.results.clone(), ..Self::default() };
        known.columns.extend(region.columns.iter().map(|(name, values)| (*name, values.len())));
        let mut define = |temp: Temp| if known.values.insert(temp) { Ok(()) } else { Err(format!("{temp:?} is defined twice")) };
        region.carried.iter().map(|c| c.temp).chain(region.captured.iter().map(|(temp, _)| *temp)).try_for_each(&mut define)?;
        match &region.turns {
            Turns::Where(mask) if !self.is_mask(mask) => return Err("it runs where no mask holds".to_owned()),
            Turns::Each { row, fixed, table, turns, .. } => {
                row.iter().copied().chain(fixed.iter().map(|(temp, _)| *temp)).try_for_each(&mut define)?;
                if let Some((_, column)) = fixed.iter().find(|(_, column)| !self.has(column, *turns)) {
                    return Err(format!("no column {column:?} for {turns} rows"));
                }
                if let Table::Values(values) = table
                    && values.len() != turns * row.len()
                {
                    return Err(format!("a table of {} values for {turns} rows of {}", values.len(), row.len()));
                }
            }
            _ => {}
        }
        for statement in &region.body {
            known.take(statement)?;
            if !statement.writes().is_empty() || matches!(statement, Stmt::Keep(..) | Stmt::Recall(..) | Stmt::Spill(..)) {
                return Err(format!("{statement:?} in a region"));
            }
        }
        region.ends().try_for_each(|operand| known.value(operand))?;
        if let Turns::Each { name, turns, results, is_kept: true, .. } = &region.turns {
            self.results.insert(*name, [*turns, results.len()]);
        }
        match &region.turns {
            Turns::Until { mask: Operand::Temp(mask), .. } if !known.masks.contains(mask) => Err("it ends where no mask holds".to_owned()),
            _ => Ok(()),
        }
    }

    fn has(&self, column: &TableColumn, turns: usize) -> bool {
        match *column {
            TableColumn::Named(name) => self.columns.get(&name) == Some(&turns),
            TableColumn::Results { region, number, first, is_backward } => self.results.get(&region).is_some_and(|[all, own]| {
                let last = if is_backward { first.checked_sub(turns - 1).map(|_| first) } else { Some(first + turns - 1) };
                number < *own && last.is_some_and(|last| last < *all)
            }),
            TableColumn::Argument { first, stride, is_backward, .. } => !is_backward || first >= (turns - 1) * stride,
        }
    }

    fn is_mask(&self, operand: &Operand) -> bool {
        operand.temp().is_some_and(|temp| self.masks.contains(&temp))
    }

    fn value(&self, operand: &Operand) -> Result<(), String> {
        match operand {
            Operand::Temp(temp) if !self.values.contains(temp) => Err(format!("{temp:?} is not defined, or is a mask")),
            Operand::Slot(slot) if !self.slots.contains(slot) => Err(format!("{slot:?} is read and was not written")),
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::Lanes;
    use crate::lir::{Array, Number, Slot, Store, Ty};

    fn body(statements: Vec<Stmt>) -> Body {
        let results = vec![Array { start: 0, lengths: vec![2] }];
        Body {
            ty: Ty::F64,
            lanes: Lanes::default(),
            results,
            pieces: vec![statements],
            kept: 0,
            slots: None,
            barrier: false,
            is_partial: false,
        }
    }

    fn number(id: usize) -> Number {
        Number { of: Operand::Temp(Temp::of(id)), lane: 0 }
    }

    fn right() -> Vec<Stmt> {
        let [x, y, z] = [0, 1, 2].map(|id| Operand::Temp(Temp::of(id)));
        let zero = Operand::Constant(0.0);
        let slot = Slot { is_far: false, number: 0 };
        vec![
            Stmt::Let(Temp::of(0), Expr::Input { argument: 0, index: 0 }),
            Stmt::Let(Temp::of(1), Expr::Op(Op::Positive, [x, zero, zero])),
            Stmt::Spill(slot, Temp::of(0)),
            Stmt::Let(Temp::of(2), Expr::Op(Op::Select, [y, Operand::Slot(slot), zero])),
            Stmt::Let(Temp::of(3), Expr::Op(Op::Add, [z, x, zero])),
            Stmt::Store(Store::One(0, number(3))),
            Stmt::Result(1, number(2)),
        ]
    }

    #[test]
    fn a_body_in_order_is_right() {
        assert_eq!(verify(&body(right())), Ok(()));
    }

    #[test]
    fn every_rule_that_is_broken_is_found() {
        let without = |k: usize| {
            let mut statements = right();
            statements.remove(k);
            verify(&body(statements)).unwrap_err()
        };
        assert!(without(0).contains("is not defined") && without(1).contains("no mask") && without(2).contains("was not written"));
        assert!(without(5).contains("number 0 of the result is not stored"));
        let mut twice = right();
        twice.push(Stmt::Result(0, number(0)));
        assert!(verify(&body(twice)).unwrap_err().contains("stored twice"));
        let mut mask = right();
        mask[5] = Stmt::Store(Store::One(0, number(1)));
        assert!(verify(&body(mask)).unwrap_err().contains("is a mask"));
        let mut again = right();
        again.insert(1, again[0].clone());
        assert!(verify(&body(again)).unwrap_err().contains("defined twice"));
        let mut beyond = right();
        beyond.push(Stmt::Result(2, number(0)));
        assert!(verify(&body(beyond)).unwrap_err().contains("beyond"));
    }
}
