//! Robots that are appended to another one: their links, joints and frames, and the worlds of their
//! files.
//!
//! All names get the prefix. States of one name are one state; the states of the appended robot
//! that the other one does not have get the prefix, too. Gravity, step and integrator are those of
//! the first file.

use std::collections::HashSet;

use articulated_core::description::{Base, Coupling, EditError, Editor};
use articulated_core::diagnostic::{At, Code, Diagnostic, Place, Subject, Unused};
use articulated_core::diagnostic::{Diagnostics, quote};
use articulated_core::effect::{Applied, EffectId};
use articulated_formats::world::{Actuator, Keyframe, Loop, Unread, World};
use articulated_formats::{LeaveOut, Options, read_with};

use super::build::{Editing, Entry};
use super::options::Appended;

impl Editing<'_> {
    /// Reads another robot and appends it, with its world.
    pub(super) fn append(&mut self, other: &Appended, editor: &mut Editor<'_>, log: &mut Diagnostics) {
        // Its root moves with the link that carries it.
        // Only the robot itself has arguments.
        let arguments = Default::default();
        let options = Options { file: other.file.value.clone(), base: Base::Floating, arguments, ..self.request.reader_options() };
        let reading = match read_with(&self.request.options.included, &other.document, &options) {
            Ok(reading) => reading,
            Err(findings) => return log.take(findings),
        };
        let result = editor.append(&other.at, &reading.description, &other.prefix, other.origin);
        self.reading.warnings.extend(reading.warnings);
        self.reading.snapped.extend(reading.snapped);
        self.reading.unused.extend(reading.unused.into_iter().map(|u| renamed(u, &other.prefix)));
        if result.is_ok() {
            self.report_other_gravity(&reading.world);
            self.coupling_files.extend(reading.world.couplings.iter().map(|_| other.file.value.clone()));
            Joining { file: &other.file, prefix: &other.prefix, warnings: &mut self.reading.warnings }
                .join(&mut self.reading.world, reading.world);
        }
        let at = match &result {
            Err(EditError::UnknownLink { .. }) => Entry::of(&other.at, "append"),
            _ => Entry::of(&other.file, "append"),
        };
        self.take(&at, result, log);
    }

    /// Lists the gravity of an appended robot's file if it differs from the robot's.
    fn report_other_gravity(&mut self, other: &World) {
        let own = self.request.options.gravity_in(&self.reading.world);
        if other.gravity.is_some_and(|gravity| gravity != own) {
            let why = "gravity is that of the robot that carries this one".to_owned();
            self.reading.unused.push(Unused { line: None, subject: Subject::Document, tag: "option gravity".to_owned(), why });
        }
    }
}

/// Content of an appended robot that is not used, under its new names.
fn renamed(unused: Unused, prefix: &str) -> Unused {
    let subject = match unused.subject {
        Subject::Document => Subject::Document,
        Subject::Link(name) => Subject::Link(format!("{prefix}{name}")),
        Subject::Joint(name) => Subject::Joint(format!("{prefix}{name}")),
    };
    Unused { subject, ..unused }
}

/// Adds the world of an appended robot to the world of the robot that carries it.
struct Joining<'a> {
    /// The file of the appended robot.
    file: &'a str,
    prefix: &'a str,
    warnings: &'a mut Vec<Diagnostic>,
}

