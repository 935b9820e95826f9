//! Constraints of sums of coordinates: fixed tendons, and equations of joints or tendons.
//!
//! ```text
//! l = Σ a q                                    of a tendon; of a joint alone q
//! limit:         lower ≤ l ≤ upper
//! dry friction:  a force against l̇, of a greatest size
//! equation:      l − l₀ = p(y) = c₀ + c₁ y + … + c₄ y⁴,   y = l₂ − l₂₀
//!                J = ∂l/∂q − p′(y) ∂l₂/∂q
//! ```
//!
//! Source: MuJoCo documentation, Computation: constraint model; XML reference: equality, tendon.

use alloc::vec::Vec;

use super::Soft;
use super::joints::{JointRow, Side};
use crate::Scalar;
use crate::scalar::flag;

/// A coordinate of one degree of freedom with its factor.
#[derive(Clone, Debug, PartialEq)]
pub struct Term<S = f64> {
    /// The coordinate.
    pub q: usize,
    /// Its degree of freedom.
    pub v: usize,
    /// Its factor, dimensionless, or m/rad.
    pub factor: S,
}

/// A constraint of a sum of coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Sum<S = f64> {
    /// The sum l.
    pub terms: Vec<Term<S>>,
    /// What holds for it.
    pub law: SumLaw<S>,
    /// How it gives way.
    pub soft: Soft<S>,
    /// The inverse inertia of its row in the reference pose, in the unit of 1/M of a coordinate.
    pub weight: S,
}

/// What holds for a sum of coordinates.
#[derive(Clone, Debug, PartialEq)]
pub enum SumLaw<S = f64> {
    /// It is between two numbers.
    Between {
        /// The bounds, in the unit of the sum.
        range: [S; 2],
        /// A bound acts from this far before it.
        margin: S,
    },
    /// Its change has a force against it of at most this size, in the unit of the force on the sum.
    DryFriction(S),
    /// It is a polynomial of another sum.
    Equation {
        /// l₂; without terms it is l₂₀.
        other: Vec<Term<S>>,
        /// l₀ and l₂₀.
        references: [S; 2],
        /// c₀ to c₄.
        coefficients: [S; 5],
    },
}

impl<S: Scalar> Term<S> {
    fn map<T: Scalar>(&self, f: impl Fn(S) -> T) -> Term<T> {
        Term { q: self.q, v: self.v, factor: f(self.factor) }
    }
}

fn length<S: Scalar>(terms: &[Term<S>], q: &[S]) -> S {
    terms.iter().fold(S::zero(), |sum, term| sum + term.factor * q[term.q])
}

impl<S: Scalar> Sum<S> {
    /// The same with `f` of each constant, always in the same order.
    pub(super) fn map<T: Scalar>(&self, f: impl Fn(S) -> T + Copy) -> Sum<T> {
        let all = |terms: &[Term<S>]| terms.iter().map(|term| term.map(f)).collect();
        let law = match &self.law {
            SumLaw::Between { range, margin } => SumLaw::Between { range: range.map(f), margin: f(*margin) },
            SumLaw::DryFriction(loss) => SumLaw::DryFriction(f(*loss)),
            SumLaw::Equation { other, references, coefficients } => {
                SumLaw::Equation { other: all(other), references: references.map(f), coefficients: coefficients.map(f) }
            }
        };
        Sum { terms: all(&self.terms), law, soft: self.soft.map(f), weight: f(self.weight) }
    }

    /// Its rows in a state.
    pub(super) fn rows(&self, q: &[S], v: &[S], rows: &mut Vec<JointRow<S>>) {
        let l = length(&self.terms, q);
        let along = |sign: S| self.terms.iter().map(|term| (term.v, sign * term.factor)).collect::<Vec<_>>();
        let mut push = |entries: Vec<(usize, S)>, violation: S, side: &dyn Fn(S) -> (S, Side<S>)| {
            let rate = entries.iter().fold(S::zero(), |sum, (k, entry)| sum + *entry * v[*k]);
            let (reference, give) = self.soft.row(violation, rate, self.weight);
            let (acts, side) = side(give);
            rows.push(JointRow { entries, curvature: acts / give, reference, side });
        };
        match &self.law {
            SumLaw::Between { range: [lower, upper], margin } => {
                for (sign, distance) in [(S::one(), l - *lower), (-S::one(), *upper - l)] {
                    push(along(sign), distance - *margin, &|_| (flag::<S>((*margin - distance).positive()), Side::Below));
                }
            }
            SumLaw::DryFriction(loss) => {
                push(along(S::one()), S::zero(), &|give| (S::one(), Side::Within([give * *loss, *loss])));
            }
            SumLaw::Equation { other, references, coefficients } => {
                let y = if other.is_empty() { S::zero() } else { length(other, q) - references[1] };
                // Horner's rule for the polynomial and its slope
                let (mut p, mut slope) = (S::zero(), S::zero());
                for c in coefficients.iter().rev() {
                    slope = slope * y + p;
                    p = p * y + *c;
                }
                let mut entries = along(S::one());
                entries.extend(other.iter().map(|term| (term.v, -(slope * term.factor))));
                push(entries, l - references[0] - p, &|_| (S::one(), Side::Both));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// J is the derivative of the violation.
    #[test]
    fn the_row_of_an_equation_is_its_derivative() {
        let term = |k: usize, factor: f64| Term { q: k, v: k, factor };
        let soft = Soft::of([0.02, 1.0], [0.9, 0.9, 0.001, 0.5, 2.0], None).unwrap();
        let law = SumLaw::Equation {
            other: [term(1, 0.5), term(2, -0.4)].into(),
            references: [0.1, -0.3],
            coefficients: [0.2, -0.7, 0.4, 1.3, -0.9],
        };
        let sum = Sum { terms: [term(0, 1.5)].into(), law, soft, weight: 0.7 };
        let violation = |q: &[f64]| {
            let y = 0.5 * q[1] - 0.4 * q[2] + 0.3;
            1.5 * q[0] - 0.1 - (0.2 - 0.7 * y + 0.4 * y * y + 1.3 * y.powi(3) - 0.9 * y.powi(4))
        };
        let q = [0.3, 0.8, -0.5];
        let mut rows = Vec::new();
        sum.rows(&q, &[0.0; 3], &mut rows);
        let [row] = rows.as_slice() else { panic!("{}", rows.len()) };
        // At rest r = −k d p
        let k = 1.0 / (0.9 * 0.9 * 0.02 * 0.02);
        assert!((row.reference + k * 0.9 * violation(&q)).abs() < 1e-9 * k);
        for (j, entry) in &row.entries {
            let at = |h: f64| {
                let mut moved = q;
                moved[*j] += h;
                violation(&moved)
            };
            assert!((entry - (at(1e-6) - at(-1e-6)) / 2e-6).abs() < 1e-8, "{j}");
        }
    }
}
