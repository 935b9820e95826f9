//! Results for people.

use std::fmt::Write;

use articulated_core::Plain;
use articulated_core::model::Model;

use super::BOUND;
use super::backward::LOOSE;
use super::layout::Grid;
use super::report::{FunctionReport, Outcome, Report};
use crate::robot::named;
use crate::table::{Table, counted, plain};

pub(super) fn text(report: &Report, model: &Model<f64>) -> String {
    let [x, y, z] = report.gravity.map(Plain);
    let effects = if report.effects.is_empty() { String::new() } else { format!("; with {}", report.effects.join(", ")) };
    let mut out =
        format!("{}, {} base, gravity ({x}, {y}, {z}) m/s²{effects}\n", plain(&named(&report.robot, report.scene.as_deref())), report.base);
    if let Some(compiler) = &report.compiler {
        let _ = writeln!(out, "generated code compiled by {compiler}");
    }
    for f in &report.functions {
        function(&mut out, f, model);
    }
    out
}

fn function(out: &mut String, f: &FunctionReport, model: &Model<f64>) {
    let _ = writeln!(out, "\n{}: {}\n  {}", f.function.name, f.function.summary, crate::shape::result(f.function));
    let grid = Grid::of(f.function, model);
    for (k, outcome) in f.outcomes.iter().enumerate() {
        let _ = writeln!(out, "\nstates[{k}]");
        match grid.columns.len() {
            1 => *out += &side_by_side(outcome, &grid).text(),
            _ => blocks(out, outcome, &grid),
        }
    }
    if let Some(d) = f.largest {
        let _ = writeln!(
            out,
            "\nlargest difference of generic and generated results: {:e}; in units of 2⁻⁵³ of the magnitude of the terms {:.2} (states[{}], bound {BOUND})",
            d.absolute, d.units, d.state
        );
    }
    if let Some(b) = f.backward {
        let _ = writeln!(
            out,
            "\none unit of rounding is more than {LOOSE:e} of the result in {}: there the torque that the result needs, less the applied one, is at most\n\
             {:e} N·m|N; in units of 2⁻⁵³ of the magnitude of its terms {:.2} (states[{}], bound {BOUND})",
            counted(b.states, "state"),
            b.residual.torque,
            b.residual.units,
            b.state
        );
    }
}

/// A row for each number.
fn side_by_side(outcome: &Outcome, grid: &Grid) -> Table {
    let sides: Vec<(&str, &Vec<f64>)> = sides(outcome);
    let difference = sides.len() == 2;
    let titles = sides.iter().map(|s| s.0).chain(difference.then_some("difference"));
    let mut table = Table::new(std::iter::once("").chain(titles).map(|t| (t, "")));
    for (k, name) in grid.rows.iter().enumerate() {
        let mut row = vec![name.clone()];
        row.extend(sides.iter().map(|s| digits(s.1[k])));
        row.extend(difference.then(|| format!("{:.1e}", (sides[0].1[k] - sides[1].1[k]).abs())));
        table.row(row);
    }
    table
}

/// Rows and columns, once for each side.
fn blocks(out: &mut String, outcome: &Outcome, grid: &Grid) {
    for (side, numbers) in sides(outcome) {
        let mut table = Table::new(std::iter::once(side.to_owned()).chain(grid.columns.iter().cloned()).map(|t| (t, "")));
        for (name, row) in grid.rows.iter().zip(numbers.chunks(grid.columns.len().max(1))) {
            table.row(std::iter::once(name.clone()).chain(row.iter().map(|x| digits(*x))));
        }
        *out += &table.text();
    }
}

fn sides(outcome: &Outcome) -> Vec<(&'static str, &Vec<f64>)> {
    let both = [("generic", &outcome.generic), ("generated", &outcome.generated)];
    both.into_iter().filter_map(|(name, x)| Some((name, x.as_ref()?))).collect()
}

/// All digits that a double has, and no more.
fn digits(x: f64) -> String {
    if x == 0.0 || (1e-5..1e9).contains(&x.abs()) { format!("{x}") } else { format!("{x:e}") }
}
