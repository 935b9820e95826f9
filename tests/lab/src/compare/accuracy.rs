//! Errors against a reference of 96 digits: the textbook's form, which shares no formula with the
//! judged code; for a robot with effects, which that does not include, the generic library.
//!
//! A result is compared with the textbook form's. The accelerations of forward dynamics are judged
//! by their backward error instead: the difference between the torques that they need and the given
//! ones.

use articulated_codegen::Options;
use articulated_core::Scalar;
use articulated_core::algorithm::{Argument, Function, FunctionId, Workspace};
use articulated_core::description::Description;
use articulated_core::model::Model;
use articulated_reference::{Big, Exact, ROUNDOFF, scales, scales_of_generated, where_suspect};
use serde::Serialize;

use super::contender::Contender;
use crate::robot::{Robot, note_of_parameters};
use crate::states::quaternions;

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

/// The function for the torques that a function's result needs, if it is judged by them.
pub(crate) fn inverse_of(function: &Function<f64>) -> Option<&'static str> {
    let inverse = FunctionId::inverse_dynamics_with_wrenches.row::<f64>();
    let solves = function.general == FunctionId::forward_dynamics_with_wrenches;
    solves.then(|| inverse.at_zero(|argument| argument == Argument::Wrenches && !function.takes.contains(&argument)).name)
}

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

/// The torques that a result needs, less those that were applied.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residual {
    /// The largest, N·m or N.
    pub torque: f64,
    /// The largest over the sum of the magnitudes of its terms, in units of 2⁻⁵³.
    pub units: f64,
}

impl Residual {
    /// Whether it is the larger one in units; NaN is the largest.
    #[must_use]
    pub fn is_larger(&self, other: &Self) -> bool {
        worse(self.units, other.units).to_bits() == self.units.to_bits()
    }

    fn of(exact: &[Big], found: &[f64], scale: &[f64]) -> Self {
        let torque = exact.iter().zip(found).map(|(e, f)| e.error_of(*f, 1.0)).fold(0.0, worse);
        Self { torque, units: largest(exact, found, scale) }
    }
}

/// The residual of a solution with the mass matrix, against the generic library in 320 bits; `None`
/// for another function.
#[must_use]
pub fn residual_of(model: &Model<f64>, function: &Function<f64>, state: &[&[f64]], found: &[f64]) -> Option<Residual> {
    let inverse = inverse_of(function);
    if inverse.is_none() && function.id != FunctionId::solve_mass_matrix {
        return None;
    }
    Big::scope(|| {
        let exact = Exact::library(model);
        match inverse {
            Some(inverse) => residual(&exact, model, inverse, state, found),
            None => residual_of_product(&exact, model, state, found),
        }
    })
}

/// M x − r for the state (q, r) and the solution x.
fn residual_of_product(reference: &Exact, model: &Model<f64>, state: &[&[f64]], found: &[f64]) -> Option<Residual> {
    let [q, applied] = *state else { return None };
    let (name, n) = (FunctionId::mass_matrix.name(), found.len());
    let (mass, terms) = (exact(reference, model, name, &[q])?, scales(model, name, &[q]).ok()?);
    let row = |i: usize| mass[i * n..][..n].iter().zip(found).fold(Big::from_f64(0.0), |sum, (m, x)| sum + *m * Big::from_f64(*x));
    let needed: Vec<Big> = (0..n).map(row).collect();
    let size = |i: usize| terms[i * n..][..n].iter().zip(found).map(|(m, x)| m * x.abs()).sum::<f64>() + applied[i].abs();
    Some(Residual::of(&needed, applied, &(0..n).map(size).collect::<Vec<_>>()))
}

fn residual(reference: &Exact, model: &Model<f64>, inverse: &str, state: &[&[f64]], found: &[f64]) -> Option<Residual> {
    let asked = [*state.get(1)?, *state.get(2)?];
    if found.iter().any(|x| !x.is_finite()) {
        return Some(Residual { torque: f64::NAN, units: f64::NAN });
    }
    let mut state = state.to_vec();
    state[2] = found;
    let motors = FunctionId::motor_torques;
    let (mut tau, terms) = (vec![0.0; model.nv()], scales(model, motors.name(), &asked).ok()?);
    motors.row().call(model, &mut Workspace::new(model), &asked, &mut tau).ok()?;
    let scale: Vec<f64> = scales(model, inverse, &state).ok()?.iter().zip(terms).map(|(s, t)| s + t).collect();
    Some(Residual::of(&exact(reference, model, inverse, &state)?, &tau, &scale))
}

/// The result of the reference. A double's quaternion has a norm of one to 16 digits only; it is
/// normalised here, so that the rest does not count as an error.
pub(crate) fn exact(reference: &Exact, model: &Model<f64>, function: &str, state: &[&[f64]]) -> Option<Vec<Big>> {
    let row = articulated_core::algorithm::function::<f64>(function)?;
    let precise = |(argument, x): (&Argument, &&[f64])| {
        let mut x: Vec<Big> = x.iter().map(|x| Big::from_f64(*x)).collect();
        if argument.is_configuration() {
            quaternions(model).for_each(|(_, at)| normalise(&mut x[at..at + 4]));
        }
        x
    };
    let arguments: Vec<Vec<Big>> = row.takes.iter().zip(state).map(precise).collect();
    let arguments: Vec<&[Big]> = arguments.iter().map(Vec::as_slice).collect();
    reference.call(row.id, &arguments)
}

fn normalise(quaternion: &mut [Big]) {
    let norm = quaternion.iter().fold(Big::from_f64(0.0), |sum, x| sum + *x * *x).sqrt();
    quaternion.iter_mut().for_each(|x| *x = *x / norm);
}

pub(crate) fn largest(exact: &[Big], found: &[f64], scale: &[f64]) -> f64 {
    let errors = exact.iter().zip(found).zip(scale).map(|((e, f), s)| e.error_of(*f, ROUNDOFF * s));
    errors.fold(0.0, worse)
}

/// The larger of two errors; NaN if one is.
pub fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || a >= b { a } else { b }
}

#[cfg(test)]
mod tests {
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

    #[test]
    fn what_is_not_a_number_stays() {
        assert_eq!((worse(1.0, 2.0), worse(2.0, 1.0)), (2.0, 2.0));
        assert!(worse(f64::NAN, 1.0).is_nan() && worse(1.0, f64::NAN).is_nan());
        assert!([0.0, f64::NAN, f64::INFINITY].into_iter().fold(0.0, worse).is_nan());
    }
}
