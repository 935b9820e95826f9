//! The implicit midpoint rule on the manifold: symmetric, order 2.
//!
//! ```text
//! v_1 = v_0 + h a(q_½, v̄, t + ½h)      v̄ = ½(v_0 + v_1)
//! q_1 = q_0 ⊕ s      q_½ = q_0 ⊕ ½s      s = cay(h v̄)
//! ```
//!
//! where cay turns by 2 atan(½h|ω|) about ω where exp would turn by h|ω| (on SE(3) the same in dual
//! numbers), and plain coordinates add h v̄.
//!
//! **Invariants.** For one body that moves or turns freely and feels no force, I V̇ = −V ×* I V =
//! ad(V)ᵀ I V is quadratic in V, and the rule keeps quadratic invariants: with P = I V, P_1 − P_0 =
//! ad(hV̄)ᵀ ½(P_0 + P_1) is P_1 = Ad(cay(hV̄))ᵀ P_0. So momentum in fixed axes, R P, and with it
//! energy, are kept up to rounding. For any other robot it is symmetric, so reversible, with an
//! error of energy that does not grow over long motions that are regular. Momentum of a cyclic
//! coordinate (a plain one on which nothing depends) is kept, any other to the order of the method.
//!
//! Simo & Wong, Int. J. Numer. Methods Eng. 31, 1991 (energy and momentum with the midpoint);
//! Hairer, Lubich & Wanner 2006, §IV.2 (quadratic invariants), §IV.8 (Cayley's map).

use std::f64::consts::PI;

use super::hermite::{Hermite, hand_on_to_hermite};
use super::{Method, Start};
use crate::simulate::step_control::{Error, Norm};
use crate::simulate::system::{AT_REST, System};
use crate::simulate::{Control, SimulateError};

/// Largest number of rounds of a step.
const MOST_ROUNDS: usize = 200;

pub(crate) struct LieMidpoint {
    acceleration: Vec<f64>,
    middle: Vec<f64>,
    rate: Vec<f64>,
    step: Vec<f64>,
    curve: Hermite,
}

impl LieMidpoint {
    pub(super) fn new(nv: usize) -> Self {
        let n = 2 * nv + 2;
        Self { acceleration: vec![0.0; nv], middle: vec![0.0; n], rate: vec![0.0; n], step: vec![0.0; nv], curve: Hermite::new(n) }
    }
}

fn largest(x: impl Iterator<Item = f64>) -> f64 {
    x.fold(0.0, |most, x| if x.is_nan() { f64::NAN } else { x.abs().max(most) })
}

impl LieMidpoint {
    /// The acceleration in the middle of the step, by rounds of substitution.
    fn solve(&mut self, system: &mut System<'_>, control: &mut dyn Control, start: Start) -> Result<(), SimulateError> {
        let (h, nv, middle) = (start.h, system.nv(), start.t + 0.5 * start.h);
        let v = &start.y[nv..2 * nv];
        let mut before = f64::INFINITY;
        for _ in 0..MOST_ROUNDS {
            self.place_middle(system, v, h);
            system.rate(control, middle, &self.middle, &mut self.rate)?;
            system.counts.iterations += 1;
            let found = &self.rate[nv..2 * nv];
            if found.iter().any(|a| !a.is_finite()) {
                let first = if before.is_finite() { None } else { system.not_finite(middle, "acceleration", found) };
                return Err(first.unwrap_or(SimulateError::NoConvergence { t: start.t, step: h }));
            }
            let change = h * largest(found.iter().zip(&self.acceleration).map(|(a, b)| a - b));
            let size = largest(v.iter().copied()).max(h * largest(found.iter().copied()));
            self.acceleration.copy_from_slice(found);
            // Down to rounding, or as near as possible, or to rest.
            if change <= (f64::EPSILON * size).max(AT_REST) || (change >= before && change <= 64.0 * f64::EPSILON * size) {
                self.place_middle(system, v, h);
                return Ok(());
            }
            before = change;
        }
        Err(SimulateError::NoConvergence { t: start.t, step: h })
    }

    /// The step and its middle, as the acceleration has them.
    fn place_middle(&mut self, system: &System<'_>, v: &[f64], h: f64) {
        let nv = v.len();
        let mean = &mut self.middle[nv..2 * nv];
        mean.iter_mut().zip(v).zip(&self.acceleration).for_each(|((mean, v), a)| *mean = v + 0.5 * h * a);
        self.step.iter_mut().zip(mean).for_each(|(step, mean)| *step = h * *mean);
        system.manifold.cayley(&mut self.step);
        self.middle[..nv].iter_mut().zip(&self.step).for_each(|(u, s)| *u = 0.5 * s);
    }
}

impl Method for LieMidpoint {
    fn reset(&mut self) {
        self.acceleration.fill(0.0);
    }

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
        let nv = system.nv();
        let v = &start.y[nv..2 * nv];
        // Cayley's map turns by less than π, for every argument.
        if let Some(error) = system.turns_too_far((start.t, h), v, PI) {
            return Err(error);
        }
        self.solve(system, control, start).inspect_err(|_| self.acceleration.fill(0.0))?;
        end[..nv].copy_from_slice(&self.step);
        let rates = self.acceleration.iter().chain(&self.rate[2 * nv..]);
        end[nv..].iter_mut().zip(&start.y[nv..]).zip(rates).for_each(|((end, y), rate)| *end = y + h * rate);
        Ok(Error { size: 0.0, index: 0 })
    }

    fn wants_rate(&self) -> bool {
        false
    }

    hand_on_to_hermite!();
}
