//! The languages that code is generated in. Each has a folder, which prints functions of the
//! intermediate representation, and a row here.

pub(crate) mod c;
pub(crate) mod rust;

use articulated_core::model::Model;
use articulated_urdf::{Problem, Unused};

use crate::capabilities::Capabilities;
use crate::lir::function::Function;
use crate::{Error, Options, Parameter, Request};

pub use c::COptions;
pub use rust::{RustOptions, identifier};

/// A language, and the choices that it alone has.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// Rust.
    Rust(RustOptions),
    /// C99, for numbers alone.
    C(COptions),
}

impl Default for Target {
    fn default() -> Self {
        Self::Rust(RustOptions::default())
    }
}

/// A generated file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// Its name, without a folder.
    pub name: String,
    /// Its contents.
    pub text: String,
}

/// What a target prints.
pub(crate) struct Module<'a> {
    pub(crate) request: &'a Request,
    pub(crate) model: &'a Model<f64>,
    pub(crate) functions: Vec<Function<'a>>,
    pub(crate) parameters: &'a [Parameter],
    pub(crate) unused: &'a [Unused],
    pub(crate) snapped: &'a [Problem],
    pub(crate) warnings: &'a [Problem],
}

impl Target {
    /// All targets, with default choices.
    #[must_use]
    pub fn all() -> [Self; 2] {
        [Self::Rust(RustOptions::default()), Self::C(COptions::default())]
    }

    /// Its name, as a request has it.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Rust(_) => "rust",
            Self::C(_) => "c",
        }
    }

    /// What functions may consist of.
    pub(crate) fn capabilities(&self, options: &Options) -> Capabilities {
        match self {
            Self::Rust(rust) => rust::capabilities(options, rust),
            Self::C(_) => c::capabilities(options),
        }
    }

    /// Whether the choices go together, whatever the robot.
    pub(crate) fn check(&self, options: &Options) -> Result<(), Error> {
        match self {
            Self::Rust(rust) => rust::check(rust),
            Self::C(c) => c::check(options, c),
        }
    }

    /// Whether the robot's names are names in this language. Errors: all that are not.
    pub(crate) fn check_names(&self, model: &Model<f64>, request: &Request) -> Result<(), Error> {
        match self {
            Self::Rust(_) => rust::Names::new(model, request).map(drop),
            Self::C(_) => Ok(()),
        }
    }

    /// The files of a module.
    pub(crate) fn print(&self, module: &Module) -> Vec<File> {
        match self {
            Self::Rust(rust) => rust::print(module, rust),
            Self::C(c) => c::print(module, c),
        }
    }
}
