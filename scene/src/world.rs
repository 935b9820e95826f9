//! The world of the robot's file, for a robot: states and actuators.

use std::borrow::Cow;
use std::collections::HashSet;
use std::sync::LazyLock;

use articulated_core::actuator::Actuators;
use articulated_core::diagnostic::{At, Code, Diagnostics, quote};
use articulated_core::model::Model;
use articulated_core::suggest::nearest;
use articulated_formats::OnLockedJoint;
use articulated_formats::world::{Keyframe, World};

use crate::initial::{Coordinates, counted};
use crate::scene::Scene;

/// The world of a file without one.
static NOTHING: LazyLock<World> = LazyLock::new(World::default);

/// A robot that a scene moves: its model, and the world of its file.
#[derive(Clone, Copy, Debug)]
pub struct RobotInWorld<'a> {
    /// The model of the robot as the scene leaves it.
    pub model: &'a Model<f64>,
    /// The world of the robot's file.
    pub world: &'a World,
}

impl<'a> From<&'a Model<f64>> for RobotInWorld<'a> {
    fn from(model: &'a Model<f64>) -> Self {
        Self { model, world: &NOTHING }
    }
}

impl Scene {
    /// Where the scene takes its step from the robot's file, that has one.
    pub(crate) fn check_file_step(&self, world: &World, log: &mut Diagnostics) {
        let place = self.simulation.as_ref().and_then(|simulation| simulation.file_step);
        if let (Some(place), None) = (place, world.step) {
            log.error((place, "simulation.step"), Code::Robot, "\"file\", and the robot's file has no time step", "a number, s");
        }
    }

    /// The scene with the step of the robot's file, if it requests that.
    #[must_use]
    pub fn with_step_of(mut self, world: &World) -> Self {
        if let Some(simulation) = self.simulation.as_mut().filter(|simulation| simulation.file_step.is_some()) {
            simulation.settings.step = world.step;
        }
        self
    }
}

impl<'a> RobotInWorld<'a> {
    /// The keyframe of the file with this name. An unknown name is an error at this place.
    pub fn keyframe(self, name: &str, place: (At, &str), log: &mut Diagnostics) -> Option<&'a Keyframe> {
        let found = self.world.keyframes.iter().find(|keyframe| keyframe.name == name);
        if found.is_none() {
            let names = || self.world.keyframes.iter().map(|keyframe| keyframe.name.as_str());
            let near = nearest(name, names()).map(|near| format!("; did you mean {near:?}?")).unwrap_or_default();
            let expected = match names().next() {
                None => "no key: the robot's file has no keyframes".to_owned(),
                Some(_) => format!("one of {}{near}", articulated_core::listed(names())),
            };
            log.error(place, Code::UnknownName, format!("the keyframe {}", quote(name)), expected);
        }
        found
    }

    /// Writes the numbers of joints, as a file has them, into a vector of the robot, `[nq]` or
    /// `[nv]`. Joints that the scene locked, or that follow others, have no numbers.
    pub fn put(self, numbers: &[(String, Vec<f64>)], is_rates: bool, into: &mut [f64]) {
        for (name, values) in numbers {
            let Some(joint) = self.model.joints().iter().find(|joint| joint.name == *name) else { continue };
            let (first, count) = if is_rates { joint.v } else { joint.q };
            if values.len() == count {
                into[first..first + count].copy_from_slice(values);
            }
        }
    }

    /// The world without the actuators, springs and dampers of these names. A name that the file
    /// does not have, or that is listed twice, is an error.
    pub(crate) fn world_without(self, without: &[(String, At)], log: &mut Diagnostics) -> Cow<'a, World> {
        if without.is_empty() {
            return Cow::Borrowed(self.world);
        }
        let names = || self.world.actuators.iter().chain(&self.world.passive).map(|actuator| actuator.name.as_str());
        let mut left: HashSet<&str> = HashSet::new();
        for (k, (name, place)) in without.iter().enumerate() {
            let key = format!("control.without[{k}]");
            if !names().any(|known| known == name) {
                let found = ("no such actuator".to_owned(), name.as_str());
                log.unknown(((*place, &key), Code::UnknownName), found, "an actuator or a tendon of the robot's file", names());
            } else if !left.insert(name) {
                log.error((*place, &key), Code::DuplicateName, format!("{} a second time", quote(name)), "each name once");
            }
        }
        let mut world = self.world.clone();
        let is_kept = |name: &str| !left.contains(name);
        for keyframe in &mut world.keyframes {
            let own = keyframe.control.iter().zip(&self.world.actuators);
            keyframe.control = own.filter(|(_, actuator)| is_kept(&actuator.name)).map(|(control, _)| *control).collect();
            let own = keyframe.activation.iter().zip(&self.world.actuators);
            keyframe.activation = own.filter(|(_, actuator)| is_kept(&actuator.name)).map(|(w, _)| *w).collect();
        }
        world.actuators.retain(|actuator| is_kept(&actuator.name));
        world.passive.retain(|actuator| is_kept(&actuator.name));
        Cow::Owned(world)
    }

    /// Writes the scene's controls, in the order of the file's actuators or by name.
    pub(crate) fn put_controls(self, from: &Coordinates, into: &mut [f64], log: &mut Diagnostics) {
        match from {
            Coordinates::Neutral => {}
            Coordinates::All { values, .. } if values.len() == into.len() => into.copy_from_slice(values),
            Coordinates::All { values, place } => {
                let expected = format!("{}, one for each actuator of the robot's file", counted(into.len()));
                log.error((*place, "control.ctrl"), Code::Number, counted(values.len()), expected);
            }
            Coordinates::Named(named) => {
                for one in named {
                    let key = format!("control.ctrl.{}", crate::table::bare(&one.joint));
                    let actuators = &self.world.actuators;
                    match (actuators.iter().position(|actuator| actuator.name == one.joint), one.values.as_slice()) {
                        (Some(k), &[u]) => into[k] = u,
                        (Some(_), values) => log.error((one.place, &key), Code::Number, counted(values.len()), "one number"),
                        (None, _) => {
                            let names = actuators.iter().map(|actuator| actuator.name.as_str());
                            let found = ("no such actuator".to_owned(), one.joint.as_str());
                            log.unknown(((one.place, &key), Code::UnknownName), found, "an actuator of the robot's file", names);
                        }
                    }
                }
            }
        }
    }

    /// The actuators of the file on this robot. An actuator on a locked joint is an error.
    pub(crate) fn actuators(self, place: (At, &str), log: &mut Diagnostics) -> Actuators {
        let (mut actuators, locked) = self.world.actuators_of(self.model);
        for OnLockedJoint { actuator, joint } in locked {
            let found = format!("the actuator {} on joint {}, which is locked", quote(&actuator), quote(&joint));
            let expected = format!("joints that move, or `without = [{}]`, which leaves it out", quote(&actuator));
            log.error(place, Code::Robot, found, expected);
        }
        // A motion has no activations, and torques of joints alone: see `warnings`.
        actuators.passive.retain(|law| law.frames.is_none());
        for law in actuators.laws.iter_mut().filter(|law| law.activation.is_some() || law.frames.is_some()) {
            (law.gain, law.bias, law.terms, law.activation, law.frames) = ([0.0; 3], [0.0; 3], None, None, None);
        }
        actuators
    }
}
