//! The measurements as text.

mod peers;

use std::fmt::Write;

use articulated_codegen::ledger::stages;
use articulated_core::Plain;

use super::accuracy::Against;
use super::report::{FunctionReport, Report, VariantReport};
use crate::ledger::Stage;
use crate::robot::named;
use crate::table::{Table, counted, freedom, plain, wrapped};
use crate::timing::Summary;

/// The summary, then the description of the measurement, then the tables.
pub(super) fn text(report: &Report) -> String {
    let mut out = wrapped(&summary(report)) + "\n" + &head(report);
    let stages = stages_of(report);
    for (title, table, legend) in [
        ("Time of a call: median, and quartiles' distance (IQR)".to_owned(), times(report), TIMES),
        (
            "Time of a state where many are computed at once, on one core, and how many times that of a call of others (of each engine its fastest build)"
                .to_owned(),
            batches(report),
            BATCHES,
        ),
        ("Time of a state in code of others that computes several states a call".to_owned(), peers::in_lanes(report), ""),
        ("Time of a call that waits for the result of the call before it, and how many times our time others take".to_owned(), peers::dependent(report), DEPENDENT),
        ("The fastest build of each engine, by the letter of its build, and how many times our time it takes".to_owned(), peers::engines(report), ""),
        (format!("Time of a call in each build of other libraries{}", peers::letters(report)), peers::builds(report), ""),
        (
            format!("Largest error in units of 2⁻⁵³ of the sum of the magnitudes of the terms, against {} in big floats", against(report)),
            errors(report),
            ERRORS,
        ),
        (
            "Multiplications and additions after each stage of the generator (the last: what is emitted)".to_owned(),
            operations(report),
            &stages,
        ),
        (
            format!(
                "What is emitted (a multiply-add is one instruction; sines and cosines apart), and what it costs to make it, {} at a time",
                crate::parallel::threads()
            ),
            sizes(report),
            SIZES,
        ),
        (
            "The same of code that others generate, of each engine its fastest build (operations as they count them)".to_owned(),
            peers::costs(report),
            "",
        ),
    ]
    .into_iter()
    .chain(report.making.iter().map(peers::making).map(|(title, table)| (title, table, "")))
    {
        if !table.is_empty() {
            let legend = if legend.is_empty() { String::new() } else { wrapped(&format!("  {legend}\n")) };
            let _ = write!(out, "\n{}{}{legend}", wrapped(&(title + "\n")), indent(&table.text()));
        }
    }
    out
}

const TIMES: &str = "generated: for this processor; any processor: the same source for any of its kind, where that is other code; generic: the library, for any robot";
const BATCHES: &str = "blocks: 8 states (f32: 16) with each of their numbers side by side; states: one state after the other, to be turned first; \
                       generated/it: how many times its time a call of generated code takes";
const DEPENDENT: &str = "as in a controller, where the next state follows from the last result: q + 0·(first + last number of the result); where calls do \
                         not depend on each other, as above, a processor begins a call before the last one has ended; –: the result stays inside the library";
/// Reference for errors.
fn against(report: &Report) -> &'static str {
    match report.reference {
        Against::Textbook => "an independent evaluation",
        Against::Library => "the generic library",
    }
}

const ERRORS: &str = "forward: of the result; backward: of the torques that the result needs; states: on which they were looked at, without those where the function is singular";
/// The meaning of the stages in the table; equal ones together.
fn stages_of(report: &Report) -> String {
    let titles = titles(report);
    let mut told: Vec<(Vec<&str>, &str)> = Vec::new();
    for (name, does) in stages().filter(|(name, _)| titles.contains(name)) {
        match told.last_mut() {
            Some((names, same)) if *same == does => names.push(name),
            _ => told.push((vec![name], does)),
        }
    }
    told.iter().map(|(names, does)| format!("{}: {does}", names.join(", "))).collect::<Vec<_>>().join("; ")
}

const SIZES: &str = "depth: the longest chain of operations that wait for each other; /time: bytes of machine code for a nanosecond of a call: if they are far fewer than of a short function, the code waits for the instruction cache; way chosen: how it is computed, where there are several ways, by count (LTDL: by factors of the mass \
                     matrix; ABA: by the articulated-body algorithm)";

