//! What a generated function takes and gives, as text.

use std::fmt::Write;

use articulated_core::algorithm::{Dim, Shape};

use crate::Level;
use crate::emit::function::levels::is_long;
use crate::emit::function::results::{ZERO, is_sparse, nested, zeros};
use crate::emit::memory::chunks::{self, gives_much};
use crate::emit::written::rows::WIDTH;
use crate::program::{Columns, Program};
use crate::wanted::{Wanted, array_of};

/// What is handed in.
#[derive(Clone)]
pub(crate) struct Input {
    pub(crate) name: &'static str,
    /// None for the parameters.
    dims: Vec<Dim>,
}

impl Input {
    fn declared(&self, real: &str) -> String {
        let ty = if self.dims.is_empty() { "[f64; PARAMETERS.len()]".into() } else { array_of(real, &self.dims) };
        format!("{}: &{ty}", self.name)
    }

    /// Whether it is the parameters.
    pub(crate) fn is_parameters(&self) -> bool {
        self.dims.is_empty()
    }

    /// Number `k` of it where it is one array of numbers.
    pub(crate) fn flat(&self, k: usize) -> String {
        format!("{}[{k}]", self.name)
    }

    /// Number `k` of it.
    pub(crate) fn at(&self, k: usize) -> String {
        match self.dims.as_slice() {
            [_, Dim::Of(width)] => format!("{}[{}][{}]", self.name, k / width, k % width),
            _ => format!("{}[{k}]", self.name),
        }
    }
}

/// Where a body puts its result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// It is the body's value.
    Value,
    /// Into what the caller hands in, whole, whatever that holds or if it holds nothing.
    Written,
    /// Into what the caller hands in, number by number as they are made, whatever that holds; where a loop remains, zeros.
    Filled,
}

impl Place {
    /// Of the result of this program. To write where nothing is yet needs a line of `unsafe`.
    pub(crate) fn of(program: &Program, level: Level, forbid_unsafe: bool) -> Self {
        let graph = &program.graph;
        match graph.outputs.len() {
            2.. if graph.lanes().width == WIDTH && !forbid_unsafe && !chunks::is_long(graph, false) && program.columns.is_none() => {
                Self::Written
            }
            _ if gives_much(graph) || program.columns.is_some() => Self::Filled,
            0 | 1 => Self::Value,
            _ if forbid_unsafe || is_long(program, level) => Self::Value,
            _ => Self::Written,
        }
    }
}

/// A list and what comes last: a function whose arguments are all constants has no other.
fn joined(list: &str, last: &str) -> String {
    if list.is_empty() { last.to_owned() } else { format!("{list}, {last}") }
}

/// An array of arrays as one.
pub(crate) struct Flat {
    pub(crate) ty: String,
    pub(crate) numbers: usize,
    /// How many times its elements are arrays themselves.
    pub(crate) nests: usize,
}

/// A function's arguments and results.
#[derive(Clone)]
pub(crate) struct Signature<'a> {
    pub(crate) wanted: &'a Wanted,
    pub(crate) inputs: Vec<Input>,
    sizes: Shape,
    /// Where the result goes.
    pub(crate) place: Place,
    /// The loop over columns that remains.
    pub(crate) columns: Option<&'a Columns>,
    /// Whether the body is cut into pieces.
    pub(crate) long: bool,
    /// Whether values wait in memory where this text says, not where a compiler does.
    pub(crate) spills: bool,
    /// Whether there is such a text beside this one.
    pub(crate) has_spilled: bool,
    /// The type of the result, if there are several.
    group: Option<String>,
    /// The type of the numbers that go in and come out.
    real: &'static str,
}

impl<'a> Signature<'a> {
    pub(crate) fn of(wanted: &'a Wanted, sizes: Shape, parameters: bool) -> Self {
        let mut inputs: Vec<Input> = wanted.arguments().iter().map(|a| Input { name: a.name(), dims: a.dims().to_vec() }).collect();
        if parameters {
            inputs.push(Input { name: "parameters", dims: Vec::new() });
        }
        Self {
            wanted,
            inputs,
            sizes,
            place: Place::Value,
            columns: None,
            long: false,
            spills: false,
            has_spilled: false,
            group: wanted.group(),
            real: "f64",
        }
    }

