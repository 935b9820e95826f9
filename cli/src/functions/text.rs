//! The table of functions for people.

use std::fmt::Write;

use super::report::{Footnotes, FunctionRow, Report};
use crate::table::{Table, freedom, plain};
use articulated_codegen::function_groups::Group;

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
    by_group(report, &mut meanings, |f| [f.summary, f.unit, f.algorithm].map(str::to_owned).to_vec());
    out + "\n" + &meanings.text()
}

fn by_group(report: &Report, table: &mut Table, mut cells: impl FnMut(&FunctionRow) -> Vec<String>) {
    for group in Group::ALL {
        table.heading(group.name());
        for f in report.functions.iter().filter(|f| f.group == group) {
            table.row(std::iter::once(format!("  {}", f.function)).chain(cells(f)));
        }
    }
}
