//! What functions a request wants: which, with what given up as a constant, and which together.
//!
//! ```text
//! inverse_dynamics                                       a function of the table
//! bias = inverse_dynamics(a = 0)                         under another name, with an argument that is a constant
//! step = forward_dynamics + jacobians_body               several in one, which share their work and take what any of them takes
//! fast = inverse_dynamics(q = sin_cos)                   sines and cosines of q are an argument too, for callers that have them
//! ```

use std::borrow::Cow;

use articulated_core::algorithm::{Argument, Dim, Function};
use articulated_core::description::JointKind;
use articulated_core::model::{JointInfo, Model};

use crate::{Error, Sym, function};

/// One function to generate.
#[derive(Clone)]
pub struct Wanted {
    /// Its name in Rust.
    pub name: String,
    /// The functions of the table that it consists of; a function of several gives a struct with a field for each.
    pub parts: Vec<Part>,
}

/// A function of the table, with arguments that are constants.
#[derive(Clone)]
pub struct Part {
    /// The function.
    pub function: &'static Function<Sym>,
    /// What is given up.
    pub constants: Vec<(Argument, Constant)>,
    /// Whether the caller gives the sines and cosines of q.
    pub sines: bool,
}

/// The value of an argument that is a constant.
#[derive(Clone, Debug, PartialEq)]
pub enum Constant {
    /// Every number of it is this.
    All(f64),
    /// Its numbers, row by row.
    Each(Vec<f64>),
}

impl Wanted {
    /// The function of the table by itself.
    pub fn plain(function: &'static Function<Sym>) -> Self {
        Self { name: function.name.into(), parts: vec![Part { function, constants: Vec::new(), sines: false }] }
    }

    /// Reads one entry of a list of functions.
    pub fn parse(text: &str) -> Result<Self, Error> {
        let wrong = |reason: String| Error::Wanted { found: text.trim().into(), reason };
        let (name, rest) = match split_outside(text, '=') {
            Some((name, rest)) => (Some(name.trim()), rest),
            None => (None, text),
        };
        let mut parts = Vec::new();
        for part in all_outside(rest, '+') {
            parts.push(Part::parse(part.trim(), &wrong)?);
        }
        let name = match (name, parts.as_slice()) {
            (Some(name), _) => name,
            (None, [one]) => one.function.name,
            (None, _) => return Err(wrong("several functions in one need a name: write name = first + second".into())),
        };
        let twice = (1..parts.len()).find(|&k| parts[..k].iter().any(|p| p.function.id == parts[k].function.id));
        if let Some(k) = twice {
            return Err(wrong(format!("`{}` is in it twice", parts[k].function.name)));
        }
        let wanted = Self { name: name.into(), parts };
        match wanted.no_name() {
            Some(reason) => Err(wrong(format!("`{name}` {reason}"))),
            None => Ok(wanted),
        }
    }

    /// What it takes: everything that a part takes and that is no constant there, in the order of the table; sines last.
    pub fn arguments(&self) -> Vec<Argument> {
        let taken = |a: &Argument| self.parts.iter().any(|p| p.function.takes.contains(a) && p.constant(*a).is_none());
        let sines = self.parts.iter().any(|p| p.sines).then_some(Argument::SinCos);
        Argument::ALL.into_iter().filter(taken).chain(sines).collect()
    }

