//! Regions as Rust: loops, and statements that run where a mask holds.
//!
//! Of several states, a lane whose iteration is over keeps its values. The loop ends when no lane
//! is left.

use std::fmt::Write;

use crate::language::rust::literal::bare;
use crate::language::rust::statements::{Printer, name, ty};
use crate::language::{factor, in_turn, stored_turn};
use crate::lir::function::Argument;
use crate::lir::{Carried, Operand, Region, Table, Temp, Turns, Ty};

impl Printer<'_> {
    /// A region. `define`: as for other statements.
    pub(super) fn region(&self, out: &mut String, region: &Region, define: &str) {
        for Carried { temp, start, .. } in &region.carried {
            // A number of two parts keeps its brackets.
            let start = self.operand(start);
            let start = if start.contains(',') { &start } else { bare(&start) };
            let _ = writeln!(out, "    let mut {} = {start};", name(*temp));
        }
        for (column, values) in &region.columns {
            let list: Vec<String> = values.iter().map(|value| self.operand(value)).collect();
            let _ = writeln!(out, "    let {}_column = [{}];", name(*column), list.join(", "));
        }
        let mut inside = String::new();
        for (temp, of) in &region.captured {
            let _ = writeln!(inside, "    let {} = {};", name(*temp), self.operand(of));
        }
        let is_states = self.body.ty == Ty::States;
        match &region.turns {
            Turns::Until { most, mask, held } => {
                let (held, one) = (name(*held), self.operand(&Operand::Constant(1.0)));
                // Of several states it decides which are left.
                let is_read = is_states || region.is_held_read();
                if is_read {
                    let _ = writeln!(out, "    let mut {held} = {};", self.operand(&Operand::Constant(0.0)));
                }
                let ends = if is_read { format!("    {held} = {one};\n    break;\n") } else { "    break;\n".to_owned() };
                self.statements(&mut inside, &region.body);
                if is_states {
                    let _ = writeln!(inside, "    let {held}_done = positive({held});");
                    self.end_of_turn(&mut inside, region, |old, new| format!("select({held}_done, {old}, {new})"));
                } else {
                    self.end_of_turn(&mut inside, region, |_, new| new.to_owned());
                }
                match mask {
                    Operand::Constant(0.0) => {}
                    Operand::Constant(_) => inside += &ends,
                    _ if is_states => {
                        let _ = writeln!(inside, "    {held} = select({}, {one}, {held});", self.operand(mask));
                        let _ = writeln!(inside, "    if !any(positive(sub({one}, {held}))) {{\n        break;\n    }}");
                    }
                    _ => {
                        let _ = writeln!(inside, "    if {} {{\n{}    }}", self.operand(mask), indented(&ends));
                    }
                }
                let _ = writeln!(out, "    for _ in 0..{most} {{\n{}    }}", indented(&inside));
            }
            Turns::Where(mask) => {
                let mask = self.operand(mask);
                self.statements(&mut inside, &region.body);
                if is_states {
                    self.end_of_turn(&mut inside, region, |old, new| format!("select({mask}, {new}, {old})"));
                    let _ = writeln!(out, "    if any({mask}) {{\n{}    }}", indented(&inside));
                } else {
                    self.end_of_turn(&mut inside, region, |_, new| new.to_owned());
                    let _ = writeln!(out, "    if {mask} {{\n{}    }}", indented(&inside));
                }
            }
            Turns::Each { name: number, table, row, fixed, results, turns, read, stored, is_kept } => {
                let (turn, is_read) = (format!("x{number}_turn"), !read.is_empty() || *is_kept);
                for (temp, column) in fixed {
                    let _ = writeln!(
                        inside,
                        "    let {} = {};",
                        name(*temp),
                        in_turn(column, &turn, name, |argument, at| self.number_of(argument, at))
                    );
                }
                if !row.is_empty() {
                    inside = self.rows(out, (table, row), (*number, &turn)) + &inside;
                }
                if is_read {
                    let (ty, zero) = ty(self.body.ty);
                    let count = results.len();
                    let _ = writeln!(out, "    let mut x{number}_results: [[{ty}; {count}]; {turns}] = [[{zero}; {count}]; {turns}];");
                }
                self.statements(&mut inside, &region.body);
                if is_read {
                    let list: Vec<String> = results.iter().map(|value| self.operand(value)).collect();
                    let _ = writeln!(inside, "    x{number}_results[{turn}] = [{}];", list.join(", "));
                }
                if let Some(stored) = stored {
                    self.store_turn(&mut inside, stored.first, results, &stored_turn(*stored, &turn, *turns));
                }
                self.end_of_turn(&mut inside, region, |_, new| new.to_owned());
                let turn = if is_read || stored.is_some() || !row.is_empty() || !fixed.is_empty() { &turn } else { "_" };
                let _ = writeln!(out, "    for {turn} in 0..{turns} {{\n{}    }}", indented(&inside));
                for (turn, k, temp) in read {
                    let _ = writeln!(out, "    {define}{} = x{number}_results[{turn}][{k}];", name(*temp));
                }
            }
        }
        for (temp, last) in &region.after {
            let _ = writeln!(out, "    {define}{} = {};", name(*temp), name(*last));
        }
    }

    /// Declares the rows before the loop, and returns the statements that read one.
    fn rows(&self, out: &mut String, (table, row): (&Table, &[Temp]), (number, turn): (u32, &str)) -> String {
        let names: Vec<String> = row.iter().map(|temp| name(*temp)).collect();
        let argument = match table {
            Table::Values(values) => {
                let _ = writeln!(out, "    let x{number}_rows = [");
                for values in values.chunks(row.len()) {
                    let list: Vec<String> = values.iter().map(|value| self.operand(value)).collect();
                    let _ = writeln!(out, "        [{}],", list.join(", "));
                }
                let _ = writeln!(out, "    ];");
                return format!("    let [{}] = x{number}_rows[{turn}];\n", names.join(", "));
            }
            Table::Argument(argument) => &self.arguments[*argument as usize],
        };
        let width = row.len();
        if self.body.ty == Ty::States {
            let read = |(k, name): (usize, &String)| format!("    let {name} = at(&{}[{turn} * {width} + {k}], part);\n", argument.name);
            return names.iter().enumerate().map(read).collect();
        }
        let slice = flattened(argument);
        let _ = writeln!(out, "    let x{number}_rows = {}{slice}.as_chunks::<{width}>().0;", argument.name);
        format!("    let [{}] = x{number}_rows[{turn}];\n", names.join(", "))
    }

    /// A number of an argument.
    fn number_of(&self, argument: u32, at: &str) -> String {
        let argument = &self.arguments[argument as usize];
        match self.body.ty {
            Ty::States => format!("at(&{}[{at}], part)", argument.name),
            _ => format!("{}{}[{at}]", argument.name, flattened(argument)),
        }
    }

    /// Stores the results of a turn behind those of the turns before it.
    fn store_turn(&self, out: &mut String, first: usize, results: &[Operand], turn: &str) {
        let (place, width) = ((self.places)(first), results.len());
        let is_matrix = self.body.results.iter().any(|array| array.start == first && array.lengths.len() == 2);
        for (k, value) in results.iter().enumerate() {
            let value = self.operand(value);
            let to = match place.index {
                Some(0) if is_matrix => format!("{}[{turn}][{k}]", place.array.strip_suffix("[0]").unwrap_or(&place.array)),
                index => format!("{}[{} + {} * {width}]", place.array, index.unwrap_or(0) + k, factor(turn)),
            };
            let _ = match self.body.ty {
                Ty::States => writeln!(out, "    put(&mut {to}, part, {value});"),
                _ => writeln!(out, "    {to} = {};", bare(&value)),
            };
        }
    }

    /// All carried values change at once.
    fn end_of_turn(&self, out: &mut String, region: &Region, value: impl Fn(&str, &str) -> String) {
        let changes = region.carried.iter().filter(|carried| carried.next != Operand::Temp(carried.temp));
        let (mut names, mut values) = (Vec::new(), Vec::new());
        for Carried { temp, next, .. } in changes {
            values.push(value(&name(*temp), &self.operand(next)));
            names.push(name(*temp));
        }
        let _ = match names.as_slice() {
            [] => Ok(()),
            [one] => writeln!(out, "    {one} = {};", values[0]),
            _ => writeln!(out, "    ({}) = ({});", names.join(", "), values.join(", ")),
        };
    }
}

fn flattened(argument: &Argument) -> String {
    ".as_flattened()".repeat(argument.lengths.len().saturating_sub(1))
}

/// The lines of a block.
fn indented(text: &str) -> String {
    text.lines().map(|line| format!("    {line}\n")).collect()
}
