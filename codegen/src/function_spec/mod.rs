//! Requested functions: names, arguments bound to constants, and groups computed together.
//!
//! ```text
//! inverse_dynamics                                       a function of the table
//! bias = inverse_dynamics(a = 0)                         under another name, with an argument that is a constant
//! step = forward_dynamics + jacobians_body               several in one, which share their work and take what any of them takes
//! fast = inverse_dynamics(q = sin_cos)                   sines and cosines of q are an argument too, for callers that have them
//! ```

mod constant;
mod transform;

use std::fmt;

use articulated_core::algorithm::{Argument, Dim, Function, FunctionId, UserFunction, functions};
use articulated_core::diagnostic::{Code, Diagnostic};
use articulated_core::model::Model;
use articulated_core::step::beside_the_table;

pub use constant::Constant;
pub use transform::{Derivative, Transform};

use constant::{constant, entries};

use crate::{Sym, function};

/// One function to generate.
#[derive(Clone)]
pub struct FunctionSpec {
    /// Its name in Rust.
    pub name: String,
    /// The functions of the table that it consists of; a function of several gives a struct with a
    /// field for each.
    pub parts: Vec<FunctionTerm>,
    /// The derivative of the only part that it is, if it is one.
    pub transform: Option<Transform>,
    /// Whether it is f(q/|q|), in which each quaternion has length one.
    pub normalises: bool,
}

/// A result of a function.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Output {
    /// Its name, if there are several.
    pub name: &'static str,
    /// Its dimensions; empty for a single number.
    pub dims: Vec<Dim>,
    /// Its units, and the meaning of the dimensions.
    pub unit: String,
}

/// A function of the table, with arguments that are constants.
#[derive(Clone)]
pub struct FunctionTerm {
    /// The function.
    pub function: &'static Function<Sym>,
    /// Arguments bound to constants.
    pub constants: Vec<(Argument, Constant)>,
    /// Whether the caller supplies the sines and cosines of q.
    pub sines: bool,
}

/// Functions of the user, which requests may name beside those of the table.
#[derive(Clone, Default)]
pub struct UserFunctions {
    functions: Vec<&'static Function<Sym>>,
    /// Names of those without a result, which requests refuse.
    without_result: Vec<&'static str>,
}

impl UserFunctions {
    /// Adds a function, in place of an earlier one of the same name.
    pub fn push<F: UserFunction>(&mut self, function: F) {
        self.functions.retain(|other| other.name != F::NAME);
        self.without_result.retain(|name| *name != F::NAME);
        if F::OUTPUTS.is_empty() {
            self.without_result.push(F::NAME);
        }
        self.functions.push(Function::of_user(function));
    }

    /// Whether a function was given without a result.
    pub(crate) fn lacks_result(&self, function: &Function<Sym>) -> bool {
        self.without_result.contains(&function.name)
    }

    /// The functions.
    pub fn iter(&self) -> impl Iterator<Item = &'static Function<Sym>> + '_ {
        self.functions.iter().copied()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.functions.is_empty()
    }
}

impl fmt::Debug for UserFunctions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.iter().map(|function| function.name)).finish()
    }
}

impl PartialEq for UserFunctions {
    fn eq(&self, other: &Self) -> bool {
        self.functions.len() == other.functions.len() && self.functions.iter().zip(&other.functions).all(|(a, b)| std::ptr::eq(*a, *b))
    }
}

/// An entry of the list of functions that is wrong.
pub(crate) fn wrong_entry(entry: &str, reason: &str) -> Diagnostic {
    Diagnostic::refusal("", (Default::default(), "functions"), Code::FunctionSpec, format!("`{entry}`: {reason}"))
}

impl FunctionSpec {
    /// The function of the table by itself.
    pub fn plain(function: &'static Function<Sym>) -> Self {
        Self {
            name: function.name.into(),
            parts: vec![FunctionTerm { function, constants: Vec::new(), sines: false }],
            transform: None,
            normalises: false,
        }
    }

    /// Reads one entry of a list of functions of the table.
    pub fn parse(text: &str) -> Result<Self, Diagnostic> {
        Self::parse_with(text, &UserFunctions::default())
    }

