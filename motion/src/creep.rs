//! Creep of a robot where smoothed friction should hold it.

use articulated::Dynamics;
use articulated::simulate::{Recording, SLIDING};
use articulated_core::effect::{Applied, EffectId, unit};

use crate::freedom::Freedom;
use crate::session::{Session, field};

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

impl Session {
    /// The contact and the joint with dry friction that crept furthest in a motion of the scene, of
    /// each kind at most one.
    ///
    /// It is judged by the records: from one to the next a contact creeps if it presses at both and
    /// its point moves along the plane, and a joint creeps if it moves, slower than [`SLIDING`]
    /// times the smoothing speed of its friction. With few records there is little to judge by:
    /// nothing is found then.
    pub fn creep(&self, recording: &Recording) -> Vec<Creep> {
        [self.creep_of_contacts(recording), self.creep_of_joints(recording)].into_iter().flatten().collect()
    }

    fn creep_of_joints(&self, recording: &Recording) -> Option<Creep> {
        let creep = |at: Freedom<'_>| {
            let speed = *at.effect(EffectId::friction)?.parameters.get(1)?;
            let mut creep = Creep { effect: EffectId::friction, on: self.name_of(&at), distance: 0.0, time: 0.0 };
            for k in 1..recording.len() {
                let time = recording.t[k] - recording.t[k - 1];
                let [a, b] = [k - 1, k].map(|k| at.own_rate(recording.v_at(k)).abs());
                // By rates: the coordinates of a ball joint are a quaternion.
                if a.max(b) <= SLIDING * speed {
                    creep.add(0.5 * (a + b) * time, time, speed);
                }
            }
            Some(creep)
        };
        furthest(self.freedoms().filter_map(creep))
    }

    fn creep_of_contacts(&self, recording: &Recording) -> Option<Creep> {
        let contacts: Vec<Contact> = self.effects_of(EffectId::contact).filter_map(|applied| Contact::of(self, applied)).collect();
        if contacts.is_empty() {
            return None;
        }
        let mut creeps: Vec<Creep> = contacts.iter().map(|contact| contact.creep.clone()).collect();
        let (mut ws, mut places) = (self.model.workspace(), vec![0.0; 12 * self.model.frames().len()]);
        // The lowest point of each sphere, and whether it presses.
        let mut before: Vec<Option<[f64; 3]>> = vec![None; contacts.len()];
        for k in 0..recording.len() {
            self.model.placements(&mut ws, recording.q_at(k), &mut places).ok()?;
            for ((contact, creep), before) in contacts.iter().zip(&mut creeps).zip(&mut before) {
                let now = contact.pressed_at(&places);
                if let (Some(a), Some(b)) = (*before, now) {
                    creep.add(contact.along_plane(a, b), recording.t[k] - recording.t[k - 1], contact.speed);
                }
                *before = now;
            }
        }
        furthest(creeps.into_iter())
    }
}

impl Creep {
    /// One more interval, s, with this distance, if that is no sliding.
    fn add(&mut self, distance: f64, time: f64, speed: f64) {
        if time > 0.0 && distance <= SLIDING * speed * time {
            (self.distance, self.time) = (self.distance + distance, self.time + time);
        }
    }
}

/// The one with the longest path; `None` if nothing crept.
fn furthest(all: impl Iterator<Item = Creep>) -> Option<Creep> {
    all.filter(|creep| creep.time > 0.0).max_by(|a, b| a.distance.total_cmp(&b.distance))
}

/// A contact, for creep detection.
struct Contact {
    frame: usize,
    point: [f64; 3],
    normal: [f64; 3],
    /// Distance of the centre from the origin along the normal, m, below which it presses.
    reach: f64,
    speed: f64,
    creep: Creep,
}

impl Contact {
    fn of(session: &Session, applied: &Applied) -> Option<Self> {
        let one = |name: &str| field(applied, name).first().copied();
        Some(Self {
            frame: session.model.frames().iter().position(|frame| frame.name == applied.on)?,
            point: applied.at.xyz,
            normal: unit(field(applied, "normal").try_into().ok()?)?,
            reach: one("height")? + one("radius")?,
            speed: one("speed")?,
            creep: Creep { effect: EffectId::contact, on: applied.on.clone(), distance: 0.0, time: 0.0 },
        })
    }

    /// The centre of the sphere in the world frame, m, where it presses. A sphere that rolls
    /// without slipping moves its centre: that counts as a distance here.
    fn pressed_at(&self, places: &[f64]) -> Option<[f64; 3]> {
        let x = places.get(12 * self.frame..12 * (self.frame + 1))?;
        let centre = [0, 1, 2].map(|k| x[9 + k] + (0..3).map(|c| x[3 * k + c] * self.point[c]).sum::<f64>());
        let height: f64 = centre.iter().zip(self.normal).map(|(x, n)| x * n).sum();
        (height < self.reach).then_some(centre)
    }

    /// Distance of two points along the plane, m.
    fn along_plane(&self, a: [f64; 3], b: [f64; 3]) -> f64 {
        let way = [0, 1, 2].map(|k| b[k] - a[k]);
        let up: f64 = way.iter().zip(self.normal).map(|(x, n)| x * n).sum();
        (0..3).map(|k| (way[k] - up * self.normal[k]).powi(2)).sum::<f64>().sqrt()
    }
}
