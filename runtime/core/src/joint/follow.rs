//! The law by which a joint follows another.

#[cfg(feature = "alloc")]
use alloc::vec::Vec;

use crate::Scalar;

/// A polynomial of the leader's coordinate q: own coordinate = f(q) = offset + multiplier q +
/// higher₀ q² + higher₁ q³ + higher₂ q⁴.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Follow<S> {
    /// d(own)/d(leader's) where the leader's coordinate is zero; everywhere, if f is linear.
    pub multiplier: S,
    /// Own coordinate where the leader's is zero, rad or m.
    pub offset: S,
    /// Coefficients of q², q³ and q⁴, in the units of the own coordinate over powers of those of
    /// the leader's; `None`: f is linear.
    pub higher: Option<[S; 3]>,
}

impl<S: Scalar> Follow<S> {
    /// f(q) at the leader's coordinate.
    #[inline(always)]
    pub fn value(&self, q: S) -> S {
        match self.higher {
            None => q * self.multiplier + self.offset,
            Some([c2, c3, c4]) => (((c4 * q + c3) * q + c2) * q + self.multiplier) * q + self.offset,
        }
    }

    /// f′(q).
    #[inline(always)]
    pub fn slope(&self, q: S) -> S {
        match self.higher {
            None => self.multiplier,
            Some([c2, c3, c4]) => ((c4 * number(4.0) * q + c3 * number(3.0)) * q + c2 * number(2.0)) * q + self.multiplier,
        }
    }

    /// f″(q); `None` of a linear f.
    #[inline(always)]
    pub fn bend(&self, q: S) -> Option<S> {
        self.higher.map(|[c2, c3, c4]| (c4 * number(12.0) * q + c3 * number(6.0)) * q + c2 * number(2.0))
    }

    /// f‴(q); `None` of a linear f.
    #[inline(always)]
    pub fn rate_of_bend(&self, q: S) -> Option<S> {
        self.higher.map(|[_, c3, c4]| c4 * number(24.0) * q + c3 * number(6.0))
    }

    /// The same in another scalar.
    #[cfg(feature = "alloc")]
    pub(crate) fn map<T: Scalar>(&self, f: impl Fn(S) -> T + Copy) -> Follow<T> {
        Follow { multiplier: f(self.multiplier), offset: f(self.offset), higher: self.higher.map(|all| all.map(f)) }
    }
}

fn number<S: Scalar>(x: f64) -> S {
    S::from_f64(x)
}

#[cfg(feature = "alloc")]
impl Follow<f64> {
    /// The least and the greatest value of f while the leader's coordinate is from `lower` to
    /// `upper`, rad or m, both finite.
    pub fn range(&self, lower: f64, upper: f64) -> [f64; 2] {
        // Between neighbours in the places where the next derivative is zero, each is monotone.
        let places = with_zeros(|q| self.rate_of_bend(q).unwrap_or(0.0), &[lower, upper]);
        let places = with_zeros(|q| self.bend(q).unwrap_or(0.0), &places);
        let places = with_zeros(|q| self.slope(q), &places);
        let values = places.iter().map(|q| self.value(*q));
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], x| [least.min(x), most.max(x)])
    }
}

/// Halvings of an interval after which its ends are neighbours, or nearly.
#[cfg(feature = "alloc")]
const HALVINGS: usize = 64;

/// The places, and between them the zeros of a function that is monotone between neighbours.
#[cfg(feature = "alloc")]
fn with_zeros(f: impl Fn(f64) -> f64, places: &[f64]) -> Vec<f64> {
    let mut all = Vec::new();
    for ends in places.windows(2) {
        let (mut low, mut high) = (ends[0], ends[1]);
        all.push(low);
        if f(low) * f(high) < 0.0 {
            let rises = f(low) < 0.0;
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                if (f(middle) < 0.0) == rises {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            all.push(low);
        }
    }
    all.extend(places.last());
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_range_of_a_law_is_that_of_its_values() {
        let laws = [
            Follow { multiplier: -2.0, offset: 0.5, higher: None },
            Follow { multiplier: 0.0, offset: 0.1, higher: Some([1.0, 0.0, 0.0]) },
            Follow { multiplier: -1.0, offset: 0.0, higher: Some([0.0, 0.7, 0.0]) },
            Follow { multiplier: 0.3, offset: -0.2, higher: Some([-1.1, 0.1, 0.4]) },
        ];
        for law in laws {
            for (lower, upper) in [(-1.5, 2.0), (0.2, 0.9), (1.0, 1.0)] {
                let values = (0..=4000).map(|k| law.value(lower + (upper - lower) * f64::from(k) / 4000.0));
                let seen = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)]);
                let found = law.range(lower, upper);
                assert!((0..2).all(|k| (found[k] - seen[k]).abs() < 1e-5), "{law:?}: {found:?}, seen {seen:?}");
                assert!(found[0] <= seen[0] + 1e-15 && seen[1] <= found[1] + 1e-15);
            }
        }
    }
}
