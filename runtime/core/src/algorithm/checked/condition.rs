//! An estimate of a condition number.

use super::{Factor, greater, larger};
use crate::Scalar;

impl<S: Scalar<Mask = bool>> Factor<S> {
    /// √M_ii, and the norm of the scaled matrix.
    pub(super) fn measure(&mut self, matrix: &[S]) {
        let n = self.n;
        for (k, scale) in self.scale.iter_mut().enumerate() {
            *scale = matrix[k * n + k].abs().sqrt();
        }
        let scaled = |i: usize, k: usize| {
            let x = matrix[i * n + k];
            if x.is_zero() { x } else { x.abs() / self.scale[i] / self.scale[k] }
        };
        let row = |i: usize| (0..n).fold(S::zero(), |sum, k| sum + scaled(i, k));
        self.norm = (0..n).fold(S::zero(), |most, i| larger(row(i), most));
    }

    /// An estimate of κ₁ of the factored matrix, scaled to a diagonal of ones: M_ik/√(M_ii M_kk).
    /// It has no units and is within n of the least over all scalings of the joints' units (van der
    /// Sluis, *Numer. Math.* 14, 1969). Never more than κ₁, rarely less than a third: Hager's
    /// estimate from two starts, and Higham's vector (Higham, *Accuracy and Stability of Numerical
    /// Algorithms*, 2002, alg. 15.1). Meaningless after an error of factoring.
    pub fn condition(&mut self) -> S {
        let mut room = core::mem::take(&mut self.room);
        let inverse = self.inverse_norm(&mut room);
        self.room = room;
        self.norm * inverse
    }

    /// ‖B⁻¹‖₁ of the scaled matrix B: from even numbers, from numbers of alternating signs, and for
    /// a vector that both may miss.
    fn inverse_norm(&self, [x, sign]: &mut [alloc::vec::Vec<S>; 2]) -> S {
        let n = self.n;
        let Some(last) = n.checked_sub(1) else { return S::one() };
        let (count, alternate) = (|k: usize| S::from_f64(k as f64), |k: usize, x: S| if k.is_multiple_of(2) { x } else { -x });
        x.fill(S::one() / count(n));
        let even = self.climb(x, sign);
        x.iter_mut().enumerate().for_each(|(k, x)| *x = alternate(k, S::one() / count(n)));
        let estimate = larger(self.climb(x, sign), even);
        // (−1)ᵏ (1 + k/(n − 1))
        x.iter_mut().enumerate().for_each(|(k, x)| *x = alternate(k, S::one() + count(k) / count(last.max(1))));
        self.apply(x);
        larger(S::from_f64(2.0) * sum(x) / (S::from_f64(3.0) * count(n)), estimate)
    }

    /// Hager's ascent: ‖B⁻¹x‖₁ of ever better unit vectors.
    fn climb(&self, x: &mut [S], sign: &mut [S]) -> S {
        let mut estimate = S::zero();
        for _ in 0..5 {
            self.apply(x);
            let size = sum(x);
            if !greater(size, estimate) {
                break;
            }
            estimate = size;
            sign.iter_mut().zip(x.iter()).for_each(|(s, x)| *s = if greater(S::zero(), *x) { -S::one() } else { S::one() });
            self.apply(sign);
            let largest = (0..self.n).fold(0, |best, k| if greater(sign[k].abs(), sign[best].abs()) { k } else { best });
            x.fill(S::zero());
            x[largest] = S::one();
        }
        estimate
    }

    /// B⁻¹ x, B⁻¹ = diag(s) M⁻¹ diag(s).
    fn apply(&self, x: &mut [S]) {
        x.iter_mut().zip(&self.scale).for_each(|(x, s)| *x *= *s);
        self.solve(x);
        x.iter_mut().zip(&self.scale).for_each(|(x, s)| *x *= *s);
    }
}

fn sum<S: Scalar>(x: &[S]) -> S {
    x.iter().fold(S::zero(), |sum, x| sum + x.abs())
}
