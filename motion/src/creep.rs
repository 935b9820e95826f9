//! Creep of a robot where smoothed friction should hold it.

use articulated::simulate::SLIDING;
use articulated_core::effect::EffectId;

use crate::freedom::Freedom;
use crate::session::Session;
use crate::touch::{Contact, Touch};

/// A contact or joint that crept, and how far.
#[derive(Clone, Debug, PartialEq)]
pub struct Creep {
    /// `contact` or `friction`.
    pub effect: EffectId,
    /// The link of the contact, or the joint.
    pub on: String,
    /// Length of the path that it crept, m or rad.
    pub distance: f64,
    /// Time spent creeping, s.
    pub time: f64,
}

impl Creep {
    fn none(effect: EffectId, on: String) -> Self {
        Self { effect, on, distance: 0.0, time: 0.0 }
    }

    /// Adds an interval, s, with this distance, if its speed is not sliding.
    fn add(&mut self, distance: f64, time: f64, speed: f64) {
        if time > 0.0 && distance <= SLIDING * speed * time {
            (self.distance, self.time) = (self.distance + distance, self.time + time);
        }
    }
}

/// Creep of the contacts and joints of a scene, step by step: in a step a contact creeps if it
/// presses at both ends and its centre moves along the plane, and a joint creeps if it moves,
/// slower than [`SLIDING`] times the smoothing speed of its friction.
pub(crate) struct Creeping<'s> {
    joints: Vec<(Freedom<'s>, f64, Creep)>,
    contacts: Vec<Creep>,
}

impl<'s> Creeping<'s> {
    pub(crate) fn of(session: &'s Session, contacts: &[Contact]) -> Self {
        let joint = |at: Freedom<'s>| {
            let speed = *at.effect(EffectId::friction)?.parameters.get(1)?;
            let creep = Creep::none(EffectId::friction, session.name_of(&at));
            Some((at, speed, creep))
        };
        let contacts = contacts.iter().map(|contact| Creep::none(EffectId::contact, contact.on.clone())).collect();
        Self { joints: session.freedoms().filter_map(joint).collect(), contacts }
    }

    /// A step of this time, s, between these states q `[nq]` and v `[nv]`.
    pub(crate) fn step_of_joints(&mut self, time: f64, before: [&[f64]; 2], after: [&[f64]; 2]) {
        for (at, speed, creep) in &mut self.joints {
            // By rates: the coordinates of a ball joint are a quaternion.
            let [a, b] = [before, after].map(|[q, v]| at.own.rate(q, v).abs());
            if a.max(b) <= SLIDING * *speed {
                creep.add(0.5 * (a + b) * time, time, *speed);
            }
        }
    }

    /// The same step of contact k. A sphere that rolls without slipping moves its centre: that
    /// counts as a distance here.
    pub(crate) fn step_of_contact(&mut self, k: usize, contact: &Contact, time: f64, before: &Touch, after: &Touch) {
        if before.presses && after.presses {
            self.contacts[k].add(contact.along_plane(after.centre - before.centre).norm(), time, contact.speed);
        }
    }

    /// The contact and the joint that crept furthest, of each kind at most one.
    pub(crate) fn found(self) -> Vec<Creep> {
        let joint = furthest(self.joints.into_iter().map(|(.., creep)| creep));
        [furthest(self.contacts.into_iter()), joint].into_iter().flatten().collect()
    }
}

/// The creep with the longest path; `None` if nothing crept.
fn furthest(all: impl Iterator<Item = Creep>) -> Option<Creep> {
    all.filter(|creep| creep.time > 0.0).max_by(|a, b| a.distance.total_cmp(&b.distance))
}
