//! Arguments and results of a generated function, as text.

use std::fmt::Write;

use articulated_core::algorithm::Dim;

use crate::function_spec::{Output, array_of};
use crate::language::rust::function::results::{is_sparse, nested, zeros};
use crate::language::rust::literal::bare;
use crate::language::rust::statements::{Place, index};
use crate::lir::function::{Argument, Ending, Function};

/// A list and its last item; the list is empty if all arguments are constants.
fn joined(list: &str, last: &str) -> String {
    if list.is_empty() { last.to_owned() } else { format!("{list}, {last}") }
}

/// The name of a part, its values, and the lengths of its array.
type PartValues<'a> = (&'static str, &'a [Option<String>], &'a [usize]);

/// A function's arguments and results.
pub(crate) struct Signature<'a> {
    pub(crate) function: &'a Function<'a>,
    /// The type of the result, if there are several.
    group: Option<String>,
    /// The type of the numbers that go in and come out.
    real: &'static str,
}

impl<'a> Signature<'a> {
    pub(crate) fn of(function: &'a Function<'a>, real: &'static str) -> Self {
        Self { function, group: function.spec.group(), real }
    }

    /// The function's name.
    pub(crate) fn name(&self) -> &'a str {
        &self.function.spec.name
    }

    /// The type of an array of these dimensions.
    pub(crate) fn array(&self, dims: &[Dim]) -> String {
        array_of(self.real, dims)
    }

    /// `q: &[f64; NQ], v: &[f64; NV]`
    pub(crate) fn arguments(&self) -> String {
        self.argument_list().join(", ")
    }

    /// The same, one by one.
    pub(crate) fn argument_list(&self) -> Vec<String> {
        let declared = |a: &Argument| {
            let ty = if a.is_parameters() { "[f64; PARAMETERS.len()]".into() } else { self.array(&a.dims) };
            format!("{}: &{ty}", a.name)
        };
        self.function.arguments.iter().map(declared).collect()
    }

    /// `q, v`
    pub(crate) fn names(&self) -> String {
        self.function.arguments.iter().map(|a| a.name).collect::<Vec<_>>().join(", ")
    }

    /// The arguments and one more.
    pub(crate) fn arguments_and(&self, last: &str) -> String {
        joined(&self.arguments(), last)
    }

    /// The names of the arguments and one more operand.
    pub(crate) fn names_and(&self, last: &str) -> String {
        joined(&self.names(), last)
    }

    /// Parameters of a body: the arguments, and the destination of the result if it has one.
    pub(crate) fn takes(&self) -> String {
        let gives = self.gives_inside();
        match self.function.ending {
            Ending::Value => self.arguments(),
            Ending::Written | Ending::Rows => self.arguments_and(&format!("out: &mut ::core::mem::MaybeUninit<{gives}>")),
            Ending::Filled => self.arguments_and(&format!("out: &mut {gives}")),
        }
    }

    /// Arguments in the call of a body.
    pub(crate) fn handed(&self) -> String {
        if self.function.ending == Ending::Value { self.names() } else { self.names_and("out") }
    }

    /// Return type of a body.
    pub(crate) fn returns(&self) -> String {
        if self.function.ending == Ending::Value { format!(" -> {}", self.gives_inside()) } else { String::new() }
    }

    /// Whether there is a form that writes into the caller's memory: if the result is more than a
    /// number.
    pub(crate) fn has_into(&self) -> bool {
        self.group.is_some() || !self.function.outputs[0].dims.is_empty()
    }

    /// Number of further dimensions of the result, if it is one array of arrays.
    pub(crate) fn nests(&self) -> Option<usize> {
        let nests = self.function.outputs[0].dims.len().checked_sub(1)?;
        (nests > 0 && self.group.is_none()).then_some(nests)
    }

    /// The type of the result.
    pub(crate) fn gives(&self) -> String {
        self.group.clone().unwrap_or_else(|| self.array(&self.function.outputs[0].dims))
    }

    /// The same, in the private module.
    pub(crate) fn gives_inside(&self) -> String {
        self.group_inside().unwrap_or_else(|| self.gives())
    }

    fn group_inside(&self) -> Option<String> {
        self.group.as_ref().map(|name| format!("super::{name}"))
    }

    /// The type of the result as one array of numbers.
    pub(crate) fn gives_flat(&self) -> String {
        let numbers: usize = self.function.results.iter().map(crate::lir::Array::numbers).sum();
        format!("[{}; {numbers}]", self.real)
    }

    /// Writes the type that holds the results of a group.
    pub(crate) fn results_type(&self, out: &mut String) {
        let Some(name) = &self.group else { return };
        let _ = writeln!(out, "/// Results of [`{}`].", self.name());
        let _ = writeln!(out, "#[derive(\n    ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::cmp::PartialEq,\n)]");
        let _ = writeln!(out, "pub struct {name} {{");
        let mut summaries = self.function.spec.summaries();
        if summaries.len() != self.function.outputs.len() {
            summaries = vec![String::new(); self.function.outputs.len()];
        }
        for (output, summary) in self.function.outputs.iter().zip(summaries) {
            let summary = if summary.is_empty() { summary } else { format!("{summary}: ") };
            let array = self.array(&output.dims);
            let _ = writeln!(out, "    /// {summary}`{array}`, {}.\n    pub {}: {array},", output.unit, output.name);
        }
        let _ = writeln!(out, "}}\n");
    }

    /// The values of each part, with its name and the lengths of its array.
    fn parts<'v>(&'v self, mut values: &'v [Option<String>]) -> Vec<PartValues<'v>> {
        let mut parts = Vec::new();
        for (output, array) in self.function.outputs.iter().zip(&self.function.results) {
            let (own, others) = values.split_at(array.numbers());
            parts.push((output.name, own, array.lengths.as_slice()));
            values = others;
        }
        parts
    }

    /// Writes the end of a body: the result made of these values, `None` for zeros.
    pub(crate) fn result(&self, out: &mut String, values: &[Option<String>]) {
        let is_written = self.function.ending == Ending::Written;
        if let (true, None, [(_, own, lengths)]) = (is_written, &self.group, self.parts(values).as_slice())
            && is_sparse(own)
            && own.iter().any(Option::is_some)
        {
            let _ = writeln!(out, "    let out = out.write({});", zeros(lengths));
            return put(out, "out", own, lengths);
        }
        let mut results = Vec::new();
        for (name, own, lengths) in self.parts(values) {
            let value = if is_sparse(own) { sparse(out, name, own, lengths) } else { nested(own, lengths) };
            results.push((name, value));
        }
        let value = match &self.group_inside() {
            None => results.into_iter().map(|(_, value)| value).collect(),
            Some(name) => {
                let fields: Vec<String> = results.iter().map(|(field, value)| format!("        {field}: {value},\n")).collect();
                format!("{name} {{\n{}    }}", fields.concat())
            }
        };
        let _ = if is_written { writeln!(out, "    out.write({value});") } else { writeln!(out, "    {value}") };
    }

    /// The array of each part of a result in uninitialised memory: its name, a pointer to it, its
    /// length.
    pub(crate) fn rooms(&self) -> Vec<(String, String, usize)> {
        let parts = self.function.outputs.iter().zip(self.function.results.iter());
        let room = |(output, array): (&Output, &crate::lir::Array)| {
            let name = output.name;
            match &self.group {
                None => ("out".to_owned(), "out.as_mut_ptr()".to_owned(), array.numbers()),
                Some(_) => (format!("out_{name}"), format!("(&raw mut (*out.as_mut_ptr()).{name})"), array.numbers()),
            }
        };
        parts.map(room).collect()
    }

    /// A result of zeros.
    pub(crate) fn nothing(&self) -> String {
        self.zeros(self.group.as_deref())
    }

    /// The same, in the private module.
    pub(crate) fn nothing_inside(&self) -> String {
        self.zeros(self.group_inside().as_deref())
    }

    fn zeros(&self, group: Option<&str>) -> String {
        let parts = self.function.outputs.iter().zip(self.function.results.iter());
        match group {
            None => parts.map(|(_, array)| zeros(&array.lengths)).collect(),
            Some(name) => {
                let fields: Vec<String> = parts.map(|(output, array)| format!("{}: {}", output.name, zeros(&array.lengths))).collect();
                format!("{name} {{ {} }}", fields.join(", "))
            }
        }
    }

    /// Where number `at` of the result is in `out: &mut` result.
    pub(crate) fn place(&self, at: usize) -> Place {
        let results = &self.function.results;
        let part = results.iter().rposition(|array| array.start <= at && at < array.start + array.numbers()).unwrap_or(0);
        let (lengths, k) = (&results[part].lengths, at - results[part].start);
        let name = match &self.group {
            Some(_) => format!("out.{}", self.function.outputs[part].name),
            None => "out".to_owned(),
        };
        match lengths.as_slice() {
            [] => Place { array: if self.group.is_none() { format!("*{name}") } else { name }, index: None },
            [rows @ .., last] => Place { array: format!("{name}{}", index(k / last, rows)), index: Some(k % last) },
        }
    }
}