/// A row for each function, under the name of its group if there are several groups.
fn by_function(report: &Report, table: &mut Table, cells: impl Fn(&FunctionReport) -> Option<Vec<String>>) {
    let several = report.functions.iter().any(|f| f.group != report.functions[0].group);
    let mut group = "";
    for f in &report.functions {
        let Some(cells) = cells(f) else { continue };
        if several && group != f.group {
            group = f.group;
            table.heading(group);
        }
        let name = if several { format!("  {}", f.function) } else { f.function.to_owned() };
        table.row(std::iter::once(name).chain(cells));
    }
}

fn head(report: &Report) -> String {
    let [x, y, z] = report.gravity.map(Plain);
    let mut out = format!(
        "{}, {} base: {}, {}; gravity ({x}, {y}, {z}) m/s²\n{} (seed {}), {} interleaved repetitions; {} {}\n",
        plain(&named(&report.robot, report.scene.as_deref())),
        report.base,
        counted(report.joints, "joint"),
        freedom(report.degrees_of_freedom),
        counted(report.states as usize, "random state"),
        report.seed,
        report.repetitions,
        report.compiler,
        report.flags,
    );
    if report.functions.iter().any(|f| f.frames.is_some()) {
        let how = if report.frames_chosen { "as chosen" } else { "the tips of the robot; --frames chooses others" };
        let _ = writeln!(out, "functions of frames: {} ({how})", plain(&report.frames.join(", ")));
        for f in &report.functions {
            if let Some(frames) = f.frames.as_ref().filter(|frames| **frames != report.frames) {
                let _ = writeln!(out, "{}: {} (those with six degrees of freedom)", f.function, plain(&frames.join(", ")));
            }
        }
    }
    if !report.optimised {
        out += "This command was built without optimisation: times of generic code and of the generation mean little.\n";
    }
    for note in &report.notes {
        let _ = writeln!(out, "note: {}", plain(note));
    }
    wrapped(&out)
}

fn operations(report: &Report) -> Table {
    let titles = titles(report);
    let mut table = Table::new(["function"].into_iter().chain(titles.iter().copied()).map(|t| (t, "")));
    let cell = |f: &FunctionReport, title: &str| {
        let stage = f.stages.iter().find(|s| s.stage == title);
        stage.map_or_else(|| "–".to_owned(), |s| format!("{}+{}", s.multiplications, s.additions))
    };
    by_function(report, &mut table, |f| Some(titles.iter().map(|title| cell(f, title)).collect()));
    table
}

/// The stages that any function went through, in their order.
fn titles(report: &Report) -> Vec<&str> {
    let mut titles: Vec<&str> = Vec::new();
    for function in &report.functions {
        let mut next = 0;
        for stage in &function.stages {
            match titles.iter().position(|title| *title == stage.stage) {
                Some(at) => next = at + 1,
                None => {
                    titles.insert(next, &stage.stage);
                    next += 1;
                }
            }
        }
    }
    titles
}

fn sizes(report: &Report) -> Table {
    let mut table = Table::new([
        ("function", ""),
        ("instructions", ""),
        ("sin, cos", ""),
        ("depth", "operations"),
        ("machine code", "bytes"),
        ("/time", "bytes/ns"),
        ("source", "bytes"),
        ("generation", "ms"),
        ("rustc", "ms"),
        ("way chosen", ""),
    ]);
    by_function(report, &mut table, |f| {
        let emitted = |what: fn(&Stage) -> u64| f.stages.last().map_or(0, what).to_string();
        Some(vec![
            emitted(|s| s.instructions),
            emitted(|s| s.sines_and_cosines),
            f.depth.to_string(),
            f.code_bytes.map_or_else(|| "–".into(), |n| n.to_string()),
            f.code_bytes.map_or_else(|| "–".into(), |n| format!("{:.1}", n as f64 / f.generated.median)),
            f.source_bytes.to_string(),
            format!("{:.1}", f.generation_seconds * 1e3),
            format!("{:.0}", f.compilation_seconds * 1e3),
            f.ways.join(", "),
        ])
    });
    table
}

