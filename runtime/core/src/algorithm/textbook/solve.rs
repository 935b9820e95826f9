//! Symmetric positive definite systems, dense.

use alloc::vec;
use alloc::vec::Vec;

use crate::Scalar;

/// A = L D Lᵀ; Golub & Van Loan, *Matrix Computations*, 2013, §4.1.2.
pub(super) struct Factor<S> {
    n: usize,
    /// L below the diagonal, D on it.
    entries: Vec<S>,
}

impl<S: Scalar> Factor<S> {
    /// Of a matrix `[n][n]`, of which the lower triangle is read.
    pub(super) fn new(matrix: &[S], n: usize) -> Self {
        let mut l = matrix.to_vec();
        for j in 0..n {
            // d_j = a_jj − Σ l_jk² d_k;  l_ij = (a_ij − Σ l_ik l_jk d_k) / d_j
            for i in j..n {
                let known = (0..j).fold(S::zero(), |sum, k| sum + l[i * n + k] * l[j * n + k] * l[k * n + k]);
                let left = l[i * n + j] - known;
                l[i * n + j] = if i == j { left } else { left / l[j * n + j] };
            }
        }
        Self { n, entries: l }
    }

    /// x with A x = b.
    pub(super) fn solve(&self, b: &[S]) -> Vec<S> {
        let (n, l, mut x) = (self.n, &self.entries, b.to_vec());
        for i in 0..n {
            x[i] = (0..i).fold(x[i], |left, k| left - l[i * n + k] * x[k]);
        }
        (0..n).for_each(|i| x[i] = x[i] / l[i * n + i]);
        for i in (0..n).rev() {
            x[i] = (i + 1..n).fold(x[i], |left, k| left - l[k * n + i] * x[k]);
        }
        x
    }

    /// A⁻¹, `[n][n]`.
    pub(super) fn inverse(&self) -> Vec<S> {
        let n = self.n;
        let mut inverse = vec![S::zero(); n * n];
        for j in 0..n {
            let unit: Vec<S> = (0..n).map(|i| if i == j { S::one() } else { S::zero() }).collect();
            self.solve(&unit).into_iter().enumerate().for_each(|(i, x)| inverse[i * n + j] = x);
        }
        inverse
    }
}
