//! Integrators, one file each: one step in the chart of the manifold, an error, a curve between.

mod dop853;
mod dop853_coefficients;
mod dopri5;
mod hermite;
mod lie_midpoint;
mod lu;
mod rk4;
mod rodas4;
mod semi_implicit_euler;
mod stages;

use super::manifold::Manifold;
use super::step_control::{Controller, Error, Norm};
use super::system::System;
use super::{Control, IntegratorId, SimulateError};

/// The start of a step: time, y with u = 0, dy/dt (only for methods that request it), and its
/// length h.
#[derive(Clone, Copy)]
pub(crate) struct Start<'a> {
    pub(crate) t: f64,
    pub(crate) h: f64,
    pub(crate) y: &'a [f64],
    pub(crate) f: &'a [f64],
}

/// The interface of an integrator. All vectors have the length of y.
pub(crate) trait Method {
    /// Starts another motion.
    fn reset(&mut self) {}

    /// One step from `start` to `end`; its error in `norm` if the method estimates one, else zero.
    fn step(
        &mut self,
        system: &mut System<'_>,
        control: &mut dyn Control,
        start: Start,
        end: &mut [f64],
        norm: &Norm,
    ) -> Result<Error, SimulateError>;

    /// dy/dt at the end of the last step, if it was computed, in the chart of that step.
    fn last_rate(&self) -> Option<&[f64]> {
        None
    }

    /// Whether a step needs dy/dt at its start.
    fn wants_rate(&self) -> bool {
        true
    }

    /// Completes an accepted step.
    fn finish(&mut self, _: &mut System<'_>, _: &mut dyn Control, _: Start, _: &mut [f64]) -> Result<(), SimulateError> {
        Ok(())
    }

    /// Prepares [`Method::between`] for the last step.
    fn prepare(&mut self, system: &mut System<'_>, control: &mut dyn Control, start: Start, end: &[f64]) -> Result<(), SimulateError>;

    /// y at t + θ·h of the last step, θ from 0 to 1.
    fn between(&self, theta: f64, start: Start, end: &[f64], out: &mut [f64]);

    /// Its step control, if it has one.
    fn controller(&self) -> Option<Controller> {
        None
    }

    /// Largest |factor| by which a step of length h multiplies a motion with the characteristic
    /// equation λ² = aλ + b; `None` for implicit methods.
    fn amplification(&self, _a: f64, _b: f64, _h: f64) -> Option<f64> {
        None
    }

    /// |hλ| of the fastest motion that the last step saw, by a quotient of differences, and the most that is stable.
    fn stiffness(&self, _h: f64, _end: &[f64]) -> Option<(f64, f64)> {
        None
    }

    /// The fastest motion in the last step of an explicit method, 1/s, roughly, and two points
    /// where it may be; zero without a sign that the step is suspicious.
    fn fastest(&self) -> Option<(f64, [&[f64]; 2])> {
        None
    }
}

/// The integrator of this name, on this manifold; whether explicit ones look for motion that is too
/// fast for their steps.
pub(crate) fn method(id: IntegratorId, manifold: &Manifold, looks: bool) -> Box<dyn Method> {
    let nv = manifold.nv;
    let n = 2 * nv + 2;
    match id {
        IntegratorId::semi_implicit_euler => Box::new(semi_implicit_euler::SemiImplicitEuler::new(n, looks)),
        IntegratorId::rk4 => Box::new(rk4::Rk4::new(n, looks)),
        IntegratorId::dopri5 => Box::new(dopri5::Dopri5::new(n, looks)),
        IntegratorId::dop853 => Box::new(dop853::Dop853::new(n, looks)),
        IntegratorId::rodas4 => Box::new(rodas4::Rodas4::new(manifold)),
        IntegratorId::lie_midpoint => Box::new(lie_midpoint::LieMidpoint::new(nv)),
    }
}

/// √(Σ (a − b)²).
fn distance(a: &[f64], b: &[f64]) -> f64 {
    squared_distance(a, b).sqrt()
}

/// Σ (a − b)², four sums side by side.
fn squared_distance(a: &[f64], b: &[f64]) -> f64 {
    let square = |a: f64, b: f64| (a - b) * (a - b);
    let ((fours, rest), (others, other)) = (a.as_chunks::<4>(), b.as_chunks::<4>());
    let mut sums = [0.0; 4];
    for (a, b) in fours.iter().zip(others) {
        sums = std::array::from_fn(|l| sums[l] + square(a[l], b[l]));
    }
    rest.iter().zip(other).fold((sums[0] + sums[1]) + (sums[2] + sums[3]), |sum, (a, b)| sum + square(*a, *b))
}

/// The roots of λ² = aλ + b as (re, im), (re, im).
pub(crate) fn roots(a: f64, b: f64) -> [(f64, f64); 2] {
    let (half, disc) = (0.5 * a, 0.25 * a * a + b);
    if disc < 0.0 {
        let im = (-disc).sqrt();
        return [(half, im), (half, -im)];
    }
    let big = half + disc.sqrt().copysign(half);
    [(big, 0.0), (if big == 0.0 { 0.0 } else { -b / big }, 0.0)]
}

/// Largest |P(hλ)| over the roots, P a polynomial by its coefficients from the constant up.
pub(crate) fn largest_of_polynomial(coefficients: &[f64], a: f64, b: f64, h: f64) -> f64 {
    let size = |(re, im): (f64, f64)| {
        let (x, y) = (h * re, h * im);
        let horner = |(p, q): (f64, f64), c: &f64| (p * x - q * y + c, p * y + q * x);
        let (p, q) = coefficients.iter().rev().fold((0.0, 0.0), horner);
        p.hypot(q)
    };
    roots(a, b).into_iter().map(size).fold(0.0, f64::max)
}
