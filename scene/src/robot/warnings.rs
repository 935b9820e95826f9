//! Warnings that robot edits raise or clear.

use std::collections::{HashMap, HashSet};

use articulated_core::Plain;
use articulated_core::description::{Collision, ContactSphere, JointKind, LinkId, PrincipalMoments};
use articulated_core::diagnostic::{At, Code, Diagnostic, Place, Subject, Unused};
use articulated_core::effect::{Applied, EffectId, effects};
use articulated_core::model::Model;
use articulated_formats::world::{Actuator, OnFrames};
use articulated_formats::{Reading, beyond_any_mass};

use super::build::Editing;
use crate::control::Drive;
use crate::effects::{indices, still};
use crate::scene::Scene;

/// The sun has 274 m/s².
const MOST_GRAVITY: f64 = 1000.0;

/// A coordinate, rad or m, beyond which double precision has fewer than ten digits of an angle
/// left.
const MOST_COORDINATE: f64 = 1e6;

/// A warning for each joint with an implausibly large coordinate in `q`, rad or m: sines of such
/// angles, and results computed from them, are rounding errors.
pub fn beyond_sense(model: &Model<f64>, q: &[f64]) -> Vec<String> {
    let joints = model.joints().iter().filter_map(|joint| {
        let own = q.get(joint.q.0..joint.q.0 + joint.q.1)?;
        let x = own.iter().find(|x| x.abs() > MOST_COORDINATE)?;
        Some(format!(
            "joint {:?}: found the coordinate {x:?}, expected at most 1e6 rad or m: beyond, rounding decides the results",
            joint.name
        ))
    });
    joints.collect()
}

/// A warning about a robot's edits.
fn warning(file: &str, place: &Place<'_>, code: Code, found: String, expected: impl Into<String>) -> Diagnostic {
    Diagnostic::error(file, place, code, found, expected).into_warning()
}

