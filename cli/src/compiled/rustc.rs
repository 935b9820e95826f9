//! The Rust compiler, as the command calls it.

use std::fmt;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use crate::children;

/// A Rust compiler that was found, and the flags it gets.
#[derive(Clone, Debug)]
pub struct Rustc {
    program: PathBuf,
    /// What it says of its version.
    pub version: String,
}

/// The processors that code is compiled for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// Those of the command itself, so that generated and generic code are compared alike.
    Own,
    /// Any of this kind: what `rustc` compiles for unless it is told.
    Any,
}

impl Target {
    /// Whether the two differ.
    pub fn differ() -> bool {
        Rustc::flags(Self::Own) != Rustc::flags(Self::Any)
    }
}

/// What the compiler makes of a source file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Makes {
    /// A library that can be loaded.
    Library,
    /// Its object file, as a C compiler's `-c` makes it: nothing is linked.
    Object,
}

/// Why generated source could not be run.
#[derive(Debug)]
pub enum CompileError {
    /// No compiler.
    NotFound {
        /// What was called.
        program: PathBuf,
        /// What the system said.
        reason: String,
    },
    /// The compiler refused the source.
    Refused {
        /// The first lines of what it said.
        message: String,
    },
    /// The temporary folder could not be written.
    Folder(std::io::Error),
    /// The library that came out could not be loaded.
    Load(String),
}

impl fmt::Display for CompileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFound { program, reason } => write!(f, "no Rust compiler: {}: {reason}; install one or set RUSTC", program.display()),
            Self::Refused { message } => write!(f, "rustc refused the generated source: {message}"),
            Self::Folder(error) => write!(f, "no temporary folder to compile in: {error}"),
            Self::Load(message) => write!(f, "the compiled library cannot be loaded: {message}"),
        }
    }
}

impl std::error::Error for CompileError {}

impl Rustc {
    /// The compiler that the variable `RUSTC` names, or `rustc`.
    pub fn find() -> Result<Self, CompileError> {
        let program = std::env::var_os("RUSTC").map_or_else(|| PathBuf::from("rustc"), PathBuf::from);
        let missing = |reason: String| CompileError::NotFound { program: program.clone(), reason };
        let answer = Command::new(&program).arg("--version").output().map_err(|e| missing(e.to_string()))?;
        if !answer.status.success() {
            return Err(missing(answer.status.to_string()));
        }
        let version = String::from_utf8_lossy(&answer.stdout).trim().to_owned();
        Ok(Self { program, version })
    }

    /// The flags that decide how fast the code is.
    pub fn flags(target: Target) -> Vec<&'static str> {
        let mut flags = vec!["-C", "opt-level=3", "-C", "codegen-units=1"];
        if target == Target::Own && cfg!(all(target_arch = "x86_64", target_feature = "fma")) {
            flags.extend(["-C", "target-cpu=native"]);
        }
        flags
    }

    /// Compiles one source file as a library with a C interface. Wall-clock time.
    pub(super) fn compile(&self, source: &Path, to: &Path, makes: Makes, target: Target) -> Result<Duration, CompileError> {
        let start = Instant::now();
        let mut command = Command::new(&self.program);
        command.args(["--edition", "2024", "--crate-type", "cdylib", "--crate-name", "generated"]).args(Self::flags(target));
        if makes == Makes::Object {
            command.args(["--emit", "obj"]);
        }
        let (status, said) = children::run(command.arg("-o").arg(to).arg(source))
            .map_err(|e| CompileError::NotFound { program: self.program.clone(), reason: e.to_string() })?;
        let time = start.elapsed();
        if status.success() {
            return Ok(time);
        }
        let said = if said.trim().is_empty() { format!("it said nothing and ended with {status}: perhaps memory was short") } else { said };
        let message: Vec<&str> = said.lines().take(20).collect();
        Err(CompileError::Refused { message: message.join("\n") })
    }
}
