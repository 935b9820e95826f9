//! The world of the robot's file, for a robot: states and actuators.

use std::borrow::Cow;
use std::collections::HashSet;
use std::sync::LazyLock;

use articulated_core::control::{ActuatorLaw, Actuators, Follower, Signal, Transmission};
use articulated_core::diagnostic::{At, Code, Diagnostics, quote};
use articulated_core::model::Model;
use articulated_core::suggest::nearest;
use articulated_formats::world::{Actuator, Keyframe, World};

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
    /// The state of the file with this name.
    pub(crate) fn keyframe(self, name: &str, place: (At, &str), log: &mut Diagnostics) -> Option<&'a Keyframe> {
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

    /// Writes the numbers of joints, as a file has them, into a vector of the robot. Joints that
    /// the scene locked, or that follow others, have no numbers.
    pub(crate) fn put(self, numbers: &[(String, Vec<f64>)], is_rates: bool, into: &mut [f64]) {
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
    pub(crate) fn actuators(self, controls: Signal, place: (At, &str), log: &mut Diagnostics) -> Actuators {
        let mut followers = Vec::new();
        let mut laws = |all: &[Actuator], mut followers: Option<&mut Vec<(String, Follower)>>| {
            let law = |(k, actuator)| self.law(actuator, followers.as_deref_mut().map(|all| (k, all)), place, log);
            all.iter().enumerate().map(law).collect()
        };
        let (laws, passive) = (laws(&self.world.actuators, Some(&mut followers)), laws(&self.world.passive, None));
        let range = |name: &str| self.world.joint_forces.iter().find(|(joint, _)| joint == name).map(|(_, range)| *range);
        let followers = followers.into_iter().map(|(name, follower)| Follower { range: range(&name), ..follower }).collect();
        let degree = |(name, range): &(String, [f64; 2])| {
            let joint = self.model.joints().iter().find(|joint| joint.name == *name && joint.v.1 == 1)?;
            Some((joint.v.0, *range))
        };
        Actuators { laws, controls, bounds: self.world.joint_forces.iter().filter_map(degree).collect(), followers, passive }
    }

    /// The law of an actuator with the robot's own coordinates. A joint that follows others is
    /// q = Σ multiplier · leader's + offset: its part of the length is one of theirs, and a
    /// constant. `followers`: the number of the law, and where to put its torques on such joints.
    fn law(
        self,
        actuator: &Actuator,
        mut followers: Option<(usize, &mut Vec<(String, Follower)>)>,
        place: (At, &str),
        log: &mut Diagnostics,
    ) -> ActuatorLaw {
        let (mut drives, mut constant) = (Vec::new(), 0.0);
        for (joint, gear) in &actuator.drives {
            if let Some(one) = self.model.joints().iter().find(|one| one.name == *joint && one.v.1 == gear.len()) {
                drives.push(Transmission { q: one.q.0, v: one.v.0, gear: gear.clone(), has_no_torque: false });
                continue;
            }
            // One that follows several is a sequence of bodies with its name.
            let parts = self.model.bodies().iter().filter(|body| body.name == *joint);
            let (before, mut leaders) = (drives.len(), Vec::new());
            for (body, follow) in parts.filter_map(|body| Some((body, body.coordinates.mimic?))) {
                constant += gear[0] * follow.offset;
                let (at, gear) = (&body.coordinates, vec![gear[0] * follow.multiplier]);
                drives.push(Transmission { q: at.q, v: at.v, gear, has_no_torque: followers.is_some() });
                leaders.push((at.v, follow.multiplier));
            }
            if let Some((law, all)) = followers.as_mut().filter(|_| !leaders.is_empty()) {
                let known = all.iter().position(|(name, _)| name == joint);
                let index = known.unwrap_or_else(|| {
                    all.push((joint.clone(), Follower { leaders, ..Follower::default() }));
                    all.len() - 1
                });
                all[index].1.laws.push((*law, gear[0]));
            }
            if drives.len() == before {
                let found = format!("the actuator {} on joint {}, which is locked", quote(&actuator.name), quote(joint));
                let expected = format!("joints that move, or `without = [{}]`, which leaves it out", quote(&actuator.name));
                log.error(place, Code::Robot, found, expected);
            }
        }
        let from = |[at_rest, of_length, of_rate]: [f64; 3]| [at_rest + of_length * constant, of_length, of_rate];
        ActuatorLaw {
            name: actuator.name.clone(),
            drives,
            gain: from(actuator.gain),
            bias: from(actuator.bias),
            control_range: actuator.control_range,
            force_range: actuator.force_range,
        }
    }
}
