//! Tables of other libraries.

use super::super::report::{FunctionReport, PeerReport, Report};
use super::{by_function, nanoseconds, times_of};
use crate::table::{Table, plain};

/// Names of all peers that were timed, in the order in which they were opened.
fn names(report: &Report) -> Vec<&str> {
    let timed = |name: &str| report.functions.iter().any(|f| f.peers.iter().any(|p| p.peer == name));
    report.peers.iter().map(|p| p.peer.as_str()).filter(|name| timed(name)).collect()
}

/// A line for each peer: its letter, its name, and what is known of its library.
pub(super) fn letters(report: &Report) -> String {
    let line = |(k, name): (usize, &str)| {
        let library = report.peers.iter().find(|p| p.peer == name).map(|p| &p.library);
        let texts = library.map(|l| [&l.engine, &l.compiler, &l.version, &l.flags]).into_iter().flatten();
        let mut known: Vec<String> = texts.flatten().cloned().collect();
        known.extend(library.and_then(|l| l.element.clone()));
        known.extend(library.and_then(|l| l.text_bytes).map(|n| format!("{n} bytes of machine code")));
        known.extend(library.and_then(|l| l.compilation_seconds).map(|s| format!("compiled in {s:.0} s")));
        format!("\n  {}: {}  {}", letter(k), plain(name), plain(&known.join(", "))).trim_end().to_owned()
    };
    names(report).into_iter().enumerate().map(line).collect()
}

fn letter(k: usize) -> String {
    u8::try_from(k).ok().filter(|k| *k < 26).map_or_else(|| format!("#{k}"), |k| char::from(b'A' + k).to_string())
}

fn letter_of(names: &[&str], peer: &PeerReport) -> String {
    names.iter().position(|name| *name == peer.peer).map_or_else(String::new, letter)
}

/// The fastest build of each engine.
pub(super) fn engines(report: &Report) -> Table {
    let (engines, names) = (report.engines(), names(report));
    let titles = engines.iter().flat_map(|engine| [(*engine, "ns"), ("", "build"), ("/ours", "ratio")]);
    let mut table = Table::new([("function", ""), ("generated", "ns")].into_iter().chain(titles));
    by_function(report, &mut table, |f| {
        f.fastest()?;
        let cells =
            |peer: &PeerReport| [nanoseconds(peer.time.median), letter_of(&names, peer), times_of(1.0 / peer.generated_over_peer.median)];
        let of = |engine: &&str| f.fastest_of(engine).map_or_else(|| ["–", "", "–"].map(str::to_owned), cells);
        Some(std::iter::once(nanoseconds(f.generated.median)).chain(engines.iter().flat_map(of)).collect())
    });
    table
}

/// All builds.
pub(super) fn builds(report: &Report) -> Table {
    let names = names(report);
    let titles = (0..names.len()).map(letter).chain(["fastest/generated".into(), "largest difference".into()]);
    let units = std::iter::repeat_n("ns", names.len()).chain(["ratio", "of magnitude"]);
    let mut table = Table::new(std::iter::once(("function".to_owned(), "")).chain(titles.zip(units)));
    by_function(report, &mut table, |f| {
        let fastest = f.fastest()?;
        let own = |name: &str| f.peers.iter().find(|p| p.peer == name).map_or_else(|| "–".into(), |p| nanoseconds(p.time.median));
        let mut cells: Vec<String> = names.iter().map(|name| own(name)).collect();
        cells.push(times_of(1.0 / fastest.generated_over_peer.median));
        cells.push(difference(f).map_or_else(|| "not compared".into(), |d| format!("{d:.1e}")));
        Some(cells)
    });
    table
}

/// The largest difference of any peer, each as a part of what it may be, shown as it is.
fn difference(f: &FunctionReport) -> Option<f64> {
    let known = f.peers.iter().filter_map(|p| Some((p.largest_difference?, p.bound)));
    known.reduce(|a, b| if a.0.is_nan() || a.0 / a.1 >= b.0 / b.1 { a } else { b }).map(|(d, _)| d)
}

/// What is known of generated code of others: of the fastest build that has any.
pub(super) fn costs(report: &Report) -> Table {
    let names = names(report);
    let columns =
        [("function", ""), ("build", ""), ("operations", ""), ("machine code", "bytes"), ("generation", "ms"), ("compilation", "ms")];
    let mut table = Table::new(columns);
    by_function(report, &mut table, |f| {
        let of = f.peers.iter().filter(|p| p.cost.is_some());
        let peer = of.min_by(|a, b| a.time.median.total_cmp(&b.time.median))?;
        let cost = peer.cost.as_ref()?;
        let count = |n: Option<u64>| n.map_or_else(|| "–".into(), |n| n.to_string());
        let milliseconds = |seconds: f64| format!("{:.1}", seconds * 1e3);
        let times = [cost.generation_seconds, cost.compilation_seconds].map(milliseconds);
        Some([vec![letter_of(&names, peer), count(cost.operations), count(cost.code_bytes)], times.to_vec()].concat())
    });
    table
}

/// The functions that were made together.
pub(super) fn made(report: &Report) -> String {
    report.making.as_ref().map_or_else(String::new, |m| m.functions.join(", "))
}

/// Generation and compilation of several functions.
pub(super) fn making(report: &Report) -> Table {
    let columns = [("whose", ""), ("generation", "ms"), ("compilation", "ms"), ("together", "ms"), ("/ours", "ratio")];
    let mut table = Table::new(columns);
    let Some(making) = &report.making else { return table };
    let milliseconds = |seconds: f64| format!("{:.0}", seconds * 1e3);
    let cells = |who: &str, generation: f64, compilation: f64, ratio: f64| {
        [who.to_owned(), milliseconds(generation), milliseconds(compilation), milliseconds(generation + compilation), times_of(ratio)]
    };
    table.row(cells("ours", making.generation_seconds, making.compilation_seconds, 1.0));
    for p in &making.peers {
        table.row(cells(&p.peer, p.generation_seconds, p.compilation_seconds, p.peer_over_ours));
    }
    table
}
