//! C99: a header and a source, for numbers alone. The source needs nothing but `math.h`.
//!
//! Arrays are flat, row by row. Functions and constants begin with a prefix, by default the robot's
//! name.

mod ascii;
mod batch;
mod casadi;
mod columns;
mod constants;
mod lanes;
mod limbs;
mod math;
mod names;
mod regions;
mod requirements;
mod statements;

use std::fmt::Write;

use articulated_core::algorithm::Dim;
use articulated_core::diagnostic::{Code, Diagnostic, Diagnostics};
use articulated_core::lanes::Real;

use crate::capabilities::Capabilities;
use crate::language::{File, Module, heads};
use crate::lir::function::{Argument, Ending, Function};
use crate::lir::{Body, Stmt, Ty};
use crate::{Arithmetic, FunctionSpec, Options, Precision, TrigAccuracy};
use ascii::ascii;
pub(in crate::language) use constants::check_names;
pub(in crate::language) use names::refusal as refuses_name;
use requirements::Requirements;
use statements::{Numbers, Printer, infinity};

/// The linkage of helpers. A processor may need only some of them.
const INLINE: &str = "\
#if defined(__GNUC__)
#define @U_INLINE static inline __attribute__((unused))
#else
#define @U_INLINE static inline
#endif

";

/// Choices for C.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct COptions {
    /// Prefix of all names; by default the robot's name in lower case.
    pub prefix: Option<String>,
    /// One header with `static inline` functions in place of a header and a source.
    pub header_only: bool,
    /// The source also has each function in the interface of CasADi's `external`.
    pub casadi: bool,
    /// The derivatives that each function has there: 0 none, 1 those of the first order, 2 those of
    /// the second too. `None` means 1.
    pub derivatives: Option<u8>,
    /// Sines, square roots and arctangents of the module's own in place of `math.h`.
    pub no_libm: bool,
}

/// Whether it is a function of C's headers or a keyword.
pub(super) fn is_word_of_c(name: &str) -> bool {
    names::is_word_of_c(name)
}

/// A function with its derivatives for CasADi up to an order; `names`: those of all functions.
pub(super) fn with_derivatives(function: &FunctionSpec, names: &[String], order: usize) -> Vec<FunctionSpec> {
    casadi::with_derivatives(function, names, order)
}

/// Numbers, and vectors if the compiler has them; in pieces if a function is long. The compiler
/// chooses the values to spill.
pub(super) fn capabilities(options: &Options, c: &COptions) -> Capabilities {
    let (vectors, states) = (options.level.has_lanes(), !options.batch.is_empty());
    // CasADi needs to know which numbers are zero, which loops hide.
    let loops = vectors && !c.casadi;
    Capabilities { level: options.level, vectors, raw_memory: true, scalar_too: true, loops, spills: false, states }
}

/// Reports a level that C does not have, and a prefix that is not a name.
pub(super) fn check(options: &Options, c: &COptions, log: &mut Diagnostics) {
    let mut error = |key, code, found, expected| log.push(Diagnostic::error("", (Default::default(), key), code, found, expected));
    let is_plain = matches!(options.level.arithmetic, Arithmetic::Double | Arithmetic::Single | Arithmetic::SingleByDouble);
    if !is_plain || options.level.sines != TrigAccuracy::Ulp1 {
        let expected = "for target \"c\": f64, f32 or f32_f64, with the sines of the mathematical library";
        error("level", Code::Level, options.level.to_string(), expected);
    }
    if c.casadi && options.level.arithmetic != Arithmetic::Double {
        error("abi", Code::Level, options.level.to_string(), "level f64, the numbers of CasADi");
    }
    if c.casadi && !options.parameters.is_empty() {
        error("abi", Code::Parameter, "parameters".into(), "none for CasADi: its functions take the arguments of the registry");
    }
    if c.casadi && c.header_only {
        error("abi", Code::File, "one header".into(), "a header and a source: a folder to write to");
    }
    if let Some(prefix) = c.prefix.as_ref().filter(|prefix| !is_identifier(prefix)) {
        error("prefix", Code::Prefix, format!("{prefix:?}"), "a letter of ASCII, then letters, digits and _");
    }
}

/// Whether this is a valid beginning of a name in C.
fn is_identifier(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_alphabetic()) && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

/// A name in C: letters and digits of ASCII stay, everything else is `_`.
pub(super) fn identifier(name: &str) -> String {
    let text: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' }).collect();
    if text.starts_with(|c: char| c.is_ascii_alphabetic()) { text } else { format!("robot_{text}") }
}

