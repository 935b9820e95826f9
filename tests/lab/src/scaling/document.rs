//! The measurements as a document.

use std::fmt::Write;
use std::path::Path;

use super::report::Report;
use super::text::{COLUMNS, cells, crossover, growth};

const HEAD: &str = "\
Made by `articulated scaling --markdown`; docs/scaling.md by `articulated scaling --all --markdown --chart docs/scaling.svg`.

Straight-line code grows with the robot. From some length on it no longer fits the caches. A loop over the joints, whose code does not grow, is then
faster. This page measures from which length on. The robots are serial arms of revolute joints; axes change from joint to joint, every fifth is askew, and links
have a full inertia. *Generic* is the same algorithm as a library, in loops over the joints.

* *Hot*: the function is called again and again on eight states, as in a simulation or an optimiser.
* *Cold*: before every call the benchmark writes 64 MiB of data and runs 2²⁰ instructions of straight-line code, so no cache holds the code or the data of
  the function. A control loop that runs once a millisecond between other work is like that. The branch predictor stays warm, which favours loops. The clock
  adds some tens of ns. The crossover depends on how fast a processor loads code from memory. Where both times are close over a wide range, it changes
  from run to run.
* *Generation*: from the URDF's text to the source, in an optimised program. A build script is compiled without optimisation, unless the profile has
  `[profile.dev.build-override] opt-level = 3`, and takes about ten times as long: 2.0 s in place of 0.2 s of one core (Zen 4), with the reading of the URDF,
  for inverse dynamics of a simpler chain of 1000 joints (axes along coordinates, equal links). The test `a_chain_of_a_thousand_joints_is_generated` measures it.
* *rustc*: with its start and linking, for code of that function alone.
* A mass matrix has n² elements. Its code, compilation and time grow in the same way, so it is measured up to 16 000 elements.
";

const TAIL: &str = "
## What grows faster than the chain

* Matrices, as above. Derivatives and regressors have matrices too.
* Forward dynamics by M = Lᵀ D L grows with the cube of the length. It costs less for short chains. The generator does not try it if its multiplications alone
  exceed all operations of the articulated-body algorithm.
* The library's workspace has room for a matrix of n². Functions without matrices never touch it.

## What is generated once

`articulated_codegen::Build` stores all inputs beside its output: every option, every robot file, and the version of the generator. A build script that runs
again with the same inputs generates nothing, and the file keeps its date, so nothing is compiled again. Build compares the bytes themselves, not a hash.

The macro `robot!` has no such cache. It is expanded each time the user's crate is compiled. It has no folder for a cache: Cargo sets `OUT_DIR` only for crates
with a build script and `CARGO_TARGET_TMPDIR` only for tests and benches, and it would neither know nor remove other files. A macro cannot find out that it was
compiled anew either, as a build script can. The gain would be small: `panda_like` with five functions (derivatives among them) and `humanoid` with three, half a
megabyte of source, are expanded in 0.75 s where procedural macros are compiled without optimisation. Generation takes 0.45 s of it; the compiler reads the tokens
in any case. If that is too long, set `[profile.dev.build-override] opt-level = 3`, or use a build script.
";

pub(super) fn markdown(report: &Report, chart: Option<&Path>) -> String {
    let joints = || report.points.iter().map(|p| p.joints);
    let chains = match (joints().min(), joints().max()) {
        (Some(least), Some(most)) if least < most => format!("Chains from {least} to {most} joints"),
        (least, _) => format!("A chain of {} joints", least.unwrap_or(0)),
    };
    let mut out = format!("# {chains}\n\n{HEAD}\n`{} {}`; medians of {}.\n", report.compiler, report.flags, report.repetitions);
    if let Some(name) = chart.and_then(Path::file_name) {
        let _ = writeln!(out, "\n![Time of a call against the number of joints]({})", name.to_string_lossy());
    }
    report.crossovers.iter().for_each(|c| out += &format!("\n* {}.", crossover(c)));
    report.growth.iter().for_each(|g| out += &format!("\n* {}.", growth(g)));
    out.push('\n');
    for (function, points) in report.functions() {
        let head: String = COLUMNS.iter().map(|(title, unit)| format!(" {} |", format!("{title} {unit}").trim())).collect();
        let _ = writeln!(out, "\n## `{function}`\n\n|{head}\n|{}", "--:|".repeat(COLUMNS.len()));
        for p in points {
            let _ = writeln!(out, "| {} |", cells(p).join(" | "));
        }
    }
    out + TAIL
}
