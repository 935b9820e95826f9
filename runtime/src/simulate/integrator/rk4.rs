//! The classical Runge–Kutta method: four stages, order 4.

use super::hermite::{Hermite, hand_on_to_hermite};
use super::stages::Stages;
use super::{Method, Start, largest_of_polynomial};
use crate::simulate::step_control::{Error, Norm};
use crate::simulate::system::System;
use crate::simulate::{Control, SimulateError};

pub(crate) struct Rk4 {
    stages: Stages,
    curve: Hermite,
}

impl Rk4 {
    pub(super) fn new(n: usize, looks: bool) -> Self {
        Self { stages: Stages::new(n, 4, looks), curve: Hermite::new(n) }
    }
}

impl Method for Rk4 {
    fn step(
        &mut self,
        system: &mut System<'_>,
        control: &mut dyn Control,
        start: Start,
        end: &mut [f64],
        _: &Norm,
    ) -> Result<Error, SimulateError> {
        let h = start.h;
        self.curve.forget();
        let k = &mut self.stages;
        k.begin(start);
        k.stage(system, control, start, 1, 0.5, &[0.5])?;
        k.stage(system, control, start, 2, 0.5, &[0.0, 0.5])?;
        k.stage(system, control, start, 3, 1.0, &[0.0, 0.0, 1.0])?;
        k.combine(start.y, h, &[1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0], end);
        Ok(Error { size: 0.0, index: 0 })
    }

    hand_on_to_hermite!();

    fn amplification(&self, a: f64, b: f64, h: f64) -> Option<f64> {
        Some(largest_of_polynomial(&[1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0], a, b, h))
    }

    fn fastest(&self) -> Option<(f64, [&[f64]; 2])> {
        Some(self.stages.fastest().seen())
    }
}
