//! Springs and dampers of higher degree, of tendons.
//!
//! ```text
//! x = l − l₂ where l > l₂, l − l₁ where l < l₁, else 0
//! f = −(k₂ x + k₃ x²) x − (d₂ |l̇| + d₃ l̇²) l̇
//! ```
//!
//! Source: MuJoCo documentation, stiffness and damping of tendons.

use crate::Scalar;

/// A force on a length l, beside the affine one.
#[derive(Clone, Debug, PartialEq)]
pub struct Terms<S = f64> {
    /// l₁ and l₂, m or rad.
    pub rest: [S; 2],
    /// k₂ and k₃: force per square and per cube of the distance from rest.
    pub stiffness: [S; 2],
    /// d₂ and d₃: force per square and per cube of the rate.
    pub damping: [S; 2],
}

impl<S: Scalar> Terms<S> {
    /// The same with `f` of each constant, always in the same order.
    pub fn map<T: Scalar>(&self, f: impl Fn(S) -> T + Copy) -> Terms<T> {
        Terms { rest: self.rest.map(f), stiffness: self.stiffness.map(f), damping: self.damping.map(f) }
    }

    /// f at a length and a rate.
    pub(super) fn force(&self, length: S, rate: S) -> S {
        let ([lower, upper], [k2, k3], [d2, d3]) = (self.rest, self.stiffness, self.damping);
        let below = S::select((lower - length).positive(), length - lower, S::zero());
        let x = S::select((length - upper).positive(), length - upper, below);
        -((k2 * x + k3 * (x * x)) * x) - (d2 * rate.abs() + d3 * (rate * rate)) * rate
    }

    /// −∂f/∂l̇.
    pub(super) fn slope(&self, rate: S) -> S {
        let [two, three] = [2.0, 3.0].map(S::from_f64);
        two * self.damping[0] * rate.abs() + three * self.damping[1] * (rate * rate)
    }

    /// Whether it depends on the rate.
    pub(super) fn has_damping(&self, is_zero: impl Fn(S) -> bool) -> bool {
        self.damping.into_iter().any(|own| !is_zero(own))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spring_of_higher_degree_is_slack_between_its_lengths() {
        let terms = Terms { rest: [0.3, 0.5], stiffness: [2.0, 10.0], damping: [3.0, 4.0] };
        for (length, force) in [(0.4, 0.0), (0.3, 0.0), (0.7, -(2.0 * 0.04 + 10.0 * 0.008)), (0.2, -(2.0 * 0.01 - 10.0 * 0.001))] {
            assert!((terms.force(length, 0.0) - force).abs() < 1e-15, "{length}");
        }
        for rate in [-1.5, 0.0, 0.7] {
            let difference = (terms.force(0.4, rate - 1e-6) - terms.force(0.4, rate + 1e-6)) / 2e-6;
            assert!((terms.slope(rate) - difference).abs() < 1e-5, "{rate}");
            assert_eq!(terms.force(0.4, -rate), -terms.force(0.4, rate));
        }
    }
}
