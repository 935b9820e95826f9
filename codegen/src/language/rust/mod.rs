//! Rust.
//!
//! A module (`module`) has functions (`function`), which are statements (`statements`); `batch` has
//! functions of many states, `spills` the memory in which values wait.

mod batch;
mod columns;
mod function;
mod instructions;
mod literal;
mod module;
mod regions;
mod requirements;
mod several;
mod spills;
mod statements;
mod tree_shake;
mod words;

use crate::Options;
use crate::capabilities::Capabilities;
use crate::language::{File, Module, Target};

pub use module::names::identifier;
pub(crate) use module::names::{Names, is_name};
pub use words::is_keyword;
pub(in crate::language) use words::refuses_name;

/// Choices for Rust.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RustOptions {
    /// No `unsafe` in the generated code, for crates that forbid it: on x86-64 sines and cosines
    /// take a little longer, and long functions without AVX-512 up to twice as long.
    pub forbid_unsafe: bool,
    /// For crates without `std`: without `unsafe` and a runtime, no multiply-add, and square roots,
    /// arctangents and sines of large angles are those of the crate `libm`.
    pub no_std: bool,
    /// Path of the runtime crate, to implement its trait `Dynamics`; `None`: the code depends on
    /// nothing but `core` and `std`.
    pub runtime: Option<String>,
}

impl Options {
    /// The choices for Rust; the default ones if the language is another.
    #[must_use]
    pub fn rust(&self) -> &RustOptions {
        static DEFAULT: RustOptions = RustOptions { forbid_unsafe: false, no_std: false, runtime: None };
        if let Target::Rust(rust) = &self.target { rust } else { &DEFAULT }
    }

    /// The choices for Rust, which becomes the language if it is not.
    pub fn rust_mut(&mut self) -> &mut RustOptions {
        if !matches!(self.target, Target::Rust(_)) {
            self.target = Target::default();
        }
        match &mut self.target {
            Target::Rust(rust) => rust,
            other => unreachable!("{} was replaced by Rust", other.name()),
        }
    }
}

/// Vectors and raw memory, unless `unsafe` is forbidden.
pub(super) fn capabilities(options: &Options, rust: &RustOptions) -> Capabilities {
    let raw_memory = !rust.forbid_unsafe;
    let vectors = raw_memory && options.level.has_lanes();
    let states = !options.batch.is_empty();
    Capabilities { level: options.level, vectors, raw_memory, scalar_too: false, loops: vectors, spills: raw_memory, states }
}

/// One file.
pub(super) fn print(module: &Module, rust: &RustOptions) -> Vec<File> {
    vec![File { name: "robot.rs".into(), text: module::module(module, rust) }]
}