/// The header and the source.
pub(super) fn print(module: &Module, c: &COptions) -> Vec<File> {
    let prefix = c.prefix.clone().unwrap_or_else(|| identifier(module.model.name()));
    let printer =
        Source { module, upper: prefix.to_ascii_uppercase(), prefix, header_only: c.header_only, casadi: c.casadi, no_libm: c.no_libm };
    let header = File { name: format!("{}.h", printer.prefix), text: ascii(&printer.header()) };
    if c.header_only { vec![header] } else { vec![header, File { name: format!("{}.c", printer.prefix), text: ascii(&printer.source()) }] }
}

struct Source<'a> {
    module: &'a Module<'a>,
    prefix: String,
    upper: String,
    header_only: bool,
    casadi: bool,
    no_libm: bool,
}

impl Source<'_> {
    fn level(&self) -> Precision {
        self.module.request.options.level
    }

    fn numbers(&self) -> Numbers<'_> {
        let (computed, outside) = match self.level().arithmetic {
            Arithmetic::Single => ("float", "float"),
            Arithmetic::SingleByDouble => ("double", "float"),
            _ => ("double", "double"),
        };
        Numbers {
            computed: computed.to_owned(),
            outside,
            is_single: computed == "float",
            prefix: &self.prefix,
            own_math: self.own_math(),
            lanes: None,
        }
    }

    fn header(&self) -> String {
        let (mut out, upper) = (String::new(), &self.upper);
        self.origin(&mut out);
        let _ = writeln!(out, "#ifndef {upper}_H\n#define {upper}_H\n");
        if !self.module.request.options.batch.is_empty() {
            let _ = writeln!(out, "#include <stddef.h>\n");
        }
        if self.header_only {
            self.include_math(&mut out);
        }
        let _ = writeln!(out, "#ifdef __cplusplus\nextern \"C\" {{\n#endif\n");
        constants::declare(&mut out, self.module, &self.prefix, &infinity(self.own_math()), self.header_only);
        let mut functions = String::new();
        for function in &self.module.functions {
            if self.header_only {
                self.function(&mut functions, function);
            } else {
                self.document(&mut functions, function);
                let _ = writeln!(functions, "{};\n", self.declaration(function));
            }
        }
        if self.header_only {
            self.batches(&mut functions);
        } else {
            self.declare_batches(&mut functions);
        }
        if self.header_only {
            out += &self.helpers();
        }
        out += &functions;
        let _ = writeln!(out, "#ifdef __cplusplus\n}}\n#endif\n\n#endif");
        out
    }

    fn source(&self) -> String {
        let mut out = String::new();
        self.origin(&mut out);
        let _ = writeln!(out, "#include \"{}.h\"\n", self.prefix);
        self.include_math(&mut out);
        constants::define(&mut out, self.module, &self.prefix, &infinity(self.own_math()));
        let mut functions = String::new();
        for function in &self.module.functions {
            self.function(&mut functions, function);
        }
        self.batches(&mut functions);
        out += &self.helpers();
        out += &functions;
        if self.casadi {
            casadi::write(&mut out, &self.prefix, &self.module.functions);
        }
        out
    }

    /// The prefix of the module's own mathematical functions, if it has them.
    fn own_math(&self) -> Option<&str> {
        self.no_libm.then_some(&self.prefix)
    }

    /// The library's header, or what is needed of it.
    fn include_math(&self, out: &mut String) {
        let up = &self.upper;
        let _ = if self.no_libm {
            writeln!(
                out,
                "#if defined(__GNUC__)\n#define {up}_INFINITY __builtin_inf()\n#else\n#include <math.h>\n#define {up}_INFINITY INFINITY\n#endif\n"
            )
        } else {
            writeln!(out, "#include <math.h>\n")
        };
    }

    /// The helpers that the functions call: mathematical functions of the module's own, vectors,
    /// and the loop over columns.
    fn helpers(&self) -> String {
        let Module { functions, request, .. } = self.module;
        let (prefix, batch) = (&self.prefix, &request.options.batch);
        let called = Requirements::of(functions, self.numbers().is_single, batch, self.no_libm);
        let of_states = |real: &Real| called.states.get(real.name()).map(|names| lanes::text(prefix, *real, self.no_libm, names));
        let vectors = batch.iter().filter_map(of_states).collect::<String>() + &lanes::of_limbs(prefix, self.no_libm, &called);
        let math = if self.no_libm { math::text(prefix, &called.math) } else { String::new() };
        let linkage = if self.header_only { "static inline" } else { "static" };
        let columns = functions.iter().find_map(|f| f.columns).map(|columns| columns::text(prefix, linkage, columns));
        let inline = if vectors.is_empty() && math.is_empty() { String::new() } else { INLINE.replace("@U_", &format!("{}_", self.upper)) };
        let width = if vectors.is_empty() && columns.is_none() { String::new() } else { lanes::width(prefix) };
        inline + &math + &width + &vectors + &columns.unwrap_or_default()
    }

    /// The head of a file.
    fn origin(&self, out: &mut String) {
        let Module { request, model, .. } = self.module;
        let [x, y, z]: [f64; 3] = model.gravity().into();
        let floats =
            if model.joints().first().is_some_and(|j| j.name == articulated_core::model::FLOATING_BASE) { "floating" } else { "fixed" };
        let text = |name: &str| name.escape_debug().to_string().replace("*/", "* /");
        let _ = writeln!(out, "/* @generated by articulated {} from {}.", env!("CARGO_PKG_VERSION"), text(heads::file_name(&request.file)));
        let _ =
            writeln!(out, "   Robot \"{}\", {floats} base, gravity ({x:?}, {y:?}, {z:?}) m/s^2 in the world frame.", text(model.name()));
        for line in heads::of_warnings(self.module.warnings) {
            let _ = writeln!(out, "   {}", heads::printable(&line).replace("*/", "* /").replace("/*", "/ *"));
        }
        let _ = writeln!(out, "   SI units and radians. Arrays are flat, row by row; results must not overlap arguments.");
        let _ = writeln!(out, "   Functions allocate nothing. To generate another one, add it to the functions of the request. */\n");
    }

    fn document(&self, out: &mut String, function: &Function) {
        let _ = writeln!(out, "/**");
        for summary in function.spec.summaries() {
            let _ = writeln!(out, " * {summary}.");
        }
        for argument in function.spec.arguments() {
            let _ = writeln!(out, " * @param {} {}: {}", argument.name(), self.lengths(argument.dims()), argument.unit());
        }
        if function.arguments.iter().any(Argument::is_parameters) {
            let _ = writeln!(out, " * @param parameters constants of the model that stayed inputs");
        }
        for (name, output) in self.results(function).iter().zip(&function.outputs) {
            let _ = writeln!(out, " * @param {name} {}: {}", self.lengths(&output.dims), output.unit);
        }
        let c = function.entry.emitted();
        let most = function.at_most();
        let _ = writeln!(out, " * Operations: {}{most}; sines and cosines: {}{most}.\n */", c.instructions(), c.trigonometric());
    }

    /// The names of the results.
    fn results(&self, function: &Function) -> Vec<&'static str> {
        match function.outputs.as_slice() {
            [_] => vec!["out"],
            outputs => outputs.iter().map(|output| output.name).collect(),
        }
    }

    /// How long an array is: a product of constants.
    fn lengths(&self, dims: &[Dim]) -> String {
        let one = |dim: &Dim| if let Dim::Of(n) = dim { n.to_string() } else { format!("{}_{dim}", self.upper) };
        let all: Vec<String> = dims.iter().map(one).collect();
        if all.is_empty() { "1".into() } else { all.join(" * ") }
    }

    fn declaration(&self, function: &Function) -> String {
        let linkage = if self.header_only { "static inline " } else { "" };
        let name = format!("{linkage}void {}_{}", self.prefix, function.spec.name);
        let list = self.parameters(function, &self.results(function));
        let (one_line, indent) = (format!("{name}({})", list.join(", ")), " ".repeat(name.len() + 1));
        if one_line.len() <= 100 { one_line } else { format!("{name}({})", list.join(&format!(",\n{indent}"))) }
    }

    fn parameters(&self, function: &Function, results: &[&str]) -> Vec<String> {
        let outside = self.numbers().outside;
        let argument = |a: &Argument| {
            if a.is_parameters() {
                format!("const double {}[{}_PARAMETERS]", a.name, self.upper)
            } else {
                self.array(&format!("const {outside}"), a.name, &a.dims, function)
            }
        };
        let result = |(name, output): (&&str, &crate::function_spec::Output)| self.array(outside, name, &output.dims, function);
        function.arguments.iter().map(argument).chain(results.iter().zip(&function.outputs).map(result)).collect()
    }

    /// The parameter for an array. C has no arrays of length zero.
    fn array(&self, ty: &str, name: &str, dims: &[Dim], function: &Function) -> String {
        let numbers: usize = dims.iter().map(|d| d.len(function.shape)).product();
        if numbers == 0 { format!("{ty} *{name}") } else { format!("{ty} {name}[{}]", self.lengths(dims)) }
    }

    /// The function, with vectors for compilers that have them and without for others.
    fn function(&self, out: &mut String, function: &Function) {
        let body = (&function.body, function.ending, function.columns.is_some());
        let Some((scalar, ending)) = &function.scalar else { return self.of_body(out, function, body) };
        let _ = writeln!(out, "#if {}_LIMBS", self.upper);
        self.of_body(out, function, body);
        let _ = writeln!(out, "#else");
        self.of_body(out, function, (scalar, *ending, function.columns.is_some()));
        let _ = writeln!(out, "#endif\n");
    }

    /// `solves`: the loop over columns follows, for what the body leaves out.
    fn of_body(&self, out: &mut String, function: &Function, (body, ending, solves): (&Body, Ending, bool)) {
        let names = self.names(function);
        if body.pieces.len() > 1 {
            self.pieces(out, function, body);
        }
        if self.header_only {
            self.document(out, function);
        }
        let _ = writeln!(out, "{} {{\n{}", self.declaration(function), unused(&names));
        self.zeros(out, function, body, ending);
        match body.pieces.as_slice() {
            [piece] => self.statements(out, function, body, piece),
            pieces => {
                let _ = writeln!(out, "    {} m[{}];", self.value(body), body.kept);
                (0..pieces.len()).for_each(|c| _ = writeln!(out, "    {}({}, m);", self.piece(function, c), names.join(", ")));
            }
        }
        if solves {
            let _ = writeln!(out, "    {}_columns(out);", self.prefix);
        }
        let _ = writeln!(out, "}}\n");
    }

    /// The names of the arguments and of the results.
    fn names<'f>(&self, function: &'f Function) -> Vec<&'f str> {
        function.arguments.iter().map(|a| a.name).chain(self.results(function)).collect()
    }

    /// The type of the values of a body.
    fn value(&self, body: &Body) -> String {
        if let Ty::Vector(width) = body.ty { format!("{}_x{width}_v", self.prefix) } else { self.numbers().computed }
    }

    fn statements(&self, out: &mut String, function: &Function, body: &Body, statements: &[Stmt]) {
        let results = self.results(function);
        let place = |at: usize| place(function, &results, at);
        if let Ty::Vector(_) = body.ty {
            let math = self.own_math().map_or(String::new(), |prefix| format!("{prefix}_"));
            let printer = limbs::Printer {
                body,
                arguments: &function.arguments,
                prefix: &self.prefix,
                math: &math,
                infinity: &infinity(self.own_math()),
                places: &place,
            };
            return printer.statements(out, statements);
        }
        Printer { arguments: &function.arguments, numbers: &self.numbers(), places: &place }.statements(out, statements);
    }

    fn piece(&self, function: &Function, c: usize) -> String {
        format!("{}_{}_piece_{c}", self.prefix, function.spec.name)
    }

    fn pieces(&self, out: &mut String, function: &Function, body: &Body) {
        let parameters = self.parameters(function, &self.results(function)).join(", ");
        let (linkage, unused) = (if self.header_only { "static inline" } else { "static" }, unused(&self.names(function)));
        for (c, piece) in body.pieces.iter().enumerate() {
            let name = self.piece(function, c);
            let _ = writeln!(out, "{linkage} void {name}({parameters}, {} *m) {{\n{unused}    (void)m;", self.value(body));
            self.statements(out, function, body, piece);
            let _ = writeln!(out, "}}\n");
        }
    }

    /// Zeros that no statement stores.
    fn zeros(&self, out: &mut String, function: &Function, body: &Body, ending: Ending) {
        if !body.is_partial || ending == Ending::Filled {
            return;
        }
        for (name, array) in self.results(function).iter().zip(&function.results).filter(|(_, array)| array.numbers() > 0) {
            let _ = writeln!(out, "    for (int k = 0; k < {}; k++) {{\n        {name}[k] = 0;\n    }}", array.numbers());
        }
    }
}

/// The array of a number of the results, and its index there.
fn place(function: &Function, results: &[&str], mut at: usize) -> (String, usize) {
    for (name, array) in results.iter().zip(&function.results) {
        if at < array.numbers() {
            return ((*name).to_owned(), at);
        }
        at -= array.numbers();
    }
    unreachable!("LIR stores what results have")
}

/// Statements that keep compilers from warnings about arguments that a function does not read.
fn unused(names: &[&str]) -> String {
    names.iter().map(|name| format!("    (void){name};\n")).collect()
}
