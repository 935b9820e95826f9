//! The report as tables for people.

use std::fmt::Write;

use super::report::{FunctionReport, Point, Report, Spread};
use crate::compare::accuracy::Against;
use crate::robot::named;
use crate::table::{Table, counted, freedom, plain, wrapped};

/// Everything.
pub(super) fn text(report: &Report) -> String {
    let mut out = head(report);
    for f in &report.functions {
        let _ = write!(out, "\n{}: {}\n{}", f.function, f.summary, table(f).text());
        f.surprises.iter().for_each(|s| {
            out += &wrapped(&format!("  {s}\n"));
        });
    }
    let reference = match report.reference {
        Against::Textbook => "the textbook's formulas on the numbers of the robot's file",
        Against::Library => "the generic library on the model's numbers",
    };
    let backward = if report.functions.iter().flat_map(|f| &f.points).any(|p| p.backward.is_some()) { BACKWARD } else { "" };
    out + &wrapped(&EXPLAINED.replace("REFERENCE", reference).replace("BACKWARD", backward))
}

/// The description of the measurement and the machine.
pub(super) fn head(report: &Report) -> String {
    let mut out = format!(
        "{}, {} base: {}, {}; frames: {}\n{} (seed {}) and {}, {} in turns; reference of {} bits\n{}; {} {}; articulated {} ({})\n",
        plain(&named(&report.robot, report.scene.as_deref())),
        report.base,
        counted(report.joints, "joint"),
        freedom(report.degrees_of_freedom),
        plain(&report.frames.join(", ")),
        counted(report.states, "random state"),
        report.seed,
        counted(report.hard_states, "hard one"),
        counted(report.repetitions as usize, "repetition"),
        report.reference_bits,
        report.processor,
        report.compiler,
        report.flags,
        report.version,
        report.commit,
    );
    for note in &report.notes {
        let _ = writeln!(out, "note: {}", plain(note));
    }
    wrapped(&out)
}

const EXPLAINED: &str = "
*: nothing measured is both faster and more accurate. Time: the median of a call; IQR: the distance of its quartiles.
Errors are relative to the sum of the magnitudes of the terms: median, 99 % and largest over the random states, against REFERENCE.
ulps: the same error in units of the last place of the result itself (of a double), large where terms cancel.
BACKWARDrounding: the error against the same formulas with the constants of the generated code; bound: what rounding can be at most on these states, guaranteed; reached: the largest \
part of a bound that an error was that is finite; hard: the largest error on the hard states, overflow if one has no result: a number on the way is beyond the largest of the level.
operations: additions, multiplications, divisions and roots of a call (a multiply-add is two; sines and cosines apart); code: machine code of the function alone.
";

const BACKWARD: &str =
    "backward: how far the torques that a solution needs are from those given, relative to the magnitudes of their terms.\n";

fn table(f: &FunctionReport) -> Table {
    let backward = f.points.iter().any(|p| p.backward.is_some());
    let mut columns = vec![
        ("level", ""),
        ("", ""),
        ("time", "ns"),
        ("IQR", "ns"),
        ("error", "median"),
        ("", "99 %"),
        ("", "largest"),
        ("ulps", "largest"),
    ];
    columns.extend(backward.then_some(("backward", "largest")));
    columns.extend([
        ("rounding", "largest"),
        ("bound", "largest"),
        ("reached", ""),
        ("hard", "largest"),
        ("operations", ""),
        ("code", "bytes"),
    ]);
    let mut table = Table::new(columns);
    for p in &f.points {
        table.row(row(p, backward));
    }
    table
}

fn row(p: &Point, backward: bool) -> Vec<String> {
    let optional = |x: Option<f64>| x.map_or_else(|| "–".into(), number);
    let largest = |s: Option<Spread>| optional(s.map(|s| s.largest));
    let count = |n: Option<u64>| n.map_or_else(|| "–".into(), |n| n.to_string());
    let mut cells = vec![
        p.level.clone(),
        if p.front { "*".into() } else { String::new() },
        format!("{:.1}", p.time.median),
        format!("{:.1}", p.time.upper_quartile - p.time.lower_quartile),
        number(p.relative.median),
        number(p.relative.most),
        number(p.relative.largest),
        number(p.ulps.largest),
    ];
    cells.extend(backward.then(|| largest(p.backward)));
    cells.extend([
        largest(p.rounding),
        optional(p.bound),
        p.reached.map_or_else(|| "–".into(), |x| format!("{x:.3}")),
        p.hard.map_or_else(|| "–".into(), |h| hardest(h.0)),
        count(p.operations),
        count(p.code_bytes),
    ]);
    cells
}

/// An error on a hard state, which may be infinite.
pub(super) fn hardest(x: f64) -> String {
    if x.is_finite() { number(x) } else { "overflow".into() }
}

/// An error in two digits.
pub(super) fn number(x: f64) -> String {
    match x {
        0.0 => "0".into(),
        x if x.is_nan() => "NaN".into(),
        x if x.is_infinite() => "∞".into(),
        x if (0.1..1e4).contains(&x) => format!("{x:.1}"),
        x => format!("{x:.1e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::super::report::example;

    #[test]
    fn every_level_has_its_line() {
        let text = super::text(&example());
        for word in [
            "f32  ",
            "double_double  *",
            "a surprise",
            "64 random states",
            "13 hard ones",
            "\nulps: ",
            "\noperations: ",
            "IQR: ",
            "; code: ",
        ] {
            assert!(text.contains(word), "{word}: {text}");
        }
    }
}
