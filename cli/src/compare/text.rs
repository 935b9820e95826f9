//! The measurements for people.

use std::fmt::Write;

use super::report::{FunctionReport, Report};
use super::timing::Summary;
use crate::ledger::Stage;
use crate::table::{Table, plain};

pub(super) fn text(report: &Report) -> String {
    let mut out = head(report);
    for (title, table) in [
        (
            "Multiplications and additions after each stage of the generator (asked: what the algorithm asks for; the last: what is emitted)",
            operations(report),
        ),
        ("Instructions after each stage: a multiply-add counts once; sines and cosines apart", instructions(report)),
        ("Size of the generated code, and what it costs to make it", sizes(report)),
        ("Time of a call: median, and quartiles' distance (IQR)", times(report)),
        ("Time of a call in other libraries, and the time of ours relative to theirs", peers(report)),
        (
            "Largest error in units of 2⁻⁵³ of the sum of the magnitudes of the terms, against an independent evaluation in big floats",
            errors(report),
        ),
    ] {
        if !table.is_empty() {
            let _ = write!(out, "\n{title}\n{}", indent(&table.text()));
        }
    }
    out + "\n" + &newcomer(report)
}

fn head(report: &Report) -> String {
    let [x, y, z] = report.gravity;
    let mut out = format!(
        "{}, {} base: {} joints, {} degrees of freedom; gravity ({x}, {y}, {z}) m/s²\n{} random states (seed {}), {} interleaved repetitions; {} {}\n",
        plain(&report.robot),
        report.base,
        report.joints,
        report.degrees_of_freedom,
        report.states,
        report.seed,
        report.repetitions,
        report.compiler,
        report.flags,
    );
    if !report.optimised {
        out += "This command was built without optimisation: times of generic code and of the generation mean little.\n";
    }
    for note in &report.notes {
        let _ = writeln!(out, "note: {}", plain(note));
    }
    out
}

fn stage_table(report: &Report, cell: impl Fn(&Stage) -> String) -> Table {
    let stages = report.functions.first().map_or(&[][..], |f| &f.stages);
    let titles = stages.iter().map(|s| s.stage.clone());
    let mut table = Table::new(std::iter::once("function".to_owned()).chain(titles).map(|t| (t, "")));
    for f in &report.functions {
        table.row(std::iter::once(f.function.clone()).chain(f.stages.iter().map(&cell)));
    }
    table
}

fn operations(report: &Report) -> Table {
    stage_table(report, |s| format!("{}+{}", s.multiplications, s.additions))
}

fn instructions(report: &Report) -> Table {
    stage_table(report, |s| s.instructions.to_string())
}

fn sizes(report: &Report) -> Table {
    let mut table = Table::new([
        ("function", ""),
        ("sin, cos", ""),
        ("depth", "operations"),
        ("machine code", "bytes"),
        ("source", "bytes"),
        ("generation", "ms"),
        ("rustc", "ms"),
    ]);
    for f in &report.functions {
        table.row([
            f.function.clone(),
            f.stages.last().map_or(0, |s| s.sines_and_cosines).to_string(),
            f.depth.to_string(),
            f.code_bytes.map_or_else(|| "–".into(), |n| n.to_string()),
            f.source_bytes.to_string(),
            format!("{:.1}", f.generation_seconds * 1e3),
            format!("{:.0}", f.compilation_seconds * 1e3),
        ]);
    }
    table
}

fn times(report: &Report) -> Table {
    let mut table = Table::new([
        ("function", ""),
        ("generated", "ns"),
        ("IQR", "ns"),
        ("generic", "ns"),
        ("IQR", "ns"),
        ("generic/generated", "ratio"),
        ("IQR", "ratio"),
    ]);
    for f in &report.functions {
        let [a, b] = [&f.generated, &f.generic].map(|s| [nanoseconds(s.median), nanoseconds(spread(s))]);
        let ratio = &f.generic_over_generated;
        table.row([vec![f.function.clone()], a.to_vec(), b.to_vec(), vec![times_of(ratio.median), times_of(spread(ratio))]].concat());
    }
    table
}

fn peers(report: &Report) -> Table {
    let mut table = Table::new([
        ("function", ""),
        ("peer", ""),
        ("time", "ns"),
        ("IQR", "ns"),
        ("generic/peer", "ratio"),
        ("generated/peer", "ratio"),
        ("largest difference", "of magnitude"),
    ])
    .left(2);
    for (f, p) in report.functions.iter().flat_map(|f| f.peers.iter().map(move |p| (f, p))) {
        table.row([
            f.function.clone(),
            p.peer.clone(),
            nanoseconds(p.time.median),
            nanoseconds(spread(&p.time)),
            times_of(p.generic_over_peer.median),
            times_of(p.generated_over_peer.median),
            p.largest_difference.map_or_else(|| "–".into(), |d| format!("{d:.1e}")),
        ]);
    }
    table
}

fn errors(report: &Report) -> Table {
    let bits = format!("{} bits", report.reference_bits);
    let mut table = Table::new([
        ("function", String::new()),
        ("generated", "units".into()),
        ("generic", "units".into()),
        ("bound", "units".into()),
        ("against", bits),
    ]);
    for f in &report.functions {
        let row = match f.errors {
            Some(e) => [format!("{:.2}", e.generated), format!("{:.2}", e.generic), format!("{}", report.bound), e.kind.into()],
            None => ["–".into(), "–".into(), "–".into(), "none yet".into()],
        };
        table.row(std::iter::once(f.function.clone()).chain(row));
    }
    table
}

/// Two sentences that say what was seen.
fn newcomer(report: &Report) -> String {
    let ratio = |f: &FunctionReport| f.generic_over_generated.median;
    let Some(best) = report.functions.iter().max_by(|a, b| ratio(a).total_cmp(&ratio(b))) else { return String::new() };
    let least = times_of(report.functions.iter().map(ratio).fold(f64::INFINITY, f64::min));
    let most = times_of(ratio(best));
    let gain = if least == most { format!("{most} times") } else { format!("{least} times to {most} times ({})", best.function) };
    format!(
        "The generator wrote this one robot's equations out with everything known beforehand folded in, and the library's generic code, which serves\n\
         any robot and computes the same numbers, takes {gain} as long for a call on this machine.\n{}",
        accuracy(report)
    )
}

fn accuracy(report: &Report) -> String {
    let errors: Vec<f64> = report.functions.iter().filter_map(|f| f.errors).map(|e| e.generated).collect();
    let worst = errors.iter().copied().fold(0.0, |a: f64, b| if b.is_nan() || b > a { b } else { a });
    let verdict = if errors.is_empty() {
        return "For none of these functions is there a reference yet by which the accuracy of either could be judged.\n".into();
    } else if worst <= report.bound {
        "so the time is not saved at the cost of accuracy"
    } else {
        "which is more than rounding explains"
    };
    format!(
        "Both round their results: the generated code was off by at most {worst:.1} times the rounding of one operation (2⁻⁵³, some 1.1e-16), measured against\n\
         the size of the terms that were added up, {verdict}.\n"
    )
}

fn spread(s: &Summary) -> f64 {
    s.upper_quartile - s.lower_quartile
}

fn nanoseconds(x: f64) -> String {
    if x < 100.0 { format!("{x:.1}") } else { format!("{x:.0}") }
}

fn times_of(x: f64) -> String {
    format!("{x:.2}")
}

fn indent(text: &str) -> String {
    text.lines().fold(String::new(), |out, line| out + "  " + line + "\n")
}
