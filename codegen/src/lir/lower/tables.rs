//! Columns of tables that are the same in each turn of a region around them.
//!
//! ```text
//! repeat { for row in [[a, x], [b, y]] { … } }    a, b: known before the region, x, y: of a turn
//! let column = [a, b];
//! repeat { for (k, row) in [[x], [y]] { column[k] … } }
//! ```

use std::collections::{HashMap, HashSet};

use crate::lir::{Operand, Region, Stmt, Table, TableColumn, Temp, Turns};

impl Region {
    /// Moves the columns of tables in its body out of it, as far as their values are known before
    /// it.
    pub(super) fn lift_columns(&mut self) {
        let outside: HashMap<Temp, Operand> = self.captured.iter().copied().collect();
        let known = |values: &[Operand]| -> Option<Vec<Operand>> {
            let of = |value: &Operand| if let Operand::Temp(temp) = value { outside.get(temp).copied() } else { Some(*value) };
            values.iter().map(of).collect()
        };
        let mut renamed: HashMap<Temp, Temp> = HashMap::new();
        for region in self.body.iter_mut().filter_map(of_region) {
            for (name, values) in std::mem::take(&mut region.columns) {
                let Some(before) = known(&values) else {
                    region.columns.push((name, values));
                    continue;
                };
                match self.columns.iter().find(|(_, other)| *other == before) {
                    Some((other, _)) => _ = renamed.insert(name, *other),
                    None => self.columns.push((name, before)),
                }
            }
            let Turns::Each { table: Table::Values(values), row, fixed, turns, .. } = &mut region.turns else { continue };
            let width = row.len();
            let column = |k: usize| -> Vec<Operand> { (0..*turns).map(|turn| values[turn * width + k]).collect() };
            let found: Vec<Option<Vec<Operand>>> = (0..width).map(|k| known(&column(k))).collect();
            let stays: Vec<bool> = found.iter().map(Option::is_none).collect();
            for (temp, before) in row.iter().zip(found) {
                let Some(before) = before else { continue };
                let same = self.columns.iter().find(|(_, other)| *other == before).map(|(name, _)| *name);
                let name = same.unwrap_or_else(|| {
                    self.columns.push((*temp, before));
                    *temp
                });
                fixed.push((*temp, TableColumn::Named(name)));
            }
            *values = values.iter().enumerate().filter(|(k, _)| stays[k % width]).map(|(_, value)| *value).collect();
            let mut stays = stays.iter();
            row.retain(|_| *stays.next().unwrap_or(&true));
        }
        if !renamed.is_empty() {
            self.body.iter_mut().for_each(|statement| rename(statement, &renamed));
        }
    }

    /// Forgets captured values that its body does not read.
    pub(super) fn forget_unread(&mut self) {
        let mut read: HashSet<Temp> = HashSet::new();
        let mut see = |operand: &Operand| _ = operand.temp().map(|temp| read.insert(temp));
        self.body.iter().for_each(|statement| statement.operands(&mut see));
        self.ends().for_each(see);
        self.captured.retain(|(temp, _)| read.contains(temp));
    }
}

pub(super) fn of_region(statement: &mut Stmt) -> Option<&mut Region> {
    if let Stmt::Region(region) = statement { Some(region) } else { None }
}

/// Reads other columns.
fn rename(statement: &mut Stmt, names: &HashMap<Temp, Temp>) {
    let Some(region) = of_region(statement) else { return };
    if let Turns::Each { fixed, .. } = &mut region.turns {
        for (_, column) in fixed {
            if let TableColumn::Named(name) = column {
                *name = names.get(name).copied().unwrap_or(*name);
            }
        }
    }
    region.body.iter_mut().for_each(|statement| rename(statement, names));
}
