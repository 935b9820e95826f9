//! The functions of the table in groups: for lists that people read, and to ask for them by one word.

use articulated_core::algorithm::{FunctionId, functions};

/// A group of functions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// Of frames.
    Kinematics,
    /// Torques, accelerations and the mass matrix.
    Dynamics,
    /// Of placements and dynamics.
    Derivatives,
    /// With energy and the centre of mass.
    Momentum,
    /// Of torques and energy.
    Regressors,
    /// Λ and its inverse.
    OperationalSpace,
    /// What a scene's effects do.
    Effects,
    /// Steps, differences and draws.
    Configurations,
}

impl Group {
    /// All of them, in the order in which they are listed.
    pub const ALL: [Self; 8] = [
        Self::Kinematics,
        Self::Dynamics,
        Self::Derivatives,
        Self::Momentum,
        Self::Regressors,
        Self::OperationalSpace,
        Self::Effects,
        Self::Configurations,
    ];

    /// Its name in lists of functions.
    pub fn name(self) -> &'static str {
        match self {
            Self::Kinematics => "kinematics",
            Self::Dynamics => "dynamics",
            Self::Derivatives => "derivatives",
            Self::Momentum => "momentum",
            Self::Regressors => "regressors",
            Self::OperationalSpace => "operational_space",
            Self::Effects => "effects",
            Self::Configurations => "configurations",
        }
    }

    /// The group of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|group| group.name() == name)
    }

    /// What is in it.
    pub fn title(self) -> &'static str {
        match self {
            Self::Kinematics => "Kinematics of frames",
            Self::Dynamics => "Dynamics",
            Self::Derivatives => "Derivatives",
            Self::Momentum => "Energy, centre of mass and momentum",
            Self::Regressors => "Regressors",
            Self::OperationalSpace => "Operational space",
            Self::Effects => "Effects of a scene",
            Self::Configurations => "Configurations",
        }
    }

    /// The group of a function. A new function needs its row here.
    pub fn of(function: FunctionId) -> Self {
        use FunctionId as F;
        match function {
            F::placements
            | F::twists_body
            | F::twists_world
            | F::twists_world_aligned
            | F::accelerations_body
            | F::accelerations_world
            | F::accelerations_world_aligned
            | F::jacobians_body
            | F::jacobians_world
            | F::jacobians_world_aligned
            | F::jacobian_rates_body
            | F::jacobian_rates_world
            | F::jacobian_rates_world_aligned
            | F::bias_accelerations_body
            | F::bias_accelerations_world
            | F::bias_accelerations_world_aligned => Self::Kinematics,
            F::inverse_dynamics
            | F::inverse_dynamics_with_wrenches
            | F::joint_wrenches
            | F::bias_forces
            | F::gravity_torque
            | F::static_torque
            | F::mass_matrix
            | F::coriolis_matrix
            | F::forward_dynamics
            | F::forward_dynamics_with_wrenches
            | F::mass_matrix_inverse
            | F::solve_mass_matrix => Self::Dynamics,
            F::placement_derivatives
            | F::inverse_dynamics_derivatives
            | F::inverse_dynamics_derivatives_with_wrenches
            | F::forward_dynamics_derivatives
            | F::forward_dynamics_derivatives_with_wrenches
            | F::static_torque_derivative => Self::Derivatives,
            F::kinetic_energy
            | F::potential_energy
            | F::center_of_mass
            | F::center_of_mass_velocity
            | F::center_of_mass_acceleration
            | F::center_of_mass_jacobian
            | F::centroidal_momentum
            | F::centroidal_momentum_matrix
            | F::centroidal_momentum_rate => Self::Momentum,
            F::torque_regressor | F::kinetic_energy_regressor | F::potential_energy_regressor => Self::Regressors,
            F::operational_space_inertia | F::operational_space_inertia_inverse => Self::OperationalSpace,
            F::effect_forces | F::dissipation | F::motor_torques => Self::Effects,
            F::integrate | F::difference | F::random_configuration => Self::Configurations,
        }
    }

    /// Names of its functions, in the table's order.
    pub fn functions(self) -> impl Iterator<Item = &'static str> {
        functions::<f64>().iter().filter(move |f| Self::of(f.id) == self).map(|f| f.name)
    }
}

/// The same list with each group's functions in the place of its name, and each entry once.
pub(crate) fn expanded(list: &[String]) -> Vec<String> {
    let mut all: Vec<String> = Vec::new();
    for entry in list {
        let names: Vec<String> = match Group::named(entry) {
            Some(group) => group.functions().map(str::to_owned).collect(),
            None => vec![entry.clone()],
        };
        for name in names {
            if !all.contains(&name) {
                all.push(name);
            }
        }
    }
    all
}

/// All functions, group by group.
pub fn all() -> Vec<String> {
    Group::ALL.into_iter().flat_map(Group::functions).map(str::to_owned).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_function_is_in_one_group_and_no_group_is_called_like_a_function() {
        assert_eq!(all().len(), functions::<f64>().len());
        assert!(Group::ALL.into_iter().all(|g| g.functions().next().is_some() && !all().contains(&g.name().to_owned())));
    }
    #[test]
    fn a_group_stands_for_its_functions_and_what_is_asked_for_twice_is_there_once() {
        let list = ["dissipation", "operational_space", "dissipation", "operational_space_inertia", "x = effects"].map(str::to_owned);
        assert_eq!(expanded(&list), ["dissipation", "operational_space_inertia", "operational_space_inertia_inverse", "x = effects"]);
    }
}
