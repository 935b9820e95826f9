//! Tables whose columns are results of an earlier region of the same block, read where they are.
//!
//! ```text
//! for row in table { results[turn] = [a, b] }
//! for row in [[results[0][1], x], [results[1][1], y]] { … }    copies b
//! for (turn, row) in [[x], [y]] { results[turn][1] … }          reads it in place
//! ```
//!
//! The way back of a gradient reads the states of the way forward in this way, from the last to the
//! first. The text does not grow with the number of turns.

use std::collections::{HashMap, HashSet};

use super::tables::of_region;
use crate::lir::{Operand, Region, Stmt, Table, TableColumn, Temp, Turns};

/// The results of regions: of each value its region, its turn, and its number in the turn.
type Made = HashMap<Temp, (u32, usize, usize)>;

/// Reads results of regions in place in the tables of the regions after them. `ends`: what is read
/// after these statements. Results that nothing else reads are then no values any more.
pub(crate) fn read_in_place(statements: &mut [Stmt], ends: &[Operand]) {
    let (mut made, mut kept) = (Made::new(), HashSet::new());
    for region in statements.iter_mut().filter_map(of_region) {
        let mut found: HashMap<Temp, TableColumn> = HashMap::new();
        region.columns.retain(|(name, values)| match column(&made, values) {
            Some(column) => found.insert(*name, column).is_some(),
            None => true,
        });
        kept.extend(found.values().chain(&own_columns(region, &made)).filter_map(region_of));
        region.body.iter_mut().filter_map(of_region).for_each(|inner| replace(inner, &found));
        if let Turns::Each { name, read, .. } = &region.turns {
            made.extend(read.iter().map(|(turn, number, temp)| (*temp, (*name, *turn, *number))));
        }
    }
    if kept.is_empty() {
        return;
    }
    let mut used: HashSet<Temp> = ends.iter().filter_map(|end| end.temp()).collect();
    statements.iter().for_each(|statement| statement.operands(|operand| used.extend(operand.temp())));
    for region in statements.iter_mut().filter_map(of_region) {
        if let Turns::Each { name, read, is_kept, .. } = &mut region.turns {
            *is_kept = kept.contains(name);
            if *is_kept {
                read.retain(|(.., temp)| used.contains(temp));
            }
        }
    }
}

/// The results of one region that these values are, turn by turn.
fn column(made: &Made, values: &[Operand]) -> Option<TableColumn> {
    let mut places = values.iter().map(|value| made.get(&value.temp()?).copied());
    let (region, first, number) = places.next()??;
    let (_, second, _) = places.next()??;
    let is_backward = second < first;
    let expected = |k: usize| if is_backward { first.checked_sub(k) } else { Some(first + k) };
    let fits = |(k, value): (usize, &Operand)| {
        let place = value.temp().and_then(|temp| made.get(&temp));
        place.is_some_and(|(other, turn, own)| (*other, *own) == (region, number) && Some(*turn) == expected(k))
    };
    values.iter().enumerate().all(fits).then_some(TableColumn::Results { region, number, first, is_backward })
}

/// The columns of the table of a region that are such results; they are no part of its table then.
fn own_columns(region: &mut Region, made: &Made) -> Vec<TableColumn> {
    let Turns::Each { table: Table::Values(values), row, fixed, turns, .. } = &mut region.turns else { return Vec::new() };
    let width = row.len();
    let found: Vec<Option<TableColumn>> =
        (0..width).map(|k| column(made, &(0..*turns).map(|turn| values[turn * width + k]).collect::<Vec<_>>())).collect();
    fixed.extend(row.iter().zip(&found).filter_map(|(temp, column)| Some((*temp, (*column)?))));
    *values = values.iter().enumerate().filter(|(k, _)| found[k % width].is_none()).map(|(_, value)| *value).collect();
    let mut stays = found.iter().map(Option::is_none);
    row.retain(|_| stays.next().unwrap_or(true));
    found.into_iter().flatten().collect()
}

fn region_of(column: &TableColumn) -> Option<u32> {
    if let TableColumn::Results { region, .. } = column { Some(*region) } else { None }
}

/// Reads these columns in place.
fn replace(region: &mut Region, columns: &HashMap<Temp, TableColumn>) {
    if let Turns::Each { fixed, .. } = &mut region.turns {
        for (_, column) in fixed {
            if let TableColumn::Named(name) = column {
                *column = columns.get(name).copied().unwrap_or(*column);
            }
        }
    }
    region.body.iter_mut().filter_map(of_region).for_each(|inner| replace(inner, columns));
}
