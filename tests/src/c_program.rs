//! Runs generated C. The system's compiler compiles it as strict C99; the program reads states and
//! writes results.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use articulated_codegen::{File, Generated};
use articulated_core::algorithm::{Shape, function};

use crate::program::Program;

/// The system's compiler of C, without which no Rust program can be linked either.
fn compiler() -> Command {
    Command::new(std::env::var_os("CC").unwrap_or_else(|| "cc".into()))
}

/// Every warning is an error; products and sums are rounded one after the other, as the interpreter
/// does.
const FLAGS: [&str; 9] = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror", "-O1", "-ffp-contract=off"];

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

/// Compiles the C of several robots, whose names are their prefixes, as one program.
///
/// # Panics
/// If the compiler refuses the program: its message is printed.
#[must_use]
pub fn build(robots: &[(&str, Shape, &Generated)]) -> Program {
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
    compile(folder.path(), &sources, &program);
    Program::compiled(program, start.elapsed(), folder)
}

fn compile(folder: &Path, sources: &[String], program: &Path) {
    let mut command = compiler();
    command.current_dir(folder).args(FLAGS).arg("-o").arg(program).args(sources).arg("-lm");
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
        for name in generated.ledger.functions.iter().map(|e| &e.function) {
            let row = function::<f64>(name).expect("a function of the registry");
            let lengths: Vec<usize> = row.takes.iter().map(|a| a.len(*shape)).collect();
            let mut at = 0;
            let mut list = String::new();
            for length in lengths {
                let _ = write!(list, "{from} + {at}, ");
                at += length;
            }
            let results = row.len(*shape);
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
        }
    }
    text + "    return 1;\n}\n"
}
