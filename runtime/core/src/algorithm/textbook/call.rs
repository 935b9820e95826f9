//! Functions by their names.

use alloc::vec;
use alloc::vec::Vec;

use super::Textbook;
use crate::Scalar;
use crate::algorithm::{Function, FunctionError, FunctionId, Shape, check_count, check_length, function};
use crate::spatial::Reference;

impl<S: Scalar> Textbook<S> {
    /// Any function of the table by its name; `arguments` in its order. `None` for a name that is
    /// not in it.
    pub fn call(&self, name: &str, arguments: &[&[S]]) -> Option<Result<Vec<S>, FunctionError>> {
        let function = function::<f64>(name)?;
        Some(self.check(function, arguments).map(|()| self.answer(function.id, arguments)))
    }

    fn check(&self, function: &Function<f64>, arguments: &[&[S]]) -> Result<(), FunctionError> {
        let shape = Shape { nq: self.nq, nv: self.nv, frames: self.frames.len(), links: self.moving_links().len(), ..Shape::default() };
        check_count(function.name, arguments.len(), function.takes.len())?;
        function.takes.iter().zip(arguments).try_for_each(|(takes, given)| check_length(takes.name(), given.len(), takes.len(shape)))
    }

    /// With as many arguments as the function takes.
    fn answer(&self, id: FunctionId, x: &[&[S]]) -> Vec<S> {
        use FunctionId as F;
        use Reference::{Body, World, WorldAligned};
        let (still, q) = (self.rest(), x[0]);
        let free = vec![S::zero(); 6 * self.frames.len()];
        match id {
            F::inverse_dynamics => self.inverse_dynamics(q, x[1], x[2]),
            F::inverse_dynamics_with_wrenches => self.inverse_dynamics_with_wrenches(q, x[1], x[2], x[3]),
            F::bias_forces => self.inverse_dynamics(q, x[1], &still),
            F::gravity_torque => self.inverse_dynamics(q, &still, &still),
            F::static_torque => self.inverse_dynamics_with_wrenches(q, &still, &still, x[1]),
            F::joint_wrenches => self.joint_wrenches(q, x[1], x[2]),
            F::mass_matrix => self.mass_matrix(q),
            F::mass_matrix_inverse => self.mass_matrix_inverse(q),
            F::solve_mass_matrix => self.solve_mass_matrix(q, x[1]),
            F::coriolis_matrix => self.coriolis_matrix(q, x[1]),
            F::forward_dynamics => self.forward_dynamics_with_wrenches(q, x[1], x[2], &free),
            F::forward_dynamics_with_wrenches => self.forward_dynamics_with_wrenches(q, x[1], x[2], x[3]),
            F::inverse_dynamics_derivatives => self.inverse_dynamics_derivatives(q, x[1], x[2], &free),
            F::inverse_dynamics_derivatives_with_wrenches => self.inverse_dynamics_derivatives(q, x[1], x[2], x[3]),
            F::forward_dynamics_derivatives => self.forward_dynamics_derivatives(q, x[1], x[2], &free),
            F::forward_dynamics_derivatives_with_wrenches => self.forward_dynamics_derivatives(q, x[1], x[2], x[3]),
            F::static_torque_derivative => self.static_torque_derivative(q, x[1]),
            F::operational_space_inertia => self.operational_space_inertia(q),
            F::operational_space_inertia_inverse => self.operational_space_inertia_inverse(q),
            F::placements => self.placements(q),
            F::placement_derivatives => self.placement_derivatives(q),
            F::twists_body => self.twists(Body, q, x[1]),
            F::twists_world => self.twists(World, q, x[1]),
            F::twists_world_aligned => self.twists(WorldAligned, q, x[1]),
            F::accelerations_body => self.accelerations(Body, q, x[1], x[2]),
            F::accelerations_world => self.accelerations(World, q, x[1], x[2]),
            F::accelerations_world_aligned => self.accelerations(WorldAligned, q, x[1], x[2]),
            F::bias_accelerations_body => self.accelerations(Body, q, x[1], &still),
            F::bias_accelerations_world => self.accelerations(World, q, x[1], &still),
            F::bias_accelerations_world_aligned => self.accelerations(WorldAligned, q, x[1], &still),
            F::jacobians_body => self.jacobians(Body, q),
            F::jacobians_world => self.jacobians(World, q),
            F::jacobians_world_aligned => self.jacobians(WorldAligned, q),
            F::jacobian_rates_body => self.jacobian_rates(Body, q, x[1]),
            F::jacobian_rates_world => self.jacobian_rates(World, q, x[1]),
            F::jacobian_rates_world_aligned => self.jacobian_rates(WorldAligned, q, x[1]),
            F::kinetic_energy => vec![self.kinetic_energy(q, x[1])],
            F::potential_energy => vec![self.potential_energy(q)],
            F::center_of_mass => self.center_of_mass(q),
            F::center_of_mass_velocity => self.center_of_mass_velocity(q, x[1]),
            F::center_of_mass_acceleration => self.center_of_mass_acceleration(q, x[1], x[2]),
            F::center_of_mass_jacobian => self.center_of_mass_jacobian(q),
            F::centroidal_momentum => self.centroidal_momentum(q, x[1]),
            F::centroidal_momentum_matrix => self.centroidal_momentum_matrix(q),
            F::centroidal_momentum_rate => self.centroidal_momentum_rate(q, x[1], x[2]),
            F::torque_regressor => self.torque_regressor(q, x[1], x[2]),
            F::joint_regressor => self.joint_regressor(x[0], x[1]),
            F::kinetic_energy_regressor => self.kinetic_energy_regressor(q, x[1]),
            F::potential_energy_regressor => self.potential_energy_regressor(q),
            // The book has no effects.
            F::effect_forces => still,
            F::dissipation => vec![S::zero()],
            F::motor_torques => x[1].to_vec(),
            F::integrate => self.integrate(q, x[1]),
            F::difference => self.difference(q, x[1]),
            F::integrate_derivatives => self.integrate_derivatives(q),
            F::difference_derivatives => self.difference_derivatives(q, x[1]),
            F::random_configuration => self.random_configuration(q),
            F::user => Vec::new(),
        }
    }
}
