//! The Coriolis matrix of the Christoffel symbols, as a sum over links.

use alloc::vec;
use alloc::vec::Vec;

use nalgebra::{Matrix3, Matrix6, Vector6};

use super::Textbook;
use super::matrix::{ad, blocks, cross_matrix, halves};
use crate::Scalar;
use crate::spatial::Reference;

impl<S: Scalar> Textbook<S> {
    /// C(q, v) = Σ Jᵀ (B J + G J̇), `[nv][nv]`: C v + g = h, and Ṁ − 2C is skew; Echeandia &
    /// Wensing, *J. Comput. Nonlinear Dyn.* 16, 2021.
    ///
    /// J̇ is the rate of the moving columns there. In link coordinates, in which J is given here,
    /// that is dJ/dt + ad(V) J.
    pub fn coriolis_matrix(&self, q: &[S], v: &[S]) -> Vec<S> {
        let n = self.nv;
        let mut c = vec![S::zero(); n * n];
        let jacobians = self.body_jacobians(Reference::Body, q);
        let rates = self.body_jacobian_rates(Reference::Body, q, v);
        let twists = self.body_twists(Reference::Body, q, v);
        for (i, body) in self.bodies.iter().enumerate().filter(|(_, b)| b.carried) {
            let (g, b) = (&body.inertia, factor_matrix(&body.inertia, &twists[i]));
            let of_column = |k: usize| b * jacobians[i][k] + g * (rates[i][k] + ad(&twists[i]) * jacobians[i][k]);
            let columns: Vec<Vector6<S>> = (0..n).map(of_column).collect();
            (0..n * n).for_each(|k| c[k] += jacobians[i][k / n].dot(&columns[k % n]));
        }
        c
    }
}

/// B(V) = ½ [(V×*) G − G (V×) + (G V)×̄*], with V×* = −ad(V)ᵀ and f ×̄* V = V ×* f.
fn factor_matrix<S: Scalar>(g: &Matrix6<S>, v: &Vector6<S>) -> Matrix6<S> {
    let (cross, f) = (ad(v), g * v);
    (-(cross.transpose() * g) - g * cross + swapped(&f)) * S::from_f64(0.5)
}

/// f ×̄* = [−[m]× −[f]×; −[f]× 0].
fn swapped<S: Scalar>(wrench: &Vector6<S>) -> Matrix6<S> {
    let (moment, force) = halves(wrench);
    let f = -cross_matrix(force);
    blocks(&-cross_matrix(moment), &f, &f, &Matrix3::zeros())
}
