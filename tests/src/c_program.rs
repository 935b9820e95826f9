//! Runs generated C. The system's compiler compiles it as strict C99; the program reads states and
//! writes results.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use articulated_codegen::ledger::Entry;
use articulated_codegen::{File, Generated};
use articulated_core::algorithm::Shape;

use crate::program::Program;

/// The system's compiler of C, without which no Rust program can be linked either.
fn compiler() -> Command {
    Command::new(std::env::var_os("CC").unwrap_or_else(|| "cc".into()))
}

/// Every warning is an error; products and sums are rounded one after the other, as the interpreter
/// does.
const FLAGS: [&str; 8] = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror", "-ffp-contract=off"];

/// Whether a compiler is installed.
#[must_use]
pub fn is_there(compiler: &str) -> bool {
    Command::new(compiler).arg("--version").output().is_ok_and(|answer| answer.status.success())
}

/// Checks that a header is free of warnings, in a file of its own.
///
/// # Panics
/// If the compiler warns: its message is printed.
pub fn check_header(compiler: &str, standard: &str, header: &File) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let is_cpp = standard.starts_with("c++");
    let main = folder.path().join(if is_cpp { "main.cpp" } else { "main.c" });
    std::fs::write(folder.path().join(&header.name), &header.text).expect("a folder that can be written");
    std::fs::write(&main, format!("#include \"{0}\"\n#include \"{0}\"\nint main(void) {{ return 0; }}\n", header.name)).expect("as above");
    let flags = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror", "-fsyntax-only"];
    let answer = Command::new(compiler).arg(format!("-std={standard}")).args(flags).arg(main).output().expect("it is there");
    assert!(answer.status.success(), "{compiler} refused {}: {}", header.name, String::from_utf8_lossy(&answer.stderr));
}

/// Checks that a header and its source are free of warnings, with vectors and without, where an
/// inline function counts as any other: Clang warns of one in a source that is not called.
///
/// # Panics
/// If the compiler warns: its message is printed.
pub fn check_source(compiler: &str, files: &[File]) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    files.iter().for_each(|file| std::fs::write(folder.path().join(&file.name), &file.text).expect("a folder that can be written"));
    let [_, source] = files else { panic!("a header and a source") };
    let prefix = source.name.trim_end_matches(".c").to_uppercase();
    for vectors in [String::new(), format!("-D{prefix}_NO_VECTORS")] {
        let mut command = Command::new(compiler);
        // The headers of the processor's vectors are inline functions themselves.
        command.current_dir(&folder).args(&FLAGS[..7]).args(["-fsyntax-only", "-include", "math.h"]);
        if vectors.is_empty() && !source.text.contains("intrin.h") || !vectors.is_empty() {
            command.arg("-Dinline=");
        }
        let answer = command.args(Some(vectors).filter(|flag| !flag.is_empty())).arg(&source.name).output().expect("it is there");
        assert!(answer.status.success(), "{compiler} refused {}: {}", source.name, String::from_utf8_lossy(&answer.stderr));
    }
}

/// Which vectors generated C uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Vectors {
    /// The vectors of any processor of this kind.
    Any,
    /// The vectors of this processor.
    Own,
    /// None: as with a compiler without vectors.
    None,
}

/// Compiles the C of several robots, whose names are their prefixes, as one program; `level` is the
/// compiler's flag for optimisation.
///
/// # Panics
/// If the compiler refuses the program: its message is printed.
#[must_use]
pub fn build(robots: &[(&str, Shape, &Generated)], vectors: Vectors, level: &str) -> Program {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("a folder that can be written");
    let start = Instant::now();
    let mut sources = vec!["main.c".to_owned()];
    for (_, _, generated) in robots {
        for file in &generated.files {
            write(&file.name, &file.text);
            sources.extend(file.name.ends_with(".c").then(|| file.name.clone()));
        }
    }
    write("main.c", &main(robots));
    let program = folder.path().join(format!("program{}", std::env::consts::EXE_SUFFIX));
    let flags: Vec<String> = match vectors {
        Vectors::Any => Vec::new(),
        Vectors::Own => vec!["-march=native".to_owned()],
        Vectors::None => robots.iter().map(|(name, ..)| format!("-D{}_NO_VECTORS", name.to_uppercase())).collect(),
    };
    let flags = [flags, vec![level.to_owned()]].concat();
    compile(folder.path(), &flags, &sources, &program);
    Program::compiled(program, start.elapsed(), folder)
}

/// The output of a program compiled with generated files.
///
/// # Panics
/// If the compiler refuses it, or it fails.
#[must_use]
pub fn run_program(main: &str, files: &[File]) -> String {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut sources = vec!["main.c".to_owned()];
    std::fs::write(folder.path().join("main.c"), main).expect("a folder that can be written");
    for file in files {
        std::fs::write(folder.path().join(&file.name), &file.text).expect("as above");
        sources.extend(file.name.ends_with(".c").then(|| file.name.clone()));
    }
    let program = folder.path().join("program");
    compile(folder.path(), &["-O1".to_owned()], &sources, &program);
    let answer = Command::new(program).output().expect("a program that was compiled");
    assert!(answer.status.success(), "{answer:?}");
    String::from_utf8(answer.stdout).expect("text")
}

