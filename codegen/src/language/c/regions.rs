//! Regions as C: loops, and statements that run where a mask holds. As in Rust.

use std::fmt::Write;

use super::statements::{Lanes, Printer, name};
use crate::language::{factor, in_turn, stored_turn};
use crate::lir::{Carried, Operand, Region, Table, Temp, Turns};

impl Printer<'_> {
    pub(super) fn region(&self, out: &mut String, region: &Region) {
        let real = &self.numbers.computed;
        let is_states = self.numbers.lanes.is_some();
        for Carried { temp, start, .. } in &region.carried {
            let _ = writeln!(out, "    {real} {} = {};", name(*temp), self.vector(start));
        }
        for (column, values) in &region.columns {
            let list: Vec<String> = values.iter().map(|value| self.vector(value)).collect();
            let _ = writeln!(out, "    const {real} {}_column[{}] = {{{}}};", name(*column), values.len(), list.join(", "));
        }
        let mut inside = String::new();
        for (temp, of) in &region.captured {
            let _ = writeln!(inside, "    const {real} {} = {};", name(*temp), self.vector(of));
        }
        match &region.turns {
            Turns::Until { most, mask, held } => {
                let (turn, held) = (format!("{}_turn", name(*held)), name(*held));
                let [zero, one] = [0.0, 1.0].map(|x| self.vector(&Operand::Constant(x)));
                // Of several states it decides which are left.
                let is_read = is_states || region.is_held_read();
                if is_read {
                    let _ = writeln!(out, "    {real} {held} = {zero};");
                }
                let _ = writeln!(out, "    for (int {turn} = 0; {turn} < {most}; {turn}++) {{");
                let ends = if is_read { format!("{held} = {one};\n        break;") } else { "break;".to_owned() };
                self.statements(&mut inside, &region.body);
                self.end_of_turn(&mut inside, region, |old, new| match is_states {
                    true => self.call("select", &format!("{held} > {zero}, {old}, {new}")),
                    false => new.to_owned(),
                });
                let _ = match mask {
                    Operand::Constant(0.0) => Ok(()),
                    Operand::Constant(_) => writeln!(inside, "    {}", ends.replace("        ", "    ")),
                    _ if is_states => {
                        let held_now = self.call("select", &format!("{}, {one}, {held}", self.operand(mask)));
                        let is_left = self.call("any", &format!("{held} < {one}"));
                        writeln!(inside, "    {held} = {held_now};\n    if (!{is_left}) {{\n        break;\n    }}")
                    }
                    _ => writeln!(inside, "    if ({}) {{\n        {ends}\n    }}", self.operand(mask)),
                };
            }
            Turns::Where(mask) => {
                let mask = self.operand(mask);
                self.statements(&mut inside, &region.body);
                self.end_of_turn(&mut inside, region, |old, new| match is_states {
                    true => self.call("select", &format!("{mask}, {new}, {old}")),
                    false => new.to_owned(),
                });
                let condition = if is_states { self.call("any", &mask) } else { mask.clone() };
                let _ = writeln!(out, "    if ({condition}) {{");
            }
            Turns::Each { name: number, table, row, fixed, results, turns, read, stored, is_kept } => {
                let (turn, is_read) = (format!("x{number}_turn"), !read.is_empty() || *is_kept);
                for (temp, column) in fixed {
                    let _ = writeln!(
                        inside,
                        "    const {real} {} = {};",
                        name(*temp),
                        in_turn(column, &turn, name, |argument, at| self.number_of(argument, at))
                    );
                }
                if !row.is_empty() {
                    inside = self.rows(out, (table, row), (*number, &turn), *turns) + &inside;
                }
                if is_read {
                    let _ = writeln!(out, "    {real} x{number}_results[{turns}][{}];", results.len());
                }
                self.statements(&mut inside, &region.body);
                for (k, value) in results.iter().enumerate().filter(|_| is_read) {
                    let _ = writeln!(inside, "    x{number}_results[{turn}][{k}] = {};", self.vector(value));
                }
                if let Some(stored) = stored {
                    let ((array, index), width) = ((self.places)(stored.first), results.len());
                    let turn = factor(&stored_turn(*stored, &turn, *turns));
                    for (k, value) in results.iter().enumerate() {
                        let (at, value) = (format!("{} + {turn} * {width}", index + k), self.vector(value));
                        let _ = match &self.numbers.lanes {
                            Some(Lanes { prefix, stride }) => writeln!(inside, "    {prefix}_store({array} + ({at}) * {stride}, {value});"),
                            None => writeln!(inside, "    {array}[{at}] = {value};"),
                        };
                    }
                }
                self.end_of_turn(&mut inside, region, |_, new| new.to_owned());
                let _ = writeln!(out, "    for (int {turn} = 0; {turn} < {turns}; {turn}++) {{");
            }
        }
        inside.lines().for_each(|line| {
            let _ = writeln!(out, "    {line}");
        });
        let _ = writeln!(out, "    }}");
        if let Turns::Each { name: number, read, .. } = &region.turns {
            for (turn, k, temp) in read {
                let _ = writeln!(out, "    const {real} {} = x{number}_results[{turn}][{k}];", name(*temp));
            }
        }
        for (temp, last) in &region.after {
            let _ = writeln!(out, "    const {real} {} = {};", name(*temp), name(*last));
        }
    }

    /// Declares the rows before the loop, and returns the statements that read one.
    fn rows(&self, out: &mut String, (table, row): (&Table, &[Temp]), (number, turn): (u32, &str), turns: usize) -> String {
        let (real, width) = (&self.numbers.computed, row.len());
        let read = |(k, temp): (usize, &Temp)| {
            let at = format!("{turn} * {width} + {k}");
            let value = match table {
                Table::Values(_) => format!("x{number}_rows[{turn}][{k}]"),
                Table::Argument(argument) => self.number_of(*argument, &at),
            };
            format!("    const {real} {} = {value};\n", name(*temp))
        };
        if let Table::Values(values) = table {
            let _ = writeln!(out, "    const {real} x{number}_rows[{turns}][{width}] = {{");
            for values in values.chunks(width) {
                let list: Vec<String> = values.iter().map(|value| self.vector(value)).collect();
                let _ = writeln!(out, "        {{{}}},", list.join(", "));
            }
            let _ = writeln!(out, "    }};");
        }
        row.iter().enumerate().map(read).collect()
    }

    /// A number of an argument.
    fn number_of(&self, argument: u32, at: &str) -> String {
        let name = &self.arguments[argument as usize].name;
        match &self.numbers.lanes {
            Some(Lanes { prefix, stride }) => format!("{prefix}_load({name} + ({at}) * {stride})"),
            None => format!("{name}[{at}]"),
        }
    }

    /// All carried values change at once.
    fn end_of_turn(&self, out: &mut String, region: &Region, value: impl Fn(&str, &str) -> String) {
        let real = &self.numbers.computed;
        let changes: Vec<&Carried> = region.carried.iter().filter(|carried| carried.next != Operand::Temp(carried.temp)).collect();
        let is_carried = |operand: &Operand| region.carried.iter().any(|carried| *operand == Operand::Temp(carried.temp));
        if changes.len() < 2 || !changes.iter().any(|carried| is_carried(&carried.next)) {
            for Carried { temp, next, .. } in changes {
                let _ = writeln!(out, "    {} = {};", name(*temp), value(&name(*temp), &self.vector(next)));
            }
            return;
        }
        for Carried { temp, next, .. } in &changes {
            let _ = writeln!(out, "    const {real} {}_next = {};", name(*temp), self.vector(next));
        }
        for Carried { temp, .. } in changes {
            let _ = writeln!(out, "    {} = {};", name(*temp), value(&name(*temp), &format!("{}_next", name(*temp))));
        }
    }
}
