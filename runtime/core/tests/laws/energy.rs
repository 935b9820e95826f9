//! Energy: the work of torques is the gain of kinetic and potential energy.

use articulated_test_support::case::{Case, State, for_each_bundled, inverse_dynamics, mass_matrix};
use articulated_test_support::measure::{U, torque_scale};
use articulated_test_support::random::Random;
use articulated_test_support::random_tree::Flavour;
use nalgebra::DVector;

use crate::trees::for_each_tree;

/// Errors allowed, in units of u times the magnitude of the terms.
const FEW: f64 = 32.0;

fn power_balance_holds(case: &Case, random: &mut Random) {
    let state = case.state(random);
    let tau = case.inverse_dynamics(&state);
    let given: f64 = tau.iter().zip(&state.v).map(|(t, v)| t * v).sum();
    let gained = case.motions().energy(&state.q, &state.v, &state.a).power;
    let scale: f64 = torque_scale(case, &state).iter().zip(&state.v).map(|(t, v)| t * v.abs()).sum();
    assert!((given - gained).abs() <= FEW * U * scale, "power given {given}, gained {gained}, scale {scale}");
}

#[test]
fn power_of_the_torques_is_the_change_of_energy() {
    for_each_tree(200, Flavour::ANY, power_balance_holds);
    for_each_tree(100, Flavour::BENT, power_balance_holds);
    for_each_bundled(power_balance_holds);
}

#[test]
fn twice_kinetic_energy_equals_vt_m_v() {
    for_each_tree(100, Flavour::ANY, |case, random| {
        let State { q, v, .. } = case.state(random);
        let m = mass_matrix(&case.model, &q);
        let rates = DVector::from_column_slice(&v);
        let found = if v.is_empty() { 0.0 } else { rates.dot(&(&m * &rates)) };
        let zero = vec![0.0; v.len()];
        let expected = 2.0 * case.motions().energy(&q, &v, &zero).kinetic;
        let scale = (0..v.len()).flat_map(|i| (0..v.len()).map(move |j| (i, j))).map(|(i, j)| (v[i] * m[(i, j)] * v[j]).abs()).sum::<f64>();
        assert!((found - expected).abs() <= 1e-12 * (scale + expected.abs()), "{found} {expected}");
    });
}

#[test]
fn gravity_torque_is_the_slope_of_potential_energy() {
    for_each_tree(50, Flavour::ANY, |case, random| {
        let State { q, v, .. } = case.state(random);
        let zero = vec![0.0; v.len()];
        let torque = inverse_dynamics(&case.model, &q, &zero, &zero);
        // dU/dt along v, without the kinetic part: that of the energy at vanishing rates.
        let slow: Vec<f64> = v.iter().map(|x| x * 1e-9).collect();
        let gained = case.motions().energy(&q, &slow, &zero).power * 1e9;
        let given: f64 = torque.iter().zip(&v).map(|(t, v)| t * v).sum();
        let scale: f64 = torque_scale(case, &State::new(q, zero.clone(), zero)).iter().zip(&v).map(|(t, v)| t * v.abs()).sum();
        assert!((given - gained).abs() <= 1e-13 * scale + 1e-14, "{given} {gained} {scale}");
    });
}
