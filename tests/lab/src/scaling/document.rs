//! The measurements as a document.

use std::fmt::Write;
use std::path::Path;

use super::report::Report;
use super::text::{COLUMNS, cells, crossover, growth};

const HEAD: &str = "\
Made by `articulated scaling --markdown`; docs/scaling.md by `articulated scaling --all --markdown --chart docs/scaling.svg`.

Straight-line code grows with the robot: from some length on it no longer fits the caches, and a loop over the joints, which is the same code for
each, is faster. The measurements say from which. The robots are serial arms of revolute joints with axes that change from joint to joint, every fifth askew, and links with a full
inertia. *Generic* is the same algorithm as a library, in loops over the joints.

* *Hot*: the function is called again and again on eight states, as in a simulation or an optimiser.
* *Cold*: before every single call 64 MiB of data are written to and 2²⁰ instructions of straight-line code are run, so that neither the code nor the data of the function are in
  any cache; as when a control loop calls it once a millisecond between other work. What the processor has learnt of branches stays, to the advantage of loops. The clock, some tens of ns, is in it. The length
  from which on generic code is faster depends on how soon a processor has code from its memory; where the two are near each other over a wide range, it moves from run to run.
* *Generation*: from the URDF's text to the source, in an optimised program. A build script is compiled without optimisation unless the profile says otherwise
  (`[profile.dev.build-override] opt-level = 3`) and takes about ten times as long: 2.0 s instead of 0.2 s of one core (Zen 4), the reading of the URDF included, for inverse dynamics of a plainer chain of 1000 joints (axes along coordinates, all links alike) than those below; the test
  `a_chain_of_a_thousand_joints_is_generated` says how to have that time.
* *rustc*: its start and linking included, for code of that function alone.
* A mass matrix has n² elements, and so grow its code, its compilation and its time: it is measured while it has at most 16 000 of them.
";

const TAIL: &str = "
## What grows faster than the chain

* Matrices, as said. Derivatives and regressors have matrices too.
* Forward dynamics by M = Lᵀ D L grows with the cube. It is the cheaper way for short chains; the generator does not even try it where its multiplications alone are more than the
  whole of the articulated-body algorithm.
* The library's workspace has room for a matrix of n², which functions without matrices never touch.

## What is generated once

`articulated_codegen::Build` keeps beside its output everything that it follows from: every option, every URDF, and which program the generator was. A build script that is run again
with nothing changed generates nothing, and the file keeps its date, so that nothing is compiled again. Compared are the bytes themselves, not a hash of them.

The macro `robot!` has no such memory. It is expanded whenever the user's crate is compiled, and only then. There is no place where it could keep anything: `OUT_DIR` is set only for crates with a
build script, `CARGO_TARGET_TMPDIR` only for tests and benches, and the compiler's own `--out-dir` is neither promised to a macro nor there in an editor; a file that a macro writes is one that cargo neither
knows of nor removes. Nor can a macro tell that it was compiled anew, as a build script can: the program that runs is the compiler. What there is to gain: `panda_like` with five functions (derivatives
among them) and `humanoid` with three, half a megabyte of source, are expanded in 0.75 s where procedural macros are compiled without optimisation. 0.45 s of it is the generation; the rest is the
tokens, which the compiler has to read in any case. Who finds that long sets `[profile.dev.build-override] opt-level = 3`, or takes a build script.
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