/// An array of zeros, into which other numbers are put one by one: for the compiler far less than
/// to write every zero out. Returns its name.
fn sparse(out: &mut String, name: &str, values: &[Option<String>], lengths: &[usize]) -> String {
    let mutable = if values.iter().any(Option::is_some) { "mut " } else { "" };
    let _ = writeln!(out, "    let {mutable}{name} = {};", zeros(lengths));
    put(out, name, values, lengths);
    name.to_owned()
}

/// Writes the non-zero values into an array of zeros.
fn put(out: &mut String, name: &str, values: &[Option<String>], lengths: &[usize]) {
    for (k, value) in values.iter().enumerate().filter_map(|(k, value)| Some((k, value.as_ref()?))) {
        let _ = writeln!(out, "    {name}{} = {};", index(k, lengths), bare(value));
    }
}

#[cfg(test)]
mod tests {
    use articulated_core::algorithm::Shape;

    use super::*;
    use crate::Precision;
    use crate::capabilities::Capabilities;
    use crate::function_spec::{FunctionSpec, FunctionTerm};
    use crate::graph::Graph;
    use crate::ledger::Entry;
    use crate::program::Program;

    const SHAPE: Shape = Shape { nq: 9, nv: 9, frames: 0, links: 0, controls: 0, activations: 0, contacts: 0, given: 0 };

