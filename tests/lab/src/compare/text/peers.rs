//! Tables of other libraries.

use super::super::making::Making;
use super::super::report::{FunctionReport, PeerReport, Report};
use super::{by_function, nanoseconds, times_of};
use crate::table::{Table, plain};

/// Names of all peers that were timed, in the order in which they were opened.
fn names(report: &Report) -> Vec<&str> {
    let timed = |name: &str| report.functions.iter().any(|f| f.peers.iter().any(|p| p.peer == name));
    report.peers.iter().map(|p| p.peer.as_str()).filter(|name| timed(name)).collect()
}

/// A line for each peer: its letter, its name, and details of its library.
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

/// Calls that wait for each other: ours, and the fastest build of each engine.
pub(super) fn dependent(report: &Report) -> Table {
    let engines = report.engines();
    let titles = engines.iter().flat_map(|engine| [(*engine, "ns"), ("/ours", "ratio")]);
    let own = [("function", ""), ("generated", "ns"), ("/independent", "ratio")];
    let mut table = Table::new(own.into_iter().chain(titles));
    by_function(report, &mut table, |f| {
        let ours = f.dependent?.median;
        let of = |engine: &&str| {
            let times = f.peers.iter().filter(|p| p.engine == *engine).filter_map(|p| p.dependent);
            let least = times.map(|t| t.median).min_by(f64::total_cmp);
            least.map_or_else(|| ["–", "–"].map(str::to_owned), |ns| [nanoseconds(ns), times_of(ns / ours)])
        };
        Some([nanoseconds(ours), times_of(ours / f.generated.median)].into_iter().chain(engines.iter().flat_map(of)).collect())
    });
    table
}

/// Peers that compute several states a call: a row for each function and build.
pub(super) fn in_lanes(report: &Report) -> Table {
    let titles = [
        ("function", ""),
        ("peer", ""),
        ("states a call", ""),
        ("a state", "ns"),
        ("it/f64 blocks", "ratio"),
        ("largest difference", "of magnitude"),
    ];
    let mut table = Table::new(titles).left(2);
    for (f, p) in report.functions.iter().flat_map(|f| f.peers_in_lanes.iter().map(move |p| (f, p))) {
        let ours = f.batches.iter().find(|b| b.numbers == "f64" && b.layout == "blocks").map(|b| p.time.median / b.time.median);
        let mut cells = vec![f.function.to_owned(), plain(&p.peer).to_string(), p.lanes.to_string(), nanoseconds(p.time.median)];
        cells.push(ours.map_or_else(|| "–".into(), times_of));
        cells.push(p.largest_difference.map_or_else(|| "not compared".into(), |d| format!("{d:.1e}")));
        table.row(cells);
    }
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

/// The largest difference of any peer, relative to its bound, shown as it is.
fn difference(f: &FunctionReport) -> Option<f64> {
    let known = f.peers.iter().filter_map(|p| Some((p.largest_difference?, p.bound)));
    known.reduce(|a, b| if a.0.is_nan() || a.0 / a.1 >= b.0 / b.1 { a } else { b }).map(|(d, _)| d)
}

/// Details of others' generated code: for each engine's fastest build, if it has any.
pub(super) fn costs(report: &Report) -> Table {
    let names = names(report);
    let generated = |engine: &&str| report.functions.iter().any(|f| f.fastest_of(engine).is_some_and(|p| p.cost.is_some()));
    let engines: Vec<&str> = report.engines().into_iter().filter(generated).collect();
    let titles = engines.iter().flat_map(|engine| {
        [(*engine, "build"), ("operations", ""), ("machine code", "bytes"), ("generation", "ms"), ("compilation", "ms")]
    });
    let mut table = Table::new(std::iter::once(("function", "")).chain(titles));
    by_function(report, &mut table, |f| {
        let known: Vec<Option<&PeerReport>> = engines.iter().map(|e| f.fastest_of(e).filter(|p| p.cost.is_some())).collect();
        known.iter().any(Option::is_some).then(|| known.iter().flat_map(|peer| cost_cells(&names, *peer)).collect())
    });
    table
}

fn cost_cells(names: &[&str], peer: Option<&PeerReport>) -> [String; 5] {
    let Some((peer, cost)) = peer.and_then(|p| Some((p, p.cost.as_ref()?))) else {
        return ["–"; 5].map(str::to_owned);
    };
    let count = |n: Option<u64>| n.map_or_else(|| "–".into(), |n| n.to_string());
    let [generation, compilation] = [cost.generation_seconds, cost.compilation_seconds].map(|s| format!("{:.1}", s * 1e3));
    [letter_of(names, peer), count(cost.operations), count(cost.code_bytes), generation, compilation]
}

/// Generation and compilation of several functions, under a title.
pub(super) fn making(making: &Making) -> (String, Table) {
    let columns = [("whose", ""), ("generation", "ms"), ("compilation", "ms"), ("together", "ms"), ("/ours", "ratio")];
    let mut table = Table::new(columns);
    let milliseconds = |seconds: f64| format!("{:.0}", seconds * 1e3);
    let cells = |who: &str, generation: Option<f64>, compilation: f64, ratio: Option<f64>| {
        let told = |x: Option<f64>, text: &dyn Fn(f64) -> String| x.map_or_else(|| "–".into(), text);
        let together = milliseconds(generation.unwrap_or_default() + compilation);
        [who.to_owned(), told(generation, &milliseconds), milliseconds(compilation), together, told(ratio, &times_of)]
    };
    table.row(cells("ours", Some(making.generation_seconds), making.compilation_seconds, Some(1.0)));
    for p in &making.peers {
        table.row(cells(&p.peer, p.generation_seconds, p.compilation_seconds, p.peer_over_ours));
    }
    let whole = making.peers.iter().any(|p| p.generation_seconds.is_none());
    let rest = if whole { "; without generation: a library for any robot, all of its functions" } else { "" };
    (
        format!(
            "Generation and compilation of {}, all together, to object files, with nothing else going on{rest}",
            making.functions.join(", ")
        ),
        table,
    )
}