    /// The same, with functions of the user beside those of the table.
    pub fn parse_with(text: &str, users: &UserFunctions) -> Result<Self, Diagnostic> {
        let wrong = |reason: String| wrong_entry(text.trim(), &reason);
        let (name, rest) = match split_outside(text, '=') {
            Some((name, rest)) => (Some(name.trim()), rest),
            None => (None, text),
        };
        let mut parts = Vec::new();
        let derivative = transform::split(rest);
        for part in all_outside(derivative.map_or(rest, |(_, function, _)| function), '+') {
            parts.push(FunctionTerm::parse(part.trim(), users, &wrong)?);
        }
        let transform = match (derivative, parts.as_slice()) {
            (None, _) => None,
            (Some((kind, _, list)), [part]) => Some(transform::parse(kind, part, list, &wrong)?),
            (Some((kind, ..)), _) => return Err(wrong(format!("{} takes one function, and not a sum", kind.name()))),
        };
        let name = match (name, parts.as_slice()) {
            (None, _) if transform.is_some() => return Err(wrong("a derivative needs a name: write name = vjp(function)".into())),
            (Some(name), _) => name,
            (None, [one]) => one.function.name,
            (None, _) => return Err(wrong("several functions in one need a name: write name = first + second".into())),
        };
        let twice = (1..parts.len()).find(|&k| parts[..k].iter().any(|p| p.function.name == parts[k].function.name));
        if let Some(k) = twice {
            return Err(wrong(format!("`{}` is in it twice", parts[k].function.name)));
        }
        let wanted = Self { name: name.into(), parts, transform, normalises: false };
        let mut names: Vec<&str> = wanted.arguments().iter().map(|a| a.name()).collect();
        let outputs = wanted.outputs();
        names.extend(outputs.iter().filter(|_| outputs.len() > 1).map(|output| output.name));
        if let Some(k) = (1..names.len()).find(|&k| names[..k].contains(&names[k])) {
            return Err(wrong(format!("two arguments or results are called `{}`: expected other names of ports", names[k])));
        }
        match wanted.no_name() {
            Some(reason) => Err(wrong(format!("`{name}` {reason}"))),
            None => Ok(wanted),
        }
    }

    /// Its arguments: those that a part takes and that are not bound to constants there, in the
    /// order of the table, then those that only users' functions have, then sines; last what a
    /// derivative takes beside them. A user's function by itself has its own order.
    pub fn arguments(&self) -> Vec<Argument> {
        let mut arguments = self.arguments_of_parts();
        arguments.extend(self.transform.iter().flat_map(|transform| transform.arguments(&self.parts[0])));
        arguments
    }

    /// The results, in order.
    pub fn outputs(&self) -> Vec<Output> {
        match &self.transform {
            None => self.parts.iter().flat_map(FunctionTerm::outputs).collect(),
            Some(transform) => transform.outputs(&self.parts[0]),
        }
    }

    /// What each part computes, in a sentence.
    pub(crate) fn summaries(&self) -> Vec<String> {
        match &self.transform {
            None => self.parts.iter().map(|part| part.summary().to_owned()).collect(),
            Some(transform) => vec![transform.summary(&self.parts[0])],
        }
    }

    /// The arguments without those of a derivative.
    pub(crate) fn arguments_of_parts(&self) -> Vec<Argument> {
        let taken = |a: &Argument| self.parts.iter().any(|p| p.function.takes.contains(a) && p.constant(*a).is_none());
        // A user's function by itself keeps its order.
        if let [part] = self.parts.as_slice()
            && part.function.id == FunctionId::user
        {
            return part.function.takes.iter().filter(|a| taken(a)).copied().chain(part.sines.then_some(Argument::SinCos)).collect();
        }
        let mut own: Vec<Argument> = Vec::new();
        for argument in self.parts.iter().flat_map(|p| p.function.takes) {
            if taken(argument) && !Argument::ALL.contains(argument) && !own.contains(argument) {
                own.push(*argument);
            }
        }
        let sines = self.parts.iter().any(|p| p.sines).then_some(Argument::SinCos);
        Argument::ALL.into_iter().filter(taken).chain(own).chain(sines).collect()
    }

