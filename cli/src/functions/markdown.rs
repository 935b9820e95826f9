//! The table of functions as a document.

use std::fmt::Write;

use super::report::{Footnotes, Report};
use crate::shape;
use crate::table::freedom;
use articulated_codegen::function_groups::Group;
use articulated_core::algorithm::Argument;

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
    for argument in Argument::ALL.into_iter().chain([Argument::SinCos]) {
        let asked = if argument == Argument::SinCos {
            "; behind the others and before `parameters`, where a function is asked for with `q = sin_cos`"
        } else {
            ""
        };
        let _ = writeln!(out, "| `{}` | `{}` {}{asked} |", argument.name(), shape::dims(argument.dims()), cell(argument.unit()));
    }
    let mut footnotes = Footnotes::default();
    for group in Group::ALL {
        let names: String = report.robots.iter().map(|r| format!(" {} |", r.robot)).collect();
        let lines = "--:|".repeat(report.robots.len());
        let _ = writeln!(out, "\n## {}\n\n| function | gives | what it is | algorithm |{names}\n|---|---|---|---|{lines}", group.title());
        for f in report.functions.iter().filter(|f| f.group == group) {
            let gives = if f.gives.is_empty() { "a number".into() } else { format!("`{}`", f.gives) };
            let costs: String = f.costs.iter().map(|c| format!(" {} |", footnotes.cell(c))).collect();
            let (summary, unit, algorithm) = (cell(f.summary), cell(f.unit), cell(f.algorithm));
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
