//! A body in doubles: the oracle of every pass and target.

use std::collections::HashMap;

use super::{Body, Carried, Expr, Number, Operand, Region, Slot, Stmt, Store, Table, TableColumn, Temp, Turns};
use crate::graph::{MOST, Op, Value, operation};

/// The numbers of the result, and NaN where a partial body stores none; `input(argument, index)`
/// gives the inputs. Every number is an `f64`, whatever the body's type, and a multiply-add is a
/// product and a sum.
///
/// # Panics
/// If the body breaks a rule of [`super::verify`].
pub fn interpret(body: &Body, input: impl Fn(usize, usize) -> f64) -> Vec<f64> {
    let numbers = body.results.iter().map(super::Array::numbers).sum();
    let mut machine = Machine {
        body,
        input,
        out: vec![f64::NAN; numbers],
        values: HashMap::new(),
        columns: HashMap::new(),
        results: HashMap::new(),
        slots: HashMap::new(),
        kept: vec![[f64::NAN; MOST]; body.kept],
    };
    for piece in &body.pieces {
        machine.values.clear();
        machine.slots.clear();
        piece.iter().for_each(|statement| machine.step(statement));
    }
    machine.out
}

struct Machine<'a, F> {
    body: &'a Body,
    input: F,
    out: Vec<f64>,
    values: HashMap<Temp, Value>,
    columns: HashMap<Temp, Vec<Value>>,
    /// The results of regions, turn by turn.
    results: HashMap<u32, Vec<Vec<Value>>>,
    slots: HashMap<Slot, Value>,
    kept: Vec<Value>,
}

