//! Errors against a reference of 96 digits: the textbook's form, which shares no formula with the
//! judged code; for a robot with effects, which that does not include, the generic library.
//!
//! A result is compared with the textbook form's. The accelerations of forward dynamics are judged
//! by their backward error instead: the difference between the torques that they need and the given
//! ones.

use articulated_codegen::Options;
use articulated_core::algorithm::Function;
use articulated_core::description::Description;
use articulated_core::model::Model;
use articulated_reference::{Big, Exact, ROUNDOFF, scales, scales_of_generated, where_suspect};
use serde::Serialize;

use super::contender::Contender;
use crate::residual::{exact, inverse_of, largest, residual, worse};
use crate::robot::{Robot, note_of_parameters};

/// The largest error of each, in units of 2⁻⁵³ of the sum of the magnitudes of the terms.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct Errors {
    /// `forward`: of the result; `backward`: of the torques that the result needs.
    pub(super) kind: &'static str,
    /// On how many states; those in which the function is singular are not counted.
    pub(super) states: usize,
    pub(super) generated: f64,
    pub(super) generic: f64,
}

/// Which reference a robot has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Against {
    /// The textbook's form, on the numbers of the robot's file.
    Textbook,
    /// The generic library, on the numbers of the model: the textbook's form includes no effects.
    Library,
}

impl Against {
    pub(crate) fn of(robot: &Robot) -> Self {
        if !robot.has_effects() { Self::Textbook } else { Self::Library }
    }
}

/// A robot as the reference takes it.
#[derive(Clone, Debug)]
pub(crate) struct Reference {
    description: Description,
    options: Options,
    against: Against,
}

impl Reference {
    pub(crate) fn new(description: &Description, robot: &Robot) -> Self {
        Self { description: description.clone(), options: robot.options.clone(), against: Against::of(robot) }
    }

    /// The reference of the robot's results.
    pub(crate) fn against(&self) -> Against {
        self.against
    }

    /// Notes for reports: if the reference is not the textbook, and which parts of the scene it
    /// does not use.
    pub(crate) fn note(&self) -> Vec<String> {
        let note = "the textbook's form knows no effects: the reference is the generic library in 320 bits, which tells roundings, not whether its formulas are right";
        let effects = (self.against() == Against::Library).then(|| note.into());
        effects.into_iter().chain(note_of_parameters(&self.options)).collect()
    }

    /// With the frames and effects of the model.
    pub(crate) fn exact(&self, model: &Model<f64>) -> Option<Exact> {
        if self.against() == Against::Library {
            return Some(Exact::library(model));
        }
        Exact::textbook(&self.description, self.options.robot.base, model.gravity().into()).ok()?.with_frames_of(model)
    }
}

/// Maximum number of states whose errors are computed: a derivative in 96 digits is slow.
const JUDGED: usize = 16;

/// The largest errors over some of the states; `None` if the reference does not have the function.
pub(super) fn errors(
    reference: &Reference,
    model: &Model<f64>,
    function: &'static Function<f64>,
    states: &[Vec<&[f64]>],
    generated: &Contender<'_>,
) -> Option<Errors> {
    let generic = Contender::generic(model, function);
    let inverse = inverse_of(function);
    Big::scope(|| {
        let reference = reference.exact(model)?;
        let kind = if inverse.is_some() { "backward" } else { "forward" };
        let mut worst = Errors { kind, states: 0, generated: 0.0, generic: 0.0 };
        for state in states.iter().take(JUDGED) {
            let sides = [generated.call(state), generic.call(state)];
            let judged = Big::scope(|| {
                let exact = exact(&reference, model, function.name, state)?;
                if singular(&exact) {
                    return Some(None);
                }
                let errors = match inverse {
                    Some(inverse) => both(sides.each_ref().map(|found| backward(&reference, model, inverse, state, found))),
                    None => forward(&exact, model, function.name, state, &sides),
                };
                errors.map(Some)
            })?;
            if let Some([a, b]) = judged {
                let states = worst.states + 1;
                worst = Errors { states, generated: worse(worst.generated, a), generic: worse(worst.generic, b), ..worst };
            }
        }
        Some(worst)
    })
}

/// Whether the reference divided by zero, or by a remainder of its 96 digits: no result is valid
/// there.
pub(crate) fn singular(exact: &[Big]) -> bool {
    exact.iter().map(|x| x.to_f64()).any(|x| x.is_nan() || x.abs() >= 1e40)
}

/// Larger errors are checked again: see [`scales_of_generated`].
const SUSPECT: f64 = 16.0;

