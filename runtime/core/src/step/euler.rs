//! Semi-implicit Euler: the velocity first, then the configuration with the new velocity.
//!
//! The velocity of the origin of a floating joint is stepped in axes that do not turn, so that a
//! constant velocity of the whole motion is kept to rounding:
//!
//! ```text
//! w₁ = R₀ v₀ + h R₀ (v̇ + ω × v),   p₁ = p₀ + h w₁,   Q₁ = Q₀ exp(h ω₁),   v₁ = R₁ᵀ w₁
//! ```

use alloc::vec;
use alloc::vec::Vec;

use super::{End, Start, free};
use crate::Scalar;
use crate::algorithm::{Workspace, effects};

/// v₁ = v₀ + h a(q₀, v₀), q₁ = q₀ ⊕ h v₁.
pub(super) fn semi_implicit<S: Scalar>(start: &Start<'_, S>, ws: &mut Workspace<S>, end: &mut End<'_, S>) {
    let mut a = vec![S::zero(); start.model.nv];
    start.acceleration(ws, (start.q, start.v, start.act), &mut a);
    free::of_origins(start.model, start.v, &mut a);
    advance(start, &a, end);
}

/// The same with (M + h D) a = τ − h(q₀, v₀), D = −∂f/∂v of the forces f of effects on joints: the
/// diagonal of h D counts as inertia of rotors that does not fall.
pub(super) fn implicit_damping<S: Scalar>(start: &Start<'_, S>, ws: &mut Workspace<S>, end: &mut End<'_, S>) {
    ws.diagonal = of_joints(start);
    semi_implicit(start, ws, end);
    ws.diagonal = Vec::new();
}

/// The diagonal of h D of effects on joints.
pub(super) fn of_joints<S: Scalar>(start: &Start<'_, S>) -> Vec<Option<S>> {
    let mut diagonal: Vec<Option<S>> = vec![None; start.model.nv];
    effects::damping(start.model, start.q, start.v, |at, slope| put(&mut diagonal[at], start.h * slope));
    diagonal
}

pub(super) fn put<S: Scalar>(entry: &mut Option<S>, own: S) {
    *entry = Some(entry.map_or(own, |sum| sum + own));
}

/// The end of a step with these accelerations, of the origins of floating joints v̇ + ω × v.
pub(super) fn advance<S: Scalar>(start: &Start<'_, S>, a: &[S], end: &mut End<'_, S>) {
    let Start { model, q, v, h, .. } = *start;
    // Sums before turns: v₀ + h (v̇ + ω × v) in axes of the start.
    end.v.iter_mut().zip(v).zip(a).for_each(|((next, v), a)| *next = *v + h * *a);
    let rates = free::to_parent(model, q, end.v);
    free::moved(model, q, &rates, h, end.q);
    end.v.copy_from_slice(&free::to_body(model, end.q, &rates));
    start.advance_activations(&start.activation_rates(start.act), end);
}
