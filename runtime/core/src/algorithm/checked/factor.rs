//! M = Lᵀ D L of a matrix that may be singular.

use alloc::vec;
use alloc::vec::Vec;

use super::pivots::{PivotMonitor, part};
use super::{greater, larger};
use crate::Scalar;
use crate::scalar::two_to;

/// How often [`Factor::refine`] corrects at most, as LAPACK's `xPORFS` does.
const STEPS: usize = 5;

/// M = Lᵀ D L of a symmetric matrix, with the remaining part of each pivot. Memory for matrices of
/// one size, allocated once.
///
/// It sees the matrix only. A diagonal element that is itself only rounding error of its terms is
/// detectable only where it is computed ([`super::checked_forward_dynamics`] does so).
#[derive(Clone, Debug)]
pub struct Factor<S = f64> {
    pub(super) n: usize,
    /// L below the diagonal, D on it; `[n · n]`.
    l: Vec<S>,
    /// D/(Σ|terms|), `[n]`.
    pivots: Vec<S>,
    /// √M_ii, and the 1-norm of M scaled by these.
    pub(super) scale: Vec<S>,
    pub(super) norm: S,
    /// For estimates, `[n]` each.
    pub(super) room: [Vec<S>; 2],
}

impl<S: Scalar<Mask = bool>> Factor<S> {
    /// For matrices of n rows.
    pub fn new(n: usize) -> Self {
        let zeros = || vec![S::zero(); n];
        Self { n, l: vec![S::zero(); n * n], pivots: zeros(), scale: zeros(), norm: S::zero(), room: [zeros(), zeros()] }
    }

    /// Factors; from the last row up, so that zeros between branches stay, as Featherstone 2008,
    /// §6.5.
    ///
    /// matrix: `[n · n]`, symmetric. Errors: (row of the lost pivot, its remaining part), of the
    /// last such row.
    ///
    /// # Panics
    /// If the matrix has another size.
    pub fn factor(&mut self, matrix: &[S]) -> Result<(), (usize, S)> {
        let n = self.n;
        self.measure(matrix);
        self.l.copy_from_slice(matrix);
        let mut lost = None;
        for k in (0..n).rev() {
            let pivot = self.l[k * n + k];
            // D = M_kk − Σ L²D, all of them positive: |terms| sum up to 2 M_kk − D.
            let own = matrix[k * n + k];
            self.pivots[k] = part(pivot, own + (own - pivot));
            if lost.is_none() {
                let mut monitor = PivotMonitor::new();
                monitor.see(k, self.pivots[k]);
                lost = monitor.lost();
            }
            self.eliminate(k, pivot);
        }
        lost.map_or(Ok(()), Err)
    }

    fn eliminate(&mut self, k: usize, pivot: S) {
        let n = self.n;
        let (above, row) = self.l.split_at_mut(k * n);
        for i in (0..k).rev().filter(|&i| !row[i].is_zero()) {
            let l = row[i] / pivot;
            // M_ij −= L_ki M_kj
            above[i * n..=i * n + i].iter_mut().zip(row.iter()).for_each(|(m, x)| *m -= l * *x);
        }
        row[..k].iter_mut().for_each(|x| *x = *x / pivot);
    }

    /// Refines x = M⁻¹ b in place; `[n]` each. matrix: the factored one. Returns the remaining
    /// backward error max_i |b − M x|_i / (|M||x| + |b|)_i.
    ///
    /// r = b − M x, x += M⁻¹ r, as long as that halves the error, and five times at most.
    /// Elimination leaves an r like roundings of √(M_ii M_jj)|x_j|. These exceed roundings of
    /// (|M||x|)_i if two coordinates hardly move each other and masses are far apart. After
    /// refinement r is like roundings of |M||x| + |b|, row by row, unless M is nearly singular
    /// (Skeel, *Iterative refinement implies numerical stability for Gaussian elimination*, Math.
    /// Comp. 35, 1980; Higham, *Accuracy and Stability of Numerical Algorithms*, 2002, 12.2).
    ///
    /// # Panics
    /// If a slice is shorter.
    pub fn refine(&mut self, matrix: &[S], b: &[S], x: &mut [S]) -> S {
        let mut residue = core::mem::take(&mut self.room[0]);
        let mut error = self.residue(matrix, b, x, &mut residue);
        for _ in 0..STEPS {
            // An error of one rounding cannot be refined.
            if !greater(error, S::from_f64(const { two_to(-(S::BITS as i32)) })) {
                break;
            }
            self.solve(&mut residue);
            x.iter_mut().zip(&residue).for_each(|(x, correction)| *x += *correction);
            let before = core::mem::replace(&mut error, self.residue(matrix, b, x, &mut residue));
            if greater(error + error, before) {
                break;
            }
        }
        self.room[0] = residue;
        error
    }

    /// r = b − M x, and the largest |r|_i / (|M||x| + |b|)_i.
    fn residue(&self, matrix: &[S], b: &[S], x: &[S], out: &mut [S]) -> S {
        let mut most = S::zero();
        for (i, r) in out.iter_mut().enumerate() {
            let (mut rest, mut size) = (b[i], b[i].abs());
            for (m, x) in matrix[i * self.n..][..self.n].iter().zip(x) {
                let product = *m * *x;
                rest -= product;
                size += product.abs();
            }
            *r = rest;
            // 0/0 is no error.
            most = if size.is_zero() { most } else { larger(rest.abs() / size, most) };
        }
        most
    }

    /// The remaining part of each pivot, D/(Σ|terms|) in (0, 1]; `[n]`.
    pub fn pivots(&self) -> &[S] {
        &self.pivots
    }

    /// x = M⁻¹ x, in place; `[n]`.
    ///
    /// # Panics
    /// If x is shorter.
    pub fn solve(&self, x: &mut [S]) {
        let (n, l) = (self.n, &self.l);
        for k in (0..n).rev() {
            let (before, own) = x.split_at_mut(k);
            before.iter_mut().zip(&l[k * n..]).for_each(|(x, l)| *x -= *l * own[0]);
        }
        for k in 0..n {
            let (before, own) = x.split_at_mut(k);
            own[0] = before.iter().zip(&l[k * n..]).fold(own[0] / l[k * n + k], |sum, (x, l)| sum - *l * *x);
        }
    }
}
