//! How a constraint gives way: reference acceleration and impedance.
//!
//! ```text
//! r = −b ṗ − k d(p) p        d(p) = d₀ + y(|p| / w) (d₁ − d₀)       1 / D = (1 − d) / d · weight
//! ```
//!
//! p is the violation, with the margin. y rises from 0 to 1 by two powers that meet at a midpoint.
//! Source: MuJoCo documentation, Modeling: solver parameters.

use crate::Scalar;
use crate::scalar::greater;

/// The smallest number that divides, as in MuJoCo.
const LEAST: f64 = 1e-15;

/// A spring, a damper and an impedance.
#[derive(Clone, Debug, PartialEq)]
pub struct Soft<S = f64> {
    /// k, 1/s²: before the factor d.
    pub stiffness: S,
    /// b, 1/s.
    pub damping: S,
    /// d.
    pub impedance: Impedance<S>,
}

/// The impedance over the violation.
#[derive(Clone, Debug, PartialEq)]
pub enum Impedance<S = f64> {
    /// One number, between 0 and 1.
    Constant(S),
    /// From the first number to the second.
    Rising {
        /// d₀ and d₁, between 0 and 1.
        ends: [S; 2],
        /// w, in the unit of the violation.
        width: S,
        /// Where the two powers meet, in parts of the width.
        midpoint: S,
        /// Twice the power, from 2 on: the powers are 1, 1½, 2, …
        twice_power: u32,
    },
}

/// MuJoCo's bounds of an impedance, and of a midpoint.
const IMPEDANCE: [f64; 2] = [1e-4, 0.9999];

impl Soft<f64> {
    /// Of `solref` and `solimp` of MuJoCo. `step`: the time constant is at least twice this time,
    /// s; `None`: it may be any. Where only one number of `solref` is positive, both are the
    /// defaults. `None`: the power of `solimp` is not a multiple of a half.
    pub fn of(solref: [f64; 2], solimp: [f64; 5], step: Option<f64>) -> Option<Self> {
        let [least, most, width, midpoint, power] = solimp;
        let bounded = |x: f64| x.clamp(IMPEDANCE[0], IMPEDANCE[1]);
        let (ends, width, midpoint, power) = ([bounded(least), bounded(most)], width.max(0.0), bounded(midpoint), power.max(1.0));
        let [stiffness, damping] = reference(solref, ends[1], step);
        let impedance = if ends[0] == ends[1] || width <= LEAST {
            Impedance::Constant(0.5 * (ends[0] + ends[1]))
        } else {
            let twice = 2.0 * power;
            if f64::from(twice as u32) != twice || twice > 64.0 {
                return None;
            }
            Impedance::Rising { ends, width, midpoint, twice_power: twice as u32 }
        };
        Some(Self { stiffness, damping, impedance })
    }
}

/// k and b of a time constant and a ratio of damping, or of a negative stiffness and damping.
pub(crate) fn reference([time, ratio]: [f64; 2], most: f64, step: Option<f64>) -> [f64; 2] {
    // One of each sign: the defaults of MuJoCo.
    let [time, ratio] = if (time > 0.0) == (ratio > 0.0) { [time, ratio] } else { [0.02, 1.0] };
    let time = if time > 0.0 { time.max(step.map_or(0.0, |step| 2.0 * step)) } else { time };
    let of = |x: f64| x.max(LEAST);
    let stiffness = if time > 0.0 { 1.0 / of(most * most * time * time * ratio * ratio) } else { -time / of(most * most) };
    let damping = if ratio > 0.0 { 2.0 / of(most * time) } else { -ratio / of(most) };
    [stiffness, damping]
}

impl<S: Scalar> Soft<S> {
    /// The same with `f` of each constant, always in the same order.
    pub fn map<T: Scalar>(&self, f: impl Fn(S) -> T + Copy) -> Soft<T> {
        let impedance = match &self.impedance {
            Impedance::Constant(d) => Impedance::Constant(f(*d)),
            Impedance::Rising { ends, width, midpoint, twice_power } => {
                Impedance::Rising { ends: ends.map(f), width: f(*width), midpoint: f(*midpoint), twice_power: *twice_power }
            }
        };
        Soft { stiffness: f(self.stiffness), damping: f(self.damping), impedance }
    }

