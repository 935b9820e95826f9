//! Yardsticks for rounding errors.

use articulated_core::Scalar;
use articulated_core::algorithm::function;
use articulated_reference::{Big, scales};

use crate::case::{Case, State, inverse_dynamics};
use crate::virtual_power::Motions;

/// Unit roundoff of double precision.
pub const U: f64 = f64::EPSILON / 2.0;

/// The scale of errors for each result of a function. For torques and placements
/// [`Motions::torque_scale`] and [`Motions::placement_scale`], which are independent of the library
/// (entries of the mass matrix are torques for a unit of one acceleration); for all others the sum
/// of the magnitudes of the terms, by the command's [`scales`].
pub fn scale(case: &Case, name: &str, state: &State) -> Vec<f64> {
    let zero = vec![0.0; case.model.nv()];
    let torque = |v: &[f64], a: &[f64]| case.motions().torque_scale(&state.q, v, a);
    match name {
        "placements" if case.model.frames().len() == case.description.links.len() => case.motions().placement_scale(&state.q),
        "inverse_dynamics" => torque(&state.v, &state.a),
        "bias_forces" => torque(&state.v, &zero),
        "gravity_torque" => torque(&zero, &zero),
        "mass_matrix" => matrix_scale(case, &state.q),
        _ => scales(&case.model, name, &arguments(name, state)).expect("arguments of the right lengths"),
    }
}

/// Row by row.
fn matrix_scale(case: &Case, q: &[f64]) -> Vec<f64> {
    let n = case.model.nv();
    let weightless = Motions::new(&case.description, case.base, [0.0; 3]);
    let column = |k: usize| weightless.torque_scale(q, &vec![0.0; n], &unit(n, k));
    let columns: Vec<Vec<f64>> = (0..n).map(column).collect();
    (0..n * n).map(|k| columns[k % n][k / n].max(columns[k / n][k % n])).collect()
}

/// The k-th of n.
pub fn unit(n: usize, k: usize) -> Vec<f64> {
    (0..n).map(|i| if i == k { 1.0 } else { 0.0 }).collect()
}

/// The difference between `found`, the result of a function in a state, and the generic library's,
/// in units of u times [`scale`]. For forward dynamics, the backward error: the difference between
/// the torques that they need and the given ones, in units of u times |M||a| + |h| + |τ|.
pub fn error(case: &Case, name: &str, state: &State, found: &[f64]) -> f64 {
    if name != "forward_dynamics" {
        return distance(found, &case.call(name, &arguments(name, state)), &scale(case, name, state));
    }
    let State { q, v, tau, .. } = state;
    let n = tau.len();
    let m: Vec<f64> = case.call("mass_matrix", &[q]);
    let bias = case.motions().torque_scale(q, v, &vec![0.0; n]);
    let terms = |i: usize| (0..n).map(|k| (m[i * n + k] * found[k]).abs()).sum::<f64>() + bias[i] + tau[i].abs();
    let scale: Vec<f64> = (0..n).map(terms).collect();
    distance(&inverse_dynamics(&case.model, q, v, found), tau, &scale)
}

/// As [`scale`], for τ = M(q)·a + h(q, v).
pub fn torque_scale(case: &Case, state: &State) -> Vec<f64> {
    scale(case, "inverse_dynamics", state)
}

/// The arguments of a function of the registry in a state.
pub fn arguments<'a>(name: &str, state: &'a State) -> Vec<&'a [f64]> {
    let row = function::<f64>(name).expect("a function of the registry");
    row.takes.iter().map(|a| state.argument(*a)).collect()
}

/// Largest |found − expected| in units of u times the scale. NaN counts as infinite, and so does
/// any difference where the scale is 0.
pub fn distance(found: &[f64], expected: &[f64], scale: &[f64]) -> f64 {
    assert_eq!([found.len(), scale.len()], [expected.len(); 2], "as many numbers");
    let one = |((f, e), s): ((&f64, &f64), &f64)| {
        let error = (f - e).abs();
        if error == 0.0 { 0.0 } else { error / (U * s) }
    };
    found.iter().zip(expected).zip(scale).map(one).fold(0.0, |worst, d| if d <= worst { worst } else { worst_of(d) })
}

/// As [`distance`], from a reference of many digits.
pub fn distance_from(found: &[f64], expected: &[Big], scale: &[f64]) -> f64 {
    assert_eq!([found.len(), scale.len()], [expected.len(); 2], "as many numbers");
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
