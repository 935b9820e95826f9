//! Functions by their names.

use alloc::vec;
use alloc::vec::Vec;

use super::Textbook;
use crate::Scalar;
use crate::algorithm::{Function, FunctionError, Shape, check_count, check_length, function};
use crate::spatial::Reference;

/// The reference that a name ends with, and what is left of the name.
fn reference(name: &str) -> (&str, Reference) {
    let all = [Reference::WorldAligned, Reference::World, Reference::Body];
    let strip = |r: Reference| name.strip_suffix(r.name())?.strip_suffix('_').map(|stem| (stem, r));
    all.into_iter().find_map(strip).unwrap_or((name, Reference::Body))
}

impl<S: Scalar> Textbook<S> {
    /// Any function of the table by its name; `arguments` in its order. `None` for a name that is not in it.
    pub fn call(&self, name: &str, arguments: &[&[S]]) -> Option<Result<Vec<S>, FunctionError>> {
        match self.check(function::<f64>(name)?, arguments) {
            Err(error) => Some(Err(error)),
            Ok(()) => self.answer(name, arguments).map(Ok),
        }
    }

    fn check(&self, function: &Function<f64>, arguments: &[&[S]]) -> Result<(), FunctionError> {
        let shape = Shape { nq: self.nq, nv: self.nv, frames: self.frames.len(), links: self.moving_links().count() };
        check_count(function.name, arguments.len(), function.takes.len())?;
        function.takes.iter().zip(arguments).try_for_each(|(takes, given)| check_length(takes.name(), given.len(), takes.len(shape)))
    }

    /// With as many arguments as the name takes.
    fn answer(&self, name: &str, x: &[&[S]]) -> Option<Vec<S>> {
        let (still, q) = (self.rest(), x[0]);
        let free = vec![S::zero(); 6 * self.frames.len()];
        Some(match name {
            "inverse_dynamics" => self.inverse_dynamics(q, x[1], x[2]),
            "inverse_dynamics_with_wrenches" => self.inverse_dynamics_with_wrenches(q, x[1], x[2], x[3]),
            "bias_forces" => self.inverse_dynamics(q, x[1], &still),
            "gravity_torque" => self.inverse_dynamics(q, &still, &still),
            "static_torque" => self.inverse_dynamics_with_wrenches(q, &still, &still, x[1]),
            "joint_wrenches" => self.joint_wrenches(q, x[1], x[2]),
            "mass_matrix" => self.mass_matrix(q),
            "mass_matrix_inverse" => self.mass_matrix_inverse(q),
            "solve_mass_matrix" => self.solve_mass_matrix(q, x[1]),
            "coriolis_matrix" => self.coriolis_matrix(q, x[1]),
            "forward_dynamics" => self.forward_dynamics_with_wrenches(q, x[1], x[2], &free),
            "forward_dynamics_with_wrenches" => self.forward_dynamics_with_wrenches(q, x[1], x[2], x[3]),
            "inverse_dynamics_derivatives" => self.inverse_dynamics_derivatives(q, x[1], x[2], &free),
            "inverse_dynamics_derivatives_with_wrenches" => self.inverse_dynamics_derivatives(q, x[1], x[2], x[3]),
            "forward_dynamics_derivatives" => self.forward_dynamics_derivatives(q, x[1], x[2], &free),
            "forward_dynamics_derivatives_with_wrenches" => self.forward_dynamics_derivatives(q, x[1], x[2], x[3]),
            "static_torque_derivative" => self.static_torque_derivative(q, x[1]),
            "operational_space_inertia" => self.operational_space_inertia(q),
            "operational_space_inertia_inverse" => self.operational_space_inertia_inverse(q),
            _ => return self.answer_of_motion(name, x),
        })
    }

    /// Kinematics, sums over links, regressors, and the manifold.
    fn answer_of_motion(&self, name: &str, x: &[&[S]]) -> Option<Vec<S>> {
        let (q, (stem, reference)) = (x[0], reference(name));
        Some(match stem {
            "placements" => self.placements(q),
            "placement_derivatives" => self.placement_derivatives(q),
            "twists" => self.twists(reference, q, x[1]),
            "accelerations" => self.accelerations(reference, q, x[1], x[2]),
            "bias_accelerations" => self.accelerations(reference, q, x[1], &self.rest()),
            "jacobians" => self.jacobians(reference, q),
            "jacobian_rates" => self.jacobian_rates(reference, q, x[1]),
            "kinetic_energy" => vec![self.kinetic_energy(q, x[1])],
            "potential_energy" => vec![self.potential_energy(q)],
            "center_of_mass" => self.center_of_mass(q),
            "center_of_mass_velocity" => self.center_of_mass_velocity(q, x[1]),
            "center_of_mass_acceleration" => self.center_of_mass_acceleration(q, x[1], x[2]),
            "center_of_mass_jacobian" => self.center_of_mass_jacobian(q),
            "centroidal_momentum" => self.centroidal_momentum(q, x[1]),
            "centroidal_momentum_matrix" => self.centroidal_momentum_matrix(q),
            "centroidal_momentum_rate" => self.centroidal_momentum_rate(q, x[1], x[2]),
            "torque_regressor" => self.torque_regressor(q, x[1], x[2]),
            "kinetic_energy_regressor" => self.kinetic_energy_regressor(q, x[1]),
            "potential_energy_regressor" => self.potential_energy_regressor(q),
            // The book knows of no effects.
            "effect_forces" => self.rest(),
            "dissipation" => vec![S::zero()],
            "motor_torques" => x[1].to_vec(),
            "integrate" => self.integrate(q, x[1]),
            "difference" => self.difference(q, x[1]),
            "integrate_derivatives" => self.integrate_derivatives(q),
            "difference_derivatives" => self.difference_derivatives(q, x[1]),
            "random_configuration" => self.random_configuration(q),
            _ => return None,
        })
    }
}
