//! Contacts that roll faster than the tolerance resolves.

use std::fmt;

use articulated::simulate::{SLIDING, Settings};
use articulated_core::Plain;

use crate::touch::{Contact, Touch};

/// A sphere that rolls so fast that the tolerance of its rates exceeds the sliding speed below
/// which its friction is smooth: steps are rejected, or pass over the layer.
#[derive(Clone, Debug, PartialEq)]
pub struct Rolling {
    /// The scene's file.
    pub file: String,
    /// The link.
    pub on: String,
    /// Largest sum of the two speeds whose difference is the sliding speed, m/s: the centre's
    /// speed, and that of the lowest point about the centre.
    pub rates: f64,
    /// The smoothing speed of its friction, m/s.
    pub speed: f64,
    /// Error of the sliding speed by the tolerance, m/s.
    pub tolerance: f64,
    /// The relative tolerance.
    pub rtol: f64,
}

/// Minimum part of the motion for a report.
const PART: f64 = 0.01;

/// The rolling contacts of a motion, step by step.
pub(crate) struct Rollers {
    /// Relative error of a difference of rates: the norm of the error is a mean over all numbers of
    /// a step, so one number may have a larger error.
    unknown: f64,
    rtol: f64,
    /// Of each contact the time that it rolls unresolved, s, and the largest rates, m/s.
    each: Vec<(f64, f64)>,
    total: f64,
}

impl Rollers {
    /// Of contacts on a robot with `nv` degrees of freedom. Fixed steps have no tolerance.
    pub(crate) fn of(contacts: &[Contact], settings: &Settings, nv: usize) -> Self {
        let rtol = if settings.step.is_some() { 0.0 } else { settings.rtol };
        Self { unknown: (2.0 * nv as f64).sqrt() * rtol, rtol, each: vec![(0.0, 0.0); contacts.len()], total: 0.0 }
    }

    /// A step of this time, s.
    pub(crate) fn step(&mut self, contacts: &[Contact], time: f64, before: &[Touch], after: &[Touch]) {
        self.total += time;
        for ((k, contact), (rolls, most)) in contacts.iter().enumerate().zip(&mut self.each) {
            let (a, b) = (&before[k], &after[k]);
            let rates = a.rates.min(b.rates);
            let sticks = a.presses && b.presses && a.sliding.max(b.sliding) < SLIDING * contact.speed;
            if sticks && contact.friction > 0.0 && self.unknown * rates > contact.speed {
                (*rolls, *most) = (*rolls + time, most.max(rates));
            }
        }
    }

    /// Those that roll unresolved for this part of the motion; the fastest one of each link.
    pub(crate) fn found(self, contacts: &[Contact], file: &str) -> Vec<Rolling> {
        let mut found: Vec<Rolling> = Vec::new();
        for (contact, (rolls, rates)) in contacts.iter().zip(self.each) {
            if rolls <= PART * self.total {
                continue;
            }
            let tolerance = self.unknown * rates;
            let one = Rolling { file: file.to_owned(), on: contact.on.clone(), rates, speed: contact.speed, tolerance, rtol: self.rtol };
            match found.iter_mut().find(|other| other.on == one.on) {
                Some(other) if other.rates >= one.rates => {}
                Some(other) => *other = one,
                None => found.push(one),
            }
        }
        found
    }
}

impl fmt::Display for Rolling {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { file, on, .. } = self;
        let round = |x: f64| Plain(crate::penetration::rounded(x));
        let (speed, tolerance, rates, rtol) = (Plain(self.speed), round(self.tolerance), round(0.5 * self.rates), Plain(self.rtol));
        let expected = round(0.1 * self.rtol * self.speed / self.tolerance);
        write!(
            f,
            "{file}: effects.contact.{on}.speed: found {speed} m/s, which rtol = {rtol} does not resolve where it rolls at {rates} m/s: its sliding speed is \
             known to {tolerance} m/s; expected rtol = {expected}, or a larger speed; the motion is slow, and less exact"
        )
    }
}
