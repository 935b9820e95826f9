//! Residuals: the torques that a result of the mass matrix needs, less those that were applied.

use articulated_core::Scalar;
use articulated_core::algorithm::{Argument, Function, FunctionId, Workspace};
use articulated_core::model::Model;
use articulated_reference::{Big, Exact, ROUNDOFF, scales};

use crate::states::quaternions;

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

pub(crate) fn residual(reference: &Exact, model: &Model<f64>, inverse: &str, state: &[&[f64]], found: &[f64]) -> Option<Residual> {
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

/// The function for the torques that a function's result needs, if it is judged by them.
pub(crate) fn inverse_of(function: &Function<f64>) -> Option<&'static str> {
    let inverse = FunctionId::inverse_dynamics_with_wrenches.row::<f64>();
    let solves = function.general == FunctionId::forward_dynamics_with_wrenches;
    solves.then(|| inverse.at_zero(|argument| argument == Argument::Wrenches && !function.takes.contains(&argument)).name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_a_number_stays() {
        assert_eq!((worse(1.0, 2.0), worse(2.0, 1.0)), (2.0, 2.0));
        assert!(worse(f64::NAN, 1.0).is_nan() && worse(1.0, f64::NAN).is_nan());
        assert!([0.0, f64::NAN, f64::INFINITY].into_iter().fold(0.0, worse).is_nan());
    }
}