impl Joining<'_> {
    fn join(&mut self, world: &mut World, other: World) {
        let counts = [world.actuators.len(), other.actuators.len()];
        self.keyframes(world, other.keyframes, counts);
        if let Some(home) = other.home {
            let own = world.home.get_or_insert_with(|| Keyframe { name: home.name.clone(), ..Keyframe::default() });
            own.q.extend(self.all_named(home.q));
            own.v.extend(self.all_named(home.v));
        }
        let mut taken: HashSet<String> = world.actuators.iter().chain(&world.passive).map(|actuator| actuator.name.clone()).collect();
        let actuators: Vec<Actuator> = other.actuators.into_iter().map(|actuator| self.actuator(actuator, &mut taken)).collect();
        let passive: Vec<Actuator> = other.passive.into_iter().map(|actuator| self.actuator(actuator, &mut taken)).collect();
        world.actuators.extend(actuators);
        world.passive.extend(passive);
        world.joint_forces.extend(self.all_named(other.joint_forces));
        world.couplings.extend(other.couplings.into_iter().map(|(coupling, at)| (self.coupling(coupling), at)));
        world.contact_masks.extend(self.all_named(other.contact_masks));
        let (tethers, effects): (Vec<_>, Vec<_>) = other.effects.into_iter().partition(|(effect, _)| effect.effect == EffectId::tether);
        let on_link = |(effect, _): (Applied, At)| (Applied { on: self.named(&effect.on), ..effect }, At::Nowhere);
        world.effects.extend(effects.into_iter().map(on_link));
        for (effect, at) in tethers {
            let place = Place { at, subject: &Subject::Link(self.named(&effect.on)), field: "stiffness" };
            let expected = "effects.tether of the scene: the spring of this free joint is to a pose in the world of its own file";
            self.warn(&place, Code::LostDynamics, "stiffness of a free joint of an appended robot".to_owned(), expected);
        }
        for plane in &other.planes {
            let place = Place { at: plane.place, subject: &Subject::Document, field: "plane" };
            let found = format!("the plane {} in a robot that is appended", quote(&plane.name));
            self.warn(&place, Code::NoContact, found, "a plane of the robot that carries it: this one makes no contact");
        }
        let named = |own: Loop| Loop {
            name: if own.name.is_empty() { own.name } else { self.named(&own.name) },
            between: own.between.iter().map(|name| self.named(name)).collect(),
            is_computed: false,
            place: At::Nowhere,
            ..own
        };
        world.loops.extend(other.loops.into_iter().map(named));
        // Limits, dry friction, equations and contacts of the other file are not appended.
        let is_constrained = other.touching.is_some_and(|own| {
            !(own.limits.is_empty() && own.friction.is_empty() && own.sums.is_empty() && own.pairs.is_empty() && own.unread.is_empty())
        });
        if let Some(touching) = world.touching.as_mut().filter(|_| is_constrained) {
            let what = format!("limits, dry friction, equations and contacts of the appended robot {:?}", self.prefix);
            touching.unread.push(Unread { kind: LeaveOut::Constraint, what, place: At::Nowhere });
        }
    }

    fn named(&self, name: &str) -> String {
        format!("{}{name}", self.prefix)
    }

    fn all_named<T>(&self, all: impl IntoIterator<Item = (String, T)>) -> Vec<(String, T)> {
        all.into_iter().map(|(name, value)| (self.named(&name), value)).collect()
    }

    fn warn(&mut self, place: &Place<'_>, code: Code, found: String, expected: &str) {
        self.warnings.push(Diagnostic::error(self.file, place, code, found, expected).into_warning());
    }

    /// Its lines are in another file than those of the robot that carries it.
    fn actuator(&mut self, actuator: Actuator, taken: &mut HashSet<String>) -> Actuator {
        let name = self.named(&actuator.name);
        let mut free = name.clone();
        let mut number = 2_usize;
        while taken.contains(&free) {
            free = format!("{name}_{number}");
            number += 1;
        }
        if free != name {
            let place = Place { at: actuator.place, subject: &Subject::Document, field: "actuator" };
            let found = format!("a second actuator {}", quote(&name));
            self.warn(&place, Code::DuplicateName, found, &format!("a name of its own, as a prefix gives it: it is {} here", quote(&free)));
        }
        taken.insert(free.clone());
        let frames = actuator.frames.map(|frames| frames.renamed(|link| self.named(link)));
        Actuator { name: free, frames, drives: self.all_named(actuator.drives), place: At::Nowhere, ..actuator }
    }

    fn coupling(&self, coupling: Coupling) -> Coupling {
        Coupling { joint: self.named(&coupling.joint), leaders: self.all_named(coupling.leaders), ..coupling }
    }

    /// States with controls for the actuators of both: `[own, appended]`. Missing controls of a
    /// state are 0, and missing joints have the file's initial coordinates.
    fn keyframes(&self, world: &mut World, other: Vec<Keyframe>, [own, appended]: [usize; 2]) {
        let full = |control: Vec<f64>, count: usize| if control.len() == count { control } else { vec![0.0; count] };
        for keyframe in &mut world.keyframes {
            keyframe.control = full(std::mem::take(&mut keyframe.control), own);
            keyframe.control.resize(own + appended, 0.0);
            keyframe.activation = full(std::mem::take(&mut keyframe.activation), own);
            keyframe.activation.resize(own + appended, 0.0);
        }
        for keyframe in other {
            let (q, v) = (self.all_named(keyframe.q), self.all_named(keyframe.v));
            let [control, activation] = [keyframe.control, keyframe.activation].map(|all| full(all, appended));
            match world.keyframes.iter_mut().find(|known| known.name == keyframe.name) {
                Some(known) => {
                    known.q.extend(q);
                    known.v.extend(v);
                    known.control.truncate(own);
                    known.control.extend(control);
                    known.activation.truncate(own);
                    known.activation.extend(activation);
                }
                None => {
                    let [control, activation] = [control, activation].map(|all| [vec![0.0; own], all].concat());
                    world.keyframes.push(Keyframe { name: self.named(&keyframe.name), q, v, control, activation, place: At::Nowhere });
                }
            }
        }
    }
}
