//! Errors against a reference of 96 digits that shares no formula with what it judges.

use articulated_codegen::Options;
use articulated_core::Scalar;
use articulated_core::algorithm::Function;
use articulated_core::algorithm::textbook::Textbook;
use articulated_core::description::Description;
use articulated_core::model::Model;
use serde::Serialize;

use super::contender::Contender;
use crate::magnitude::{ROUNDOFF, scales};
use crate::precise::Big;

/// The largest error of each, in units of 2⁻⁵³ of the sum of the magnitudes of the terms.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct Errors {
    pub(super) generated: f64,
    pub(super) generic: f64,
}

/// The textbook form of a robot, to be evaluated with [`Big`] numbers.
#[derive(Clone, Debug)]
pub(super) struct Reference {
    description: Description,
    options: Options,
}

impl Reference {
    pub(super) fn new(description: &Description, options: &Options) -> Self {
        Self { description: description.clone(), options: options.clone() }
    }
}

/// `None` where the textbook form does not have the function.
pub(super) fn errors(
    reference: &Reference,
    model: &Model<f64>,
    function: &'static Function<f64>,
    states: &[Vec<&[f64]>],
    generated: &Contender<'_>,
) -> Option<Errors> {
    let generic = Contender::generic(model, function);
    Big::scope(|| {
        let textbook = Textbook::<Big>::new(&reference.description, reference.options.base, reference.options.gravity).ok()?;
        let mut worst = Errors { generated: 0.0, generic: 0.0 };
        for state in states {
            let scale = scales(model, function.name, state).ok()?;
            let sides = [generated.call(state), generic.call(state)];
            let [a, b] = Big::scope(|| {
                let exact = exact(&textbook, function.name, state)?;
                Some(sides.map(|found| largest(&exact, &found, &scale)))
            })?;
            worst = Errors { generated: worse(worst.generated, a), generic: worse(worst.generic, b) };
        }
        Some(worst)
    })
}

fn exact(textbook: &Textbook<Big>, name: &str, state: &[&[f64]]) -> Option<Vec<Big>> {
    let arguments: Vec<Vec<Big>> = state.iter().map(|x| x.iter().map(|x| Big::from_f64(*x)).collect()).collect();
    let arguments: Vec<&[Big]> = arguments.iter().map(Vec::as_slice).collect();
    textbook.call(name, &arguments)?.ok()
}

fn largest(exact: &[Big], found: &[f64], scale: &[f64]) -> f64 {
    let errors = exact.iter().zip(found).zip(scale).map(|((e, f), s)| e.error_of(*f, ROUNDOFF * s));
    errors.fold(0.0, worse)
}

/// The larger, and not a number if either is not.
fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || a >= b { a } else { b }
}
