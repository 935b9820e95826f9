//! The scale of each number of a function's result.

use articulated_core::Scalar;
use articulated_core::algorithm::{FunctionError, Workspace, function};
use articulated_core::model::Model;
use num_traits::Zero;

use super::{Magnitude, norms, solution};

/// The scale of each number of a function's result: the algorithm of the table, run with
/// [`Magnitude`] on `model`, which must be as read, before model passes; at most the norms of its
/// terms, if these are defined.
///
/// A function that solves with the mass matrix is measured by the rounding error of a backward
/// stable solution instead: divisions would let the sum of magnitudes grow without bound, and every
/// result would pass.
pub fn scales(model: &Model<f64>, name: &str, arguments: &[&[f64]]) -> Result<Vec<f64>, FunctionError> {
    let row = function::<f64>(name).ok_or(UNKNOWN)?;
    if row.inverts_mass_matrix() {
        return solution::scales(model, row, arguments);
    }
    let mut scales: Vec<f64> = magnitudes(model, name, &exact_magnitudes(arguments))?.into_iter().map(|x| x.magnitude).collect();
    scales.iter_mut().zip(norms(row.id, model, arguments)).for_each(|(scale, norm)| *scale = scale.min(norm));
    Ok(scales)
}

/// Tolerance of generated code where [`scales`] is too strict: model passes turn and move frames,
/// so that one term becomes a sum of several, and a zero of the file in a moment m·c, an offset or
/// a rotation becomes the rounding error of its neighbours. At most the largest scale of all
/// numbers of the result.
pub fn scales_of_generated(model: &Model<f64>, name: &str, arguments: &[&[f64]]) -> Result<Vec<f64>, FunctionError> {
    let own = scales(model, name, arguments)?;
    if function::<f64>(name).is_some_and(|row| row.inverts_mass_matrix()) {
        return Ok(own);
    }
    let moved = evaluated(&turned(constants(model)), name, &exact_magnitudes(arguments))?;
    let largest = own.iter().copied().fold(0.0, f64::max);
    let mut scales: Vec<f64> = own.into_iter().zip(moved).map(|(own, moved)| own.max(moved.magnitude.min(largest))).collect();
    if name.starts_with("inverse_dynamics_derivatives") {
        scales.chunks_mut(model.nv() * model.nv()).for_each(|matrix| rests(matrix, model.nv()));
    }
    Ok(scales)
}

/// The scales of a result: those of generated code for numbers that are suspect by their own
/// scales, the own scales for the others.
pub fn where_suspect(own: &[f64], moved: &[f64], is_suspect: impl Fn(usize, f64) -> bool) -> Vec<f64> {
    own.iter().zip(moved).enumerate().map(|(k, (own, moved))| if is_suspect(k, *own) { *moved } else { *own }).collect()
}

/// A number that is zero in the joint's own axes (the force along a slide that moves with its own
/// rate, at a right angle to it) is a rounding error of its neighbours in other axes. Its scale is
/// at least the largest number of its row or of its column, whichever is less.
fn rests(matrix: &mut [f64], n: usize) {
    let largest = |numbers: &mut dyn Iterator<Item = f64>| numbers.fold(0.0, f64::max);
    let rows: Vec<f64> = matrix.chunks(n).map(|row| largest(&mut row.iter().copied())).collect();
    let columns: Vec<f64> = (0..n).map(|j| largest(&mut matrix.iter().skip(j).step_by(n).copied())).collect();
    for (k, scale) in matrix.iter_mut().enumerate() {
        *scale = scale.max(rows[k / n].min(columns[k % n]));
    }
}

pub(super) const UNKNOWN: FunctionError = FunctionError::NotGenerated { function: "of this name" };

/// Numbers without error.
pub(super) fn exact_magnitudes(arguments: &[&[f64]]) -> Vec<Vec<Magnitude>> {
    arguments.iter().map(|x| x.iter().map(|x| Magnitude::from_f64(*x)).collect()).collect()
}

/// The result of a function with these arguments, in its first form, which
/// [`articulated_core::algorithm::Function::call`] uses: in other forms some cancelling terms are
/// zero, but that does not justify a stricter scale.
pub(super) fn magnitudes(model: &Model<f64>, name: &str, arguments: &[Vec<Magnitude>]) -> Result<Vec<Magnitude>, FunctionError> {
    evaluated(&constants(model), name, arguments)
}

fn evaluated(model: &Model<Magnitude>, name: &str, arguments: &[Vec<Magnitude>]) -> Result<Vec<Magnitude>, FunctionError> {
    let row = function::<Magnitude>(name).ok_or(UNKNOWN)?;
    let arguments: Vec<&[Magnitude]> = arguments.iter().map(Vec::as_slice).collect();
    let mut out = vec![Magnitude::zero(); row.len(model.shape())];
    row.call(model, &mut Workspace::new(model), &arguments, &mut out)?;
    Ok(out)
}

/// The model's constants. Each was computed from numbers of the file, so a small number may be the
/// difference of larger terms: its error is that of its neighbours. Zeros are exact, except in a
/// rotation about none of the axes: there a zero may be a difference too.
fn constants(model: &Model<f64>) -> Model<Magnitude> {
    model.cast::<Magnitude>().changed(|parts| {
        for body in &mut parts.bodies {
            neighbours(body.inertia.first.as_mut_slice(), false);
            neighbours(body.inertia.second.as_mut_slice(), false);
        }
        let frames = parts.frames.iter_mut().map(|f| &mut f.placement);
        for placement in parts.bodies.iter_mut().map(|b| &mut b.placement).chain(frames) {
            let about_an_axis = placement.rotation.iter().any(|x| x.value.abs() == 1.0);
            neighbours(placement.rotation.as_mut_slice(), !about_an_axis);
            neighbours(placement.position.as_mut_slice(), false);
        }
    })
}

/// Constants of frames that may have been turned and moved: every number of a body may be a
/// difference of its neighbours.
fn turned(model: Model<Magnitude>) -> Model<Magnitude> {
    model.changed(|parts| {
        for body in &mut parts.bodies {
            neighbours(body.inertia.first.as_mut_slice(), true);
            neighbours(body.inertia.second.as_mut_slice(), true);
            neighbours(body.placement.position.as_mut_slice(), true);
            neighbours(body.placement.rotation.as_mut_slice(), true);
        }
    })
}

fn neighbours(numbers: &mut [Magnitude], all: bool) {
    let largest = numbers.iter().map(|x| x.magnitude).fold(0.0, f64::max);
    for x in numbers.iter_mut().filter(|x| all || x.value != 0.0 && x.value.abs() != 1.0) {
        x.magnitude = largest;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_suspect_keeps_its_own_scale() {
        assert_eq!(where_suspect(&[1.0, 2.0, 0.0], &[5.0, 6.0, 7.0], |k, own| k == 1 || own == 0.0), [1.0, 6.0, 7.0]);
    }

    #[test]
    fn a_rest_is_measured_by_the_lesser_of_its_row_and_its_column() {
        let mut matrix = [4.0, 0.0, 1.0, 3.0, 0.0, 2.0, 0.0, 0.0, 8.0];
        rests(&mut matrix, 3);
        assert_eq!(matrix, [4.0, 0.0, 4.0, 3.0, 0.0, 3.0, 4.0, 0.0, 8.0]);
    }
}
