//! The scale of each number that a function gives.

use articulated_core::Scalar;
use articulated_core::algorithm::{FunctionError, Workspace, function};
use articulated_core::model::Model;
use num_traits::Zero;

use super::{Magnitude, solution};

/// The scale of each number that a function gives: the algorithm of the table, run with [`Magnitude`] on `model`, which has
/// to be as it was read, before model passes.
///
/// A function that solves with the mass matrix is measured by what rounding does to a backward stable solution instead: divisions would let the sum of
/// magnitudes grow without bound, and everything would pass.
pub fn scales(model: &Model<f64>, name: &str, arguments: &[&[f64]]) -> Result<Vec<f64>, FunctionError> {
    let row = function::<f64>(name).ok_or(UNKNOWN)?;
    if row.inverts_mass_matrix() {
        return solution::scales(model, row, arguments);
    }
    Ok(magnitudes(model, name, &given(arguments))?.into_iter().map(|x| x.magnitude).collect())
}

pub(super) const UNKNOWN: FunctionError = FunctionError::NotGenerated { function: "of this name" };

/// Numbers without error.
pub(super) fn given(arguments: &[&[f64]]) -> Vec<Vec<Magnitude>> {
    arguments.iter().map(|x| x.iter().map(|x| Magnitude::from_f64(*x)).collect()).collect()
}

/// What a function gives with these arguments; the least magnitude, where there are several ways to compute it: one that turns everything into common axes adds
/// up terms that no other has.
pub(super) fn magnitudes(model: &Model<f64>, name: &str, arguments: &[Vec<Magnitude>]) -> Result<Vec<Magnitude>, FunctionError> {
    let row = function::<Magnitude>(name).ok_or(UNKNOWN)?;
    let model: Model<Magnitude> = model.cast();
    let arguments: Vec<&[Magnitude]> = arguments.iter().map(Vec::as_slice).collect();
    let mut least: Option<Vec<Magnitude>> = None;
    for way in row.ways.iter().filter(|w| (w.applies)(&model)) {
        let mut out = vec![Magnitude::zero(); row.len(model.shape())];
        row.call_by(way, &model, &mut Workspace::new(&model), &arguments, &mut out)?;
        let smaller = |(a, b): (&Magnitude, &Magnitude)| if a.magnitude <= b.magnitude { *a } else { *b };
        least = Some(least.map_or_else(|| out.clone(), |least| least.iter().zip(&out).map(smaller).collect()));
    }
    least.ok_or(UNKNOWN)
}
