//! The motion between the ends of a step.

use super::integrator::{Method, Start};
use super::system::System;
use super::{Control, SimulateError};

/// The last step's curve, and memory for a point of it.
pub(crate) struct Curve<'a> {
    pub(crate) method: &'a mut dyn Method,
    pub(crate) start: Start<'a>,
    pub(crate) end: &'a [f64],
    pub(crate) point: &'a mut Point,
}

/// A point of a motion.
#[derive(Clone, Debug)]
pub(crate) struct Point {
    pub(crate) t: f64,
    /// In the chart of the step.
    pub(crate) y: Vec<f64>,
    pub(crate) q: Vec<f64>,
}

impl Point {
    pub(crate) fn new(nq: usize, n: usize) -> Self {
        Self { t: 0.0, y: vec![0.0; n], q: vec![0.0; nq] }
    }
}

impl Curve<'_> {
    /// Computes the data of the curve.
    pub(crate) fn prepare(&mut self, system: &mut System<'_>, control: &mut dyn Control) -> Result<(), SimulateError> {
        self.method.prepare(system, control, self.start, self.end)
    }

    /// The point at t + θ·h; at the ends the ends themselves.
    pub(crate) fn at(&mut self, system: &mut System<'_>, theta: f64) -> Result<&Point, SimulateError> {
        let Point { t, y, q } = &mut *self.point;
        *t = self.start.t + theta * self.start.h;
        if theta <= 0.0 {
            y.copy_from_slice(self.start.y);
        } else if theta >= 1.0 {
            y.copy_from_slice(self.end);
        } else {
            self.method.between(theta, self.start, self.end, y);
        }
        system.configuration(&y[..system.manifold.nv], q)?;
        Ok(self.point)
    }
}