    /// Why it cannot be called so, if it cannot.
    fn no_name(&self) -> Option<&'static str> {
        let (name, among) = (self.name.as_str(), |words: &str| words.split_whitespace().any(|word| word == self.name));
        let plain = name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_');
        if !plain || !name.starts_with(|c: char| c.is_ascii_lowercase()) {
            return Some("is not a valid name for a Rust function: expected lower case letters, digits and _");
        }
        // The type of several results is called as they are: `self_` would be `Self`.
        if is_keyword(name) || name.trim_end_matches('_') == "self" {
            return Some("is a reserved word of Rust: expected another name");
        }
        let group = self.group();
        if among(KEPT) || KEPT_TYPES.split_whitespace().any(|word| group.as_deref() == Some(word)) {
            return Some("is kept for a part of the generated module: expected another name");
        }
        let results = self.parts.len() > 1 && self.parts.iter().any(|p| p.function.name == name);
        let argument = results || self.arguments().iter().any(|a| a.name() == name);
        argument.then_some("is what one of its arguments or results is called: expected another name")
    }

    /// The type that holds the results of several parts: the name with each word's first letter in capitals. `None` for one part.
    pub(crate) fn group(&self) -> Option<String> {
        let word = |w: &str| w[..1].to_uppercase() + &w[1..];
        (self.parts.len() > 1).then(|| self.name.split('_').filter(|w| !w.is_empty()).map(word).collect())
    }

    /// The function of the table that it is, if it is one as it stands.
    pub fn as_function(&self) -> Option<&'static Function<Sym>> {
        match self.parts.as_slice() {
            [part] if part.constants.is_empty() && !part.sines && part.function.name == self.name => Some(part.function),
            _ => None,
        }
    }

    /// Whether constants are right for a robot: as many numbers as it takes, and quaternions that are some.
    pub fn check(&self, model: &Model<f64>) -> Result<(), Error> {
        let shape = model.shape();
        for (argument, constant) in self.parts.iter().flat_map(|p| &p.constants) {
            let (name, expected) = (argument.name(), argument.len(shape));
            let wrong = |what: String| Err(Error::Wanted { found: self.name.clone(), reason: format!("constant {name}: {what}") });
            let numbers = constant.numbers(expected);
            if numbers.len() != expected {
                return wrong(format!("found {} numbers, expected {expected}", numbers.len()));
            }
            let configuration = matches!(argument, Argument::Q | Argument::Target);
            if let Some((joint, norm)) = model.joints.iter().filter(|_| configuration).find_map(|joint| not_unit(joint, &numbers)) {
                return wrong(format!(
                    "joint {joint:?}: found a quaternion of norm {norm}, expected 1 within {NORM:e}, or 0, which does not turn"
                ));
            }
        }
        Ok(())
    }
}

/// How far the norm of a constant quaternion may be from 1: results are off by twice that.
const NORM: f64 = 1e-9;

/// The joint and the norm of its quaternion, if it has one that is no rotation. That of zeros does not turn.
fn not_unit<'a>(joint: &'a JointInfo, q: &[f64]) -> Option<(&'a str, f64)> {
    let end = joint.q.0 + joint.q.1;
    let quaternion = matches!(joint.kind, JointKind::Floating | JointKind::Spherical).then(|| &q[end - 4..end])?;
    let norm = quaternion.iter().map(|x| x * x).sum::<f64>().sqrt();
    (norm != 0.0 && (norm - 1.0).abs() > NORM).then_some((joint.name.as_str(), norm))
}

impl Constant {
    /// The numbers of an argument of so many.
    fn numbers(&self, count: usize) -> Cow<'_, [f64]> {
        match self {
            Self::All(x) => vec![*x; count].into(),
            Self::Each(numbers) => numbers.into(),
        }
    }
}

