//! M = Lᵀ D L, which keeps the zeros that branches leave in M. Featherstone 2008, §6.5.

use alloc::vec::Vec;

use crate::Scalar;

/// The degrees of freedom on the path from `k` to the root, without `k`.
pub(crate) fn path_to_root(parent_dof: &[usize], k: usize) -> impl Iterator<Item = usize> {
    let next = |k: usize| parent_dof[k].checked_sub(1);
    core::iter::successors(next(k), move |&i| next(i))
}

/// How many multiplications [`factor`] takes where no element on the way between two joints is
/// zero.
pub(super) fn multiplications(parent_dof: &[usize]) -> u64 {
    // Number of joints between each and the base; these come before it.
    let mut depths: Vec<u64> = Vec::with_capacity(parent_dof.len());
    for &next in parent_dof {
        depths.push(next.checked_sub(1).map_or(0, |i| depths[i] + 1));
    }
    depths.iter().map(|d| d * (d + 5) / 2).sum()
}

/// M = Lᵀ D L in place: L below the diagonal with ones on it, D⁻¹ on the diagonal. From the last
/// row up, so that the zeros between branches stay.
pub(crate) fn factor<S: Scalar>(m: &mut [S], parent_dof: &[usize]) {
    let n = parent_dof.len();
    for k in (0..n).rev() {
        let inverse = S::one() / m[k * n + k];
        for i in path_to_root(parent_dof, k) {
            let l = m[k * n + i] * inverse;
            // M_ij −= L_ki M_kj
            let product = l * m[k * n + i];
            m[i * n + i] -= product;
            for j in path_to_root(parent_dof, i) {
                let product = l * m[k * n + j];
                m[i * n + j] -= product;
            }
        }
        for i in path_to_root(parent_dof, k) {
            m[k * n + i] *= inverse;
        }
        m[k * n + k] = inverse;
    }
}

/// x = L⁻¹ D⁻¹ L⁻ᵀ b, in place.
pub(crate) fn solve<S: Scalar>(l: &[S], parent_dof: &[usize], x: &mut [S]) {
    let n = parent_dof.len();
    for k in (0..n).rev() {
        for i in path_to_root(parent_dof, k) {
            let product = l[k * n + i] * x[k];
            x[i] -= product;
        }
    }
    for k in 0..n {
        x[k] *= l[k * n + k];
        for i in path_to_root(parent_dof, k) {
            let product = l[k * n + i] * x[i];
            x[k] -= product;
        }
    }
}

/// bᵀ M⁻¹ b = |D^−½ L⁻ᵀ b|²: not negative, also with roundings.
pub(crate) fn inverse_square<S: Scalar>(l: &[S], parent_dof: &[usize], b: &[S]) -> S {
    let (n, mut x) = (parent_dof.len(), b.to_vec());
    for k in (0..n).rev() {
        for i in path_to_root(parent_dof, k) {
            let product = l[k * n + i] * x[k];
            x[i] -= product;
        }
    }
    (0..n).fold(S::zero(), |sum, k| sum + x[k] * x[k] * l[k * n + k])
}

/// X = M⁻¹ B in place, for a matrix B of `below.len()` columns, row by row: all its columns at
/// once.
pub(crate) fn solve_rows<S: Scalar>(l: &[S], parent_dof: &[usize], x: &mut [S]) {
    solve_from(l, parent_dof, x, |_| 0);
}

/// X = M⁻¹, `[n][n]`, row by row.
pub(super) fn inverse<S: Scalar>(l: &[S], parent_dof: &[usize], x: &mut [S]) {
    let n = parent_dof.len();
    x.fill(S::zero());
    (0..n).for_each(|k| x[k * n + k] = S::one());
    // L⁻ᵀ is zero below its diagonal, and one half of a symmetric result is enough.
    solve_from(l, parent_dof, x, |k| k);
    for j in 0..n {
        (0..j).for_each(|i| x[j * n + i] = x[i * n + j]);
    }
}

/// As [`solve_rows`], each row from this column on.
#[inline(always)]
fn solve_from<S: Scalar>(l: &[S], parent_dof: &[usize], x: &mut [S], first: impl Fn(usize) -> usize) {
    let n = parent_dof.len();
    for k in (0..n).rev() {
        for i in path_to_root(parent_dof, k) {
            let (before, row) = x.split_at_mut(k * n);
            subtract(&mut before[i * n..][first(k)..n], &row[first(k)..n], l[k * n + i]);
        }
    }
    for k in 0..n {
        let (before, row) = x.split_at_mut(k * n);
        let row = &mut row[first(k)..n];
        row.iter_mut().for_each(|x| *x *= l[k * n + k]);
        for i in path_to_root(parent_dof, k) {
            subtract(row, &before[i * n..][first(k)..n], l[k * n + i]);
        }
    }
}

/// to −= factor · from.
#[inline(always)]
fn subtract<S: Scalar>(to: &mut [S], from: &[S], factor: S) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to -= factor * *from);
}
