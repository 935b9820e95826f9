//! v₁ = v₀ + h a(t₀, q₀, v₀), q₁ = q₀ ⊕ h v₁: order 1, symplectic where the mass matrix is constant
//! and forces are the slope of an energy of q.
//!
//! The linear velocity of a floating joint is stepped in axes that do not rotate with it:
//! [`Manifold::semi_implicit_step`](crate::simulate::manifold::Manifold::semi_implicit_step).

use super::hermite::{Hermite, hand_on_to_hermite};
use super::stages::Fastest;
use super::{Method, Start, roots};
use crate::simulate::stability::SUSPICIOUS;
use crate::simulate::step_control::{Error, Norm};
use crate::simulate::system::System;
use crate::simulate::{Control, SimulateError};

pub(crate) struct SemiImplicitEuler {
    curve: Hermite,
    /// Where the last step began, in the chart of the present one, and its rate; from there to
    /// here.
    before: Vec<f64>,
    rate: Vec<f64>,
    fastest: Fastest,
    /// Whether to look for fast motion.
    looks: bool,
}

impl SemiImplicitEuler {
    pub(super) fn new(n: usize, looks: bool) -> Self {
        Self { curve: Hermite::new(n), before: vec![0.0; n], rate: vec![f64::NAN; n], fastest: Fastest::new(n), looks }
    }
}

impl Method for SemiImplicitEuler {
    fn reset(&mut self) {
        self.rate.fill(f64::NAN);
    }

    fn step(
        &mut self,
        system: &mut System<'_>,
        _: &mut dyn Control,
        start: Start,
        end: &mut [f64],
        _: &Norm,
    ) -> Result<Error, SimulateError> {
        let h = start.h;
        self.curve.forget();
        let nv = system.nv();
        if self.looks {
            self.fastest.reset(SUSPICIOUS / h);
            self.fastest.compare([&self.before, start.y], [&self.rate, start.f]);
        }
        let (u, rest) = end.split_at_mut(nv);
        let (v, powers) = rest.split_at_mut(nv);
        system.manifold.semi_implicit_step(&start.y[nv..2 * nv], &start.f[nv..2 * nv], h, u, v);
        powers.iter_mut().zip(&start.y[2 * nv..]).zip(&start.f[2 * nv..]).for_each(|((end, y), f)| *end = y + h * f);
        if !self.looks {
            return Ok(Error { size: 0.0, index: 0 });
        }
        // To first order q_0 is q_1 ⊕ (−u).
        self.before.copy_from_slice(start.y);
        self.before[..nv].iter_mut().zip(&*u).for_each(|(before, u)| *before = -*u);
        self.rate.copy_from_slice(start.f);
        Ok(Error { size: 0.0, index: 0 })
    }

    hand_on_to_hermite!();

    /// One step of ü = a u̇ + b u: the matrix [1 + h²b, h(1 + ha); hb, 1 + ha], μ² = (2 + ha + h²b)
    /// μ − (1 + ha).
    fn amplification(&self, a: f64, b: f64, h: f64) -> Option<f64> {
        let both = roots(2.0 + h * a + h * h * b, -(1.0 + h * a));
        Some(both.into_iter().map(|(re, im)| re.hypot(im)).fold(0.0, f64::max))
    }

    fn fastest(&self) -> Option<(f64, [&[f64]; 2])> {
        Some(self.fastest.seen())
    }
}