impl<F: Fn(usize, usize) -> f64> Machine<'_, F> {
    fn step(&mut self, statement: &Stmt) {
        match statement {
            Stmt::Let(dst, expression) => {
                let value = self.expression(expression);
                _ = self.values.insert(*dst, value);
            }
            Stmt::SinCos { angles, .. } => {
                for angle in angles {
                    let value = self.operand(angle.angle);
                    for (dst, of) in [(angle.sin, f64::sin as fn(f64) -> f64), (angle.cos, f64::cos)] {
                        if let Some(dst) = dst {
                            _ = self.values.insert(dst, value.map(of));
                        }
                    }
                }
            }
            Stmt::Thirds { dst, argument, first } => {
                for (k, dst) in dst.iter().enumerate() {
                    let value = std::array::from_fn(|lane| (self.input)(*argument as usize, *first as usize + 3 * lane + k));
                    _ = self.values.insert(*dst, value);
                }
            }
            Stmt::SumLanes(dst, operands) => {
                let sum = |lane: usize| self.sum(operands[lane.min(operands.len() - 1)]);
                let value = std::array::from_fn(sum);
                _ = self.values.insert(*dst, value);
            }
            Stmt::Keep(slot, temp) => self.kept[*slot] = self.values[temp],
            Stmt::Recall(dst, slot) => _ = self.values.insert(*dst, self.kept[*slot]),
            Stmt::Spill(slot, temp) => _ = self.slots.insert(*slot, self.values[temp]),
            Stmt::Load(dst, slot) => _ = self.values.insert(*dst, self.slots[slot]),
            Stmt::Store(store) => self.store(store),
            Stmt::Result(at, number) => self.out[*at] = self.number(number),
            Stmt::Region(region) => self.region(region),
        }
    }

    /// Runs a region. Lanes are those of limbs, which regions do not have.
    fn region(&mut self, region: &Region) {
        for Carried { temp, start, .. } in &region.carried {
            self.values.insert(*temp, self.operand(*start));
        }
        for (temp, of) in &region.captured {
            self.values.insert(*temp, self.operand(*of));
        }
        for (name, values) in &region.columns {
            let column = values.iter().map(|value| self.operand(*value)).collect();
            self.columns.insert(*name, column);
        }
        match &region.turns {
            Turns::Until { most, mask, held } => {
                let ends = (0..*most).any(|_| {
                    self.turn(region);
                    self.operand(*mask)[0] > 0.0
                });
                self.values.insert(*held, [f64::from(u8::from(ends)); MOST]);
            }
            Turns::Where(mask) => {
                if self.operand(*mask)[0] > 0.0 {
                    self.turn(region);
                }
            }
            Turns::Each { name, table, row, fixed, results, turns, read, stored, .. } => {
                self.results.insert(*name, Vec::new());
                for turn in 0..*turns {
                    for (temp, column) in fixed {
                        let place = column.place(turn);
                        let value = match *column {
                            TableColumn::Named(name) => self.columns[&name][place],
                            TableColumn::Results { region, number, .. } => self.results[&region][place][number],
                            TableColumn::Argument { argument, .. } => [(self.input)(argument as usize, place); MOST],
                        };
                        self.values.insert(*temp, value);
                    }
                    for (k, temp) in row.iter().enumerate() {
                        let place = turn * row.len() + k;
                        let value = match table {
                            Table::Values(values) => self.operand(values[place]),
                            Table::Argument(argument) => [(self.input)(*argument as usize, place); MOST],
                        };
                        self.values.insert(*temp, value);
                    }
                    let found = self.turn(region);
                    debug_assert_eq!(found.len(), region.carried.len() + results.len());
                    if let Some(stored) = stored {
                        let first = stored.of_turn(turn, (*turns, results.len()));
                        found[region.carried.len()..].iter().enumerate().for_each(|(k, value)| self.out[first + k] = value[0]);
                    }
                    for (_, k, temp) in read.iter().filter(|(at, ..)| *at == turn) {
                        self.values.insert(*temp, found[region.carried.len() + k]);
                    }
                    self.results.entry(*name).or_default().push(found[region.carried.len()..].to_vec());
                }
            }
        }
        for (temp, last) in &region.after {
            self.values.insert(*temp, self.values[last]);
        }
    }

    /// One turn; returns the values of its end.
    fn turn(&mut self, region: &Region) -> Vec<Value> {
        region.body.iter().for_each(|statement| self.step(statement));
        let ends: Vec<Value> = region.ends().map(|operand| self.operand(*operand)).collect();
        for (carried, end) in region.carried.iter().zip(&ends) {
            self.values.insert(carried.temp, *end);
        }
        ends
    }

    fn store(&mut self, store: &Store) {
        match store {
            Store::One(at, number) => self.out[*at] = self.number(number),
            Store::Two(at, numbers) => numbers.iter().enumerate().for_each(|(k, number)| self.out[at + k] = self.number(number)),
            Store::Fill(at, count, x) => self.out[*at..at + count].fill(*x),
            Store::Whole(at, operand) => {
                let lanes = self.operand(*operand);
                self.out[*at..at + MOST].copy_from_slice(&lanes);
            }
            Store::Rows(rows, columns) => {
                for (lane, at) in rows.starts().into_iter().enumerate() {
                    for (k, column) in columns.iter().enumerate() {
                        self.out[at + k] = self.operand(*column)[lane];
                    }
                }
            }
        }
    }

    fn expression(&self, expression: &Expr) -> Value {
        match expression {
            Expr::Input { argument, index } => [(self.input)(*argument as usize, *index as usize); MOST],
            Expr::LaneInput { argument, indices } => {
                let indices = self.body.lanes.input(*indices);
                std::array::from_fn(|lane| (self.input)(*argument as usize, indices[lane % indices.len()] as usize))
            }
            Expr::Broadcast(number) => [self.number(number); MOST],
            Expr::Op(Op::ReduceAdd, [a, ..]) => [self.sum(*a); MOST],
            Expr::Op(op, operands) => {
                let arity = op.row().arity;
                let [a, b, c] = std::array::from_fn(|k| if k < arity { self.operand(operands[k]) } else { [0.0; MOST] });
                std::array::from_fn(|lane| operation(*op, [a[lane], b[lane], c[lane]]))
            }
        }
    }

    /// The sum of the lanes that the type has.
    fn sum(&self, operand: Operand) -> f64 {
        self.operand(operand)[..self.body.ty.lanes()].iter().sum()
    }

    fn number(&self, number: &Number) -> f64 {
        self.operand(number.of)[number.lane]
    }

    fn operand(&self, operand: Operand) -> Value {
        match operand {
            Operand::Temp(temp) => self.values[&temp],
            Operand::Constant(x) => [x; MOST],
            Operand::Lanes(number) => self.body.lanes.constant(number),
            Operand::Slot(slot) => self.slots[&slot],
        }
    }
}