    /// Why it cannot be called so, if it cannot.
    fn no_name(&self) -> Option<&'static str> {
        let name = self.name.as_str();
        let plain = name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_');
        if !plain || !name.starts_with(|c: char| c.is_ascii_lowercase()) {
            return Some("is not a valid name for a function: expected lower case letters, digits and _");
        }
        let is_part = |f: &Function<Sym>| self.transform.is_none() && self.parts.iter().any(|part| part.function.name == f.name);
        let is_another = |f: &Function<Sym>| f.name == name && !is_part(f);
        if functions::<Sym>().iter().chain(beside_the_table()).any(is_another) {
            return Some("is what another function is called: expected a name of its own");
        }
        let outputs = self.outputs();
        let results = outputs.len() > 1 && outputs.iter().any(|output| output.name == name);
        let argument = results || self.arguments().iter().any(|a| a.name() == name);
        argument.then_some("is what one of its arguments or results is called: expected another name")
    }

    /// The type that holds the results of several parts: the name with each word's first letter in
    /// capitals. `None` for one part.
    pub(crate) fn group(&self) -> Option<String> {
        let word = |w: &str| w[..1].to_uppercase() + &w[1..];
        (self.outputs().len() > 1).then(|| self.name.split('_').filter(|w| !w.is_empty()).map(word).collect())
    }

    /// The function of the table, if it is one unchanged.
    pub fn as_function(&self) -> Option<&'static Function<Sym>> {
        match self.parts.as_slice() {
            [part]
                if self.transform.is_none()
                    && part.function.id != FunctionId::user
                    && part.constants.is_empty()
                    && !part.sines
                    && part.function.name == self.name =>
            {
                Some(part.function)
            }
            _ => None,
        }
    }

    /// The same function with equal but cheaper terms: arguments fixed at zero then cost nothing.
    pub(crate) fn reduced(&self) -> Self {
        Self {
            name: self.name.clone(),
            parts: self.parts.iter().map(FunctionTerm::reduced).collect(),
            transform: self.transform.clone(),
            normalises: self.normalises,
        }
    }

    /// Checks constants for a robot: their number, and unit quaternions.
    pub fn check(&self, model: &Model<f64>) -> Result<(), Diagnostic> {
        let mut constants =
            self.parts.iter().flat_map(|p| p.constants.iter().map(move |(argument, constant)| (p.function.id, argument, constant)));
        let wrong = |reason: String| wrong_entry(&self.name, &reason);
        constants.try_for_each(|(function, argument, constant)| constant.fits(function, *argument, model)).map_err(wrong)
    }
}

impl FunctionTerm {
    fn parse(text: &str, users: &UserFunctions, wrong: &dyn Fn(String) -> Diagnostic) -> Result<Self, Diagnostic> {
        let (name, arguments) = match text.split_once('(') {
            None => (text, None),
            Some((name, rest)) => {
                let inner = rest.trim_end().strip_suffix(')').ok_or_else(|| wrong("expected `)` at the end".into()))?;
                (name.trim(), Some(inner))
            }
        };
        if name.is_empty() {
            return Err(wrong("expected a function, as in name = first + second(a = 0)".into()));
        }
        let own = users.functions.iter().find(|function| function.name == name).copied();
        let function = own.map_or_else(|| function(name), Ok).map_err(|error| Diagnostic { field: "functions".into(), ..error })?;
        let mut constants = Vec::new();
        let mut sines = false;
        for entry in arguments.into_iter().flat_map(|a| entries(all_outside(a, ','))) {
            if is_sines(entry) && function.takes.contains(&Argument::Q) {
                sines = true;
                continue;
            }
            let (argument, value) = constant(entry, function, wrong)?;
            if constants.iter().any(|(a, _)| *a == argument) {
                return Err(wrong(format!("constant {} is given twice", argument.name())));
            }
            constants.push((argument, value));
        }
        if let (true, Some(_)) = (sines, constants.iter().find(|(a, _)| *a == Argument::Q)) {
            return Err(wrong("q is a constant, and its sines are an argument".into()));
        }
        Ok(Self { function, constants, sines })
    }

    /// The equal term that takes none of the arguments that are fixed at zero, as far as there is
    /// one.
    fn reduced(&self) -> Self {
        if self.function.id == FunctionId::user {
            return self.clone();
        }
        let function = self.function.at_zero(|argument| self.constant(argument).is_some_and(Constant::is_zero));
        let constants = self.constants.iter().filter(|(argument, _)| function.takes.contains(argument)).cloned().collect();
        Self { function, constants, sines: self.sines }
    }

