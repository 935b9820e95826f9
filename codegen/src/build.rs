//! The build-script interface.

use std::fs;
use std::path::{Path, PathBuf};

use articulated_core::description::Base;

use crate::{Error, Generated, Request, generate};

/// Generates a robot's code from a build script.
///
/// ```no_run
/// // build.rs
/// articulated_codegen::Build::new("robots/arm.urdf").functions(["inverse_dynamics"]).write("arm");
/// ```
/// and in the crate: `mod arm { include!(concat!(env!("OUT_DIR"), "/arm.rs")); }`.
#[derive(Clone, Debug)]
pub struct Build {
    path: PathBuf,
    request: Request,
}

impl Build {
    /// For the URDF at `path`, relative to the crate's folder.
    pub fn new(path: impl AsRef<Path>) -> Self {
        let path = path.as_ref();
        let root = std::env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from).unwrap_or_default();
        let mut request = Request::new(path.display().to_string(), []);
        request.options.runtime = Some("::articulated".into());
        Self { path: root.join(path), request }
    }

    /// A floating base.
    #[must_use]
    pub fn floating(mut self) -> Self {
        self.request.options.base = Base::Floating;
        self
    }

    /// Gravity in the base frame, m/s².
    #[must_use]
    pub fn gravity(mut self, gravity: [f64; 3]) -> Self {
        self.request.options.gravity = gravity;
        self
    }

    /// The functions wanted.
    #[must_use]
    pub fn functions<N: Into<String>>(mut self, names: impl IntoIterator<Item = N>) -> Self {
        self.request.options.functions = names.into_iter().map(Into::into).collect();
        self
    }

    /// Code that depends on nothing but `core` and `std`: no implementation of the trait `Dynamics`.
    #[must_use]
    pub fn standalone(mut self) -> Self {
        self.request.options.runtime = None;
        self
    }

    /// No `unsafe` in the generated code, for crates that forbid it.
    #[must_use]
    pub fn forbid_unsafe(mut self) -> Self {
        self.request.options.forbid_unsafe = true;
        self
    }

    /// Any other choice.
    #[must_use]
    pub fn options(mut self, change: impl FnOnce(&mut crate::Options)) -> Self {
        change(&mut self.request.options);
        self
    }

    /// Reads the URDF and generates. Nothing is written or printed.
    pub fn generate(&self) -> Result<Generated, Error> {
        let file = |e: std::io::Error| Error::File { file: self.path.display().to_string(), reason: e.to_string() };
        let mut request = self.request.clone();
        request.urdf = fs::read(&self.path).map_err(file)?;
        generate(&request)
    }

    /// Generates and writes `$OUT_DIR/<name>.rs`, and tells cargo what the result depends on. For build scripts.
    pub fn try_write(&self, name: &str) -> Result<Generated, Error> {
        println!("cargo::rerun-if-changed={}", self.path.display());
        let generated = self.generate()?;
        for warning in &generated.warnings {
            println!("cargo::warning={warning}");
        }
        let folder = std::env::var_os("OUT_DIR").map(PathBuf::from).unwrap_or_default();
        let target = folder.join(name).with_extension("rs");
        let file = |e: std::io::Error| Error::File { file: target.display().to_string(), reason: e.to_string() };
        // An unchanged file keeps its date, so that nothing is compiled again.
        if fs::read_to_string(&target).is_ok_and(|old| old == generated.source) {
            return Ok(generated);
        }
        fs::write(&target, &generated.source).map_err(file)?;
        Ok(generated)
    }

    /// As [`Build::try_write`]; on an error prints it for cargo and ends the build script with status 1.
    pub fn write(&self, name: &str) {
        if let Err(error) = self.try_write(name) {
            for line in error.to_string().lines() {
                println!("cargo::error={line}");
            }
            std::process::exit(1);
        }
    }
}