    /// The same with numbers of another type.
    pub(crate) fn with(self, real: &'static str) -> Self {
        Self { real, ..self }
    }

    /// The same of a body in one piece, in which values wait where its text says.
    pub(crate) fn that_spills(&self) -> Self {
        Self { long: false, spills: true, ..self.clone() }
    }

    /// The type of an array of these dimensions.
    pub(crate) fn array(&self, dims: &[Dim]) -> String {
        array_of(self.real, dims)
    }

    /// `q: &[f64; NQ], v: &[f64; NV]`
    pub(crate) fn arguments(&self) -> String {
        self.inputs.iter().map(|i| i.declared(self.real)).collect::<Vec<_>>().join(", ")
    }

    /// `q, v`
    pub(crate) fn names(&self) -> String {
        self.inputs.iter().map(|i| i.name).collect::<Vec<_>>().join(", ")
    }

    /// The arguments and one more.
    pub(crate) fn arguments_and(&self, last: &str) -> String {
        joined(&self.arguments(), last)
    }

    /// The names of the arguments and one more operand.
    pub(crate) fn names_and(&self, last: &str) -> String {
        joined(&self.names(), last)
    }

    /// What a body takes: the arguments, and where the result goes if it goes there.
    pub(crate) fn takes(&self) -> String {
        let gives = self.gives();
        match self.place {
            Place::Value => self.arguments(),
            Place::Written => self.arguments_and(&format!("out: &mut ::core::mem::MaybeUninit<{gives}>")),
            Place::Filled => self.arguments_and(&format!("out: &mut {gives}")),
        }
    }

    /// What a body is handed.
    pub(crate) fn handed(&self) -> String {
        if self.place == Place::Value { self.names() } else { self.names_and("out") }
    }

    /// What a body returns.
    pub(crate) fn returns(&self) -> String {
        if self.place == Place::Value { format!(" -> {}", self.gives()) } else { String::new() }
    }

    /// Whether there is a form that writes into what the caller has: wherever the result is more than a number.
    pub(crate) fn has_into(&self) -> bool {
        self.group.is_some() || !self.wanted.parts[0].function.gives.is_empty()
    }

    /// What a body fills as one array, where it is an array of arrays.
    pub(crate) fn flattened(&self) -> Option<Flat> {
        let nests = self.wanted.parts[0].function.gives.len().checked_sub(1)?;
        if nests == 0 || self.group.is_some() {
            return None;
        }
        let numbers = self.wanted.parts[0].function.len(self.sizes);
        Some(Flat { ty: format!("[{}; {numbers}]", self.real), numbers, nests })
    }

    /// The type of the result.
    pub(crate) fn gives(&self) -> String {
        self.group.clone().unwrap_or_else(|| self.array(self.wanted.parts[0].function.gives))
    }

    /// Writes the type that holds the results of a group.
    pub(crate) fn results_type(&self, out: &mut String) {
        let Some(name) = &self.group else { return };
        let _ = writeln!(out, "/// What [`{}`] gives.", self.wanted.name);
        let _ = writeln!(out, "#[derive(::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::cmp::PartialEq)]");
        let _ = writeln!(out, "pub struct {name} {{");
        for part in &self.wanted.parts {
            let f = part.function;
            let _ = writeln!(
                out,
                "    /// {}: `{}`, {}.\n    pub {}: {},",
                f.summary,
                self.array(f.gives),
                f.unit,
                f.name,
                self.array(f.gives)
            );
        }
        let _ = writeln!(out, "}}\n");
    }