    /// What the function computes, without a full stop.
    pub(crate) fn summary(&self) -> &'static str {
        self.function.summary.trim_end_matches('.')
    }

    /// The results of the function.
    pub fn outputs(&self) -> Vec<Output> {
        let Function { name, gives, unit, outputs, .. } = self.function;
        match outputs {
            [] => vec![Output { name, dims: gives.to_vec(), unit: (*unit).to_owned() }],
            several => {
                several.iter().map(|port| Output { name: port.name, dims: port.dims.to_vec(), unit: port.unit.to_owned() }).collect()
            }
        }
    }

    /// The constant in the place of an argument.
    pub fn constant(&self, argument: Argument) -> Option<&Constant> {
        self.constants.iter().find(|(a, _)| *a == argument).map(|(_, c)| c)
    }
}

/// `q = sin_cos`
fn is_sines(entry: &str) -> bool {
    entry.split_once('=').is_some_and(|(name, value)| (name.trim(), value.trim()) == ("q", "sin_cos"))
}

/// The text before and after the first `mark` that is in no brackets.
fn split_outside(text: &str, mark: char) -> Option<(&str, &str)> {
    let mut depth = 0;
    for (at, c) in text.char_indices() {
        match c {
            '(' | '[' => depth += 1,
            ')' | ']' => depth -= 1,
            c if c == mark && depth == 0 => return Some((&text[..at], &text[at + mark.len_utf8()..])),
            _ => {}
        }
    }
    None
}

/// The pieces between the marks that are in no brackets.
pub(crate) fn all_outside(mut text: &str, mark: char) -> Vec<&str> {
    let mut pieces = Vec::new();
    while let Some((piece, rest)) = split_outside(text, mark) {
        pieces.push(piece);
        text = rest;
    }
    pieces.push(text);
    pieces
}

