//! Results for people.

use std::fmt::Write;

use articulated_core::model::Model;

use super::BOUND;
use super::layout::{Layout, freedom_names};
use super::report::{FunctionReport, Outcome, Report};
use crate::table::{Table, plain};

pub(super) fn text(report: &Report, model: &Model<f64>) -> String {
    let [x, y, z] = report.gravity;
    let mut out = format!("{}, {} base, gravity ({x}, {y}, {z}) m/s²\n", plain(&report.robot), report.base);
    if let Some(compiler) = &report.compiler {
        let _ = writeln!(out, "generated code compiled by {compiler}");
    }
    for f in &report.functions {
        function(&mut out, f, model);
    }
    out
}

fn function(out: &mut String, f: &FunctionReport, model: &Model<f64>) {
    let _ = writeln!(out, "\n{}: {}\n  {}", f.function.name, f.function.summary, f.function.gives.doc());
    let layout = Layout::of(f.function);
    for (k, outcome) in f.outcomes.iter().enumerate() {
        let _ = writeln!(out, "\nstates[{k}]");
        match layout {
            Layout::Joints => *out += &joints(outcome, model).text(),
            Layout::Frames => frames(out, outcome, model),
            Layout::Square => blocks(out, outcome, model.nv, &freedom_names(model)),
        }
    }
    if let Some(d) = f.largest {
        let _ = writeln!(
            out,
            "\nlargest difference of generic and generated results: {:e}; in units of 2⁻⁵³ of the magnitude of the terms {:.2} (states[{}], bound {BOUND})",
            d.absolute, d.units, d.state
        );
    }
}

/// A row for each degree of freedom.
fn joints(outcome: &Outcome, model: &Model<f64>) -> Table {
    let sides: Vec<(&str, &Vec<f64>)> = sides(outcome);
    let difference = sides.len() == 2;
    let titles = sides.iter().map(|s| s.0).chain(difference.then_some("difference"));
    let mut table = Table::new(std::iter::once("joint").chain(titles).map(|t| (t, "")));
    for (k, name) in freedom_names(model).into_iter().enumerate() {
        let mut row = vec![name];
        row.extend(sides.iter().map(|s| digits(s.1[k])));
        row.extend(difference.then(|| format!("{:.1e}", (sides[0].1[k] - sides[1].1[k]).abs())));
        table.row(row);
    }
    table
}

/// A row for each frame, once for each side.
fn frames(out: &mut String, outcome: &Outcome, model: &Model<f64>) {
    let titles = ["r11", "r12", "r13", "r21", "r22", "r23", "r31", "r32", "r33", "x (m)", "y (m)", "z (m)"];
    for (side, numbers) in sides(outcome) {
        let mut table = Table::new(std::iter::once(format!("{side}: frame")).chain(titles.map(str::to_owned)).map(|t| (t, "")));
        for (frame, x) in model.frames.iter().zip(numbers.chunks_exact(12)) {
            table.row(std::iter::once(frame.name.clone()).chain(x.iter().map(|x| digits(*x))));
        }
        *out += &table.text();
    }
}

/// Rows of `width` numbers, once for each side.
fn blocks(out: &mut String, outcome: &Outcome, width: usize, names: &[String]) {
    for (side, numbers) in sides(outcome) {
        let width = width.max(1);
        let titles = (0..width).map(|k| names.get(k).cloned().unwrap_or_default());
        let mut table = Table::new(std::iter::once(side.to_owned()).chain(titles).map(|t| (t, "")));
        for (k, row) in numbers.chunks(width).enumerate() {
            let name = names.get(k).cloned().unwrap_or_default();
            table.row(std::iter::once(name).chain(row.iter().map(|x| digits(*x))));
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
