//! The algorithms, each written once over the scalar, and the table of their functions.

mod aba;
pub(crate) mod argument;
mod base_parameters;
mod call;
pub mod checked;
mod common;
mod coriolis;
mod crba;
mod derivatives;
pub(crate) mod effects;
mod energy;
mod formulation;
mod forward_dynamics;
mod frames;
mod kinematics;
pub(crate) mod ltdl;
pub(crate) mod manifold;
mod manifold_derivatives;
mod momentum;
mod operational_space;
mod pushed;
pub(crate) mod registry;
mod regressor;
mod rnea;
pub(crate) mod table;
pub mod textbook;
mod user_function;
mod workspace;
mod wrenches;

pub use aba::{articulated_body, articulated_body_with_wrenches, solve_by_articulated_body};
pub use argument::{Argument, Dim, Port};
pub use base_parameters::{BaseParameter, BodyParameters, Identifiability, base_parameters, identifiable_parameters};
pub use call::{FunctionError, check_count, check_length, exactly, exactly_rows};
pub use checked::{checked_forward_dynamics, checked_forward_dynamics_with_wrenches};
pub use coriolis::coriolis_matrix;
pub use crba::mass_matrix;
pub use derivatives::{forward_dynamics_derivatives_with_wrenches, inverse_dynamics_derivatives_with_wrenches, static_torque_derivative};
use derivatives::{unsolved_derivatives, without_motors};
pub use effects::{dissipation, effect_forces, motor_torques};
pub use energy::{kinetic_energy, potential_energy};
pub use formulation::{AngularKinematics, Formulation, FrameRotation};
pub use forward_dynamics::{forward_dynamics_with_wrenches, mass_matrix_inverse, solve_mass_matrix};
pub use frames::{
    accelerations_body, accelerations_world, accelerations_world_aligned, jacobian_rates_body, jacobian_rates_world,
    jacobian_rates_world_aligned, jacobians_body, jacobians_world, jacobians_world_aligned, placement_derivatives, twists_body,
    twists_world, twists_world_aligned,
};
pub use kinematics::placements;
pub use manifold::{coordinate_box, difference, divide_by_length, integrate, neutral, random_configuration, small_difference, small_step};
pub use manifold_derivatives::{difference_derivatives, integrate_derivatives};
pub use momentum::{
    center_of_mass, center_of_mass_acceleration, center_of_mass_jacobian, center_of_mass_velocity, centroidal_momentum,
    centroidal_momentum_matrix, centroidal_momentum_rate,
};
pub use operational_space::{operational_space_inertia, operational_space_inertia_inverse};
pub(crate) use pushed::Placed;
pub use registry::{Function, Group, Inputs, Needs, Shape, Variant};
pub use regressor::{PARAMETERS, joint_regressor, kinetic_energy_regressor, potential_energy_regressor, torque_regressor};
pub use rnea::{inverse_dynamics_with_wrenches, joint_wrenches};
pub use table::presets::*;
pub use table::{FunctionId, function, functions};
pub(crate) use table::{always, factorization, nothing, untied};
pub use user_function::UserFunction;
pub use workspace::Workspace;