/// The type of an array of these dimensions in generated code, of numbers of this type.
pub(crate) fn array_of(real: &str, dims: &[Dim]) -> String {
    dims.iter().rev().fold(real.to_owned(), |inner, dim| format!("[{inner}; {dim}]"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_alone_is_the_function() {
        let wanted = FunctionSpec::parse("inverse_dynamics").unwrap();
        assert_eq!(wanted.as_function().map(|f| f.name), Some("inverse_dynamics"));
        assert_eq!(wanted.arguments(), [Argument::Q, Argument::V, Argument::A]);
    }

    #[test]
    fn constants_are_no_arguments() {
        let wanted = FunctionSpec::parse("slow = inverse_dynamics(v = 0, a = [0, -1.5 , 2])").unwrap();
        assert_eq!((wanted.name.as_str(), wanted.arguments()), ("slow", vec![Argument::Q]));
        assert_eq!(wanted.parts[0].constant(Argument::A), Some(&Constant::Each(vec![0.0, -1.5, 2.0])));
        assert!(wanted.as_function().is_none());
    }

    /// A preset exists, returns the same array, takes the remaining arguments, and costs the same
    /// as by itself.
    #[test]
    fn what_is_fixed_at_zero_costs_nothing() {
        let robot = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/urdf/ur5_like.urdf");
        let mut request = crate::Request::new("ur5_like", std::fs::read(robot).unwrap());
        let all = functions::<Sym>();
        let pairs = all.iter().flat_map(|preset| all.iter().map(move |function| (function, preset)));
        let is_preset = |f: &Function<Sym>, preset: &Function<Sym>| {
            f.id != preset.id && f.general == preset.general && preset.takes.iter().all(|a| f.takes.contains(a))
        };
        let pairs: Vec<_> = pairs.filter(|(function, preset)| is_preset(function, preset)).collect();
        assert_eq!(pairs.len(), 14, "each preset of a row and of the row's other presets");
        for (k, (function, preset)) in pairs.into_iter().enumerate() {
            let fixed = function.takes.iter().filter(|a| !preset.takes.contains(a)).map(|a| format!("{} = 0", a.name()));
            let fixed = fixed.collect::<Vec<_>>().join(", ");
            let own = format!("own_{k} = {}({fixed})", function.name);
            request.options.functions.extend([own.into(), format!("plain_{k} = {}", preset.name).into()]);
        }
        request.options.functions.push("all = inverse_dynamics_with_wrenches(v = 0, a = [0, 0, 0, 0, 0, 0], wrenches = 0)".into());
        request.options.functions.push("torque = gravity_torque".into());
        request.options.functions.retain(|f| f.contains('='));
        let generated = crate::generate(&request).unwrap();
        for pair in generated.ledger.functions.chunks(2) {
            assert_eq!(pair[0].emitted(), pair[1].emitted(), "{} and {}", pair[0].function, pair[1].function);
        }
        // And it is the same function: the general algorithm gives its values.
        let model = &generated.model;
        let values = |text: &str| {
            let wanted = FunctionSpec::parse(text).unwrap();
            let way = crate::trace::ways(&wanted.parts[0], model)[0].0;
            let graph = crate::trace::trace(&wanted, &[crate::program::Strategy::plain(way, 0)], model, &[]);
            graph.evaluate(|argument, k| 0.3 - 0.1 * argument as f64 + 0.07 * k as f64)
        };
        for pair in request.options.functions.chunks(2) {
            let [general, preset] = [&pair[0], &pair[1]].map(|text| values(&text.value));
            let scale = preset.iter().fold(1.0, |max: f64, x| max.max(x.abs()));
            assert!(general.iter().zip(&preset).all(|(a, b)| (a - b).abs() < 1e-12 * scale), "{pair:?}");
        }
    }

    #[test]
    fn sines_are_one_argument_more() {
        let wanted = FunctionSpec::parse("fast = inverse_dynamics(q = sin_cos, a = 0)").unwrap();
        assert_eq!(wanted.arguments(), [Argument::Q, Argument::V, Argument::SinCos]);
        assert!(FunctionSpec::parse("inverse_dynamics(q = sin_cos)").unwrap().as_function().is_none());
    }

    #[test]
    fn a_group_takes_what_any_part_takes() {
        let wanted = FunctionSpec::parse("all = mass_matrix + inverse_dynamics(a = 0)").unwrap();
        assert_eq!(wanted.arguments(), [Argument::Q, Argument::V]);
    }

    #[test]
    fn only_what_stands_as_it_is_in_the_table_is_a_function_of_it() {
        let is = |text: &str| FunctionSpec::parse(text).unwrap().as_function().is_some();
        assert!(FunctionSpec::parse("inverse_dynamics = inverse_dynamics(a = 0)").is_ok());
        assert!(is("inverse_dynamics") && is(" inverse_dynamics = inverse_dynamics( ) "));
        assert!(!is("inverse_dynamics(a = 0)") && !is("other = inverse_dynamics"));
    }

    #[test]
    fn the_type_of_several_results_is_called_as_the_function() {
        let group = |text: &str| FunctionSpec::parse(text).unwrap().group();
        assert_eq!(group("one__step_2_ = mass_matrix + placements").as_deref(), Some("OneStep2"));
        assert_eq!(group("step = mass_matrix"), None);
    }

    #[test]
    fn brackets_keep_together_what_is_in_them() {
        assert_eq!(all_outside("a(b + c) + d[e + (f)] + g", '+'), ["a(b + c) ", " d[e + (f)] ", " g"]);
    }

    #[test]
    fn what_is_wrong_is_said() {
        for (text, part) in [
            ("mass_matrix + placements", "need a name"),
            ("x = mass_matrix + mass_matrix", "twice"),
            ("mass_matrx", "did you mean `mass_matrix`?"),
            ("bias_forces(a = 0)", "takes q, v"),
            ("bias_forces(v = x)", "expected a constant"),
            ("bias_forces(v = 0", "expected `)`"),
            ("mass_matrix(q = sin_cos, q = 0)", "its sines are an argument"),
            ("Big = mass_matrix", "not a valid name"),
            ("q = mass_matrix", "arguments or results"),
            ("mass_matrix = mass_matrix + placements", "arguments or results"),
            ("mass_matrix = gravity_torque", "what another function is called"),
            ("mass_matrix = gravity_torque + placements", "what another function is called"),
            ("x = ", "expected a function"),
            ("x = mass_matrix + placements + mass_matrix", "twice"),
            ("x = placements + mass_matrix + mass_matrix", "twice"),
            ("inverse_dynamics(v = 0, v = [1])", "given twice"),
            ("bias_forces(v = inf)", "expected a constant"),
            ("bias_forces(v = [0, NaN])", "expected a constant"),
            ("random_configuration(q = sin_cos)", "expected a constant as in random_configuration(uniform = 0)"),
            ("mass_matrix(q = sincos)", "or its sines and cosines, q = sin_cos; mass_matrix takes q"),
            ("1st = mass_matrix", "not a valid name"),
            ("_x = mass_matrix", "not a valid name"),
        ] {
            let error = FunctionSpec::parse(text).err().map(|e| e.to_string()).unwrap_or_default();
            assert!(error.contains(part), "{text}: {error}");
        }
    }
}
