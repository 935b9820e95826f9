//! Derivatives of a function, requested by name.
//!
//! ```text
//! g = vjp(inverse_dynamics)                    λᵀ ∂τ/∂q, λᵀ ∂τ/∂v, λᵀ ∂τ/∂a for given λ
//! g = jvp(forward_dynamics, q v)               ∂a/∂q·dq + ∂a/∂v·dv for given dq and dv
//! g = hvp(inverse_dynamics)                    ∂²(λᵀτ)·(dq, dv, da) for given λ and directions
//! g = hessian(potential_energy)                λ ∂²U/∂q² for given λ
//! g = jacobian(center_of_mass)                 ∂c/∂q
//! g = gradient(kinetic_energy, v)              ∂T/∂v, of a function with one number as its result
//! g = vjp(inverse_dynamics, q in coordinates)  with respect to the numbers of q
//! ```
//!
//! With respect to q they are derivatives in the tangent space, of f(q ⊕ δ) at δ = 0, unless the
//! request says `in coordinates`.

use std::collections::BTreeSet;
use std::sync::Mutex;

use articulated_core::algorithm::{Argument, Dim, Port};
use articulated_core::diagnostic::Diagnostic;

use super::{FunctionTerm, Output};

/// The kind of a derivative.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Derivative {
    /// λᵀ ∂f/∂x for weights λ.
    Vjp,
    /// ∂f/∂x·dx for directions dx.
    Jvp,
    /// ∂²(λᵀf)/∂x²·dx for weights and directions.
    Hvp,
    /// ∂²(λᵀf)/∂x² for weights.
    Hessian,
    /// ∂f/∂x.
    Jacobian,
    /// ∂f/∂x of a single number f.
    Gradient,
}

impl Derivative {
    /// All of them.
    pub const ALL: [Self; 6] = [Self::Vjp, Self::Jvp, Self::Hvp, Self::Hessian, Self::Jacobian, Self::Gradient];

    /// Its name in requests.
    pub fn name(self) -> &'static str {
        match self {
            Self::Vjp => "vjp",
            Self::Jvp => "jvp",
            Self::Hvp => "hvp",
            Self::Hessian => "hessian",
            Self::Jacobian => "jacobian",
            Self::Gradient => "gradient",
        }
    }

    /// Whether it takes a weight for each number of the function's result.
    fn takes_weights(self) -> bool {
        matches!(self, Self::Vjp | Self::Hvp | Self::Hessian)
    }

    /// Whether it takes a direction for each argument.
    fn takes_directions(self) -> bool {
        matches!(self, Self::Jvp | Self::Hvp)
    }

    /// Before the names of its results.
    fn prefix(self) -> &'static str {
        match self {
            Self::Vjp | Self::Gradient => "grad",
            Self::Hvp => "hvp",
            Self::Hessian => "hess",
            Self::Jacobian => "jac",
            Self::Jvp => "",
        }
    }
}

/// A requested derivative.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Transform {
    /// Its kind.
    pub kind: Derivative,
    /// The arguments that it is taken with respect to, in the order of the function's arguments.
    pub wrt: Vec<Argument>,
    /// Whether configurations are plain numbers, and not points of a manifold.
    pub in_coordinates: bool,
}

impl Transform {
    /// The dimensions of a derivative with respect to an argument.
    pub(crate) fn dims(&self, argument: Argument) -> &'static [Dim] {
        if self.in_coordinates { argument.dims() } else { argument.tangent_dims() }
    }

    /// A factor for each number of each result, in the tangent space of results that are
    /// configurations.
    pub(crate) fn weights(&self, part: &FunctionTerm) -> Vec<Argument> {
        const UNIT: &str = "a factor of each number of the result";
        match part.function.outputs {
            [] => vec![port("weights", part.function.gives, UNIT)],
            several => several.iter().map(|output| port(&format!("weights_{}", output.name), self.dims_of(output), UNIT)).collect(),
        }
    }

    fn dims_of(&self, result: &Port) -> &'static [Dim] {
        if self.in_coordinates { result.dims } else { result.tangent_dims() }
    }

    /// The results of the function, in the tangent space where they are configurations.
    pub(crate) fn results(&self, part: &FunctionTerm) -> Vec<Output> {
        let mut results = part.outputs();
        for (result, port) in results.iter_mut().zip(part.function.outputs) {
            result.dims = self.dims_of(port).to_vec();
        }
        results
    }

    /// Weights, then directions, as far as the derivative takes them.
    pub(super) fn arguments(&self, part: &FunctionTerm) -> Vec<Argument> {
        let weights = if self.kind.takes_weights() { self.weights(part) } else { Vec::new() };
        let directions = self.wrt.iter().filter(|_| self.kind.takes_directions());
        weights.into_iter().chain(directions.map(|a| port(&format!("d{}", a.name()), self.dims(*a), "a direction"))).collect()
    }

    /// The results.
    pub(super) fn outputs(&self, part: &FunctionTerm) -> Vec<Output> {
        let (name, own) = (part.function.name, self.results(part));
        if self.kind == Derivative::Jvp {
            let along = |output: Output| Output { unit: format!("{}, per unit of the direction", output.unit), ..output };
            return own.into_iter().map(along).collect();
        }
        if self.kind == Derivative::Jacobian {
            let of = |output: &Output, argument: &Argument| {
                let result = if own.len() == 1 { String::new() } else { format!("_{}", output.name) };
                let dims = [output.dims.as_slice(), self.dims(*argument)].concat();
                let space = if argument.is_configuration() && !self.in_coordinates { " in the tangent space" } else { "" };
                let unit = format!("∂{}/∂{}{space}", output.name, argument.name());
                Output { name: interned(&format!("jac{result}_{}", argument.name())), dims, unit }
            };
            return own.iter().flat_map(|output| self.wrt.iter().map(move |argument| of(output, argument))).collect();
        }
        if self.kind == Derivative::Hessian {
            let of = |one: &Argument, other: &Argument| {
                let dims = [self.dims(*one), self.dims(*other)].concat();
                let unit = format!("∂²(weightsᵀ {name})/∂{}∂{}", one.name(), other.name());
                Output { name: interned(&format!("hess_{}_{}", one.name(), other.name())), dims, unit }
            };
            return self.wrt.iter().flat_map(|one| self.wrt.iter().map(move |other| of(one, other))).collect();
        }
        let of = |argument: &Argument| {
            let dims = self.dims(*argument).to_vec();
            let what = match self.kind {
                Derivative::Vjp => "weightsᵀ ∂",
                Derivative::Hvp => "∂² of weightsᵀ f, times the directions, for ",
                _ => "∂",
            };
            let space = if argument.is_configuration() && !self.in_coordinates { " in the tangent space" } else { "" };
            let unit = match self.kind {
                Derivative::Hvp => format!("{what}{}{space}", argument.name()),
                _ => format!("{what}{name}/∂{}{space}", argument.name()),
            };
            Output { name: interned(&format!("{}_{}", self.kind.prefix(), argument.name())), dims, unit }
        };
        self.wrt.iter().map(of).collect()
    }

    /// What it does, in a sentence about a function.
    pub(crate) fn summary(&self, part: &FunctionTerm) -> String {
        let wrt: Vec<&str> = self.wrt.iter().map(|a| a.name()).collect();
        let what = match self.kind {
            Derivative::Vjp => "weightsᵀ times the Jacobian",
            Derivative::Jvp => "the Jacobian times a direction",
            Derivative::Hvp => "the Hessian of weightsᵀ times the result, times a direction,",
            Derivative::Hessian => "the Hessian of weightsᵀ times the result",
            Derivative::Jacobian => "the Jacobian",
            Derivative::Gradient => "the gradient",
        };
        format!("{what} of {} with respect to {}: {}", part.function.name, wrt.join(", "), part.summary())
    }
}

