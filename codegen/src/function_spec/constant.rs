//! Constants bound to arguments.

use std::borrow::Cow;

use articulated_core::algorithm::{Argument, Function, FunctionId};
use articulated_core::diagnostic::Diagnostic;
use articulated_core::model::{JointInfo, Model};

use crate::Sym;

/// The value of an argument that is a constant.
#[derive(Clone, Debug, PartialEq)]
pub enum Constant {
    /// All its numbers are this one.
    All(f64),
    /// Its numbers, row by row.
    Each(Vec<f64>),
}

impl Constant {
    /// Whether all its numbers are zero.
    pub(super) fn is_zero(&self) -> bool {
        match self {
            Self::All(x) => *x == 0.0,
            Self::Each(numbers) => numbers.iter().all(|x| *x == 0.0),
        }
    }

    /// Its number `k`.
    pub fn at(&self, k: usize) -> f64 {
        match self {
            Self::All(x) => *x,
            Self::Each(numbers) => numbers[k],
        }
    }

    /// Checks it for a function of a robot: as many numbers as the argument has, and unit
    /// quaternions. A quaternion of zeros means no rotation, except where the function updates or
    /// compares it. Errors: a text.
    pub(super) fn fits(&self, function: FunctionId, argument: Argument, model: &Model<f64>) -> Result<(), String> {
        let (name, expected) = (argument.name(), argument.len(model.shape()));
        let numbers = self.numbers(expected);
        if numbers.len() != expected {
            return Err(format!("constant {name}: found {} numbers, expected {expected}", numbers.len()));
        }
        let configuration = argument.is_configuration();
        let zeros = !matches!(function, FunctionId::integrate | FunctionId::difference | FunctionId::difference_derivatives);
        let or = if zeros { ", or 0, which does not turn" } else { "" };
        let told =
            |(joint, norm)| format!("constant {name}: joint {joint:?}: found a quaternion of norm {norm}, expected 1 within {NORM:e}{or}");
        let wrong = model.joints().iter().filter(|_| configuration).find_map(|joint| not_unit(joint, &numbers, zeros));
        wrong.map_or(Ok(()), |found| Err(told(found)))
    }

    /// The numbers of an argument of length `count`.
    fn numbers(&self, count: usize) -> Cow<'_, [f64]> {
        match self {
            Self::All(x) => vec![*x; count].into(),
            Self::Each(numbers) => numbers.into(),
        }
    }
}

/// How far the norm of a constant quaternion may be from 1: results are off by twice that.
const NORM: f64 = 1e-9;

/// The joint and the norm of its quaternion, if that is not a rotation; `zeros`: whether zeros are
/// allowed and mean no rotation.
fn not_unit<'a>(joint: &'a JointInfo, q: &[f64], zeros: bool) -> Option<(&'a str, f64)> {
    let quaternion = &q[joint.quaternion()?];
    let norm = quaternion.iter().map(|x| x * x).sum::<f64>().sqrt();
    (!(zeros && norm == 0.0) && (norm - 1.0).abs() > NORM).then_some((joint.name.as_str(), norm))
}