    fn with<T>(text: &str, shape: Shape, ending: Ending, work: impl FnOnce(&Signature) -> T) -> T {
        let spec = FunctionSpec::parse(text).unwrap();
        let entry = Entry { function: text.into(), ways: Vec::new(), stages: Vec::new(), depth: 0, lanes: 1, arguments: Vec::new() };
        let numbers = |part: &FunctionTerm| part.function.gives.iter().map(|d| d.len(shape)).product::<usize>();
        let mut graph = Graph::default();
        let zero = graph.constant(0.0);
        graph.outputs = vec![zero; spec.parts.iter().map(numbers).sum()];
        let program = Program { spec, graph, plain: Graph::default(), scalar: Graph::default(), entry, columns: None, with_loop: None };
        let level = Precision::default();
        let can = Capabilities { level, vectors: true, raw_memory: true, scalar_too: false, loops: true, spills: true, states: false };
        let mut function = Function::of(&program, shape, false, can);
        function.ending = ending;
        work(&Signature::of(&function, "f64"))
    }

    /// The end of a body with these values.
    fn end(text: &str, ending: Ending, values: &[Option<String>]) -> String {
        with(text, SHAPE, ending, |signature| {
            let mut out = String::new();
            signature.result(&mut out, values);
            out
        })
    }

    /// Zeros except for one in `every`.
    fn sparse(n: usize, every: usize) -> Vec<Option<String>> {
        (0..n).map(|k| (k % every == 1).then(|| format!("x{k}"))).collect()
    }

    #[test]
    fn of_a_sparse_result_other_numbers_are_put_into_zeros() {
        let values = sparse(81, 10);
        let puts: String = (0..81).filter(|k| values[*k].is_some()).map(|k| format!("    NAME[{}][{}] = x{k};\n", k / 9, k % 9)).collect();
        let zeros = "[[0.0; 9]; 9]";
        let into = end("mass_matrix", Ending::Written, &values);
        assert_eq!(into, format!("    let out = out.write({zeros});\n{}", puts.replace("NAME", "out")));
        let value = end("mass_matrix", Ending::Value, &values);
        let puts = puts.replace("NAME", "mass_matrix");
        assert_eq!(value, format!("    let mut mass_matrix = {zeros};\n{puts}    mass_matrix\n"));
        let both = end("both = mass_matrix + gravity_torque", Ending::Written, &[values, sparse(9, 2)].concat());
        let torque = "[0.0, x1, 0.0, x3, 0.0, x5, 0.0, x7, 0.0]";
        let fields = format!("        mass_matrix: mass_matrix,\n        gravity_torque: {torque},\n");
        assert_eq!(both, format!("    let mut mass_matrix = {zeros};\n{puts}    out.write(super::Both {{\n{fields}    }});\n"));
        // A number that is assigned needs no brackets.
        let negative = [&[Some("(-2.0)".to_owned())], &vec![None; 80][..]].concat();
        let into = end("mass_matrix", Ending::Written, &negative);
        assert_eq!(into, format!("    let out = out.write({zeros});\n    out[0][0] = -2.0;\n"));
        // Nothing is written if all is zero.
        let none = end("mass_matrix", Ending::Written, &vec![None; 81]);
        assert_eq!(none, format!("    let mass_matrix = {zeros};\n    out.write(mass_matrix);\n"));
    }

    #[test]
    fn each_number_has_its_place_whatever_it_is_part_of() {
        let of = |text: &str| {
            with(text, Shape { nq: 2, nv: 2, ..SHAPE }, Ending::Filled, |signature| {
                let numbers: usize = signature.function.results.iter().map(crate::lir::Array::numbers).sum();
                let places: Vec<String> = (0..numbers).map(|at| signature.place(at).to_string()).collect();
                (places, signature.nests().map(|nests| (signature.gives_flat(), nests)), signature.nothing())
            })
        };
        let strings = |places: &[&str]| places.iter().map(|place| (*place).to_owned()).collect::<Vec<_>>();
        let matrix = ["out[0][0]", "out[0][1]", "out[1][0]", "out[1][1]"];
        assert_eq!(of("mass_matrix"), (strings(&matrix), Some(("[f64; 4]".into(), 1)), "[[0.0; 2]; 2]".into()));
        assert_eq!(of("gravity_torque"), (strings(&["out[0]", "out[1]"]), None, "[0.0; 2]".into()));
        assert_eq!(of("kinetic_energy"), (strings(&["*out"]), None, "0.0".into()));
        let both = of("both = kinetic_energy + gravity_torque");
        let places = strings(&["out.kinetic_energy", "out.gravity_torque[0]", "out.gravity_torque[1]"]);
        assert_eq!(both, (places, None, "Both { kinetic_energy: 0.0, gravity_torque: [0.0; 2] }".into()));
        assert_eq!(of("both = mass_matrix + kinetic_energy").1, None);
    }
}
