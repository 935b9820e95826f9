//! Compilers of C, as the command calls them.

use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use articulated_codegen::{COptions, Generated, Target};

use super::rustc::{CompileError, Target as Processors};
use super::{Compiled, Library, load, symbols};
use crate::native::Native;
use crate::process::{self, Folder};

/// A compiler of C that was found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cc {
    /// The command to call.
    program: &'static str,
    /// The first line of its version text.
    pub version: String,
}

/// Maximum time of a compiler.
const LIMIT: Duration = Duration::from_secs(3600);

impl Cc {
    /// GCC and Clang, as far as they are installed; `cc` where neither is.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let found = |program| {
            let answer = process::run(Command::new(program).arg("--version"), LIMIT).ok()?;
            let version = answer.output.lines().next()?.trim().to_owned();
            answer.status.success().then_some(Self { program, version })
        };
        let all: Vec<Self> = ["gcc", "clang"].into_iter().filter_map(found).collect();
        if all.is_empty() { found("cc").into_iter().collect() } else { all }
    }

    /// Its name in tables.
    #[must_use]
    pub fn name(&self) -> String {
        format!("C, {}", self.program)
    }

    /// The flags that decide how fast the code is.
    #[must_use]
    pub fn flags(&self) -> Vec<&'static str> {
        let mut flags = vec!["-std=gnu99", "-O2", "-ffp-contract=fast", "-fno-math-errno"];
        if self.program == "gcc" {
            // GCC 12 combines numbers of a result into vectors at a loss: a mass matrix takes half
            // as long again.
            flags.push("-fno-tree-slp-vectorize");
        }
        if Processors::differ() {
            flags.push("-march=native");
        }
        flags
    }
}

impl Compiled {
    /// The target of code that [`Compiled::build_c`] loads.
    pub(crate) fn c_target() -> Target {
        // With this prefix functions have the names under which kernels are looked for.
        Target::C(COptions { prefix: Some("articulated".to_owned()), ..COptions::default() })
    }

    /// Compiles and loads C that was generated for [`Compiled::c_target`].
    ///
    /// # Errors
    /// The compiler refuses the code, or its output cannot be loaded.
    pub(crate) fn build_c(cc: &Cc, generated: &Generated) -> Result<Self, CompileError> {
        let folder = Folder::new().map_err(CompileError::Folder)?;
        for file in &generated.files {
            std::fs::write(folder.path().join(&file.name), &file.text).map_err(CompileError::Folder)?;
        }
        let file = folder.path().join(format!("{}generated{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX));
        let time = compile(cc, &folder.path().join("articulated.c"), &file)?;
        let native = Native::open(&file).map_err(CompileError::Load)?;
        let library = Library { native, file, time, _folder: folder };
        let sizes = symbols::Sizes::of(&library.file);
        let (shape, single) = (generated.model.shape(), generated.level.is_single());
        let names = generated.ledger.functions.iter().map(|f| f.function.as_str());
        let per = if single { 2 } else { 1 };
        let functions = names.map(|name| load(&library.native, &sizes, name, shape, per)).collect::<Result<_, _>>()?;
        Ok(Self { functions, shape, single, time: library.time, _library: library })
    }
}

fn compile(cc: &Cc, source: &Path, to: &Path) -> Result<Duration, CompileError> {
    let start = Instant::now();
    let mut command = Command::new(cc.program);
    command.args(cc.flags()).args(["-shared", "-fPIC", "-o"]).arg(to).arg(source).arg("-lm");
    let failed = |e: std::io::Error| CompileError::Refused { message: format!("{} could not be run: {e}", cc.program) };
    let process::Ended { status, errors, .. } = process::run(&mut command, LIMIT).map_err(failed)?;
    let time = start.elapsed();
    if status.success() {
        return Ok(time);
    }
    let lines: Vec<&str> = errors.lines().take(20).collect();
    Err(CompileError::Refused { message: format!("{}: {}", cc.program, lines.join("\n")) })
}
