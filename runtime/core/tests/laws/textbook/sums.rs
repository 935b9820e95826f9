//! Sums over links: energies, momentum, regressors.

use articulated_core::algorithm::Argument;
use articulated_reference::Big;
use num_traits::Zero;

use super::{EXACT, NEARLY, REGULAR, SMALL, apply, dot, for_each_scene, plus, same, times};

#[test]
fn torques_and_energies_are_regressors_times_parameters() {
    for_each_scene(15, SMALL, |_, scene| {
        let ([q, v, a, _], nv) = (scene.motion(), scene.size[1]);
        let parameters = scene.book.parameters();
        let found = apply(&scene.call("torque_regressor", &[q, v, a]), &parameters, nv);
        same("τ", &found, &scene.call("inverse_dynamics", &[q, v, a]), EXACT);
        let found = apply(&scene.call("kinetic_energy_regressor", &[q, v]), &parameters, 1);
        same("T", &found, &scene.call("kinetic_energy", &[q, v]), EXACT);
        let found = apply(&scene.call("potential_energy_regressor", &[q]), &parameters, 1);
        same("U", &found, &scene.call("potential_energy", &[q]), EXACT);
    });
}

#[test]
fn energies_are_those_of_virtual_power() {
    for_each_scene(15, SMALL, |case, scene| {
        let ([q, v, ..], n) = (scene.motion(), scene.size[1]);
        let motions = case.motions();
        let (rest, other) = (vec![Big::zero(); n], scene.given(Argument::Target));
        let energy = |q: &[Big]| motions.energy(q, v, &rest);
        same("T", &scene.call("kinetic_energy", &[q, v]), &[energy(q).kinetic], EXACT);
        // The links that do not move have a height too, but always the same.
        let potential = |q: &[Big]| scene.call("potential_energy", &[q])[0];
        same("U", &[potential(q) - potential(other)], &[energy(q).potential - energy(other).potential], EXACT);
        let m = scene.call("mass_matrix", &[q]);
        same("½ vᵀM v", &times(0.5, &[dot(v, &apply(&m, v, n))]), &[energy(q).kinetic], EXACT);
    });
}

#[test]
fn momentum_is_mass_times_velocity_and_a_matrix_times_rates() {
    for_each_scene(10, REGULAR, |_, scene| {
        let ([q, v, a, _], n) = (scene.motion(), scene.size[1]);
        if n == 0 {
            return;
        }
        let momentum = scene.call("centroidal_momentum", &[q, v]);
        same("A v", &apply(&scene.call("centroidal_momentum_matrix", &[q]), v, 6), &momentum, EXACT);
        let velocity = scene.call("center_of_mass_velocity", &[q, v]);
        same("J v", &apply(&scene.call("center_of_mass_jacobian", &[q]), v, 3), &velocity, EXACT);
        let mass = scene.book.parameters().chunks(10).fold(Big::zero(), |sum, p| sum + p[0]);
        let carried: Vec<Big> = velocity.iter().map(|&x| x * mass).collect();
        same("m ċ", &momentum[3..], &carried, EXACT);
        let later = |h: f64| plus(v, &times(h, a));
        let slope = scene.slope(v, |q, _| scene.call("center_of_mass", &[q]));
        same("ċ", &velocity, &slope, NEARLY);
        let slope = scene.slope(v, |q, h| scene.call("center_of_mass_velocity", &[q, &later(h)]));
        same("c̈", &scene.call("center_of_mass_acceleration", &[q, v, a]), &slope, NEARLY);
        let slope = scene.slope(v, |q, h| scene.call("centroidal_momentum", &[q, &later(h)]));
        same("ḣ", &scene.call("centroidal_momentum_rate", &[q, v, a]), &slope, NEARLY);
    });
}
