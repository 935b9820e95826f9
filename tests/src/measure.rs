//! Yardsticks for rounding errors.

use articulated_cli::precise::Big;
use articulated_core::Scalar;
use articulated_core::algorithm::{Argument, ResultKind, function};

use crate::case::{Case, State};

/// Unit roundoff of double precision.
pub const U: f64 = f64::EPSILON / 2.0;

/// What an error of each result of a function is measured against: see [`crate::virtual_power::Motions::torque_scale`] and
/// [`crate::virtual_power::Motions::placement_scale`].
pub fn scale(case: &Case, name: &str, state: &State) -> Vec<f64> {
    let row = function::<f64>(name).expect("a function of the registry");
    let zero = vec![0.0; case.model.nv];
    let or_rest = |argument: Argument, given| if row.takes.contains(&argument) { given } else { &zero[..] };
    match row.gives {
        ResultKind::Placements => case.motions().placement_scale(&state.q),
        ResultKind::Torque => case.motions().torque_scale(&state.q, or_rest(Argument::V, &state.v), or_rest(Argument::A, &state.a)),
    }
}

/// As [`scale`], for τ = M(q)·a + h(q, v).
pub fn torque_scale(case: &Case, state: &State) -> Vec<f64> {
    scale(case, "inverse_dynamics", state)
}

/// The arguments of a function of the registry in a state.
pub fn arguments<'a>(name: &str, state: &'a State) -> Vec<&'a [f64]> {
    let row = function::<f64>(name).expect("a function of the registry");
    row.takes.iter().map(|a| state.argument(a, &state.a)).collect()
}

/// Largest |found − expected| in units of u times the scale. NaN counts as infinite, and so does any difference where the scale is 0.
pub fn distance(found: &[f64], expected: &[f64], scale: &[f64]) -> f64 {
    assert!(found.len() == expected.len() && found.len() == scale.len(), "as many numbers");
    let one = |((f, e), s): ((&f64, &f64), &f64)| {
        let error = (f - e).abs();
        if error == 0.0 { 0.0 } else { error / (U * s) }
    };
    found.iter().zip(expected).zip(scale).map(one).fold(0.0, |worst, d| if d <= worst { worst } else { worst_of(d) })
}

/// As [`distance`], from a reference of many digits.
pub fn distance_from(found: &[f64], expected: &[Big], scale: &[f64]) -> f64 {
    assert!(found.len() == expected.len() && found.len() == scale.len(), "as many numbers");
    let one = |((e, &f), &s): ((&Big, &f64), &f64)| {
        let error = (Big::from_f64(f) - *e).to_f64().abs();
        // The reference has rounding errors of its own, far below.
        if error < 1e-60 { 0.0 } else { error / (U * s) }
    };
    let errors = expected.iter().zip(found).zip(scale).map(one);
    errors.fold(0.0, |worst, d| if d <= worst { worst } else { worst_of(d) })
}

fn worst_of(d: f64) -> f64 {
    if d.is_nan() { f64::INFINITY } else { d }
}

/// Sum of the magnitudes, entry by entry.
pub fn plus(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(x, y)| x + y).collect()
}
