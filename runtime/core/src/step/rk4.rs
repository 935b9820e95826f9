//! The classical Runge–Kutta method of four stages:
//!
//! ```text
//! k₁ = f(x), k₂ = f(x + ½h k₁), k₃ = f(x + ½h k₂), k₄ = f(x + h k₃)
//! x₁ = x + h/6 (k₁ + 2k₂ + 2k₃ + k₄)
//! ```

use alloc::vec;
use alloc::vec::Vec;

use super::{End, Start, free};
use crate::Scalar;
use crate::algorithm::{Workspace, integrate};

/// Where each stage is: the part of the step behind the stage before it.
const STAGES: [f64; 3] = [0.5, 0.5, 1.0];
/// Weights of the stages, in sixths.
const WEIGHTS: [f64; 4] = [1.0, 2.0, 2.0, 1.0];

/// In step vectors u of q = q₀ ⊕ u, u̇ = J_r(u)⁻¹ v: the order stays four on the manifold.
pub(super) fn on_the_manifold<S: Scalar>(start: &Start<'_, S>, ws: &mut Workspace<S>, end: &mut End<'_, S>) {
    let Start { model, q: q0, v: v0, h, .. } = *start;
    let nv = model.nv;
    let mut rates: [Vec<S>; 4] = core::array::from_fn(|_| vec![S::zero(); nv]);
    let mut accelerations = rates.clone();
    rates[0].copy_from_slice(v0);
    start.acceleration(ws, (q0, v0, start.act), &mut accelerations[0]);
    let mut changes = Changes::of(start);
    let (mut u, mut v, mut q) = (vec![S::zero(); nv], vec![S::zero(); nv], vec![S::zero(); model.nq]);
    for (k, part) in STAGES.into_iter().enumerate() {
        let step = h * S::from_f64(part);
        u.iter_mut().zip(&rates[k]).for_each(|(u, rate)| *u = step * *rate);
        v.iter_mut().zip(v0).zip(&accelerations[k]).for_each(|((v, v0), a)| *v = *v0 + step * *a);
        integrate(model, ws, q0, &u, &mut q);
        free::chart_rates(model, &u, &v, &mut rates[k + 1]);
        start.acceleration(ws, (&q, &v, &changes.stage(start, k, step)), &mut accelerations[k + 1]);
    }
    u.copy_from_slice(&mean(&rates, h));
    integrate(model, ws, q0, &u, end.q);
    start.advance_activations(&mean(&changes.0, S::one()), end);
    end.v.iter_mut().zip(v0).zip(mean(&accelerations, h)).for_each(|((next, v0), change)| *next = *v0 + change);
}

/// The same with velocities of origins in axes of the parent, and step vectors of turns alone: as
/// MuJoCo 4 moves.
pub(super) fn in_axes_of_the_parent<S: Scalar>(start: &Start<'_, S>, ws: &mut Workspace<S>, end: &mut End<'_, S>) {
    let Start { model, q: q0, v: v0, h, .. } = *start;
    let nv = model.nv;
    let w0 = free::to_parent(model, q0, v0);
    let mut rates: [Vec<S>; 4] = core::array::from_fn(|_| w0.clone());
    let mut accelerations: [Vec<S>; 4] = core::array::from_fn(|_| vec![S::zero(); nv]);
    let acceleration = |ws: &mut Workspace<S>, q: &[S], v: &[S], act: &[S]| {
        let mut a = vec![S::zero(); nv];
        start.acceleration(ws, (q, v, act), &mut a);
        free::of_origins(model, v, &mut a);
        free::to_parent(model, q, &a)
    };
    accelerations[0] = acceleration(ws, q0, v0, start.act);
    let mut changes = Changes::of(start);
    let mut q = vec![S::zero(); model.nq];
    for (k, part) in STAGES.into_iter().enumerate() {
        let step = h * S::from_f64(part);
        free::moved(model, q0, &rates[k], step, &mut q);
        let w: Vec<S> = w0.iter().zip(&accelerations[k]).map(|(w, a)| *w + step * *a).collect();
        let u: Vec<S> = rates[k].iter().map(|rate| step * *rate).collect();
        free::turn_rates(model, &u, &w, &mut rates[k + 1]);
        let act = changes.stage(start, k, step);
        accelerations[k + 1] = acceleration(ws, &q, &free::to_body(model, &q, &w), &act);
    }
    free::moved(model, q0, &mean(&rates, S::one()), h, end.q);
    let w: Vec<S> = w0.iter().zip(mean(&accelerations, h)).map(|(w, change)| *w + change).collect();
    end.v.copy_from_slice(&free::to_body(model, end.q, &w));
    start.advance_activations(&mean(&changes.0, S::one()), end);
}

/// Rates of the activations at each stage.
struct Changes<S>([Vec<S>; 4]);

impl<S: Scalar> Changes<S> {
    fn of(start: &Start<'_, S>) -> Self {
        let first = start.activation_rates(start.act);
        Self(core::array::from_fn(|_| first.clone()))
    }

    /// The activations at the stage behind stage `k`; their rates are kept.
    fn stage(&mut self, start: &Start<'_, S>, k: usize, step: S) -> Vec<S> {
        let act: Vec<S> = start.act.iter().zip(&self.0[k]).map(|(w, rate)| *w + step * *rate).collect();
        self.0[k + 1] = start.activation_rates(&act);
        act
    }
}

/// h/6 (k₁ + 2k₂ + 2k₃ + k₄).
fn mean<S: Scalar>(stages: &[Vec<S>; 4], h: S) -> Vec<S> {
    let weights = WEIGHTS.map(|weight| h * S::from_f64(weight / 6.0));
    (0..stages[0].len()).map(|i| (0..4).fold(S::zero(), |sum, k| sum + weights[k] * stages[k][i])).collect()
}
