//! The motion that a robot's file describes: its state, controls, method and step.

use articulated_core::actuator::Actuators;
use articulated_core::description::Description;
use articulated_core::diagnostic::{At, Diagnostics};
use articulated_core::model::Model;
use articulated_core::step::State;
use articulated_formats::world::{Keyframe, Stepping, World};
use articulated_scene::RobotInWorld;

use crate::console;
use crate::failure::Failure;
use crate::robot_scene::HOME;

/// The step of a file that has none, s.
const STEP: f64 = 1e-3;

/// Where a motion starts.
pub(crate) struct Start {
    /// The state.
    pub(crate) state: State,
    /// The controls of the actuators.
    pub(crate) ctrl: Vec<f64>,
    /// Where they are from, in words.
    pub(crate) source: String,
}

impl Start {
    /// The keyframe of this name; without a name that called `home`, or else the initial state of
    /// the file, with controls of 0.
    ///
    /// # Errors
    /// A name that no keyframe has.
    pub(crate) fn of_file(file: &str, world: &World, model: &Model<f64>, keyframe: Option<&str>) -> Result<Self, Failure> {
        let robot = RobotInWorld { model, world };
        let found = match keyframe {
            Some(name) => {
                let mut log = Diagnostics::new(file);
                let found = robot.keyframe(name, (At::Nowhere, "--keyframe"), &mut log);
                log.result(found)?
            }
            None => world.keyframes.iter().find(|keyframe| keyframe.name == HOME),
        };
        let mut state = State::neutral(model);
        let mut ctrl = vec![0.0; model.actuators().laws.len()];
        for keyframe in world.home.iter().chain(found) {
            robot.put(&keyframe.q, false, &mut state.q);
            robot.put(&keyframe.v, true, &mut state.v);
        }
        if let Some(keyframe) = found {
            ctrl.iter_mut().zip(&keyframe.control).for_each(|(u, value)| *u = *value);
            put_activations(model.actuators(), keyframe, &mut state);
        }
        let controls = if ctrl.is_empty() { "" } else { ", controls of 0" };
        let source = match found {
            Some(keyframe) => format!("the keyframe {:?}", keyframe.name),
            None if world.home.is_some() => format!("the initial state of the file{controls}"),
            None => format!("coordinates of 0 at rest{controls}"),
        };
        Ok(Self { state, ctrl, source })
    }
}

/// Writes the activations of a keyframe into a state.
pub(crate) fn put_activations(actuators: &Actuators, keyframe: &Keyframe, state: &mut State) {
    let own = actuators.laws.iter().zip(&keyframe.activation).filter(|(law, _)| law.activation.is_some());
    state.act.iter_mut().zip(own).for_each(|(w, (_, value))| *w = *value);
}

/// Whether a function with constraints can be called: warnings are of what an option leaves out.
///
/// # Errors
/// Constraints of the file that are not computed.
pub(crate) fn are_computed(file: &str, (description, world): (&Description, &World), model: &Model<f64>) -> Result<(), Failure> {
    let mut log = Diagnostics::new(file);
    let unread = articulated_codegen::unread_constraints(file, (description, world, model), &mut log);
    unread.iter().for_each(|warning| console::warn(&warning.to_string()));
    log.result(Some(()))?;
    Ok(())
}

/// The length of a step, s: the given one, or that of the file.
pub(crate) fn step_length(given: Option<f64>, world: &World) -> f64 {
    given.or(world.time_step()).unwrap_or(STEP)
}

/// The names of the function of a step that a file requests, with torques and with actuators. A
/// note says where it differs from the file's own.
pub(crate) fn step_of_file(stepping: Option<&Stepping>) -> [&'static str; 2] {
    let Some(stepping) = stepping else { return ["step_semi_implicit_euler", "actuated_step_semi_implicit_euler"] };
    stepping.functions().unwrap_or_else(|| {
        let known = ["step_implicit_velocity", "actuated_step_implicit_velocity"];
        console::note(&format!("the file's integrator is {}: steps are those of implicitfast", stepping.integrator));
        known
    })
}