impl Editing<'_> {
    /// Warnings about the edits; removes findings that the edits made obsolete.
    pub(super) fn warn(&mut self, effects: &[Applied]) {
        self.let_go();
        self.warn_of_gravity();
        self.warn_of_limits();
        self.warn_of_followers();
        self.warn_of_loads();
        self.warn_of_moments();
        self.warn_of_masses();
        self.leave_what_is_used(effects);
        self.report_world();
        self.warn_of_activations();
    }

    /// Lists content of the file's world that the scene does not request.
    fn report_world(&mut self) {
        let (Reading { world, unused, .. }, scene) = (&mut self.reading, self.request.scene);
        let is_driven = scene.is_some_and(|scene| matches!(scene.control.drive, Drive::Actuators(_)));
        let is_placed = scene.is_some_and(|scene| scene.initial.keyframe.is_some());
        let is_stepped = scene
            .and_then(|scene| scene.simulation.as_ref())
            .is_some_and(|simulation| simulation.file_step.is_some() || simulation.law.is_some());
        let count = |n: usize, what: &str| if n == 1 { format!("one {what}") } else { format!("{n} {what}s") };
        let mut list = |tag: &str, place: At, why: String| {
            unused.push(Unused { line: place.line(), subject: Subject::Document, tag: tag.to_owned(), why });
        };
        let control = "used in scenes with control = { kind = \"actuators\" }, and by functions of the group actuators";
        for (tag, all, what) in [("actuator", &world.actuators, "actuator"), ("tendon", &world.passive, "spring or damper of tendon")] {
            if let Some(first) = all.first().filter(|_| !is_driven) {
                list(tag, first.place, format!("{}: {control}", count(all.len(), what)));
            }
        }
        for row in effects() {
            let asked = |scene: &Scene| scene.effects.iter().any(|one| one.effect == row.id);
            let mut own = world.effects.iter().filter(|(own, _)| own.effect == row.id);
            let count_of = own.clone().count();
            if let Some((_, place)) = own.next().filter(|_| !scene.is_some_and(asked)) {
                let why = format!("{}: used in scenes with effects.{} = \"file\"", count(count_of, "link"), row.name);
                list(row.name, *place, why);
            }
        }
        if let Some(first) = world.keyframes.first().filter(|_| !is_placed) {
            list(
                "keyframe",
                first.place,
                format!("{}: used in scenes with initial = {{ keyframe = … }}", count(world.keyframes.len(), "state")),
            );
        }
        if let Some(step) = world.step.filter(|_| !is_stepped) {
            let why = format!("{} s: used in scenes with simulation = {{ step = \"file\" }}", Plain(step));
            list("option timestep", At::Nowhere, why);
        }
    }

    /// A scene has no states but those of the robot, and torques of joints: actuators with an
    /// activation, those of sites, and spatial tendons give no force in it.
    fn warn_of_activations(&mut self) {
        let Some(control) = self.request.scene.filter(|scene| scene.law().is_none()).map(|scene| &scene.control) else { return };
        if !matches!(control.drive, Drive::Actuators(_)) {
            return;
        }
        let Reading { world, warnings, .. } = &mut self.reading;
        let is_left = |name: &str| control.without.iter().any(|(left, _)| left == name);
        let is_lost = |own: &&Actuator| (own.activation.is_some() || own.frames.is_some()) && !is_left(&own.name);
        let all = world.actuators.iter().map(|own| ("actuator", own)).chain(world.passive.iter().map(|own| ("tendon", own)));
        // A spring that is slack between two lengths is several laws of one name.
        let mut named = HashSet::new();
        for (sort, actuator) in all.filter(|(sort, own)| is_lost(own) && named.insert((*sort, own.name.clone()))) {
            let place = Place { at: actuator.place, subject: &Subject::Document, field: sort };
            let what = match actuator.frames {
                Some(OnFrames::Site(_)) => "a site",
                Some(OnFrames::Path(_)) => "the path",
                None => "an activation",
            };
            let found = format!("{what} of the {sort} {:?}, which gives no force in a scene without `law`", actuator.name);
            let expected = "`articulated simulate FILE --smooth` or `articulated rollout`, which step it, or `without` in [control]";
            warnings.push(warning(self.request.file, &place, Code::LostDynamics, found, expected));
        }
    }

    /// Mass behind a shaft moves, and so does mass that the shaft has taken over.
    fn let_go(&mut self) {
        if self.request.options.shafts.is_empty() {
            return;
        }
        let description = &self.reading.description;
        let still = still(description, self.request.options.base);
        let held = description.links.iter().zip(still).filter(|(link, still)| *still && link.inertial.is_some());
        let held: HashSet<String> = held.map(|(link, _)| link.name.clone()).collect();
        self.reading.release(|link| !held.contains(link));
    }

    /// Warns of implausible gravity.
    fn warn_of_gravity(&mut self) {
        let gravity = self.request.options.gravity_in(&self.reading.world);
        let size = gravity.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        if size > MOST_GRAVITY {
            self.reading.warnings.push(warning(
                self.request.file,
                &Place { at: At::Nowhere, subject: &Subject::Document, field: "gravity" },
                Code::BeyondSense,
                format!("{gravity:?} m/s², more than any star's"),
                "m/s², of which 9.81 are usual; used as written",
            ));
        }
    }

    /// A lock beyond the joint's limits is used, with a warning.
    fn warn_of_limits(&mut self) {
        let joints = &self.reading.description.joints;
        let of_name = indices(joints.iter().map(|j| j.name.as_str()));
        let problems = self.request.options.lock.iter().filter_map(|lock| {
            let (name, at) = &lock.value;
            let joint = &joints[*of_name.get(name.as_str())?];
            let limit = joint.limit.filter(|_| joint.locked.is_some())?;
            let beyond = |found: String, expected: String| {
                let place = Place { at: At::Nowhere, subject: &Subject::Joint(name.clone()), field: "lock" };
                warning(self.request.file, &place, Code::BeyondLimit, found, expected)
            };
            if let (JointKind::Spherical, &[x, y, z, w]) = (joint.kind, at.as_slice()) {
                // The angle of the rotation from the identity, rad
                let angle = 2.0 * (x * x + y * y + z * z).sqrt().atan2(w.abs());
                // Rounding of the numbers in the scene is tolerated.
                return (limit.upper > 0.0 && angle > limit.upper * (1.0 + 1e-9)).then(|| {
                    beyond(
                        format!("a rotation by {angle:.6} rad, beyond its limit"),
                        format!("at most {} rad; used as given", Plain(limit.upper)),
                    )
                });
            }
            let &[at] = at.as_slice() else { return None };
            (at < limit.lower || limit.upper < at).then(|| {
                beyond(
                    format!("{}, beyond its limits", Plain(at)),
                    format!("{} to {}; used as given", Plain(limit.lower), Plain(limit.upper)),
                )
            })
        });
        self.reading.warnings.extend(problems.collect::<Vec<_>>());
    }

    /// Warns of a follower by a polynomial that leaves its limits, as its leader moves within its
    /// own.
    fn warn_of_followers(&mut self) {
        let joints = &self.reading.description.joints;
        let problems = joints.iter().filter_map(|joint| {
            let mimic = joint.mimic.filter(|mimic| mimic.degree() > 1)?;
            let leader = joints.get(mimic.joint)?;
            let (own, led) = (joint.limit?, leader.limit.filter(|led| led.lower <= led.upper && (led.upper - led.lower).is_finite())?);
            let [least, most] = mimic.law().range(led.lower, led.upper);
            (own.lower <= own.upper && (least < own.lower || own.upper < most)).then(|| {
                let place = Place { at: At::Nowhere, subject: &Subject::Joint(joint.name.clone()), field: "coupling" };
                let found = format!("a range of {least:.4} to {most:.4}, as joint {:?} moves within its limits", leader.name);
                let expected = format!("a range within this joint's limits, {} to {}; used as given", Plain(own.lower), Plain(own.upper));
                warning(self.request.file, &place, Code::MimicRange, found, expected)
            })
        });
        self.reading.warnings.extend(problems.collect::<Vec<_>>());
    }

    /// Warns of a load on a link that the base holds: it has no effect.
    fn warn_of_loads(&mut self) {
        let (options, description) = (&self.request.options, &self.reading.description);
        let still = still(description, options.base);
        let links = indices(description.links.iter().map(|l| l.name.as_str()));
        // The first frame of a name is the last that is inserted.
        let frames: HashMap<&str, LinkId> = description.frames.iter().rev().map(|frame| (frame.name.as_str(), frame.link)).collect();
        let carrier = |name: &str| links.get(name).copied().or_else(|| frames.get(name).copied());
        let held = |name: &str| carrier(name).is_some_and(|at| still.get(at).copied().unwrap_or_default());
        let loads = options.payloads.iter().filter(|load| load.mass != 0.0 && held(&load.link)).map(|load| {
            warning(
                self.request.file,
                &Place { at: At::Nowhere, subject: &Subject::Link(load.link.clone()), field: "payload" },
                Code::UnusedInertia,
                format!("{} kg on a link that a fixed base holds", load.mass),
                "a link that moves: here it plays no part in the dynamics",
            )
        });
        self.reading.warnings.extend(loads.collect::<Vec<_>>());
    }

    /// Warns of a load with an implausible mass.
    fn warn_of_masses(&mut self) {
        let odd = self.request.options.payloads.iter().filter_map(|load| {
            let (found, expected) = beyond_any_mass(load.mass)?;
            let place = Place { at: At::Nowhere, subject: &Subject::Link(load.link.clone()), field: "payload" };
            Some(warning(self.request.file, &place, Code::Units, found, expected))
        });
        self.reading.warnings.extend(odd);
    }

    /// An inertia of a load that no body can have is used, with a warning, as that of a link is.
    fn warn_of_moments(&mut self) {
        let odd = self.request.options.payloads.iter().filter_map(|load| {
            let moments = PrincipalMoments::of(load.inertia);
            moments.miss_triangle().then(|| {
                warning(
                    self.request.file,
                    &Place { at: At::Nowhere, subject: &Subject::Link(load.link.clone()), field: "payload" },
                    Code::InertiaTriangle,
                    moments.to_string(),
                    format!("{}; used as given", PrincipalMoments::TRIANGLE),
                )
            })
        });
        self.reading.warnings.extend(odd);
    }

    /// Collision geometry of links that have contact at its points is used.
    fn leave_geometry_that_is_used(&mut self, effects: &[Applied]) {
        let Reading { description, unused, .. } = &mut self.reading;
        let links = indices(description.links.iter().map(|link| link.name.as_str()));
        let is_of_shape = |e: &Applied| {
            let spheres = links.get(e.on.as_str()).map(|at| &description.links[*at]).into_iter().flat_map(|link| &link.collision);
            let is = |s: ContactSphere| s.center == e.at.xyz && e.parameters.first() == Some(&s.radius);
            spheres.flat_map(Collision::contact_spheres).any(is)
        };
        let contacts = effects.iter().filter(|e| e.effect == EffectId::contact);
        let used: HashSet<&str> = contacts.filter(|e| is_of_shape(e)).map(|e| e.on.as_str()).collect();
        unused.retain(|u| u.tag != "collision" || !matches!(&u.subject, Subject::Link(name) if used.contains(name.as_str())));
    }

    /// Numbers of the file that an effect has taken are used.
    fn leave_what_is_used(&mut self, effects: &[Applied]) {
        self.leave_geometry_that_is_used(effects);
        let Reading { description, unused, .. } = &mut self.reading;
        let joints = indices(description.joints.iter().map(|j| j.name.as_str()));
        let tags = |e: &Applied| {
            let dynamics = description.joints[*joints.get(e.on.as_str())?].dynamics;
            // Numbers of the file by their index among those of the effect.
            let [damping, stiffness] =
                [dynamics.damping_terms, dynamics.stiffness_terms].map(|terms| [0, 1].map(|k| terms.map(|own| own[k])));
            let numbers: &[(usize, &str, Option<f64>)] = match e.effect {
                EffectId::polynomial_damping => &[(0, "joint damping, quadratic", damping[0]), (1, "joint damping, cubic", damping[1])],
                EffectId::polynomial_spring => &[
                    (0, "joint stiffness, quadratic", stiffness[0]),
                    (1, "joint stiffness, cubic", stiffness[1]),
                    (2, "joint springref", dynamics.rest),
                ],
                EffectId::damping => &[(0, "dynamics damping", dynamics.damping)],
                EffectId::friction => &[(0, "dynamics friction", dynamics.friction)],
                EffectId::armature => &[(0, "joint armature", dynamics.armature)],
                EffectId::spring => &[(0, "joint stiffness", dynamics.stiffness), (1, "joint springref", dynamics.rest)],
                _ => return None,
            };
            let used = numbers.iter().filter(|(k, _, number)| number.is_some() && e.parameters.get(*k).copied() == *number);
            Some(used.map(|(_, tag, _)| *tag).collect::<Vec<_>>())
        };
        let used: HashSet<(&str, &str)> =
            effects.iter().flat_map(|e| tags(e).unwrap_or_default().into_iter().map(|tag| (e.on.as_str(), tag))).collect();
        unused.retain(|u| !matches!(&u.subject, Subject::Joint(name) if used.contains(&(name.as_str(), u.tag.as_str()))));
    }
}