/// `q = 0` or `q = [0, 0]`
pub(super) fn constant(
    text: &str,
    function: &Function<Sym>,
    wrong: &dyn Fn(String) -> Diagnostic,
) -> Result<(Argument, Constant), Diagnostic> {
    let takes: Vec<&str> = function.takes.iter().map(|a| a.name()).collect();
    let expected = || {
        let (found, name, first) = (text.trim(), function.name, takes[0]);
        let sines = if function.takes.contains(&Argument::Q) { ", or its sines and cosines, q = sin_cos" } else { "" };
        format!(
            "`{found}`: expected a constant as in {name}({first} = 0) or {name}({first} = [0, 0]){sines}; {name} takes {}",
            takes.join(", ")
        )
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

/// A finite number; its sign may be separate, as in the text of the macro's tokens.
fn number(text: &str) -> Option<f64> {
    let text = text.trim();
    let (sign, digits) = text.split_at(text.len() - text.strip_prefix(['-', '+']).unwrap_or(text).len());
    format!("{sign}{}", digits.trim_start()).parse().ok().filter(|x: &f64| x.is_finite())
}

/// The entries of a list without the last if that is empty: there may be a comma behind each.
pub(super) fn entries(mut pieces: Vec<&str>) -> Vec<&str> {
    pieces.pop_if(|last| last.trim().is_empty());
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::FunctionSpec;

    #[test]
    fn a_sign_may_stand_apart_and_a_comma_last() {
        let constant =
            |text: &str| FunctionSpec::parse(&format!("x = inverse_dynamics({text})")).unwrap().parts[0].constant(Argument::A).cloned();
        assert_eq!(["a = - 1.5", "a=+ 2e-3 ,", "a = -\n1"].map(constant), [-1.5, 2e-3, -1.0].map(|x| Some(Constant::All(x))));
        let list = [("a = [ - 1 , + 2.5,\n- 3e1, ],", vec![-1.0, 2.5, -30.0]), ("a = []", Vec::new()), ("", Vec::new())];
        list.into_iter().for_each(|(text, numbers)| assert_eq!(constant(text), (!text.is_empty()).then_some(Constant::Each(numbers))));
    }

    #[test]
    fn numbers_are_not_put_together_and_entries_not_left_out() {
        let numbers = ["1 2", "- - 1", "-+1", "1 e3", "1. 5", "-", "[0 1, 3]", "[,0,,0,]", "[0,,1]", "[,]", "[0,,]", "[0, - ]", ""];
        for number in numbers {
            let told = FunctionSpec::parse(&format!("x = inverse_dynamics(v = {number}, a = 0)")).err().map(|e| e.to_string());
            let told = told.unwrap_or_else(|| panic!("{number}"));
            assert!(told.contains(&format!("`{}`: expected a constant as in", format!("v = {number}").trim())), "{told}");
        }
        for arguments in [",", ", v = 0", "v = 0,, a = 0", "v = 0,,"] {
            let told = FunctionSpec::parse(&format!("x = inverse_dynamics({arguments})")).err().map(|e| e.to_string());
            assert!(told.is_some_and(|told| told.contains("``: expected a constant as in")), "{arguments}");
        }
    }

    #[test]
    fn a_constant_has_as_many_numbers_as_the_argument() {
        let wanted = FunctionSpec::parse("slow = inverse_dynamics(v = 0, a = [0, 1])").unwrap();
        let right = |joints: usize| wanted.check(&chain(&vec!["continuous"; joints])).is_ok();
        assert_eq!([1, 2, 3].map(right), [false, true, false]);
    }

    /// A quaternion of another norm is not a rotation; zeros mean no rotation.
    #[test]
    fn a_constant_configuration_has_quaternions_that_turn() {
        let told = |q: &str| FunctionSpec::parse(&format!("x = placements(q = {q})")).unwrap().check(&chain(&["continuous", "spherical"]));
        for q in ["0", "[1, 0, 0, 0, 1]", "[2, 0.6, 0, 0, -0.8]", "[7, 0, 0, 0, 0]"] {
            assert!(told(q).is_ok(), "{q}");
        }
        let text = told("1").unwrap_err().to_string();
        assert!(text.contains("constant q: joint \"j1\": found a quaternion of norm 2, expected 1 within 1e-9"), "{text}");
        let norms = ["0.999", "1.00000001", "0.99999999", "1.0000000001", "0.9999999999"];
        assert_eq!(norms.map(|w| told(&format!("[0, 0, 0, 0, {w}]")).is_ok()), [false, false, false, true, true]);
        // Functions that update or compare a configuration need a unit quaternion.
        for text in [
            "x = integrate(q = 0)",
            "x = difference(q = 0)",
            "x = difference(target = [0, 0, 0, 0, 0])",
            "x = inverse_dynamics(q = 0, a = 0) + integrate(q = 0)",
        ] {
            let told = FunctionSpec::parse(text).unwrap().check(&chain(&["continuous", "spherical"])).unwrap_err().to_string();
            assert!(told.ends_with("joint \"j1\": found a quaternion of norm 0, expected 1 within 1e-9"), "{told}");
        }
        let rates = FunctionSpec::parse("x = inverse_dynamics(v = 1, a = 0)").unwrap();
        assert!(rates.check(&chain(&["spherical"])).is_ok());
    }

    /// Joints of these kinds, one on the other.
    fn chain(kinds: &[&str]) -> Model<f64> {
        let joint = |(i, kind): (usize, &&str)| {
            format!("<link name='l{}'/><joint name='j{i}' type='{kind}'><parent link='l{i}'/><child link='l{}'/></joint>", i + 1, i + 1)
        };
        let joints: String = kinds.iter().enumerate().map(joint).collect();
        let request = crate::Request::new("chain.urdf", format!("<robot name='chain'><link name='l0'/>{joints}</robot>"));
        request.build_robot().unwrap().model
    }
}
