//! Activations: one number of state between a control and its force.
//!
//! ```text
//! integrator: ẇ = u     filter: ẇ = (u − w)/T     exact filter: w₁ = w + T ẇ (1 − exp(−h/T))
//! ```

use alloc::vec::Vec;

use super::{ActuatorLaw, Actuators, torques::clamp};
use crate::Scalar;

/// The activation of an actuator.
#[derive(Clone, Debug, PartialEq)]
pub struct Activation<S = f64> {
    /// How it follows the control.
    pub filter: Filter<S>,
    /// Bounds of the activation after a step.
    pub range: Option<[S; 2]>,
    /// Whether the force during a step has the activation after it (MuJoCo's `actearly`).
    pub is_early: bool,
}

/// How an activation w follows the control u.
#[derive(Clone, Debug, PartialEq)]
pub enum Filter<S = f64> {
    /// ẇ = u.
    Integrator,
    /// ẇ = (u − w)/T with the time constant T, s, stepped by Euler's method.
    Euler(S),
    /// The same, stepped exactly for a control that does not change.
    Exact(S),
}

impl<S: Scalar> Activation<S> {
    /// The same with `f` of each constant, always in the same order.
    pub fn map<T: Scalar>(&self, f: impl Fn(S) -> T + Copy) -> Activation<T> {
        let filter = match &self.filter {
            Filter::Integrator => Filter::Integrator,
            Filter::Euler(time) => Filter::Euler(f(*time)),
            Filter::Exact(time) => Filter::Exact(f(*time)),
        };
        Activation { filter, range: self.range.map(|range| range.map(f)), is_early: self.is_early }
    }

    /// ẇ at the activation w and the control u, 1/s.
    fn rate(&self, w: S, u: S) -> S {
        match self.filter {
            Filter::Integrator => u,
            Filter::Euler(time) | Filter::Exact(time) => (u - w) / time,
        }
    }

    /// The activation after h seconds.
    fn next(&self, w: S, rate: S, h: S) -> S {
        let time = match self.filter {
            Filter::Integrator | Filter::Euler(_) => h,
            Filter::Exact(time) => time * one_minus_exp(h / time),
        };
        clamp(w + rate * time, self.range)
    }
}

/// An actuator with its control within its bounds, and its activation if it has one.
struct Controlled<'a, S> {
    law: &'a ActuatorLaw<S>,
    control: S,
    /// w.
    state: Option<S>,
}

impl<'a, S: Scalar> Controlled<'a, S> {
    /// The activation, w, and its rate.
    fn moving(&self) -> Option<(&'a Activation<S>, S, S)> {
        let (activation, w) = (self.law.activation.as_ref()?, self.state?);
        Some((activation, w, activation.rate(w, self.control)))
    }
}

impl<S: Scalar> Actuators<S> {
    fn controlled<'a>(&'a self, act: &'a [S], ctrl: &'a [S]) -> impl Iterator<Item = Controlled<'a, S>> {
        let mut next = act.iter();
        self.laws.iter().zip(ctrl).map(move |(law, u)| {
            let state = law.activation.as_ref().and_then(|_| next.next().copied());
            Controlled { law, control: clamp(*u, law.control_range), state }
        })
    }

    /// The numbers w that gains of actuators multiply, `[nu]`: controls within their bounds, or
    /// activations. An early activation is that after `h` seconds.
    ///
    /// act: `[na]`; ctrl: `[nu]`; h: s, or none for the activations as they are.
    pub fn inputs(&self, act: &[S], ctrl: &[S], h: Option<S>) -> Vec<S> {
        let input = |own: Controlled<'_, S>| match (own.moving(), h) {
            (None, _) => own.control,
            (Some((activation, w, rate)), Some(h)) if activation.is_early => activation.next(w, rate, h),
            (Some((_, w, _)), _) => w,
        };
        self.controlled(act, ctrl).map(input).collect()
    }

    /// Rates of the activations, `[na]`, 1/s. act: `[na]`; ctrl: `[nu]`.
    pub fn activation_rates(&self, act: &[S], ctrl: &[S]) -> Vec<S> {
        self.controlled(act, ctrl).filter_map(|own| own.moving().map(|(_, _, rate)| rate)).collect()
    }

    /// Activations `[na]` after h seconds at these rates, within their bounds.
    pub fn next_activations(&self, act: &[S], rates: &[S], h: S) -> Vec<S> {
        let activations = self.laws.iter().filter_map(|law| law.activation.as_ref());
        activations.zip(act.iter().zip(rates)).map(|(activation, (w, rate))| activation.next(*w, *rate, h)).collect()
    }
}

/// 1 − exp(−x) for x ≥ 0: a power series of y = x/2ᵏ, then p = 1 − e^(−y) k times by
/// 1 − e^(−2y) = p (2 − p), which damps the error of the factor.
fn one_minus_exp<S: Scalar>(x: S) -> S {
    const HALVINGS: u32 = 6;
    // Beyond this exp(−x) is less than half a unit in the last place of one.
    let most = f64::from(S::BITS) * core::f64::consts::LN_2 + 1.0;
    let x = clamp(x, Some([S::zero(), S::from_f64(most)]));
    let y = x * S::from_f64(crate::scalar::two_to(-(HALVINGS as i32)));
    // Σ (−1)ⁿ⁻¹ yⁿ/n! = y (1 − y/2 (1 − y/3 (…))): as many terms as the precision needs.
    let bound = most * crate::scalar::two_to(-(HALVINGS as i32));
    let (mut terms, mut size) = (2_u32, bound);
    while size > crate::scalar::two_to(-(S::BITS as i32)) {
        terms += 1;
        size *= bound / f64::from(terms);
    }
    let series = (2..=terms).rev().fold(S::one(), |sum, n| S::one() - y * sum / S::from_f64(f64::from(n)));
    let two = S::from_f64(2.0);
    (0..HALVINGS).fold(y * series, |part, _| part * (two - part))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponential_is_exact_to_rounding() {
        for k in 0..4000 {
            let x = libm::exp(f64::from(k) * 0.015 - 40.0);
            let (found, expected) = (one_minus_exp(x), -libm::expm1(-x));
            assert!((found - expected).abs() <= 4.0 * f64::EPSILON * expected, "{x}: {found} {expected}");
        }
        assert_eq!(one_minus_exp(0.0), 0.0);
        assert_eq!(one_minus_exp(1e9), 1.0);
        assert!((one_minus_exp(0.5_f32) - 0.393_469_34).abs() < 1e-7);
    }
}