    /// The values of each part, with its name and the lengths of its array.
    fn parts<'v>(&self, mut values: &'v [String]) -> Vec<(&'static str, &'v [String], Vec<usize>)> {
        let mut parts = Vec::new();
        for part in &self.wanted.parts {
            let (own, others) = values.split_at(part.function.len(self.sizes));
            parts.push((part.function.name, own, part.function.gives.iter().map(|d| d.len(self.sizes)).collect()));
            values = others;
        }
        parts
    }

    /// Writes the end of a body: the result made of these values.
    pub(crate) fn result(&self, out: &mut String, values: &[String]) {
        if let (Place::Written, None, [(_, own, lengths)]) = (self.place, &self.group, self.parts(values).as_slice())
            && is_sparse(own)
            && own.iter().any(|value| value != ZERO)
        {
            let _ = writeln!(out, "    let out = out.write({});", zeros(lengths));
            return put(out, "out", own, lengths);
        }
        let mut results = Vec::new();
        for (name, own, lengths) in self.parts(values) {
            let value = if is_sparse(own) { sparse(out, name, own, &lengths) } else { nested(own, &lengths) };
            results.push((name, value));
        }
        let value = match &self.group {
            None => results.into_iter().map(|(_, value)| value).collect(),
            Some(name) => {
                let fields: Vec<String> = results.iter().map(|(field, value)| format!("        {field}: {value},\n")).collect();
                format!("{name} {{\n{}    }}", fields.concat())
            }
        };
        let _ = if self.place == Place::Written { writeln!(out, "    out.write({value});") } else { writeln!(out, "    {value}") };
    }

    /// The room of each array of a result that is written where nothing is yet: a name, a pointer to it, how many numbers.
    pub(crate) fn rooms(&self) -> Vec<(String, String, usize)> {
        let parts = self.wanted.parts.iter().map(|part| (part.function.name, part.function.len(self.sizes)));
        match &self.group {
            None => parts.map(|(_, length)| ("out".to_owned(), "out.as_mut_ptr()".to_owned(), length)).collect(),
            Some(_) => {
                parts.map(|(name, length)| (format!("out_{name}"), format!("(&raw mut (*out.as_mut_ptr()).{name})"), length)).collect()
            }
        }
    }

    /// A result of zeros.
    pub(crate) fn nothing(&self) -> String {
        let part = |gives: &[Dim]| zeros(&gives.iter().map(|d| d.len(self.sizes)).collect::<Vec<_>>());
        match &self.group {
            None => part(self.wanted.parts[0].function.gives),
            Some(name) => {
                let fields: Vec<String> =
                    self.wanted.parts.iter().map(|p| format!("{}: {}", p.function.name, part(p.function.gives))).collect();
                format!("{name} {{ {} }}", fields.join(", "))
            }
        }
    }

    /// Where each number of the result stands in `out: &mut` result.
    pub(crate) fn places(&self) -> Vec<String> {
        let mut places = Vec::new();
        for part in &self.wanted.parts {
            let lengths: Vec<usize> = part.function.gives.iter().map(|d| d.len(self.sizes)).collect();
            let of = if self.group.is_some() { format!("out.{}", part.function.name) } else { "out".to_owned() };
            let star = if self.group.is_none() && lengths.is_empty() { "*" } else { "" };
            places.extend((0..part.function.len(self.sizes)).map(|k| format!("{star}{of}{}", super::results::index(k, &lengths))));
        }
        places
    }
}

/// An array of zeros, and what is not zero put in one by one: for the compiler far less than to write every zero out. Returns its name.
fn sparse(out: &mut String, name: &str, values: &[String], lengths: &[usize]) -> String {
    let mutable = if values.iter().any(|value| value != ZERO) { "mut " } else { "" };
    let _ = writeln!(out, "    let {mutable}{name} = {};", zeros(lengths));
    put(out, name, values, lengths);
    name.to_owned()
}

