//! The Rust compiler, as the command calls it.

use std::fmt;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use crate::process;

/// A Rust compiler that was found, and the flags it gets.
#[derive(Clone, Debug)]
pub struct Rustc {
    program: PathBuf,
    /// Its version text.
    pub version: String,
}

/// The processors that code is compiled for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// The processor of the command itself, so that generated and generic code are compared alike.
    Own,
    /// Any processor of this kind: the default of `rustc`.
    Any,
}

impl Target {
    /// Whether the two differ.
    pub fn differ() -> bool {
        Rustc::flags(Self::Own) != Rustc::flags(Self::Any)
    }
}

/// Output of the compiler for a source file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Makes {
    /// A library that can be loaded.
    Library,
    /// Its object file, as a C compiler's `-c` makes it: it is not linked.
    Object,
}

/// Why generated source could not be run.
#[derive(Debug)]
pub enum CompileError {
    /// No compiler.
    NotFound {
        /// The called program.
        program: PathBuf,
        /// The system's message.
        reason: String,
    },
    /// The compiler refused the source.
    Refused {
        /// The first lines of its message.
        message: String,
    },
    /// The compiler was ended before it was done: by a signal, or by the limit of its time.
    Ended {
        /// The reason.
        reason: String,
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
            Self::Ended { reason } => write!(f, "rustc was ended: {reason}"),
            Self::Folder(error) => write!(f, "no temporary folder to compile in: {error}"),
            Self::Load(message) => write!(f, "the compiled library cannot be loaded: {message}"),
        }
    }
}

impl std::error::Error for CompileError {}

/// The variable that limits the time of a compiler, s.
const LIMIT: &str = "ARTICULATED_RUSTC_SECONDS";

/// Maximum time of a compiler: an hour, unless the user sets another limit.
fn limit() -> Duration {
    let seconds = std::env::var(LIMIT).ok().and_then(|text| text.parse().ok()).filter(|seconds| *seconds > 0);
    Duration::from_secs(seconds.unwrap_or(3600))
}

impl Rustc {
    /// The compiler that the variable `RUSTC` names, or `rustc`.
    pub fn find() -> Result<Self, CompileError> {
        let program = std::env::var_os("RUSTC").map_or_else(|| PathBuf::from("rustc"), PathBuf::from);
        let missing = |reason: String| CompileError::NotFound { program: program.clone(), reason };
        let answer = process::run(Command::new(&program).arg("--version"), limit()).map_err(|e| missing(e.to_string()))?;
        if !answer.status.success() {
            return Err(missing(answer.status.to_string()));
        }
        let version = answer.output.trim().to_owned();
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
        let failed = |e: std::io::Error| match e.kind() {
            ErrorKind::TimedOut => CompileError::Ended { reason: format!("{e}; {LIMIT} sets another limit, s") },
            _ => CompileError::NotFound { program: self.program.clone(), reason: e.to_string() },
        };
        let process::Ended { status, errors: said, .. } = process::run(command.arg("-o").arg(to).arg(source), limit()).map_err(failed)?;
        let time = start.elapsed();
        if status.success() {
            return Ok(time);
        }
        if status.code().is_none() {
            return Err(CompileError::Ended { reason: format!("{status}: perhaps memory was short") });
        }
        let said = if said.trim().is_empty() { format!("it said nothing and ended with {status}: perhaps memory was short") } else { said };
        let message: Vec<&str> = said.lines().take(20).collect();
        Err(CompileError::Refused { message: message.join("\n") })
    }
}
