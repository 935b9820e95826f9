//! The languages that code is generated in. Each has a folder, which prints functions of the
//! intermediate representation, and a row here.

pub(crate) mod c;
mod heads;
pub(crate) mod rust;

use articulated_core::diagnostic::{Code, Diagnostic, Diagnostics, Unused};
use articulated_core::effect::Applied;
use articulated_core::lanes::Real;
use articulated_core::model::Model;

use crate::capabilities::Capabilities;
use crate::lir::function::Function;
use crate::lir::{Stored, TableColumn, Temp};
use crate::size::Bytes;
use crate::{FunctionSpec, Options, Parameter, Request};

pub use c::COptions;
pub use rust::{RustOptions, identifier, is_keyword};

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

/// Input of a target's printer.
pub(crate) struct Module<'a> {
    pub(crate) request: &'a Request,
    /// All effects: the scene's, then the request's.
    pub(crate) effects: &'a [Applied],
    pub(crate) model: &'a Model<f64>,
    pub(crate) functions: Vec<Function<'a>>,
    pub(crate) parameters: &'a [Parameter],
    pub(crate) unused: &'a [Unused],
    pub(crate) snapped: &'a [Diagnostic],
    pub(crate) warnings: &'a [Diagnostic],
}

/// Reports a type of batches that is listed twice.
fn check_batch(batch: &[Real], log: &mut Diagnostics) {
    let twice = batch.iter().enumerate().filter(|(k, real)| batch[..*k].contains(real));
    let mut twice: Vec<&Real> = twice.map(|(_, real)| real).collect();
    twice.dedup();
    for real in twice {
        let found = format!("a type that is there twice, {}", real.name());
        log.push(Diagnostic::error("", (Default::default(), "batch"), Code::Batch, found, "each once"));
    }
}

/// Words that the text around a function uses, beside its arguments.
const AROUND: &str = "out parameters parameter_sets count blocks states sets slots shelves first this row rows given steps kept b i k m n p \
    add mul fma trig lanes lane sin_cos store put body whole fused spill at gather scatter implementation columns four half";

/// Why an argument or a result of a user's function cannot have its name in some language.
pub(crate) fn refuses_port(name: &str) -> Option<&'static str> {
    let is_plain = name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_');
    // A letter and a number; values and what regions make of them have an x.
    let (counted, more) = name.split_once('_').unwrap_or((name, ""));
    let has_number = counted.len() > 1 && counted[1..].bytes().all(|b| b.is_ascii_digit());
    let is_counted = has_number && (more.is_empty() && !name.ends_with('_') || name.starts_with('x'));
    if !is_plain || !name.starts_with(|c: char| c.is_ascii_lowercase()) {
        return Some("is not a valid name: expected lower case letters, digits and _");
    }
    if is_keyword(name) || c::is_word_of_c(name) {
        return Some("is a word of Rust or of C: expected another name");
    }
    let is_around = is_counted || AROUND.split(' ').any(|word| word == name);
    is_around.then_some("is a name that generated code uses for itself: expected another name")
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

    /// Bytes of source per instruction, measured on chains of 12 to 250 joints.
    pub(crate) fn bytes(&self) -> Bytes {
        match self {
            // Batches come in numbers and in vectors, of all types at once.
            Self::Rust(_) => Bytes { single: 66.0, limbs: 0.0, states: [132.0, 0.0] },
            // Limbs come with the same function in numbers; each type of batches has its own text.
            Self::C(_) => Bytes { single: 56.0, limbs: 8.0, states: [0.0, 52.0] },
        }
    }

    /// What functions may consist of.
    pub(crate) fn capabilities(&self, options: &Options) -> Capabilities {
        match self {
            Self::Rust(rust) => rust::capabilities(options, rust),
            Self::C(c) => c::capabilities(options, c),
        }
    }

    /// Reports choices that exclude each other, whatever the robot.
    pub(crate) fn check(&self, options: &Options, log: &mut Diagnostics) {
        check_batch(&options.batch, log);
        if let Self::C(c) = self {
            c::check(options, c, log);
        }
    }

    /// Why a function cannot have its name beside the others in this language, if it cannot.
    pub(crate) fn refuses_name(&self, function: &FunctionSpec, others: &[&FunctionSpec]) -> Option<String> {
        match self {
            Self::Rust(_) => rust::refuses_name(function),
            Self::C(c) => c::refuses_name(function, others, c),
        }
    }

    /// A function with those that the language makes of it beside it; `names`: those of all.
    pub(crate) fn with_derivatives(&self, function: FunctionSpec, names: &[String]) -> Vec<FunctionSpec> {
        match self {
            Self::C(options) if options.casadi => c::with_derivatives(&function, names, options.derivatives.unwrap_or(1).into()),
            _ => vec![function],
        }
    }

    /// Reports the robot's names that are not names in this language.
    pub(crate) fn check_names(&self, model: &Model<f64>, request: &Request, log: &mut Diagnostics) {
        match self {
            Self::Rust(_) => rust::Names::check(model, request, log),
            Self::C(_) => c::check_names(model, request, log),
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
/// A column of a table in a turn, in Rust and in C. `argument`: numbers of an argument, by their
/// place.
fn in_turn(column: &TableColumn, turn: &str, name: fn(Temp) -> String, argument: impl Fn(u32, &str) -> String) -> String {
    let at = |first: usize, stride: usize, is_backward: bool| {
        let moved = if stride == 1 { turn.to_owned() } else { format!("{turn} * {stride}") };
        match (first, is_backward) {
            (0, false) => moved,
            (_, false) => format!("{first} + {moved}"),
            (_, true) => format!("{first} - {moved}"),
        }
    };
    match *column {
        TableColumn::Named(column) => format!("{}_column[{turn}]", name(column)),
        TableColumn::Results { region, number, first, is_backward } => {
            format!("x{region}_results[{}][{number}]", at(first, 1, is_backward))
        }
        TableColumn::Argument { argument: of, first, stride, is_backward } => argument(of, &at(first, stride, is_backward)),
    }
}

/// An expression as a factor of a product.
fn factor(expression: &str) -> String {
    if expression.contains(' ') { format!("({expression})") } else { expression.to_owned() }
}

/// The number of the turn whose results are stored in a turn.
fn stored_turn(stored: Stored, turn: &str, turns: usize) -> String {
    if stored.is_backward { format!("{} - {turn}", turns - 1) } else { turn.to_owned() }
}