/// `vjp(f)`, `jvp(f(a = 0), q v)`, …: the kind, the function, and the arguments after it. `None`:
/// another text.
pub(super) fn split(text: &str) -> Option<(Derivative, &str, &str)> {
    let (name, rest) = text.trim().split_once('(')?;
    let kind = Derivative::ALL.into_iter().find(|kind| kind.name() == name.trim())?;
    let inner = rest.trim_end().strip_suffix(')')?;
    let mut pieces = super::all_outside(inner, ',').into_iter();
    let (function, first) = (pieces.next().unwrap_or_default(), pieces.next());
    // The rest is one list, with or without commas.
    let wrt = first.map_or("", |first| &inner[first.as_ptr() as usize - inner.as_ptr() as usize..]);
    Some((kind, function.trim(), wrt))
}

/// The derivative of a function with respect to the arguments in a list; all, if it is empty.
pub(super) fn parse(
    kind: Derivative,
    part: &FunctionTerm,
    list: &str,
    wrong: &dyn Fn(String) -> Diagnostic,
) -> Result<Transform, Diagnostic> {
    let function = part.function;
    let (list, in_coordinates) = match list.trim().strip_suffix("in coordinates") {
        Some(list) => (list, true),
        None => (list, false),
    };
    let takes: Vec<Argument> = function.takes.iter().copied().filter(|a| part.constant(*a).is_none()).collect();
    let names = || takes.iter().map(|a| a.name()).collect::<Vec<_>>().join(" ");
    let mut wanted = Vec::new();
    for word in list.split([' ', ',', '\n', '\t']).filter(|word| !word.is_empty()) {
        match takes.iter().find(|a| a.name() == word) {
            Some(argument) if wanted.contains(argument) => return Err(wrong(format!("`{word}` is given twice"))),
            Some(argument) => wanted.push(*argument),
            None => return Err(wrong(format!("`{word}`: expected some of {}", names()))),
        }
    }
    if takes.is_empty() {
        return Err(wrong(format!("{} takes no arguments to differentiate by", function.name)));
    }
    if kind == Derivative::Gradient && !matches!(part.outputs().as_slice(), [output] if output.dims.is_empty()) {
        return Err(wrong(format!("{} has several numbers as its result: expected vjp, or jacobian", function.name)));
    }
    let wrt = takes.into_iter().filter(|a| wanted.is_empty() || wanted.contains(a)).collect();
    Ok(Transform { kind, wrt, in_coordinates })
}

/// An argument of this name. It lives as long as the program, and once for all functions.
fn port(name: &str, dims: &'static [Dim], unit: &'static str) -> Argument {
    static PORTS: Mutex<Vec<&'static Port>> = Mutex::new(Vec::new());
    let port = Port::new(interned(name), dims, unit);
    let mut known = PORTS.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let found = known.iter().find(|other| ***other == port).copied();
    Argument::new(found.unwrap_or_else(|| {
        known.push(Box::leak(Box::new(port)));
        known[known.len() - 1]
    }))
}

/// A name that lives as long as the program.
fn interned(name: &str) -> &'static str {
    static NAMES: Mutex<BTreeSet<&'static str>> = Mutex::new(BTreeSet::new());
    let mut known = NAMES.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    if let Some(found) = known.get(name) {
        return found;
    }
    let own: &'static str = Box::leak(name.to_owned().into_boxed_str());
    known.insert(own);
    own
}
