//! The table of functions: for a terminal, and as a document.

use std::fmt::Write;

use super::report::{Footnotes, FunctionRow, Report};
use crate::shape;
use crate::table::{Table, freedom, plain};
use articulated_codegen::function_groups::Group;
use articulated_core::algorithm::Argument;
use articulated_core::step::{ACT, CTRL, H, QPOS, QVEL, WARM};

pub(super) fn text(report: &Report) -> String {
    let mut out =
        "Multiplications+additions of generated code, and instructions (a multiply-add counted once); sines and cosines apart\n".to_owned();
    for r in &report.robots {
        let (name, frames) = (plain(&r.robot), plain(&r.frames.join(", ")));
        let _ = writeln!(out, "{name}: {} base, {}; functions of frames on its tips {frames}", r.base, freedom(r.degrees_of_freedom));
    }
    let mut footnotes = Footnotes::default();
    let titles = report.robots.iter().map(|r| r.robot.clone());
    let mut costs =
        Table::new(["function".into(), "takes".into(), "gives".into()].into_iter().chain(titles).map(|t: String| (t, ""))).left(3);
    by_group(report, &mut costs, |f| {
        let mut cells = vec![f.takes.join(", "), f.gives.clone()];
        cells.extend(f.costs.iter().map(|c| footnotes.cell(c)));
        cells
    });
    let _ = write!(out, "\n{}", costs.text());
    footnotes.lines().for_each(|line| out += &(line + "\n"));
    let mut meanings = Table::new(["function", "what", "units", "algorithm"].map(|t| (t, ""))).left(4);
    by_group(report, &mut meanings, |f| vec![f.summary.to_owned(), f.unit.clone(), f.computed_by("")]);
    out + "\n" + &meanings.text()
}

fn by_group(report: &Report, table: &mut Table, mut cells: impl FnMut(&FunctionRow) -> Vec<String>) {
    for group in Group::ALL.into_iter().chain(Group::BESIDE) {
        table.heading(group.name());
        for f in report.functions.iter().filter(|f| f.group == group) {
            table.row(std::iter::once(format!("  {}", f.function)).chain(cells(f)));
        }
    }
}

const HEAD: &str = "\
# All functions

Made by `articulated functions --markdown`; `articulated functions ROBOT…` makes it for robots of yours.

The last columns are what generated code does in one call: multiplications+additions, and instructions, where a multiply-add counts once. Sines and
cosines of the joints come on top. Where limbs or joints are computed side by side (most of quadruped and humanoid), an instruction on a vector counts
once. Units \"a|b\": a for joints that rotate, b for joints that slide; \"a|b|c\" of a pair: a for two that rotate, b for one of each, c for two that slide. Functions of frames are generated for the tips of each
robot: moving links that carry no other.

";

const ARGUMENTS: &str = "\n## Arguments\n\n| argument | is |\n|---|---|\n";

pub(super) fn markdown(report: &Report) -> String {
    let mut out = HEAD.to_owned();
    for r in &report.robots {
        let frames: Vec<String> = r.frames.iter().map(|f| format!("`{f}`")).collect();
        let _ = writeln!(out, "* {}: {} base, {}; tips {}", r.robot, r.base, freedom(r.degrees_of_freedom), frames.join(", "));
    }
    out += ARGUMENTS;
    for argument in Argument::ALL.into_iter().chain([H, ACT, CTRL, WARM, QPOS, QVEL, Argument::SinCos]) {
        let asked = if argument == Argument::SinCos {
            "; behind the others and before `parameters`, where a function is asked for with `q = sin_cos`"
        } else {
            ""
        };
        let dims = if argument.dims().is_empty() { "one number,".to_owned() } else { format!("`{}`", shape::dims(argument.dims())) };
        let _ = writeln!(out, "| `{}` | {dims} {}{asked} |", argument.name(), cell(argument.unit()));
    }
    let mut footnotes = Footnotes::default();
    for group in Group::ALL.into_iter().chain(Group::BESIDE) {
        let names: String = report.robots.iter().map(|r| format!(" {} |", r.robot)).collect();
        let lines = "--:|".repeat(report.robots.len());
        let _ = writeln!(out, "\n## {}\n\n| function | gives | what it is | algorithm |{names}\n|---|---|---|---|{lines}", group.title());
        for f in report.functions.iter().filter(|f| f.group == group) {
            let gives = if f.gives.is_empty() { "a number".into() } else { format!("`{}`", f.gives) };
            let costs: String = f.costs.iter().map(|c| format!(" {} |", footnotes.cell(c))).collect();
            let (summary, unit, algorithm) = (cell(f.summary), cell(&f.unit), cell(&f.computed_by("`")));
            let _ = writeln!(out, "| `{}({})` | {gives} {unit} | {summary} | {algorithm} |{costs}", f.function, f.takes.join(", "));
        }
    }
    footnotes.lines().for_each(|line| out += &format!("\n{line}\n"));
    out
}

/// Text that ends no cell.
fn cell(text: &str) -> String {
    text.replace('|', "\\|")
}
