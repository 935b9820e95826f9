//! Regions as Rust: loops, and statements that run where a mask holds.
//!
//! Of several states, a lane whose iteration is over keeps its values. The loop ends when no lane
//! is left.

use std::fmt::Write;

use crate::language::rust::statements::{Printer, name, ty};
use crate::lir::{Carried, Operand, Region, Turns, Ty};

impl Printer<'_> {
    /// A region. `define`: as for other statements.
    pub(super) fn region(&self, out: &mut String, region: &Region, define: &str) {
        for Carried { temp, start, .. } in &region.carried {
            let _ = writeln!(out, "    let mut {} = {};", name(*temp), self.operand(start));
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
            Turns::Each { name: number, table, row, results, turns, read } => {
                let is_read = !read.is_empty();
                if !row.is_empty() {
                    let _ = writeln!(out, "    let x{number}_rows = [");
                    for values in table.chunks(row.len()) {
                        let list: Vec<String> = values.iter().map(|value| self.operand(value)).collect();
                        let _ = writeln!(out, "        [{}],", list.join(", "));
                    }
                    let _ = writeln!(out, "    ];");
                    let names: Vec<String> = row.iter().map(|temp| name(*temp)).collect();
                    inside = format!("    let [{}] = x{number}_rows[x{number}_turn];\n{inside}", names.join(", "));
                }
                if is_read {
                    let (ty, zero) = ty(self.body.ty);
                    let _ = writeln!(
                        out,
                        "    let mut x{number}_results: [[{ty}; {}]; {turns}] = [[{zero}; {}]; {turns}];",
                        results.len(),
                        results.len()
                    );
                }
                self.statements(&mut inside, &region.body);
                if is_read {
                    let list: Vec<String> = results.iter().map(|value| self.operand(value)).collect();
                    let _ = writeln!(inside, "    x{number}_results[x{number}_turn] = [{}];", list.join(", "));
                }
                self.end_of_turn(&mut inside, region, |_, new| new.to_owned());
                let turn = if is_read || !row.is_empty() { format!("x{number}_turn") } else { "_".to_owned() };
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

/// The lines of a block.
fn indented(text: &str) -> String {
    text.lines().map(|line| format!("    {line}\n")).collect()
}