fn times(report: &Report) -> Table {
    let variants: &[VariantReport] = report.functions.first().map_or(&[], |f| &f.variants);
    let mut columns: Vec<(String, &str)> =
        [("function", ""), ("generated", "ns"), ("IQR", "ns")].into_iter().map(|(t, u)| (t.to_owned(), u)).collect();
    columns.extend(variants.iter().flat_map(|v| [(v.variant.clone(), "ns"), ("/generated".to_owned(), "ratio")]));
    let generic = [("generic", "ns"), ("IQR", "ns"), ("generic/generated", "ratio"), ("IQR", "ratio")];
    columns.extend(generic.into_iter().map(|(t, u)| (t.to_owned(), u)));
    let mut table = Table::new(columns);
    by_function(report, &mut table, |f| {
        let own = |s: &Summary| [nanoseconds(s.median), nanoseconds(spread(s))];
        let mut cells = own(&f.generated).to_vec();
        cells.extend(f.variants.iter().flat_map(|v| [nanoseconds(v.time.median), times_of(v.over_generated.median)]));
        cells.extend(own(&f.generic));
        let ratio = &f.generic_over_generated;
        cells.extend([times_of(ratio.median), times_of(spread(ratio))]);
        Some(cells)
    });
    table
}

fn errors(report: &Report) -> Table {
    let bits = format!("{} bits", report.reference_bits);
    let mut table = Table::new([
        ("function", String::new()),
        ("generated", "units".into()),
        ("generic", "units".into()),
        ("bound", "units".into()),
        ("states", String::new()),
        ("against", bits),
    ]);
    by_function(report, &mut table, |f| {
        Some(match f.errors {
            Some(e) if e.states == 0 => ["–", "–", "–", "0", "singular in every state"].map(str::to_owned).to_vec(),
            Some(e) => vec![
                format!("{:.2}", e.generated),
                format!("{:.2}", e.generic),
                format!("{}", report.bound),
                e.states.to_string(),
                e.kind.into(),
            ],
            None => ["–", "–", "–", "–", "no independent reference"].map(str::to_owned).to_vec(),
        })
    });
    table
}

/// Two sentences: how much faster generated code is, and how exact.
fn summary(report: &Report) -> String {
    let ratio = |f: &FunctionReport| f.generic_over_generated.median;
    let Some(best) = report.functions.iter().max_by(|a, b| ratio(a).total_cmp(&ratio(b))) else { return String::new() };
    let least = times_of(report.functions.iter().map(ratio).fold(f64::INFINITY, f64::min));
    let most = times_of(ratio(best));
    let gain = if least == most { format!("{most} times") } else { format!("{least} times to {most} times ({})", best.function) };
    format!(
        "On this machine, the library's generic code, which serves any robot, takes {gain} as long for a call as the code that is generated for \
         this robot.\n{}",
        accuracy(report)
    )
}

fn accuracy(report: &Report) -> String {
    let errors: Vec<f64> = report.functions.iter().filter_map(|f| f.errors).map(|e| e.generated).collect();
    let worst = errors.iter().copied().fold(0.0, |a: f64, b| if b.is_nan() || b > a { b } else { a });
    if errors.is_empty() {
        return "None of these functions has a reference yet, so the accuracy of neither code is known.\n".into();
    }
    let verdict = if worst <= report.bound { "within the bound of" } else { "which is more than rounding explains: the bound is" };
    format!(
        "The largest error of generated code is {worst:.1} roundings of one operation (2⁻⁵³, about 1.1e-16), relative to the sum of the magnitudes \
         of the terms, {verdict} {}.\n",
        report.bound
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

/// A row for each function, type and layout.
fn batches(report: &Report) -> Table {
    let engines = report.engines();
    let titles = [("function", ""), ("numbers", ""), ("layout", ""), ("a state", "ns"), ("IQR", "ns"), ("generated/it", "ratio")];
    let peers = engines.iter().map(|engine| (format!("{engine}/it"), "ratio"));
    let columns = titles.map(|(title, unit)| (title.to_owned(), unit)).into_iter().chain(peers);
    let mut table = Table::new(columns.chain([("largest difference".to_owned(), "of magnitude")])).left(3);
    for (f, b) in report.functions.iter().flat_map(|f| f.batches.iter().map(move |b| (f, b))) {
        let mut cells = [f.function, b.numbers, b.layout].map(str::to_owned).to_vec();
        cells.extend([nanoseconds(b.time.median), nanoseconds(spread(&b.time)), times_of(b.generated_over_batch.median)]);
        cells.extend(engines.iter().map(|e| b.fastest_of(e).map_or_else(|| "–".into(), |p| times_of(p.peer_over_batch.median))));
        cells.push(b.largest_difference.map_or_else(|| "not compared".into(), |d| format!("{d:.1e}")));
        table.row(cells);
    }
    table
}