/// |found − exact| over the scale of the result, of each that was found.
fn forward(exact: &[Big], model: &Model<f64>, name: &str, state: &[&[f64]], found: &[Vec<f64>; 2]) -> Option<[f64; 2]> {
    let own = above_residues(scales(model, name, state).ok()?);
    let [generated, generic] = found.each_ref().map(|found| largest(exact, found, &own));
    if generated <= SUSPECT {
        return Some([generated, generic]);
    }
    let moved = above_residues(scales_of_generated(model, name, state).ok()?);
    let is_suspect = |k: usize, own: f64| exact[k].error_of(found[0][k], ROUNDOFF * own) > SUSPECT;
    Some([largest(exact, &found[0], &where_suspect(&own, &moved, is_suspect)), generic])
}

/// Upper bound for remainders of zeros due to rounding in the reference's 96 digits, relative to
/// the scale of a result.
const RESIDUE: f64 = 1e-60;

/// Scales, at least as large as the reference's remainders of results that are exactly zero in the
/// model. If all are zero, there is no scale: that of numbers near one is used, and any number
/// above its remainders is wrong.
pub(crate) fn above_residues(mut scale: Vec<f64>) -> Vec<f64> {
    let largest = scale.iter().copied().fold(0.0, f64::max);
    let floor = RESIDUE * if largest == 0.0 { 1.0 } else { largest };
    scale.iter_mut().for_each(|s| *s = s.max(floor));
    scale
}

/// Both, if there are both.
fn both([a, b]: [Option<f64>; 2]) -> Option<[f64; 2]> {
    Some([a?, b?])
}

/// η = maxᵢ |ID_exact(q, v, a) − τ|ᵢ / (scale of ID + that of τ)ᵢ, in units of 2⁻⁵³, for the state
/// (q, v, τ, …) and the accelerations found; τ are the torques that the motors deliver for those of
/// the state.
pub(crate) fn backward(reference: &Exact, model: &Model<f64>, inverse: &str, state: &[&[f64]], found: &[f64]) -> Option<f64> {
    residual(reference, model, inverse, state, found).map(|residual| residual.units)
}

#[cfg(test)]
mod tests {
    use articulated_core::Scalar;

    use super::*;

    #[test]
    fn what_is_divided_by_nothing_is_singular() {
        let [one, zero] = [1.0, 0.0].map(Big::from_f64);
        assert!(singular(&[one, one / zero]) && singular(&[zero / zero]) && singular(&[one / Big::from_f64(1e-90)]));
        assert!(!singular(&[one, zero, Big::from_f64(-1e20)]));
    }

    #[test]
    fn zeros_are_right_where_all_of_a_result_is_zero_and_nothing_else_is() {
        let scale = above_residues(vec![0.0, 0.0]);
        let exact = [Big::from_f64(3e-93), Big::from_f64(0.0)];
        assert!(largest(&exact, &[0.0, 0.0], &scale) < 1e-9);
        assert!(largest(&exact, &[0.0, 1e-30], &scale) > 1e9);
        assert_eq!(above_residues(vec![0.0, 2.0]), [2.0 * RESIDUE, 2.0]);
    }

    #[test]
    fn an_acceleration_is_judged_by_the_torques_it_needs() {
        let robot = articulated_models::robot("simple_pendulum").unwrap();
        let description = articulated_formats::read(robot.urdf.as_bytes(), &articulated_formats::Options::default()).unwrap().description;
        let model = Model::new(&description, robot.base).unwrap();
        let textbook = Exact::textbook(&description, robot.base, [0.0, 0.0, -9.81]).unwrap();
        // 1.001 kg·m² · a + 9.81 N·m · sin q = τ
        let (q, tau) = (0.5_f64, 3.0);
        let a = (tau - 9.81 * q.sin()) / 1.001;
        let error = |a: f64| backward(&textbook, &model, "inverse_dynamics", &[&[q], &[0.0], &[tau]], &[a]).unwrap();
        assert!(error(a) < 4.0, "{}", error(a));
        // 1e-10 of the accelerating torque, over the sizes of the terms and of τ.
        let scale = scales(&model, "inverse_dynamics", &[&[q], &[0.0], &[a]]).unwrap()[0];
        let expected = 1e-10 * (1.001 * a).abs() / (ROUNDOFF * (scale + tau));
        let found = error(a * (1.0 + 1e-10));
        assert!((found / expected - 1.0).abs() < 0.01, "{found} {expected}");
        assert!(error(f64::NAN).is_nan());
    }
}
