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

use super::{Start, free};
use crate::Scalar;
use crate::algorithm::{Workspace, effects};

/// v₁ = v₀ + h a(q₀, v₀), q₁ = q₀ ⊕ h v₁.
pub(super) fn semi_implicit<S: Scalar>(start: &Start<'_, S>, ws: &mut Workspace<S>, q_next: &mut [S], v_next: &mut [S]) {
    let mut a = vec![S::zero(); start.model.nv];
    start.acceleration(ws, start.q, start.v, &mut a);
    advance(start, &mut a, q_next, v_next);
}

/// The same with (M + h D) a = τ − h(q₀, v₀), D = −∂f/∂v of the forces f of effects on joints: the
/// diagonal of h D counts as inertia of rotors that does not fall.
pub(super) fn implicit_damping<S: Scalar>(start: &Start<'_, S>, ws: &mut Workspace<S>, q_next: &mut [S], v_next: &mut [S]) {
    let mut diagonal: Vec<Option<S>> = vec![None; start.model.nv];
    effects::damping(start.model, start.q, start.v, |at, slope| {
        let own = start.h * slope;
        diagonal[at] = Some(diagonal[at].map_or(own, |sum| sum + own));
    });
    ws.diagonal = diagonal;
    let mut a = vec![S::zero(); start.model.nv];
    start.acceleration(ws, start.q, start.v, &mut a);
    ws.diagonal = Vec::new();
    advance(start, &mut a, q_next, v_next);
}

fn advance<S: Scalar>(start: &Start<'_, S>, a: &mut [S], q_next: &mut [S], v_next: &mut [S]) {
    let Start { model, q, v, h, .. } = *start;
    free::of_origins(model, v, a);
    // Sums before turns: v₀ + h (v̇ + ω × v) in axes of the start.
    v_next.iter_mut().zip(v).zip(a).for_each(|((next, v), a)| *next = *v + h * *a);
    let rates = free::to_parent(model, q, v_next);
    free::moved(model, q, &rates, h, q_next);
    v_next.copy_from_slice(&free::to_body(model, q_next, &rates));
}
