//! The implicit midpoint rule on the manifold: symmetric, of order two.
//!
//! ```text
//! v₁ = v₀ + h a(q_½, v̄)      v̄ = ½(v₀ + v₁)
//! q₁ = q₀ ⊕ s      q_½ = q₀ ⊕ ½s      s = cay(h v̄)
//! ```
//!
//! Cayley's map cay turns by 2 atan(½|w|) about w where exp turns by |w|; on SE(3) the same with
//! dual numbers. The acceleration is found by substitution, until it changes no more. If it does
//! not settle, the rates of the result are not finite.
//!
//! One body that moves freely keeps its momentum in fixed axes, and its energy, up to rounding. Of
//! any other robot the error of the energy does not grow in long regular motions. Simo & Wong, Int.
//! J. Numer. Methods Eng. 31, 1991; Hairer, Lubich & Wanner 2006, §IV.2, §IV.8.

use alloc::vec;
use alloc::vec::Vec;

use super::{End, Start};
use crate::Scalar;
use crate::actuator::{Activation, Filter};
use crate::algorithm::manifold::{Space, put, range, six, three};
use crate::algorithm::{Workspace, integrate};
use crate::model::Model;
use crate::scalar::two_to;
use crate::spatial::screw::Quaternion;
use crate::spatial::{Twist, Vector3};

/// Largest number of rounds of substitution.
const MOST: usize = 50;
/// Powers of two: a change in parts of the size that ends the rounds, and one that ends them if it
/// no longer falls.
const SETTLED: i32 = -47;
const SMALL: i32 = -16;
/// The square of a change that always ends them, and one that is larger than any.
const AT_REST: f64 = 1e-36;
const FIRST: f64 = 1e30;

pub(super) fn lie_midpoint<S: Scalar>(start: &Start<'_, S>, ws: &mut Workspace<S>, end: &mut End<'_, S>) {
    let Start { model, q: q0, v: v0, h, .. } = *start;
    let half = h * S::from_f64(0.5);
    // Activations at the middle of the step.
    let first = start.activation_rates(start.act);
    let act: Vec<S> = start.act.iter().zip(&first).map(|(w, rate)| *w + half * *rate).collect();
    // The acceleration, and the square of its last change.
    let mut state = vec![S::zero(); model.nv + 1];
    state[model.nv] = S::from_f64(FIRST);
    start.acceleration(ws, (q0, v0, start.act), &mut state[..model.nv]);
    let converged = S::repeat(MOST, &mut state, |state| {
        let (a, last) = state.split_at_mut(model.nv);
        let before = a.to_vec();
        let mean: Vec<S> = v0.iter().zip(&before).map(|(v, a)| *v + half * *a).collect();
        let half_step: Vec<S> = cayley(model, &mean, h).iter().map(|s| *s * S::from_f64(0.5)).collect();
        let mut q = vec![S::zero(); model.nq];
        integrate(model, ws, q0, &half_step, &mut q);
        start.acceleration(ws, (&q, &mean, &act), a);
        is_settled(v0, (&before, a), h, &mut last[0])
    });
    let a = &state[..model.nv];
    let mean: Vec<S> = v0.iter().zip(a).map(|(v, a)| *v + half * *a).collect();
    integrate(model, ws, q0, &cayley(model, &mean, h), end.q);
    // Without convergence the rates are not finite.
    let certain = S::one() / S::select(converged, S::one(), S::zero());
    end.v.iter_mut().zip(v0).zip(a).for_each(|((end, v), a)| *end = (*v + h * *a) * certain);
    // An exact filter needs its rate at the start, the others theirs at the middle.
    let is_exact = |own: &Activation<S>| matches!(own.filter, Filter::Exact(_));
    let activations = model.actuators.laws.iter().filter_map(|law| law.activation.as_ref());
    let rates = activations.zip(first.iter().zip(start.activation_rates(&act)));
    let rates: Vec<S> = rates.map(|(own, (first, middle))| if is_exact(own) { *first } else { middle }).collect();
    start.advance_activations(&rates, end);
}

/// |h Δa| ≤ ε √(|v|² + |h a|²) with ε = 64 units in the last place of f64: the next round would
/// change less. Or it is small and no longer falls: in other precisions, and where rounding is
/// large.
fn is_settled<S: Scalar>(v: &[S], (before, a): (&[S], &[S]), h: S, last: &mut S) -> S::Mask {
    let sum = |terms: &mut dyn Iterator<Item = S>| terms.fold(S::zero(), |sum, x| sum + x * x);
    let change = sum(&mut before.iter().zip(a).map(|(before, a)| h * (*a - *before)));
    let size = sum(&mut v.iter().copied()) + sum(&mut a.iter().map(|a| h * *a));
    let beyond = |part: i32| size * S::from_f64(two_to(2 * part)) + S::from_f64(AT_REST) - change;
    let near = S::select((*last - change).positive(), -S::one(), beyond(SMALL));
    *last = change;
    S::select(beyond(SETTLED).positive(), S::one(), near).positive()
}

/// The step vector of Cayley's map of h v.
fn cayley<S: Scalar>(model: &Model<S>, v: &[S], h: S) -> Vec<S> {
    let mut step: Vec<S> = v.iter().map(|v| h * *v).collect();
    for joint in &model.joints {
        let own = &mut step[range(joint.v)];
        match Space::of(joint.kind) {
            Space::Placements => {
                let twist = six(own);
                let (rotation, position) = moved(twist.angular, twist.linear);
                let exact = Twist::log_of_parts(&rotation, position);
                put(own, &exact.angular);
                put(&mut own[3..], &exact.linear);
            }
            Space::Rotations => {
                let (rotation, _) = moved(three(own), Vector3::zeros());
                put(own, &rotation.log());
            }
            Space::Numbers => {}
        }
    }
    step
}

/// The rotation r and the position p of Cayley's map of a twist (w, s):
///
/// ```text
/// r = (1 + ½w)/n,   n² = 1 + ¼|w|²,   p = 2 d r*,   d = ½s/n − wᵀs/(4n³) (1 + ½w)
/// ```
fn moved<S: Scalar>(w: Vector3<S>, s: Vector3<S>) -> (Quaternion<S>, Vector3<S>) {
    let [half, quarter] = [0.5, 0.25].map(S::from_f64);
    let inverse = S::one() / (S::one() + quarter * w.dot(&w)).sqrt();
    let quaternion = |v: Vector3<S>, w: S| Quaternion::from_array([v.x, v.y, v.z, w]);
    let rotation = quaternion(w * (half * inverse), inverse);
    let part = quarter * w.dot(&s) * inverse * inverse * inverse;
    let dual = quaternion(s * (half * inverse) - w * (half * part), -part);
    let [x, y, z, _] = dual.product(&rotation.conjugate()).to_array();
    (rotation, Vector3::new(x, y, z) * S::from_f64(2.0))
}
