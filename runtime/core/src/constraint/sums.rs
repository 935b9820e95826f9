//! Constraints of lengths: of tendons, and equations of joints or tendons.
//!
//! ```text
//! l = Σ a q                                    of a fixed tendon; of a joint alone q
//! l = Σ c Σ |p_{k+1} − p_k|                    of a path over points of bodies
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
use crate::actuator::{Strand, path_row};
use crate::algorithm::Placed;
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

/// A length that changes with the coordinates.
#[derive(Clone, Debug, PartialEq)]
pub enum Length<S = f64> {
    /// A sum of coordinates.
    Sum(Vec<Term<S>>),
    /// That of a path.
    Path(Vec<Strand<S>>),
}

/// A constraint of a length.
#[derive(Clone, Debug, PartialEq)]
pub struct Sum<S = f64> {
    /// The length l.
    pub length: Length<S>,
    /// What holds for it.
    pub law: SumLaw<S>,
    /// How it gives way.
    pub soft: Soft<S>,
    /// The inverse inertia of its row in the reference pose, in the unit of 1/M of a coordinate.
    pub weight: S,
}

/// What holds for a length.
#[derive(Clone, Debug, PartialEq)]
pub enum SumLaw<S = f64> {
    /// It is between two numbers.
    Between {
        /// The bounds, in the unit of the length.
        range: [S; 2],
        /// A bound acts from this far before it.
        margin: S,
    },
    /// Its change has a force against it of at most this size, in the unit of the force along it.
    DryFriction(S),
    /// It is a polynomial of another length.
    Equation {
        /// l₂; without one it is l₂₀.
        other: Option<Length<S>>,
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

impl<S: Scalar> Length<S> {
    /// The same with `f` of each constant, always in the same order.
    fn map<T: Scalar>(&self, f: impl Fn(S) -> T + Copy) -> Length<T> {
        match self {
            Self::Sum(terms) => Length::Sum(terms.iter().map(|term| term.map(f)).collect()),
            Self::Path(strands) => Length::Path(strands.iter().map(|strand| strand.map(f)).collect()),
        }
    }

    /// Its value and ∂l/∂q: degrees of freedom, each with its entry.
    fn at(&self, bodies: &Placed<'_, S>, q: &[S]) -> (S, Vec<(usize, S)>) {
        match self {
            Self::Sum(terms) => {
                let value = terms.iter().fold(S::zero(), |sum, term| sum + term.factor * q[term.q]);
                (value, terms.iter().map(|term| (term.v, term.factor)).collect())
            }
            Self::Path(strands) => path_row(strands, bodies),
        }
    }
}

/// The rows of all constraints of lengths in a state.
pub(super) fn rows<S: Scalar>(sums: &[Sum<S>], bodies: &Placed<'_, S>, (q, v): (&[S], &[S]), rows: &mut Vec<JointRow<S>>) {
    for sum in sums {
        let other = sum.lengths().nth(1).map(|other| other.at(bodies, q));
        sum.rows(sum.length.at(bodies, q), other, v, rows);
    }
}

impl<S: Scalar> Sum<S> {
    /// Its length, and the other one of an equation.
    pub(crate) fn lengths(&self) -> impl Iterator<Item = &Length<S>> {
        let other = if let SumLaw::Equation { other, .. } = &self.law { other.as_ref() } else { None };
        core::iter::once(&self.length).chain(other)
    }

    /// The same with `f` of each constant, always in the same order.
    pub(super) fn map<T: Scalar>(&self, f: impl Fn(S) -> T + Copy) -> Sum<T> {
        let law = match &self.law {
            SumLaw::Between { range, margin } => SumLaw::Between { range: range.map(f), margin: f(*margin) },
            SumLaw::DryFriction(loss) => SumLaw::DryFriction(f(*loss)),
            SumLaw::Equation { other, references, coefficients } => SumLaw::Equation {
                other: other.as_ref().map(|other| other.map(f)),
                references: references.map(f),
                coefficients: coefficients.map(f),
            },
        };
        Sum { length: self.length.map(f), law, soft: self.soft.map(f), weight: f(self.weight) }
    }

    /// Its rows with its length, and that of the other one, each with ∂l/∂q.
    fn rows(&self, (l, row): (S, Vec<(usize, S)>), other: Option<(S, Vec<(usize, S)>)>, v: &[S], rows: &mut Vec<JointRow<S>>) {
        let along = |sign: S| row.iter().map(|(k, entry)| (*k, sign * *entry)).collect::<Vec<_>>();
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
            SumLaw::Equation { references, coefficients, .. } => {
                let (l2, second) = other.unwrap_or((references[1], Vec::new()));
                let y = if second.is_empty() { S::zero() } else { l2 - references[1] };
                // Horner's rule for the polynomial and its slope
                let (mut p, mut slope) = (S::zero(), S::zero());
                for c in coefficients.iter().rev() {
                    slope = slope * y + p;
                    p = p * y + *c;
                }
                let mut entries = along(S::one());
                entries.extend(second.iter().map(|(k, entry)| (*k, -(slope * *entry))));
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
            other: Some(Length::Sum([term(1, 0.5), term(2, -0.4)].into())),
            references: [0.1, -0.3],
            coefficients: [0.2, -0.7, 0.4, 1.3, -0.9],
        };
        let sum = Sum { length: Length::Sum([term(0, 1.5)].into()), law, soft, weight: 0.7 };
        let violation = |q: &[f64]| {
            let y = 0.5 * q[1] - 0.4 * q[2] + 0.3;
            1.5 * q[0] - 0.1 - (0.2 - 0.7 * y + 0.4 * y * y + 1.3 * y.powi(3) - 0.9 * y.powi(4))
        };
        let q = [0.3, 0.8, -0.5];
        let mut rows = Vec::new();
        let (length, y) = ((1.5 * q[0], [(0, 1.5)].into()), (0.5 * q[1] - 0.4 * q[2], [(1, 0.5), (2, -0.4)].into()));
        sum.rows(length, Some(y), &[0.0; 3], &mut rows);
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
