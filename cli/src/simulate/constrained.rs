//! How well a motion keeps its constraints.

use serde::Serialize;

use crate::touching::{FOUND, Touching};

/// How limits, dry friction and contacts were kept at the recorded times.
#[derive(Clone, Debug, Default, Serialize)]
pub(super) struct Constrained {
    /// The most contacts at once.
    pub(super) most_contacts: usize,
    /// The largest bound of the error of an acceleration, see [`Touching::relative_error`].
    pub(super) largest_relative_error: f64,
    /// The most steps of Newton's method.
    pub(super) most_search_steps: u32,
    /// The first time at which the search did not find the acceleration, s.
    pub(super) not_found_at_s: Option<f64>,
}

impl Constrained {
    pub(super) fn add(&mut self, t: f64, touching: &Touching) {
        self.most_contacts = self.most_contacts.max(touching.contacts.len());
        self.most_search_steps = self.most_search_steps.max(touching.search_steps);
        let error = touching.relative_error;
        if error.is_nan() || error > self.largest_relative_error {
            self.largest_relative_error = error;
        }
        if !touching.is_found() {
            self.not_found_at_s.get_or_insert(t);
        }
    }

    /// Of accelerations that were not found.
    pub(super) fn warning(&self, file: &str) -> Option<String> {
        let error = self.largest_relative_error;
        self.not_found_at_s.map(|t| {
            format!("{file}: the search of accelerations with constraints did not end at t = {t} s: relative error {error:.1e}, expected {FOUND:e}")
        })
    }
}
