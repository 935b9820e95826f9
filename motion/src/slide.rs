//! Contacts that move although friction would hold them.
//!
//! An undamped contact vibrates at rest, and slides a little whenever it presses less. Over a while
//! it needs less than the available friction, and moves all the same.

use std::fmt;

use articulated::simulate::SLIDING;
use articulated_core::Plain;
use articulated_core::spatial::Vector3;

use crate::touch::{Contact, Touch};

/// A link with contacts that move although friction would hold them.
#[derive(Clone, Debug, PartialEq)]
pub struct Slide {
    /// The scene's file.
    pub file: String,
    /// The link.
    pub on: String,
    /// Its path while sliding, m.
    pub distance: f64,
    /// For how long, s.
    pub time: f64,
    /// The mean force across the normal, relative to the maximum friction force.
    pub part: f64,
    /// A damping time that damps the contacts under their load critically, s: 2 √(m/k), with the
    /// mass m that rests on each.
    pub damping_time: f64,
}

/// Length of the windows over which forces are averaged, s.
const WINDOW: f64 = 0.2;

/// A link that is off the plane for longer, s, lifts its contacts: it does not rest.
const LIFTED: f64 = 0.1;

/// Part of friction up to which it would hold.
const HOLDS: f64 = 0.9;

/// Minimum number of windows for a report: a landing is in one or two.
const SEVERAL: u32 = 3;

/// The contacts of one link, step by step.
pub(crate) struct Sliding {
    on: String,
    /// Indices among the scene's contacts.
    members: Vec<usize>,
    window: Window,
    /// Windows with sliding, and their path, m, and time, s.
    windows: u32,
    distance: f64,
    time: f64,
    /// Impulse across the normal and the maximum impulse of friction, N·s, over the windows that
    /// count.
    impulses: [f64; 2],
    /// Mean mass on a contact over its stiffness, kg·m/N, times time.
    loaded: f64,
}

/// A window so far.
#[derive(Clone, Default)]
struct Window {
    time: f64,
    /// Displacement of the mean of the contacts along the plane, m.
    way: Vector3<f64>,
    /// ∫F_t dt and ∫μF_n dt, N·s.
    across: Vector3<f64>,
    friction: f64,
    /// ∫F_n/k dt, m·s, the mean of the contacts that press.
    depth: f64,
    /// Time since the last contact that pressed, s, and the longest so far.
    off: f64,
    longest_off: f64,
}

impl Sliding {
    /// One for each link with contacts.
    pub(crate) fn of(contacts: &[Contact]) -> Vec<Self> {
        let mut links: Vec<Self> = Vec::new();
        for (k, contact) in contacts.iter().enumerate() {
            match links.iter_mut().find(|link| link.on == contact.on) {
                Some(link) => link.members.push(k),
                None => links.push(Self {
                    on: contact.on.clone(),
                    members: vec![k],
                    window: Window::default(),
                    windows: 0,
                    distance: 0.0,
                    time: 0.0,
                    impulses: [0.0; 2],
                    loaded: 0.0,
                }),
            }
        }
        links
    }

    /// A step of this time, s.
    pub(crate) fn step(&mut self, contacts: &[Contact], time: f64, before: &[Touch], after: &[Touch]) {
        let window = &mut self.window;
        let (mut pressing, mut depth, mut speed) = (0.0_f64, 0.0, 0.0_f64);
        for &k in &self.members {
            let (contact, a, b) = (&contacts[k], &before[k], &after[k]);
            let press = 0.5 * (a.press + b.press);
            window.way += contact.slip(a, b) / self.members.len() as f64;
            window.across += (a.drag + b.drag) * (0.5 * time);
            window.friction += contact.friction * press * time;
            if a.presses || b.presses {
                (pressing, depth) = (pressing + 1.0, depth + press / contact.stiffness);
            }
            speed = speed.max(contact.speed);
        }
        window.time += time;
        if pressing > 0.0 {
            window.depth += depth / pressing * time;
            window.off = 0.0;
        } else {
            window.off += time;
        }
        window.longest_off = window.longest_off.max(window.off);
        if window.time >= WINDOW {
            self.close(speed);
        }
    }

    fn close(&mut self, speed: f64) {
        let Window { time, way, across, friction, depth, off, longest_off } = std::mem::take(&mut self.window);
        self.window.off = off;
        let rests = longest_off <= LIFTED && friction > 0.0;
        if rests && way.norm() > SLIDING * speed * time && across.norm() < HOLDS * friction {
            self.windows += 1;
            (self.distance, self.time, self.loaded) = (self.distance + way.norm(), self.time + time, self.loaded + depth);
            self.impulses = [self.impulses[0] + across.norm(), self.impulses[1] + friction];
        }
    }

    /// The link, if it slid for several windows. `gravity`: m/s².
    pub(crate) fn found(self, file: &str, gravity: f64) -> Option<Slide> {
        (self.windows >= SEVERAL).then(|| Slide {
            file: file.to_owned(),
            on: self.on,
            distance: self.distance,
            time: self.time,
            part: self.impulses[0] / self.impulses[1],
            damping_time: 2.0 * (self.loaded / self.time / gravity.max(f64::MIN_POSITIVE)).sqrt(),
        })
    }
}

impl fmt::Display for Slide {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { file, on, .. } = self;
        let [distance, time, part, damping] =
            [self.distance, self.time, self.part, self.damping_time].map(crate::penetration::rounded).map(Plain);
        write!(
            f,
            "{file}: effects.contact.{on}: slides although its cone holds: found {distance} m in {time} s with {part} of its friction, expected rest: \
             its contacts vibrate; damping_time = {damping} damps them under their load"
        )
    }
}
