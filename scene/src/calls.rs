//! Functions of the robot that the motion of a scene calls.

use articulated_core::algorithm::FunctionId;
use articulated_core::integrator::IntegratorId;

use crate::control::Drive;
use crate::scene::Scene;
use crate::simulation::EventClass;

/// The functions that a motion calls, for any robot.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Calls {
    /// Required functions: [`integrate`](FunctionId::integrate) for robots with a quaternion,
    /// `placements` if events need frames, all others for every robot.
    pub required: Vec<FunctionId>,
    /// Functions for the recording's energies and momentum, and for losses if effects are on;
    /// `centroidal_momentum` only for robots with moving mass.
    pub reported: Vec<FunctionId>,
}

impl Calls {
    /// All of them, by name.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        self.required.iter().chain(&self.reported).map(|function| function.name())
    }
}

impl Scene {
    /// The functions that the scene's motion calls, with the scene's integrator; empty without
    /// `[simulation]`.
    pub fn calls(&self) -> Calls {
        self.simulation.as_ref().map(|simulation| self.calls_with(simulation.settings.integrator)).unwrap_or_default()
    }

    /// The functions that the scene's motion calls, with this integrator.
    pub fn calls_with(&self, integrator: IntegratorId) -> Calls {
        let mut required = integrator.row().needs.to_vec();
        required.push(FunctionId::integrate);
        if matches!(self.control.drive, Drive::Pd { .. }) {
            required.push(FunctionId::difference);
        }
        let contacts = self.simulation.as_ref().is_some_and(|simulation| simulation.events.contains(&EventClass::Contacts));
        if contacts || self.impact.is_some() {
            required.push(FunctionId::placements);
        }
        if self.impact.is_some() {
            required.extend([FunctionId::jacobians_world_aligned, FunctionId::solve_mass_matrix]);
        }
        let mut reported = vec![FunctionId::kinetic_energy, FunctionId::potential_energy, FunctionId::centroidal_momentum];
        if self.has_effects() {
            reported.extend([FunctionId::dissipation, FunctionId::motor_torques]);
        }
        Calls { required, reported }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn called(text: &str) -> Vec<&'static str> {
        Scene::read("s.toml", text).unwrap().calls().names().collect()
    }

    #[test]
    fn a_scene_that_does_not_move_calls_nothing_and_others_what_they_ask_for() {
        const ENERGIES: [&str; 3] = ["kinetic_energy", "potential_energy", "centroidal_momentum"];
        assert_eq!(called("effects = { damping = 1 }"), [""; 0]);
        assert_eq!(called("simulation = { end = 1 }"), [&["forward_dynamics", "integrate"][..], &ENERGIES].concat());
        let all = called(
            "effects = { damping = 1 }
            simulation = { end = 1, integrator = 'rodas4', events = ['contacts'] }
            control = { kind = 'pd', kp = 1, kd = 1 }
            impact = { link = 'tip', normal = [1, 0, 0], mass = 1, restitution = 1, time = 0.5 }",
        );
        let required = [
            "forward_dynamics",
            "forward_dynamics_derivatives",
            "integrate",
            "difference",
            "placements",
            "jacobians_world_aligned",
            "solve_mass_matrix",
        ];
        let effects = ["dissipation", "motor_torques"];
        assert!(all.iter().eq(required.iter().chain(&ENERGIES).chain(&effects)), "{all:?}");
    }
}