impl Part {
    fn parse(text: &str, wrong: &dyn Fn(String) -> Error) -> Result<Self, Error> {
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
        let function = function(name)?;
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

    /// The constant in the place of an argument.
    pub fn constant(&self, argument: Argument) -> Option<&Constant> {
        self.constants.iter().find(|(a, _)| *a == argument).map(|(_, c)| c)
    }
}

impl Constant {
    /// Its number `k`.
    pub fn at(&self, k: usize) -> f64 {
        match self {
            Self::All(x) => *x,
            Self::Each(numbers) => numbers[k],
        }
    }
}

/// `q = sin_cos`
fn is_sines(entry: &str) -> bool {
    entry.split_once('=').is_some_and(|(name, value)| (name.trim(), value.trim()) == ("q", "sin_cos"))
}

fn constant(text: &str, function: &Function<Sym>, wrong: &dyn Fn(String) -> Error) -> Result<(Argument, Constant), Error> {
    let takes: Vec<&str> = function.takes.iter().map(|a| a.name()).collect();
    let expected = || {
        let (found, name, takes) = (text.trim(), function.name, takes.join(", "));
        format!("`{found}`: expected a constant as in {name}(q = 0) or {name}(q = [0, 0]); {name} takes {takes}")
    };
    let (name, value) = text.split_once('=').ok_or_else(|| wrong(expected()))?;
    let argument = function.takes.iter().find(|a| a.name() == name.trim()).ok_or_else(|| wrong(expected()))?;
    let number = |x: &str| number(x).ok_or_else(|| wrong(expected()));
    let value = value.trim();
    let constant = match value.strip_prefix('[').and_then(|v| v.strip_suffix(']')) {
        None => Constant::All(number(value)?),
        Some(list) => Constant::Each(entries(list.split(',').collect()).into_iter().map(number).collect::<Result<_, _>>()?),
    };
    Ok((*argument, constant))
}

/// A finite number; its sign may stand apart, as in the text of the macro's tokens.
fn number(text: &str) -> Option<f64> {
    let text = text.trim();
    let (sign, digits) = text.split_at(text.len() - text.strip_prefix(['-', '+']).unwrap_or(text).len());
    format!("{sign}{}", digits.trim_start()).parse().ok().filter(|x: &f64| x.is_finite())
}

/// The entries of a list without the last if that is empty: there may be a comma behind each.
fn entries(mut pieces: Vec<&str>) -> Vec<&str> {
    pieces.pop_if(|last| last.trim().is_empty());
    pieces
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

/// Whether Rust keeps the word for itself.
pub fn is_keyword(word: &str) -> bool {
    KEYWORDS.split_whitespace().any(|keyword| keyword == word)
}

const KEYWORDS: &str = "as async await break const continue crate dyn else enum extern false fn for gen if impl in let loop match mod move mut pub \
                        ref return self static struct super trait true try type unsafe use where while abstract become box do final macro \
                        override priv typeof unsized virtual yield";

/// Names that generated code uses, beside those of arguments and results.
const KEPT: &str = "fma trig joint frame link q_index v_index parameter parameters robot out";

/// Types that generated code uses, which the type of several results cannot be.
const KEPT_TYPES: &str = "Bits Block Bodies Chunk F Far Float Fma Four Fraction Group Held Kept Lanes LengthError Line M Matrix MultiplyAdd N Numbers Own Pair Path Plain Real Robot Root S Shelf \
                          Spread Sums T Three Turned V Workspace";

/// The type of an array of these dimensions in generated code, of numbers of this type.
pub(crate) fn array_of(real: &str, dims: &[Dim]) -> String {
    dims.iter().rev().fold(real.to_owned(), |inner, dim| format!("[{inner}; {dim}]"))
}

#[cfg(test)]
mod tests {
    use articulated_core::description::Base;

    use super::*;
    use crate::{Options, Real, Request, generate};

    #[test]
    fn a_name_alone_is_the_function() {
        let wanted = Wanted::parse("inverse_dynamics").unwrap();
        assert_eq!(wanted.as_function().map(|f| f.name), Some("inverse_dynamics"));
        assert_eq!(wanted.arguments(), [Argument::Q, Argument::V, Argument::A]);
    }

    #[test]
    fn constants_are_no_arguments() {
        let wanted = Wanted::parse("slow = inverse_dynamics(v = 0, a = [0, -1.5 , 2])").unwrap();
        assert_eq!((wanted.name.as_str(), wanted.arguments()), ("slow", vec![Argument::Q]));
        assert_eq!(wanted.parts[0].constant(Argument::A), Some(&Constant::Each(vec![0.0, -1.5, 2.0])));
        assert!(wanted.as_function().is_none());
    }

    #[test]
    fn a_sign_may_stand_apart_and_a_comma_last() {
        let constant =
            |text: &str| Wanted::parse(&format!("x = inverse_dynamics({text})")).unwrap().parts[0].constant(Argument::A).cloned();
        assert_eq!(["a = - 1.5", "a=+ 2e-3 ,", "a = -\n1"].map(constant), [-1.5, 2e-3, -1.0].map(|x| Some(Constant::All(x))));
        let list = [("a = [ - 1 , + 2.5,\n- 3e1, ],", vec![-1.0, 2.5, -30.0]), ("a = []", Vec::new()), ("", Vec::new())];
        list.into_iter().for_each(|(text, numbers)| assert_eq!(constant(text), (!text.is_empty()).then_some(Constant::Each(numbers))));
    }

    #[test]
    fn numbers_are_not_put_together_and_entries_not_left_out() {
        let numbers = ["1 2", "- - 1", "-+1", "1 e3", "1. 5", "-", "[0 1, 3]", "[,0,,0,]", "[0,,1]", "[,]", "[0,,]", "[0, - ]", ""];
        for number in numbers {
            let told = Wanted::parse(&format!("x = inverse_dynamics(v = {number}, a = 0)")).err().map(|e| e.to_string());
            let told = told.unwrap_or_else(|| panic!("{number}"));
            assert!(told.contains(&format!("`{}`: expected a constant as in", format!("v = {number}").trim())), "{told}");
        }
        for arguments in [",", ", v = 0", "v = 0,, a = 0", "v = 0,,"] {
            let told = Wanted::parse(&format!("x = inverse_dynamics({arguments})")).err().map(|e| e.to_string());
            assert!(told.is_some_and(|told| told.contains("``: expected a constant as in")), "{arguments}");
        }
    }

    #[test]
    fn sines_are_one_argument_more() {
        let wanted = Wanted::parse("fast = inverse_dynamics(q = sin_cos, a = 0)").unwrap();
        assert_eq!(wanted.arguments(), [Argument::Q, Argument::V, Argument::SinCos]);
        assert!(Wanted::parse("inverse_dynamics(q = sin_cos)").unwrap().as_function().is_none());
    }

    #[test]
    fn a_group_takes_what_any_part_takes() {
        let wanted = Wanted::parse("all = mass_matrix + inverse_dynamics(a = 0)").unwrap();
        assert_eq!(wanted.arguments(), [Argument::Q, Argument::V]);
    }

    #[test]
    fn only_what_stands_as_it_is_in_the_table_is_a_function_of_it() {
        let is = |text: &str| Wanted::parse(text).unwrap().as_function().is_some();
        assert!(is("inverse_dynamics") && is(" inverse_dynamics = inverse_dynamics( ) "));
        assert!(!is("inverse_dynamics(a = 0)") && !is("other = inverse_dynamics"));
    }

    #[test]
    fn a_constant_has_as_many_numbers_as_the_argument() {
        let wanted = Wanted::parse("slow = inverse_dynamics(v = 0, a = [0, 1])").unwrap();
        let right = |joints: usize| wanted.check(&chain(&vec!["continuous"; joints])).is_ok();
        assert_eq!([1, 2, 3].map(right), [false, true, false]);
    }

    /// A quaternion of another norm is no rotation; zeros stand for none.
    #[test]
    fn a_constant_configuration_has_quaternions_that_turn() {
        let told = |q: &str| Wanted::parse(&format!("x = placements(q = {q})")).unwrap().check(&chain(&["continuous", "spherical"]));
        for q in ["0", "[1, 0, 0, 0, 1]", "[2, 0.6, 0, 0, -0.8]", "[7, 0, 0, 0, 0]"] {
            assert!(told(q).is_ok(), "{q}");
        }
        let text = told("1").unwrap_err().to_string();
        assert!(text.contains("constant q: joint \"j1\": found a quaternion of norm 2, expected 1 within 1e-9"), "{text}");
        assert!(told("[0, 0, 0, 0, 0.999]").is_err());
        let rates = Wanted::parse("x = inverse_dynamics(v = 1, a = 0)").unwrap();
        assert!(rates.check(&chain(&["spherical"])).is_ok());
    }

    /// Joints of these kinds, one on the other.
    fn chain(kinds: &[&str]) -> Model<f64> {
        let joint = |(i, kind): (usize, &&str)| {
            format!("<link name='l{}'/><joint name='j{i}' type='{kind}'><parent link='l{i}'/><child link='l{}'/></joint>", i + 1, i + 1)
        };
        let joints: String = kinds.iter().enumerate().map(joint).collect();
        let request = crate::Request::new("chain.urdf", format!("<robot name='chain'><link name='l0'/>{joints}</robot>"));
        crate::model(&request, &crate::read(&request).unwrap().description).unwrap()
    }

    #[test]
    fn the_type_of_several_results_is_called_as_the_function() {
        let group = |text: &str| Wanted::parse(text).unwrap().group();
        assert_eq!(group("one__step_2_ = mass_matrix + placements").as_deref(), Some("OneStep2"));
        assert_eq!(group("step = mass_matrix"), None);
    }

    #[test]
    fn brackets_keep_together_what_is_in_them() {
        assert_eq!(all_outside("a(b + c) + d[e + (f)] + g", '+'), ["a(b + c) ", " d[e + (f)] ", " g"]);
    }

    /// Whatever the robot and the choices: types of lanes, of loops, of levels, of shelves, of batches, of crates without `std`.
    #[test]
    fn no_type_of_generated_code_is_a_name_for_several_results() {
        let source = |robot: &str, change: &dyn Fn(&mut Options)| {
            let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/urdf");
            let mut request = Request::new(robot, std::fs::read(format!("{folder}/{robot}.urdf")).unwrap());
            request.options.base = if robot == "panda_like" { Base::Fixed } else { Base::Floating };
            request.options.functions = ["forward_dynamics", "inverse_dynamics_derivatives", "integrate"].map(str::to_owned).into();
            change(&mut request.options);
            generate(&request).unwrap().source
        };
        let level = |name: &'static str| move |o: &mut Options| o.level = name.parse().unwrap();
        let sources = [
            source("humanoid", &|_| {}),
            source("quadruped", &|o| (o.batch, o.runtime) = (vec![Real::F64, Real::F32], Some("::articulated".into()))),
            source("panda_like", &|_| {}),
            source("panda_like", &level("f32")),
            source("panda_like", &level("compensated + two")),
            source("panda_like", &level("f64 + correct")),
            source("panda_like", &level("double_double")),
            source("panda_like", &|o| o.no_std = true),
        ];
        let mut free = Vec::new();
        for source in &sources {
            let code: Vec<&str> = source.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
            let code = code.join("\n");
            let words: Vec<&str> = code.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|w| !w.is_empty()).collect();
            let types = words.windows(2).filter(|two| ["struct", "type", "trait", "enum", "union"].contains(&two[0])).map(|two| two[1]);
            let types = types.filter(|word| word.starts_with(|c: char| c.is_ascii_uppercase()) && !word.contains('_'));
            for word in types.chain(["F", "T", "N"]) {
                let name: String = word
                    .chars()
                    .enumerate()
                    .map(|(k, c)| if c.is_uppercase() && k > 0 { format!("_{}", c.to_lowercase()) } else { c.to_lowercase().to_string() })
                    .collect();
                if Wanted::parse(&format!("{name} = mass_matrix + placements")).is_ok() {
                    free.push(word.to_owned());
                }
            }
        }
        assert_eq!(free, [""; 0]);
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
            ("fn = mass_matrix", "reserved word"),
            ("self_ = mass_matrix + placements", "reserved word"),
            ("robot = mass_matrix", "generated module"),
            ("q = mass_matrix", "arguments or results"),
            ("mass_matrix = mass_matrix + placements", "arguments or results"),
            ("out = mass_matrix", "generated module"),
            ("shelf = mass_matrix + placements", "generated module"),
            ("multiply_add = mass_matrix + placements", "generated module"),
            ("f_ = mass_matrix + placements", "generated module"),
            ("x = ", "expected a function"),
            ("x = mass_matrix + placements + mass_matrix", "twice"),
            ("x = placements + mass_matrix + mass_matrix", "twice"),
            ("inverse_dynamics(v = 0, v = [1])", "given twice"),
            ("bias_forces(v = inf)", "expected a constant"),
            ("bias_forces(v = [0, NaN])", "expected a constant"),
            ("random_configuration(q = sin_cos)", "expected a constant"),
            ("1st = mass_matrix", "not a valid name"),
            ("_x = mass_matrix", "not a valid name"),
        ] {
            let error = Wanted::parse(text).err().map(|e| e.to_string()).unwrap_or_default();
            assert!(error.contains(part), "{text}: {error}");
        }
    }
}