fn compile(folder: &Path, flags: &[String], sources: &[String], program: &Path) {
    let mut command = compiler();
    command.current_dir(folder).args(FLAGS).args(flags).arg("-o").arg(program).args(sources).arg("-lm");
    let answer = command.output().expect("a compiler of C");
    assert!(answer.status.success(), "refused: {}", String::from_utf8_lossy(&answer.stderr));
}

const HEAD: &str = "\
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static double in[1 << 20];
static double out[1 << 16];
static float in_single[1 << 20];
static float out_single[1 << 16];

int main(int argc, char **argv) {
    const long states = argc > 3 ? atol(argv[3]) : 0;
    const size_t numbers = fread(in, sizeof(double), sizeof(in) / sizeof(double), stdin);
    const double *x = in;
    const float *y = in_single;
    for (size_t k = 0; k < numbers; k++) {
        in_single[k] = (float)in[k];
    }
    (void)out_single;
    (void)y;
";

fn main(robots: &[(&str, Shape, &Generated)]) -> String {
    let mut text: String = robots.iter().map(|(robot, ..)| format!("#include \"{robot}.h\"\n")).collect();
    text += HEAD;
    for (robot, shape, generated) in robots {
        let single = generated.level.is_single();
        let (from, to) = if single { ("y", "out_single") } else { ("x", "out") };
        for (entry, graph) in generated.ledger.functions.iter().zip(&generated.graphs) {
            let (name, results) = (&entry.function, graph.outputs.len());
            let lengths: Vec<usize> = entry.arguments.iter().map(|a| a.len(*shape)).collect();
            let mut at = 0;
            let mut list = String::new();
            for length in lengths {
                let _ = write!(list, "{from} + {at}, ");
                at += length;
            }
            let widen = if single {
                format!("            for (int j = 0; j < {results}; j++) {{ out[j] = out_single[j]; }}\n")
            } else {
                String::new()
            };
            let _ = writeln!(
                text,
                "    if (!strcmp(argv[1], \"{robot}\") && !strcmp(argv[2], \"{name}\")) {{\n        for (long k = 0; k < states; k++) {{\n            \
                 for (int j = 0; j < {results}; j++) {{ {to}[j] = NAN; }}\n            {robot}_{name}({list}{to});\n{widen}            \
                 fwrite(out, sizeof(double), {results}, stdout);\n            {from} += {at};\n        }}\n        return 0;\n    }}"
            );
            batches(&mut text, robot, (entry, results), *shape, generated);
        }
    }
    text + "    return 1;\n}\n"
}

/// Calls of a function for all states at once: one after the other, and in blocks. Unwritten
/// numbers of results are NaN.
fn batches(text: &mut String, robot: &str, (entry, results): (&Entry, usize), shape: Shape, generated: &Generated) {
    let name = &entry.function;
    let lengths: Vec<usize> = entry.arguments.iter().map(|a| a.len(shape)).collect();
    let taken: usize = lengths.iter().sum();
    for (real, ty, block) in [("f64", "double", 8), ("f32", "float", 16)] {
        for (form, per) in [("batch", 1), ("blocks", block)] {
            if !generated.source.contains(&format!("{robot}_{name}_{form}_{real}(")) {
                continue;
            }
            let _ = writeln!(text, "    if (!strcmp(argv[1], \"{robot}\") && !strcmp(argv[2], \"{name} {form} {real}\")) {{");
            // A state after the last would be found out of bounds by a sanitizer.
            let _ = writeln!(text, "        const size_t blocks = ((size_t)states + {per} - 1) / {per};");
            let mut at = 0;
            for (k, n) in lengths.iter().enumerate() {
                let _ = writeln!(text, "        {ty} *a{k} = malloc(blocks * {per} * {} * sizeof({ty}));", n.max(&1));
                // Compilers warn of loops over no numbers.
                if *n == 0 {
                    continue;
                }
                let _ = writeln!(
                    text,
                    "        for (size_t s = 0; s < blocks * {per}; s++) {{\n            const size_t from = s < (size_t)states ? s : (size_t)states - 1;"
                );
                let _ = writeln!(
                    text,
                    "            for (size_t j = 0; j < {n}; j++) {{ a{k}[(s / {per} * {n} + j) * {per} + s % {per}] = ({ty})x[from * {taken} + {at} + j]; }}\n        }}"
                );
                at += n;
            }
            let _ = writeln!(text, "        {ty} *found = malloc(blocks * {per} * {} * sizeof({ty}));", results.max(1));
            if results > 0 {
                let _ = writeln!(text, "        for (size_t k = 0; k < blocks * {per} * {results}; k++) {{ found[k] = ({ty})NAN; }}");
            }
            let list: String = (0..lengths.len()).map(|k| format!("a{k}, ")).collect();
            let count = if per == 1 { "(size_t)states" } else { "blocks" };
            let _ = writeln!(text, "        {robot}_{name}_{form}_{real}({count}, {list}found);");
            if results > 0 {
                let _ = writeln!(
                    text,
                    "        for (size_t s = 0; s < (size_t)states; s++) {{\n            for (size_t k = 0; k < {results}; k++) {{ out[k] = (double)found[(s / {per} * {results} + k) * {per} + s % {per}]; }}\n            \
                 fwrite(out, sizeof(double), {results}, stdout);\n        }}"
                );
            }
            (0..lengths.len()).for_each(|k| _ = writeln!(text, "        free(a{k});"));
            let _ = writeln!(text, "        free(found);\n        return 0;\n    }}");
        }
    }
}