    /// The reference acceleration at a violation p and its rate, and R = 1 / D of a row with this
    /// inverse inertia.
    pub(super) fn row(&self, p: S, rate: S, weight: S) -> (S, S) {
        self.row_of(p, p, rate, weight)
    }

    /// The same of one row of several, whose violations have this size.
    pub(super) fn row_of(&self, size: S, p: S, rate: S, weight: S) -> (S, S) {
        let d = self.impedance.at(size);
        (-(self.damping * rate) - self.stiffness * d * p, greater((S::one() - d) / d * weight, S::from_f64(LEAST)))
    }
}

impl<S> Impedance<S> {
    /// Twice the power of one that rises.
    pub(super) fn twice_power(&self) -> Option<u32> {
        if let Self::Rising { twice_power, .. } = self { Some(*twice_power) } else { None }
    }
}

impl<S: Scalar> Impedance<S> {
    /// d(p).
    fn at(&self, p: S) -> S {
        let (zero, one) = (S::zero(), S::one());
        match self {
            Self::Constant(d) => *d,
            Self::Rising { ends: [least, most], width, midpoint, twice_power } => {
                let x = p.abs() / *width;
                let y = if *twice_power == 2 {
                    x
                } else {
                    // xᵖ / mᵖ⁻¹ before the midpoint, 1 − (1 − x)ᵖ / (1 − m)ᵖ⁻¹ behind it
                    let part = |x: S, m: S| power(x, *twice_power) / power(m, *twice_power - 2);
                    // No root of a negative number, where the other side counts.
                    let rest = S::select((one - x).positive(), one - x, zero);
                    S::select((x - *midpoint).positive(), one - part(rest, one - *midpoint), part(x, *midpoint))
                };
                let within = S::select((one - x).positive(), y, one);
                *least + within * (*most - *least)
            }
        }
    }
}

/// x to the power of half of `twice`.
fn power<S: Scalar>(x: S, twice: u32) -> S {
    let whole = (0..twice / 2).fold(S::one(), |product, _| product * x);
    if twice % 2 == 1 { whole * x.sqrt() } else { whole }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_impedance_rises_from_end_to_end() {
        let soft = Soft::of([0.02, 1.0], [0.9, 0.95, 0.001, 0.5, 2.0], None).unwrap();
        let at = |p: f64| soft.impedance.at(p);
        assert_eq!((at(0.0), at(0.001), at(-7.0)), (0.9, 0.95, 0.95));
        // 2 x² up to the midpoint, and the mirror image behind it.
        assert!((at(-0.00025) - (0.9 + 0.05 * 0.125)).abs() < 1e-15);
        assert!((at(0.00075) - (0.9 + 0.05 * 0.875)).abs() < 1e-15);
        assert_eq!(Soft::of([0.02, 1.0], [0.9, 0.95, 0.001, 0.5, 2.2], None), None);
        let constant = Soft::of([0.02, 1.0], [0.8, 0.9, 0.0, 0.5, 2.2], None).unwrap();
        assert!((constant.impedance.at(1.0) - 0.85).abs() < 1e-15);
        // x√x / √m with a power of 1½
        let half = Soft::of([0.02, 1.0], [0.1, 0.9, 1.0, 0.25, 1.5], None).unwrap();
        assert!((half.impedance.at(0.16) - (0.1 + 0.8 * 0.064 / 0.5)).abs() < 1e-15);
        assert!((half.impedance.at(2.0) - 0.9).abs() < 1e-15);
    }

    #[test]
    fn references_are_springs_and_dampers_in_both_forms() {
        // k = 1/(d² t² ζ²), b = 2/(d t)
        let [k, b] = reference([0.1, 2.0], 0.5, None);
        assert!((k - 100.0).abs() < 1e-12 && (b - 40.0).abs() < 1e-13, "{k} {b}");
        assert_eq!(reference([-100.0, -30.0], 0.5, Some(1.0)), [400.0, 60.0]);
        // At least two steps; one of each sign is the default.
        assert_eq!(reference([0.001, 1.0], 0.5, Some(0.01)), reference([0.02, 1.0], 0.5, None));
        assert_eq!(reference([0.3, -1.0], 0.5, None), reference([0.02, 1.0], 0.5, None));
    }
}
