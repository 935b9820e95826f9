//! The curve of third degree through both ends of a step, for methods without a curve of their own.

use super::Start;
use crate::simulate::system::System;
use crate::simulate::{Control, SimulateError};

/// Slopes at both ends.
#[derive(Clone, Debug)]
pub(super) struct Hermite {
    first: Vec<f64>,
    last: Vec<f64>,
    ready: bool,
}

impl Hermite {
    pub(super) fn new(n: usize) -> Self {
        Self { first: vec![0.0; n], last: vec![0.0; n], ready: false }
    }

    /// The slopes are of an earlier step from now on.
    pub(super) fn forget(&mut self) {
        self.ready = false;
    }

    /// The slope at the end, if it is known.
    pub(super) fn last(&self) -> Option<&[f64]> {
        self.ready.then_some(&self.last)
    }

    /// One evaluation; two where the slope at the start is not known.
    pub(super) fn prepare(
        &mut self,
        system: &mut System<'_>,
        control: &mut dyn Control,
        start: Start,
        end: &[f64],
        known: bool,
    ) -> Result<(), SimulateError> {
        let h = start.h;
        if self.ready {
            return Ok(());
        }
        if known {
            self.first.copy_from_slice(start.f);
        } else {
            system.rate(control, start.t, start.y, &mut self.first)?;
        }
        system.rate(control, start.t + h, end, &mut self.last)?;
        self.ready = true;
        Ok(())
    }

    /// Hairer, Nørsett & Wanner 1993, (II.6.7).
    pub(super) fn between(&self, s: f64, start: &[f64], h: f64, end: &[f64], out: &mut [f64]) {
        for (i, out) in out.iter_mut().enumerate() {
            let (a, b) = (start[i], end[i]);
            let bend = (1.0 - 2.0 * s) * (b - a) + (s - 1.0) * h * self.first[i] + s * h * self.last[i];
            *out = (1.0 - s) * a + s * b + s * (s - 1.0) * bend;
        }
    }
}

/// The methods that a [`super::Method`] with the field `curve` of this kind delegates to it.
macro_rules! hand_on_to_hermite {
    () => {
        fn last_rate(&self) -> Option<&[f64]> {
            self.curve.last()
        }

        fn prepare(&mut self, system: &mut System<'_>, control: &mut dyn Control, start: Start, end: &[f64]) -> Result<(), SimulateError> {
            let known = Method::wants_rate(self);
            self.curve.prepare(system, control, start, end, known)
        }

        fn between(&self, theta: f64, start: Start, end: &[f64], out: &mut [f64]) {
            let h = start.h;
            self.curve.between(theta, start.y, h, end, out);
        }
    };
}
pub(super) use hand_on_to_hermite;
