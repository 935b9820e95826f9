//! Functions of many states in C: one state a lane of a vector.
//!
//! ```text
//! NAME_batch_f64     states one after the other
//! NAME_blocks_f64    blocks of states, each number of a block in one cache line
//! NAME_lanes_f64     as many states of a block as a vector has lanes
//! ```

use std::fmt::Write;

use articulated_core::lanes::Real;

use super::lanes::states_of_block;
use super::statements::{Lanes, Numbers, Printer};
use super::{Source, unused};
use crate::lir::Stmt;
use crate::lir::function::{Function, States};

/// An argument or a result of a batch.
struct Array<'a> {
    name: &'a str,
    /// How long it is, in C.
    length: String,
    numbers: usize,
    is_parameters: bool,
    is_result: bool,
}

impl Array<'_> {
    /// Its declaration as a pointer.
    fn pointer(&self, ty: &str) -> String {
        let constant = if self.is_result { "" } else { "const " };
        format!("{constant}{ty} *{}", self.name)
    }
}

/// Forms of a function: the states one after the other, or blocks of them.
#[derive(Clone, Copy, PartialEq)]
enum Form {
    States,
    Blocks,
}

impl Source<'_> {
    /// The declarations of the functions of many states, documented.
    pub(super) fn declare_batches(&self, out: &mut String) {
        self.each_batch(|function, _, real| {
            for form in [Form::States, Form::Blocks] {
                self.document_batch(out, function, real, form);
                let _ = writeln!(out, "{};\n", self.head(function, real, form));
            }
        });
    }

    /// The functions of many states.
    pub(super) fn batches(&self, out: &mut String) {
        self.each_batch(|function, states, real| {
            let is_any = function.results.iter().any(|array| array.numbers() > 0);
            if is_any {
                self.of_lanes(out, function, states, real);
            }
            for form in [Form::States, Form::Blocks] {
                if self.header_only {
                    self.document_batch(out, function, real, form);
                }
                let _ = writeln!(out, "{} {{", self.head(function, real, form));
                match form {
                    _ if !is_any => {
                        let names: Vec<&str> = self.arrays(function).iter().map(|array| array.name).collect();
                        *out += &unused(&names);
                        *out += if form == Form::States { "    (void)count;\n" } else { "    (void)blocks;\n" };
                        let takes_sets = function.arguments.iter().any(crate::lir::function::Argument::is_parameters);
                        *out += if takes_sets { "    (void)parameter_sets;\n" } else { "" };
                    }
                    Form::States => self.of_states(out, function, real),
                    Form::Blocks => self.of_blocks(out, function, real),
                }
                let _ = writeln!(out, "}}\n");
            }
        });
    }

    fn each_batch(&self, mut see: impl FnMut(&Function, &States, Real)) {
        for real in &self.module.request.options.batch {
            for function in &self.module.functions {
                if let Some(states) = &function.states {
                    see(function, states, *real);
                }
            }
        }
    }

    /// Arguments, then results.
    fn arrays<'f>(&self, function: &'f Function) -> Vec<Array<'f>> {
        let mut all: Vec<Array> = Vec::new();
        for a in &function.arguments {
            let is_parameters = a.is_parameters();
            let length = if is_parameters { format!("{}_PARAMETERS", self.upper) } else { self.lengths(&a.dims) };
            let numbers = if is_parameters { 1 } else { a.dims.iter().map(|d| d.len(function.shape)).product() };
            all.push(Array { name: a.name, length, numbers, is_parameters, is_result: false });
        }
        let results = self.results(function);
        for ((name, output), array) in results.into_iter().zip(&function.outputs).zip(&function.results) {
            let length = self.lengths(&output.dims);
            all.push(Array { name, length, numbers: array.numbers(), is_parameters: false, is_result: true });
        }
        all
    }

    fn document_batch(&self, out: &mut String, function: &Function, real: Real, form: Form) {
        let name = format!("{}_{}", self.prefix, function.spec.name);
        let _ = writeln!(out, "/**\n * {name} for many states, with its arguments, results and units.");
        let n = states_of_block(real);
        let _ = match form {
            Form::States => writeln!(out, " * Arrays have the states one after the other."),
            Form::Blocks => writeln!(
                out,
                " * Number k of state {n} * b + i is at [(b * length + k) * {n} + i]. Faster where arrays begin at a multiple of 64 bytes."
            ),
        };
        if function.arguments.iter().any(crate::lir::function::Argument::is_parameters) {
            let _ = writeln!(out, " * @param parameter_sets 1: the same parameters for all; else one set for each state.");
        }
        let _ = writeln!(out, " * Sines and cosines are at most 1 ulp off.\n */");
    }

    /// A function's name, arguments and results.
    fn head(&self, function: &Function, real: Real, form: Form) -> String {
        let linkage = if self.header_only { "static inline " } else { "" };
        let (form, count) = match form {
            Form::States => ("batch", "size_t count"),
            Form::Blocks => ("blocks", "size_t blocks"),
        };
        let name = format!("{linkage}void {}_{}_{form}_{}", self.prefix, function.spec.name, real.name());
        let mut list = vec![count.to_owned()];
        for array in self.arrays(function) {
            list.push(array.pointer(number(real)));
            list.extend(array.is_parameters.then(|| "size_t parameter_sets".to_owned()));
        }
        let (one_line, indent) = (format!("{name}({})", list.join(", ")), " ".repeat(name.len() + 1));
        if one_line.len() <= 100 { one_line } else { format!("{name}({})", list.join(&format!(",\n{indent}"))) }
    }

    /// The name of the function for a vector of states, or for a piece of it.
    fn lanes_name(&self, function: &Function, real: Real, piece: Option<usize>) -> String {
        let piece = piece.map_or(String::new(), |c| format!("_piece_{c}"));
        format!("{}_{}_lanes_{}{piece}", self.prefix, function.spec.name, real.name())
    }

    /// The function for a vector of states, in pieces if it is long.
    fn of_lanes(&self, out: &mut String, function: &Function, states: &States, real: Real) {
        let prefix = format!("{}_{}", self.prefix, real.name());
        let numbers = Numbers {
            computed: format!("{prefix}_v"),
            outside: number(real),
            is_single: real == Real::F32,
            prefix: &self.prefix,
            own_math: self.own_math(),
            lanes: Some(Lanes { prefix, stride: states_of_block(real) }),
        };
        let (arrays, results) = (self.arrays(function), self.results(function));
        let list: Vec<String> = arrays.iter().map(|array| array.pointer(number(real))).collect();
        let names: Vec<&str> = arrays.iter().map(|array| array.name).collect();
        let (list, ignored) = (list.join(", "), unused(&names));
        let place = |at: usize| super::place(function, &results, at);
        let print = |out: &mut String, piece: &[Stmt]| {
            Printer { arguments: &function.arguments, numbers: &numbers, places: &place }.statements(out, piece);
        };
        let linkage = if self.header_only { "static inline" } else { "static" };
        let (name, v) = (self.lanes_name(function, real, None), &numbers.computed);
        match states.body.pieces.as_slice() {
            [piece] => {
                let _ = writeln!(out, "{linkage} void {name}({list}) {{\n{ignored}");
                print(out, piece);
            }
            pieces => {
                for (c, piece) in pieces.iter().enumerate() {
                    let name = self.lanes_name(function, real, Some(c));
                    let _ = writeln!(out, "{linkage} void {name}({list}, {v} *m) {{\n{ignored}    (void)m;");
                    print(out, piece);
                    let _ = writeln!(out, "}}\n");
                }
                let _ = writeln!(out, "{linkage} void {name}({list}) {{\n    {v} m[{}];", states.body.kept.max(1));
                for c in 0..pieces.len() {
                    let _ = writeln!(out, "    {}({}, m);", self.lanes_name(function, real, Some(c)), names.join(", "));
                }
            }
        }
        let _ = writeln!(out, "}}\n");
    }

    /// The call of the same for all vectors of a block.
    fn call(&self, out: &mut String, function: &Function, real: Real, given: impl Fn(&Array) -> String) {
        let list: Vec<String> = self.arrays(function).iter().map(given).collect();
        let lanes = format!("{}_{}_LANES", self.upper, real.name().to_ascii_uppercase());
        let _ = writeln!(out, "        for (size_t i = 0; i < {}; i += {lanes}) {{", states_of_block(real));
        let _ = writeln!(out, "            {}({});\n        }}", self.lanes_name(function, real, None), list.join(", "));
    }

    fn of_states(&self, out: &mut String, function: &Function, real: Real) {
        let (n, ty, prefix) = (states_of_block(real), number(real), format!("{}_{}", self.prefix, real.name()));
        let arrays = self.arrays(function);
        if function.is_faster_one_by_one(self.level(), real) {
            let list: Vec<String> = arrays.iter().map(|a| format!("{} + k * ({})", a.name, a.length)).collect();
            let _ = writeln!(out, "    /* To turn blocks of results into states takes longer than vectors save. */");
            let _ = writeln!(out, "    for (size_t k = 0; k < count; k++) {{");
            let _ = writeln!(out, "        {}_{}({});\n    }}", self.prefix, function.spec.name, list.join(", "));
            return;
        }
        // C has no arrays of length zero.
        let block = |a: &Array| format!("    {}_ALIGNED {ty} {}_block[{n} * ({})];\n", self.upper, a.name, a.length);
        for a in &arrays {
            *out += &if a.numbers > 0 { block(a) } else { format!("    (void){};\n", a.name) };
        }
        for a in arrays.iter().filter(|a| a.is_parameters) {
            let _ = writeln!(
                out,
                "    if (parameter_sets == 1) {{\n        {prefix}_gather({0}, 1, {1}, {0}_block);\n    }}",
                a.name, a.length
            );
        }
        let _ = writeln!(out, "    for (size_t first = 0; first < count; first += {n}) {{");
        let _ = writeln!(out, "        const size_t some = count - first < {n} ? count - first : {n};");
        for a in arrays.iter().filter(|a| !a.is_result && a.numbers > 0) {
            let gather = format!("{prefix}_gather({0} + first * ({1}), some, {1}, {0}_block);", a.name, a.length);
            let _ = match a.is_parameters {
                true => writeln!(out, "        if (parameter_sets != 1) {{\n            {gather}\n        }}"),
                false => writeln!(out, "        {gather}"),
            };
        }
        self.call(out, function, real, |a| if a.numbers > 0 { format!("{}_block + i", a.name) } else { a.name.to_owned() });
        for a in arrays.iter().filter(|a| a.is_result && a.numbers > 0) {
            let _ = writeln!(out, "        {prefix}_scatter({0}_block, {0} + first * ({1}), some, {1});", a.name, a.length);
        }
        let _ = writeln!(out, "    }}");
    }

    fn of_blocks(&self, out: &mut String, function: &Function, real: Real) {
        let n = states_of_block(real);
        let _ = writeln!(out, "    for (size_t b = 0; b < blocks; b++) {{");
        self.call(out, function, real, |a| {
            let at = if a.is_parameters { "(parameter_sets == 1 ? 0 : b)" } else { "b" };
            if a.numbers > 0 { format!("{} + {at} * {n} * ({}) + i", a.name, a.length) } else { a.name.to_owned() }
        });
        let _ = writeln!(out, "    }}");
    }
}

fn number(real: Real) -> &'static str {
    match real {
        Real::F64 => "double",
        Real::F32 => "float",
    }
}
