//! Generated modules as a program: compiled by the user's compiler; it reads states and returns
//! results.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::PathBuf;
use std::process::Stdio;
use std::sync::Arc;
use std::time::{Duration, Instant};

use articulated_codegen::Generated;

use crate::machine;

/// Several robots' generated modules, compiled as one program.
#[derive(Debug)]
pub struct Program {
    file: PathBuf,
    /// How long the compiler took.
    pub time: Duration,
    /// A variable that is set for the run.
    variable: Option<&'static str>,
    _folder: Arc<tempfile::TempDir>,
}

impl Program {
    /// Compiles; `flags` go to the compiler, and a warning is an error. The modules must be
    /// generated without a runtime crate and their names must be identifiers.
    ///
    /// # Panics
    /// If the compiler refuses the program: its message is printed.
    pub fn build(robots: &[(&str, &Generated)], flags: &[&str]) -> Self {
        Self::of(robots, &main(robots), flags)
    }

    /// The same with another `main`, which must follow the format of [`Program::run`].
    pub(crate) fn of(robots: &[(&str, &Generated)], main: &str, flags: &[&str]) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("a folder that can be written");
        for (name, generated) in robots {
            write(&format!("{name}.rs"), &generated.source);
        }
        write("main.rs", main);
        let file = folder.path().join(format!("program{}", std::env::consts::EXE_SUFFIX));
        let start = Instant::now();
        let mut command = machine::compiler(flags);
        command.args(["--edition", "2024", "--crate-name", "program"]);
        let answer = command.arg("-o").arg(&file).arg(folder.path().join("main.rs")).output().expect("a Rust compiler");
        assert!(answer.status.success(), "refused: {}", String::from_utf8_lossy(&answer.stderr));
        Self::compiled(file, start.elapsed(), folder)
    }

    /// A program that was compiled in this folder.
    pub(crate) fn compiled(file: PathBuf, time: Duration, folder: tempfile::TempDir) -> Self {
        Self { file, time, variable: None, _folder: Arc::new(folder) }
    }

    /// The same program, which runs with this variable of the environment.
    pub fn with_variable(&self, variable: &'static str) -> Self {
        Self { file: self.file.clone(), variable: Some(variable), _folder: self._folder.clone(), ..*self }
    }

    /// Results of one function for many states: each a list of arguments in the registry's order.
    ///
    /// # Panics
    /// If the program fails, as it would on a panic in generated code.
    pub fn run(&self, robot: &str, function: &str, states: &[Vec<&[f64]>]) -> Vec<Vec<f64>> {
        let mut child = machine::run(&self.file)
            .envs(self.variable.map(|variable| (variable, "1")))
            .args([robot, function, &states.len().to_string()])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the program that was compiled");
        let input: Vec<u8> = states.iter().flatten().copied().flatten().flat_map(|x| x.to_le_bytes()).collect();
        // The program reads all before it writes anything.
        child.stdin.take().expect("a pipe").write_all(&input).expect("a program that reads");
        let output = child.wait_with_output().expect("a program that ends");
        assert!(output.status.success(), "{robot}::{function} failed");
        let number = |bytes: &[u8]| f64::from_le_bytes(bytes.try_into().expect("eight bytes"));
        let numbers: Vec<f64> = output.stdout.chunks_exact(8).map(number).collect();
        let each = numbers.len() / states.len();
        (0..states.len()).map(|k| numbers[k * each..(k + 1) * each].to_vec()).collect()
    }
}

const HEAD: &str = "\
#![allow(dead_code)]
#![deny(warnings)]
use std::io::{Read, Write};

trait Numbers {
    fn take(x: &mut &[f64]) -> Self;
    fn add_to(&self, out: &mut Vec<f64>);
}

impl Numbers for f64 {
    fn take(x: &mut &[f64]) -> f64 {
        let (first, rest) = x.split_first().unwrap();
        *x = rest;
        *first
    }

    fn add_to(&self, out: &mut Vec<f64>) {
        out.push(*self);
    }
}

impl<T: Numbers, const N: usize> Numbers for [T; N] {
    fn take(x: &mut &[f64]) -> Self {
        std::array::from_fn(|_| T::take(x))
    }

    fn add_to(&self, out: &mut Vec<f64>) {
        self.iter().for_each(|t| t.add_to(out));
    }
}

/// Whether the processor has AVX2. The variable WITHOUT_AVX2 turns it off.
#[cfg(target_arch = \"x86_64\")]
fn has_avx2() -> bool {
    static ANSWER: std::sync::OnceLock<bool> = std::sync::OnceLock::new();
    *ANSWER.get_or_init(|| std::env::var_os(\"WITHOUT_AVX2\").is_none() && std::is_x86_feature_detected!(\"avx2\"))
}

/// A result, and the same written where there were other numbers.
fn assert_same(y: &impl Numbers, z: &impl Numbers) {
    let (mut value, mut written) = (Vec::new(), Vec::new());
    y.add_to(&mut value);
    z.add_to(&mut written);
    let same = |(a, b): (&f64, &f64)| a == b || a.is_nan() && b.is_nan();
    assert!(value.len() == written.len() && value.iter().zip(&written).all(same), \"{value:?} was written as {written:?}\");
}

#[allow(unused)]
fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let nothing = vec![f64::NAN; 1 << 17];
    let mut bytes = Vec::new();
    std::io::stdin().read_to_end(&mut bytes).unwrap();
    let numbers: Vec<f64> = bytes.chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect();
    let mut x = &numbers[..];
    let mut out: Vec<f64> = Vec::new();
    for _ in 0..arguments[3].parse::<usize>().unwrap() {
        match (arguments[1].as_str(), arguments[2].as_str()) {
";

const TAIL: &str = "\
            _ => panic!(\"no such function\"),
        }
    }
    let bytes: Vec<u8> = out.iter().flat_map(|y| y.to_le_bytes()).collect();
    std::io::stdout().write_all(&bytes).unwrap();
}
";

fn main(robots: &[(&str, &Generated)]) -> String {
    let mut out = HEAD.to_owned();
    for (robot, generated) in robots {
        for entry in &generated.ledger.functions {
            let name = &entry.function;
            let names: Vec<String> = (0..entry.arguments.len()).map(|k| format!("a{k}")).collect();
            let taken: String = names.iter().map(|a| format!("                let {a} = Numbers::take(&mut x);\n")).collect();
            let arguments: String = names.iter().map(|a| format!("&{a}, ")).collect();
            let _ = writeln!(out, "            ({robot:?}, {name:?}) => {{\n{taken}                let y = {robot}::{name}({arguments});");
            if generated.source.contains(&format!("pub fn {name}_into(")) {
                out += "                let mut z = Numbers::take(&mut &nothing[..]);\n";
                let _ = writeln!(out, "                {robot}::{name}_into({arguments}&mut z);\n                assert_same(&y, &z);");
            }
            out += "                y.add_to(&mut out);\n            }\n";
        }
    }
    out += TAIL;
    for (robot, _) in robots {
        // As in a crate that has other things under the names of the prelude.
        let _ =
            writeln!(out, "#[no_implicit_prelude]\n#[deny(unused_results, trivial_numeric_casts, unused_qualifications)]\nmod {robot};");
    }
    out
}