/// Puts what is not zero into an array of zeros.
fn put(out: &mut String, name: &str, values: &[String], lengths: &[usize]) {
    for (k, value) in values.iter().enumerate().filter(|(_, value)| *value != ZERO) {
        let _ = writeln!(out, "    {name}{} = {};", super::results::index(k, lengths), crate::emit::statements::literal::bare(value));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHAPE: Shape = Shape { nq: 9, nv: 9, frames: 0, links: 0 };

    /// The end of a body that gives these values.
    fn end(text: &str, place: Place, values: &[String]) -> String {
        let wanted = Wanted::parse(text).unwrap();
        let (mut signature, mut out) = (Signature::of(&wanted, SHAPE, false), String::new());
        signature.place = place;
        signature.result(&mut out, values);
        out
    }

    /// Zeros but for one in so many.
    fn sparse(n: usize, every: usize) -> Vec<String> {
        (0..n).map(|k| if k % every == 1 { format!("x{k}") } else { ZERO.to_owned() }).collect()
    }

    #[test]
    fn of_a_result_of_zeros_what_is_none_is_put_in_its_place() {
        let values = sparse(81, 10);
        let puts: String = (0..81).filter(|k| values[*k] != ZERO).map(|k| format!("    NAME[{}][{}] = x{k};\n", k / 9, k % 9)).collect();
        let zeros = "[[0.0; 9]; 9]";
        let into = end("mass_matrix", Place::Written, &values);
        assert_eq!(into, format!("    let out = out.write({zeros});\n{}", puts.replace("NAME", "out")));
        let value = end("mass_matrix", Place::Value, &values);
        let puts = puts.replace("NAME", "mass_matrix");
        assert_eq!(value, format!("    let mut mass_matrix = {zeros};\n{puts}    mass_matrix\n"));
        let both = end("both = mass_matrix + gravity_torque", Place::Written, &[values, sparse(9, 2)].concat());
        let torque = "[0.0, x1, 0.0, x3, 0.0, x5, 0.0, x7, 0.0]";
        let fields = format!("        mass_matrix: mass_matrix,\n        gravity_torque: {torque},\n");
        assert_eq!(both, format!("    let mut mass_matrix = {zeros};\n{puts}    out.write(Both {{\n{fields}    }});\n"));
        // A number that is assigned needs no brackets.
        let negative = [&["(-2.0)".to_owned()], &vec![ZERO.to_owned(); 80][..]].concat();
        let into = end("mass_matrix", Place::Written, &negative);
        assert_eq!(into, format!("    let out = out.write({zeros});\n    out[0][0] = -2.0;\n"));
        // Nothing is put where all is zero.
        let none = end("mass_matrix", Place::Written, &vec![ZERO.to_owned(); 81]);
        assert_eq!(none, format!("    let mass_matrix = {zeros};\n    out.write(mass_matrix);\n"));
    }

    #[test]
    fn each_number_has_its_place_whatever_it_is_part_of() {
        let of = |text: &str| {
            let wanted = Wanted::parse(text).unwrap();
            let signature = Signature::of(&wanted, Shape { nq: 2, nv: 2, ..SHAPE }, false);
            (signature.places(), signature.flattened().map(|flat| (flat.numbers, flat.nests)), signature.nothing())
        };
        let strings = |places: &[&str]| places.iter().map(|place| (*place).to_owned()).collect::<Vec<_>>();
        let matrix = ["out[0][0]", "out[0][1]", "out[1][0]", "out[1][1]"];
        assert_eq!(of("mass_matrix"), (strings(&matrix), Some((4, 1)), "[[0.0; 2]; 2]".into()));
        assert_eq!(of("gravity_torque"), (strings(&["out[0]", "out[1]"]), None, "[0.0; 2]".into()));
        assert_eq!(of("kinetic_energy"), (strings(&["*out"]), None, "0.0".into()));
        let both = of("both = kinetic_energy + gravity_torque");
        let places = strings(&["out.kinetic_energy", "out.gravity_torque[0]", "out.gravity_torque[1]"]);
        assert_eq!(both, (places, None, "Both { kinetic_energy: 0.0, gravity_torque: [0.0; 2] }".into()));
        assert_eq!(of("both = mass_matrix + kinetic_energy").1, None);
    }
}
